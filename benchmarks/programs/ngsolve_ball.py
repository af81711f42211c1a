"""ball-axisymmetric with NGSolve: curved P2 triangles of netgen with our sizes over half a meridian plane. See ngsolve_body.py.

x is the radius, y the axis; F is 3 x 3 with F_33 = 1 + u_x/x, and pi x half the length of a hoop.
"""

import math
from dataclasses import replace

import ngsolve_body
from ngsolve import CF, Grad, x
from ngsolve_body import Shape
from ngsolve_disc import disc


def gradient(u):
    """(3, 3) of a displacement of the meridian plane."""
    H = Grad(u)
    return CF((H[0, 0], H[0, 1], 0, H[1, 0], H[1, 1], 0, 0, 0, u[0] / x), dims=(3, 3))


def ball(options) -> Shape:
    return replace(disc(options), gradient=gradient, share=math.pi * x, more=(2, 1))


if __name__ == "__main__":
    ngsolve_body.main("ball-axisymmetric", ball)
