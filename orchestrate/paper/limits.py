"""Sections 2.1 to 2.3: J = 1, and the limits k -> infinity of (10) and epsilon -> 0 of (12)."""

import numpy as np
import pandas as pd

from ..sweeps import sweep_figures
from .judging import AGREES, DIFFERS, PARTLY, Finding, Results, finished, of_both, states

STIFFNESS, SLIP = "calibrate", "slip-limit"
INCOMPRESSIBLE = "disc-normal-incompressible"   # no scene yet
ISOCHORIC = 1e-3            # |J - 1| below which a run kept its volume
FORMULAS = {"sqrt": "φ¹", "tanh": "φ²", "linear": "φ³"}


@states("Section 2.1, equation (6)", "if J = 1 a neo-Hookean incompressible solid is modelled")
def incompressible(results: Results) -> Finding:
    """Agrees where a run with law = incompressible keeps J = 1 to 1e-3; not met while there is no such run: a compressible law is no answer to it."""
    nearest = results.summary("disc-normal-neohookean")["min_jacobian"]
    beside = f"The compressible neo-Hookean disc (ν = 0.45, 8 m/s) goes down to J = {nearest:.3f}."
    used = [results.run("disc-normal-neohookean")]
    if not results.has(INCOMPRESSIBLE):
        return Finding(DIFFERS, f"not met: there is no run with law = incompressible. {beside}", runs=used)
    off = abs(results.summary(INCOMPRESSIBLE)["min_jacobian"] - 1)
    return Finding(AGREES if off < ISOCHORIC else DIFFERS, f"the run with law = incompressible keeps J = 1 to {off:.0e}. "
                                                           f"{beside}", runs=[*used, results.run(INCOMPRESSIBLE)])


@states("Section 2.2, equations (7), (10)", "for a sufficiently large k the regularised contact (10) approximates Signorini's condition (7)")
def stiff_limit(results: Results) -> Finding:
    """With a law, for every ν, over k on the disc at 8 m/s: where the largest penetration falls with every larger k and the rebound settles."""
    rows = finished(results, STIFFNESS)
    lost = list(rows[rows.law == "svk"].ellipticity_lost_time)

    def of(law: str) -> tuple[bool, str]:
        good, depths, left = [], [], []
        for _, group in rows[rows.law == law].sort_values("penalty").groupby("nu"):
            depth = group.max_penetration.to_numpy()
            good.append(len(group) > 2 and bool((np.diff(depth) < 0).all()) and settles(group, "rebound_vy"))
            depths.append(depth[[0, -1]])
            left.append(_changes(group, "rebound_vy"))
        if not good:
            return False, "no run"
        first, last = (max(depth[end] for depth in depths) for end in (0, 1))
        ends = "; ".join(dict.fromkeys((left[0], left[-1])))
        return all(good), f"for {sum(good)} of {len(good)} ν, penetration from up to {1e3 * first:.2g} down to {1e3 * last:.2g} mm, rebound {ends} m/s"
    verdict, words = of_both(of)
    return Finding(verdict, f"largest penetration, and what each larger k still changes of the rebound with the first and the last ν, from k = "
                            f"{rows.penalty.min():.0e} to {rows.penalty.max():.0e} Pa/m; {words}.",
                   results.drawn(STIFFNESS), results.sweep_runs(STIFFNESS), lost)


@states("Section 2.3, equation (12)", "for ε → 0 φ^1, φ^2, φ^3 tend to the step, and a sufficiently small ε serves")
def slip_limit(results: Results) -> Finding:
    """Agrees where every tabulated φ rises and reaches 0.95 at 4 ε (they hang on v/ε alone), and on the oblique neo-Hookean impact, which converges, rebound
    and friction work settle as ε falls; partly where the functions do alone."""
    laws, rows = results.friction_laws(), finished(results, SLIP).sort_values("slip_velocity", ascending=False)
    reach = {words: _rises(laws[(laws.panel == "b") & (laws.law == law) & (laws.v >= 0)]) for law, words in FORMULAS.items()}
    numbers = ("rebound_vx", "friction_work")
    runs = len(rows) > 2 and all(settles(rows, name) for name in numbers)
    functions = min(reach.values()) >= 0.95
    return Finding(AGREES if functions and runs else PARTLY if functions else DIFFERS, f"at the largest tabulated v, "
                                                                                       f"{', '.join(f'{words} = {value:.3f}' for words, value in reach.items())} "
                   f"(friction-laws/laws.csv). What each smaller ε, {rows.slip_velocity.max():g} to {rows.slip_velocity.min():g} m/s, still changes: of the "
                   f"velocity along the plane "
                   f"{_changes(rows, 'rebound_vx')} m/s, of the friction work {_changes(rows, 'friction_work')} "
                   f"J/m.", [*results.drawn(SLIP), results.folder / "friction-laws/friction-laws.png"],
                   results.sweep_runs(SLIP))


def settles(rows: pd.DataFrame, name: str) -> bool:
    """Whether, row by row towards a limit, what changes from one to the next falls until it is within their error bars, and ends there."""
    values, bars = rows[name].to_numpy(), sweep_figures.bars(rows, name)
    changes, allowed = np.abs(np.diff(values)), bars[1:] + bars[:-1]
    return bool(((changes[1:] < changes[:-1]) | (changes[1:] <= allowed[1:])).all() and changes[-1] <= allowed[-1])


def _changes(rows: pd.DataFrame, name: str) -> str:
    """First and last change of a number from row to row, with the error bar of the last."""
    values, bars = rows[name].to_numpy(), sweep_figures.bars(rows, name)
    changes = np.abs(np.diff(values))
    return f"{changes[0]:.2g} to {changes[-1]:.2g} ± {bars[-1] + bars[-2]:.1g}" if len(changes) else "nothing"


def _rises(curve: pd.DataFrame) -> float:
    """The last value of a tabulated law over the velocity; 0 where it falls somewhere."""
    values = curve.sort_values("v").ratio.to_numpy()
    return float(values[-1]) if (np.diff(values) >= -1e-12).all() else 0.0
