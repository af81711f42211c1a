"""Tests of the scenes of users: their meshes, and the command on the smallest of them."""

import pandas as pd
import pytest

from benchmarks import users
from ffimpact.scenes.assembly import prepare


@pytest.mark.parametrize("name", users.USERS)
def test_a_scene_of_users_has_a_mesh(tmp_path, name):
    """The mesh with the sizes by hand has at most 4000 vertices, and the run has the step by hand."""
    opened = users.USERS[name].open().override(users.USERS[name].by_hand)
    _, used, _ = prepare(opened, tmp_path)
    vertices = int((tmp_path / "mesh.msh").read_text().split()[0])
    assert 50 < vertices <= 4000 and used["dt"] == users.USERS[name].by_hand["dt"]


def test_the_command_measures_a_scene(tmp_path, capsys, monkeypatch):
    """The command runs the disc on a rigid plane with automatic steps and by hand, and writes its
    table and its page. Errors are those against the stored reference."""
    monkeypatch.setattr(users, "RATIOS", {users.RIGID: users.RATIOS[users.RIGID]})
    monkeypatch.setattr(users, "CASES", {f"{users.RATIO}-inf": users.RATIOS[users.RIGID]})
    users.main([users.RATIO, "--out", str(tmp_path / "out"), "--page", str(tmp_path / "users.md")])
    rows = pd.read_csv(tmp_path / "out/users.csv", keep_default_na=False, na_values=[""])
    assert list(rows.setting) == [users.AUTOMATIC, users.BY_HAND] and rows.message.isna().all()
    reference = users.references().loc[(f"{users.RATIO}-inf", rows.answer[0])]
    assert rows["error %"].to_numpy() == pytest.approx(100 * abs(rows.value.to_numpy() / reference.value - 1)) and (rows["error %"] < 2).all()
    assert "1 of 1 runs with automatic steps have ended" in capsys.readouterr().out
    assert "![Scenes of users](users.svg)" in (tmp_path / "users.md").read_text() and (tmp_path / "users-ratio.csv").exists()
