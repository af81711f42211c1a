"""Velocities and displacements of the points of bodies at the start."""

import pytest

import ffimpact as ff

RUBBER = ff.NeoHookean(young=7e6, nu=0.45, density=1722)
QUIET = {"progress": False, "figures": False, "estimate": False}


def spinning(tmp_path, name: str, **motion) -> ff.Result:
    sizes = {"mesh_size": 0.01, "contact_mesh_size": 0.004}
    disc = ff.Disc(radius=0.05, material=RUBBER, position=(0, 0.0515), **motion, **sizes)
    scene = ff.Scene(bodies=[disc], obstacles=[ff.Plane()], accuracy=0.1, symmetry="full",
                     contact=ff.Contact(friction_static=0.3, penalty=1e10, slip_velocity=0.05))  # fmt: skip
    return ff.run(scene, out=tmp_path / name, **QUIET)


def test_the_field_of_a_rigid_motion_is_that_motion(tmp_path):
    """The flight before the contact is integrated with a field, and exact without."""
    rigid = spinning(tmp_path, "rigid", velocity=(2, -8), spin=30)
    field = spinning(tmp_path, "field", initial_velocity=lambda p: (2 - 30 * (p[1] - 0.0515), -8 + 30 * p[0]))
    assert field["energy_initial"] == pytest.approx(rigid["energy_initial"], rel=1e-5)
    for name in ("impulse", "rebound_vy", "rebound_spin"):
        assert field[name] == pytest.approx(rigid[name], rel=0.02), name


@pytest.mark.parametrize("integrator, drift", [("energy-momentum", 1e-9), ("central-difference", 0.01)])
def test_the_energies_are_those_of_the_fields(tmp_path, integrator, drift):
    """A turned bar with nu = 0 that is stretched evenly by 1e-3, and whose points move apart: E e^2/2
    and rho v^2/2 over its area. Both are conserved; the energy of explicit steps oscillates."""
    soft = ff.NeoHookean(young=7e6, nu=0.0, density=1722)
    bar = ff.Rectangle(width=0.1, height=0.02, material=soft, position=(0.3, 0), angle=90,
                       initial_displacement=[0, "1e-3*y"], initial_velocity=["3*y", 0])  # fmt: skip
    scene = ff.Scene(bodies=[bar], end_time=2e-3, accuracy=0.2, integrator=integrator)
    result = ff.run(scene, out=tmp_path / "bar", **QUIET)
    stored, moving = 7e6 * 1e-6 / 2 * 2e-3, 1722 * 9 * 0.1**2 / 12 / 2 * 2e-3
    assert result.history.elastic[0] == pytest.approx(stored, rel=3e-3)
    assert result.history.kinetic[0] == pytest.approx(moving, rel=2e-3)
    assert result["energy_drift"] < drift


def test_a_field_where_the_body_is_held_is_refused(tmp_path):
    bar = ff.Rectangle(width=0.1, height=0.02, material=RUBBER, position=(0, 0), support=ff.Support(where="left"),
                       initial_displacement=["0.1*x", 0])  # fmt: skip
    with pytest.raises(ff.BadInput, match="^initial_displacement: up to 0.005 where a support, an axis"):
        ff.run(ff.Scene(bodies=[bar], end_time=1e-3, accuracy=0.2), out=tmp_path / "bar", **QUIET)
