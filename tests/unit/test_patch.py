"""The contact area: half-width and largest pressure in the history and the summary against
fields/contact.csv, ParaView files, the figure."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

from ffimpact.report import contact


def cloud(bodies: int, turn: float) -> np.recarray:
    """Loaded contact points of whole bodies in three dimensions, with the pressure p0 sqrt(1 -
    r^2).

    They lie in a disc of radius 1 mm whose normal is rotated by the angle `turn` about z.
    """
    rng = np.random.default_rng(1)
    radius, angle = np.sqrt(rng.uniform(0, 1, 400)), rng.uniform(0, 2 * np.pi, 400)
    across, up = 1e-3 * radius * np.cos(angle), 1e-3 * radius * np.sin(angle)
    x, y = across * np.cos(turn), across * np.sin(turn)
    points = pd.DataFrame({"s": 1e-3 * radius, "X": x, "Y": y, "Z": up, "x": x, "y": y, "z": up, "weight": np.pi * 1e-6 / 400, "pressure": 1e6 * np.sqrt(1 - radius**2),
                           "projected_pressure": 1e6 * np.sqrt(1 - radius**2), "shear": 1.0, "shear_z": 0.0, "slip_velocity": 0.1, "slip_velocity_z": 0.0, "slides": (radius > 0.7).astype(int), "partner": -1})
    return pd.concat([points.assign(t=t, body=body) for t in (1e-3, 2e-3) for body in range(1, bodies + 1)]).to_records(index=False)


def test_rings_are_means_over_the_surface():
    """Means over rings as functions of the distance from the first contact point.

    The pressure of a ring is that of its radius. A ring slides beyond 0.7 mm and sticks within. The
    loads of the rings add up.
    """
    table = cloud(1, 0.0)
    own, words, states = contact.radial(table, None)
    now = own[own.t == 1e-3]
    assert words == "distance from the first contact point" and states == contact.SLIDES
    np.testing.assert_allclose(now.pressure, 1e6 * np.sqrt(1 - (1e3 * now.s) ** 2), atol=1e5)
    assert (now.state[now.s > 0.75e-3] == 1).all() and (now.state[now.s < 0.65e-3] == 0).all()


@pytest.mark.parametrize("count, turn", [(1, 0.0), (2, 0.7)])
def test_whole_bodies_in_three_dimensions_are_drawn(count, turn):
    """With several bodies the contact area is drawn in its own plane, in any orientation, and the
    map has its width."""
    table = cloud(count, turn)
    figure = contact.draw(table, ["a", "b"][:count], False, np.array([]), None, "full", None)
    maps = [axes for axes in figure.axes if axes.get_aspect() == 1]
    assert len(maps) == 2 * 2 * count
    if count == 2:
        assert list(np.ptp(np.asarray(maps[0].collections[0].get_offsets()), axis=0)) == pytest.approx([2, 2], rel=0.05)
    plt.close(figure)


def test_a_contact_pair_is_shown_once():
    """Three bodies in a row are shown by the two outer ones. A body that also lies on an obstacle is
    shown, too."""
    def shown(*pairs):
        rows = np.rec.fromrecords([(body, partner, 1.0) for body, partner in pairs], names="body,partner,pressure")
        return contact.representatives(rows)
    row = (1, 2), (2, 1), (2, 3), (3, 2)
    assert shown((1, 2), (2, 1)) == [1] and shown(*row) == [1, 3] and shown(*row, (2, -1)) == [1, 2, 3]
