"""Runs the paper's own scripts (edp/*.edp) into results/paper-scripts, draws the force of (14), (15)
beside that of closest points, and prints a table of the answers.

The cases are those of sections 3.1 to 3.3; the runs of pairs.py are the disc on the block on two
meshes, by closest points (9) and by pairs of points (14), (15).
"""

import argparse
import math
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from ffimpact.failure import BadInput, Failure
from ffimpact.freefem import freefem
from ffimpact.mesh import mesh
from ffimpact.output.evaluate import evaluate
from ffimpact.output.folder import result_folder
from ffimpact.output.paper_script import ANSWERS
from ffimpact.output.results import read_history, read_summary
from ffimpact.places import RESULTS, ROOT, shown
from ffimpact.report.figures import BLUE, ORANGE, save, styled

FOLDER, FIGURE = "paper-scripts", "pairs.png"
OBLIQUE = {"law": "neohookean", "speed": 12, "angle": 60, "friction_static": 0.7, "friction_dynamic": 0.5}
# A run: the script and its flags. All other flags have the defaults of the script.
CASES = {
    "disc-normal": ("disc-plane", {}),
    "disc-normal-neohookean": ("disc-plane", {"law": "neohookean"}),
    "disc-normal-incompressible": ("disc-plane", {"law": "incompressible"}),
    "disc-oblique": ("disc-plane", OBLIQUE),
    "disc-oblique-printed": ("disc-plane", OBLIQUE | {"regularization": "linear-printed"}),
    "disc-rolling": ("disc-plane", {"law": "neohookean", "speed": 1, "angle": 0, "gravity": 9.81, "friction_static": 0.5, "friction_dynamic": 0.4,
                                    "slip_velocity": 0.01, "mesh_size": 0.008, "contact_mesh_size": 0.008, "dt": 2e-4, "end_time": 0.2}),
    "disc-block": ("disc-block", {}),
    "ball-axisymmetric": ("ball-axisymmetric", {"law": "neohookean"}),
    "ball": ("ball-plane", {"law": "neohookean"}),
}
# Contact formulations, widths ε of (14) [m] and element sizes near the contact [m] of the pairs; "auto" is one element.
FORMULATIONS, ELEMENT, SEPARATION, SIZES = ("closest-point", "pairwise", "pairwise-printed"), "auto", 0.049, (0.125, 0.1)


def pair(formulation: str, width: str | float) -> list[str]:
    """The names of the runs of a formulation with this ε, on both meshes. Closest points have no ε."""
    end = "" if formulation == "closest-point" else f"-{width}"
    return [f"{formulation}{end}-{size:g}" for size in SIZES]


def runs() -> dict[str, tuple[str, dict]]:
    """All runs, by name."""
    every = dict(CASES)
    for formulation in FORMULATIONS:
        for width in (ELEMENT, SEPARATION):
            for name, size in zip(pair(formulation, width), SIZES):
                flags = {"nu": 0.4, "mesh_size": 0.25, "contact_mesh_size": size, "pairing": formulation}
                every[name] = "disc-block", flags | ({} if width == ELEMENT or formulation == "closest-point" else {"pairing_range": width})
    return every


def on_the_plane(path: Path) -> Path:
    """A copy of the mesh of a body about its centre, moved up until the body touches y = 0."""
    about = mesh.read(path)
    moved = path.with_name("moved.msh")
    mesh.write(replace(about, points=about.points - [0, about.points[:, 1].min()]), moved)
    return moved


def on_the_block(path: Path) -> Path:
    """A copy of the mesh of half a disc above half a block for disc-block.edp: the block's top is y = 0,
    the disc is a quarter radius above it, and the labels are the script's."""
    both = mesh.read(path)
    piece = mesh.pieces(len(both.points), both.triangles)
    disc = piece != piece[both.points[:, 0].argmax()]
    radius, top = np.ptp(both.points[disc, 1]) / 2, both.points[~disc, 1].max()
    points = both.points - [0, top]
    points[disc, 1] += radius / 4 - points[disc, 1].min()
    middle, of_disc = points[both.edges].mean(axis=1), disc[both.edges[:, 0]]
    meets = np.where(of_disc, middle[:, 1] < radius * (1.25 - math.cos(1)), (abs(middle[:, 1]) < 1e-9 * radius) & (middle[:, 0] < radius))
    labels = np.where(both.labels == mesh.AXIS, 2, np.where(meets, np.where(of_disc, 1, 3), np.where(of_disc, 4, 9)))
    moved = path.with_name("moved.msh")
    mesh.write(replace(both, points=points, labels=labels), moved)
    return moved


def sources(script: str) -> Iterator[Path]:
    """The files that a script consists of."""
    yield ROOT / f"edp/{script}.edp"
    yield from (ROOT / "edp/paper").glob("*.idp")


def is_finished(folder: Path, script: str) -> bool:
    """Whether the folder has a run of the present script."""
    answers = folder / ANSWERS
    return answers.exists() and all(answers.stat().st_mtime >= path.stat().st_mtime for path in sources(script))


def compute(folder: Path, script: str, flags: dict) -> None:
    """Runs a script into a folder, unless it is finished. Raises Failure if it does not finish."""
    folder.mkdir(parents=True, exist_ok=True)
    if not is_finished(folder, script):
        code, message = freefem.run(freefem.find(), f"edp/{script}.edp", flags | {"out": folder}, folder / "log.txt")
        if code or not (folder / ANSWERS).exists():
            raise Failure(message or f"edp/{script}.edp stopped with exit code {code}; see {folder / 'log.txt'}", code=code or 1)
    evaluate(folder)


def draw(folder: Path) -> None:
    """Draws the force over time of all formulations on both meshes."""
    with styled():
        figure, grid = plt.subplots(1, len(FORMULATIONS), figsize=(10.2, 3.4), sharey=True, layout="constrained")
        for axes, formulation in zip(grid, FORMULATIONS):
            for width, line in ((ELEMENT, "-"), (SEPARATION, ":"))[: 1 if formulation == "closest-point" else 2]:
                for name, size, colour in zip(pair(formulation, width), SIZES, (ORANGE, BLUE)):
                    history, words = read_history(folder / name), "" if formulation == "closest-point" else ", ε an element" if line == "-" else f", ε = {width} m"
                    axes.plot(1e3 * history["t"], 1e-3 * history["normal_force"], line, color=colour, linewidth=0.9, label=f"elements of {size:g} m{words}")
            axes.set(title=formulation, xlabel="time [ms]")
            axes.legend(fontsize=6)
        grid[0].set_ylabel("force [kN/m]")
        save(figure, folder / FIGURE)


def main(argv: list[str]) -> int:
    """Runs what is not finished, two scripts at a time."""
    parser = argparse.ArgumentParser(prog="python -m examples.paper.scripts", description=__doc__)
    parser.add_argument("--results", metavar="DIR", type=Path, default=RESULTS, help="where the cases are (default: results)")
    parser.add_argument("--only", metavar="RUN", nargs="+", default=[], help="run these only, without the figure")
    options = parser.parse_args(argv)
    every, folder = runs(), result_folder(options.results) / FOLDER
    if wrong := [name for name in options.only if name not in every]:
        raise BadInput(f"--only: '{wrong[0]}' is no run (accepted: {', '.join(every)})")
    names = options.only or list(every)
    with ThreadPoolExecutor(2) as pool:
        list(pool.map(lambda name: compute(folder / name, *every[name]), names))
    for name in names:
        end = read_summary(folder / name)
        speeds = " ".join(f"{axis} {end[axis]:.4g}" for axis in end if axis.startswith("rebound_v") and end[axis])
        print(f"{name}: contact {1e3 * end['contact_time']:.4g} ms, impulse {end['impulse']:.5g}, {speeds} m/s, drift {end['energy_drift']:.0e}, "
              f"{end['dofs']} unknowns, {end['cpu_seconds']:.0f} s")
    if not options.only:
        draw(folder)
    print(shown(folder))
    return 0


if __name__ == "__main__":
    import sys

    from ffimpact.__main__ import guarded

    sys.exit(guarded(main, sys.argv[1:]))
