"""Changes the sizes of elements and steps of a scene, for the runs that estimate an error."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from ..input.bodies import SIZES
from ..input.parameters import Table
from ..output import estimate
from .approach import onsets_of
from .front import fronts, stretch_of

if TYPE_CHECKING:
    from ..scene import Scene

__all__ = ["scaled"]


def scaled(scene: Scene, used: Table, factor: float) -> Table:
    """Returns the entries to override in a scene, run before as the tables `used`, for `factor`
    times its elements and steps.

    Penalty, slip velocity and dynamic friction keep their values, except the penalty of flat
    strikes. Meshes of files stay, too.
    """
    kept = ("penalty", "slip_velocity", "friction_dynamic")
    entries: Table = {f"contact.{name}": used["contact"][name] for name in kept}
    if used["contact"].get("pair"):
        entries["contact.pair"] = _pairs(scene, used["contact"]["pair"], factor)
    entries["accuracy"] = estimate.loosened(used["accuracy"], factor)
    stretched = any("mesh_stretch" in table for table in used["body"])
    strikes = []
    if stretched:  # errors of fronts are of first order in the elements
        first_order = math.sqrt(scene.number("accuracy") * entries["accuracy"])
        strikes = fronts(scene.override({"accuracy": first_order}), onsets_of(scene))
    for k, (body, table) in enumerate(zip(scene.bodies, used["body"])):
        if not body.file_mesh:
            bulk = min(factor * table["mesh_size"], 2 * body.outline.coarsest)
            before = table.get("mesh_stretch", 1.0)
            stretch = before if body.mesh_stretch else stretch_of(k, strikes, bulk)
            contact = min(bulk, factor * table["contact_mesh_size"] * before / stretch)
            sizes = dict(zip(SIZES, (bulk, contact))) | (
                {"mesh_stretch": stretch} if stretched else {}
            )
            entries |= {f"body.{k + 1}.{name}": value for name, value in sizes.items()}
    if used["dt"] > 0:
        entries["dt"] = factor * used["dt"]
    return entries | estimate.output(factor)


def _pairs(scene: Scene, used: list[Table], factor: float) -> list[Table]:
    """Returns the tables [[contact.pair]] for `factor` times the elements. If the penalty of a flat
    strike is automatic, it changes so that the front rises in `factor` times the time. The
    estimated error is then that of elements and penalty together (front.py).
    """
    fixed_pairs = {(pair.first, pair.second) for pair in scene.pairs if "penalty" in pair}
    if scene.contact_values["penalty"] != "auto" or len(used) == len(fixed_pairs):
        return used
    onsets = [front.onset for front in fronts(scene, onsets_of(scene))]
    # The index -1 is obstacle 0.
    others = [body.own_name for body in scene.bodies]
    others += [obstacle.own_name for obstacle in reversed(scene.obstacles)]
    flat = [
        [others[onset.first], others[onset.second]]
        for onset in onsets
        if (onset.first, onset.second) not in fixed_pairs
    ]
    softer = factor ** scene.number("exponent")
    return [
        pair | {"penalty": pair["penalty"] / softer} if pair["bodies"] in flat else pair
        for pair in used
    ]
