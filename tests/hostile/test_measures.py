"""Measurements of runs: run time against error, runs without savings, other units, phases."""

import numpy as np
import pandas as pd
import pytest

from benchmarks import bench
from ffimpact.output import results


@pytest.mark.robustness
def test_bench_on_coarse_runs(tmp_path, monkeypatch, capsys):
    """There is a row for each setting with time and errors, which fall with refinement. The page,
    the figure and the CSV file exist."""
    monkeypatch.setattr(bench, "settings", lambda *_: {"adaptive, P2": [{"accuracy": 0.05}, {"accuracy": 0.005}], "bdf2": [{"accuracy": 0.05, "integrator": "bdf2"}]})
    monkeypatch.setattr(bench, "references", lambda *_: [{"accuracy": 0.0025}, {"accuracy": 0.002}])
    monkeypatch.setattr(bench, "PEERS_QUICK", {"normal-svk": [("ngsolve", "tuned", 2, 1e-4), ("textbook", "FreeFEM", 2, 1e-4)]})
    monkeypatch.setattr(bench.peers, "run", lambda *_, **__: (None, "is not installed"))
    assert bench.main(["--quick", "--out", str(tmp_path)]) == 0
    table = pd.read_csv(tmp_path / "bench.csv")
    assert len(table) == 5 and table.seconds[:3].notna().all() and table.impulse_error[4] < 5 and table.force_error[0] > table.force_error[1] > 0
    text = (tmp_path / "bench.md").read_text()
    assert "Cheapest setting" in text and "- ngsolve" in text and "is not installed" in text and (tmp_path / "normal-svk.png").exists()
    assert text.strip() in capsys.readouterr().out


@pytest.mark.robustness
def test_bench_of_the_ball(tmp_path, monkeypatch):
    """The ball in three dimensions has small errors relative to the body of revolution, and the
    other program gets the settings of ours."""
    calls = []
    monkeypatch.setattr(bench, "settings", lambda *_: {"adaptive, P2": [{"accuracy": 0.1}]})
    monkeypatch.setattr(bench, "references", lambda *_: [{"accuracy": 0.01}, {"accuracy": 0.008}])
    monkeypatch.setattr(bench.peers, "run", lambda *arguments, **flags: calls.append((arguments, flags)) or (None, "is not installed"))
    assert bench.main(["--quick", "ball", "--out", str(tmp_path)]) == 0
    table = pd.read_csv(tmp_path / "bench.csv")
    assert table.impulse_error[0] < 1 and table.rebound_vy_error[0] < 1 and table.force_error[0] < 10 and table.message[1] == "is not installed"
    assert calls[0][1]["scene"] == "ball" and calls[0][1]["penalty"] == 1.5e10 and (tmp_path / "ball-axisymmetric/runs").is_dir()


@pytest.mark.robustness
def test_bench_of_two_bodies(tmp_path, monkeypatch):
    """The disc on the block: errors of both bodies, errors of the other program for the same
    reference, or the reason why it has no results."""
    monkeypatch.setattr(bench, "settings", lambda *_: {"adaptive, P2": [{"accuracy": 0.1}]})
    monkeypatch.setattr(bench, "references", lambda *_: [{"accuracy": 0.04}, {"accuracy": 0.03}])
    requests, ours = [], {}

    def other(limit, refine, history, **flags):
        requests.append(flags)
        if refine == bench.REFINEMENTS_QUICK[-1]:
            return None, "is not installed"
        runs = tmp_path / "disc-block-svk/runs"
        ours.update(results.read_summary(runs / "accuracy=0.04"))
        t, force = bench.force_of(runs / "accuracy=0.04")
        np.savetxt(history, np.stack([t, force], axis=1), delimiter=",", header="t,normal_force", comments="")
        return {"dofs": 1, "steps": 1, "cpu_seconds": 1.0} | {name: 1.1 * ours[answer] for answer, name in bench.NGSOLVE.items()}, ""

    monkeypatch.setattr(bench.peers, "two_bodies", other)
    assert bench.main(["--quick", "disc-block-svk", "--out", str(tmp_path)]) == 0
    table = pd.read_csv(tmp_path / "bench.csv")
    assert requests == [{"law": "svk", "penalty": 1e9}] * 2 and table.exit.tolist() == [0, 0, 1] and table.message[2] == "is not installed"
    assert all(0 < table[f"{answer}_error"][0] < 30 for answer in bench.NGSOLVE)
    assert table.rebound_vy_2_error[1] == pytest.approx(10, abs=0.5) and table.force_error[1] == pytest.approx(0, abs=1e-6) and table.force_error[0] > 0.1
