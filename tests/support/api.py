"""Helpers that the modules test_api.py share."""

import ffimpact as ff

RUBBER = ff.NeoHookean(young=7e6, nu=0.45, density=1722)


def drop(**entries) -> ff.Scene:
    """A scene with a disc 1 mm above the floor."""
    disc = ff.Disc(radius=0.05, material=RUBBER, position=(0, 0.051), velocity=(0, -8))
    contact = entries.pop("contact", ff.Contact(friction_static=0.3))
    return ff.Scene(bodies=[disc], obstacles=[ff.Plane()], contact=contact, **entries)
