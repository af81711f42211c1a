"""V10: a stiff disc hits the plane obliquely. Expected is the rigid limit with the measured
restitution e."""

import math
from collections.abc import Iterator
from pathlib import Path

from .case import LAWS, Row
from .measure import disc

# A pressure wave crosses this disc in 35 us, and its contact lasts 1.4 ms for a penalty of 1e10:
# the disc is rigid on its penalty. Its stresses are large relative to its energy, so that round-off
# permits a tolerance of 1e-10 of the initial energy, not the default 5e-12.
STIFF = dict(radius=0.05, young=1e10, nu=0.3, speed=1, slip_velocity=1e-3, mesh_size=0.025, contact_mesh_size=0.0079, accuracy=0.03, tolerance=1e-10)


def leaves(lost: float, inertia: float = 2) -> tuple[float, float]:
    """Speed of the centre and speed of the rim about it after the impact, over the initial speed
    along the plane.

    The share `lost` = mu (1+e) v_n/v_t of this speed is lost if the body slides throughout, 1/(1 +
    inertia) if it rolls at the end. `inertia` is R^2/k^2 with the radius of gyration k, 2 for a
    disc.
    """
    rolls = inertia / (1 + inertia)
    return (1 - lost, inertia * lost) if 1 > (1 + inertia) * lost else (rolls, rolls)


def oblique(folder: Path) -> Iterator[Row]:
    """Speed along the plane and of the rim after the impact over the initial speed along the plane,
    with the measured restitution."""
    for penalty in (1e11, 3e10, 1e10, 3e9):
        for law, friction, angle in (("neohookean", 0.2, 30), ("svk", 0.3, 20), ("neohookean", 0.2, 60), ("svk", 0.2, 75)):
            summary = disc(folder, law=law, angle=angle, friction_static=friction, friction_dynamic=friction, penalty=penalty,
                           **STIFF).summary
            along, across = math.cos(math.radians(angle)), math.sin(math.radians(angle))
            lost = friction * (across + summary["rebound_vy"]) / along
            (centre, rim), slides, size = leaves(lost), 1 > 3 * lost, penalty * STIFF["radius"] / STIFF["young"]
            words = f"{'slides' if slides else 'rolls'}, {angle}°, {LAWS[law]}"
            yield Row(f"{words}: centre", size, summary["rebound_vx"] / along, centre)
            yield Row(f"{words}: rim", size, -summary["rebound_spin"] * STIFF["radius"] / along, rim)
