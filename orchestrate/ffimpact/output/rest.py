"""Estimates the errors of a run until rest: of the number of bounces, of the first restitutions and
of the time of rest.

The flights of two runs have different durations, so one run may be a bounce ahead of the other.
Differences of time histories then do not estimate the errors of these results.
"""

import math

from ..input.parameters import Table
from .results import Answers, suffixes

__all__ = ["DOUBLED", "rest_errors"]

DOUBLED = 2.0  # error estimate over the largest difference of the first restitutions


def rest_errors(fine: Answers, coarse: Answers) -> dict[str, float]:
    """Returns the error estimates of the finer run of a pair; none if a run did not end at rest.

    - `first_restitutions` (absolute): DOUBLED times the largest difference de of a bounce that both
      runs have. One difference can be small by chance, the largest of three rarely is.
    - `rest_time` (relative): with a constant restitution e, bodies that fall from rest bounce for
      t (1 + e)/(1 - e), t the time of the fall. So the estimate is 2 de/(1 - e^2), and at least the
      difference of the runs.
    - `bounces` (relative): their number grows as 1/ln(1/e). So the estimate is de/(e ln(1/e)), and
      at least the difference of the runs.
    - `rebound`, `rebound_spin` (over the speed) and `energy` (over the largest energy): the
      remaining velocities and energy of either run, which are zero at rest.
    """
    summary, other = fine.summary, coarse.summary
    if not summary.get("ended") == other.get("ended") == "rest":
        return {}
    estimates = {
        "rebound": max(
            _speed(run.summary, "rebound_v", "xyz") / fine.speed for run in (fine, coarse)
        ),
        "rebound_spin": max(
            _speed(run.summary, "rebound_spin", ("", "_x", "_y")) / fine.speed
            for run in (fine, coarse)
        ),
        "energy": max(
            summary.get("energy_drift") or 0.0,
            *(
                run.summary["energy_final"] / run.summary["largest_energy"]
                for run in (fine, coarse)
            ),
        ),
        "rest_time": _apart(summary, other, "rest_time"),
        "bounces": _apart(summary, other, "bounces"),
    }
    pairs = list(zip(summary["first_restitutions"], other["first_restitutions"], strict=False))
    if not pairs:
        return estimates
    apart = DOUBLED * max(abs(first - second) for first, second in pairs)
    e = min(0.999, max(0.001, math.prod(first for first, _ in pairs) ** (1 / len(pairs))))
    return estimates | {
        "first_restitutions": apart,
        "rest_time": max(estimates["rest_time"], 2 * apart / (1 - e**2)),
        "bounces": max(estimates["bounces"], apart / (e * math.log(1 / e))),
    }


def _apart(summary: Table, other: Table, name: str) -> float:
    """The difference of a number, relative to the first."""
    return abs(summary[name] - other[name]) / summary[name] if summary[name] else 0.0


def _speed(summary: Table, kind: str, components: str | tuple[str, ...]) -> float:
    """The largest size of a velocity of a body; of a spin that of its rim [m/s]."""
    return max(
        math.hypot(*(summary.get(f"{kind}{component}{end}") or 0.0 for component in components))
        * (summary[f"reach{end}"] if kind == "rebound_spin" else 1.0)
        for end in suffixes(summary)
    )
