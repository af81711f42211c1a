"""The examples of the pages about scenes, supports and loads are scenes, and those in Python are the
same scenes as those in TOML."""

import re
import tomllib

import pytest

import ffimpact as ff
from ffimpact.places import ROOT
from ffimpact.scene import read

# Tables that the page shows alone are completed with these.
TOP = {"law": "neohookean", "young": 7e6, "nu": 0.45, "density": 1722}
DISC = {"shape": "disc", "radius": 0.05, "position": [-0.2, 0.06], "velocity": [0, -1]}
FLOOR = {"kind": "plane"}


def blocks(page: str) -> list[tuple[str, str]]:
    """The examples of a page: language and text."""
    return re.findall(r"```(toml|python)\n(.*?)```", (ROOT / f"docs/how-to/{page}.md").read_text(), re.S)


@pytest.mark.parametrize("page, pairs", [("scenes", 3), ("supports-and-loads", 3)])
def test_examples_are_scenes_and_the_same_in_python(page, pairs, tmp_path, monkeypatch):
    """Each example in TOML is accepted. An example in Python that follows one is the same scene."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(ff, "run", lambda scene: Answers())
    names, written, compared = {}, None, 0
    for kind, text in blocks(page):
        if kind == "toml":
            tables = TOP | {"body": [DISC]} | tomllib.loads(text)
            written = read(tables if len(tables["body"]) > 1 else {"obstacle": [FLOOR]} | tables, tmp_path, "page")
            continue
        text = re.sub(r"(?m)^(ff\.Scene\()", r"scene = \1", text)
        exec(text, names)  # noqa: S102
        same = names["scene"].ready()
        for name in ("values", "contact"):
            assert getattr(same, name) == getattr(written, name), (page, name)
        assert [pair.own for pair in same.pairs] == [pair.own for pair in written.pairs]
        assert [obstacle.numbers for obstacle in same.obstacles] == [obstacle.numbers for obstacle in written.obstacles]
        assert [described(body) for body in same.bodies] == [described(body) for body in written.bodies]
        compared += 1
    assert compared == pairs


class Answers(dict):
    """A result whose numbers and histories are all 1."""

    def __missing__(self, name: str) -> float:
        return 1.0

    def __getattr__(self, name: str):
        return self

    def max(self) -> float:
        return 1.0


def described(body) -> tuple:
    """What two bodies have in common if they are the same."""
    own = body.made_of.young, body.made_of.nu, body.made_of.density, body.made_of.loss, body.start_angle, body.start_spin
    conditions = [[repr(condition.part) for condition in listed] for listed in (body.supports, body.loads)]
    return own, list(body.start_position), list(body.start_velocity), body.outline.area, conditions
