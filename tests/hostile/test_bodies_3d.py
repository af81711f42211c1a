"""Scenes of bodies in three dimensions: shapes and distances, meshes, files, symmetry, refused
input, and runs."""

import math

import numpy as np
import pytest

from ffimpact.mesh import curved, solid_file
from ffimpact.running import run
from ffimpact.scene import read as read_scene
from ffimpact.scenes import assembly
from tests.support.bodies_3d import BALL, BLOCK, FLOOR, SCENE, prism, read


@pytest.mark.robustness
def test_meshes_are_fine_where_bodies_touch():
    """Faces below the lowest point of the ball and in the middle of the upper side of the block are
    small, others are not; they rotate with the body."""
    scene = read(BALL, BLOCK, mesh_size=0.03, contact_mesh_size=0.006, symmetry="full")
    built = assembly.assemble(scene)
    m = built.mesh
    size = np.sqrt(np.linalg.norm(np.cross(m.points[m.faces[:, 1]] - m.points[m.faces[:, 0]], m.points[m.faces[:, 2]] - m.points[m.faces[:, 0]]), axis=1))
    from_touch = np.linalg.norm(m.points[m.faces].mean(axis=1) - [0, -0.05, 0], axis=1)
    assert size[from_touch < 0.008].max() < 0.01 and size[(from_touch > 0.08) & (m.points[m.faces][..., 1].max(axis=1) < 0.051)].min() > 0.012
    upper = np.linalg.norm(m.points[m.faces].mean(axis=1) - built.centres[1] - [0, 0.04, 0], axis=1)
    assert size[upper < 0.008].max() < 0.01
    edge = {"shape": "box", "width": 0.1, "height": 0.1, "depth": 0.1, "position": [0, 0.2, 0], "angle": 45, "velocity": [0, -5, 0]}
    tilted = assembly.assemble(read(edge, obstacles=[FLOOR | {"point": [0, 0, 0]}], mesh_size=0.03, contact_mesh_size=0.008)).mesh
    lengths = np.linalg.norm(tilted.points[tilted.faces[:, 0]] - tilted.points[tilted.faces[:, 1]], axis=1)
    assert tilted.points[:, 1].min() == pytest.approx(-0.05 * math.sqrt(2)) and tilted.points[tilted.faces[lengths.argmin(), 0], 1] < -0.04


def found_in(path) -> list[tuple]:
    """The round surfaces of a file: whether it is a cylinder, its radius, and the share of the
    faces on it."""
    m = solid_file.read(path)
    return [(len(surface.axis) > 0, round(surface.radius, 9), len(own) / len(m.faces))
            for surface, own in curved.surfaces(m.points, m.faces)]


@pytest.mark.robustness
def test_surfaces_are_round_by_the_angles_of_their_faces(tmp_path):
    """A hexagonal prism stays one although its vertices lie on a sphere; with 24 sides it becomes a
    cylinder.

    A shaft with flats keeps them. A ball with a flat is not a ball but has the surface of a sphere.
    """
    prism(6, tmp_path / "6.mesh")
    prism(24, tmp_path / "24.mesh")
    for name, made in {"shaft": "Cylinder(1) = {0, 0, 0, 0, 0.03, 0, 0.02}; Box(2) = {-0.015, -1, -1, 0.03, 2, 2}; BooleanIntersection(3)",
                       "dome": "Sphere(1) = {0, 0, 0, 0.05}; Box(2) = {-1, -1, -1, 2, 1.02, 2}; BooleanIntersection(3)"}.items():
        (tmp_path / f"{name}.geo").write_text(f'SetFactory("OpenCASCADE");\n{made} = {{ Volume{{1}}; Delete; }}{{ Volume{{2}}; Delete; }};\n')
    assert found_in(tmp_path / "6.mesh") == [] and found_in(tmp_path / "24.mesh") == [(True, 0.05, pytest.approx(48 / 92))]
    assert [surface[:2] for surface in found_in(tmp_path / "shaft.geo")] == [(True, 0.02)] * 2
    assert [surface[:2] for surface in found_in(tmp_path / "dome.geo")] == [(False, 0.05)]
    body, = read({"shape": "mesh", "file": "dome.geo", "position": [0, 0.3, 0]}, folder=tmp_path).bodies
    assert body.outline.disc is None and body.outline.extent[1] == pytest.approx(0.07, rel=5e-3)


@pytest.mark.robustness
def test_a_pair_is_that_of_the_other_dimension(tmp_path):
    """A ball on a free cylinder up to the largest force agrees with bodies of revolution, to the
    error of the coarse meshes.

    Compared are impulse, velocities and force.
    """
    cylinder = {"name": "cylinder", "shape": "cylinder", "radius": 0.08, "height": 0.06}
    ball = {key: value for key, value in BALL.items() if key not in ("position", "velocity")}
    top = {"end_time": 2e-3, "accuracy": 0.1}
    solid = run.run(read(BALL | {"position": [0, 0.05, 0]}, cylinder | {"position": [0, -0.03, 0]}, obstacles=(), **top), {}, tmp_path / "solid", estimate=False).summary
    scene = read_scene(SCENE | top | {"dimension": "axisymmetric", "body": [ball | {"position": 0.05, "velocity": -8}, cylinder | {"position": -0.03}]}, tmp_path, "flat")
    flat = run.run(scene, {}, tmp_path / "flat", estimate=False).summary
    assert flat["impulse"] > 2.5
    for name, off in (("impulse", 0.02), ("impulse_y_1", 0.02), ("rebound_vy_1", 0.02), ("rebound_vy_2", 0.03), ("peak_force", 0.06)):
        assert solid[name] == pytest.approx(flat[name], rel=off), name
