"""Evaluates what the contact points of each pair bore, from the steps that FreeFEM has recorded in
contacts.bin: the largest load and the points that carried it, their penetration, and the share of
contacts that began at a sharp corner.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..input.parameters import Table
from .contacts import Interval

__all__ = ["corner_share", "of_pairs", "whole_load"]

# Columns of the rows (edp/program/run/contacts.idp): sum of the sizes of the normal forces, points
# that bear them, their largest penetration, the largest share of facets with a sharp corner in the
# load on a body, and whether both facets of a ridge bear load.
LOAD, POINTS, DEPTH, CORNER, PRESSED = range(36, 41)
# A contact begins at a corner if so much of the load on one body is on facets with a corner.
AT_CORNER = 0.75


def of_pairs(pairs: Sequence[Mapping[str, Any]], intervals: Sequence[Interval]) -> list[Table]:
    """The contact pairs of a record with their largest load `peak` [N/m], the number of points under
    it, and the largest penetrations [m]: of contact points (`at_points`), and of all that is in between,
    too (`deepest`).
    """
    result = []
    for pair in pairs:
        rows = _rows(pair, intervals)
        largest = rows[rows[:, LOAD].argmax()] if len(rows) else np.zeros(PRESSED + 1)
        at_points = float(rows[:, DEPTH].max(initial=0.0))
        result.append(
            dict(pair)
            | {"peak": float(largest[LOAD]), "points_at_peak": int(largest[POINTS])}
            | {"at_points": at_points, "deepest": max(at_points, pair["between"])}
        )
    return result


def whole_load(intervals: Sequence[Interval]) -> float:
    """The impulse of all normal tractions [N s/m]."""
    return float(sum(i.step @ i.rows[:, LOAD] for i in intervals))


def corner_share(
    pairs: Sequence[Mapping[str, Any]], intervals: Sequence[Interval], transit: float
) -> float | None:
    """The share of contacts that began at a sharp corner and press it flat in the impulse of all normal
    tractions; None without contact. A corner is pressed flat once both its sides bear load: if the rim of a face
    strikes first, only one does. A contact ends after the transit time of a wave [s] without load,
    as a face that strikes flat is unloaded in between.
    """
    whole = whole_load(intervals)
    if whole == 0:
        return None
    flat = 0.0
    for pair in pairs:
        for rows in _contacts(_rows(pair, intervals), transit):
            if rows[0, CORNER] >= AT_CORNER and rows[:, PRESSED].any():
                flat += float(rows[:, 2] @ rows[:, LOAD])
    return flat / whole


def _rows(pair: Mapping[str, Any], intervals: Sequence[Interval]) -> np.ndarray:
    """The steps under load of a pair, in order of time."""
    own = [i.rows for i in intervals if i.pair is pair]
    rows = np.concatenate(own) if own else np.zeros((0, PRESSED + 1))
    return rows[np.argsort(rows[:, 1], kind="stable")]


def _contacts(rows: np.ndarray, transit: float) -> list[np.ndarray]:
    """The rows of each contact of a pair."""
    starts, ends = rows[:, 1] - rows[:, 2] / 2, rows[:, 1] + rows[:, 2] / 2
    breaks = 1 + np.flatnonzero(starts[1:] - ends[:-1] > transit)
    return np.split(rows, breaks) if len(rows) else []
