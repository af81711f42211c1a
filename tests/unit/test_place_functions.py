"""Fields at the start of a run: expressions, tables, Python functions of place, and what is refused."""

import numpy as np
import pytest

import ffimpact as ff
from ffimpact.geometry import place_functions
from ffimpact.geometry.place_functions import FOLLOWED, of_entry, tabulated

RUBBER = ff.NeoHookean(young=7e6, nu=0.45, density=1722)
LOW, HIGH = np.array([0.0, -1.0]), np.array([2.0, 1.0])
PLACES = LOW + (HIGH - LOW) * np.random.default_rng(2).uniform(size=(300, 2))


def scene(shape=ff.Disc, top=None, **entries) -> ff.Scene:
    body = {"radius": 0.05, "material": RUBBER, "position": (0, 0.06), "velocity": (0, -3)} | entries
    return ff.Scene(bodies=[shape(**body)], obstacles=[ff.Plane()], **(top or {}))


def test_expressions_of_place():
    field = of_entry("v", [2, "x*y^2 + 1"], 2)
    assert field(np.array([[3.0, 2.0], [0.0, 0.0]])).tolist() == [[2, 13], [2, 1]]


@pytest.mark.parametrize("wave", [1.0, 4.0])
def test_the_table_of_a_function_is_within_its_stated_error(wave):
    """Not only where it was compared; a rougher function has more points."""

    def function(place):
        return 5 * np.sin(wave * place[0]) * np.exp(place[1]), place[0] ** 2

    table = tabulated("v", function, LOW, HIGH)
    exact = np.array([function(place) for place in PLACES])
    off = abs(of_entry("v", table, 2)(PLACES) - exact).max()
    assert off <= 1.5 * FOLLOWED * abs(exact).max()
    assert len(table["values"]) == len(table["x"]) ** 2 and len(table["x"]) == (33 if wave == 1 else 65)


def test_in_space():
    table = tabulated("v", lambda p: p[::-1] * p, np.zeros(3), np.ones(3))
    place = np.array([[0.2, 0.3, 0.9]])
    assert of_entry("v", table, 3)(place) == pytest.approx(place[:, ::-1] * place, abs=1e-5)


REFUSED = {
    "a number": ({"initial_velocity": 3}, "body.1.initial_velocity: '3' is no field (accepted: [vx, vy], each a number"),
    "one component": ({"initial_velocity": ["x"]}, "body.1.initial_velocity: '['x']' is no field"),
    "time": ({"initial_velocity": ["t", 0]}, "body.1.initial_velocity.1: 't' in 't' is not known (accepted: numbers, pi, x, y"),
    "pole": ({"initial_displacement": [0, "1/(y-y)"]}, "body.1.initial_displacement: is [ 0. inf] at ("),
    "three numbers": ({"initial_velocity": lambda p: (0, 0, 1)}, "body.1.initial_velocity: cannot reshape array"),
    "text": ({"initial_velocity": lambda p: "fast"}, "body.1.initial_velocity: could not convert string to float"),
    "infinite": ({"initial_velocity": lambda p: (0, np.inf)}, "body.1.initial_velocity: is not finite at ("),
    "a jump": ({"initial_velocity": lambda p: (0, np.sign(p[0]))}, "body.1.initial_velocity: changes too fast for a table"),
    "bad table": ({"initial_velocity": {"x": [0, 1]}}, "body.1.initial_velocity: '{'x': [0, 1]}' is no field (accepted: a table of x, y"),
    "small table": ({"initial_velocity": {"x": [0, 1, 2, 3], "y": [0, 1, 2, 3], "values": 16 * [[0, 0]]}},
                    "body.1.initial_velocity: is [nan nan] at ("),
    "rigid": ({"rigid": True, "material": None, "density": 1e3, "initial_velocity": [0, "x"]},
              "Disc: initial_velocity: a rigid body has none"),
    "at rest": ({"velocity": None, "initial_velocity": [0, "x"], "top": {"start": "equilibrium", "gravity": 9.81}},
                "body.1.initial_velocity: '[0, 'x']' beside start = 'equilibrium'"),
    "symmetry": ({"initial_velocity": [0, "x"], "top": {"symmetry": "half"}}, "symmetry: half, but the scene is not"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_wrong_fields_are_refused_by_name(case, monkeypatch):
    monkeypatch.setattr(place_functions, "LARGEST", 2**12)
    entries, line = REFUSED[case]
    with pytest.raises(ff.BadInput) as refused:
        scene(**entries)
    assert str(refused.value).startswith(line)


def test_the_mean_of_the_field_is_the_velocity_of_the_body():
    """The rest of the field has no mean, and both together are the field. A scene that moves by its
    field alone is accepted."""
    field = scene(velocity=None, initial_velocity=[1, "-8 - 100*x^2"])
    body = field.ready().bodies[0]
    assert body.start_velocity == pytest.approx([1, -8 - 100 * 0.05**2 / 4], rel=2e-3)
    place = np.array([[0.03, 0.06]])
    assert body.start_velocity + body.fields["initial_velocity"](place)[0] == pytest.approx([1, -8.09])


def test_a_function_and_its_table_are_the_same_scene(tmp_path):
    first = scene(initial_velocity=lambda p: (0, -3 * np.cos(20 * p[0])))
    again = ff.Scene.load(first.save(tmp_path / "scene.toml"))
    assert again == first
    ball = ff.Scene(bodies=[ff.Ball(radius=0.05, material=RUBBER, position=0.06, velocity=-3,
                                    initial_displacement=lambda p: (0.01 * np.sqrt(p[0]) ** 2, 0))],
                    obstacles=[ff.Plane()], dimension="axisymmetric")  # fmt: skip
    assert min(ball.table()["body"][0]["initial_displacement"]["x"]) == 0
