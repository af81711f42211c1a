"""Meshes of the user: reports of errors in a file, with and without Python; bodies of any outline;
gmsh files."""

import numpy as np
import pytest

from ffimpact.mesh import mesh
from tests.support.foreign_meshes import RADIUS, agree, go, moved


@pytest.mark.robustness
def test_place_in_the_file_does_not_matter(tmp_path):
    """The same disc at another position gives the same history with a shifted centre of mass, to
    1e-6, the round-off of the solver."""
    m = mesh.disc(RADIUS, 0.015, 0.006, False)
    here, there = go(tmp_path / "here", m), go(tmp_path / "there", moved(m, 0.8, -3))
    agree(here, there, 1e-6)
    assert there.history["x"] - here.history["x"] == pytest.approx(np.full(len(here.history["x"]), 0.8), rel=1e-9)
