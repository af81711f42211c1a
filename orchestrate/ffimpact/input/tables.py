"""Tables of a scene's TOML file ([[body]], [contact] ...) read with one clear line for whatever is wrong in them."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..failure import BadInput, brief, suggestion
from .parameters import Parameter, Value

LONGEST = 1e9                # m, m/s: beyond the largest of anything
MOST = 2000                  # points of a polygon or a chain: each of its sides is held against all others
SHORTEST = 1e-9              # m


class Table:
    """The entries `given` of the table `path` ("body.2", "" at the top), of which only the keys `accepted` may be there; `elsewhere`: the
    full names of others. Every BadInput names path.key, the value and what is accepted."""

    def __init__(self, path: str, given: dict, accepted: Sequence[str], elsewhere: dict[str, str] | None = None):
        if not isinstance(given, dict):
            raise BadInput(f"{path}: '{brief(given)}' is no table (accepted: a table with {', '.join(accepted)})")
        for key, value in given.items():
            if key not in accepted:
                meant = (elsewhere or {}).get(key)
                hint = f"; did you mean {meant}?" if meant else suggestion(key, accepted)
                raise BadInput(f"{_at(path, brief(key))}: no such entry, set to '{brief(value)}'{hint} (accepted: {', '.join(accepted)})")
        self.path, self.given = path, given

    def at(self, key: str) -> str:
        """The full name of an entry."""
        return _at(self.path, key)

    def __contains__(self, key: str) -> bool:
        return key in self.given

    def parameter(self, key: str, rule: Parameter) -> Value:
        """The entry by the rule of a parameter; its default where there is none."""
        return replace(rule, name=self.at(key)).check(self.given[key]) if key in self.given else rule.default

    def number(self, key: str, low: float = SHORTEST, high: float = LONGEST, default: float | None = None) -> float:
        """A number between two bounds, a length where they are not given; required where there is no default."""
        self._wanted(key, default, f"{low:g} to {high:g}")
        return self.parameter(key, _real(low, high, default, "m" if (low, high) == (SHORTEST, LONGEST) else ""))

    def numbers(self, key: str, default: tuple[float, ...] | None = None, count: int = 2, low: float = -LONGEST,
                high: float = LONGEST) -> np.ndarray:
        """So many numbers, [x, y] or [x, y, z], between two bounds."""
        self._wanted(key, default, f"{placeholder(count)}, each {low:g} to {high:g}")
        return _vector(self.at(key), self.given.get(key, default), low, high, count)

    def lengths(self, keys: Sequence[str]) -> list[float | np.ndarray]:
        """The sizes of a shape, of semi_axes two."""
        return [self.numbers(key, low=SHORTEST) if key == "semi_axes" else self.number(key) for key in keys]

    def points(self, key: str, least: int = 3) -> np.ndarray:
        """At least so many points [x, y], (n, 2) in m."""
        self._wanted(key, None, f"{least} points [x, y] or more")
        return _points(self.at(key), self.given[key], least)

    def polygons(self, key: str) -> list[np.ndarray]:
        """A list of polygons, [] where there is none."""
        given = self.given.get(key, [])
        if not isinstance(given, list):
            raise BadInput(f"{self.at(key)}: '{brief(given)}' is no list of polygons (accepted: [[[x, y], ...], ...])")
        return [_points(f"{self.at(key)}.{k}", one, 3) for k, one in enumerate(given, 1)]

    def flag(self, key: str, default: bool) -> bool:
        """true or false."""
        given = self.given.get(key, default)
        if not isinstance(given, bool):
            raise BadInput(f"{self.at(key)}: '{brief(given)}' is neither true nor false (accepted: true|false)")
        return given

    def text(self, key: str, default: str) -> str:
        given = self.given.get(key, default)
        if not isinstance(given, str):
            raise BadInput(f"{self.at(key)}: '{brief(given)}' is no text (accepted: text in quotes)")
        return given

    def _wanted(self, key: str, default, accepted: str) -> None:
        if key not in self.given and default is None:
            raise BadInput(f"{self.at(key)}: is missing (accepted: {accepted})")


def listed(given: dict, key: str) -> list[dict]:
    """The tables [[key]] of a file, [] where there are none."""
    tables = given.get(key, [])
    if not isinstance(tables, list):
        raise BadInput(f"{key}: '{brief(tables)}' is no list of tables (accepted: [[{key}]])")
    for k, table in enumerate(tables, 1):
        if not isinstance(table, dict):
            raise BadInput(f"{key}.{k}: '{brief(table)}' is no table (accepted: [[{key}]])")
    return tables


def _at(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key


def _real(low: float, high: float, default: float | None = None, unit: str = "") -> Parameter:
    return Parameter("", "real", default, unit, "", low, high)


def placeholder(count: int) -> str:
    """A point, in the words of messages."""
    return f"[{', '.join('xyz'[:count])}]"


def _vector(path: str, given, low: float, high: float, count: int = 2) -> np.ndarray:
    if not isinstance(given, list | tuple) or len(given) != count:
        raise BadInput(f"{path}: '{brief(given)}' is no {placeholder(count)} (accepted: {('two', 'three')[count - 2]} numbers, each "
                       f"{low:g} to {high:g})")
    return np.array([replace(_real(low, high), name=f"{path}.{k}").check(value) for k, value in enumerate(given, 1)])


def _points(path: str, given, least: int) -> np.ndarray:
    if not isinstance(given, list) or len(given) < least:
        raise BadInput(f"{path}: '{brief(given)}' is too little (accepted: {least} points [x, y] or more)")
    if len(given) > MOST:
        raise BadInput(f"{path}: {len(given)} points (accepted: {least} to {MOST})")
    return np.array([_vector(f"{path}.{k}", point, -LONGEST, LONGEST) for k, point in enumerate(given, 1)])
