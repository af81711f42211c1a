"""The scene ball-axisymmetric with NGSolve; see ngsolve_body.py.

Curved P2 triangles of netgen with our sizes on half of the meridian plane. x is the radius and y
the axis. F is 3 x 3 with F_33 = 1 + u_x/x, and pi x is half the length of a circumference.
"""

import math
from dataclasses import replace

import ngsolve_body
from ngsolve import CF, Grad, x
from ngsolve_body import Shape
from ngsolve_disc import disc


def gradient(u):
    """The displacement gradient (3, 3) of a displacement in the meridian plane."""
    H = Grad(u)
    return CF((H[0, 0], H[0, 1], 0, H[1, 0], H[1, 1], 0, 0, 0, u[0] / x), dims=(3, 3))


def ball(options) -> Shape:
    return replace(disc(options), gradient=gradient, share=math.pi * x, more=(2, 1))


if __name__ == "__main__":
    ngsolve_body.main("ball-axisymmetric", ball)
