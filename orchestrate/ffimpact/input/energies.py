"""Energies of hyperelastic laws as expressions: of I1, I2, the invariants of C, and J = det F, or of
the principal stretches L1, L2, L3 and J. What they are at rest: stress, moduli. Units are SI.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..failure import BadInput
from ..geometry import implicit

__all__ = ["Energy", "FUNCTIONS", "Refused", "energy"]

FUNCTIONS = ("sqrt", "exp", "log")
INVARIANTS, STRETCHES = ("I1", "I2", "J"), ("L1", "L2", "L3")
# The programs of the variables; with stretches J is their product.
MEANINGS: dict[bool, dict[str, tuple[float, ...]]] = {
    False: {"I1": (1,), "I2": (2,), "J": (3,)},
    True: {"L1": (1,), "L2": (2,), "L3": (3,), "J": (1, 2, 6, 3, 6)},
}
ADD, SUBTRACT, TIMES, OVER, LOG = 4.0, 5.0, 6.0, 7.0, 17.0  # operations (geometry/implicit.py)
NU_OF_POINTS = 0.45  # of the part of lambda that stays at points, where J = 1
LARGEST_NU = 0.4999
# Stress at rest and lack of symmetry that are round-off, relative to the stiffness and to W.
ROUND_OFF, UNEVEN = 1e-9, 1e-10
NEAR = 0.01  # largest strain at which an energy must have values
TINY = 1e-30  # step of derivatives by complex numbers, which are exact


@dataclass(frozen=True)
class Refused(Exception):
    """An energy is not accepted: `text` is the message behind the name of the entry."""

    entry: str
    text: str


@dataclass(frozen=True)
class Energy:
    """An energy W: programs of the stack machine (geometry/implicit.py), over invariants or
    (`of_stretches`) principal stretches. `volume` is the sum of its terms of J alone, `rest` that of
    the others; either is empty if there is none.
    """

    of_stretches: bool
    volume: tuple[float, ...]
    rest: tuple[float, ...]

    @property
    def code(self) -> tuple[float, ...]:
        """The program of W."""
        return _sum(self.volume, self.rest)

    @property
    def _J(self) -> tuple[float, ...]:
        return MEANINGS[self.of_stretches]["J"]

    def _variables(self, stretches: np.ndarray) -> np.ndarray:
        """The variables (n, 3) of the programs at principal stretches (n, 3)."""
        if self.of_stretches:
            return stretches
        squares = stretches**2
        I1 = squares.sum(axis=1)
        I2 = (I1**2 - (squares**2).sum(axis=1)) / 2
        return np.column_stack([I1, I2, stretches.prod(axis=1)])

    def values(self, code: Sequence[float], stretches: np.ndarray) -> np.ndarray:
        """W (n,) [J/m3] of a program at principal stretches (n, 3)."""
        with np.errstate(all="ignore"):
            return implicit.run(code, self._variables(stretches))[0]

    def slopes(self, code: Sequence[float], stretches: np.ndarray) -> np.ndarray:
        """dW/dL (n, 3) [Pa] of a program at principal stretches (n, 3), which may be complex."""
        variables = self._variables(stretches)
        with np.errstate(all="ignore"):
            slopes = implicit.run(code, variables)[1]
            if self.of_stretches:
                return slopes
            I1, J = variables[:, [0]], variables[:, [2]]
            by_I1, by_I2, by_J = slopes.T[:, :, None]
            of_both = 2 * stretches * (by_I1 + by_I2 * (I1 - stretches**2))
            along: np.ndarray = of_both + by_J * J / stretches
            return along

    def at_rest(self, code: Sequence[float]) -> tuple[float, float, float]:
        """dW/dL1, d2W/dL1^2 and d2W/dL1 dL2 [Pa] of a program at rest."""
        if not code:
            return 0.0, 0.0, 0.0
        complex_slopes = self.slopes(code, np.ones((1, 3)) + [[1j * TINY, 0, 0]])[0]
        first, second = complex_slopes.real, complex_slopes.imag / TINY
        return float(first[0]), float(second[0]), float(second[1])

    def moduli(self, held: bool) -> tuple[float, float]:
        """lambda and mu [Pa] at rest. If J = 1 (`held`), a pressure makes the stress vanish, and lambda
        is that of points.
        """
        slope, along, across = self.at_rest(self.rest if held else self.code)
        mu = (along - across + slope) / 2
        return (2 * mu * NU_OF_POINTS / (1 - 2 * NU_OF_POINTS) if held else across), mu

    def nu(self) -> float:
        """Poisson's ratio at rest."""
        lame, mu = self.moduli(False)
        return float(np.where(abs(lame) < ROUND_OFF * mu, 0.0, lame / (2 * (lame + mu))))

    def young(self, nu: float) -> float:
        """Young's modulus [Pa] at rest, for nu() or nu = 0.5 (J = 1)."""
        return 2 * (1 + nu) * self.moduli(nu == 0.5)[1]

    def numbers(self, held: bool) -> list[float]:
        """The numbers of the law for edp/kernels/energy.hpp. If J = 1, terms of J alone have no
        part in W; terms in log J make the stress at rest vanish and set the lambda of points.
        """
        if held:
            pressure, _, across = self.at_rest(self.rest)
            more = self.moduli(True)[0] - across
            log = (*self._J, LOG)
            square = (*log, *log, TIMES, 0.0, more / 2, TIMES)
            code = (*self.rest, *log, 0.0, pressure, TIMES, SUBTRACT, *square, ADD)
            return [float(self.of_stretches), 0.0, len(code), *code]
        bulk, part = self._unit_volume()
        return [float(self.of_stretches), bulk, len(self.code), *self.code, *part]

    def _unit_volume(self) -> tuple[float, tuple[float, ...]]:
        """K and u(J) of the terms U = K u + U'(1) log J + U(1) of J alone, u''(1) = 1; 0 and nothing
        if K <= 0.
        """
        if not self.volume:
            return 0.0, ()
        place = np.ones((1, 3)) if self.of_stretches else np.array([[3.0, 3.0, 1.0]])
        which = 0 if self.of_stretches else 2
        step = 1j * TINY * np.eye(3)[which]
        values, slopes = implicit.run(self.volume, place + step)
        value, slope = float(values[0].real), float(slopes[0, which].real)
        bulk = float(slopes[0, which].imag / TINY) + slope
        if not bulk > ROUND_OFF * abs(slope):
            return 0.0, ()
        log = (*self._J, LOG, 0.0, slope, TIMES)
        return bulk, (*self.volume, *log, SUBTRACT, 0.0, value, SUBTRACT, 0.0, bulk, OVER)

    def refusal(self, nu: float | None) -> str:
        """What is not accepted of the energy with the entry nu, behind the entry's name; empty if
        nothing.
        """
        held = nu == 0.5
        near = 1 + NEAR * np.random.default_rng(1).uniform(-1, 1, (50, 3))
        code = self.rest if held else self.code
        slope, along, across = self.at_rest(code)
        tried = np.vstack([np.ones((1, 3)), near])
        numbers = np.column_stack([self.values(code, tried), self.slopes(code, tried)])
        if not np.isfinite([*numbers.ravel(), slope, along, across]).all():
            where = "L1 = L2 = L3 = 1" if self.of_stretches else "I1 = I2 = 3, J = 1"
            return f": has no value or no derivative at or near rest, {where} (accepted: an energy that has)"
        if self.of_stretches and (text := self._unsymmetric(code)):
            return text
        stiffness = max(abs(along), abs(across))
        if not held and abs(slope) > ROUND_OFF * stiffness:
            return f": has the stress {slope:.6g} Pa at rest (accepted: 0, or nu = 0.5: J = 1)"
        lame, mu = self.moduli(held)
        if not mu > 0:
            return f": has the shear modulus {mu:.6g} Pa at rest (accepted: more than 0)"
        if held:
            return ""
        if not lame + 2 / 3 * mu > 0:
            return (
                f": has the bulk modulus {lame + 2 / 3 * mu:.6g} Pa at rest (accepted: more than 0)"
            )
        if self.nu() > LARGEST_NU:
            return f": makes Poisson's ratio {self.nu():.6g} (accepted: up to {LARGEST_NU}, or nu = 0.5: J = 1)"
        return ""

    def _unsymmetric(self, code: Sequence[float]) -> str:
        points = np.random.default_rng(2).uniform(0.8, 1.25, (50, 3))
        orders = ([0, 1, 2], [1, 0, 2], [1, 2, 0])
        values, *others = (self.values(code, points[:, order]) for order in orders)
        scale = UNEVEN * (abs(values).max() + abs(self.slopes(code, points)).max())
        if all((abs(other - values) <= scale).all() for other in others):
            return ""
        return ": changes when stretches change places (accepted: symmetric in L1, L2, L3)"


def _sum(*codes: tuple[float, ...]) -> tuple[float, ...]:
    """The program of the sum of programs, of which some may be empty."""
    total: tuple[float, ...] = ()
    for code in codes:
        total = (*total, *code, ADD) if total and code else total + code
    return total


def energy(text: object, parameters: Mapping[str, float]) -> Energy:
    """The energy of an expression with parameters. Raises Refused."""
    return _energy(text, tuple(sorted(parameters.items())))


@lru_cache
def _energy(text: object, parameters: tuple[tuple[str, float], ...]) -> Energy:
    names = (*INVARIANTS, *STRETCHES, *dict(parameters))
    try:
        tree = implicit.parsed("", text, names, FUNCTIONS)
        used = _names(tree)
        of_stretches = any(name in used for name in STRETCHES)
        _refuse_names(used, dict(parameters), of_stretches)
        meanings = MEANINGS[of_stretches] | {name: (0.0, value) for name, value in parameters}
        parts: dict[bool, tuple[float, ...]] = {True: (), False: ()}
        for sign, term in _terms(tree):
            code = implicit.translated("", str(text), term, meanings, FUNCTIONS)
            code = code if sign > 0 else (0.0, -1.0, *code, TIMES)
            alone = _names(term) & {*INVARIANTS, *STRETCHES} == {"J"}
            parts[alone] = _sum(parts[alone], code)
    except BadInput as error:
        raise Refused("energy", str(error)) from None
    return Energy(of_stretches, parts[True], parts[False])


def _names(tree: ast.AST) -> set[str]:
    """The names of variables and parameters in an expression."""
    functions = {id(node.func) for node in ast.walk(tree) if isinstance(node, ast.Call)}
    return {
        node.id
        for node in ast.walk(tree)
        if isinstance(node, ast.Name) and id(node) not in functions
    } - {"pi"}


def _terms(tree: ast.expr, sign: int = 1) -> Iterator[tuple[int, ast.expr]]:
    """Yields the terms of a sum with their signs."""
    match tree:
        case ast.BinOp(left=a, op=ast.Add() | ast.Sub() as op, right=b):
            yield from _terms(a, sign)
            yield from _terms(b, sign if isinstance(op, ast.Add) else -sign)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            yield from _terms(operand, -sign)
        case _:
            yield sign, tree


def _refuse_names(used: set[str], parameters: dict[str, float], of_stretches: bool) -> None:
    """Raises Refused for names that the energy or its parameters should not have."""
    variables = (*INVARIANTS, *STRETCHES)
    for name in parameters:
        if name in (*variables, "pi", *FUNCTIONS):
            raise Refused(
                f"parameters.{name}", ": is a name of energy itself (accepted: another name)"
            )
        if name not in used:
            raise Refused(f"parameters.{name}", ": is not in energy (accepted: without it)")
    if of_stretches and used & {"I1", "I2"}:
        raise Refused(
            "energy", ": has invariants beside stretches (accepted: I1, I2, J or L1, L2, L3, J)"
        )
    for name in sorted(used - {*variables, *parameters}):
        raise Refused(
            "energy",
            f": '{name}' has no number (accepted: I1, I2, J or L1, L2, L3, J, and names in parameters)",
        )
