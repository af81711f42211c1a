"""The outcome of a fit: entries with intervals, predictions, further experiments. Units are SI."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from ..failure import BadInput, brief
from ..scene import Scene
from ..sweeps.study import unit_of
from .emulator import Scales
from .experiments import Experiment
from .likelihood import UNIFORM, Profile, covariance
from .predictions import named, samples
from .runs import Runs
from .search import Found

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["Fit"]

TOGETHER = 0.98  # correlation above which two entries are known only together
ALONE = 0.9  # of an interval's width is what was known before: the data add little
LARGE = 6.635  # chi2 of one degree of freedom with this probability:
REFUSED = 0.01  # probability of so large a chi2 below which the model is refused


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
        # only what the data determine takes degrees of freedom
        bounds = UNIFORM * np.linalg.inv(outcome.information)
        taken = len(scales.names) - round(float(np.trace(bounds)))
        self.freedom = len(outcome.predicted) + known_before - taken
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
    def refused(self) -> bool:
        """Whether chi2 refuses the model."""
        if self.settings.get("robust"):
            return False
        return self.chi2 > LARGE if self.freedom < 1 else self.p < REFUSED

    @property
    def verdict(self) -> str:
        """What chi2 says of the model."""
        if self.settings.get("robust"):
            return (
                f"robust: chi2 {self.chi2:.3g} of {self.freedom} degrees of freedom is not tested"
            )
        if self.freedom < 1 and self.refused:
            return f"the model is refused: as many values as free entries, and still chi2 {self.chi2:.3g}"
        if self.freedom < 1:
            return "as many values as free entries: they cannot refuse the model"
        words = f"chi2 {self.chi2:.3g} of {self.freedom} degrees of freedom, p = {self.p:.2g}"
        return (
            f"the model is refused: {words}"
            if self.refused
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
            status = self._status(k, profile, low, high)
            value = best[k] if status.startswith("yes") else math.nan
            rows.append(
                {"value": value, "low": low, "high": high, "unit": unit_of(name), "known": status}
            )
        return pd.DataFrame(rows, index=pd.Index(names, name="entry"))

    def _status(self, k: int, profile: Profile, low: float, high: float) -> str:
        """Whether entry k is known, and if not, why."""
        names = self.scales.names
        related = self.correlation[names[k]].abs() > TOGETHER
        others = [name for name in names if related[name] and name != names[k]]
        if profile.low is None and profile.high is None:
            return "no: every value between the bounds agrees with the data"
        if profile.low is None or profile.high is None:
            return f"only below {high:.4g}" if profile.low is None else f"only above {low:.4g}"
        if len(profile.parts) > 1:
            ends = (
                self.scales.values(np.array([np.full(len(names), end) for end in part]))[:, k]
                for part in profile.parts
            )
            return "no: one of " + ", ".join(f"{a:.4g} to {b:.4g}" for a, b in ends)
        if others:
            return f"only together with {', '.join(others)}"
        before = 2 * 1.96 * self.outcome.likelihood.priors[k, 1]
        if self.refused:
            return "yes, if the refused model were true"
        alone = profile.high - profile.low > ALONE * before
        return "yes, from before: the data add little" if alone else "yes"

    def _measurements(self) -> pd.DataFrame:
        rows = []
        runs, k = self.laboratory, 0
        total = np.diag(self.outcome.likelihood.variance)
        for number, experiment in enumerate(runs.experiments, 1):
            own = [math.hypot(n.error, n.common) for n in experiment.numbers]
            for curve in experiment.curves:
                shared = curve.common * curve.values
                own += np.sqrt(np.diag(curve.noise) + shared**2).tolist()
            for name, value, error in zip(named(experiment), experiment.values, own):
                predicted = float(self.outcome.predicted[k])
                model = math.sqrt(max(total[k] - error**2, 0.0))
                rows.append(
                    {
                        "experiment": experiment.name or number,
                        "number": name,
                        "measured": value,
                        "error": error,
                        "predicted": predicted,
                        "model_error": model,
                        "off": (value - predicted) / math.sqrt(total[k]),
                    }
                )
                k += 1
        return pd.DataFrame(rows)

    @property
    def curves(self) -> dict[str, pd.DataFrame]:
        """Each measured curve beside that of a run with the most likely values: t, measured, predicted. A
        pulse has its mean time at zero; of many values the means are taken.
        """
        drawn = {}
        answers = self.laboratory.answers([self.best])
        for k, (experiment, (features,)) in enumerate(zip(self.experiments, answers), 1):
            if features is None:
                continue
            for curve, predicted in zip(experiment.curves, samples(experiment, features[None])):
                columns = {"t": curve.times, "measured": curve.samples, "predicted": predicted[0]}
                drawn[f"{curve.name} of experiment {experiment.name or k}"] = pd.DataFrame(columns)
        return drawn

    def listed(self) -> str:
        """The measurements as text; of a curve the root mean square of its deviations."""
        numbers = [n.name for e in self.experiments for n in e.numbers]
        own = self.measurements["number"].isin(numbers)
        words = self.measurements[own].to_string(index=False, float_format=lambda x: f"{x:.5g}")
        lines = [words] if own.any() else []
        for (k, name), part in self.measurements[~own].groupby(["experiment", "number"]):
            size = math.sqrt(float((part["off"] ** 2).mean()))
            lines.append(
                f"experiment {k}: {name} by {len(part)} coefficients, off by {size:.2g} errors (rms)"
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
        the error (95 %) by the entries that are fitted, that of elements and steps (NaN where no run
        estimates it), and the ends of both. An entry without a value counts with all that agree.

        Runs at the most likely values, at one standard error along each axis of their covariance and at
        the ends of intervals; the value is that of a finer run.
        """
        chosen = [names] if isinstance(names, str) else list(names or ())
        if not chosen or not all(isinstance(name, str) for name in chosen):
            raise BadInput(f"predict: names: '{brief(names)}' (accepted: names of numbers)")
        wanted: dict[str, Any] = {name: (None, 1.0) for name in chosen}
        asked = Experiment(entries, speed=speed, height=height, **wanted)
        runs, at = self.laboratory.with_experiments([asked], self.best), self.outcome.best
        values, vectors = np.linalg.eigh(np.linalg.inv(self.outcome.information))
        axes = [np.sqrt(value) * vector for value, vector in zip(values, vectors.T)]
        sides = [side for axis in axes for side in (at + axis, at - axis)]
        ends = np.vstack([profile.ends for profile in self.outcome.profiles])
        points = [self.scales.entries(np.clip(p, 0, 1)) for p in [at, *sides, *ends]]
        answers = runs.answers(points)[0]
        if any(answer is None for answer in answers):
            raise BadInput("predict: a run within the intervals of the entries does not end")
        predicted = np.array(answers) - answers[0]
        # the larger of both sides, as one may be cut off by a bound
        away = np.maximum(*(np.abs(predicted[k : len(sides) + 1 : 2]) for k in (1, 2)))
        spread = 1.96 * np.sqrt((away**2).sum(axis=0))
        outer = predicted[len(sides) + 1 :]
        value, stated = runs.fine(0, self.best, accuracy or runs.finer or self.accuracy)
        model = stated * np.abs(value)
        own = np.nan_to_num(model)
        table = {
            "value": value,
            "error": np.maximum(spread, np.abs(outer).max(axis=0)),
            "model_error": model,
            "low": value + np.minimum(-spread, outer.min(axis=0)) - own,
            "high": value + np.maximum(spread, outer.max(axis=0)) + own,
        }
        return pd.DataFrame(table, index=pd.Index(chosen, name="number"))

    @property
    def accuracy(self) -> float:
        return float(self.start.number("accuracy"))

    def next(self, candidates: Sequence[Experiment] | Experiment) -> pd.DataFrame:
        """What each of the candidates would add: the standard error of each free entry with it over that
        without. Errors that it shares with the other measurements count once; values may be None. Best
        first.
        """
        candidates = [candidates] if isinstance(candidates, Experiment) else list(candidates or ())
        if not candidates or not all(isinstance(e, Experiment) for e in candidates):
            raise BadInput("next: no candidates (accepted: a list of Experiment)")
        runs, at, box = (
            self.laboratory.with_experiments(candidates, self.best),
            self.outcome.best,
            self.outcome.box,
        )
        step = np.minimum(0.5 * box.spacing, 0.05)
        sides = [np.clip(at + sign * d, 0, 1) for d in np.diag(step) for sign in (1, -1)]
        answers = runs.answers([self.scales.entries(side) for side in sides])
        own = self.outcome.likelihood
        slopes_before = own.slopes(at, box)
        before, rows = np.sqrt(np.diag(np.linalg.inv(self.outcome.information))), []
        for i, experiment in enumerate(candidates):
            if any(answer is None for answer in answers[i]):
                raise BadInput(f"{experiment!r}: a run near the fitted values does not end")
            seen = runs.observed(i, np.array(answers[i]))
            width = np.array([sides[2 * k][k] - sides[2 * k + 1][k] for k in range(len(at))])
            slopes = np.hstack([slopes_before, (seen[0::2] - seen[1::2]) / width[:, None]])
            # with the errors that it shares with what is measured already
            predicted = np.append(self.outcome.predicted, seen.mean(axis=0))
            together = [*self.experiments, experiment]
            noise = covariance(together, [*self.laboratory.stated, runs.stated[i]], predicted)
            m = len(own.measured)
            noise[:m, :m] = own.variance
            prior = np.diag(1 / own.priors[:, 1] ** 2 + UNIFORM)
            more = slopes @ np.linalg.solve(noise, slopes.T) + prior
            rows.append(np.sqrt(np.diag(np.linalg.inv(more))) / before)
        index = pd.Index([e.asked for e in candidates], name="experiment")
        table = pd.DataFrame(rows, index, self.scales.names)
        return table.iloc[np.argsort(table.prod(axis=1).to_numpy())]

    def compare(self, *others: Fit) -> pd.DataFrame:
        """This fit beside others of the same measurements: chi2, p, and the criteria of Akaike and of
        Schwarz, less the least of them.
        """
        rows = []
        for other in (self, *others):
            if not isinstance(other, Fit):
                raise BadInput(f"compare: '{brief(other)}' is no fit (accepted: fits)")
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

        if not isinstance(folder, str | Path) or Path(folder).is_file():
            raise BadInput(f"save: '{brief(folder)}' (accepted: the path of a folder)")
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


def _probability(chi2: float, freedom: int) -> float:
    """The probability of a chi2 as large or larger."""
    from scipy.special import gammaincc  # takes long to load

    return float(gammaincc(freedom / 2, chi2 / 2)) if freedom > 0 else math.nan
