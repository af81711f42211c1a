"""The meshes of the scenes."""

import numpy as np

from ffimpact.mesh import mesh


def test_file_keeps_every_digit(tmp_path):
    """A mesh in FreeFEM's format reads back with all digits."""
    m = mesh.disc(0.05, 0.01, 0.004, True)
    mesh.write(m, tmp_path / "m.msh")
    back = mesh.read(tmp_path / "m.msh")
    for name in ("points", "triangles", "edges", "labels"):
        assert np.array_equal(getattr(m, name), getattr(back, name)), name


def test_same_input_same_mesh():
    """The mesh depends on its input only."""
    first, second = (mesh.disc(0.05, 0.01, 0.002, True) for _ in range(2))
    assert np.array_equal(first.points, second.points)


def test_no_mesh_depends_on_the_unit_of_length():
    """A disc in metres and in millimetres has the same mesh except for round-off."""
    metres, millimetres = (mesh.disc(0.05 * metre, 0.011313708499 * metre, 0.0028 * metre, False, 1.2) for metre in (1, 1000))
    assert metres.points.shape == millimetres.points.shape and abs(1000 * metres.points - millimetres.points).max() < 1e-11 * 50
