"""The contact problem has the unknowns of the points that touch, not of those that once touched."""

import re

import pytest

from tests.support.rigid import run

# Rolls over a third of its outline without slip. Penalty and steps are soft, so that it rests.
ROLLING = """
law = "neohookean"
young = 7e6
nu = 0.3
density = 1000
gravity = 9.81
end_time = 0.1
dt = 5e-4
[[body]]
shape = "disc"
radius = 0.05
position = [0, 0.05]
velocity = [1, 0]
spin = -20
mesh_size = 0.008
contact_mesh_size = 0.008
{obstacle}
[contact]
penalty = 1e8
friction_static = 0.5
"""
PLANE = '[[obstacle]]\nkind = "plane"\npoint = [0, 0]\nnormal = [0, 1]\n'
BOWL = '[[obstacle]]\nkind = "bowl"\ncentre = [0, 1]\nradius = 1\n'


def unknowns_near_contact(folder) -> int:
    """The largest number of unknowns in a contact problem of a run."""
    [found] = re.findall("dofs, at most ([0-9]+) near contact", (folder / "log.txt").read_text())
    return int(found)


@pytest.mark.parametrize("obstacle", [PLANE, BOWL], ids=["plane", "bowl"])
def test_a_rolling_disc_forgets_the_points_behind(tmp_path, obstacle):
    """Of 160 unknowns on the outline a dozen touch at a time. With all points that the search finds
    in the contact problem the answers are the same, up to the tolerance of the iteration."""
    text = ROLLING.format(obstacle=obstacle)
    summary, _ = run(tmp_path, text, "forgets")
    everything, _ = run(tmp_path, text, "all", without="contact-culling")
    assert 4 <= unknowns_near_contact(tmp_path / "forgets") <= 30 < unknowns_near_contact(tmp_path / "all")
    for name in ("rebound_vx", "rebound_spin", "impulse"):
        assert summary[name] == pytest.approx(everything[name], rel=1e-6), name
    assert summary["energy_drift"] < 1e-9
