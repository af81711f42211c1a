"""Section 3.2: closest points (9), their cost, and contact (14), (15) without a search for them.

The case is the disc on the block on two meshes: the cost by the program (sweep closest-points), (14) and
(15) by the paper's own script edp/disc-block.edp (scripts.py).
"""

from collections.abc import Callable
from pathlib import Path

from . import scripts
from .judging import Results, both, graded, lost, states

SEARCH, LAW = "closest-points", {"law": "svk"}
# Two contact formulations agree up to this difference of the rebound velocities over the speed, and
# of the impulse.
SAME = 0.01
# A search is expensive above this share of the processor time.
DEAR = 0.1
PRINTED = {"pairwise": "with a repulsion that vanishes at ε", "pairwise-printed": "as printed"}
# ε equals an element size in the contact region.
ELEMENT, DRAWN = scripts.ELEMENT, f"{scripts.FOLDER}/{scripts.FIGURE}"
LOST = lost((SEARCH, LAW))


def runs(results: Results) -> list[Path]:
    """The runs of the program by closest points, on both meshes."""
    return results.pair(SEARCH, **LAW)


def script_runs(*widths: str | float) -> Callable[[Results], list[Path]]:
    """The runs of the paper's script by all formulations with these ε [m], without duplicates."""
    names = dict.fromkeys(name for width in widths for formulation in scripts.FORMULATIONS for name in scripts.pair(formulation, width))
    return lambda results: [results.folder / scripts.FOLDER / name for name in names]


@states("Section 3.2, equation (9)", "the minimum distance is found at each instant at the cost of CPU time", runs, SEARCH, LOST)
def search_costs(results: Results) -> tuple[str, str]:
    """Agrees if the search for closest points takes more than a tenth of the processor time on both
    meshes, partly if it does on one.
    """
    ends = results.summaries(SEARCH, **LAW)
    shares = [end["phase_seconds"]["search"] / end["cpu_seconds"] for end in ends]
    dear = [share > DEAR for share in shares]
    return graded(all(dear), any(dear)), (
        f"the search takes {' and '.join(f'{100 * share:.0f} %' for share in shares)} of {both([end['cpu_seconds'] for end in ends], '.1f')} s of processor time on two "
        f"meshes. More than {100 * DEAR:g} % is asked; boxes leave few edges to a point.")


@states("Section 3.2, equations (14), (15)", "a sum over all points nearer than ε takes the place of the closest points", script_runs(ELEMENT),
        DRAWN, LOST)
def sum_of_points(results: Results) -> tuple[str, str]:
    """As printed, on two meshes: agrees if rebounds and impulse equal those of closest points to 1
    % with the same number of contact intervals.

    Partly if only rebounds and impulse do, as printed or with a repulsion that vanishes at ε.
    """
    return _beside_closest(results, ELEMENT, "ε an element where the bodies touch")


@states("Section 3.2, equation (15)", "with ε of the order of the separation of the points and a large k a point meets a single one of the "
        "other body, and nothing has to be sought", script_runs(ELEMENT, scripts.SEPARATION), DRAWN, LOST)
def single_point(results: Results) -> tuple[str, str]:
    """As (14), (15) with this ε. The verdict depends on the results, not on the number of points.
    """
    return _beside_closest(results, scripts.SEPARATION, "ε the separation of the points")


def _beside_closest(results: Results, width: str | float, words: str) -> tuple[str, str]:
    """Verdict and words of (14), (15) with ε = `width`, compared with closest points."""
    nearest = results.by_scripts("closest-point", ELEMENT)
    usual, same, as_often, sentences = [near["contact_intervals"] for near in nearest], {}, {}, []
    for pairing, how in PRINTED.items():
        ends = results.by_scripts(pairing, width)
        apart, touches = [_apart(*pair) for pair in zip(ends, nearest)], [end["contact_intervals"] for end in ends]
        peaks = both([end["peak_force"] / near["peak_force"] for end, near in zip(ends, nearest)], ".2f")
        slip = any("slip through" in warning for end in ends for warning in end["warnings"])
        same[pairing] = max(apart) <= SAME and not slip
        as_often[pairing] = all(count <= limit for count, limit in zip(touches, usual))
        sentences.append(f"{how} {' and '.join(f'{100 * value:.1f} %' for value in apart)} off, touching {both(touches)} times, peak force "
                         f"{peaks} times that of closest points" + ", points slip through between each other" * slip)
    return graded(same["pairwise-printed"] and as_often["pairwise-printed"], any(same.values())), (
        f"{words}, on two meshes (closest points touch {both(usual)} times): {'; '.join(sentences)}. As printed the force jumps to its "
        f"largest where points come within ε.")


def _apart(end: dict, nearest: dict) -> float:
    """The largest difference of both rebound velocities over the speed, and of the impulse."""
    speed = abs(nearest["rebound_vy_1"] - nearest["impulse_y_1"] / nearest["mass_1"])
    rebounds = [abs(end[f"rebound_vy_{b}"] - nearest[f"rebound_vy_{b}"]) / speed for b in (1, 2)]
    return max(*rebounds, abs(end["impulse_y_1"] / nearest["impulse_y_1"] - 1))
