"""fields/contact.csv: the loaded contact points along the outlines, against the forces of the
history."""

import functools

import numpy as np
import pandas as pd
import pytest

from ffimpact import scene
from ffimpact.output.results import Record
from ffimpact.report import contact, report
from ffimpact.report.figures import plt
from ffimpact.running import run
from ffimpact.scene import read as read_scene
from verification import measure as runs

PLANE = {"kind": "plane", "point": [0, 0]}
CORNER = {"law": "neohookean", "young": 7e6, "nu": 0.4, "density": 1722, "accuracy": 0.4, "fields": 8, "contact": {"friction_static": 0.3},
          "body": [{"shape": "disc", "radius": 0.05, "position": [0.052, 0.052], "velocity": [-4, -4]}],
          "obstacle": [PLANE | {"normal": [0, 1]}, PLANE | {"normal": [1, 0]}]}


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """ran(name, **set): a coarse run of the scene with 8 snapshots or the entries `set`, made once."""
    @functools.cache
    def at(name: str, **entries) -> Record:
        folder = tmp_path_factory.mktemp("run")
        problem = read_scene(CORNER, folder, name) if name == "corner" else scene.load(name)
        return run.run(problem, {"accuracy": 0.4, "fields": 8} | entries, folder / "out", estimate=False)
    return at


def summed(result: Record) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Forces [N/m] by instant and counter-body from contact.csv, and the rows of the history at
    these instants."""
    points = pd.DataFrame(contact.read(result.folder))
    points = points.assign(pressure=points.pressure * points.weight, shear=points.shear * points.weight)
    forces = points.groupby(["t", "partner"])[["pressure", "shear"]].sum().unstack(fill_value=0)
    history = pd.DataFrame(result.history)
    return forces, history.iloc[[(history.t - t).abs().argmin() for t in forces.index]]


@pytest.mark.parametrize("name, values", [("disc-normal", {}), ("disc-normal", {"accuracy": 0.03, "symmetry": "full", "integrator": "bdf2"}), ("disc-oblique", {}),
                                          ("disc-oblique", {"degree": 1, "regularization": "tanh"})])
def test_forces_on_a_plane(ran, name, values):
    """Pressure and shear times weight add up to normal and friction force of the history at every
    instant, for the whole body."""
    forces, there = summed(ran(name, **values))
    assert len(forces) > 8 and (there.normal_force > 0).all()
    np.testing.assert_allclose(forces.pressure[-1], there.normal_force, rtol=1e-6)
    np.testing.assert_allclose(forces.shear[-1], there.friction_force, rtol=1e-6, atol=1e-6 * there.normal_force.max())


@pytest.mark.few(1)
@pytest.mark.parametrize("values", [{}, {"body.1.direction": -60, "friction_static": 0.4, "contact_mesh_size": 0.03}])
def test_both_bodies_bear_the_force_between_them(ran, values):
    """Each body carries the normal load once (to 10 % on coarse elements, as each has both roles;
    shear on finer ones), both together exactly twice."""
    result = ran("disc-block", **values)
    forces, there = summed(result)
    np.testing.assert_allclose(forces.pressure[[1, 2]].sum(axis=1), 2 * there.normal_load, rtol=1e-6)
    shares = pd.DataFrame(contact.read(result.folder)).eval("load = pressure * weight").groupby("body").load.sum()
    assert shares[1] == pytest.approx(shares[2], rel=0.1)
    np.testing.assert_allclose(forces.shear[1].sum(), forces.shear[2].sum(), rtol=0.1, atol=1e-9)


def test_projected_pressure_has_the_same_resultant_and_moment(tmp_path):
    """In terms of the shape functions of the outline the force equals that of the points to
    round-off.

    The moment agrees as far as the outline is that of the elements.
    """
    numbers = runs.measure("homogeneous", accuracy=0.1, out=tmp_path)
    assert abs(numbers["resultant"]) < 1e-12 and abs(numbers["moment"]) < 1e-6


def test_two_obstacles_at_once(ran):
    """A disc in a corner: forces on floor (-1) and wall (-2) are separate, and the friction of each
    is within its cone."""
    forces, there = summed(ran("corner"))
    np.testing.assert_allclose(forces.pressure.sum(axis=1), there.normal_force, rtol=1e-6)
    assert {-1, -2} == set(forces.pressure) and (np.abs(forces.shear) <= 0.3000001 * forces.pressure).all(axis=None)


@pytest.mark.parametrize("symmetry", ["half", "full"])
def test_arcs(ran, symmetry):
    """s is the arc length along the circle, counter-clockwise, 0 at the first contact: of a half the
    lowest point, of a whole disc the Gauss point nearest to it, or one of two that are as near."""
    points = contact.read(ran("disc-normal", symmetry=symmetry).folder)
    arc = 0.05 * np.arcsin(points.X / 0.05)
    first = arc[np.abs(points.s).argmin()] if symmetry == "full" else 0
    assert np.abs(first) <= np.abs(arc).min() * (1 + 1e-6) or symmetry == "half"
    assert np.abs(points.s - (arc - first)).max() < 1e-4
    assert (points.partner == -1).all() and (points.body == 1).all()


def test_nothing_that_nobody_asked_for(ran):
    """Without snapshots there is no file, and the results do not change."""
    with_it, without = ran("disc-oblique"), ran("disc-oblique", fields=0)
    assert not (without.folder / "fields").exists()
    assert with_it.summary["impulse"] == without.summary["impulse"]


def test_picture(ran):
    """The figure is drawn if there was contact."""
    result = ran("disc-oblique")
    report.draw(result)
    assert (result.folder / "figures/contact.png").stat().st_size > 10000
    assert contact.draw(contact.read(result.folder)[:0], ["body"], False, np.array([])) is None


def test_a_profile_is_a_line_alone():
    """A projected pressure is drawn as a line without its points. Without projection the points are
    drawn."""
    table = pd.DataFrame({"t": 1e-3, "s": [-1e-3, 0, 1e-3], "pressure": [1e5, 3e5, 1e5], "projected_pressure": [1e5, 2e5, 1e5]}).to_records()
    for line, drawn in (("-", ("-", "")), ("", ("None", "."))):
        figure, axes = plt.subplots()
        contact.draw_profiles(axes, table, "along the outline", line, [1e-3])
        only, = axes.lines
        assert (only.get_linestyle(), only.get_marker()) == drawn
        plt.close(figure)
