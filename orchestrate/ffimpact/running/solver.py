"""FreeFem++ runs of one scene in the folder of a run: the main one, those that estimate its error,
and what each has left. While they go on it is told which of them is at what; of one that will take
long about how long, and which entry makes it so.
"""

import bisect
import math
import os
import shutil
import signal
import threading
import time
from collections.abc import Mapping
from contextlib import AbstractContextManager, ExitStack, suppress
from functools import partial
from pathlib import Path

import numpy as np

from ..failure import Failure, NotInstalled, Unreadable, of_code
from ..freefem import freefem
from ..input.parameters import Value
from ..output import estimate
from ..output.fields import write_fields
from ..output.results import read_history, read_json, read_summary, write_json
from ..progress import Line
from ..scene import Scene
from ..scenes.assembly import prepare
from ..scenes.finer import scaled

__all__ = ["FAILURES", "Solver", "Display", "USED", "between", "entry", "forecast", "runs"]

FAILURES = {
    10: "bad input",
    11: "step failed",
    12: "material broke down",
    13: "not installed",
    14: "unreadable",
}
COST = (
    estimate.COARSER**-3
)  # of a run with larger elements and steps, over that of the one beside it
LONG = 60.0  # s
FIRST = 2.0  # s of steps from which on its end is foretold
AGAIN = (
    1.5  # a forecast is renewed where the run takes at least so many times what was said at most
)
USUAL = freefem.At(
    1.0, 0.0, 200, 2000
)  # steps and unknowns of a usual run: what is further above them makes a run long
# scene.toml as Python writes it, there from the start: whoever finds the run finished puts it in
# its place
USED = "scene.used"
# times that the slow body waits for the quick one's steps: more than mesh or accuracy cost
APART = 10.0


class Solver(AbstractContextManager):
    """Runs the scene with some values in a folder, one run after the other, but the coarser one
    beside the main one where `pair` says that it will be wanted and a core is free. A thread
    beside the main one belongs to a study, which has a run on every core already.
    """

    def __init__(
        self,
        program: freefem.FreeFem,
        scene: Scene,
        mesh_file: Path | None,
        foreign: bytes | None,
        stage: Path,
        lock: int,
        line: Line,
        pair: bool,
    ):
        self.program, self.scene, self.mesh_file, self.foreign = program, scene, mesh_file, foreign
        self.scaled = partial(scaled, scene)
        self.stage, self.lock, self.line = stage, lock, line
        self.pair = (
            pair and freefem.CORES > 1 and threading.current_thread() is threading.main_thread()
        )
        self.own_mesh = foreign is None and not scene.of_files
        self.number = 0
        self.beside: tuple[Path, dict[str, Value], freefem.Process] | None = None
        self.leaving = ExitStack()

    def __exit__(self, *_) -> None:
        """Ends a run beside; of a main one that is lost nothing else is of use."""
        self.leaving.close()
        if not any((self.stage / name).exists() for name in ("summary.json", "checkpoint")):
            shutil.rmtree(self.stage / estimate.COARSE, ignore_errors=True)

    def __call__(self, given: dict[str, Value], where: Path) -> None:
        """Runs in the folder `where`: from its checkpoint where there is one, not again
        where it is finished.
        """
        self.number += 1
        display = Display(
            self.line,
            self.scene,
            self.mesh_file,
            "main run" if where == self.stage else f"{where.name} run",
            self.number,
        )
        taken, exit_code, said = self._taken(given, where), 0, ""
        if taken or not (where / "summary.json").exists():
            with ExitStack() as leaving:
                process = taken or self._started(given, where, leaving, display)
                exit_code, said = process.end(display.show)
        if (where / USED).exists() and (where / "scene.toml").exists():
            os.replace(where / USED, where / "scene.toml")
        write_fields(where)
        _check(where, exit_code, said)
        display.at("ready", 1.0)

    def _started(
        self,
        given: dict[str, Value],
        where: Path,
        leaving: ExitStack,
        display: "Display | None" = None,
    ) -> freefem.Process:
        """A process at work in the folder until `leaving`."""
        scene, goes_on = self.scene.override(given), (where / "checkpoint").exists()
        if not goes_on:
            if where != self.stage:
                shutil.rmtree(where, ignore_errors=True)
            where.mkdir(exist_ok=True)
            if not (where / "checkpoint.json").exists():  # what makes the folder ours
                write_json(where / "checkpoint.json", scene.asked)
        if display:
            display.at("mesh")
        flags, used, scene_toml = prepare(scene, where, self.foreign, self.scene)
        if scene_toml:
            (where / USED).write_text(scene_toml, "utf-8")
        if display:
            display.at("set-up")
        flags = flags | {"out": where} | ({"restart": where / "checkpoint"} if goes_on else {})
        process = leaving.enter_context(
            freefem.start(
                self.program, f"edp/{scene.script}.edp", flags, where / "log.txt", self.lock
            )
        )
        if where == self.stage and self.pair:
            self._start_beside(used)
        return process

    def _start_beside(self, used: Mapping) -> None:
        """The coarser run, as settle() will ask for it. What hinders it is said then."""
        where = self.stage / estimate.COARSE
        given = self.scaled(
            self.scene.values | self.scene.sizes, used, estimate.COARSER, self.own_mesh
        )
        if not (where / "summary.json").exists():
            with suppress(Failure):
                self.beside = where, given, self._started(given, where, self.leaving)

    def _taken(self, given: dict[str, Value], where: Path) -> freefem.Process | None:
        """The process beside the main one, where it is the one that is asked for; else it ends."""
        if not self.beside:
            return None
        place, values, process = self.beside
        self.beside = None
        if (place, values) == (where, given):
            return process
        self.leaving.close()
        shutil.rmtree(place)
        return None


def _check(stage: Path, exit_code: int, said: str) -> None:
    """Failure unless FreeFem++ ended well AND left a finished summary and a finite history (0
    alone says little).

    Its code is that of the process, its words those of the failure.json that the script wrote,
    else what it `said`.
    """
    if exit_code == 0:
        try:
            read_summary(stage)
            history = read_history(stage)
        except Unreadable as error:
            problem = str(error).replace(f"{stage}/", "")
            raise Failure(f"FreeFem++ ended without a result: {problem}; {_tail(stage)}") from None
        for name, column in history.items():
            if not np.isfinite(column).all():
                raise Failure(
                    f"history.csv: {name} is not finite from row {1 + np.argmin(np.isfinite(column))} on"
                )
        return
    log = (stage / "log.txt").read_text(errors="replace")
    said = read_json(stage / "failure.json").get("message") or said
    if exit_code in FAILURES and said:
        raise of_code(exit_code, said)
    if exit_code == -signal.SIGXFSZ:
        raise Unreadable(
            "out: a file of the run is larger than files may be here; raise ulimit -f, or ask for fewer fields or steps"
        )
    if "Load error" in log:
        raise NotInstalled(f"FreeFem++ lacks a plugin: {_tail(stage)}; {freefem.HOW}")
    how = (
        f"was killed by {signal.Signals(-exit_code).name}"
        if exit_code < 0
        else f"stopped with exit code {exit_code}"
    )
    goes_on = (
        "; the same command goes on from the last checkpoint"
        if (stage / "checkpoint").exists()
        else ""
    )
    raise Failure(f"FreeFem++ {how}; {_tail(stage)}{goes_on}")


def _tail(stage: Path) -> str:
    lines = [line.strip() for line in (stage / "log.txt").read_text(errors="replace").splitlines()]
    said = (
        [line for line in lines if line and not line.startswith("progress ")]
        or lines[-1:]
        or ["nothing"]
    )
    return "end of its log: " + " | ".join(said[-4:])


# ---- progress of the runs


def runs(estimate: bool) -> dict[str, float]:
    """The runs that are foreseen, with their costs."""
    return {"main run": 1.0} | ({"coarser run": COST} if estimate else {})


class Display:
    """One run, the `number`th of those in the line."""

    def __init__(self, line: Line, scene: Scene, mesh_file: Path | None, kind: str, number: int):
        self.line, self.scene, self.mesh_file, self.number = line, scene, mesh_file, number
        self.words = f"{kind} {number} of {max(number, len(line.costs))}"
        self.part = kind if kind in line.costs else self.words
        self.seen: list[tuple[float, freefem.At]] = []
        self.foretold = math.inf if kind == "coarser run" else LONG  # s of all runs, at most

    def at(self, what: str, share: float = 0.0) -> None:
        """It is at this, and so far."""
        self.line.at(self.part, share, f"{self.words}, {what}", COST ** (2 - self.number))

    def show(self, at: freefem.At) -> None:
        """What FreeFem++ says of it."""
        self.at(f"t = {at.t * 1e3:.3f} ms, {at.steps} steps", at.share)
        self.seen.append(
            (time.monotonic(), at)
        )  # from the first steps on, with the set-up behind it
        if self.seen[-1][0] - self.seen[0][0] < FIRST:
            return
        seconds, steps = forecast(self.seen)
        low, high = (
            each * sum(self.line.costs.values()) / self.line.costs[self.part] for each in seconds
        )
        if self.foretold < low < math.inf:
            self.foretold = AGAIN * (high if high < math.inf else low)
            self.line.say(
                f"{self.scene.name}: {between(low / 60, high / 60)} min, for {between(*steps)} steps of {at.unknowns} unknowns: "
                f"{entry(self.scene, at, self.mesh_file)}"
            )


def forecast(
    seen: list[tuple[float, freefem.At]],
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Seconds and steps of a run from its first report on, each (at least, at most): by its
    pace since then, and by its pace since half of that time. They differ where its steps become
    shorter, or where the impact lasts longer than it seemed; a pace by which the end recedes
    makes it infinite.
    """
    (start, first), (now, at) = seen[0], seen[-1]
    middle = seen[max(0, bisect.bisect(seen, (start + now) / 2, key=lambda one: one[0]) - 1)]
    seconds, steps = [], []
    for when, since in ((start, first), middle):
        left = (1 - at.share) / (at.share - since.share) if at.share > since.share else math.inf
        seconds.append(now - start + left * (now - when))
        steps.append(at.steps + left * (at.steps - since.steps))
    return (min(seconds), max(seconds)), (min(steps), max(steps))


def between(low: float, high: float) -> str:
    """A range of numbers in words."""
    if high == math.inf:
        return f"at least {low:.0f}"
    return (
        f"about {high:.0f}"
        if high < 1.2 * low or f"{low:.0f}" == f"{high:.0f}"
        else f"{low:.0f} to {high:.0f}"
    )


def entry(scene: Scene, at: freefem.At, mesh_file: Path | None) -> str:
    """The entry of the scene that makes it long."""
    given = scene.values | scene.sizes
    if at.apart > APART:
        return f"a stiff body beside a soft one, whose waves take {at.apart:.0f} times as long as those that set the steps (young, density)"
    if at.steps / at.share / USUAL.steps > at.unknowns / USUAL.unknowns:
        names = (
            "dt",
            "end_time",
            *(["integrator"] if given["integrator"] == "central-difference" else []),
        )
    elif mesh_file:
        return f"the mesh {mesh_file}"
    else:
        names = ("contact_mesh_size", "mesh_size")
    name = next((name for name in names if given.get(name)), "accuracy")
    return (
        f"{name} = {given[name]:g}" if isinstance(given[name], float) else f"{name} = {given[name]}"
    )
