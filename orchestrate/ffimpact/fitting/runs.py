"""The runs of a fit: of each experiment at many points, each made once. Units are SI."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from .. import flight
from ..failure import BadInput, Failure, brief
from ..input.parameters import Table, Value
from ..output.errors import errors
from ..output.results import read_record
from ..scene import Scene
from ..scenes.entries import dependents
from ..sweeps.study import place, study
from .curves import Array
from .experiments import Experiment
from .likelihood import STATED
from .predictions import DENT, DERIVED, check_units, drag_of, features, observed

__all__ = ["Runs", "checked_free"]

MOVES = ("body.1.velocity", "body.1.speed")  # entries that a speed sets
# Entries that change the error of a run, not what runs
NUMERICS = (
    "accuracy",
    "tolerance",
    "mesh_size",
    "contact_mesh_size",
    "mesh_stretch",
    "dt",
    "degree",
    "fields",
)
MESHED = ("mesh_size", "contact_mesh_size")
TRACKED = 200  # states that a run keeps for a track
LIMIT = 600.0  # largest time of a run [s]
REST = (
    1 / 3
)  # of an error in proportion to the accuracy remains so much of the change by a finer run
# Errors relative to the restitution's of numbers that follow from it
POWER = {"rebound_height": 2.0, "interval_ratio": 1.0}


class Runs:
    """The runs of experiments, each made once, in a `folder`. `air` is its density [kg/m3].

    `fixed` are, for each experiment, its entries with the mesh of a first run, so that answers change
    smoothly with the free entries. `stated` (m,) are the errors of elements and steps of what is
    measured, relative to its size, as the runs estimate them: STATED standard errors. Where there is no
    estimate, the accuracy is taken. correct() corrects all by finer runs: `factors` and `offsets` (m,).
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
            _check_free(experiment, set(centre))
        self.cores, self.air = cores, air
        self.gravity = scene.number("gravity") or flight.GRAVITY  # of the flights before and after
        self.features_by_point: dict[tuple[int, tuple[Value, ...]], Array | None] = {}
        self.made, self.unanswered = 0, Counter[str]()  # runs, and by message those without answer
        still = [{**centre, **e.entries, "fields": 0} for e in self.experiments]
        firsts = self._study(still, estimate=False)
        # what the scene sets, such as a step, stays set while the free entries change
        self.own: list[dict[str, Value]] = [
            dependents(scene.content, [*centre, *e.entries])
            | {"fields": _states(e)}
            | dict(e.entries)
            | self._velocity(e, first)
            for e, first in zip(self.experiments, firsts)
        ]
        rows = self._study([entries | dict(centre) for entries in self.own], estimate=True)
        self.accuracy = scene.number("accuracy")
        self.fixed: list[dict[str, Value]] = []
        self.first_stated: list[Array] = []
        for experiment, entries, row in zip(self.experiments, self.own, rows):
            self._need(row)
            where = place(self.folder, entries | dict(centre))
            self.fixed.append(entries | _meshes(where))
            stated = _relative_errors(experiment, where)
            self.first_stated.append(np.where(np.isnan(stated), STATED * self.accuracy, stated))
            own = features(
                experiment, row, where, self.gravity, self.air
            )  # raises for unknown names
            check_units(experiment, own)
        self.begin(self.experiments)

    def begin(self, experiments: Sequence[Experiment]) -> None:
        """Begins again without corrections, by experiments that measured the same otherwise."""
        self.experiments, self.stated = list(experiments), list(self.first_stated)
        self.factors = [np.ones(len(e.values)) for e in self.experiments]
        self.offsets = [np.zeros(len(e.values)) for e in self.experiments]
        self.finer: float | None = None  # accuracy of the runs that correct

    def with_experiments(
        self, experiments: Sequence[Experiment], centre: Mapping[str, Value]
    ) -> Runs:
        """The runs of other experiments with the same scene, in the same folder, corrected at `centre` as
        these are.
        """
        other = Runs(self.scene, experiments, self.folder, centre, cores=self.cores, air=self.air)
        if self.finer:
            other.correct(centre, self.finer)
        return other

    def observed(self, i: int, predicted: Array) -> Array:
        """What is measured in an experiment, (p, m), from features (p, f), corrected."""
        return observed(self.experiments[i], predicted) * self.factors[i] + self.offsets[i]

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
                own, why = None, str(row["message"])
                try:
                    own = self._features(i, row, entries) if row["exit"] == 0 else None
                except BadInput as error:  # such as a dent of a body that has not yielded
                    why = str(error)
                self.features_by_point[i, key] = own
                if own is None:
                    self.unanswered[why] += 1
        listed = iter(wanted)
        return [
            [self.features_by_point[next(listed)[:2]] for _ in points] for _ in self.experiments
        ]

    def _features(self, i: int, row: Table, entries: dict[str, Value]) -> Array:
        """The features of a run. Raises BadInput if it has none, such as of a ball that stays."""
        where = place(self.folder, entries)
        own = features(self.experiments[i], row, where, self.gravity, self.air)
        if not np.isfinite(own).all():
            raise BadInput("a number has no value")
        return own

    def fine(self, i: int, point: Mapping[str, Value], accuracy: float) -> tuple[Array, Array]:
        """What a run with elements and steps of this accuracy predicts for an experiment (m,), and the
        relative errors that it states, NaN where there is none.
        """
        experiment = self.experiments[i]
        entries = self.own[i] | dict(point) | {"accuracy": accuracy}
        row = self._study([entries], estimate=True)[0]
        self._need(row)
        where = place(self.folder, entries)
        predicted = features(experiment, row, where, self.gravity, self.air)
        return observed(experiment, predicted[None])[0], _relative_errors(experiment, where)

    def correct(self, point: Mapping[str, Value], accuracy: float) -> list[str]:
        """Corrects all predictions by what finer runs at a point change. Returns notes on numbers that
        change by more than was stated, and on runs that fail.
        """
        notes, self.finer = [], accuracy
        for i, (experiment, (coarse,)) in enumerate(zip(self.experiments, self.answers([point]))):
            try:
                if coarse is None:
                    raise Failure("the run with the scene's accuracy has no answer")
                fine, stated = self.fine(i, point, accuracy)
            except Failure as failure:
                notes.append(f"{experiment!r}: not corrected by a finer run: {failure}")
                continue
            before = observed(experiment, coarse[None])[0]
            change = fine - before
            notes += _surprises(experiment, change, fine, self.first_stated[i])
            rest = STATED * _rest(experiment, change) / experiment.sizes(fine)
            # by a factor what has one sign, the coefficients of a curve together by a sum
            scaled = fine * before > 0
            scaled[len(experiment.numbers) :] = False
            self.factors[i] = np.where(scaled, fine / np.where(scaled, before, 1.0), 1.0)
            self.offsets[i] = np.where(scaled, 0.0, change)
            self.stated[i] = np.where(np.isnan(stated), rest, stated)
        return notes

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

    def _velocity(self, experiment: Experiment, first: Table) -> dict[str, Value]:
        """The entries that give the first body the speed of an experiment, by a first run."""
        self._need(first)
        speed = experiment.speed
        if experiment.height is not None:
            drag = drag_of(first, self.air)
            speed = flight.speed_of_fall(experiment.height, self.gravity, drag)
        if speed is None:
            return {}
        velocity = self.scene.content["body"][0].get("velocity")
        if velocity is None:
            return {"body.1.speed": speed}
        size = abs(velocity) if isinstance(velocity, int | float) else math.hypot(*velocity)
        if size == 0:
            raise BadInput(
                "experiment: speed of a body without velocity (accepted: a scene in which body 1 moves)"
            )
        if isinstance(velocity, int | float):  # along the axis
            return {"body.1.velocity": math.copysign(speed, velocity)}
        return {f"body.1.velocity.{k}": speed * v / size for k, v in enumerate(velocity, 1) if v}


def _rest(experiment: Experiment, change: Array) -> Array:
    """The standard errors (m,) that remain after a correction by a change (m,): of a coefficient of a
    curve by the change of all, as one may be small by chance.
    """
    square = change**2
    for at in experiment.parts:
        square[at] = (square[at] + np.mean(square[at])) / 2
    return np.asarray(REST * np.sqrt(square))


def _surprises(experiment: Experiment, change: Array, fine: Array, stated: Array) -> list[str]:
    """Notes on numbers that a finer run changes by more than was stated."""
    return [
        f"{number.name} of {experiment!r}: a finer run gives {own:.5g}, {100 * abs(by / own):.2g} % off, "
        f"where {100 * share:.2g} % was stated: a smaller accuracy is needed"
        for number, by, own, share in zip(experiment.numbers, change, fine, stated)
        if abs(by) > share * abs(own) + 0.3 * number.error
    ]


def _check_free(experiment: Experiment, free: set[str]) -> None:
    """Raises BadInput if an experiment sets what is free."""
    taken = set(experiment.entries) & free
    if experiment.speed is not None or experiment.height is not None:
        taken |= {name for name in free if name.startswith(MOVES)}
    if taken:
        raise BadInput(
            f"experiment: {taken.pop()} is free (accepted: set by the experiments, or free)"
        )


def _states(experiment: Experiment) -> int:
    """The number of states that a run keeps for an experiment."""
    if any(curve.marker for curve in experiment.curves):
        return TRACKED
    return 2 if any(DENT.fullmatch(number.name) for number in experiment.numbers) else 0


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
    """The estimated relative errors of the numbers (m,), NaN where there is none, as of curves."""
    record = read_record(where)
    estimated = errors(record)

    def relative(name: str) -> float:
        like = "restitution" if name in DERIVED else name
        if like not in estimated or not record.summary.get(like):
            return math.nan
        return float(POWER.get(name, 1.0) * estimated[like] / abs(record.summary[like]))

    of_curves = [math.nan for curve in experiment.curves for _ in curve.basis]
    return np.array([relative(number.name) for number in experiment.numbers] + of_curves)


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
        if not isinstance(name, str) or name.rpartition(".")[2] in NUMERICS:
            raise BadInput(f"free: {brief(name)} (accepted: entries of the mechanics)")
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
