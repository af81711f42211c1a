"""Implicit obstacles: the surface D(x) = 0 of an expression D of x, y (and z) [m] (docs: scenes).

D is positive outside the solid, smooth, and not constant on the surface. It need not be a distance.
The expression is translated into a list of numbers, the program of a stack machine. The kernels run
this program; edp/kernels/implicit.cpp documents the numbers and the gap that follows from D.
`gap` computes the same gap in Python.
"""

import ast
import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..failure import BadInput, brief

__all__ = [
    "Interval",
    "Stop",
    "among",
    "bending",
    "closest",
    "gap",
    "is_mirrored",
    "least",
    "nearest",
    "no_zero",
    "parsed",
    "program",
    "radius_at",
    "run",
    "settled",
    "sines",
    "translated",
]

ACCEPTED = "numbers, pi, {names}, + - * / ^, {functions} and parentheses"
LONGEST = 1000  # largest number of characters of an expression
# Numbers of the stack operations with two operands and with one operand.
TWO = {ast.Add: 4, ast.Sub: 5, ast.Mult: 6, ast.Div: 7, ast.Pow: 8, "min": 9, "max": 10}
ONE = {ast.USub: 11, "sin": 12, "cos": 13, "sqrt": 14, "exp": 15, "abs": 16, "log": 17}
FUNCTIONS = ("sin", "cos", "sqrt", "exp", "abs", "min", "max")
# Added to the denominator of the derivative of sqrt: at sqrt(0) the derivative stays finite, and
# the chain rule gives 0 where the gradient of the argument is 0.
TINY = 1e-300
TURNS = 60  # largest number of iterations of the closest-point projection
CLOSE = 1e-9  # convergence tolerance of the closest-point projection, relative to `limit`
BESIDE = 1e-6  # tangential offset of the first iterate from the point, relative to `limit`
SAMPLES = 4000  # number of points near which curvature is sampled
# Largest gradient whose square does not overflow. Beyond it only the sign of D is used.
STEEPEST = 1e150
Interval = tuple[np.ndarray, np.ndarray]  # lower and upper bounds (n,)
WIDEST = 1e15  # largest width of a box that is known to have no zero, over `limit`
FARTHEST = 1e4  # largest factor by which the box of the bodies grows in search of the surface


@dataclass(frozen=True)
class Stop(Exception):
    """An expression is not accepted; `what` is the text of the part that is refused."""

    what: str


def program(entry: str, text: object, names: str) -> tuple[float, ...]:
    """Translates an expression into the program of the stack machine.

    `names` contains the names of the variables, one letter each. Raises BadInput, with the name of
    the entry, if the text is not an accepted expression.
    """
    meanings = {name: (k,) for k, name in enumerate(names, 1)}
    return translated(entry, str(text), parsed(entry, text, names), meanings)


def parsed(
    entry: str, text: object, names: Collection[str], functions: Collection[str] = FUNCTIONS
) -> ast.expr:
    """Parses an expression of variables with these names. Raises BadInput if it is none."""
    accepted = _accepted(names, functions)
    if not isinstance(text, str) or not text.strip():
        raise BadInput(
            f"{entry}: '{brief(text)}' is no expression {accepted}"
            if text is not None
            else f"{entry}: is missing {accepted}"
        )
    if len(text) > LONGEST:
        raise BadInput(f"{entry}: {len(text)} characters (accepted: up to {LONGEST})")
    try:
        return ast.parse(text.strip().replace("^", "**"), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise BadInput(f"{entry}: '{brief(text)}' is no expression {accepted}") from None


def translated(
    entry: str,
    text: str,
    tree: ast.expr,
    meanings: Mapping[str, Sequence[float]],
    functions: Collection[str] = FUNCTIONS,
) -> tuple[float, ...]:
    """Translates the parsed expression `tree`, a part of `text`. `meanings` has the program of each
    name. Raises BadInput if the expression has something else.
    """
    try:
        return tuple(_tokens(tree, {"pi": (0.0, math.pi)} | dict(meanings), functions))
    except Stop as stop:
        accepted = _accepted(meanings, functions)
        raise BadInput(
            f"{entry}: '{brief(stop.what)}' in '{brief(text)}' is not known {accepted}"
        ) from None
    except RecursionError:
        raise BadInput(f"{entry}: is nested too deeply (accepted: fewer parentheses)") from None


def _accepted(names: Collection[str], functions: Collection[str]) -> str:
    words = ACCEPTED.format(names=", ".join(names), functions=" ".join(functions))
    return f"(accepted: {words})"


def _tokens(
    node: ast.AST, meanings: Mapping[str, Sequence[float]], functions: Collection[str]
) -> list[float]:
    match node:
        case ast.Constant(value=int() | float() as value) if (
            not isinstance(value, bool) and abs(value) < 1e300
        ):
            return [0.0, float(value)]
        case ast.Name(id=name) if name in meanings:
            return list(meanings[name])
        case ast.UnaryOp(op=ast.UAdd(), operand=operand):
            return _tokens(operand, meanings, functions)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return _applied(ONE[ast.USub], _tokens(operand, meanings, functions))
        case ast.BinOp(left=a, op=op, right=b) if type(op) in TWO:
            second = _tokens(b, meanings, functions)
            if isinstance(op, ast.Pow) and not _is_number(second):
                raise Stop("^ " + ast.unparse(b))
            return _applied(TWO[type(op)], _tokens(a, meanings, functions), second)
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in functions:
            operation = {1: ONE, 2: TWO}.get(len(args), {}).get(name)
            if operation is not None:
                return _applied(operation, *(_tokens(item, meanings, functions) for item in args))
    raise Stop(ast.unparse(node))


def _is_number(code: Sequence[float]) -> bool:
    return len(code) == 2 and code[0] == 0


def _applied(operation: int, *operands: list[float]) -> list[float]:
    """The program of an operation on the programs of its operands; a number if they are numbers."""
    if all(map(_is_number, operands)):
        a, b = np.float64(operands[0][1]), np.float64(operands[-1][1])
        with np.errstate(all="ignore"):
            side = SIDES[operation](a, b) if operation in SIDES else None
            value = float(OPERATIONS[operation](a, b, side)[0])
        if math.isfinite(value):
            return [0.0, value]
    return [*(token for operand in operands for token in operand), float(operation)]


# Each operation on a (and b) returns its value and its derivatives with respect to a and b. `side`
# is the branch of min, max and abs: 1 where min and max select a, else 0; of abs the sign of a.
OPERATIONS: dict[float, Callable[[Any, Any, Any], tuple[Any, Any, Any]]] = {
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
    17: lambda a, b, side: (np.log(a), 1 / a, 0),
}
SIDES: dict[float, Callable[[Any, Any], Any]] = {
    9: lambda a, b: (a < b) * 1.0,
    10: lambda a, b: (a >= b) * 1.0,
    16: lambda a, b: np.where(a < 0, -1.0, 1.0),
}


def run(
    code: Sequence[float], points: np.ndarray, sides: dict[int, np.ndarray] | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Returns D (n,) and its gradient (n, axes) at points (n, axes).

    `sides` holds the branches of min, max and abs, by the position of the operation in the program.
    Branches in `sides` are kept; a missing branch is chosen at these points and added to `sides`.
    """
    sides = {} if sides is None else sides
    stack, entries, eye = [], enumerate(code), np.eye(points.shape[1])
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


def no_zero(code: Sequence[float], points: np.ndarray, half: np.ndarray) -> np.ndarray:
    """Whether D has values and no zero in boxes about points (n, axes) of half the width (n,) [m]:
    (n,), by interval arithmetic. False where that cannot tell.
    """
    stack, entries = [], enumerate(code)
    for _, op in entries:
        if op == 0:
            value = np.full(len(points), next(entries)[1])
            stack.append((value, value))
        elif op < 4:
            stack.append((points[:, int(op) - 1] - half, points[:, int(op) - 1] + half))
        else:
            b = stack.pop() if op < 11 else None
            stack.append(RANGES[op](stack.pop(), b))
    low, high = stack[0]
    return (low > 0) | (high < 0)


def among(*values: np.ndarray) -> Interval:
    """The smallest and the largest of values; infinite where one is no number."""
    finite = np.isfinite(values).all(axis=0)
    return (
        np.where(finite, np.min(values, axis=0), -np.inf),
        np.where(finite, np.max(values, axis=0), np.inf),
    )


def _quotients(a: Interval, b: Interval) -> Interval:
    whole = np.where((b[0] <= 0) & (b[1] >= 0), np.nan, 1.0)
    return among(*(x / y * whole for x in a for y in b))


def _powers(a: Interval, b: Interval) -> Interval:
    (low, high), power = a, b[0][0]
    if power > 0 and power % 2 == 0:
        ends = low**power, high**power
        return np.where((low <= 0) & (high >= 0), 0.0, np.minimum(*ends)), np.maximum(*ends)
    defined = (low > 0) | (power > 0) & ((low == 0) | (power % 2 == 1))
    return among(np.where(defined, low, np.nan) ** power, high**power)


def sines(a: Interval, shift: float = 0.0) -> Interval:
    """Bounds of sin(x + shift) for x in a: the extremes +-1 are at pi/2 + k pi."""
    low, high = a[0] + shift, a[1] + shift
    first, last = np.ceil(low / np.pi - 0.5), np.floor(high / np.pi - 0.5)
    ends, both = (np.sin(low), np.sin(high)), ~(last - first < 1)
    top, bottom = ((first <= last) & (first % 2 == k) | both for k in (0, 1))
    return np.where(bottom, -1.0, np.minimum(*ends)), np.where(top, 1.0, np.maximum(*ends))


# Each operation on intervals a (and b) returns bounds of its values, infinite if not known.
RANGES: dict[float, Callable[[Interval, Any], Interval]] = {
    4: lambda a, b: (a[0] + b[0], a[1] + b[1]),
    5: lambda a, b: (a[0] - b[1], a[1] - b[0]),
    6: lambda a, b: among(*(x * y for x in a for y in b)),
    7: _quotients,
    8: _powers,
    9: lambda a, b: (np.minimum(a[0], b[0]), np.minimum(a[1], b[1])),
    10: lambda a, b: (np.maximum(a[0], b[0]), np.maximum(a[1], b[1])),
    11: lambda a, b: (-a[1], -a[0]),
    12: lambda a, b: sines(a),
    13: lambda a, b: sines(a, np.pi / 2),
    14: lambda a, b: (np.sqrt(np.maximum(a[0], 0.0)), np.sqrt(np.maximum(a[1], 0.0))),
    15: lambda a, b: (np.exp(a[0]), np.exp(a[1])),
    16: lambda a, b: (np.maximum(0.0, np.maximum(a[0], -a[1])), np.maximum(-a[0], a[1])),
}


def _bound(code: Sequence[float], points: np.ndarray, limit: float) -> np.ndarray:
    """A lower bound (n,) [m] of the distance of points from the surface: half the width of a box
    without a zero; in general at least half of the largest such box.
    """
    half, grows = np.full(len(points), limit), no_zero(code, points, np.full(len(points), limit))
    more = grows.copy()
    while more.any():
        more[more] = no_zero(code, points[more], 2 * half[more]) & (half[more] < WIDEST * limit)
        half[more] *= 2
    more = ~grows
    while more.any():
        half[more] /= 2
        more[more] = (half[more] > 1e-12 * limit) & ~no_zero(code, points[more], half[more])
    return half


def _least_bound(code: Sequence[float], points: np.ndarray, limit: float) -> tuple[float, int]:
    """The smallest _bound() [m] of points, and the number of the first point that has it."""

    def failing_of(tested: np.ndarray, half: float) -> np.ndarray:
        """The numbers of the tested points whose boxes of half the width `half` may have a zero."""
        fails = ~no_zero(code, points[tested], np.full(len(tested), half))
        return np.compress(fails, tested)

    half, every = limit, np.arange(len(points))
    failing = failing_of(every, half)
    if not len(failing):
        while half < WIDEST * limit and not len(failing := failing_of(every, 2 * half)):
            half *= 2
        return half, int(failing[0]) if len(failing) else 0
    while len(failing):
        half, last = half / 2, failing
        failing = failing_of(failing, half) if half > 1e-12 * limit else failing[:0]
    return half, int(last[0])


def _parts(code: Sequence[float]) -> list[Sequence[float]]:
    """The programs of a, b, ... of an expression min(a, b, ...), else the whole: surfaces of solids
    whose union is the obstacle.
    """
    first, depth, entries = 0, 0, enumerate(code[:-1])
    for e, op in entries:
        depth += 1 if op < 4 else -1 if op < 11 else 0
        if op == 0:
            e, _ = next(entries, (e, 0))
        if depth == 1:
            first = e + 1
    if code[-1] != TWO["min"] or code[-2] == 0:
        return [code]
    return _parts(code[:first]) + _parts(code[first:-1])


def gap(points: np.ndarray, numbers: tuple[float, ...], bounds: bool = True) -> np.ndarray:
    """Signed distances (n,) [m] of points (n, axes) from the surface.

    Distances up to about `limit` are exact if that part of the surface is certainly the nearest.
    Others are a lower bound or, without `bounds`, D / |grad D|, the distance to first order.
    `numbers` are those that `settled` returns: limit and the program.
    """
    limit, *code = numbers
    nearest: np.ndarray = np.min(
        [_gap(points, part, limit, bounds) for part in _parts(code)], axis=0
    )
    return nearest


def _gap(points: np.ndarray, code: Sequence[float], limit: float, bounds: bool) -> np.ndarray:
    """gap() of one part."""
    gaps, value, size = _certain(points, code, limit, bounds)
    open_ = np.isnan(gaps)
    with np.errstate(all="ignore"):
        if not bounds:
            first = np.where(size < STEEPEST, value / size, np.copysign(limit, value))
            return np.where(open_, first, gaps)
        if open_.any():
            gaps[open_] = np.copysign(_bound(code, points[open_], limit), value[open_])
    return gaps


def least(points: np.ndarray, numbers: tuple[float, ...]) -> tuple[float, int]:
    """The smallest gap() [m] of points (n, axes), and the number of the point that has it."""
    limit, *code = numbers
    return min((_least(points, part, limit) for part in _parts(code)), key=lambda gap: gap[0])


def _least(points: np.ndarray, code: Sequence[float], limit: float) -> tuple[float, int]:
    """least() of one part. Of the bounds of uncertain points it finds the smallest one only."""
    gaps, value, _ = _certain(points, code, limit, True)
    open_ = np.flatnonzero(np.isnan(gaps))
    if not (value[open_] > 0).all():
        gaps = _gap(points, code, limit, True)
    elif len(open_):
        with np.errstate(all="ignore"):
            bound, first = _least_bound(code, points[open_], limit)
        gaps[open_], gaps[open_[first]] = np.inf, bound
    nearest_point = int(gaps.argmin())
    return float(gaps[nearest_point]), nearest_point


def _certain(
    points: np.ndarray, code: Sequence[float], limit: float, bounds: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Distances (n,) [m] of points from the surface, not a number where they are not certain; D and
    |grad D| (n,).
    """
    with np.errstate(all="ignore"):
        value, slope = run(code, points)
        size, gaps = np.linalg.norm(slope, axis=1), np.full(len(points), np.nan)
        near = abs(value) < limit * np.minimum(size, STEEPEST)
        if near.any():
            distance = closest(points[near], code, limit)[0]
            certain = (abs(distance) <= 2 * limit) & (
                (distance <= 0) | ~bounds | no_zero(code, points[near], distance / 2)
            )
            gaps[near] = np.where(certain, distance, np.nan)
    return gaps, value, size


def closest(
    points: np.ndarray, code: Sequence[float], limit: float
) -> tuple[np.ndarray, np.ndarray]:
    """Closest-point projection: signed distances (n,) of points (n, axes), and the closest points.

    Each iteration projects the points onto the tangent plane of D at the present closest points.
    It stops for points whose distance exceeds 2 `limit`. The first iterates lie beside the points:
    the bottom of a concave region is another fixed point of the iteration, but it is repelling
    unless it is the closest point.
    """
    at = points + BESIDE * limit * _along_surface(run(code, points)[1])
    sides: dict[int, np.ndarray] = {}
    distance = np.zeros(len(points))
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
    """Tangential directions (n, axes) at gradients (n, axes), in general not along an axis."""
    normal = _unit(slope)
    if slope.shape[1] == 2:
        return np.column_stack([normal[:, 1], -normal[:, 0]])
    return np.cross(normal, [0.36, 0.48, 0.8])


def _unit(slope: np.ndarray) -> np.ndarray:
    """The unit normals (n, axes) at gradients (n, axes)."""
    normals: np.ndarray = slope / np.linalg.norm(slope, axis=1, keepdims=True)
    return normals


def nearest(
    point: np.ndarray,
    gap: float,
    code: Sequence[float],
    limit: float,
    disc: tuple[np.ndarray, float] | None,
) -> tuple[float, np.ndarray]:
    """Gap [m] and outward normal (axes,) of the obstacle at the closest point of a body.

    `point` (axes,) is the sampled point of the body with the least gap, `gap`. Farther than `limit`
    the function returns this gap and the direction of the gradient. Nearer than `limit` it projects
    the point onto the surface. For a disc or ball, `disc` = (centre, radius), it rotates the point
    about the centre towards point = centre - radius n, n the normal at the closest point of the
    surface, by a share that is halved until the gap decreases: the whole way is too far if the
    radius exceeds the radius of curvature of the surface.
    """
    parts = _parts(code)
    if len(parts) > 1:
        code = min(parts, key=lambda part: float(_gap(point[None], part, limit, True)[0]))
    value, slope = run(code, point[None])
    if abs(value[0]) >= limit * np.linalg.norm(slope):
        return float(gap), slope[0] / np.linalg.norm(slope)
    distance, normal = _projected(point, code, limit)
    if disc is None:
        return min(gap, distance), normal
    centre, radius = disc
    share, direction = 1.0, (centre - point) / np.linalg.norm(centre - point)
    for _ in range(TURNS):
        turned = direction + share * (normal - direction)
        turned /= np.linalg.norm(turned)
        nearer, its_normal = _projected(centre - radius * turned, code, limit)
        if nearer > distance:
            share /= 2
            continue
        change, direction, distance, normal = (
            abs(turned - direction).max(),
            turned,
            nearer,
            its_normal,
        )
        if radius * change <= CLOSE * limit:
            break
    return min(gap, distance), normal


def _projected(point: np.ndarray, code: Sequence[float], limit: float) -> tuple[float, np.ndarray]:
    """Gap [m] of a point (axes,), and the unit normal at its closest point of the surface."""
    distance, on = closest(point[None], code, limit)
    slope = run(code, on)[1][0]
    return float(distance[0]), slope / np.linalg.norm(slope)


def settled(
    path: str, code: tuple[float, ...], centre: np.ndarray, half: float
) -> tuple[float, ...]:
    """Returns the numbers of an obstacle: limit [m] and the program of D.

    `limit` is a third of the smallest convex or concave radius of curvature, `half` at most, of the
    surface in a box around the `centre` (axes,) of the bodies, of half the side length `half` [m].
    If it is not there, the surface is looked for along the gradient, then in boxes of twice the
    size. Raises BadInput, with the name path.distance, if D has no value or gradient at a point, or
    if no surface is found.
    """
    cube, growth = np.random.default_rng(1).uniform(-1, 1, (SAMPLES, len(centre))), 1
    middle = centre
    while True:
        points = middle + growth * half * cube
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
            on_surface = (
                _point_of_surface(code, centre) if growth == 1 and middle is centre else None
            )
        if on_surface is not None:
            middle = on_surface
            continue
        if growth > FARTHEST:
            raise BadInput(
                f"{path}.distance: no zero was found within {growth * half:.3g} m of the bodies (accepted: an expression that is 0 "
                f"on a surface there)"
            )
        middle, growth = centre, 2 * growth
    with np.errstate(all="ignore"):
        size = np.linalg.norm(slope, axis=1)
        near = points[abs(value) < 0.1 * growth * half * size]
        on = closest(near, code, half)[1] if len(near) else near
        on = on[(abs(on - middle) <= growth * half).all(axis=1)]
        if not len(on):
            raise BadInput(
                f"{path}.distance: changes its sign near {_text(middle)} without being 0 (accepted: an expression that is "
                f"continuous, with a gradient on its surface)"
            )
        # Next to a corner the estimate depends on the step: the smaller of two estimates leaves out
        # most of these points.
        bend = np.minimum(
            *(abs(bending(code, on, step * half)).max(axis=1) for step in (1e-3, 1e-4))
        ).max(initial=0.0)
    return float(min(half, 1 / max(3 * bend, 1e-300))), *code


def _point_of_surface(code: Sequence[float], start: np.ndarray) -> np.ndarray | None:
    """A point (axes,) of the surface, by Newton's method along the gradient; None if it fails."""
    point = start.copy()
    for _ in range(10 * TURNS):
        (value,), (slope,) = run(code, point[None])
        step = value / (slope @ slope) * slope
        point -= step
        if not np.isfinite(point).all():
            return None
        if np.linalg.norm(step) <= 1e-9 * np.linalg.norm(point - start):
            return point
    return None


def bending(code: Sequence[float], points: np.ndarray, step: float) -> np.ndarray:
    """Curvatures (n, axes) [1/m] of the surface at points (n, axes) on it, positive where convex.

    Component i is the curvature along axis i projected onto the surface: the change of the normal
    between the points at -step and +step [m], divided by 2 step.
    """

    def normals(at: np.ndarray) -> np.ndarray:
        return _unit(run(code, at)[1])

    n, curvatures = normals(points), []
    for axis in np.eye(points.shape[1]):
        along = axis - n * (n @ axis)[:, None]
        # The short projection of an axis that is nearly normal to the surface is not scaled to 1.
        along /= np.maximum(np.linalg.norm(along, axis=1), 0.3)[:, None]
        curvatures.append(
            np.sum(
                along * (normals(points + step * along) - normals(points - step * along)), axis=1
            )
            / (2 * step)
        )
    known_curvatures: np.ndarray = np.nan_to_num(np.stack(curvatures, axis=1))
    return known_curvatures


def radius_at(point: np.ndarray, numbers: tuple[float, ...]) -> float:
    """The smallest radius of curvature [m] of the surface at the point closest to `point` (axes,).

    The radius is infinite where the surface is concave or flat.
    """
    limit, *code = numbers
    with np.errstate(all="ignore"):
        bend = bending(code, closest(point[None], code, limit)[1], 1e-3 * limit).max()
    return float(1 / bend) if bend * limit > 1e-6 else np.inf


def is_mirrored(code: Sequence[float], axis: int, axes: int) -> bool:
    """Whether D is symmetric about the plane through the origin that is normal to an axis.

    The values are compared at random points, to a relative 1e-10.
    """
    points = np.random.default_rng(2).normal(size=(SAMPLES, axes))
    points *= np.logspace(-4, 2, SAMPLES)[:, None]
    with np.errstate(all="ignore"):
        image = points * np.where(np.arange(axes) == axis, -1, 1)
        values, images = run(code, points)[0], run(code, image)[0]
        return np.allclose(values, images, rtol=1e-10, equal_nan=True)


def _text(point: np.ndarray) -> str:
    return "[" + ", ".join(f"{coordinate:.4g}" for coordinate in point) + "]"
