"""Compares runs of several scenes: their reports, and one figure of their forces, energies and
velocities.
"""

import argparse
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from .. import progress
from ..failure import BadInput, Failure
from ..input.parameters import Table, add_set, overrides
from ..output.evaluate import evaluate
from ..output.folder import result_folder
from ..output.results import Record, body_names, mechanical_energy, read_record, suffixes
from ..places import RESULTS, shown
from ..running.run import run
from ..scene import Scene, load
from . import report
from .figures import (
    ABOVE,
    BLUE,
    GREEN,
    GREY,
    LAWS,
    ORANGE,
    PURPLE,
    contact_bounds,
    per_metre,
    save,
    styled,
)

__all__ = ["contact_force", "draw", "main", "mass_of"]


def main(argv: list[str]) -> int:
    """Runs or reuses every scene, prints the reports and draws DIR/<names>.png. After a scene that
    fails the others still run; the first failure is raised at the end.
    """
    parser = argparse.ArgumentParser(prog="ffimpact compare", description=__doc__)
    parser.add_argument(
        "scenes",
        metavar="SCENE",
        nargs="+",
        help="two or more built-in scenes, TOML files, or folders of finished runs",
    )
    add_set(parser, "set a parameter in all of them")
    parser.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        default=RESULTS,
        help="a folder for a folder of each scene",
    )
    options = parser.parse_args(argv)
    scenes, folder = [_scene_or_run(name) for name in options.scenes], result_folder(options.out)
    if len({candidate.name for candidate in scenes}) < max(2, len(scenes)):
        raise BadInput("compare: two or more different scenes are needed")
    results, failed = {}, None
    for loaded in progress.in_turn("compare", scenes):
        try:
            if isinstance(loaded, Path):
                result = _finished(loaded)
            else:
                result = run(loaded, overrides(options.set), folder / loaded.name)
            results[loaded.name] = result
            report.draw(result)
            print(report.report(result) + "\n")
        except Failure as failure:
            print(f"{loaded.name}: failed: {failure}\n")
            failed = failed or failure
    if len(results) > 1:
        path = folder / ("-and-".join(results) + ".png")
        folder.mkdir(parents=True, exist_ok=True)
        draw(results, path)
        print(f"compared in {shown(path)}")
    if failed:
        raise failed
    return 0


def _scene_or_run(name: str) -> Scene | Path:
    """Returns the folder of a finished run, or loads a scene."""
    return Path(name) if Path(name).is_dir() else load(name)


def _finished(folder: Path) -> Record:
    """Returns the run in a folder, evaluated if it is of an .edp script."""
    evaluate(folder)
    return read_record(folder)


def draw(results: dict[str, Record], path: Path) -> None:
    """Draws normal force, friction force, total energy and the velocities (of each body) over time,
    with one colour for each run. If no run has friction, the largest penetration replaces the
    friction force.

    Total energies, which often coincide, are drawn with alternating dashes. If the runs mix forces
    per metre (discs) with forces (balls), the figure shows the acceleration of the centre of mass
    (figure 11; of the first one of several bodies) instead of the force, and energies relative to
    the initial energy.
    """
    mixed = len({per_metre(result.scene) for result in results.values()}) > 1
    rubs = any(result.history["friction_force"].any() for result in results.values())
    with styled():
        figure, grid = plt.subplots(2, 2, figsize=(8.2, 5.6), sharex=True, layout="constrained")
        (force, drag), (energy, velocity) = grid
        for k, ((name, result), colour) in enumerate(
            zip(results.items(), (BLUE, ORANGE, GREEN, PURPLE) * len(results))
        ):
            h, used = result.history, result.scene
            t, per = 1e3 * h["t"], per_metre(used)
            heavy, start = (
                (mass_of(result), result.summary["energy_initial"]) if mixed else (1.0, 1.0)
            )
            force.plot(
                t,
                1e-3 * (contact_force(h) if mixed else h["normal_force"]) / heavy,
                color=colour,
                label=f"{name}: {_material(used)}{result.summary['dofs']} dofs",
            )
            if when := contact_bounds(result.summary):
                force.axvline(1e3 * when[1], color=colour, linestyle=":", linewidth=0.9)
            drag.plot(
                t,
                1e-3 * h["friction_force"] / heavy if rubs else h["max_penetration"] * 1e3,
                color=colour,
            )
            energy.plot(
                t,
                mechanical_energy(h) / start,
                color=colour,
                linewidth=2.4,
                linestyle=(2 * k, (2, 2 * len(results) - 2)),
            )
            energy.plot(t, h["elastic"] / start, color=colour, linewidth=0.9)
            for suffix, body in zip(suffixes(h), body_names(used)):
                if suffix and colour == BLUE:  # labels the bodies of the first run only
                    velocity.annotate(
                        body,
                        (t[-1], h[f"vy{suffix}"][-1]),
                        xytext=(-4, 4),
                        textcoords="offset points",
                        ha="right",
                    )
                velocity.plot(t, h[f"vy{suffix}"], color=colour, linestyle="--")
                if np.any(h[f"vx{suffix}"]):
                    velocity.plot(t, h[f"vx{suffix}"], color=colour)
                    velocity.plot(
                        t,
                        -result.summary[f"reach{suffix}"] * h[f"spin{suffix}"],
                        color=colour,
                        linestyle=":",
                    )
        for axes in (drag, velocity):
            axes.axhline(0, color=GREY, linewidth=0.6)
        force.set(
            ylabel="normal acceleration [10³ m/s²]" if mixed else f"normal force [kN{per}]",
            ylim=(0, None),
        )
        drag.set_ylabel(
            ("acceleration by friction [10³ m/s²]" if mixed else f"friction force [kN{per}]")
            if rubs
            else "largest penetration [mm]"
        )
        energy.set(
            ylabel="energy over that at the start" if mixed else f"energy [J{per}]",
            ylim=(0, None),
            xlabel="time [ms]",
        )
        _key(force, {"end of the contact": ":"})
        _key(energy, {"total": "--", "elastic": "-"})
        velocity.set(ylabel="velocity [m/s]", xlabel="time [ms]")
        _key(velocity, {"along x": "-", "along y": "--", "−ωR": ":"} if rubs else {"along y": "--"})
        force.margins(x=0)
        figure.legend(*force.get_legend_handles_labels(), loc="outside upper center", ncols=1)
        save(figure, path)


def contact_force(history: dict[str, np.ndarray]) -> np.ndarray:
    """Returns the contact force on the body normal to the plane. For several bodies it is the
    magnitude of the total contact force on the first one.
    """
    on_first = [
        history[name] for name in ("force_x_1", "force_y_1", "force_z_1") if name in history
    ]
    return np.linalg.norm(on_first, axis=0) if on_first else history["normal_force"]


def mass_of(result: Record) -> float:
    """Returns the mass of the body, or of the first one of several bodies [kg, in plane strain
    kg/m].
    """
    if "mass_1" in result.summary:
        return float(result.summary["mass_1"])
    moves = int(np.argmax(np.abs(result.history["vy"])))
    return float(result.history["momentum_y"][moves] / result.history["vy"][moves])


def _material(used: Table) -> str:
    """Returns law, nu and penalty if all bodies have the same, else an empty text."""
    materials = {(body.get("law"), body.get("nu")) for body in used["body"]}
    law, nu = materials.pop()
    if materials or not law:
        return ""
    return f"{LAWS.get(law, law)}, ν = {nu:g}, k = {report.stiffness(used['contact'])}, "


def _key(axes: Axes, lines: dict[str, str]) -> None:
    """Explains the line styles in a legend above the panel."""
    handles = [Line2D([], [], color="black", ls=line, label=label) for label, line in lines.items()]
    axes.legend(handles=handles, **ABOVE | {"handlelength": 2.4}, ncols=len(lines))
