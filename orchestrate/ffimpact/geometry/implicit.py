"""Obstacles by a signed distance, an expression of x, y (and z) [m] (docs: scenes): positive
outside, 0 on the surface, any smooth one that is not constant there. It becomes a program of
numbers for a stack, which FreeFEM runs (edp/core/contact/shapes.idp: what they mean, and how the
gap comes from it); `gap` does the same.
"""

import ast
import math
from dataclasses import dataclass

import numpy as np

from ..failure import BadInput, brief

__all__ = [
    "Stop",
    "bending",
    "closest",
    "gap",
    "is_mirrored",
    "nearest",
    "program",
    "radius_at",
    "run",
    "settled",
]

ACCEPTED = "numbers, pi, {names}, + - * / ^, sin cos sqrt exp abs min max and parentheses"
LONGEST = 1000  # characters of an expression
TWO = {ast.Add: 4, ast.Sub: 5, ast.Mult: 6, ast.Div: 7, ast.Pow: 8, "min": 9, "max": 10}
ONE = {ast.USub: 11, "sin": 12, "cos": 13, "sqrt": 14, "exp": 15, "abs": 16}
TINY = 1e-300  # so that the slope of a root of 0 is that of what is in it, where this has none
TURNS = 60  # towards the closest point, at most
CLOSE = 1e-9  # of `limit`: how near it is at last
BESIDE = 1e-6  # of `limit`: how far beside a point its iteration begins
SAMPLES = 4000  # points at which steepness and curvature are looked for
STEEPEST = 1e150  # beyond, squares overflow: of the expression the sign alone is known
FARTHEST = 1e4  # how far, over the size of all bodies, the surface is looked for


@dataclass(frozen=True)
class Stop(Exception):
    """What of an expression is not accepted."""

    what: str


def program(entry: str, text: object, names: str) -> tuple[float, ...]:
    """The program of an expression of variables with names of one letter. BadInput, naming the
    entry.
    """
    accepted = f"(accepted: {ACCEPTED.format(names=', '.join(names))})"
    if not isinstance(text, str) or not text.strip():
        raise BadInput(
            f"{entry}: '{brief(text)}' is no expression {accepted}"
            if text is not None
            else f"{entry}: is missing {accepted}"
        )
    if len(text) > LONGEST:
        raise BadInput(f"{entry}: {len(text)} characters (accepted: up to {LONGEST})")
    try:
        return tuple(_tokens(ast.parse(text.strip().replace("^", "**"), mode="eval").body, names))
    except Stop as stop:
        raise BadInput(
            f"{entry}: '{brief(stop.what)}' in '{brief(text)}' is not known {accepted}"
        ) from None
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise BadInput(f"{entry}: '{brief(text)}' is no expression {accepted}") from None


def _tokens(node: ast.AST, names: str) -> list[float]:
    match node:
        case ast.Constant(value=int() | float() as value) if (
            not isinstance(value, bool) and abs(value) < 1e300
        ):
            return [0.0, float(value)]
        case ast.Name(id="pi"):
            return [0.0, math.pi]
        case ast.Name(id=name) if name in tuple(names):
            return [1.0 + names.index(name)]
        case ast.UnaryOp(op=ast.UAdd(), operand=one):
            return _tokens(one, names)
        case ast.UnaryOp(op=ast.USub(), operand=one):
            return [*_tokens(one, names), float(ONE[ast.USub])]
        case ast.BinOp(left=base, op=ast.Pow(), right=power):
            exponent = _tokens(power, names)
            if any(token in (1, 2, 3) for token in exponent[::2]) or len(exponent) > 3:
                raise Stop("^ " + ast.unparse(power))
            return [*_tokens(base, names), *exponent, float(TWO[ast.Pow])]
        case ast.BinOp(left=a, op=op, right=b) if type(op) in TWO:
            return [*_tokens(a, names), *_tokens(b, names), float(TWO[type(op)])]
        case ast.Call(func=ast.Name(id=name), args=[one], keywords=[]) if name in ONE:
            return [*_tokens(one, names), float(ONE[name])]
        case ast.Call(func=ast.Name(id=name), args=[a, b], keywords=[]) if name in TWO:
            return [*_tokens(a, names), *_tokens(b, names), float(TWO[name])]
    raise Stop(ast.unparse(node))


# Of every operation on a (and b): its value and its derivatives by a and b. `side` is what min, max
# and abs take: 1 where it is a, or the sign of a.
OPERATIONS = {
    4: lambda a, b, side: (a + b, 1, 1),
    5: lambda a, b, side: (a - b, 1, -1),
    6: lambda a, b, side: (a * b, b, a),
    7: lambda a, b, side: (a / b, 1 / b, -a / b**2),
    8: lambda a, b, side: (a**b, np.where(b == 0, 0, b * a ** np.where(b == 0, 1, b - 1)), 0),
    9: lambda a, b, side: (np.where(side, a, b), side, 1 - side),
    10: lambda a, b, side: (np.where(side, a, b), side, 1 - side),
    11: lambda a, b, side: (-a, -1, 0),
    12: lambda a, b, side: (np.sin(a), np.cos(a), 0),
    13: lambda a, b, side: (np.cos(a), -np.sin(a), 0),
    14: lambda a, b, side: (np.sqrt(a), 0.5 / (np.sqrt(a) + TINY), 0),
    15: lambda a, b, side: (np.exp(a), np.exp(a), 0),
    16: lambda a, b, side: (a * side, side, 0),
}
SIDES = {
    9: lambda a, b: (a < b) * 1.0,
    10: lambda a, b: (a >= b) * 1.0,
    16: lambda a, b: np.where(a < 0, -1.0, 1.0),
}


def run(
    code: tuple[float, ...], points: np.ndarray, sides: dict | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """D (n,) and its gradient (n, axes) at points (n, axes). `sides`: what min, max and abs
    take in each place; put in where missing.
    """
    stack, entries, sides, eye = (
        [],
        enumerate(code),
        {} if sides is None else sides,
        np.eye(points.shape[1]),
    )
    for e, op in entries:
        if op < 4:
            value, slope = (
                (next(entries)[1], 0 * eye[0])
                if op == 0
                else (points[:, int(op) - 1], eye[int(op) - 1])
            )
            stack.append((value + np.zeros(len(points)), slope + np.zeros_like(points)))
            continue
        b, slope_b = stack.pop() if op < 11 else (0.0, 0.0)
        a, slope_a = stack.pop()
        if op in SIDES and e not in sides:
            sides[e] = SIDES[op](a, b)
        value, by_a, by_b = OPERATIONS[op](a, b, sides.get(e))
        stack.append(
            (value, slope_a * np.reshape(by_a, (-1, 1)) + slope_b * np.reshape(by_b, (-1, 1)))
        )
    return stack[0]


def gap(points: np.ndarray, numbers: tuple[float, ...], bounds: bool = True) -> np.ndarray:
    """Signed distances (n,) of points (n, axes) from the surface; where they are more than
    about `limit`, no more than these, or, without `bounds`, to first order of the
    expression.
    """
    steepest, limit, *code = numbers
    with np.errstate(all="ignore"):
        found, slope = run(code, points)
        size = np.linalg.norm(slope, axis=1)
        near = abs(found) < limit * np.minimum(size, STEEPEST)
        found = np.where(
            size < STEEPEST,
            found / np.maximum(steepest if bounds else 0, size),
            np.copysign(limit, found),
        )
        if near.any():
            distance = closest(points[near], code, limit)[0]
            found[near] = np.where(abs(distance) <= 2 * limit, distance, found[near])
    return found


def closest(points: np.ndarray, code: list[float], limit: float) -> tuple[np.ndarray, np.ndarray]:
    """Distances (n,) of points near the surface, and the closest points of it (n, axes):
    projected on the tangent plane of D there, again and again, unless they turn out to be
    farther than twice `limit`. The iteration begins beside each point: the bottom of a hollow
    is a fixed point of it as well, but repels if it is not the closest point.
    """
    at = points + BESIDE * limit * _along_surface(run(code, points)[1])
    sides, distance = {}, np.zeros(len(points))
    for _ in range(TURNS):
        value, slope = run(code, at, sides)
        size = np.linalg.norm(slope, axis=1)
        normal = slope / size[:, None]
        distance = value / size + np.sum(normal * (points - at), axis=1)
        before, at = (
            at,
            np.where(abs(distance[:, None]) > 2 * limit, at, points - distance[:, None] * normal),
        )
        if not abs(at - before).max() > CLOSE * limit:
            break
    return distance, at


def _along_surface(slope: np.ndarray) -> np.ndarray:
    """Directions (n, axes) across the normals, along no axis in general."""
    normal = slope / np.linalg.norm(slope, axis=1)[:, None]
    if slope.shape[1] == 2:
        return normal[:, ::-1] * [1.0, -1.0]
    return np.cross(normal, [0.36, 0.48, 0.8])


def nearest(
    point: np.ndarray,
    gap: float,
    code: list[float],
    limit: float,
    disc: tuple[np.ndarray, float] | None,
) -> tuple[float, np.ndarray]:
    """Gap and outward normal at a point of a body. If that is a disc or ball, centre and
    radius, and near, at its lowest point as the normal there sees it: centre - radius n, again
    and again.
    """
    value, slope = run(code, point[None])
    if abs(value[0]) >= limit * np.linalg.norm(slope):
        return float(gap), slope[0] / np.linalg.norm(slope)
    for _ in range(TURNS):
        distance, on = closest(point[None], code, limit)
        normal = run(code, on)[1][0]
        normal /= np.linalg.norm(normal)
        before, point = point, disc[0] - disc[1] * normal if disc else point
        if abs(point - before).max() <= CLOSE * limit:
            break
    return float(min(gap, distance[0])), normal


def settled(
    path: str, code: tuple[float, ...], centre: np.ndarray, half: float
) -> tuple[float, ...]:
    """The numbers of an obstacle: steepest, limit, program; from points of a box around
    `centre` (axes,) of the bodies, at first of the half size `half`, so large that it holds
    some of the surface.
    """
    cube, growth = np.random.default_rng(1).uniform(-1, 1, (SAMPLES, len(centre))), 1
    while True:
        points = centre + growth * half * cube
        with np.errstate(all="ignore"):
            value, slope = run(code, points)
            if not (np.isfinite(value).all() and np.isfinite(slope).all()):
                bad = points[np.argmin(np.isfinite(value) & np.isfinite(slope).all(axis=1))]
                raise BadInput(
                    f"{path}.distance: has no value or no gradient at {_text(bad)} (accepted: an expression that has both "
                    f"wherever bodies may be)"
                )
        if value.min() < 0 < value.max():
            break
        if growth > FARTHEST:
            raise BadInput(
                f"{path}.distance: is 0 nowhere within {growth * half:.3g} m of the bodies (accepted: an expression that is 0 "
                f"on a surface there)"
            )
        growth *= 2
    with np.errstate(all="ignore"):
        size = np.linalg.norm(slope, axis=1)
        on = closest(points[abs(value) < 0.1 * growth * half * size], code, half)[1]
        on = on[(abs(on - centre) <= growth * half).all(axis=1)]
        # not that of a corner, which grows
        bend = np.minimum(
            *(abs(bending(code, on, step * half)).max(axis=1) for step in (1e-3, 1e-4))
        ).max(initial=0.0)
    return 1.1 * float(size.max()), float(min(half, 1 / max(3 * bend, 1e-300))), *code


def bending(code: tuple[float, ...], points: np.ndarray, step: float) -> np.ndarray:
    """Curvatures (n, axes) of the surface at points of it, 1/m, along each axis projected on
    it, positive where it bulges out: the change of the normal along the way 2 `step`.
    """

    def normals(at: np.ndarray) -> np.ndarray:
        slope = run(code, at)[1]
        return slope / np.linalg.norm(slope, axis=1)[:, None]

    n, found = normals(points), []
    for axis in np.eye(points.shape[1]):
        along = axis - n * (n @ axis)[:, None]
        along /= np.maximum(np.linalg.norm(along, axis=1), 0.3)[
            :, None
        ]  # an axis nearly across says nothing
        found.append(
            np.sum(
                along * (normals(points + step * along) - normals(points - step * along)), axis=1
            )
            / (2 * step)
        )
    return np.nan_to_num(np.transpose(found))


def radius_at(point: np.ndarray, numbers: tuple[float, ...]) -> float:
    """The smallest radius of curvature [m] of the surface where it is nearest to a point
    (axes,), infinite where it is hollow or flat.
    """
    _, limit, *code = numbers
    with np.errstate(all="ignore"):
        bend = bending(code, closest(point[None], code, limit)[1], 1e-3 * limit).max()
    return float(1 / bend) if bend * limit > 1e-6 else np.inf


def is_mirrored(code: tuple[float, ...], axis: int, axes: int) -> bool:
    """Whether the expression is the same on both sides of the plane through the origin across
    an axis.
    """
    points = np.random.default_rng(2).normal(size=(SAMPLES, axes))
    points *= np.logspace(-4, 2, SAMPLES)[:, None]
    with np.errstate(all="ignore"):
        return bool(
            np.allclose(
                *(
                    run(code, sign * points + (1 - sign) * points * (np.arange(axes) != axis))[0]
                    for sign in (1, -1)
                ),
                rtol=1e-10,
                equal_nan=True,
            )
        )


def _text(point: np.ndarray) -> str:
    return "[" + ", ".join(f"{one:.4g}" for one in point) + "]"
