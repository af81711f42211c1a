"""The largest step is a share of the time that a wave takes across a body or its wall."""

import math

import pytest

from verification.measure import bodies

RADIUS, YOUNG, NU, DENSITY = 0.05, 1e6, 0.3, 1000
WAVE = math.sqrt(YOUNG * (1 - NU) / ((1 + NU) * (1 - 2 * NU)) / DENSITY)  # speed of pressure waves [m/s]
FALLING = {"radius": RADIUS, "position": [0, 1.01 * RADIUS], "velocity": [0, -0.3]}
SHAPES = {
    "disc": ({"shape": "disc"}, 2 * RADIUS),
    "ring": ({"shape": "ring", "inner_radius": 0.8 * RADIUS}, 2 * 0.2 * RADIUS),
}


@pytest.mark.parametrize("accuracy", [0.02, 0.05, 0.1])
@pytest.mark.parametrize("shape", SHAPES)
def test_the_largest_step_follows_the_wall_and_the_root_of_the_accuracy(tmp_path, shape, accuracy):
    """The transit is that across a solid body, and twice that across the wall of a hollow one, so
    that step and mesh follow the same length. Runs with sqrt(2) times larger elements, which have
    twice the accuracy, have sqrt(2) times larger steps."""
    entries, across = SHAPES[shape]
    run = bodies(tmp_path, {"law": "neohookean", "young": YOUNG, "nu": NU, "density": DENSITY, "accuracy": accuracy, "body": [FALLING | entries],
                            "obstacle": [{"kind": "plane", "point": [0, 0], "normal": [0, 1]}]})
    pressed = run.history["normal_force"] > 0
    first = slice(pressed.argmax(), pressed.argmax() + pressed[pressed.argmax():].argmin())  # contact
    assert run.history["dt"][first].max() == pytest.approx(math.sqrt(accuracy / 2.5e-3) / 16 * across / WAVE, rel=1e-4)
