"""The FreeFem++ runs of a scene: the main run and the runs that estimate its error. The module
checks what each run has left and shows the progress. For a long run it prints a forecast of its
duration and the entry of the scene that makes it long.
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
from ..output.evaluate import RECORD, evaluate
from ..output.results import read_history, read_json, read_summary, write_json
from ..progress import Line, work
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
# Cost ratio of a run to the run with elements and steps smaller by the factor COARSER.
COST = estimate.COARSER**-3
LONG = 60.0  # a run with a longer forecast [s] is reported as long
FIRST = 2.0  # time [s] after the first report from which on the duration is forecast
# A forecast is printed again once its lower bound exceeds the last upper bound by this factor.
AGAIN = 1.5
# 200 steps and 2000 unknowns of a usual run. The number that exceeds its usual value by the larger
# factor makes a run long.
USUAL = freefem.At(1.0, 0.0, 200, 2000)
# Name of the scene.toml that Python writes before the run. When the run has finished, this file
# replaces the scene.toml of the script.
USED = "scene.used"
# Ratio of the wave transit times of the slowest and the quickest body. A larger ratio costs more
# time than mesh or accuracy.
APART = 10.0


class Solver(AbstractContextManager):
    """Runs a scene with given values in given folders, one run after the other. If `pair` is set
    and a core is free, the coarser runs start at the same time as the main run. In a thread other
    than the main thread they do not, because a study already has a run on every core.
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
        # The coarser runs that have started, by folder, with the entries that they override.
        self.beside: dict[Path, tuple[dict[str, Value], freefem.Process]] = {}
        self.leaving = ExitStack()

    def __exit__(self, *_) -> None:
        """Ends the coarser runs. Removes their folders if the main run has neither a summary nor a
        checkpoint.
        """
        self.leaving.close()
        if not any((self.stage / name).exists() for name in ("summary.json", "checkpoint")):
            for name in estimate.LEVELS:
                shutil.rmtree(self.stage / name, ignore_errors=True)

    def __call__(self, overrides: dict[str, Value], where: Path) -> None:
        """Runs the scene, with `overrides`, in the folder `where`: from its checkpoint if there is
        one, and not at all if it has finished. Raises Failure.
        """
        self.number += 1
        display = Display(
            self.line,
            self.scene,
            self.mesh_file,
            "main run" if where == self.stage else f"{where.name} run",
            self.number,
        )
        taken, exit_code, message = self._taken(overrides, where), 0, ""
        if not taken:
            record = where / RECORD
            if record.exists() and not record.read_bytes().rstrip().endswith(b"}"):
                record.unlink()  # FreeFem++ was killed while it wrote this last file
            evaluate(where)  # what a run has left that was killed before it was evaluated
        if taken or not (where / "summary.json").exists():
            with ExitStack() as leaving:
                process = taken or self._started(overrides, where, leaving, display)
                setting_up = leaving.enter_context(ExitStack())
                setting_up.enter_context(work(f"FreeFem++ sets up the {display.part}"))

                def show(at: freefem.At) -> None:
                    setting_up.close()  # the first report comes with the first steps
                    display.show(at)

                exit_code, message = process.end(show)
        if (where / USED).exists() and (where / "scene.toml").exists():
            os.replace(where / USED, where / "scene.toml")
        evaluate(where)
        _check(where, exit_code, message)
        display.at("ready", 1.0)

    def _started(
        self,
        overrides: dict[str, Value],
        where: Path,
        leaving: ExitStack,
        display: "Display | None" = None,
    ) -> freefem.Process:
        """Starts the scene, with `overrides`, in the folder `where`. The process is ended when
        `leaving` is closed.
        """
        scene, goes_on = self.scene.override(overrides), (where / "checkpoint").exists()
        if not goes_on:
            if where != self.stage:
                shutil.rmtree(where, ignore_errors=True)
            where.mkdir(exist_ok=True)
            if not (where / "checkpoint.json").exists():  # marks the folder as ours
                write_json(where / "checkpoint.json", scene.decisive_entries)
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
        """Starts the coarser runs as estimate.settle() will request them. A Failure is ignored
        here; settle() then raises it again.
        """
        for k, name in enumerate(estimate.LEVELS, 1):
            where, factor = self.stage / name, estimate.COARSER**k
            overrides = self.scaled(
                self.scene.values | self.scene.sizes, used, factor, self.own_mesh
            )
            if not (where / "summary.json").exists():
                with suppress(Failure):
                    self.beside[where] = overrides, self._started(overrides, where, self.leaving)

    def _taken(self, overrides: dict[str, Value], where: Path) -> freefem.Process | None:
        """Returns the process of the coarser run if the request is for this run, else None. If the
        request is for other sizes, the coarser runs are ended and their folders removed.
        """
        if where not in self.beside:
            return None
        values, process = self.beside.pop(where)
        if values == overrides:
            return process
        self.leaving.close()
        for folder in (where, *self.beside):
            shutil.rmtree(folder)
        self.beside = {}
        return None


def _check(stage: Path, exit_code: int, message: str) -> None:
    """Raises Failure unless FreeFem++ ended with exit code 0 and left a finished summary and a
    finite history. The exit code 0 alone does not prove success.

    The failure has the exit code of the process. Its message is that of the failure.json that the
    script wrote, or else `message`.
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
    message = read_json(stage / "failure.json").get("message") or message
    if exit_code in FAILURES and message:
        raise of_code(exit_code, message)
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
    ending = (
        [line for line in lines if line and not line.startswith("progress ")]
        or lines[-1:]
        or ["nothing"]
    )
    return "end of its log: " + " | ".join(ending[-4:])


# ---- progress of the runs


def runs(pair: bool) -> dict[str, float]:
    """Returns the runs that are expected with their costs."""
    levels = {f"{name} run": COST**k for k, name in enumerate(estimate.LEVELS, 1)}
    return {"main run": 1.0} | (levels if pair else {})


class Display:
    """Shows the progress of a run, the `number`th run of the progress line."""

    def __init__(self, line: Line, scene: Scene, mesh_file: Path | None, kind: str, number: int):
        self.line, self.scene, self.mesh_file, self.number = line, scene, mesh_file, number
        self.words = f"{kind} {number} of {max(number, len(line.costs))}"
        self.part = kind if kind in line.costs else self.words
        self.seen: list[tuple[float, freefem.At]] = []
        # The upper bound [s] of the last forecast for all runs.
        self.foretold = math.inf if kind.startswith(estimate.LEVELS) else LONG

    def at(self, what: str, share: float = 0.0) -> None:
        """Shows the current work `what` and the completed fraction `share`, in [0, 1]."""
        self.line.at(self.part, share, f"{self.words}, {what}", COST ** (3 - self.number))

    def show(self, at: freefem.At) -> None:
        """Shows the progress that FreeFem++ reports. Prints a forecast if the runs will take
        long.
        """
        self.at(f"t = {at.t * 1e3:.3f} ms, {at.steps} steps", at.share)
        # The first report comes with the first steps, after the set-up.
        self.seen.append((time.monotonic(), at))
        if self.seen[-1][0] - self.seen[0][0] < FIRST:
            return
        seconds, steps = forecast(self.seen)
        low, high = (
            bound * sum(self.line.costs.values()) / self.line.costs[self.part] for bound in seconds
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
    """Returns the duration [s] of a run from its first report on and its number of steps, each as
    (lower bound, upper bound). `seen` has the reports with their times [s].

    One forecast uses the pace since the first report, the other one the pace since half of the
    elapsed time. They differ if the steps become shorter or if the impact lasts longer than it
    seemed. If the completed fraction has not increased, a forecast is infinite.
    """
    (start, first), (now, at) = seen[0], seen[-1]
    middle = seen[max(0, bisect.bisect(seen, (start + now) / 2, key=lambda state: state[0]) - 1)]
    seconds, steps = [], []
    for when, since in ((start, first), middle):
        remaining = (
            (1 - at.share) / (at.share - since.share) if at.share > since.share else math.inf
        )
        seconds.append(now - start + remaining * (now - when))
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


def entry(scene: Scene, at: freefem.At, mesh_file: Path | None) -> str:
    """Returns the entry of the scene that makes the run long."""
    values = scene.values | scene.sizes
    if at.apart > APART:
        return f"a stiff body beside a soft one, whose waves take {at.apart:.0f} times as long as those that set the steps (young, density)"
    if at.steps / at.share / USUAL.steps > at.unknowns / USUAL.unknowns:
        names = (
            "dt",
            "end_time",
            *(["integrator"] if values["integrator"] == "central-difference" else []),
        )
    elif mesh_file:
        return f"the mesh {mesh_file}"
    else:
        names = ("contact_mesh_size", "mesh_size")
    name = next((name for name in names if values.get(name)), "accuracy")
    return (
        f"{name} = {values[name]:g}"
        if isinstance(values[name], float)
        else f"{name} = {values[name]}"
    )
