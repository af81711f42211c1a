"""Figures and the snapshots from which they are drawn."""

import xml.etree.ElementTree as xml

import numpy as np
import pytest

from ffimpact.failure import Unreadable
from ffimpact.output import folder, vtu
from ffimpact.report import drawing, figures
from tests.support.triangles import areas


def test_all_figures_are_drawn(finished_folder):
    """A folder with snapshots gives four figures that are not empty."""
    files = drawing.draw(finished_folder)
    assert {file.stem for file in files} <= set(folder.FIGURES)
    assert sorted(f.name for f in files) == ["energies.png", "force.png", "shapes.png", "velocity.png"]
    assert all(f.stat().st_size > 5000 for f in files)


def test_no_snapshots_no_shapes(finished_folder):
    """Without snapshots only the shapes are missing."""
    (finished_folder / "fields.pvd").unlink()
    assert sorted(f.stem for f in drawing.draw(finished_folder)) == ["energies", "force", "velocity"]


def test_half_a_body_is_mirrored(finished_folder):
    """The figure of half a disc shows the whole disc: symmetric in x with twice the area."""
    _, path = vtu.series(finished_folder / "fields.pvd")[0]
    snapshot = vtu.read(path)
    body = figures.deformed(snapshot, half=True)
    assert body.points[:, 0].min() == -body.points[:, 0].max() < 0
    assert len(body.triangles) == 2 * len(snapshot.triangles) and len(body.stress) == len(body.points)


def test_quadratic_triangles_are_split(finished_folder):
    """The four straight triangles of each quadratic one cover the half disc, with the correct
    orientation and area."""
    snapshot = vtu.read(finished_folder / "fields/0000.vtu")
    area = areas(snapshot)
    assert abs(area).sum() == pytest.approx(np.pi * 0.05**2 / 2, rel=0.01)
    assert (np.sign(area[abs(area) > 1e-15]) == np.sign(area.sum())).all()


def test_series_is_in_the_order_of_time(finished_folder):
    """The list of snapshots has their times and existing files."""
    series = vtu.series(finished_folder / "fields.pvd")
    assert len(series) == 9 and [t for t, _ in series] == sorted(t for t, _ in series)
    assert all(path.exists() for _, path in series)


@pytest.mark.parametrize("damage", ["", "<VTKFile/>", "<VTKFile"])
def test_broken_snapshot_is_named(finished_folder, damage):
    """A truncated or empty snapshot is reported, without a traceback of the parser."""
    path = finished_folder / "fields/0003.vtu"
    path.write_text(damage)
    with pytest.raises(Unreadable, match="0003.vtu"):
        vtu.read(path)


def test_unsupported_cells_are_named(finished_folder):
    """Elements other than triangles are refused."""
    path = finished_folder / "fields/0003.vtu"
    tree = xml.parse(path)
    types = tree.getroot().find(".//Cells/DataArray[@Name='types']")
    types.text = types.text.replace("22", "9")
    tree.write(path)
    with pytest.raises(Unreadable, match="cell types"):
        vtu.read(path)
