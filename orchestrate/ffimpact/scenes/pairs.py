"""Contact pairs of a scene that have parameters of their own, and bodies that may come into contact
with themselves. A surface has the index k of body k, or -1 - k of obstacle k.
"""

import itertools
from typing import Any

from ..failure import BadInput, brief
from ..geometry.outlines import Outline
from ..input.bodies import Body
from ..input.contact import Contact, Pair
from ..input.dimension import AXISYMMETRIC, Dimension
from ..input.obstacles import Obstacle
from ..input.parameters import Value

__all__ = [
    "STIFF",
    "exceptions",
    "names",
    "own_of_obstacles",
    "penalties_of",
    "with_rigid_modulus",
    "touching_themselves",
]

# `young` of a rigid body over the largest of the others. Its strain is smaller by this factor.
STIFF = 1e5
# Bending strain (Outline.folding) up to which a body may come into contact with itself: that of a
# ring as thick as its inner radius.
FOLDING = 0.2


def names(bodies: list[Body], obstacles: list[Obstacle]) -> dict[str, int]:
    """Returns the index of each body and obstacle by name. Raises BadInput if a name occurs twice."""
    index: dict[str, int] = {}
    where: dict[str, str] = {}
    surfaces: list[tuple[int, Body | Obstacle]] = list(enumerate(bodies))
    for number, surface in [*surfaces, *((-1 - k, other) for k, other in enumerate(obstacles))]:
        if (name := surface.own_name) in index:
            raise BadInput(
                f"{surface.at('name')}: '{brief(name)}' is the name of {where[name]} too (accepted: each name once)"
            )
        index[name], where[name] = number, surface.entry
    return index


def own_of_obstacles(tables: list[Obstacle], bodies_count: int) -> dict[tuple[int, int], Pair]:
    """Returns the contact parameters in [[obstacle]] tables, as exceptions for every body."""
    pairs: dict[tuple[int, int], Pair] = {}
    for k, table in enumerate(tables):
        pairs |= {
            (body, -1 - k): Pair.between(body, -1 - k, table.entry, table.own)
            for body in range(bodies_count)
            if table.own
        }
    return pairs


def penalties_of(common: Value, pairs: list[Pair], bodies: int, obstacles: int) -> list[Value]:
    """Returns the penalties of all pairs of surfaces, by the numbers of bodies and obstacles; `common`
    where a pair has none of its own, and where there is no pair.
    """
    surfaces = [*range(bodies), *(-1 - k for k in range(obstacles))]
    every = [both for both in itertools.combinations(surfaces, 2) if both[0] >= 0]
    own = {(pair.first, pair.second): pair.own["penalty"] for pair in pairs if "penalty" in pair}
    return [own.get(both, common) for both in every] or [common]


def exceptions(tables: list[Pair], index: dict[str, int]) -> dict[tuple[int, int], Pair]:
    """Returns the exceptions in the tables [[contact.pair]] by the two indices."""
    pairs: dict[tuple[int, int], Pair] = {}
    for table in tables:
        both = _partners(table.entry, table.bodies, index)
        if both in pairs:
            raise BadInput(
                f"{table.at('bodies')}: '{table.value_text('bodies')}' has a table already (accepted: one a pair)"
            )
        pairs[both] = Pair.between(*both, table.entry, table.own)
    return pairs


def touching_themselves(
    contact: Contact,
    all_bodies: list[Body],
    scene_dimension: Dimension,
    alone: bool,
) -> list[int]:
    """Returns the bodies that may come into contact with themselves, by `self_contact`.

    "auto" takes bodies in the plane or of revolution that close at a bending strain below FOLDING,
    and nothing takes rigid ones.
    A body that is `alone`, without obstacles or other bodies, always may.
    """
    self_contact = contact.self_contact or "auto"
    if alone and self_contact == "off":
        raise BadInput(
            f"{contact.at('self_contact')}: off, but a body without obstacles and other bodies may "
            f"come into contact with itself (accepted: auto|on, or an obstacle)"
        )
    if alone:
        return [0]
    if self_contact == "off":
        return []
    return [
        k
        for k, body in enumerate(all_bodies)
        if not body.rigid
        and (
            self_contact == "on"
            or isinstance(body.outline, Outline)
            and body.outline.folding(scene_dimension is AXISYMMETRIC) < FOLDING
        )
    ]


def _partners(path: str, names: Any, index: dict[str, int]) -> tuple[int, int]:
    """Returns the indices of the two surfaces of a contact pair, the body or the first body
    first.
    """
    accepted = f"accepted: two names, one at least of a body, of {', '.join(index)}"
    if (
        not isinstance(names, list)
        or len(names) != 2
        or not all(isinstance(name, str) for name in names)
    ):
        raise BadInput(
            f"{path}.bodies: '{'' if names is None else brief(names)}' is no pair ({accepted})"
        )
    for name in names:
        if name not in index:
            raise BadInput(f"{path}.bodies: '{brief(name)}' is not in the scene ({accepted})")
    first, second = sorted((index[name] for name in names), key=lambda k: (k < 0, abs(k)))
    if first < 0:
        raise BadInput(
            f"{path}.bodies: '{brief(names)}' cannot come into contact with each other ({accepted})"
        )
    return first, second


def with_rigid_modulus(bodies: list[Body], penalties: list[Value], path: str) -> list[Body]:
    """Returns the bodies of a scene with `young` of the rigid ones.

    It is STIFF times the largest `young` of the other bodies. If all bodies are rigid it is STIFF
    times the largest of the `penalties` times the largest half thickness. Raises BadInput if one of
    the penalties is automatic then.
    """
    if not any(body.rigid for body in bodies):
        return bodies
    soft = max((body.made_of.young for body in bodies if not body.rigid), default=0.0)
    if not soft and "auto" in penalties:
        raise BadInput(
            f"{path}: 'auto' follows from a body that deforms, and all are rigid (accepted: a number, Pa/m^m)"
        )
    half = max(body.outline.half_thickness for body in bodies)
    young = STIFF * (soft or max(float(penalty) for penalty in penalties) * half)
    return [
        body.model_copy(update={"materials": [body.made_of.model_copy(update={"young": young})]})
        if body.rigid
        else body
        for body in bodies
    ]
