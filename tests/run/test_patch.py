"""The contact area: half-width and largest pressure in the history and the summary against
fields/contact.csv, ParaView files, the figure."""

import matplotlib.pyplot as plt
import meshio
import numpy as np
import pandas as pd
import pytest

from ffimpact import scene
from ffimpact.output import vtu
from ffimpact.output.results import Record, body_names
from ffimpact.report import contact, figures
from ffimpact.report.impact import impact_of
from ffimpact.running import run

SCENES = {"disc": ("disc-normal", {}), "whole disc": ("disc-oblique", {}), "revolution": ("ball-axisymmetric", {"accuracy": 0.1}),
          "ball": ("ball", {"accuracy": 0.2}), "oblique ball": ("ball-oblique", {}),
          "block": ("disc-block", {})}


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """ran(which): a coarse run with snapshots at all steps, made once."""
    results = {}

    def at(which: str) -> Record:
        if which not in results:
            name, values = SCENES[which]
            results[which] = run.run(scene.load(name), {"accuracy": 0.4, "fields": 30} | values, tmp_path_factory.mktemp("run") / "out", estimate=False)
        return results[which]
    return at


def ball_of(used: dict) -> dict | None:
    """The impact of a scene as used if it is that of a ball that does not rotate, as drawing.draw
    asks for it."""
    impact = impact_of(used)
    return impact if impact and impact["kind"] in figures.BODY and figures.is_half(used) else None


def at_the_same_times(result: Record) -> list[tuple[pd.DataFrame, pd.Series]]:
    """The loaded points at each instant and the row of the history at this instant."""
    history = pd.DataFrame(result.history)
    return [(points, history.iloc[(history.t - t).abs().argmin()]) for t, points in pd.DataFrame(contact.read(result.folder)).groupby("t")]


@pytest.mark.few(3)
@pytest.mark.parametrize("which", SCENES)
def test_largest_pressure(ran, which):
    """max_pressure is the largest projected pressure in contact.csv at its instant, for every body.

    The value of the summary is the largest of the history, at its time, and its point of the
    outline is that of contact.csv.
    """
    result = ran(which)
    h, s = result.history, result.summary
    for points, row in at_the_same_times(result):
        assert row.max_pressure == pytest.approx(points.projected_pressure.max(), rel=1e-7)
        for body in range(1, 3 if "max_pressure_2" in row else 1):
            assert row[f"max_pressure_{body}"] == pytest.approx(points[points.body == body].projected_pressure.max(), rel=1e-7)
    peak = int(np.argmax(h["max_pressure"]))
    assert s["max_pressure"] == h["max_pressure"][peak] > 0 and s["max_pressure_time"] == h["t"][peak]
    there = [points.loc[points.projected_pressure.idxmax()] for points, row in at_the_same_times(result) if row.t == h["t"][peak]]
    assert not there or (there[0].X, there[0].Y) == pytest.approx((s["max_pressure_x"], s["max_pressure_y"]), rel=1e-6)
    assert (s["max_pressure_z"] is not None) == ("ball" in which)


@pytest.mark.parametrize("which", [which for which in SCENES if which != "oblique ball"])
def test_half_width_is_that_of_the_size(ran, which):
    """For one contact area without a hole it is half the contact length, or the radius of the area,
    to the distance of two points; 0 without contact."""
    h = ran(which).history
    size, touches = h["contact_size"], h["contact_size"] > 0
    radius = np.sqrt(size / np.pi) if which in ("revolution", "ball") else size / 2
    used, large = run.read_scene(ran(which).folder), size > 0.5 * size.max()
    element = used.get("contact_mesh_size") or max(body["contact_mesh_size"] for body in used["body"])
    # Gauss points of an edge.
    assert large.sum() > 5 and np.abs(h["contact_half_width"] - radius)[large].max() < 0.39 * element
    assert (h["contact_half_width"][~touches] == 0).all() and (h["contact_half_width"][touches] > 0).all()


def test_no_contact_has_no_pressure(tmp_path):
    """A disc in flight has zeros, and no time or place."""
    result = run.run(scene.load("disc-normal"), {"accuracy": 0.4, "body.1.position.2": 0.15, "end_time": 1e-3, "fields": 0}, tmp_path / "out", estimate=False)
    assert not result.history["max_pressure"].any() and not result.history["contact_half_width"].any()
    assert result.summary["max_pressure"] == 0 and result.summary["max_pressure_time"] is None and result.summary["max_pressure_x"] is None


@pytest.mark.parametrize("which, bodies", [("disc", 1), ("block", 2)])
def test_cells_have_the_number_of_their_body(ran, which, bodies):
    """The elements of a snapshot have the number of their body, from 1, as integers. At their
    displaced places those of body 2, the block, are below the disc's."""
    _, path = vtu.series(ran(which).folder / "fields.pvd")[0]
    mesh = meshio.read(path)
    numbers, cells = mesh.cell_data["body"][0], mesh.cells[0].data
    assert numbers.dtype == np.int32 and len(numbers) == len(cells) and set(numbers) == {k + 1 for k in range(bodies)}
    centres = (mesh.points + mesh.point_data["displacement"])[cells].mean(axis=1)
    heights = [centres[numbers == k + 1, 1] for k in range(bodies)]
    assert bodies == 1 or heights[1].max() < heights[0].min()


@pytest.mark.parametrize("which", SCENES)
def test_every_row_bears_load(ran, which):
    """contact.csv has a row for every loaded point and no other."""
    table = pd.read_csv(ran(which).folder / "fields/contact.csv")
    assert len(table) > 10 and (table.pressure > 0).all()


@pytest.mark.parametrize("which", ["disc", "whole disc", "revolution", "ball", "oblique ball", "block"])
def test_panels_show_the_same_pressure(ran, which):
    """The largest pressure of an instant is the same in the profiles, in the figure over time, and
    in the last panel."""
    result = ran(which)
    half = figures.is_half(result.scene)
    figure = contact.draw(contact.read(result.folder), body_names(result.scene) if len(result.scene["body"]) > 1 else ["body"],
                          half, np.array([]), ball_of(result.scene), result.scene.get("symmetry", "full"), result.history)
    profiles = next(axes for axes in figure.axes if axes.get_ylabel() == contact.PRESSURE)
    picture = next(axes for axes in figure.axes if axes.collections and "time" in axes.get_xlabel()).collections[0]
    edges = picture.get_coordinates()[0, :, 0]
    largest = next(axes for axes in figure.axes if "largest pressure" in axes.get_ylabel()).lines[0]
    lines = [line for line in profiles.lines if line.get_label().endswith(" ms")]
    assert len(lines) == 3
    for line in lines:
        t = float(line.get_label().removesuffix(" ms"))
        row = int(np.argmin(np.abs(largest.get_xdata() - t)))
        assert edges[row] < largest.get_xdata()[row] < edges[row + 1]
        shown = np.nanmax(line.get_ydata()), np.ma.max(picture.get_array()[:, row]), largest.get_ydata()[row]
        assert shown == pytest.approx([shown[0]] * 3, rel=1e-9), (t, shown)
    plt.close(figure)


@pytest.mark.parametrize("which", ["disc", "whole disc", "ball", "block"])
def test_points_for_paraview(ran, which):
    """fields/contact.pvd lists a file for every snapshot of fields.pvd at the same time.

    It has the points and numbers of contact.csv at their displaced places, or none without contact.
    """
    folder = ran(which).folder
    table = pd.DataFrame(contact.read(folder))
    files = vtu.series(folder / "fields/contact.pvd")
    assert [t for t, _ in files] == [t for t, _ in vtu.series(folder / "fields.pvd")] and {path.name for _, path in files} == {path.name for path in folder.glob("fields/contact-*.vtu")}
    for t, path in files:
        rows = table[np.isclose(table.t, t, rtol=1e-8, atol=0)]
        if rows.empty:
            assert 'NumberOfPoints="0"' in path.read_text()
            continue
        mesh = meshio.read(path)
        assert len(mesh.points) == len(rows)
        axes = [axis for axis in "XYZ" if axis in rows]
        np.testing.assert_allclose(mesh.points[:, :len(axes)], rows[axes], rtol=1e-8, atol=1e-12)
        moved = mesh.points + mesh.point_data.pop("displacement")
        np.testing.assert_allclose(moved[:, :len(axes)], rows[[axis.lower() for axis in axes]], rtol=1e-8, atol=1e-12)
        names = [name for name in table if name not in "t s X Y Z x y z".split()]
        assert set(names) == set(mesh.point_data)
        for name in names:
            np.testing.assert_allclose(mesh.point_data[name], rows[name], rtol=1e-8, err_msg=name)


@pytest.mark.parametrize("which, panels, maps", [("disc", 3, 0), ("whole disc", 4, 0), ("revolution", 3, 0), ("ball", 3, 0), ("oblique ball", 4, 10), ("block", 3, 0)])
def test_panels_of_the_figure(ran, which, panels, maps):
    """There is a row for each body, one for two bodies in contact with each other only.

    Panels: profiles, pressure over time, stick and slip if there is friction, half-width and
    largest pressure; for oblique impacts of a ball also maps of pressure and of stick and slip at
    five instants.
    """
    result = ran(which)
    several = len(result.scene["body"]) > 1
    half = figures.is_half(result.scene)
    figure = contact.draw(contact.read(result.folder), body_names(result.scene) if several else ["body"], half, np.array([]),
                          ball_of(result.scene), result.scene.get("symmetry", "full"), result.history)
    titles = [axes.get_xlabel() for axes in figure.axes]
    assert sum("mm" in title or "ms" in title for title in titles) - maps // 2 == panels, titles
    assert sum(bool(axes.collections) and axes.get_aspect() == 1 for axes in figure.axes) == maps
    assert ("distance from the axis [mm]" in titles) == (which in ("ball", "revolution"))
    plt.close(figure)


def test_a_uniform_pressure_on_a_face_stays_uniform(tmp_path):
    """Two blocks with nu = 0 at rest press the floor by rho g h everywhere.

    Their projected pressure equals this up to the corners of the outline, without oscillations
    there and without values around the corners.
    """
    block = {"shape": "rectangle", "width": 0.1, "height": 0.05, "mesh_size": 0.025, "contact_mesh_size": 0.0125}
    tables = {"law": "neohookean", "young": 1e5, "nu": 0.0, "density": 1000.0, "loss": 2.0, "loss_model": "kelvin-voigt", "gravity": 9.81, "until": "rest",
              "accuracy": 0.1, "fields": 1,
              "body": [block | {"name": name, "position": [x, 0.025]} for name, x in (("left", 0.0), ("right", 0.3))],
              "obstacle": [{"kind": "plane", "point": [0.0, 0.0], "normal": [0.0, 1.0]}]}
    result = run.run(scene.read(tables, tmp_path, "block"), {}, tmp_path / "out", estimate=False)
    table = pd.DataFrame(contact.read(result.folder))
    last = table[table.t == table.t.max()]
    face = last[last.pressure > 0]
    assert len(face) > 30 and face.projected_pressure.to_numpy() == pytest.approx(face.pressure.to_numpy(), rel=0.01)
    assert result.history["max_pressure"][-1] == pytest.approx(1000 * 9.81 * 0.05, rel=0.1)
