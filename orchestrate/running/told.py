"""What is told of the runs of a scene while they go on: which of them, what it is at; in the first seconds of one that will take long about
how long, and which entry makes it so."""

import time
from pathlib import Path

from ..output.estimate import COARSER
from ..freefem.freefem import At
from ..progress import Line
from ..scene import Scene

COST = COARSER**-3                # of a run with larger elements and steps, over that of the one beside it
LONG = 60.0                       # s
FIRST, LAST = 2.0, 15.0           # s of steps after which it is judged
USUAL = At(1.0, 0.0, 200, 2000)   # steps and unknowns of a usual run: what is further above them makes a run long
APART = 10.0                      # times that the slow body waits for the quick one's steps: more than mesh or accuracy cost


def runs(estimate: bool) -> dict[str, float]:
    """The runs that are foreseen, with their costs."""
    return {"main run": 1.0} | ({"coarser run": COST} if estimate else {})


class Told:
    """One run, the `number`th of those in the line."""

    def __init__(self, line: Line, scene: Scene, mesh_file: Path | None, kind: str, number: int):
        self.line, self.scene, self.mesh_file, self.number = line, scene, mesh_file, number
        self.words = f"{kind} {number} of {max(number, len(line.costs))}"
        self.part = kind if kind in line.costs else self.words
        self.first: tuple[float, At] | None = None
        self.judged = kind == "coarser run"

    def at(self, what: str, share: float = 0.0) -> None:
        """It is at this, and so far."""
        self.line.at(self.part, share, f"{self.words}, {what}", COST**(2 - self.number))

    def show(self, at: At) -> None:
        """What FreeFem++ says of it."""
        self.at(f"t = {at.t * 1e3:.3f} ms, {at.steps} steps", at.share)
        now = time.monotonic()
        self.first = self.first or (now, at)     # with what was before it, the set-up, behind it
        seconds, share = now - self.first[0], at.share - self.first[1].share
        if self.judged or seconds < FIRST or share <= 0:
            return
        whole = seconds / share * sum(self.line.costs.values()) / self.line.costs[self.part]
        if whole > LONG:
            self.line.say(f"{self.scene.name}: about {whole / 60:.0f} min, for some {at.steps / at.share:.0f} steps of {at.unknowns} "
                          f"unknowns: {entry(self.scene, at, self.mesh_file)}")
        self.judged = whole > LONG or seconds > LAST


def entry(scene: Scene, at: At, mesh_file: Path | None) -> str:
    """The entry of the scene that makes it long."""
    given = scene.values | scene.sizes
    if at.apart > APART:
        return f"a stiff body beside a soft one, whose waves take {at.apart:.0f} times as long as those that set the steps (young, density)"
    if at.steps / at.share / USUAL.steps > at.unknowns / USUAL.unknowns:
        names = ("dt", "end_time", *(["integrator"] if given["integrator"] == "central-difference" else []))
    elif mesh_file:
        return f"the mesh {mesh_file}"
    else:
        names = ("contact_mesh_size", "mesh_size")
    name = next((name for name in names if given.get(name)), "accuracy")
    return f"{name} = {given[name]:g}" if isinstance(given[name], float) else f"{name} = {given[name]}"
