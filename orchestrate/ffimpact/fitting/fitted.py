"""The outcome of a fit: entries with intervals, predictions, further experiments. Units are SI."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from ..failure import BadInput
from ..scene import Scene
from ..sweeps.study import unit_of
from .emulator import Scales
from .experiments import LIKE_BEFORE, Experiment
from .likelihood import COVERED, covariance
from .predictions import Runs, named
from .search import Found

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["Fit", "confirmed", "questions"]

TOGETHER = 0.98  # correlation above which two entries are known only together
REFUSED = 0.01  # probability of so large a chi2 below which the model is refused
FINER = 4.0  # the last runs have the accuracy of the scene over this


class Fit:
    """The outcome of fit().

    `table`: for each free entry its value, the ends of its interval of 95 % (profile likelihood),
    unit, and `known`: yes, or why it has no value. `correlation`: of the entries (of their logarithms
    if these were varied). `measurements`: each measured value with its prediction and the errors of
    both. `chi2`, `freedom`, `p`: how well the runs agree. `notes`: what was left out or is to be
    questioned. `start` is the scene as it was, `settings` the other arguments, `runs` and `seconds`
    what the fit took.
    """

    def __init__(self, scales: Scales, runs: Runs, outcome: Found, settings: dict[str, Any]):
        self.scales, self.laboratory, self.outcome, self.settings = scales, runs, outcome, settings
        self.start, self.experiments = runs.scene, runs.experiments
        self.seconds, self.runs = 0.0, runs.made
        self.chi2 = outcome.least
        known_before = int(np.isfinite(outcome.likelihood.priors[:, 1]).sum())
        self.freedom = len(outcome.predicted) + known_before - len(scales.names)
        tested = 0 if settings.get("robust") else self.freedom
        self.p = _probability(self.chi2, tested)
        self.notes: list[str] = []
        spread = np.linalg.inv(outcome.information)
        sizes = np.sqrt(np.diag(spread))
        self.correlation = pd.DataFrame(spread / np.outer(sizes, sizes), scales.names, scales.names)
        self.table = self._entries()
        self.measurements = self._measurements()

    @property
    def best(self) -> dict[str, float]:
        """The most likely values, of entries that are not known too."""
        return self.scales.entries(self.outcome.best)

    @property
    def verdict(self) -> str:
        """What chi2 says of the model."""
        if self.settings.get("robust"):
            return (
                f"robust: chi2 {self.chi2:.3g} of {self.freedom} degrees of freedom is not tested"
            )
        if self.freedom < 1 and self.chi2 > COVERED:
            return f"the model is refused: as many values as free entries, and still chi2 {self.chi2:.3g}"
        if self.freedom < 1:
            return "as many values as free entries: they cannot refuse the model"
        words = f"chi2 {self.chi2:.3g} of {self.freedom} degrees of freedom, p = {self.p:.2g}"
        return (
            f"the model is refused: {words}"
            if self.p < REFUSED
            else f"the model is not refused: {words}"
        )

    @property
    def scene(self) -> Scene:
        """The scene with the most likely values."""
        return self.start.override(dict(self.best))

    def _entries(self) -> pd.DataFrame:
        rows = []
        best, names = self.scales.values(self.outcome.best), self.scales.names
        for k, (name, profile) in enumerate(zip(names, self.outcome.profiles)):
            low, high = (
                math.nan if end is None else float(self.scales.values(np.full(len(names), end))[k])
                for end in (profile.low, profile.high)
            )
            others = [
                other
                for other in names
                if other != name and abs(self.correlation.loc[name, other]) > TOGETHER
            ]
            status = "yes"
            if math.isnan(low) and math.isnan(high):
                status = "no: every value between the bounds agrees with the data"
            elif math.isnan(low) or math.isnan(high):
                status = f"only {'below' if math.isnan(low) else 'above'} {high if math.isnan(low) else low:.4g}"
            elif others:
                status = f"only together with {', '.join(others)}"
            value = best[k] if status == "yes" else math.nan
            rows.append(
                {"value": value, "low": low, "high": high, "unit": unit_of(name), "known": status}
            )
        return pd.DataFrame(rows, index=pd.Index(names, name="entry"))

    def _measurements(self) -> pd.DataFrame:
        rows = []
        runs, k = self.laboratory, 0
        variance = self.outcome.likelihood
        coarse = np.sqrt(np.diag(np.linalg.inv(variance.root.T @ variance.root)))
        for number, experiment in enumerate(runs.experiments, 1):
            own = [n.error for n in experiment.numbers] + [
                c.error for c in experiment.curves for _ in c.times
            ]
            for name, value, error in zip(named(experiment), experiment.values, own):
                predicted = float(self.outcome.predicted[k])
                model = math.sqrt(max(coarse[k] ** 2 - error**2, 0.0))
                rows.append(
                    {
                        "experiment": experiment.name or number,
                        "number": name,
                        "measured": value,
                        "error": error,
                        "predicted": predicted,
                        "model_error": model,
                        "off": (value - predicted) / coarse[k],
                    }
                )
                k += 1
        return pd.DataFrame(rows)

    def listed(self) -> str:
        """The measurements as text; of a curve the root mean square of its deviations."""
        numbers = [n.name for e in self.experiments for n in e.numbers]
        own = self.measurements["number"].isin(numbers)
        words = self.measurements[own].to_string(index=False, float_format=lambda x: f"{x:.5g}")
        lines = [words] if own.any() else []
        for (k, name), part in self.measurements[~own].groupby(["experiment", "number"]):
            size = math.sqrt(float((part["off"] ** 2).mean()))
            lines.append(
                f"experiment {k}: {name} at {len(part)} times, off by {size:.2g} errors (rms)"
            )
        return "\n".join(lines)

    def predict(
        self,
        entries: Mapping[str, Any] | None = None,
        names: Sequence[str] | str = ("restitution",),
        *,
        speed: float | None = None,
        height: float | None = None,
        accuracy: float | None = None,
    ) -> pd.DataFrame:
        """What the fitted scene, with other entries, predicts: for each of the numbers `names` value,
        the error (95 %) by the entries that are fitted, that of elements and steps, and the ends of both.

        Runs at the most likely values and at one standard error along each axis of their covariance.
        """
        chosen = [names] if isinstance(names, str) else list(names)
        wanted: dict[str, Any] = {name: (None, 1.0) for name in chosen}
        asked = Experiment(entries, speed=speed, height=height, **wanted)
        runs, at = self.laboratory.with_experiments([asked], self.best), self.outcome.best
        values, vectors = np.linalg.eigh(np.linalg.inv(self.outcome.information))
        axes = [np.sqrt(value) * vector for value, vector in zip(values, vectors.T)]
        points = [at, *(side for axis in axes for side in (at + axis, at - axis))]
        inside = [self.scales.entries(np.clip(point, 0, 1)) for point in points]
        answers = runs.answers(inside)[0]
        if any(answer is None for answer in answers):
            raise BadInput("predict: a run within the covariance of the entries does not end")
        predicted = np.array(answers)
        # the larger of both sides, as one may be cut off by a bound
        away = np.maximum(*(np.abs(predicted[k::2] - predicted[0]) for k in (1, 2)))
        parameters = 1.96 * np.sqrt((away**2).sum(axis=0))
        value, stated = runs.fine(0, self.best, accuracy or self.accuracy)
        rows = [
            {
                "value": v,
                "error": p,
                "model_error": m * abs(v),
                "low": v - p - m * abs(v),
                "high": v + p + m * abs(v),
            }
            for v, p, m in zip(value, parameters, np.nan_to_num(stated))
        ]
        return pd.DataFrame(rows, index=pd.Index(chosen, name="number"))

    @property
    def accuracy(self) -> float:
        return float(self.start.number("accuracy"))

    def next(self, candidates: Sequence[Experiment] | Experiment) -> pd.DataFrame:
        """What each of the candidates would add: the standard error of each free entry with it over that
        without. Only the errors of their measurements count; values may be None. Best first.
        """
        candidates = [candidates] if isinstance(candidates, Experiment) else list(candidates)
        runs, at, box = (
            self.laboratory.with_experiments(candidates, self.best),
            self.outcome.best,
            self.outcome.box,
        )
        step = np.minimum(0.5 * box.spacing, 0.05)
        sides = [np.clip(at + sign * d, 0, 1) for d in np.diag(step) for sign in (1, -1)]
        answers = runs.answers([self.scales.entries(side) for side in sides])
        before = np.sqrt(np.diag(np.linalg.inv(self.outcome.information)))
        rows = []
        for i, experiment in enumerate(candidates):
            if any(answer is None for answer in answers[i]):
                raise BadInput(f"{experiment!r}: a run near the fitted values does not end")
            seen = runs.observed(i, np.array(answers[i]))
            width = np.array([sides[2 * k][k] - sides[2 * k + 1][k] for k in range(len(at))])
            slope = (seen[0::2] - seen[1::2]) / width[:, None]
            measured = experiment.expecting(seen.mean(axis=0))
            noise = covariance([measured], [runs.stated[i]], measured.values)
            more = self.outcome.information + slope @ np.linalg.solve(noise, slope.T)
            rows.append(np.sqrt(np.diag(np.linalg.inv(more))) / before)
        index = pd.Index([repr(experiment) for experiment in candidates], name="experiment")
        table = pd.DataFrame(rows, index, self.scales.names)
        return table.iloc[np.argsort(table.prod(axis=1).to_numpy())]

    def compare(self, *others: Fit) -> pd.DataFrame:
        """This fit beside others of the same measurements: chi2, p, and the criteria of Akaike and of
        Schwarz, less the least of them.
        """
        rows = []
        for other in (self, *others):
            values = len(other.measurements)
            if values != len(self.measurements) or not np.allclose(
                other.measurements.measured, self.measurements.measured
            ):
                raise BadInput(
                    "compare: the fits are of different measurements (accepted: of the same)"
                )
            root = other.outcome.likelihood.root
            fits = other.chi2 - 2 * float(np.log(np.diag(root)).sum())
            count = len(other.scales.names)
            akaike, schwarz = fits + 2 * count, fits + math.log(values) * count
            rows.append(
                {
                    "chi2": other.chi2,
                    "freedom": other.freedom,
                    "p": other.p,
                    "aic": akaike,
                    "bic": schwarz,
                }
            )
        table = pd.DataFrame(
            rows, index=pd.Index([", ".join(f.scales.names) for f in (self, *others)], name="free")
        )
        table[["aic", "bic"]] -= table[["aic", "bic"]].min()
        return table

    def save(self, folder: str | Path, figure: bool = True) -> None:
        """Writes fit.json, entries.csv, measurements.csv, the fitted scene.toml, figures/fit.png, and
        fit.toml with start.toml, with which `ffimpact fit` makes the fit again.
        """
        from .record import write

        write(self, Path(folder))
        if figure:
            from ..report.figures import save

            (Path(folder) / "figures").mkdir(exist_ok=True)
            save(self.plot(), Path(folder) / "figures" / "fit.png")

    def plot(self) -> Figure:
        """Draws the profiles of the entries, and what was measured beside what is predicted."""
        from ..report.fit import draw

        return draw(self)

    @property
    def profiles(self) -> dict[str, pd.DataFrame]:
        """For each entry the rise of chi2 over its value, at the best of the others."""
        count, drawn = len(self.scales.names), {}
        for k, (name, profile) in enumerate(zip(self.scales.names, self.outcome.profiles)):
            at = np.tile(profile.at[:, None], count)
            drawn[name] = pd.DataFrame(
                {"value": self.scales.values(at)[:, k], "rise": profile.rise}
            )
        return drawn

    def __repr__(self) -> str:
        rows = self.table.copy()
        for name in ("value", "low", "high"):
            rows[name] = ["-" if math.isnan(v) else f"{v:.4g}" for v in rows[name]]
        lines = [rows.to_string(), self.verdict, *(f"  {note}" for note in self.notes)]
        return "\n".join([*lines, f"{self.runs} runs, {self.seconds:.3g} s"])


def questions(made: Fit, experiments: list[Experiment]) -> list[str]:
    """What is to be questioned in the data."""
    notes = []
    for row in made.measurements.itertuples():
        if (
            row.predicted > 0
            and not 1 / LIKE_BEFORE < row.measured / row.predicted < LIKE_BEFORE
            and abs(row.off) > 5
        ):
            notes.append(
                f"{row.number} of experiment {row.experiment} is {row.measured:.4g}, predicted {row.predicted:.4g}: is its unit right?"
            )
    seen: dict[tuple[str, str], Any] = {}
    for e in experiments:
        for number in e.numbers:
            key = (repr((sorted(e.entries.items()), e.speed, e.height)), number.name)
            other = seen.setdefault(key, number)
            if abs(other.value - number.value) > 5 * math.hypot(other.error, number.error):
                notes.append(
                    f"{number.name}: {other.value:.4g} and {number.value:.4g} in two experiments that are alike contradict each other"
                )
    for k, (value, error) in enumerate(made.outcome.likelihood.priors):
        if abs(made.outcome.best[k] - value) > 3 * error:
            name = made.scales.names[k]
            notes.append(
                f"{name}: {made.best[name]:.4g} is far from what was known beforehand: is it another material?"
            )
    for row in made.measurements.itertuples():
        if made.freedom < 1 and abs(row.off) > 3:
            notes.append(
                f"{row.number} of experiment {row.experiment} is off by {abs(row.off):.2g} errors: no values between the bounds agree"
            )
    table = made.measurements
    if (table.model_error > table.error).mean() > 0.5:
        notes.append(
            "errors of elements and steps exceed those of most measurements: a smaller accuracy narrows the intervals"
        )
    for at, (name, row) in zip(made.outcome.best, made.table.iterrows()):
        if min(at, 1 - at) < 1e-3 and row["known"] == "yes":
            notes.append(
                f"{name}: the best value is at a bound, {made.best[str(name)]:.4g}: are the bounds right?"
            )
    return notes[:12]


def confirmed(made: Fit) -> list[str]:
    """Notes on numbers that finer runs at the fitted values change by more than was stated."""
    notes, runs = [], made.laboratory
    k = 0
    for i, experiment in enumerate(runs.experiments):
        fine, _ = runs.fine(i, made.best, made.accuracy / FINER)
        for n, number in enumerate(experiment.numbers):
            coarse, stated = made.outcome.predicted[k + n], runs.stated[i][n]
            if abs(coarse - fine[n]) > np.nan_to_num(stated) * abs(fine[n]) + 0.3 * number.error:
                notes.append(
                    f"{number.name} of {experiment!r}: a finer run gives {fine[n]:.5g} for {coarse:.5g}, more than stated "
                    f"({100 * stated:.2g} %): a smaller accuracy is needed"
                )
        k += len(experiment.values)
    return notes


def _probability(chi2: float, freedom: int) -> float:
    """The probability of a chi2 as large or larger."""
    from scipy.special import gammaincc  # takes long to load

    return float(gammaincc(freedom / 2, chi2 / 2)) if freedom > 0 else math.nan
