"""Scenes with friction: loading, runs, reports and the figures 4 to 6 of the paper."""

import pytest

from ffimpact.__main__ import main


@pytest.mark.robustness
def test_compare_runs_reports_and_draws(fake, tmp_path, capsys):
    """Each scene runs once with a coarser run for its error, is reported and compared in one
    figure. A second call reuses all."""
    arguments = ["compare", "disc-oblique-svk", "disc-oblique", "--out", str(tmp_path / "both"), "--set", "fields=0"]
    assert main(arguments) == 0 and fake.starts() == 4
    out = capsys.readouterr().out
    assert "disc-oblique-svk: finished" in out and out.strip().endswith("disc-oblique-svk-and-disc-oblique.png")
    assert (tmp_path / "both/disc-oblique-svk-and-disc-oblique.png").stat().st_size > 20_000
    assert main(arguments) == 0 and fake.starts() == 4
