"""Experiments: changes of a scene with what was measured. Units are SI.

Experiment(speed=2.2, restitution=(0.895, 0.002), contact_time=(4.1e-4, 1e-5))
Experiment(height=0.8, rebound_height={"values": [0.637, 0.640, 0.636]})
Experiment({"body.1.mass": 0.5}, normal_force={"file": "force.csv", "error": 2.0})
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from .. import repeats
from ..failure import BadInput, Unreadable, brief, unknown
from ..input.parameter import plain
from ..recording import Bounces
from .curves import Array, Curve, as_measured

__all__ = ["Experiment", "Number"]

NUMBER = ("value", "values", "error", "common")  # accepted in the table of a number,
TRACK = ("file", "table", "error", "point", "body", "scale")  # of a marker
CURVE = ("file", "table", "error", "common", "start")  # and of a curve
STARTS = ("onset", "clock")
PULSES = ("normal_force", "normal_load")  # curves of one impact, which begin with it
SHARES = ("restitution", "interval_ratio")  # numbers between 0 and 1
POSITIVE = ("contact_time", "peak_force", "impulse", "rebound_height")  # numbers above 0


@dataclass(frozen=True)
class Number:
    """A measured number: `value` with its standard error; `common` is the standard error that all
    numbers of this name share, such as that of a scale.
    """

    name: str
    value: float
    error: float
    common: float = 0.0


class Experiment:
    """A change of the scene and what was measured then.

    entries: entries of the scene by dotted names. speed [m/s] of the first body, or height [m] from
    which it fell. Each measured number has the name that it has in a result, or is interval_ratio,
    rebound_height, or dent_depth_2 or dent_radius_2 of body 2; each curve that of a column of the
    history; track is a marker on a body.

    A number is a pair (value, standard error), or a table with value and error, or with the `values`
    of repeats, whose median and spread are taken; `common` is an error that all numbers of a name
    share. A curve is a table with a `file` (CSV with the columns t [s] and that of its name) and
    `error`; its `common` is relative. The file of a track has the columns t and x, y (, z), `error` is in
    their unit, `scale` this unit in m, `point` its place from the centre of mass on [m].

    Raises BadInput or Unreadable.
    """

    def __init__(
        self,
        entries: Mapping[str, Any] | None = None,
        *,
        speed: float | None = None,
        height: float | None = None,
        name: str = "",
        **measured: Any,
    ):
        if not isinstance(entries or {}, Mapping):
            raise BadInput(f"experiment: '{brief(entries)}' is no table of entries of the scene")
        if speed is not None and height is not None:
            raise BadInput("experiment: speed beside height (accepted: one of them)")
        for word, value in (("speed", speed), ("height", height)):
            if value is not None and not 0 < _number(f"experiment: {word}", value) < math.inf:
                raise BadInput(f"experiment: {word}: {brief(value)} (accepted: above 0)")
        if not measured:
            raise BadInput(
                "experiment: nothing is measured (accepted: restitution=(0.9, 0.01) ...)"
            )
        if not isinstance(name, str):
            raise BadInput(f"experiment: name: '{brief(name)}' (accepted: words)")
        if wrong := [entry for entry in entries or {} if not isinstance(entry, str)]:
            raise BadInput(f"experiment: '{brief(wrong[0])}' is no entry of the scene")
        self.entries: dict[str, Any] = plain(dict(entries or {}))
        self.speed, self.height, self.name = speed, height, name
        self.numbers: list[Number] = []
        self.curves: list[Curve] = []
        self.tables: dict[str, dict[str, Any]] = {}  # of the curves, as they were measured
        for word, what in measured.items():
            if word == "track":
                self.curves += _track(what)
                self.tables[word] = _listed(what, _read(("t",), what)[1])
            elif isinstance(what, Mapping) and {"file", "table"} & set(what):
                where, table = _read(("t", word), what)
                self.tables[word] = _listed(what, table[["t", word]])
                self.curves.append(_curve(word, what, where, table))
            else:
                self.numbers.append(_measured(word, what))

    @classmethod
    def of_bounces(cls, drop: Bounces) -> list[Experiment]:
        """An experiment with the ratio of two intervals for each bounce that ff.bounces() has a
        restitution of. Its error is that of the intervals, and what the restitutions scatter more, as
        by roughness and spin.
        """
        if not isinstance(drop, Bounces):
            raise BadInput(f"of_bounces: '{brief(drop)}' (accepted: what ff.bounces() returns)")
        heard = drop.table.dropna(subset=["restitution"])
        ratios, errors = heard["restitution"].to_numpy(), heard["error"].to_numpy()
        spread = repeats.scatter(heard["speed"].to_numpy(), ratios, errors)
        if math.isinf(spread):
            raise BadInput("of_bounces: one restitution (accepted: two or more)")
        # the ratio of the intervals contains the contact, whose time the runs know
        return [
            cls(speed=speed, interval_ratio=(ratio, ratio / own * math.hypot(error, spread)))
            for speed, ratio, own, error in zip(heard["speed"], heard["ratio"], ratios, errors)
        ]

    def __repr__(self) -> str:
        words = [f"{name} = {value}" for name, value in self.entries.items()]
        words += [f"speed = {self.speed:g} m/s"] if self.speed else []
        words += [f"height = {self.height:g} m"] if self.height else []
        return self.name or ", ".join(words) or "as the scene"

    @property
    def asked(self) -> str:
        """The experiment with what it measures, in words."""
        words = [f"{number.name} +- {number.error:.3g}" for number in self.numbers]
        return f"{self!r}: {', '.join([*words, *(curve.name for curve in self.curves)])}"

    @property
    def values(self) -> Array:
        """All that was measured, (m,): the numbers, then the curves."""
        return np.concatenate(
            [[number.value for number in self.numbers], *(c.values for c in self.curves)]
        )

    @property
    def parts(self) -> list[slice]:
        """Where the values of each curve are among all."""
        ends = len(self.numbers) + np.cumsum([0] + [len(c.basis) for c in self.curves])
        return [slice(int(begin), int(end)) for begin, end in zip(ends, ends[1:])]

    def sizes(self, predicted: Array) -> Array:
        """The sizes (m,) of predicted values (m,): of the coefficients of a curve their root mean
        square.
        """
        size = np.abs(predicted)
        for at in self.parts:
            size[at] = np.sqrt(np.mean(predicted[at] ** 2))
        return size


def _number(where: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float | np.number):
        raise BadInput(f"{where}: '{brief(value)}' is no number")
    return float(value)


def _measured(name: str, what: Any) -> Number:
    """A number as it is given: a pair, or a table."""
    if isinstance(what, tuple | list) and len(what) == 2:
        what = {"value": what[0], "error": what[1]}
    if not isinstance(what, Mapping):
        raise BadInput(f"{name}: '{brief(what)}' (accepted: value and standard error, or a table)")
    for word in what:
        if word not in NUMBER:
            raise BadInput(f"{name}: {unknown(word, NUMBER, ', ')}")
    if ("value" in what) == ("values" in what):
        raise BadInput(f"{name}: {brief(dict(what))} (accepted: value with error, or values)")
    common = _number(f"{name}.common", what.get("common", 0.0))
    if "values" in what:
        value, error = _of_repeats(name, what["values"])
        error = math.hypot(error, _number(f"{name}.error", what.get("error", 0.0)))
    elif "error" not in what:
        raise BadInput(f"{name}: has no error (accepted: error, the standard error of the value)")
    else:
        value = math.nan if what["value"] is None else _number(f"{name}.value", what["value"])
        error = _number(f"{name}.error", what["error"])
        if what["value"] is not None and not math.isfinite(value):
            raise BadInput(f"{name}: {value} is no measured value (accepted: a finite number)")
    if not 0 < error < math.inf or not 0 <= common < math.inf:
        raise BadInput(
            f"{name}: error {error:g}, common {common:g} (accepted: error above 0, common from 0 on)"
        )
    if name in SHARES and not math.isnan(value) and not 0 < value <= 1:
        raise BadInput(f"{name}: {value:g} (accepted: above 0, up to 1)")
    if name in POSITIVE and value <= 0:
        raise BadInput(f"{name}: {value:g} (accepted: above 0)")
    return Number(name, value, error, common)


def _of_repeats(name: str, values: Any) -> tuple[float, float]:
    """Median of repeats and its standard error."""
    try:
        several = np.asarray(values, dtype=float).ravel()
    except (TypeError, ValueError):
        several = np.empty(0)
    if len(several) < 3 or not np.isfinite(several).all():
        raise BadInput(f"{name}: values = {brief(values)} (accepted: three finite numbers or more)")
    return repeats.middle(several)


def _curve(name: str, what: Mapping[str, Any], where: str, table: pd.DataFrame) -> Curve:
    for word in what:
        if word not in CURVE:
            raise BadInput(f"{name}: {unknown(word, CURVE, ', ')}")
    if "error" not in what:
        raise BadInput(f"{name}: has no error (accepted: error, the standard error of a value)")
    error, common = (_number(f"{name}.{word}", what.get(word, 0.0)) for word in ("error", "common"))
    if not 0 < error < math.inf or not 0 <= common < 1:
        raise BadInput(
            f"{name}: error {error:g}, common {common:g} (accepted: error above 0, common 0 to 1)"
        )
    start = what.get("start", "onset" if name.startswith(PULSES) else "clock")
    if start not in STARTS:
        raise BadInput(f"{name}.start: {unknown(start, STARTS)}")
    times, values = table["t"].to_numpy(float), table[name].to_numpy(float)
    for column, numbers in (("t", times), (name, values)):
        if not np.isfinite(numbers).all():
            row = int(np.flatnonzero(~np.isfinite(numbers))[0]) + 1
            raise BadInput(f"{where}: row {row} of {column} is no number")
    if len(times) < 4 or (np.diff(times) <= 0).any():
        raise BadInput(
            f"{where}: {len(times)} times (accepted: 4 or more, each later than the one before)"
        )
    if start == "clock" and times[0] < 0:
        raise BadInput(
            f"{where}: t begins at {times[0]:g} s (accepted: 0 or later, the start of the run, or start = 'onset')"
        )
    return as_measured(name, times, values, error, common, aligned=start == "onset")


def _listed(what: Mapping[str, Any], table: pd.DataFrame) -> dict[str, Any]:
    """A curve as it was given, with its table in place of the file."""
    own = {name: value for name, value in what.items() if name != "file"}
    return plain(own | {"table": table.to_dict("list")})  # type: ignore[no-any-return]


def _track(what: Any) -> list[Curve]:
    """The curves of a marker on a body, one for each measured axis."""
    if not isinstance(what, Mapping) or not {"file", "table"} & set(what):
        raise BadInput(f"track: '{brief(what)}' (accepted: a table with file, error, point)")
    for word in what:
        if word not in TRACK:
            raise BadInput(f"track: {unknown(word, TRACK, ', ')}")
    if "error" not in what or "point" not in what:
        raise BadInput("track: has no error or no point (accepted: both, in m)")
    error, scale, body = (_number(f"track.{w}", what.get(w, 1)) for w in ("error", "scale", "body"))
    try:
        point = np.asarray(what["point"], dtype=float)
    except (TypeError, ValueError):
        point = np.empty(0)
    if point.ndim != 1 or len(point) not in (2, 3) or not 0 < error < math.inf or scale == 0:
        raise BadInput(
            f"track: point {brief(what['point'])}, error {error:g}, scale {scale:g} (accepted: two or three "
            "coordinates, error above 0, scale in m for a unit of the file)"
        )
    where, table = _read(("t",), what)
    axes = [axis for axis in "xyz" if axis in table]
    columns = table[["t", *axes]].to_numpy(float)
    if not axes or not np.isfinite(columns).all() or len(table) < 4:
        raise BadInput(
            f"{where}: {len(table)} rows of {', '.join(table)} (accepted: 4 or more of t, x, y in numbers)"
        )
    if (np.diff(columns[:, 0]) <= 0).any() or columns[0, 0] < 0:
        raise BadInput(
            f"{where}: times do not increase from 0 on (accepted: each later than the one before)"
        )
    curves = []
    for axis, values in zip(axes, columns[:, 1:].T):
        marker = (int(body), tuple(point.tolist()))
        ways = abs(scale) * error
        curves.append(as_measured(axis, columns[:, 0], scale * values, ways, marker=marker))
    return curves


def _read(names: tuple[str, ...], what: Mapping[str, Any]) -> tuple[str, pd.DataFrame]:
    """The table of a curve with the columns `names`, and how messages name it."""
    if "table" in what and "file" in what:
        raise BadInput(f"{names[-1]}: file beside table (accepted: one of them)")
    if "table" in what:
        where = names[-1]
        try:
            table = pd.DataFrame(what["table"])
        except (TypeError, ValueError) as error:
            raise BadInput(f"{where}: is no table: {brief(str(error))}") from None
    else:
        path = Path(str(what["file"]))
        where = str(path)
        try:
            table = pd.read_csv(path)
        except (OSError, ValueError) as error:
            why = getattr(error, "strerror", None) or brief(str(error))
            raise Unreadable(f"{path} cannot be read: {why} (accepted: a CSV file)") from None
    if missing := [column for column in names if column not in table]:
        raise BadInput(
            f"{where}: has no column {', '.join(missing)} (accepted: {', '.join(names)}, t in s)"
        )
    return where, table.apply(pd.to_numeric, errors="coerce")
