"""Helpers that the modules test_disc_block_errors.py share."""

import pandas as pd

from benchmarks import disc_block_errors as block
from ffimpact.sweeps import study

CASE = block.PEER_CASES[0]
MASSES = {"mass_1": 1000.0, "mass_2": 20000.0}
RUN = MASSES | {"exit": 0, "message": "", "rebound_vy_1": 2.0, "rebound_vy_2": -0.6, "vibration_energy_1": 5000.0, "vibration_energy_2": 39400.0,
                "energy_initial": 50000.0, "energy_drift": 1e-11, "thresholded_contact_time": 0.05, "contact_time": 0.055, "dofs": 4000, "steps": 150, "cpu_seconds": 5.0}


def tables(monkeypatch, tmp_path, *changes: dict) -> pd.DataFrame:
    """The table of one case: runs at two accuracies and a reference, with these changes in turn."""
    runs = [RUN | change for change in (*changes, *[{}] * (3 - len(changes)))]
    monkeypatch.setattr(study, "study", lambda points, folder, *_: pd.DataFrame(runs[2:] if folder.name == "finer" else runs[:2]))
    monkeypatch.setattr(block, "read_scene", lambda _: {"body": [{"mesh_size": 0.1, "contact_mesh_size": 0.02}] * 2, "dt": 0.0, "accuracy": 0.005,
                                                         "contact": {"penalty": 1e9, "slip_velocity": 0.05, "friction_dynamic": 0.0}})
    return block.compare([CASE], block.ACCURACIES, tmp_path)
