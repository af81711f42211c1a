"""Content of figures: start of time, end of contact, the paper's number, a scale; and the section
of a body in three dimensions."""

import dataclasses
import itertools
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from ffimpact.output import results, vtu
from ffimpact.report import bodies, figures, impacts
from ffimpact.report.figures import plt
from ffimpact.report.impact import impact_of
from tests.support.report_figures import SCENE, disc, history, labels
from tests.support.triangles import areas


@pytest.fixture(autouse=True)
def closed():
    yield
    figures.plt.close("all")


@pytest.mark.parametrize("draw", [bodies.forces, bodies.velocities, bodies.energies])
def test_time_begins_at_zero_and_the_last_touch_is_marked(draw):
    """A run that starts at contact has a tick at t = 0. The end of contact, within the last step,
    is a line with its time in the legend."""
    figure = draw(history(), SCENE)
    axes = figure.axes[0]
    assert axes.get_xlim()[0] == 0 and 0 in axes.get_xticks()
    assert "end of the contact, 3.93 ms" in labels(axes)


def test_a_body_that_goes_on_bouncing_has_no_last_touch():
    """If a run ends between two contacts, no end of contact is drawn.

    If it begins with a flight, it begins shortly before contact, and this instant is not on the
    axis.
    """
    h = history(normal_force=np.where(np.arange(100) % 20 < 10, 1e3, 0.0))
    assert bodies.forces(h, disc(speed=3) | {"touched": (0.0, 4.5e-3)}).axes[0].get_legend() is None
    figure = bodies.forces(history(t=np.linspace(2e-3, 7e-3, 100)), SCENE)
    assert figure.axes[0].get_xlim()[0] == pytest.approx(2 - 0.02 * 5)


def test_numbers_of_the_paper_are_those_of_the_same_impact():
    """4.8 ms for the disc at 8 m/s, beside a sweep over the speed; none for another law or shape."""
    assert figures.numbers_of_the_paper(disc(speed=7), "contact_time", over="speed") == [(8, 0.0048, "paper, section 3.3")]
    assert figures.numbers_of_the_paper(disc(law="neohookean"), "contact_time", over="speed") == []
    assert figures.numbers_of_the_paper(disc(shape="mesh", file="mine.msh"), "contact_time", over="speed") == []


def test_no_curve_hides_another():
    """Under gravity, elastic, contact and gravity's energies are near 0. Coinciding lines become
    thinner, and labels of small ones have their maximum."""
    axes = bodies.energies(history(external_work=np.full(100, 0.5)), SCENE).axes[0]
    widths = [line.get_linewidth() for line in axes.lines if line.get_label() in ("total", "kinetic", "elastic") or line.get_label().startswith(("contact", "external"))]
    assert len(widths) == 5 and widths == sorted(widths, reverse=True) and len(set(widths)) == 5
    assert "contact (up to 0.001)" in labels(axes)


def test_no_contact_is_in_the_legend_of_rolling():
    h = history(friction_force=np.full(100, -1.0))
    assert "no contact" in labels(figures.rolling(h, impact_of(SCENE)).axes[1])


def test_a_normal_impact_has_no_flight():
    """The path of a body that neither moves along the plane nor rotates is a vertical line and is
    not drawn."""
    assert not figures.is_oblique(history(), impact_of(SCENE))
    assert figures.is_oblique(history(spin=np.full(100, 5.0)), impact_of(SCENE)) and figures.is_oblique(history(vx=np.full(100, 1.0)), impact_of(SCENE))


@pytest.mark.parametrize("width, words", [(0.12, "20 mm"), (11.0, "2 m"), (4e-4, "100 μm"), (0.4, "100 mm")])
def test_scale_of_length(width, words):
    figure, axes = figures.plt.subplots()
    axes.set_xlim(0, width)
    figures.scale_bar(axes)
    assert [text.get_text() for text in axes.texts] == [words] and axes.get_xlim() == (0, width)
    bar, = axes.lines
    assert 0.1 * width < np.ptp(bar.get_xdata()) <= 0.25 * width


def test_a_body_at_rest_on_its_partner_has_no_restitution():
    """An approach velocity of round-off gives no restitution. An excessive value of a vibrating
    body is marked at the edge and does not scale the axis."""
    rows = pd.DataFrame(dict(body=1, partner=-1, start=[0, 0.03, 0.05], end=[0.02, 0.04, 0.06], impulse=1.0, approach=[5e-20, 0.02, 0.03], separation=0.004,
                             restitution=[8e16, 0.2, 4.4], restitution_tangential=np.nan, slip_before=0.0))
    top = impacts.draw(rows.to_records(), ["body"], ["plane"]).axes[0]
    assert impacts.HIGHEST < top.get_ylim()[1] < 2
    pushed, = (line for line in top.lines if line.get_marker() == "^")
    assert list(pushed.get_xdata()) == [50] and list(pushed.get_ydata()) == [impacts.HIGHEST]


def test_what_rolls_does_not_bounce():
    """Intervals of contact without a normal restitution, as of a body that rolls over a step, are no
    bounces, though they have a tangential one."""
    rows = pd.DataFrame(dict(body=1, partner=-1, start=[0, 0.03, 0.05], end=[0.02, 0.04, 0.06], impulse=1.0, approach=[0.3, -0.9, 0.1], separation=0.2,
                             restitution=[np.nan, np.nan, 0.5], restitution_tangential=[-0.7, -0.6, np.nan], slip_before=0.2))
    assert impacts.draw(rows.to_records(), ["tyre"], ["road"]) is None


def test_the_size_of_contact_is_zero_in_flight():
    """A history has the onset of contact in the row that ends a flight. In the flight before it the
    contact has no size."""
    rows = {"t": [0.0, 1.0, 2.0], "dt": [0.0, 1.0, 1.0], "newton_iterations": [0, 0, 3], "normal_force": [0.0, 0.0, 5.0], "contact_half_width": [0.0, 0.1, 0.3],
            "y": [2.0, 1.0, 0.0], "vy": [-1.0, -1.0, 0.0], "momentum_y": [-1.0, -1.0, 0.0], "kinetic": [1.0, 1.0, 0.0], "external_work": [0.0, 0.0, 0.0]}
    filled = impacts.with_flights(results.Contents({name: np.array(column, float) for name, column in rows.items()}, Path("history.csv")))
    inside = (filled["t"] > 0) & (filled["t"] < 1)
    assert inside.sum() > 10 and not filled["contact_half_width"][inside].any() and filled["contact_half_width"][filled["t"] == 1] == 0.1


# ---- section of a body in three dimensions

def block(low: float, high: float, count: int) -> vtu.Solid:
    """A block 2 x 2 from z = low to high of quadratic tetrahedra, six in each of count^3 cubes.

    The displacement is u = (x, y, z), a field is 1 + 2 x - y + z.
    """
    axis = np.linspace(-1, 1, count + 1)
    corners = np.array([(x, y, low + (high - low) * (z + 1) / 2) for x, y, z in itertools.product(axis, axis, axis)])
    number = {index: k for k, index in enumerate(itertools.product(range(count + 1), repeat=3))}
    cells = []
    for cell in itertools.product(range(count), repeat=3):
        # Along the edges of the cube from corner to corner.
        for order in itertools.permutations(range(3)):
            steps = np.cumsum([np.zeros(3, int), *np.eye(3, dtype=int)[list(order)]], axis=0)
            cells.append([number[tuple(np.add(cell, step))] for step in steps])
    points, middles, tetrahedra = list(corners), {}, []
    for a, b, c, d in cells:
        row = [a, b, c, d]
        for pair in ((a, b), (b, c), (a, c), (a, d), (b, d), (c, d)):
            key = tuple(sorted(pair))
            if key not in middles:
                middles[key] = len(points)
                points.append((corners[key[0]] + corners[key[1]]) / 2)
            row.append(middles[key])
        tetrahedra.append(row)
    points = np.array(points)
    fields = {"displacement": points.copy(), "von_mises": 1 + points @ (2.0, -1.0, 1.0)}
    return vtu.Solid(points, np.array(tetrahedra), results.Contents(fields, Path("a.vtu")), np.zeros(len(tetrahedra), dtype=int))


@pytest.mark.parametrize("low, high, count", [(-1, 2, 2), (-1, 1, 1), (-1, 1, 3), (-0.25, 0.75, 1)])
def test_cut_of_a_whole_body(low, high, count):
    """The section covers 4 m2 once, with triangles of one orientation and exact linear fields,
    whether nodes lie in the plane or not."""
    solid = block(low, high, count)
    on_plane = np.abs(solid.points[:, 2]) < 1e-9
    snapshot = vtu.cut_in_plane(solid, on_plane)
    assert areas(snapshot).sum() == pytest.approx(4) and areas(snapshot).min() > 0
    assert snapshot.fields["von_mises"] == pytest.approx(1 + snapshot.points @ (2.0, -1.0))
    assert snapshot.fields["displacement"] == pytest.approx(np.pad(snapshot.points, [(0, 0), (0, 1)]))
    sides = np.sort(snapshot.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    outline = np.unique(sides, axis=0, return_counts=True)
    ends = snapshot.points[outline[0][outline[1] == 1]]
    # The section is connected: its free edges lie on the surface of the block.
    assert (np.isclose(np.abs(ends).max(axis=2), 1)).all()


@pytest.mark.parametrize("low, high, count", [(-1, 2, 2), (-1, 1, 2), (-0.25, 0.75, 2)])
def test_the_cut_of_a_layered_body_has_its_interface(low, high, count):
    """A line along x = 0 from side to side."""
    solid = block(low, high, count)
    layers = (solid.points[solid.tetrahedra[:, :4], 0].mean(axis=1) > 0).astype(int)
    snapshot = vtu.cut_in_plane(dataclasses.replace(solid, layers=layers), np.abs(solid.points[:, 2]) < 1e-9)
    ends = snapshot.points[snapshot.interfaces]
    assert abs(ends[..., 0]).max() < 1e-12 and np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).sum() == pytest.approx(2)
    assert len(vtu.cut_in_plane(solid, np.zeros(len(solid.points), bool)).interfaces) == 0


def test_a_body_beside_the_plane_has_no_cut():
    solid = block(0.5, 1, 1)
    assert len(vtu.cut_in_plane(solid, np.zeros(len(solid.points), bool)).triangles) == 0


@pytest.mark.parametrize("restitution, drawn", [(np.nan, False), (0.8, True)])
def test_no_legend_without_names(recwarn, restitution, drawn):
    """If no bounce has a restitution, as between a table and a pressing plate, there is no figure
    and no warning."""
    columns = {"body": 1, "partner": -1, "start": [0.0, 1e-3], "end": [5e-4, 2e-3], "impulse": [1.0, 0.8], "approach": [1.2, 1.0],
               "separation": [0.1, 0.1], "slip_before": [0.0, 0.0], "restitution": restitution, "restitution_tangential": np.nan}
    figure = impacts.draw(pd.DataFrame(columns).to_records(index=False), ["block"], ["table"])
    assert (figure is not None) == drawn and not recwarn.list
    plt.close("all")


def test_a_legend_takes_what_has_a_name():
    """A legend without labels is omitted."""
    figure, axes = plt.subplots()
    axes.plot([0, 1])
    figures.legend(axes)
    assert axes.get_legend() is None
    axes.plot([1, 0], label="a line")
    figures.legend(axes)
    assert labels(axes) == ["a line"]
    plt.close(figure)
