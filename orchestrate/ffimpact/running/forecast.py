"""Shows the progress of the runs of a scene. For a long run it prints a forecast of its duration
and the entry of the scene that makes it short.
"""

import bisect
import math
import time
from collections.abc import Callable, Iterator
from itertools import chain

from ..failure import Failure
from ..freefem import freefem
from ..input.bodies import SIZES
from ..input.parameters import Value
from ..output import estimate as estimates
from ..progress import Line, muted
from ..scene import Scene
from .plan import COST, LONG, Plan, duration, levels, measure

__all__ = ["Display", "between", "cure", "forecast", "runs"]

FIRST = 2.0  # time [s] after the first report from which on the duration is forecast
# A forecast is printed again once its lower bound exceeds the last upper bound by this factor.
AGAIN = 1.5
SHORT = 60.0  # time [s] that a changed entry aims at
COARSEST = 0.05  # largest accuracy that is proposed
EARLIEST = 0.1  # smallest share of end_time that is proposed
# An entry is proposed if it shortens a run by this factor at least.
WORTH = 2.0
# The time of a run is about proportional to accuracy^-POWER.
POWER = 1.2
ROUND = (1, 2, 5)  # first digits of the proposed values

Entries = dict[str, Value]
PlanWith = Callable[[Entries], Plan | None]
# Entries to change, the plan with them (None if they are refused), and what they cost, in words.
Change = tuple[Entries, Plan | None, str]


def runs(estimate: bool) -> dict[str, float]:
    """Returns the runs that are expected with their costs."""
    return {"main run": 1.0} | {f"{name} run": cost for name, cost in levels(estimate).items()}


class Display:
    """Shows the progress of a run, the `number`th run of the progress line."""

    def __init__(self, line: Line, scene: Scene, kind: str, number: int):
        self.line, self.scene, self.number = line, scene, number
        self.words = f"{kind} {number} of {max(number, len(line.costs))}"
        self.part = kind if kind in line.costs else self.words
        self.seen: list[freefem.At] = []
        # The upper bound [s] of the last forecast for all runs.
        self.foretold = math.inf if kind.startswith(estimates.LEVELS) else LONG
        self.cure: str | None = None
        # Wall time of the run [s] until which its reports are out of date.
        self.sought_until = 0.0

    def at(self, what: str, share: float = 0.0) -> None:
        """Shows the current work `what` and the completed fraction `share`, in [0, 1]."""
        self.line.at(self.part, share, f"{self.words}, {what}", COST ** (3 - self.number))

    def show(self, at: freefem.At) -> None:
        """Shows the progress that FreeFem++ reports. Prints a forecast if the runs will take
        long.
        """
        if at.wall < self.sought_until:
            return
        self.at(f"t = {at.t * 1e3:.3f} ms, {at.steps} steps", at.share)
        # The first report comes after the set-up.
        self.seen.append(at)
        if self.line.quiet or at.wall - self.seen[0].wall < FIRST:
            return
        seconds, steps = forecast(self.seen)
        low, high = (
            bound * sum(self.line.costs.values()) / self.line.costs[self.part] for bound in seconds
        )
        if self.foretold < low < math.inf:
            self.foretold = AGAIN * (high if high < math.inf else low)
            if self.cure is None:
                began = time.monotonic()
                self.cure = cure(self.scene, low, len(self.line.costs) > 1)
                self.sought_until = at.wall + time.monotonic() - began
            self.line.say(
                f"{self.scene.name}: {between(low / 60, high / 60)} min, for {between(*steps)} steps of {at.unknowns} unknowns: "
                f"{self.cure}"
            )


def forecast(
    seen: list[freefem.At],
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Returns the duration [s] of a run from its first report on and its number of steps, each as
    (lower bound, upper bound). `seen` has the reports.

    One forecast uses the pace since the first report, the other one the pace since half of the
    elapsed time. They differ if the steps become shorter or if the impact lasts longer than it
    seemed. If the completed fraction has not increased, a forecast is infinite.
    """
    first, at = seen[0], seen[-1]
    half = bisect.bisect(seen, (first.wall + at.wall) / 2, key=lambda state: state.wall)
    seconds, steps = [], []
    for since in (first, seen[max(0, half - 1)]):
        remaining = (
            (1 - at.share) / (at.share - since.share) if at.share > since.share else math.inf
        )
        seconds.append(at.wall - first.wall + remaining * (at.wall - since.wall))
        steps.append(at.steps + remaining * (at.steps - since.steps))
    return (min(seconds), max(seconds)), (min(steps), max(steps))


def between(low: float, high: float) -> str:
    """Returns a range of numbers in words."""
    if high == math.inf:
        return f"at least {low:.0f}"
    return (
        f"about {high:.0f}"
        if high < 1.2 * low or f"{low:.0f}" == f"{high:.0f}"
        else f"{low:.0f} to {high:.0f}"
    )


# ---- the entry that makes a run short


def cure(scene: Scene, seconds: float, estimate: bool) -> str:
    """Returns the entry and the value that make a run of `seconds` short, the time that it then
    takes, and what that costs. This time is measured (plan.py), not extrapolated.

    Tried in this order: steps and sizes that the scene sets become automatic; a larger accuracy; an
    earlier end_time. The first change with a short run is returned, otherwise the one with the
    shortest if that takes less than seconds / WORTH.
    """

    def plan_with(entries: Entries) -> Plan | None:
        """Returns the plan with these entries, None if they are refused."""
        try:
            with muted():
                return measure(scene.override(entries), estimate)
        except Failure:
            return None

    quickest = seconds / WORTH, ""
    for entries, plan, cost in chain(
        _automatic(scene, plan_with),
        _coarser(scene, seconds, plan_with),
        _ended_earlier(scene, seconds, plan_with),
    ):
        if plan:
            quickest = min(quickest, (plan.total_seconds, f"{_time_of(entries, plan)}, {cost}"))
        if quickest[1] and quickest[0] <= LONG:
            break
    if quickest[1]:
        return quickest[1]
    if not estimate:
        return "no entry makes it short"
    alone = seconds / (1 + sum(levels(True).values()))
    return f"no entry makes it short: --no-estimate takes about {duration(alone)}, without error estimates"


def _time_of(entries: Entries, plan: Plan) -> str:
    """Returns the entries and their time in words."""
    names = ", ".join(f"{name} = {value}" for name, value in entries.items())
    finer = plan.total_seconds + plan.finer_seconds
    more = f" (up to {duration(finer)} if finer runs follow)" if plan.finer_seconds else ""
    return f"{names} takes about {duration(plan.total_seconds)}{more}"


def _automatic(scene: Scene, plan_with: PlanWith) -> Iterator[Change]:
    """Yields the entries for steps and sizes that the scene sets, made automatic."""
    steps: list[Entries] = []
    if scene.number("dt") > 0:
        steps.append({"dt": 0})
    if scene.values["integrator"] == "central-difference":
        steps.append({"integrator": "auto"})
    places = {"": scene.content} | {
        f"body.{k}.": table for k, table in enumerate(scene.content.get("body", []), 1)
    }
    sizes: Entries = {
        f"{at}{name}": 0 for at, table in places.items() for name in SIZES if table.get(name)
    }
    for entries in steps + [sizes] * bool(sizes):
        cost = f"with the error that accuracy = {scene.values['accuracy']} asks for"
        yield entries, plan_with(entries), cost


def _coarser(scene: Scene, seconds: float, plan_with: PlanWith) -> Iterator[Change]:
    """Yields a larger accuracy, and another one that follows from the power of the accuracy that
    the first one has shown.
    """
    accuracy, power, before = scene.number("accuracy"), POWER, math.inf
    for _ in range(2):
        proposed = min(COARSEST, _rounded(accuracy * (seconds / SHORT) ** (1 / power)))
        if proposed <= accuracy or proposed == before:
            return
        before, larger = proposed, proposed / accuracy
        entries: Entries = {"accuracy": proposed}
        plan = plan_with(entries)
        cost = f"with errors about {larger:.2g} times as large "
        yield entries, plan, f"{cost}(about {100 * proposed:g} % instead of {100 * accuracy:g} %)"
        if plan:
            power = max(0.5, math.log(seconds / plan.total_seconds) / math.log(larger))


def _ended_earlier(scene: Scene, seconds: float, plan_with: PlanWith) -> Iterator[Change]:
    """Yields an earlier end_time if the scene has one."""
    end = scene.number("end_time")
    if end > 0:
        earlier = float(f"{end * max(EARLIEST, SHORT / seconds):.1g}")
        cost = f"without what happens after {earlier:g} s"
        yield {"end_time": earlier}, plan_with({"end_time": earlier}), cost


def _rounded(value: float) -> float:
    """Returns the smallest number with one of the first digits ROUND that is not below `value`."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(
        float(f"{first * power:.1g}") for first in (*ROUND, 10) if first * power > 0.99 * value
    )
