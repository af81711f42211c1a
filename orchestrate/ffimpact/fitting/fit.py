"""Materials from measurements: fit() seeks the values of free entries of a scene with which its runs
agree with experiments. Units are SI.

    drops = [ff.Experiment(speed=2.2, restitution=(0.895, 0.002), contact_time=(4.1e-4, 1e-5))]
    fit = ff.fit(scene, {"body.1.young": (1e7, 1e9), "body.1.loss": (0.01, 0.5)}, drops)
    fit.table, fit.measurements, fit.scene
"""

from __future__ import annotations

import hashlib
import json
import math
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .. import flight
from ..failure import BadInput, brief, unknown
from ..freefem import freefem
from ..places import RESULTS
from ..progress import muted
from ..scene import Scene
from .curves import Array
from .emulator import Scales
from .experiments import Experiment
from .fitted import Fit
from .questions import questions
from .runs import Runs, checked_free
from .search import search

__all__ = ["fit"]

FAR = 3.0  # errors beyond its bounds up to which a prior is accepted
FINER = 4.0  # finer runs have the accuracy of the scene over this


def fit(
    scene: Scene | str | Path,
    free: Mapping[str, Sequence[float]],
    experiments: Sequence[Experiment] | Experiment,
    entries: Mapping[str, Any] | None = None,
    *,
    priors: Mapping[str, Sequence[float]] | None = None,
    robust: bool = False,
    air: float = flight.AIR,
    confirm: bool = True,
    workers: int | None = None,
    out: str | Path | None = None,
    progress: bool | None = None,
) -> Fit:
    """Returns the values of the `free` entries, each between two bounds, with which the runs of a scene
    agree with the `experiments`.

    Runs at the nodes of a grid between the bounds are interpolated; the grid is narrowed around what
    is likely. Errors of measurements, of elements and steps and of the interpolation enter the
    likelihood. priors: for an entry its value and standard error as known beforehand. robust: large
    deviations count linearly. air: its density [kg/m3], for the drag in rebound_height,
    interval_ratio and height. confirm: finer runs at the best values correct the others. Runs are kept
    in the folder `out`: an interrupted fit goes on, with the same numbers. Raises the exceptions of run().
    """
    started = time.monotonic()
    _check_arguments(entries, air, workers, out)
    loaded = scene if isinstance(scene, Scene) else Scene.load(scene)
    loaded = (loaded.ready(loaded.name) if isinstance(scene, Scene) else loaded).override(
        dict(entries or {})
    )
    every = [experiments] if isinstance(experiments, Experiment) else list(experiments or ())
    scales = Scales(checked_free(loaded, free))
    _check(every, scales, priors)
    content = json.dumps([loaded.content, scales.names], sort_keys=True, default=str)
    folder = (
        Path(out)
        if out
        else RESULTS / f"{loaded.name}-fit-{hashlib.sha256(content.encode()).hexdigest()[:8]}"
    )
    with muted(progress is False):
        centre = scales.entries(np.full(len(scales.names), 0.5))
        known_before = _priors(scales, priors)
        runs = Runs(loaded, every, folder, centre, cores=workers or freefem.CORES, air=air)
        finer = loaded.number("accuracy") / FINER if confirm else None
        outcome = search(runs, scales, known_before, robust, finer)
        settings = {"free": {name: list(pair) for name, pair in scales.bounds.items()}}
        settings |= {"priors": {name: list(pair) for name, pair in (priors or {}).items()}}
        made = Fit(scales, runs, outcome, settings | {"robust": robust, "air": air})
        made.notes += outcome.notes + questions(made)
    made.seconds, made.runs = time.monotonic() - started, runs.made
    return made


def _check_arguments(entries: Any, air: Any, workers: Any, out: Any) -> None:
    if entries is not None and not isinstance(entries, Mapping):
        raise BadInput(f"entries: '{brief(entries)}' (accepted: a table of entries)")
    if isinstance(air, bool) or not isinstance(air, int | float) or not 0 <= air < math.inf:
        raise BadInput(f"air: '{brief(air)}' (accepted: 0 or above, in kg/m3)")
    if workers is not None and (type(workers) is not int or workers < 1):
        raise BadInput(f"workers: '{brief(workers)}' (accepted: 1, 2 ...)")
    if out is not None and (not isinstance(out, str | Path) or Path(out).is_file()):
        raise BadInput(f"out: '{brief(out)}' (accepted: the path of a folder)")


def _check(experiments: list[Experiment], scales: Scales, priors: Mapping[str, Any] | None) -> None:
    if not experiments or not all(isinstance(e, Experiment) for e in experiments):
        raise BadInput("experiments: nothing was measured (accepted: a list of Experiment)")
    for e in experiments:
        for number in e.numbers:
            if math.isnan(number.value):
                raise BadInput(f"{number.name}: has no value (accepted: the measured value)")
    values = sum(len(e.values) for e in experiments)
    if values + len(priors or {}) < len(scales.names):
        raise BadInput(
            f"free: {len(scales.names)} entries by {values} measured values (accepted: as many values)"
        )


def _priors(scales: Scales, priors: Mapping[str, Sequence[float]] | None) -> Array:
    """Coordinate and standard error (k, 2) of what is known beforehand."""
    table = np.column_stack([np.zeros(len(scales.names)), np.full(len(scales.names), np.inf)])
    for name, pair in (priors or {}).items():
        if name not in scales.names:
            raise BadInput(f"priors: {unknown(name, scales.names, ', ')}")
        value, error = _pair(name, pair)
        low = scales.bounds[name][0]
        if value <= 0 and scales.logarithmic[scales.names.index(name)]:
            raise BadInput(
                f"priors: {name}: {value:g} (accepted: above 0, as its bounds from {low:g} on)"
            )
        at = scales.coordinates(scales.entries(np.full(len(scales.names), 0.5)) | {name: value})
        k = scales.names.index(name)
        beside = scales.values(at + 1e-4 * np.eye(len(at))[k])[k]
        table[k] = at[k], error / ((beside - value) / 1e-4)
        if not -FAR < at[k] / table[k, 1] or not (at[k] - 1) / table[k, 1] < FAR:
            raise BadInput(
                f"priors: {name}: {value:g} +- {error:g} is beyond its bounds, {low:g} to {scales.bounds[name][1]:g}"
            )
    return table


def _pair(name: str, pair: Any) -> tuple[float, float]:
    """Value and standard error of a prior."""
    try:
        value, error = (float(number) for number in pair)
    except (TypeError, ValueError):
        raise BadInput(
            f"priors: {name}: '{brief(pair)}' (accepted: value and standard error)"
        ) from None
    if not (math.isfinite(value) and 0 < error < math.inf):
        raise BadInput(
            f"priors: {name}: {value:g}, {error:g} (accepted: a number, and an error above 0)"
        )
    return value, error
