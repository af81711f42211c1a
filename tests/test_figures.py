"""Figures and the snapshots they are drawn from."""

import xml.etree.ElementTree as xml

import numpy as np
import pytest

from ffimpact.failure import Unreadable
from ffimpact.output import vtu
from ffimpact.report import bodies, drawing, figures
from triangles import areas


def test_all_figures_are_drawn(finished_folder):
    """A folder with snapshots gives four pictures that are not empty."""
    files = drawing.draw(finished_folder)
    assert sorted(f.name for f in files) == ["energies.png", "force.png", "shapes.png", "velocity.png"]
    assert all(f.stat().st_size > 5000 for f in files)


def test_no_snapshots_no_shapes(finished_folder):
    """Without snapshots the shapes are left out and nothing else."""
    (finished_folder / "fields.pvd").unlink()
    assert sorted(f.stem for f in drawing.draw(finished_folder)) == ["energies", "force", "velocity"]


def test_half_a_body_is_mirrored(finished_folder):
    """The picture of half a disc shows the whole: symmetric in x, twice the area."""
    _, path = vtu.series(finished_folder / "fields.pvd")[0]
    snapshot = vtu.read(path)
    body = figures.deformed(snapshot, half=True)
    assert body.points[:, 0].min() == -body.points[:, 0].max() < 0
    assert len(body.triangles) == 2 * len(snapshot.triangles) and len(body.stress) == len(body.points)


def test_quadratic_triangles_are_split(finished_folder):
    """The four straight triangles of each quadratic one cover the disc: none turned over, the area of the half circle."""
    snapshot = vtu.read(finished_folder / "fields/0000.vtu")
    area = areas(snapshot)
    assert abs(area).sum() == pytest.approx(np.pi * 0.05**2 / 2, rel=0.01)
    assert (np.sign(area[abs(area) > 1e-15]) == np.sign(area.sum())).all()


def test_series_is_in_the_order_of_time(finished_folder):
    """The list of snapshots gives their times, and files that exist."""
    series = vtu.series(finished_folder / "fields.pvd")
    assert len(series) == 9 and [t for t, _ in series] == sorted(t for t, _ in series)
    assert all(path.exists() for _, path in series)


@pytest.mark.parametrize("damage", ["", "<VTKFile/>", "<VTKFile"])
def test_broken_snapshot_is_named(finished_folder, damage):
    """A snapshot that is cut off or empty is named, without a traceback from the parser."""
    path = finished_folder / "fields/0003.vtu"
    path.write_text(damage)
    with pytest.raises(Unreadable, match="0003.vtu"):
        vtu.read(path)


def test_unsupported_cells_are_named(finished_folder):
    """Cells that are not triangles are refused, not drawn wrongly."""
    path = finished_folder / "fields/0003.vtu"
    tree = xml.parse(path)
    types = tree.getroot().find(".//Cells/DataArray[@Name='types']")
    types.text = types.text.replace("22", "9")
    tree.write(path)
    with pytest.raises(Unreadable, match="cell types"):
        vtu.read(path)


def test_a_title_is_shown_as_written(tmp_path):
    """Dollars are no formula, control characters are blanks, what is too long is wrapped and cut."""
    body = dict(law="svk", young=7e6, nu=0.4, density=1722)
    scene = dict(title="from $5 to $\\frac{$ \0", body=[body | dict(name=f"body{k}") for k in range(1000)])
    text = drawing.wrapped(bodies.title(scene), 8)
    assert r"from \$5 to \$\frac{\$" in text and text.isprintable() is False and "\0" not in text
    assert max(map(len, text.split("\n"))) <= 8 * drawing.LETTERS and text.count("\n") <= drawing.MOST_LINES
    figure = figures.plt.figure()
    figure.suptitle(text)
    figure.savefig(tmp_path / "title.png")
    figures.plt.close(figure)


def test_balance_of_bodies_at_rest():
    """Under gravity from rest kinetic and elastic energy are the work of the weight: their sum less that work is 0, no scale for the balance."""
    t = np.linspace(0, 1e-2, 5)
    rest = np.zeros_like(t)
    history = dict(t=t, kinetic=1e3 * t, elastic=2e3 * t, contact=rest, friction_work=rest, external_work=3e3 * t, balance=np.full_like(t, 3e-12), normal_force=rest)
    figure = bodies.energies(history, {"script": "bodies", "body": [{"name": "body"}]})
    line = figure.axes[-1].lines[0].get_ydata()
    figures.plt.close(figure)
    assert line == pytest.approx(1e-13)


def test_fifty_bodies_and_no_force(recwarn):
    """Of many bodies legends and titles name the first and the last; where nothing touched there is no legend of forces, and no warning."""
    t = np.linspace(0, 1e-2, 5)
    many, scene = {f"body{k}": f"_{k}" for k in range(1, 51)}, {"script": "bodies", "body": [{"name": f"body{k}"} for k in range(1, 51)]}
    history = dict(t=t, dt=0 * t + t[1], normal_force=0 * t, friction_force=0 * t) | {f"{name}{of}": (name == "vx") + 0 * t
                                                                     for of in many.values() for name in ("vx", "vy", "spin", "force_x", "force_y")}
    speeds, pushes = bodies.velocities(history, scene), bodies.forces(history, scene)
    named = [text.get_text() for text in speeds.axes[0].get_legend().get_texts()]
    assert named == [f"body{k}" for k in (*range(1, 7), *range(45, 51))] and pushes.axes[0].get_legend() is None and not recwarn.list
    for figure in (speeds, pushes):
        figures.plt.close(figure)
