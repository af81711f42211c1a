"""The tables of whole scenes: the entries at the top, bodies, obstacles and contact.

TOML files, --set, the Python interface and the JSON schema use them. The program chooses an entry
that is None. Units are SI.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated, Any, NamedTuple

from ..failure import BadInput, brief, gathered, suggestion, unknown
from .bodies import SIZES, Body
from .contact import CONTACT, Contact, OfContact
from .dimension import DIMENSIONS, PLANE_STRAIN, SOLID, Dimension
from .entries import FORMER, Context, Entries, no_more, no_such, rule_of
from .materials import OfMaterial
from .obstacles import OBSTACLES, Obstacle
from .parameter import Parameter, Rule, integer, real, word
from .rules import InSpace, Text
from .shapes import BODIES

__all__ = [
    "PARAMETERS",
    "RUN",
    "Tables",
    "Top",
    "full_name",
    "listed",
    "obstacles_of",
    "of_table",
    "read",
    "rule_of_body",
    "tables",
]


class Top(OfMaterial):
    """The entries at the top of a scene.

    They control the run, and set the material and mesh sizes of bodies without their own.
    """

    title: Annotated[str | None, Text(), "a line about it"] = None
    script: Annotated[str | None, Text(), "script of edp/"] = None
    dimension: Annotated[
        str | None,
        Parameter("", "word", None, "-", words=tuple(DIMENSIONS)),
        "what it is computed in",
    ] = None
    symmetry: Annotated[
        str | None,
        Parameter("", "word", None, "-", words=("auto", "full", "half", "quarter")),
        "the part that is computed: in the plane the half x >= 0, in space the half z >= 0, or of "
        "that the half x >= 0; auto = the least that represents the scene",
    ] = None
    only = dict.fromkeys(("symmetry", "body_force_x"), (PLANE_STRAIN, SOLID))
    mesh_size: Annotated[
        float | None, real(0, 0, 1e9, "m"), "element size in the bulk; 0 = from accuracy"
    ] = None
    contact_mesh_size: Annotated[
        float | None,
        real(0, 0, 1e9, "m"),
        "element size at the contact boundary; 0 = from accuracy",
    ] = None
    gravity: Annotated[
        float | None,
        real(0, 0, 1e12, "m/s2"),
        "gravity, along -y; another direction: body_force_x, body_force_y",
    ] = None
    body_force_x: Annotated[
        float | None,
        real(0, -1e12, 1e12, "m/s2"),
        "constant body force b of (1), along the plane",
    ] = None
    body_force_y: Annotated[
        float | None,
        real(0, -1e12, 1e12, "m/s2"),
        "constant body force b of (1), away from the plane; gravity comes on top",
    ] = None
    volume: Annotated[
        str | None,
        word("auto", ("plain", "projected", "auto")),
        "resistance to change of volume: plain = at points, which locks as nu -> 0.5; projected ="
        " what is beyond that of nu = 0.45 in the mean of each element; auto = projected, where "
        "degree=1 plain",
    ] = None
    degree: Annotated[
        int | None, integer(2, 1, 2, "-"), "polynomial degree of the displacement"
    ] = None
    integrator: Annotated[
        str | None,
        word(
            "energy-momentum",
            ("energy-momentum", "midpoint", "backward-euler", "bdf2", "central-difference", "auto"),
        ),
        "time integrator; central-difference: explicit, in substeps that resolve the waves in "
        "the bodies, contact and friction solved in each; auto: central-difference or "
        "energy-momentum, whichever is cheaper by the estimated number of operations",
    ] = None
    dt: Annotated[float | None, real(0, 0, 1e9, "s"), "time step; 0 = adaptive"] = None
    accuracy: Annotated[
        float | None,
        real(0.005, 1e-5, 0.4, "-"),
        "requested relative accuracy: of impulse and thresholded contact time relative to themselves, "
        "rebound velocities and spin relative to the speed, energies and friction work to the largest "
        "energy; mesh and step that are not given follow from it",
    ] = None
    accuracy_of: Annotated[
        str | None,
        word("promised", ("promised", "friction_work", "peak_force", "contact_time")),
        "one more number to which the accuracy applies, relative to itself: it costs more"
        " because these numbers scatter more",
    ] = None
    tolerance: Annotated[
        float | None,
        real(5e-12, 1e-15, 0.0001, "-"),
        "largest work of the residual in a step, over the energy at the start",
    ] = None
    breakdown: Annotated[
        str | None,
        word("stop", ("stop", "continue")),
        "what a run does under svk when det F <= 0 or a point loses four fifths of its volume in "
        "the smallest step",
    ] = None
    chatter: Annotated[
        str | None,
        word("stop", ("stop", "continue")),
        "what a run does when the body leaves the obstacle and is back within a transit of its "
        "waves twenty times in a row",
    ] = None
    end_time: Annotated[
        float | None,
        real(0, 0, 1e9, "s"),
        "end of the run; 0 = until the first impact is over, with the contacts that follow it at "
        "once",
    ] = None
    start: Annotated[
        str | None,
        word("given", ("given", "equilibrium")),
        "the bodies at t = 0: as given, or at rest in equilibrium under body force, loads, gas and "
        "contact, reached from the given shape and place by slow loading",
    ] = None
    until: Annotated[
        str | None,
        word("impact", ("impact", "rest")),
        "what ends the run, at end_time at the latest: the end of the impact, or under gravity, "
        "with viscosity or friction, that all rests",
    ] = None
    fields: Annotated[int | None, integer(0, 0, 10000, "-"), "number of field snapshots (VTU)"] = (
        None
    )
    modes: Annotated[
        int | None,
        integer(0, 0, 500, "-"),
        "number of natural modes of the free bodies, with their energies at the end of the run; 0"
        " = none",
    ] = None
    checkpoint_every: Annotated[
        int | None,
        integer(0, 0, 1000000000, "steps"),
        "a checkpoint every so many steps, from which a killed run goes on; 0 = none; the answer "
        "stays the same",
    ] = None
    without: Annotated[
        str | None,
        word(
            "none",
            ("none", "flight", "friction", "body-force", "frozen-factorisation", "contact-culling"),
        ),
        "leave out one saving, to measure what it saves",
    ] = None

    @classmethod
    def refused(cls, name: str, value: Any, dimension: Dimension | None) -> str:
        """The message about an unknown entry, with the table that has this entry, if any."""
        if name in FORMER:
            return no_more(name, value)
        of_bodies = {entry for model in BODIES.values() for entry in model.names(dimension)}
        meant = (
            f"body.1.{name}" if name in of_bodies else f"contact.{name}" if name in CONTACT else ""
        )
        accepted = [*cls.names(dimension), "body", "obstacle", "contact"]
        if not meant and not suggestion(name, accepted):
            meant = _nearest(name, of_bodies, CONTACT)
        return no_such(name, value, accepted, meant)


def _nearest(name: str, of_bodies: Iterable[str], of_contact: Iterable[str]) -> str:
    """The dotted name of the entry of a body or of the contact that a misspelt name may mean."""
    places = {f"body.1.{entry}": entry for entry in sorted(of_bodies)}
    places |= {f"contact.{entry}": entry for entry in of_contact}
    near = suggestion(name, list(dict.fromkeys(places.values())))
    return next((place for place, entry in places.items() if f" {entry}?" in near), "")


# ---- whole scenes


def _parameters() -> Iterator[Parameter]:
    models: tuple[type[Entries], ...] = (OfMaterial, Body, OfContact, Contact, Top)
    for model in models:
        for name in model.__annotations__:
            rule: Rule | None = rule_of(model, name)
            rule = rule.plane if isinstance(rule, InSpace) else rule
            if isinstance(rule, Parameter) and rule.default is not None:
                yield replace(rule, name=name)


# The parameters by name: entries with defaults, which are those of a run, of contact and of bodies.
PARAMETERS: dict[str, Parameter] = {parameter.name: parameter for parameter in _parameters()}
# Those of a run, at the top of a scene.
RUN = tuple(name for name in Top.__annotations__ if name in PARAMETERS and name not in SIZES)


class Tables(NamedTuple):
    """The tables of a scene."""

    top: Top
    bodies: list[Body]
    obstacles: list[Obstacle]
    contact: Contact


KINDS: dict[str, tuple[str, dict[str, type[Any]]]] = {
    "body": ("shape", BODIES),
    "obstacle": ("kind", OBSTACLES),
}


def read(content: dict[str, Any], dimension: Dimension, folder: Path = Path()) -> Tables:
    """The tables of a scene, whose files are sought from `folder`. Raises BadInput with a line for
    each error in any of them.
    """
    top = {name: value for name, value in content.items() if name not in (*KINDS, "contact")}
    every = gathered(
        (
            lambda: Top.from_table("", top, dimension),
            lambda: tables(content, "body", dimension),
            lambda: tables(content, "obstacle", dimension),
            lambda: Contact.from_table("contact", content.get("contact", {}), dimension),
        )
    )
    made = Tables(*every)
    context = Context(dimension, folder, made.top.end_time or 0.0, made.top)
    for table in (*made.bodies, *made.obstacles):
        table.bind(context)
    return made


def tables(content: dict[str, Any], key: str, dimension: Dimension) -> list[Any]:
    """The bodies or obstacles of a scene's tables `[[key]]`."""
    listed_ones = enumerate(listed(content, key), 1)
    return gathered(
        [partial(of_table, f"{key}.{k}", table, key, dimension) for k, table in listed_ones]
    )


def obstacles_of(content: dict[str, Any], dimension: Dimension, folder: Path) -> list[Obstacle]:
    """The obstacles of a scene whose other tables are not needed."""
    made: list[Obstacle] = tables(content, "obstacle", dimension)
    for obstacle in made:
        obstacle.bind(Context(dimension, folder, content.get("end_time") or 0.0))
    return made


def of_table(
    entry: str, table: dict[str, Any], key: str, dimension: Dimension | None = None
) -> Any:
    """The body or obstacle of a table, by its shape or kind.

    Without a `dimension`, the shapes or kinds of all dimensions are accepted. Raises BadInput
    for other ones and for errors in the table.
    """
    word, models = KINDS[key]
    accepted = [
        name for name, model in models.items() if dimension is None or dimension in model.dimensions
    ]
    name = table.get(word)
    if name is None:
        raise BadInput(f"{entry}.{word}: is missing (accepted: {'|'.join(accepted)})")
    if not isinstance(name, str) or name not in accepted:
        raise BadInput(f"{entry}.{word}: {unknown(name, accepted)}")
    own = {key: value for key, value in table.items() if key != word}
    return models[name].from_table(entry, own, dimension)


def rule_of_body(name: str) -> Parameter | None:
    """The rule of a number among the entries of bodies, None if no body has such a number."""
    rules = (rule_of(model, name) for model in BODIES.values())
    return next((rule for rule in rules if isinstance(rule, Parameter)), None)


def full_name(content: dict[str, Any], name: str, dimension: Dimension) -> str:
    """The dotted name of an entry. A name without a table is that of the top of the scene, of
    [contact], or of the only body: penalty is contact.penalty, speed is body.1.speed.

    Raises BadInput for a former entry.
    """
    if name in FORMER:
        raise BadInput(f"{name}: is no entry any more (accepted: {FORMER[name]})")
    if "." in name or name in (*Top.names(dimension), *KINDS, "contact"):
        return name
    if name in Contact.names(dimension):
        return f"contact.{name}"
    bodies = listed(content, "body")
    shape = BODIES.get(bodies[0].get("shape", "")) if len(bodies) == 1 else None
    own = (*shape.heading, *shape.names(dimension)) if shape else ()
    return f"body.1.{name}" if name in own else name


def listed(content: dict[str, Any], key: str) -> list[dict[str, Any]]:
    """The list of tables `[[key]]` of a file, [] without such tables; raises BadInput otherwise."""
    tables = content.get(key, [])
    if not isinstance(tables, list):
        raise BadInput(f"{key}: '{brief(tables)}' is no list of tables (accepted: [[{key}]])")
    for k, table in enumerate(tables, 1):
        if not isinstance(table, dict):
            raise BadInput(f"{key}.{k}: '{brief(table)}' is no table (accepted: [[{key}]])")
    return tables
