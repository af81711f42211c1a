"""What `start = "equilibrium"` accepts, and overlaps at the start that may be the depth at rest."""

from pathlib import Path

import pytest

from ffimpact.failure import BadInput
from ffimpact.scene import read
from tests.support.slope import HEIGHT, slope


def of(tables: dict):
    return read(tables, Path("."), "scene")


@pytest.mark.parametrize("tables, words", [
    (slope(speed=1, start="equilibrium"), r"body\.1\.velocity: .* beside start = 'equilibrium'.*\(accepted: 0"),
    ({"integrator": "central-difference", "start": "equilibrium", "law": "svk", "young": 1e6, "nu": 0.3, "density": 1000, "body": [{"shape": "disc", "radius": 0.1, "position": [0, 0.2]}]}, r"integrator: 'central-difference', but start = 'equilibrium' needs .*\(accepted: auto\|energy"),
    (slope(start="rest"), r"start: 'rest' is not known \(accepted: given\|equilibrium"),
    (slope(start="equilibrium") | {"obstacle": [{"kind": "plane", "point": [0, -1], "normal": [0, 1], "velocity": [1, 0]}]},
     r"obstacle\.1\.velocity: .* beside start = 'equilibrium'")])
def test_equilibrium_is_at_rest(tables, words):
    with pytest.raises(BadInput, match=words):
        of(tables)


def test_a_small_overlap_is_left_to_the_solver_where_something_presses():
    """A twentieth of the half thickness; without weight and loads nothing but round-off."""
    small = -0.9 * 0.05 * HEIGHT / 2
    of(slope(small))
    for tables in (slope(1.2 * small), slope(small, gravity=0.0)):
        with pytest.raises(BadInput, match=r"overlaps 'obstacle1'.*\(accepted: "):
            of(tables)


@pytest.mark.parametrize("tables, words", [
    (slope(contact={"penalty_damping": -1}), r"contact\.penalty_damping: -1 is out of range \(accepted: 0 to "),
    (slope(contact={"penalty_damping": 1e-3}, integrator="bdf2"), r"integrator: 'bdf2', but penalty_damping needs another value \(accepted: auto\|")])
def test_damping_of_the_penalty(tables, words):
    with pytest.raises(BadInput, match=words):
        of(tables)
