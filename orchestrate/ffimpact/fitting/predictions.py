"""What runs of a scene predict for experiments. Units are SI."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np

from .. import flight
from ..failure import BadInput, Failure, brief, unknown
from ..input.dimension import AXISYMMETRIC
from ..input.parameters import Table, Value
from ..output.errors import errors
from ..output.results import force_times, numbers, read_history, read_record
from ..output.states import Fields
from ..scene import Scene
from ..scenes.entries import dependents
from ..sweeps.study import place, study
from .experiments import Array, Curve, Experiment, crossing

__all__ = ["DERIVED", "Runs", "checked_free", "features", "named", "observed"]

PULSE = np.linspace(0, 1, 41)  # times of a force over its duration
DENT = re.compile(r"dent_(depth|radius)(?:_([0-9]+))?")  # of the body of this number
MESHED = ("mesh_size", "contact_mesh_size")
TRACKED = 200  # states that a run keeps for a track
LIMIT = 600.0  # largest time of a run [s]
# Errors relative to the restitution's of numbers that follow from it
POWER = {"rebound_height": 2.0, "interval_ratio": 1.0}


def _rebound_height(row: Table, gravity: float, drag: float) -> float:
    """The height [m] to which the first body rises after the impact, in air."""
    return flight.rise(max(row["rebound_vy"], 0.0), gravity, drag)


def _interval_ratio(row: Table, gravity: float, drag: float) -> float:
    """The interval between the sounds of an impact and the next over the interval before it. An
    interval is a contact and a flight with drag. The next contact is taken to last as long.
    """
    after = float(row["rebound_vy"])
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


class Runs:
    """The runs of experiments, each made once, in a `folder`. The drag of the air is that of a ball
    with the mass and the size of the first body.

    `fixed` are, for each experiment, its entries with the mesh of a first run, so that answers change
    smoothly with the free entries. `stated` are the relative errors of elements and steps of what is
    measured, estimated in this first run.
    """

    def __init__(
        self,
        scene: Scene,
        experiments: Sequence[Experiment],
        folder: Path,
        centre: Mapping[str, Value],
        *,
        cores: int,
        air: float = flight.AIR,
    ):
        self.scene, self.experiments, self.folder = scene, list(experiments), folder
        for experiment in self.experiments:
            if both := set(experiment.entries) & set(centre):
                raise BadInput(
                    f"experiment: {both.pop()} is free (accepted: set by the experiments, or free)"
                )
        self.cores, self.air, self.gravity, self.drag = cores, air, flight.GRAVITY, 0.0
        self.features_by_point: dict[tuple[int, tuple[Value, ...]], Array | None] = {}
        self.made = 0
        first = self._study([{**centre, "fields": 0}], estimate=False)[0]
        self._need(first)
        if first.get("mass") and first.get("reach"):
            self.drag = flight.drag_of(first["mass"], first["reach"], air)
        # what the scene sets, such as a step, stays set while the free entries change
        self.own: list[dict[str, Value]] = [
            dependents(scene.content, [*centre, *e.entries])
            | {"fields": _states(e)}
            | dict(e.entries)
            | self._velocity(e)
            for e in self.experiments
        ]
        rows = self._study([entries | dict(centre) for entries in self.own], estimate=True)
        self.fixed: list[dict[str, Value]] = []
        self.stated: list[Array] = []
        for experiment, entries, row in zip(self.experiments, self.own, rows):
            self._need(row)
            where = place(self.folder, entries | dict(centre))
            self.fixed.append(entries | _meshes(where))
            self.stated.append(_relative_errors(experiment, where))
            features(experiment, row, where, self.gravity, self.drag)  # raises for unknown names

    def with_experiments(
        self, experiments: Sequence[Experiment], centre: Mapping[str, Value]
    ) -> Runs:
        """The runs of other experiments with the same scene, in the same folder."""
        return Runs(self.scene, experiments, self.folder, centre, cores=self.cores, air=self.air)

    def observed(self, i: int, predicted: Array) -> Array:
        """What is measured in an experiment, (p, m), from features (p, f)."""
        return observed(self.experiments[i], predicted)

    def answers(self, points: Sequence[Mapping[str, Value]]) -> list[list[Array | None]]:
        """For each experiment the features at the points; None where a run failed."""
        wanted = [
            (i, tuple(point.values()), dict(self.fixed[i]) | dict(point))
            for i in range(len(self.experiments))
            for point in points
        ]
        missing = [item for item in wanted if item[:2] not in self.features_by_point]
        if missing:
            rows = self._study([entries for *_, entries in missing], estimate=False)
            for (i, key, entries), row in zip(missing, rows):
                self.features_by_point[i, key] = (
                    self._features(i, row, entries) if row["exit"] == 0 else None
                )
        listed = iter(wanted)
        return [
            [self.features_by_point[next(listed)[:2]] for _ in points] for _ in self.experiments
        ]

    def _features(self, i: int, row: Table, entries: dict[str, Value]) -> Array | None:
        """The features of a run; None if it has no answer, such as a ball that stays."""
        where = place(self.folder, entries)
        try:
            own = features(self.experiments[i], row, where, self.gravity, self.drag)
        except BadInput:  # such as a dent of a body that has not yielded
            return None
        return own if np.isfinite(own).all() else None

    def fine(self, i: int, point: Mapping[str, Value], accuracy: float) -> tuple[Array, Array]:
        """What a run with elements and steps of this accuracy predicts for an experiment, and the
        relative errors that it states.
        """
        experiment = self.experiments[i]
        entries = self.own[i] | dict(point) | {"accuracy": accuracy}
        row = self._study([entries], estimate=True)[0]
        self._need(row)
        where = place(self.folder, entries)
        predicted = features(experiment, row, where, self.gravity, self.drag)
        return observed(experiment, predicted[None])[0], _relative_errors(experiment, where)

    def _study(self, points: list[dict[str, Value]], estimate: bool) -> list[Table]:
        table = study(points, self.folder, {}, LIMIT, self.scene, self.cores, estimate)
        self.made += int((~table["reused"].astype(bool)).sum())
        return [dict(row) for row in table.to_dict("records")]

    @staticmethod
    def _need(row: Table) -> None:
        if row["exit"] == BadInput.code:
            raise BadInput(str(row["message"]))
        if row["exit"] != 0:
            raise Failure(f"the first run of the fit: {row['message']}", code=int(row["exit"]))

    def _velocity(self, experiment: Experiment) -> dict[str, Value]:
        """The entries that give the first body the speed of an experiment."""
        speed = experiment.speed
        if experiment.height is not None:
            speed = flight.speed_of_fall(experiment.height, self.gravity, self.drag)
        if speed is None:
            return {}
        velocity = self.scene.content["body"][0].get("velocity")
        if velocity is None:
            return {"body.1.speed": speed}
        if isinstance(velocity, int | float):  # along the axis
            return {"body.1.velocity": math.copysign(speed, velocity)}
        size = math.hypot(*velocity)
        if size == 0:
            raise BadInput(
                "experiment: speed of a body without velocity (accepted: a scene in which body 1 moves)"
            )
        return {f"body.1.velocity.{k}": speed * v / size for k, v in enumerate(velocity, 1) if v}


def _states(experiment: Experiment) -> int:
    """The number of states that a run keeps for an experiment."""
    if any(curve.marker for curve in experiment.curves):
        return TRACKED
    return 2 if any(DENT.fullmatch(number.name) for number in experiment.numbers) else 0


def _fields(where: Path) -> Fields:
    summary = read_record(where).summary
    revolution = summary["provenance"]["script"] == AXISYMMETRIC.script
    return Fields(where, revolution, summary.get("symmetric_along", ()))


def _meshes(where: Path) -> dict[str, Value]:
    """The sizes of elements that a run has used, by dotted names."""
    bodies = read_record(where).scene["body"]
    return {
        f"body.{k}.{name}": body[name]
        for k, body in enumerate(bodies, 1)
        if body.get("shape") != "mesh"
        for name in MESHED
        if body.get(name)
    }


def _relative_errors(experiment: Experiment, where: Path) -> Array:
    """The estimated relative errors of the numbers, and of scale and duration of the curves; NaN where
    there is none.
    """
    record = read_record(where)
    estimated = errors(record)

    def relative(name: str) -> float:
        like = "restitution" if name in DERIVED else name
        if like not in estimated or not record.summary.get(like):
            return math.nan
        return float(POWER.get(name, 1.0) * estimated[like] / abs(record.summary[like]))

    of_curves = [
        relative(name) if curve.onset else math.nan
        for curve in experiment.curves
        for name in ("peak_force", "contact_time")
    ]
    return np.array([relative(number.name) for number in experiment.numbers] + of_curves)


def features(experiment: Experiment, row: Table, where: Path, gravity: float, drag: float) -> Array:
    """What is interpolated between runs: the numbers; for each force its duration and its values at
    PULSE of it, for other curves the values at the measured times. Raises BadInput for unknown names.
    """
    names = [number.name for number in experiment.numbers]
    parts = [np.array([_predicted(name, row, where, gravity, drag) for name in names])]
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


def _predicted(name: str, row: Table, where: Path, gravity: float, drag: float) -> float:
    if dented := DENT.fullmatch(name):
        return float(getattr(_fields(where).dent(int(dented[2] or 1)), dented[1]))
    if name in DERIVED:
        try:
            return DERIVED[name](row, gravity, drag)
        except (KeyError, TypeError):
            raise BadInput(
                f"experiment: {name} needs a body that rebounds from an obstacle"
            ) from None
    if name not in row or not isinstance(row[name], int | float):
        raise BadInput(
            f"experiment: {unknown(name, [*numbers(read_record(where).summary), *DERIVED, 'dent_depth_1', 'dent_radius_1'], ', ')}"
        )
    return float(row[name])


def _moved(curve: Curve, where: Path) -> Array:
    """The ways of a marker along an axis since the first measured time."""
    body, point = curve.marker or (1, ())
    seen = _fields(where).probe(point, body)
    if curve.times[-1] > seen["t"].iloc[-1] * (1 + 1e-9):
        raise BadInput(
            f"experiment: track is measured to {curve.times[-1]:g} s, the run ends at {seen['t'].iloc[-1]:g} s "
            "(accepted: a later end_time)"
        )
    at: Array = np.interp(curve.times, seen["t"], seen[curve.name])
    return np.asarray(at - at[0])


def _sampled(curve: Curve, times: Array, values: Array, end: float) -> Array:
    if not curve.onset:
        if curve.times[-1] > end * (1 + 1e-9):
            raise BadInput(
                f"experiment: {curve.name} is measured to {curve.times[-1]:g} s, the run ends at {end:g} s "
                "(accepted: a later end_time)"
            )
        # from the middle of the last step to its end
        ahead = (end - times[-1]) * (values[-1] - values[-2]) / (times[-1] - times[-2])
        longer = np.append(times, end), np.append(values, values[-1] + ahead)
        at_times: Array = np.interp(curve.times, *longer)
        return at_times
    largest = float(values.max())
    if largest <= 0:
        raise BadInput(
            f"experiment: {curve.name} is nowhere positive (accepted: a force that presses)"
        )
    start = crossing(times, values, curve.onset * largest)
    over = values > curve.onset * largest
    # the force is followed a quarter longer than it lasts above the onset
    duration = (float(times[np.flatnonzero(over)[-1]]) - start) * 1.25
    return np.append(duration, np.interp(start + duration * PULSE, times, values, right=0.0))


def observed(experiment: Experiment, predicted: Array) -> Array:
    """What is measured, (p, m), from features (p, f)."""
    n = len(experiment.numbers)
    columns, at = [predicted[:, :n]], n
    for curve in experiment.curves:
        size = len(PULSE) + 1 if curve.onset else len(curve.times)
        part = predicted[:, at : at + size]
        at += size
        if curve.onset:
            part = np.array(
                [np.interp(curve.times / own[0], PULSE, own[1:], right=0.0) for own in part]
            )
        columns.append(part)
    return np.hstack(columns)


def named(experiment: Experiment) -> list[str]:
    """The name of each measured value, in the order of `observed`."""
    return [n.name for n in experiment.numbers] + [
        c.name for c in experiment.curves for _ in c.times
    ]


def checked_free(
    scene: Scene, free: Mapping[str, Sequence[float]]
) -> dict[str, tuple[float, float]]:
    """The free entries with their bounds. Raises BadInput if the scene does not accept one."""
    if not isinstance(free, Mapping) or not free:
        raise BadInput('free: nothing is free (accepted: {"body.1.young": (1e6, 1e8)})')
    if len(free) > 5:
        raise BadInput(f"free: {len(free)} entries (accepted: up to 5)")
    bounds = {}
    for name, pair in free.items():
        if not isinstance(pair, tuple | list) or len(pair) != 2:
            raise BadInput(f"free: {name}: '{brief(pair)}' (accepted: lowest and highest value)")
        try:
            low, high = (float(value) for value in pair)
        except (TypeError, ValueError):
            raise BadInput(f"free: {name}: '{brief(pair)}' (accepted: two numbers)") from None
        if not (math.isfinite(low) and math.isfinite(high) and low < high):
            raise BadInput(
                f"free: {name}: {low:g} to {high:g} (accepted: two numbers, the lower first)"
            )
        for value in (low, high):
            scene.override({name: value})
        bounds[name] = (low, high)
    return bounds
