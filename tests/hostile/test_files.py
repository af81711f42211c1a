"""Bodies from files: search paths, reading, sizes, scaling, copies, and the boundaries that may
come into contact."""

import math

import numpy as np
import pytest

from ffimpact.mesh import rounding, solid_mesh
from ffimpact.scene import read
from ffimpact.scenes import assembly
from tests.support.files import solid, write_step

# ---- fillets

def unknowns(file: str, folder, **entries) -> tuple[int, float, solid_mesh.SolidMesh]:
    tables = solid(file, **entries) | {"accuracy": 0.02}
    built = assembly.assemble(read(tables, folder, "x"))
    size = built.used["body"][0]["contact_mesh_size"]
    return solid_mesh.unknowns(built.mesh.cells, 2), size, built.mesh


def rounded_box(radius: float) -> float:
    """The volume [m3] of the box with fillets of this radius [mm]."""
    a, b, c = (side - 2 * radius for side in (100, 60, 40))
    faces, edges, corners = a * b + b * c + c * a, a + b + c, 4 / 3 * math.pi * radius**3
    return 1e-9 * (a * b * c + 2 * radius * faces + math.pi * radius**2 * edges + corners)


@pytest.mark.robustness
def test_fillets_that_touch_nothing_cost_little(tmp_path):
    """A box with fillets of 2 mm on all edges, which its elements do not resolve, costs little more
    than the box.

    With elements of their curvature it has six times as many unknowns. The volume is exact to a
    quarter of the accuracy.
    """
    write_step(tmp_path / "box.step")
    write_step(tmp_path / "small.step", 2)
    plain, *_ = unknowns("box.step", tmp_path)
    small, _, m = unknowns("small.step", tmp_path)
    assert small < 1.6 * plain
    assert 0 < 1 - m.volumes.sum() / rounded_box(2) < 0.25 * 0.02


@pytest.mark.robustness
def test_a_fillet_that_touches_is_resolved(tmp_path):
    """A box comes into contact with a fillet on its edge: elements at this fillet have the size of
    its curvature.

    Elements at other fillets do not, as the volume does not require it.
    """
    write_step(tmp_path / "part.step", 5)
    _, size, m = unknowns("part.step", tmp_path, turn=[0, 0, 30])
    assert size < 5e-3 and 0 < 1 - m.volumes.sum() / rounded_box(5) < 0.25 * 0.02
    ends, middle = m.points[m.faces[:, :2]], m.points[m.faces].mean(axis=1)
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    low = middle[:, 1] < m.points[:, 1].min() + 5e-4
    fine = 2 * math.pi * 5e-3 / rounding.TURN
    assert lengths[low].max() < 2.5 * fine and np.median(lengths[~low]) > 2 * fine


@pytest.mark.robustness
def test_a_geometry_is_as_fine_as_the_shape(tmp_path):
    """The contact of a box on its edge has the element size of the built-in box, to a tenth.
    Samples of a mesh are weighted with their area."""
    write_step(tmp_path / "box.step")
    _, size, _ = unknowns("box.step", tmp_path, turn=[0, 0, 20])
    tables = solid("box.step", turn=[0, 0, 20]) | {"accuracy": 0.02, "symmetry": "full"}
    del tables["body"][0]["file"]
    tables["body"][0] |= {"shape": "box", "width": 0.1, "height": 0.06, "depth": 0.04}
    built = assembly.assemble(read(tables, tmp_path, "x"))
    assert size == pytest.approx(built.used["body"][0]["contact_mesh_size"], rel=0.1)
