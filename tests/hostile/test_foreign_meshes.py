"""Meshes of the user: reports of errors in a file, with and without Python; bodies of any outline;
gmsh files."""

from dataclasses import replace

import numpy as np
import pytest

from ffimpact.mesh import mesh
from tests.support.foreign_meshes import RADIUS, agree, go, moved, shaped
from tests.support.triangles import whole_of


@pytest.mark.robustness
def test_place_in_the_file_does_not_matter(tmp_path):
    """The same disc at another position gives the same history with a shifted centre of mass, to
    1e-6, the round-off of the solver."""
    m = mesh.disc(RADIUS, 0.015, 0.006, False)
    here, there = go(tmp_path / "here", m), go(tmp_path / "there", moved(m, 0.8, -3))
    agree(here, there, 1e-6)
    assert there.history["x"] - here.history["x"] == pytest.approx(np.full(len(here.history["x"]), 0.8), rel=1e-9)


@pytest.mark.robustness
def test_whole_mesh_counts_once(tmp_path):
    """A mesh of the whole disc with symmetry=auto gives history, impulse and contact time of the
    half disc, without drift and rotation."""
    half = mesh.disc(RADIUS, 0.015, 0.006, True)
    half_result, whole_result = go(tmp_path / "half", half), go(tmp_path / "whole", whole_of(half))
    agree(half_result, whole_result, 1e-5)
    assert [half_result.summary[name] for name in ("impulse", "contact_time")] == pytest.approx([whole_result.summary[name] for name in ("impulse", "contact_time")], rel=1e-6)
    assert abs(whole_result.summary["rebound_vx"]) < 1e-9 and abs(whole_result.summary["rebound_spin"]) < 1e-6
    assert (half_result.scene["symmetry"], whole_result.scene["symmetry"]) == ("half", "full")


@pytest.mark.robustness
def test_half_an_ellipse_is_the_ellipse(tmp_path):
    """Half of a body with straight edges and the whole body give the same history."""
    def half_ellipse(occ):
        occ.addDisk(0, 0, 0, 0.05, 0.03)
        occ.addRectangle(0, -1, 0, 1, 2)
        occ.intersect([(2, 1)], [(2, 2)])
    half = shaped(half_ellipse)
    on_axis = abs(half.points[half.edges, 0]).max(axis=1) < 1e-12
    half = replace(half, labels=np.where(on_axis, mesh.AXIS, mesh.FREE))
    half.points[np.unique(half.edges[on_axis]), 0] = 0
    agree(go(tmp_path / "half", half), go(tmp_path / "whole", whole_of(half)), 1e-5, ("normal_force", "kinetic", "elastic", "contact", "y", "vy"))
