"""Figures and the snapshots from which they are drawn."""

import numpy as np
import pytest

from ffimpact.report import bodies, drawing, figures


def test_a_title_is_shown_as_written(tmp_path):
    """Dollar signs are not formulas, control characters become blanks, long titles are wrapped and
    cut."""
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
    """Under gravity from rest, kinetic and elastic energy equal the work of the weight. Their
    difference is 0 and cannot scale the balance."""
    t = np.linspace(0, 1e-2, 5)
    rest = np.zeros_like(t)
    history = dict(t=t, kinetic=1e3 * t, elastic=2e3 * t, contact=rest, friction_work=rest, external_work=3e3 * t, balance=np.full_like(t, 3e-12), normal_force=rest)
    figure = bodies.energies(history, {"script": "bodies", "body": [{"name": "body"}]})
    line = figure.axes[-1].lines[0].get_ydata()
    figures.plt.close(figure)
    assert line == pytest.approx(1e-13)


def test_fifty_bodies_and_no_force(recwarn):
    """With many bodies, legends and titles contain the first and the last. Without contact forces
    there is no legend and no warning."""
    t = np.linspace(0, 1e-2, 5)
    many, scene = {f"body{k}": f"_{k}" for k in range(1, 51)}, {"script": "bodies", "body": [{"name": f"body{k}"} for k in range(1, 51)]}
    history = dict(t=t, dt=0 * t + t[1], normal_force=0 * t, friction_force=0 * t) | {f"{name}{suffix}": (name == "vx") + 0 * t
                                                                     for suffix in many.values() for name in ("vx", "vy", "spin", "force_x", "force_y")}
    speeds, pushes = bodies.velocities(history, scene), bodies.forces(history, scene)
    named = [text.get_text() for text in speeds.axes[0].get_legend().get_texts()]
    assert named == [f"body{k}" for k in (*range(1, 7), *range(45, 51))] and pushes.axes[0].get_legend() is None and not recwarn.list
    for figure in (speeds, pushes):
        figures.plt.close(figure)
