"""V3: superposed rigid motions, and a free body that spins for 100 turns."""

import pytest


@pytest.mark.few(1)
@pytest.mark.parametrize("law", ["svk", "neohookean"])
def test_spinning_disc_keeps_energy_and_momenta(measure, law):
    """A vibrating free disc keeps energy, momentum and angular momentum to 1e-10 over 100 turns of
    30 steps.

    A rigid motion of a deformed body changes neither its energy nor det F.
    """
    numbers = measure("spinning", law=law, spin=200, exponent=3, tolerance=5e-14, mesh_size=0.03, contact_mesh_size=0.03)
    assert numbers["state"] == 0 and numbers["strain"] > 0.02
    assert numbers["energy"] < 1e-10 and numbers["momentum"] < 1e-10 and numbers["angular"] < 1e-10
    assert numbers["rigid"] < 1e-11
