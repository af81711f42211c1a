"""The FreeFem++ runs of a scene: the main run and the runs that estimate its error."""

import os
import shutil
import threading
from collections.abc import Callable
from contextlib import AbstractContextManager, ExitStack, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from ..failure import Failure
from ..freefem import freefem
from ..input.parameters import Table
from ..output import estimate
from ..output.evaluate import RECORD, evaluate_numbers
from ..output.results import write_json
from ..progress import Line, work
from ..scene import Scene
from ..scenes.assembly import prepare
from ..scenes.finer import scaled
from .forecast import Display
from .outcome import check

__all__ = ["LAST_STATE", "Earlier", "Solver", "Watch"]


# A file in the folder of a run that ends it at its next report (edp/program/run/march.idp).
# Files in the folder of a run that ask it to end, and to report each step; seconds between two looks.
STOP, WATCHED = "stop", "watched"
LOOK = 0.01
LAST_STATE = "last-state"  # the checkpoint at the end of a run (edp/program/run/checkpoint.idp)
# Sees the progress of the main run and its folder; True ends the run.
Watch = Callable[[freefem.At, Path], object]


@dataclass(frozen=True)
class Earlier:
    """A finished run in a folder, with its scene as it was used, from whose end a run goes on."""

    folder: Path
    scene: Scene

    def hand_over(self, where: Path) -> None:
        """Copies what the run that goes on needs to the folder `where`, unless it has a checkpoint."""
        if (where / "checkpoint").exists():
            return
        for name in ("history.csv", "scene.bin.unstressed", LAST_STATE):
            if (self.folder / name).exists():
                shutil.copyfile(self.folder / name, where / name)
        os.replace(where / LAST_STATE, where / "checkpoint")


class Solver(AbstractContextManager["Solver", None]):
    """Runs a scene with given values in given folders, one run after the other. If `pair` is set
    and a core is free, the coarser runs start at the same time as the main run. In a thread other
    than the main thread they do not, because a study already has a run on every core. `watch` may
    end the main run.
    """

    def __init__(
        self,
        program: freefem.FreeFem,
        scene: Scene,
        stage: Path,
        lock: int,
        line: Line,
        pair: bool,
        watch: Watch | None = None,
        earlier: "Earlier | None" = None,
    ):
        self.program, self.scene = program, scene
        self.scaled = partial(scaled, scene)
        self.stage, self.lock, self.line = stage, lock, line
        # The integrator that `auto` takes, and all levels have, is known after the main run only.
        self.pair = (
            pair
            and freefem.CORES > 1
            and scene.values["integrator"] != "auto"
            and threading.current_thread() is threading.main_thread()
        )
        self.watch, self.earlier = watch, earlier
        self.stopped = False  # by watch
        self.own_mesh = not scene.of_files
        self.number = 0
        # The coarser runs that have started, by folder, with the entries that they override.
        self.beside: dict[Path, tuple[Table, freefem.Process]] = {}
        self.leaving = ExitStack()

    def __exit__(self, *_: object) -> None:
        """Ends the coarser runs. Removes their folders if the main run has neither a summary nor a
        checkpoint.
        """
        self.leaving.close()
        if not any((self.stage / name).exists() for name in ("summary.json", "checkpoint")):
            for name in estimate.LEVELS:
                shutil.rmtree(self.stage / name, ignore_errors=True)

    def __call__(self, overrides: Table, where: Path) -> None:
        """Runs the scene, with `overrides`, in the folder `where`: from its checkpoint if there is
        one, and not at all if it has finished. Raises Failure.
        """
        self.number += 1
        display = Display(
            self.line,
            self.scene,
            "main run" if where == self.stage else f"{where.name} run",
            self.number,
        )
        taken, exit_code, message = self._taken(overrides, where), 0, ""
        if not taken:
            record = where / RECORD
            if record.exists() and not record.read_bytes().rstrip().endswith(b"}"):
                record.unlink()  # FreeFem++ was killed while it wrote this last file
            evaluate_numbers(where)  # what a run has left that was killed before it was evaluated
        if taken or not (where / "summary.json").exists():
            with ExitStack() as leaving:
                process = taken or self._started(overrides, where, leaving, display)
                setting_up = leaving.enter_context(ExitStack())
                setting_up.enter_context(work(f"FreeFem++ sets up the {display.part}"))

                def show(at: freefem.At) -> None:
                    setting_up.close()  # the first report comes with the first steps
                    display.show(at)
                    if watched and not self.stopped and watched(at, where):
                        self.stopped = True
                        (where / STOP).touch()

                watched = self.watch if where == self.stage else None
                exit_code, message = process.end(show, LOOK if watched else freefem.POLL)
        for name in (STOP, WATCHED):
            (where / name).unlink(missing_ok=True)
        evaluate_numbers(where)
        check(where, exit_code, message)
        display.at("ready", 1.0)

    def _started(
        self,
        overrides: Table,
        where: Path,
        leaving: ExitStack,
        display: "Display | None" = None,
    ) -> freefem.Process:
        """Starts the scene, with `overrides`, in the folder `where`. The process is ended when
        `leaving` is closed.
        """
        scene, earlier = self.scene.override(overrides), None
        if where == self.stage and (earlier := self.earlier):
            earlier.hand_over(where)
        goes_on = (where / "checkpoint").exists()
        if not goes_on:
            if where != self.stage:
                shutil.rmtree(where, ignore_errors=True)
            where.mkdir(exist_ok=True)
            if not (where / "checkpoint.json").exists():  # marks the folder as ours
                write_json(where / "checkpoint.json", scene.decisive_entries)
        if display:
            display.at("mesh")
        flags, used, scene_toml = (
            prepare(earlier.scene, where, scene) if earlier else prepare(scene, where)
        )
        (where / "scene.toml").write_text(scene_toml, "utf-8")
        if self.watch and where == self.stage:
            (where / WATCHED).touch()
        if display:
            display.at("set-up")
        flags = flags | {"out": where} | ({"restart": where / "checkpoint"} if goes_on else {})
        process = leaving.enter_context(
            freefem.start(
                self.program,
                f"edp/program/{scene.kind.script}.edp",
                flags,
                where / "log.txt",
                self.lock,
            )
        )
        if where == self.stage and self.pair:
            self._start_beside(used)
        return process

    def _start_beside(self, used: Table) -> None:
        """Starts the coarser runs as estimate.settle() will request them. A Failure is ignored
        here; settle() then raises it again.
        """
        for k, name in enumerate(estimate.LEVELS, 1):
            where, factor = self.stage / name, estimate.COARSER**k
            overrides = self.scaled(used, factor)
            if not (where / "summary.json").exists():
                with suppress(Failure):
                    self.beside[where] = overrides, self._started(overrides, where, self.leaving)

    def _taken(self, overrides: Table, where: Path) -> freefem.Process | None:
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
