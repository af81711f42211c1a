"""Foretells what a run will take: mesh, steps, processor time and memory.

The mesh is made and the solver started as for a run. The solver prints the largest step and the
number of steps that it expects (edp/program/run/march.idp), and takes steps for TIMED of processor
time. Then it is ended. The time of these steps is extrapolated.
"""

import math
import re
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from ..freefem import freefem
from ..output import estimate as estimates
from ..output.materials import layer_lines
from ..scene import Scene
from ..scenes.assembly import prepare
from .outcome import check

__all__ = ["COST", "LONG", "UNCERTAINTY", "Plan", "duration", "levels", "measure"]

LONG = 120.0  # runs that take more time [s] are reported as long
TIMED, FEWEST = 1.0, 3  # processor time [s] of the steps that are timed, and their smallest number
# Factor by which the expected steps and time are usually at most too small or too large. An impact
# may last longer than a first contact, and first steps need fewer iterations than later ones.
UNCERTAINTY = 2.5
# Cost ratio of a run to the run with elements and steps smaller by the factor COARSER.
COST = estimates.COARSER**-3
BODY = re.compile(r"(?m)^body elements=(\d+) unknowns=(\d+) name=(.*)$")


@dataclass(frozen=True)
class Plan:
    """What a run will take. Steps, time and memory are expected values."""

    #: Name of the scene.
    name: str
    #: Number of elements of each body, by its name.
    elements: dict[str, int]
    #: Number of unknowns of each body, by its name. A rigid body has a few.
    unknowns: dict[str, int]
    #: Largest time step [s].
    step: float
    #: Number of steps of the main run; infinite if no end is in sight.
    steps: float
    #: Number of steps that were taken to time them.
    timed_steps: int
    #: Processor time of the main run [s], with its set-up.
    seconds: float
    #: Processor time of the coarser runs that estimate its errors [s]; 0 without an estimate.
    estimate_seconds: float
    #: Processor time of the finer runs [s] that follow if the estimated error is above the accuracy;
    #: 0 without an estimate, or with given sizes or steps.
    finer_seconds: float
    #: Largest memory of the main run so far [bytes].
    memory: float
    #: Factors (below 1, above 1) on `steps` and the times within which they usually are. Both are 1
    #: if the run is so short that the timed steps were all of it.
    bounds: tuple[float, float]
    #: A line for each layer: its body, its place and its material.
    layers: tuple[str, ...] = ()
    #: For a long run: the entry and the value that make it short, the time that it then takes, and
    #: what that costs.
    advice: str = ""

    @property
    def total_seconds(self) -> float:
        """Processor time [s] of the main run and of those that estimate its errors."""
        return self.seconds + self.estimate_seconds

    @property
    def is_long(self) -> bool:
        """Whether the runs take more than two minutes."""
        return LONG < self.total_seconds < math.inf

    def __str__(self) -> str:
        """The plan as a table."""
        width = max(len("together"), *map(len, self.elements))
        bodies = [
            f"{name:<{width}} {self.elements[name]:7} elements {self.unknowns[name]:7} unknowns"
            for name in self.elements
        ]
        if len(bodies) > 1:
            totals = sum(self.elements.values()), sum(self.unknowns.values())
            bodies.append(f"{'together':<{width}} {totals[0]:7} elements {totals[1]:7} unknowns")
        if self.steps == math.inf:
            steps = f"not foreseeable, of at most {self.step:.3g} s (the run ends at rest)"
        else:
            steps = f"{self._about(self.steps)} of at most {self.step:.3g} s"
        return "\n".join(
            [
                f"{self.name}: plan, nothing is written",
                *_listed("mesh", bodies),
                *_listed("layers", list(self.layers)),
                *_listed("steps", [steps]),
                *_listed("time", self._times()),
                *_listed("memory", [f"{self.memory / 1e6:.0f} MB in the main run"]),
                *_listed("basis", [self._basis()]),
                *_listed("shorter", [self.advice] * bool(self.advice)),
            ]
        )

    def _times(self) -> list[str]:
        """Returns the processor time of the runs in words."""
        if self.steps == math.inf:
            return [f"not foreseeable: {self.timed_steps} steps took {self.seconds:.1f} s"]
        main = f"{self._about(self.seconds, duration)} of processor time"
        if not self.estimate_seconds:
            return [f"{main}, without an estimate of the errors"]
        times = [
            f"{self._about(self.total_seconds, duration)} of processor time: main run "
            f"{duration(self.seconds)}, coarser runs for the error estimate {duration(self.estimate_seconds)}"
        ]
        if self.finer_seconds:
            times.append(
                f"if the estimate is above the accuracy, {estimates.MOST} finer runs at most follow: "
                f"{duration(self.finer_seconds)} more"
            )
        return times

    def _basis(self) -> str:
        if self.bounds == (1.0, 1.0):
            return f"all {self.timed_steps} steps of the main run were taken"
        low, high = self.bounds
        return f"{self.timed_steps} steps were timed; in brackets: {low:.1g} and {high:.2g} times the values"

    def _about(self, value: float, words: Callable[[float], str] = "{:.0f}".format) -> str:
        """Returns a number with its bounds in words."""
        if self.bounds == (1.0, 1.0):
            return words(value)
        low, high = (words(value * bound) for bound in self.bounds)
        return f"about {words(value)} ({low} to {high})"


def _listed(title: str, lines: list[str]) -> list[str]:
    """Returns lines under a title, as the report of a run has them."""
    return [f"  {head:<9}{line}" for head, line in zip([title] + [""] * len(lines), lines)]


def duration(seconds: float) -> str:
    """Returns a duration in words."""
    for size, unit in ((1.0, "s"), (60.0, "min"), (3600.0, "h")):
        number = seconds / size
        if number < 100 or unit == "h":
            break
    return f"{number:.1f} {unit}" if number < 10 else f"{number:.0f} {unit}"


def levels(estimate: bool) -> dict[str, float]:
    """Returns the costs of the coarser runs that estimate the errors, over that of the main run."""
    return {name: COST**k for k, name in enumerate(estimates.LEVELS, 1)} if estimate else {}


class _Enough(Exception):
    """Ends the waiting for a process whose steps have been timed."""


def measure(scene: Scene, estimate: bool = True) -> Plan:
    """Returns the plan of a scene. `estimate`: with the coarser runs. Raises the Failure that the
    run would meet until then.
    """
    seen: list[freefem.At] = []

    def watch(at: freefem.At) -> None:
        seen.append(at)
        if at.seconds >= seen[0].seconds + TIMED and at.steps >= seen[0].steps + FEWEST:
            raise _Enough

    with tempfile.TemporaryDirectory() as name:
        folder, began = Path(name), time.process_time()
        flags, used, _ = prepare(scene, folder)
        prepared = time.process_time() - began
        process = freefem.start(
            freefem.find(),
            f"edp/program/{scene.kind.script}.edp",
            flags | {"out": folder / "run"},
            folder / "log.txt",
        )
        with suppress(_Enough), process as started:
            code, message = started.end(watch)
            if code:
                check(folder, code, message)
        bodies = BODY.findall((folder / "log.txt").read_text(errors="replace"))
    first, last = seen[0], seen[-1]
    cost = (last.seconds - first.seconds) / max(1, last.steps - first.steps)
    expected = last.expected or math.inf
    values = scene.values | scene.sizes
    fixed = scene.of_files or any(values[name] for name in estimates.SIZES)
    finer = 0 if fixed or not estimate else sum(COST**-k for k in range(1, estimates.MOST + 1))
    main = prepared + last.seconds + cost * (expected - last.steps)
    names = [body[2] for body in bodies]
    return Plan(
        scene.name,
        elements=dict(zip(names, (int(body[0]) for body in bodies))),
        unknowns=dict(zip(names, (int(body[1]) for body in bodies))),
        step=last.step,
        steps=expected if expected == math.inf else round(expected),
        timed_steps=last.steps - first.steps,
        seconds=main,
        estimate_seconds=main * sum(levels(estimate).values()),
        finer_seconds=main * finer,
        memory=last.memory,
        layers=tuple(line for body in used["body"] for line in layer_lines(body)),
        bounds=(1.0, 1.0)
        if last.steps >= expected
        else (1 / UNCERTAINTY, max(UNCERTAINTY, last.longer)),
    )
