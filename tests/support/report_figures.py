"""Helpers that the modules test_report_figures.py share."""

import numpy as np

MATERIAL = dict(law="svk", young=7e6, nu=0.45, density=1722)


def disc(**entries) -> dict:
    """A scene as used: a disc that falls on the plane. Entries of the disc replace its own."""
    body = MATERIAL | dict(name="disc", shape="disc", radius=0.05, position=[0.0, 0.05], speed=8, direction=-90) | entries
    return dict(script="bodies", dimension="plane-strain", title="disc", gravity=0, body_force_x=0, body_force_y=0, touched=(0.0, 3.93e-3), body=[body],
                obstacle=[dict(name="plane", kind="plane", point=[0.0, 0.0], normal=[0.0, 1.0])],
                contact=dict(friction_static=0, penalty=1e10, exponent=1))


SCENE = disc()


def history(**columns) -> dict[str, np.ndarray]:
    """A contact of 4 ms and 1 ms of flight after it, in steps of 0.05 ms. The first row is just
    before contact."""
    t = np.linspace(5e-5, 5e-3, 100)
    none = np.zeros_like(t)
    force = np.where(t < 4e-3, 1e4 * np.sin(np.pi * t / 4e-3), 0)
    return dict(t=t, dt=np.full_like(t, 5e-5), normal_force=force, friction_force=none, kinetic=400 - 100 * np.sin(np.pi * t / 5e-3), elastic=100 * np.sin(np.pi * t / 5e-3),
                contact=none + 1e-3, friction_work=none, external_work=none, balance=none + 1e-9, vx=none, vy=np.linspace(-8, 8, 100), spin=none,
                sliding_fraction=none + 1) | columns


def labels(axes) -> list[str]:
    return [text.get_text() for text in axes.get_legend().get_texts()]
