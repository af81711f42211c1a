"""Where the time goes and how it grows: the phases of a run, its floor, and time and memory over the degrees of freedom.

The floor of a step is what no arrangement of the same method saves: the operators (gradient, its transpose, mass) once through
memory for each residual that the run evaluated, and its back-substitutions.
"""

import time
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

from .. import run, scene
from ..output import results
from ..failure import Failure
from ..places import shown
from ..progress import in_turn
from ..report.figures import BLUE, GREY, ORANGE, STYLE, save
from ..sweeps import study

PHASES = ("assembly", "factor", "solve", "contact", "search", "output", "audit", "setup", "other")
LIMIT = 900.0                                   # seconds a run may take
DOFS = (1e3, 3e3, 1e4, 3e4, 1e5, 2e5)           # wanted
STEPS, DT = 20, 2e-5                            # of the growth runs, from the touch on
CASES = {                                       # of the profile: scene and what is set
    "normal-svk": ("disc-normal", {}),
    "normal-neohookean": ("disc-normal", {"law": "neohookean"}),
    "oblique": ("disc-oblique", {}),
    "normal-svk, 10,000 dofs": ("disc-normal", {"mesh_size": 2.0e-3, "contact_mesh_size": 1.0e-3, "dt": DT}),
}


def main(argv: list[str]) -> int:
    """Prints both tables, writes profile.csv, growth.csv and growth.png."""
    parser = study.command("costs", __doc__)
    parser.add_argument("--quick", action="store_true", help="small meshes only")
    options = parser.parse_args(argv)
    out = options.out
    rate = bandwidth()
    profiles = profile(out, rate, options.quick)
    study.save(profiles, out / "profile.csv")
    print(f"Seconds of processor time by phase (other: mixing, line search, and waiting for the processor); floor at {rate / 1e9:.1f} GB/s\n")
    print(study.table(profiles, {"case": "", "dofs": ".0f", "steps": ".0f"} | dict.fromkeys(PHASES, ".2f")
                      | {"wall": ".2f", "ms a step": ".2f", "floor, ms a step": ".2f", "over floor": ".1f"}))
    growing, laws = growth(out, options.quick)
    study.save(growing, out / "growth.csv")
    draw(growing, laws, out / "growth.png")
    print(f"\nThe first {STEPS} steps of {DT:g} s of the normal impact\n")
    print(study.table(growing, {"dofs": ".0f", "seconds": ".2f", "ms a step": ".1f", "set-up": ".2f", "memory, MB": ".0f"}))
    print("\n" + "; ".join(f"{name} grows with dofs^{power:.2f}" for name, (power, _) in laws.items()))
    print(f"{shown(out)}/profile.csv, growth.csv, growth.png")
    return 0


def bandwidth() -> float:
    """Bytes a second that one core reads from memory: a sum over 256 MB, the fastest of five."""
    block = np.ones(2**25)
    times = []
    for _ in range(5):
        start = time.perf_counter()
        block.sum()
        times.append(time.perf_counter() - start)
    return block.nbytes / min(times)


def profile(out: Path, rate: float, quick: bool) -> pd.DataFrame:
    """A row a case: seconds by phase, their sum (the wall time), and a step beside its floor; rate: bytes a second."""
    rows = []
    for name, (wanted, point) in in_turn("costs", list(CASES.items())[:2 if quick else None]):
        result = run.run(scene.load(wanted), {"fields": 0} | point, out / "runs" / name.replace(",", "").replace(" ", "-"), force=True)
        end = result.summary
        phases = end["phase_seconds"]
        floor = end["residual_evaluations"] * end["operator_bytes"] / rate + phases["solve"]
        marching = end["cpu_seconds"] - phases["setup"]
        rows.append({"case": name, "dofs": end["dofs"], "steps": end["steps"]} | {phase: phases[phase] for phase in PHASES}
                    | {"wall": end["wall_seconds"], "ms a step": 1e3 * marching / end["steps"], "floor, ms a step": 1e3 * floor / end["steps"],
                       "over floor": marching / floor})
    return pd.DataFrame(rows)


def growth(out: Path, quick: bool) -> tuple[pd.DataFrame, dict[str, tuple[float, float]]]:
    """A row a mesh: dofs, seconds of processor time, of a step and of the set-up, memory [MB]; and the fitted power laws
    value = factor dofs^power from the four largest, as name: (power, factor)."""
    points = []
    for dofs in DOFS[:3] if quick else DOFS:
        factor = (1028 / dofs) ** (1 / 1.79)      # that mesh has 1,028; all elements shrink alike, the graded ones fewer at first
        points.append({"mesh_size": float(f"{factor * study.BULK:.4g}"), "contact_mesh_size": float(f"{factor * study.CONTACT:.4g}")})
    rows = study.study(points, out, {"fields": 0, "dt": DT, "end_time": STEPS * DT}, LIMIT, cores=1)
    if rows.exit.any():
        raise Failure(f"costs: {rows.message[rows.exit != 0].iloc[0]}", int(rows.exit.max()))
    setup = pd.Series([results.read_summary(study.place(out, point))["phase_seconds"]["setup"] for point in points])
    table = pd.DataFrame({"dofs": rows.dofs, "seconds": rows.cpu_seconds, "ms a step": 1e3 * (rows.cpu_seconds - setup) / rows.steps,
                          "set-up": setup, "memory, MB": rows.peak_memory / 1e6})
    laws = {}
    for name in ("ms a step", "memory, MB"):
        power, log = np.polyfit(np.log(table.dofs[-4:]), np.log(table[name][-4:]), 1)
        laws[name] = float(power), float(np.exp(log))
    return table, laws


def draw(table: pd.DataFrame, laws: dict[str, tuple[float, float]], path: Path) -> None:
    """Time of a step and memory over the degrees of freedom, with the fitted laws."""
    with plt.rc_context(STYLE):
        figure, panels = plt.subplots(1, 2, figsize=(7.6, 3.4))
        for axes, (name, (power, factor)), colour in zip(panels, laws.items(), (BLUE, ORANGE)):
            axes.loglog(table.dofs, table[name], color=colour, marker="o", markersize=4, linestyle="")
            axes.loglog(table.dofs, factor * table.dofs**power, color=GREY, linestyle="--", label=f"dofs$^{{{power:.2f}}}$")
            axes.set(xlabel="degrees of freedom", ylabel={"ms a step": "processor time of a step [ms]", "memory, MB": "peak memory [MB]"}[name])
            axes.grid(alpha=0.3)
            axes.legend()
        figure.suptitle(f"Normal impact, the first {STEPS} steps of {DT:g} s", fontsize=9)
        with study.complete(path) as part:
            save(figure, part)
