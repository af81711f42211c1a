"""Helpers that the modules test_oblique_angles.py share."""

import math

import pandas as pd

from benchmarks import oblique_angles as angles

SLIDES, STICKS = 20.0, 60.0  # degrees, for a friction coefficient of 0.3


def rows(psi_2=None, e=1.0, **columns) -> pd.DataFrame:
    """A run of each body and kind at SLIDES and STICKS with the result of its theory. `columns`
    replaces columns."""
    table = []
    for body, inertia in angles.INERTIA.items():
        for kind in angles.KINDS:
            for angle in (SLIDES, STICKS):
                psi = angles.number(1 / math.tan(math.radians(angle)), 0.3)
                after = angles.elastic(psi, e, inertia) if (body, kind) == ("ball", "slow") else angles.rigid(psi, e, inertia)
                table.append({"body": body, "kind": kind, "friction": 0.3, "angle": angle, "speed": angles.KINDS[kind][body]["speed"], "psi_1": psi, "e": e,
                              "along": 0.7, "psi_2": float(after), "e_error": 0.0, "along_error": 0.0, "psi_2_error": 0.01, "exit": 0, "message": "", "warnings": ""})
    return pd.DataFrame(table).assign(**columns)
