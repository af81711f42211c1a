"""What needs what: the values of entries that a property of a scene needs, as one table.

refuse() reads the table where a scene is read, implicit_for() where integrator = auto is settled.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..failure import BadInput
from ..input.materials import LAW_WORDS
from ..input.parameters import PARAMETERS, Value

if TYPE_CHECKING:
    from ..scene import Scene

__all__ = ["EXPLICIT", "IMPLICIT", "NEEDS", "Need", "implicit_for", "refuse"]

# The integrator that `auto` takes for many small steps, and the one that it takes otherwise.
EXPLICIT, IMPLICIT = "central-difference", "energy-momentum"
_INTEGRATORS = tuple(word for word in PARAMETERS["integrator"].words if word != "auto")
_IMPLICIT = tuple(word for word in _INTEGRATORS if word != EXPLICIT)
_MIDDLE = (IMPLICIT, "midpoint")  # forces in the middle of a step: their work is exact


@dataclass(frozen=True)
class Need:
    """A row of the table.

    `what` is the property with its verb ("rigid bodies need"). `has` tells whether a part of the
    scene has it: a body if the property is one `of_body`, else the scene itself. `accepted` holds
    the accepted values by entry; `auto` is accepted beside them.
    """

    what: str
    of_body: bool
    has: Callable[[Any], bool]
    accepted: dict[str, tuple[Value, ...]]

    def holders(self, scene: Scene) -> list[tuple[str, Any]]:
        """Returns the bodies that have the property, or the scene, with the prefix of their entries."""
        parts: list[tuple[str, Any]] = [("", scene)]
        if self.of_body:
            alone = len(scene.bodies) == 1
            parts = [
                ("" if alone else f"body.{k}.", body) for k, body in enumerate(scene.bodies, 1)
            ]
        return [(prefix, part) for prefix, part in parts if self.has(part)]


NEEDS = (
    Need(
        "supports and loads need",
        True,
        lambda body: bool(body.supports or body.loads),
        {"integrator": _MIDDLE},
    ),
    # The few unknowns of a rigid body have no diagonal mass.
    Need("rigid bodies need", True, lambda body: body.rigid, {"integrator": _IMPLICIT}),
    # Dissipation is counted by the rate of deformation in the middle of a step.
    Need(
        "viscosity or relaxation needs",
        True,
        lambda body: any(material.damped for material in body.materials),
        {"integrator": _MIDDLE},
    ),
    # A pressure in each element keeps its volume at the end of a step. svk is quadratic in E: it has
    # no limit for nu -> 0.5. The volume of a metal has a modulus.
    Need(
        "nu = 0.5 (J = 1) needs",
        True,
        lambda body: any(material.nu == 0.5 for material in body.materials),
        {
            "integrator": (IMPLICIT,),
            "degree": (2,),
            "volume": ("projected",),
            "law": tuple(law for law in LAW_WORDS if law not in ("svk", "metal")),
        },
    ),
    # Elements of degree 1 lock in plastic flow. Stresses that stay in a dented metal are no vibration,
    # which the test for rest and flights without vibration would take them for.
    Need(
        "law = 'metal' needs",
        True,
        lambda body: any(material.law == "metal" for material in body.materials),
        {"degree": (2,), "until": ("impact",)},
    ),
    # An element of degree 1 has one volume.
    Need(
        "volume = 'projected' needs",
        False,
        lambda scene: scene.values["volume"] == "projected",
        {"degree": (2,)},
    ),
    # Explicit steps reduce the penalty, and with it the depth at rest.
    Need(
        "start = 'equilibrium' needs",
        False,
        lambda scene: scene.values["start"] == "equilibrium",
        {"integrator": _IMPLICIT},
    ),
    # The nodes of straight elements are not moved.
    Need("given_shape = 'inflated' needs", True, lambda body: body.inflated, {"degree": (2,)}),
    # The potential of adhesion is not convex; other integrators gain energy from it.
    Need(
        "adhesion needs",
        False,
        lambda scene: scene.contact_values["adhesion"] > 0,
        {"integrator": (IMPLICIT, EXPLICIT)},
    ),
    # The others take contact forces at the end of a step, where their work is not exact.
    Need(
        "penalty_damping needs",
        False,
        lambda scene: scene.contact_values["penalty_damping"] > 0,
        {"integrator": (*_MIDDLE, EXPLICIT)},
    ),
)


def refuse(scene: Scene) -> None:
    """Raises BadInput for the first entry with a value that a property of the scene does not accept.
    The message has the values that all properties of the scene accept.
    """
    present = [(need, holders) for need in NEEDS if (holders := need.holders(scene))]
    for need, holders in present:
        for name in need.accepted:
            rows = [other.accepted[name] for other, _ in present if name in other.accepted]
            words = [word for word in need.accepted[name] if all(word in row for row in rows)]
            if "auto" in PARAMETERS[name].words:
                words = ["auto", *words]
            for entry, value in _values(scene, name, holders):
                if value not in ("auto", *need.accepted[name]):
                    raise BadInput(
                        f"{entry}: '{value}', but {need.what} another value "
                        f"(accepted: {'|'.join(map(str, words))})"
                    )


def implicit_for(scene: Scene) -> str:
    """Returns which property of the scene needs implicit steps, as a sentence; "" if none does."""
    for need in NEEDS:
        if EXPLICIT not in need.accepted.get("integrator", (EXPLICIT,)) and need.holders(scene):
            return f"{need.what} implicit steps"
    return ""


def _values(scene: Scene, name: str, holders: list[tuple[str, Any]]) -> list[tuple[str, Value]]:
    """Returns the full names and values of an entry: of the run, or of the bodies `holders`."""
    if name in scene.values:
        return [(name, scene.values[name])]
    return [
        (f"{prefix}{name}", getattr(material, name))
        for prefix, body in holders
        for material in body.materials
    ]
