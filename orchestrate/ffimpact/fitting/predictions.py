"""What runs of a scene predict for experiments. Units are SI."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from .. import flight
from ..failure import BadInput, unknown
from ..input.dimension import AXISYMMETRIC
from ..input.parameters import Table
from ..output.results import force_times, numbers, read_history, read_record
from ..output.states import Fields
from .curves import WINDOW, Array, Curve, pulse
from .experiments import Experiment

__all__ = ["DENT", "DERIVED", "check_units", "drag_of", "features", "named", "observed", "samples"]

PULSE = np.linspace(-1.5 * WINDOW, 1.5 * WINDOW, 181)  # times of a pulse over its deviation
UNLIKE = 30.0  # ratio of a pulse's width or height to a run's from which on its unit is wrong
# Numbers of how a run went
OF_RUNS = re.compile("seconds|memory|bytes|iterations|factorizations|evaluations|steps|drift|dofs")
DENT = re.compile(r"dent_(depth|radius)(?:_([0-9]+))?")  # of the body of this number


def drag_of(row: Table, air: float) -> float:
    """The drag [1/m] of a ball with the mass and the size of the first body of a run in air of this
    density.
    """
    if not row.get("mass") or not row.get("reach"):
        return 0.0
    return flight.drag_of(row["mass"], row["reach"], air)


def _rebound_height(row: Table, gravity: float, air: float) -> float:
    """The height [m] to which the first body rises after the impact, in air."""
    drag = drag_of(row, air)
    return flight.rise(max(row["rebound_vy"], 0.0), gravity, drag)


def _interval_ratio(row: Table, gravity: float, air: float) -> float:
    """The interval between the sounds of an impact and the next over the interval before it. An
    interval is a contact and a flight with drag. The next contact is taken to last as long.
    """
    after, drag = float(row["rebound_vy"]), drag_of(row, air)
    before, contact = after / row["restitution"], float(row["contact_time"])
    flights = (
        flight.duration(after, gravity, drag),
        flight.duration(flight.start_of(before, gravity, drag), gravity, drag),
    )
    return (flights[0] + contact) / (flights[1] + contact)


DERIVED: dict[str, Callable[[Table, float, float], float]] = {
    "rebound_height": _rebound_height,
    "interval_ratio": _interval_ratio,
}


def _fields(where: Path) -> Fields:
    summary = read_record(where).summary
    revolution = summary["provenance"]["script"] == AXISYMMETRIC.script
    return Fields(where, revolution, summary.get("symmetric_along", ()))


def features(experiment: Experiment, row: Table, where: Path, gravity: float, air: float) -> Array:
    """What is interpolated between runs: the numbers; for each force its duration and its values at
    PULSE of it, for other curves the values at the measured times. Raises BadInput for unknown names.
    """
    names = [number.name for number in experiment.numbers]
    parts = [np.array([_predicted(name, row, where, gravity, air) for name in names])]
    if experiment.curves:
        history, used = read_history(where), read_record(where).scene
        mean_times = force_times(history, used.get("integrator"))
        for curve in experiment.curves:
            if curve.marker:
                parts.append(_moved(curve, where))
                continue
            if curve.name not in history:
                raise BadInput(f"experiment: {unknown(curve.name, sorted(history), ', ')}")
            times = mean_times if "force" in curve.name else history["t"]
            parts.append(_sampled(curve, times, history[curve.name], float(history["t"][-1])))
    return np.concatenate(parts)


def _predicted(name: str, row: Table, where: Path, gravity: float, air: float) -> float:
    if dented := DENT.fullmatch(name):
        return float(getattr(_fields(where).dent(int(dented[2] or 1)), dented[1]))
    if name in DERIVED:
        try:
            return DERIVED[name](row, gravity, air)
        except (KeyError, TypeError):
            raise BadInput(
                f"experiment: {name} needs a body that rebounds from an obstacle"
            ) from None
    if name not in row or not isinstance(row[name], int | float) or OF_RUNS.search(name):
        own = [other for other in numbers(read_record(where).summary) if not OF_RUNS.search(other)]
        accepted = [*own, *DERIVED, "dent_depth_1", "dent_radius_1"]
        raise BadInput(f"experiment: {unknown(name, accepted, ', ')}")
    return float(row[name])


def _check_times(what: str, times: Array, end: float) -> None:
    """Raises BadInput if times that count from the start of a run go beyond its end."""
    if times[-1] > end * (1 + 1e-9):
        raise BadInput(
            f"experiment: {what} is measured from {times[0]:g} to {times[-1]:g} s, the run ends at {end:g} s "
            "(accepted: t from the start of the run on, a later end_time)"
        )


def _moved(curve: Curve, where: Path) -> Array:
    """The ways of a marker along an axis since the first measured time."""
    body, point = curve.marker or (1, ())
    seen = _fields(where).probe(point, body)
    _check_times("track", curve.times, float(seen["t"].iloc[-1]))
    at: Array = np.interp(curve.times, seen["t"], seen[curve.name])
    return np.asarray(at - at[0])


def _sampled(curve: Curve, times: Array, values: Array, end: float) -> Array:
    if not curve.pulse:
        _check_times(curve.name, curve.times, end)
        # from the middle of the last step to its end
        ahead = (end - times[-1]) * (values[-1] - values[-2]) / (times[-1] - times[-2])
        longer = np.append(times, end), np.append(values, values[-1] + ahead)
        at_times: Array = np.interp(curve.times, *longer)
        return at_times
    if not values.max() > 0:
        raise BadInput(
            f"experiment: {curve.name} is nowhere positive (accepted: a force that presses)"
        )
    centre, width = pulse(times, values)
    return np.append(width, np.interp(centre + width * PULSE, times, values, left=0.0, right=0.0))


def _of_curves(experiment: Experiment, predicted: Array) -> Iterator[tuple[Curve, Array]]:
    """Each curve with its features (p, .)."""
    at = len(experiment.numbers)
    for curve in experiment.curves:
        size = len(PULSE) + 1 if curve.pulse else len(curve.times)
        yield curve, predicted[:, at : at + size]
        at += size


def samples(experiment: Experiment, predicted: Array) -> list[Array]:
    """Each curve at its times, (p, n), from features (p, f)."""
    curves = []
    for curve, part in _of_curves(experiment, predicted):
        if curve.pulse:
            rows = [
                np.interp(curve.times / own[0], PULSE, own[1:], left=0.0, right=0.0) for own in part
            ]
            part = np.array(rows)
        curves.append(part)
    return curves


def check_units(experiment: Experiment, predicted: Array) -> None:
    """Raises BadInput if a pulse is far longer or larger than that of a run with the features (f,)."""
    for curve, part in _of_curves(experiment, predicted[None]):
        if not curve.pulse:
            continue
        width, largest = pulse(curve.times, curve.samples)[1], float(curve.samples.max())
        for what, measured, run in (
            ("width in s", width, float(part[0, 0])),
            ("largest value", largest, float(part[0, 1:].max())),
        ):
            if not 1 / UNLIKE < measured / run < UNLIKE:
                raise BadInput(
                    f"{curve.name}: its {what} is {measured:.3g}, that of a first run {run:.3g}: is its unit right? "
                    f"(accepted: up to {UNLIKE:g} times as large)"
                )


def observed(experiment: Experiment, predicted: Array) -> Array:
    """What is measured, (p, m), from features (p, f)."""
    curves = zip(experiment.curves, samples(experiment, predicted))
    coefficients = [part @ curve.basis.T for curve, part in curves]
    return np.hstack([predicted[:, : len(experiment.numbers)], *coefficients])


def named(experiment: Experiment) -> list[str]:
    """The name of each measured value, in the order of `observed`."""
    return [n.name for n in experiment.numbers] + [
        c.name for c in experiment.curves for _ in c.basis
    ]
