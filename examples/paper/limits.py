"""Sections 2.1 to 2.3: J = 1, and the limits k -> infinity of (10) and epsilon -> 0 of (12)."""

import numpy as np
import pandas as pd

from ffimpact.sweeps import sweep_figures

from .judging import Lost, Results, both, finished, graded, of_laws, states

STIFFNESS, SLIP = "calibrate", "slip-limit"
COMPRESSIBLE, INCOMPRESSIBLE = "disc-normal-neohookean", "disc-normal-incompressible"
# Change of the volume of an element below which a run conserves it.
ISOCHORIC = 1e-6
FORMULAS = {"sqrt": "φ¹", "tanh": "φ²", "linear": "φ³"}


@states("Section 2.1, equation (6)", "if J = 1 a neo-Hookean incompressible solid is modelled", figures="",
        runs=lambda results: results.folders(COMPRESSIBLE, INCOMPRESSIBLE))
def incompressible(results: Results) -> tuple[str, str]:
    """Agrees if the run with law = incompressible conserves the volume of every element to 1e-6: J
    = 1 in the mean, not at points."""
    held, free = (results.summary(name) for name in (INCOMPRESSIBLE, COMPRESSIBLE))
    return graded(held["volume_change"] < ISOCHORIC), (
        f"the run with law = incompressible keeps the volume of its elements to {held['volume_change']:.0e} (at points J is from "
        f"{held['min_jacobian']:.3f}); the compressible neo-Hookean disc (ν = 0.45, 8 m/s) goes down to J = "
        f"{free['min_jacobian']:.3f}. Contact lasts "
        f"{both([1e3 * end['thresholded_contact_time'] for end in (held, free)], '.3g')} ms.")


@states("Section 2.2, equations (7), (10)",
        "for a sufficiently large k the regularised contact (10) approximates Signorini's condition (7)", STIFFNESS)
def stiff_limit(results: Results) -> tuple[str, str, Lost]:
    """With a law, for every ν, over k for the disc at 8 m/s: whether the largest penetration falls
    with k and the rebound converges."""
    rows = finished(results, STIFFNESS)

    def judge(_: Results, law: str) -> tuple[bool, str]:
        groups = [group for _, group in rows[rows.law == law].sort_values("penalty").groupby("nu")]
        if not groups:
            return False, "no run"
        depths = [group.max_penetration.to_numpy() for group in groups]
        good = [len(group) > 2 and bool((np.diff(depth) < 0).all()) and settles(group, "rebound_vy")
                for group, depth in zip(groups, depths)]
        first, last = (max(depth[end] for depth in depths) for end in (0, -1))
        ends = "; ".join(dict.fromkeys(_changes(group, "rebound_vy") for group in (groups[0], groups[-1])))
        return all(good), (
            f"for {sum(good)} of {len(good)} ν, penetration from up to {1e3 * first:.2g} down to {1e3 * last:.2g} mm, rebound {ends} m/s")
    around = ("largest penetration, and what each larger k still changes of the rebound with the first and the last ν, from k = "
              f"{rows.penalty.min():.0e} to {rows.penalty.max():.0e} Pa/m; {{}}.")
    return *of_laws(judge, results, around), list(rows[rows.law == "svk"].ellipticity_lost_time)


@states("Section 2.3, equation (12)", "for ε → 0 φ^1, φ^2, φ^3 tend to the step, and a sufficiently small ε serves", SLIP,
        f"{SLIP} friction-laws/friction-laws.png")
def slip_limit(results: Results) -> tuple[str, str]:
    """Agrees if every tabulated φ rises and reaches 0.95 at 4 ε, and rebound and friction work
    converge as ε falls.

    The functions φ depend on v/ε only. The runs are the oblique neo-Hookean impact, which
    converges. Partly if only the functions do.
    """
    laws, rows = results.friction_laws(), finished(results, SLIP).sort_values("slip_velocity", ascending=False)
    reach = {words: _rises(laws[(laws.panel == "b") & (laws.law == law) & (laws.v >= 0)]) for law, words in FORMULAS.items()}
    runs = len(rows) > 2 and all(settles(rows, name) for name in ("rebound_vx", "friction_work"))
    functions = min(reach.values()) >= 0.95
    return graded(functions and runs, functions), (
        f"at the largest tabulated v, {', '.join(f'{words} = {value:.3f}' for words, value in reach.items())} (friction-laws/laws.csv). "
        f"What each smaller ε, {rows.slip_velocity.max():g} to {rows.slip_velocity.min():g} m/s, still changes: of the velocity along "
        f"the plane {_changes(rows, 'rebound_vx')} m/s, of the friction work {_changes(rows, 'friction_work')} J/m.")


def settles(rows: pd.DataFrame, name: str) -> bool:
    """Whether the changes from row to row towards a limit fall until they are within the error
    bars, and the last change is within them."""
    values, bars = rows[name].to_numpy(), sweep_figures.bars(rows, name)
    changes, allowed = np.abs(np.diff(values)), bars[1:] + bars[:-1]
    return bool(((changes[1:] < changes[:-1]) | (changes[1:] <= allowed[1:])).all() and changes[-1] <= allowed[-1])


def _changes(rows: pd.DataFrame, name: str) -> str:
    """First and last change of a number from row to row, with the error bar of the last."""
    values, bars = rows[name].to_numpy(), sweep_figures.bars(rows, name)
    changes = np.abs(np.diff(values))
    return f"{changes[0]:.2g} to {changes[-1]:.2g} ± {bars[-1] + bars[-2]:.1g}" if len(changes) else "nothing"


def _rises(curve: pd.DataFrame) -> float:
    """The last value of a tabulated law over the velocity; 0 if the law decreases anywhere."""
    values = curve.sort_values("v").ratio.to_numpy()
    return float(values[-1]) if (np.diff(values) >= -1e-12).all() else 0.0
