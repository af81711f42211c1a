"""The tables of a scene as pydantic models.

The models are bodies by shape, materials by law, supports, loads, obstacles by kind, contact, pairs
and the entries at the top. TOML files, --set, the Python interface and the JSON schema use them.
The program chooses an entry that is None. Units are SI.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from inspect import Parameter as Keyword, Signature
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, NamedTuple, Self

import numpy as np
from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ModelWrapValidatorHandler,
    PrivateAttr,
    ValidationError,
    model_serializer,
    model_validator,
)
from pydantic.fields import FieldInfo
from pydantic_core import PydanticCustomError

from ..failure import BadInput, brief, gathered, suggestion, unknown
from .dimension import AXISYMMETRIC, DIMENSIONS, PLANE_STRAIN, SOLID, Dimension
from .parameter import Parameter, Rule, integer, plain, real, word
from .rules import (
    LONGEST,
    Flag,
    Function,
    InSpace,
    Name,
    Numbers,
    OfPlace,
    Partners,
    Parts,
    Place,
    Points,
    Polygons,
    Rows,
    Text,
    Vector,
    Where,
    number,
)

__all__ = [
    "BODIES",
    "Ball",
    "Body",
    "Bowl",
    "Box",
    "CONTACT",
    "Circle",
    "Contact",
    "Cylinder",
    "DAMPING",
    "Disc",
    "Drawn",
    "Ellipse",
    "Ellipsoid",
    "Entries",
    "FIELDS",
    "FORMER",
    "Gas",
    "Hollow",
    "Implicit",
    "Incompressible",
    "LAWS",
    "LAW_WORDS",
    "LAW_ENTRIES",
    "Load",
    "MATERIAL",
    "MOST_PRESSURE",
    "MOST_STRETCH",
    "Material",
    "Mesh",
    "MooneyRivlin",
    "NOT_RIGID",
    "NeoHookean",
    "OBSTACLES",
    "OWN",
    "OfContact",
    "OfMaterial",
    "Obstacle",
    "Ogden",
    "PARAMETERS",
    "Pair",
    "Plane",
    "Polygon",
    "Polyline",
    "Rectangle",
    "Ring",
    "STIFFEST",
    "SaintVenantKirchhoff",
    "Shell",
    "Sphere",
    "Support",
    "Surface",
    "Tables",
    "Top",
    "Torus",
    "Tube",
    "full_name",
    "listed",
    "of_table",
    "read",
    "rule_of",
    "rule_of_body",
    "several",
    "tables",
]

if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
else:
    ModelMetaclass = type(BaseModel)

# Types of entries. Arrays and tuples become lists; Python functions become tables.
Components = list[float] | float  # one for each axis, or the only one
Timed = float | str | list[Any] | dict[str, Any] | Callable[[float], Any]  # functions of time
Placed = list[float | str] | dict[str, Any] | Callable[[np.ndarray], Any]  # functions of place

PLACEMENTS = ("centroid", "as-drawn")
MOST_PRESSURE = 1e15  # largest accepted pressure [Pa]
MOST_TURN = 36000.0  # largest accepted angle [degrees]
MOST_STRETCH = 20.0  # largest accepted ratio of the lengths of an element
SIDES = ("left", "right", "bottom", "top", "back", "front", "all", "outer", "inner", "axis")


def several(value: Any) -> Any:
    """Returns a single table as a list with one element, and any other value unchanged."""
    return [value] if isinstance(value, Entries) else value


class _Made(ModelMetaclass):
    """The metaclass of models: Python constructors raise BadInput and ignore entries that are None.

    BadInput replaces pydantic's ValidationError.
    """

    def __call__(cls, *unnamed: Any, **entries: Any) -> Any:
        if unnamed:
            accepted = ", ".join(cls.__signature__.parameters)
            raise BadInput(
                f"{cls.__name__}: '{brief(unnamed[0])}' has no name (accepted: entries by name: {accepted})"
            )
        set_entries = {name: plain(value) for name, value in entries.items() if value is not None}
        model: Any = cls  # a subclass of Entries
        try:
            made = super().__call__(**set_entries)
        except ValidationError as error:
            raise BadInput(*_lines(model, error, cls.__name__, ": ", None)) from None
        made._given = set_entries
        return made

    @property
    def __signature__(cls) -> Signature:
        """The entries as keywords, with units and meanings, for help() and notebooks."""
        model: Any = cls
        fields = {name: model.model_fields[name] for name in model.names(None)}
        keywords = [_keyword(*item) for item in fields.items() if not item[1].exclude]
        if issubclass(cls, Body):
            own = Keyword("material", Keyword.KEYWORD_ONLY, default=None, annotation="a Material")
            keywords.insert(1, own)
        return Signature(keywords)

    @__signature__.setter
    def __signature__(cls, made: Any) -> None:
        """Ignores pydantic's own signature, which contains only types."""


def _keyword(name: str, field: FieldInfo) -> Keyword:
    """The entry of a model as a keyword of its constructor."""
    rule = next((rule for rule in field.metadata if isinstance(rule, Rule)), None)
    text = rule.meaning if rule else field.description or ""
    default = Keyword.empty if field.is_required() else field.get_default()
    annotation = text or Keyword.empty
    return Keyword(name, Keyword.KEYWORD_ONLY, default=default, annotation=annotation)


class Entries(BaseModel, metaclass=_Made):
    """The common base of all tables of a scene."""

    # defer_build: built at the first use
    model_config = ConfigDict(extra="forbid", defer_build=True, validate_assignment=True)
    nested: ClassVar[dict[str, type[Entries]]] = {}  # the models of nested tables, by entry
    only: ClassVar[dict[str, tuple[Dimension, ...]]] = {}  # entries of some dimensions alone
    heading: ClassVar[tuple[str, ...]] = ()  # the entry that selects the model: shape or kind
    _entry: str = PrivateAttr("")  # the name of the table in the scene: body.2
    _given: dict[str, Any] = PrivateAttr(default_factory=dict)

    def __setattr__(self, name: str, value: Any) -> None:
        """Sets an entry if it is accepted as it would be when the table is made. Raises BadInput."""
        if name.startswith("_"):
            return super().__setattr__(name, value)
        before = dict(self.__dict__)
        try:
            super().__setattr__(name, plain(value))
        except (ValidationError, BadInput) as error:
            self.__dict__.update(before)
            if isinstance(error, BadInput):
                raise
            raise BadInput(*_lines(type(self), error, type(self).__name__, ": ", None)) from None
        self._given = {**self._given, name: value}

    @model_validator(mode="wrap")
    @classmethod
    def _agrees(cls, entries: Any, validated: ModelWrapValidatorHandler[Self]) -> Self:
        """Refuses entries that do not agree with each other, when made and when set."""
        model = validated(entries)
        if isinstance(entries, dict):
            model._given = entries
        if refusals := list(model.refusals()):
            raise PydanticCustomError("entries", "they do not agree", {"refusals": refusals})
        return model

    def refusals(self) -> Iterator[tuple[str, str]]:
        """Yields entries that do not agree with others of the table, each with the message behind its
        name.
        """
        yield from ()

    @model_serializer(mode="plain")
    def _dumped(self) -> dict[str, Any]:
        """model_dump() is table(): nothing of a body's shape is lost."""
        return self.table()

    def __repr_args__(self) -> list[tuple[str | None, Any]]:
        return [
            (name, value)
            for name, value in self
            if value is not None and type(self).model_fields[name].repr
        ]

    def __contains__(self, name: str) -> bool:
        return getattr(self, name, None) is not None

    @property
    def entry(self) -> str:
        """The name of the table in the scene, "body.2"."""
        return self._entry

    def at(self, name: str) -> str:
        """The full name of an entry of the table, "body.2.radius"."""
        return f"{self._entry}.{name}" if self._entry else name

    def value_text(self, name: str) -> str:
        """The given value of an entry, as a message prints it."""
        return brief(self._given.get(name, ""))

    def table(self) -> dict[str, Any]:
        """The table as in a TOML file, without entries that are None."""
        return {name: _table(value) for name, value in self if value is not None}

    @classmethod
    def names(cls, dimension: Dimension | None) -> list[str]:
        """The names of the entries in a dimension, the model's own before those of its bases."""
        every = dict.fromkeys(
            name
            for model in cls.__mro__
            for name in model.__dict__.get("__annotations__", {})
            if name in cls.model_fields
        )
        return [
            name
            for name in every
            if dimension is None or dimension in cls.only.get(name, (dimension,))
        ]

    @classmethod
    def refused(cls, name: str, value: Any, dimension: Dimension | None) -> str:
        """The message about an entry that the model does not have, behind the entry's name."""
        return _no_such(name, value, [*cls.heading, *cls.names(dimension)])

    @classmethod
    def read(cls, entry: str, table: Any, dimension: Dimension | None) -> Self:
        """The model of the table `entry` of a scene.

        Raises BadInput with a line for each error in the table.
        """
        if not isinstance(table, dict):
            raise BadInput(
                f"{entry}: '{brief(table)}' is no table (accepted: a table with {', '.join(cls.names(dimension))})"
            )
        names, others = cls.names(dimension), {}
        if set(cls.model_fields) - set(names):  # the model has entries of other dimensions
            others = {
                name: value
                for name, value in table.items()
                if name in cls.model_fields and name not in names
            }
        messages = [
            f"{entry}.{name}{cls.refused(name, value, dimension)}".lstrip(".")
            for name, value in others.items()
        ]
        try:
            model = cls.model_validate(
                {name: table[name] for name in table if name not in others},
                context={"of": dimension},
            )
        except ValidationError as error:
            messages += _lines(cls, error, entry, ".", dimension)
        if messages:
            raise BadInput(*messages)
        model._stands_at(entry, table)
        return model

    def _stands_at(self, entry: str, table: dict[str, Any]) -> None:
        self._entry, self._given = entry, table
        for name, value in self:
            if isinstance(value, Entries):
                value._stands_at(self.at(name), table[name])
            elif name in self.nested and isinstance(value, list):
                for k, nested_model in enumerate(value, 1):
                    nested_model._stands_at(f"{self.at(name)}.{k}", table[name][k - 1])


def _table(value: Any) -> Any:
    if isinstance(value, Entries):
        return value.table()
    return [_table(item) for item in value] if isinstance(value, list | tuple) else plain(value)


def _no_such(name: str, value: Any, accepted: list[str], meant: str = "") -> str:
    hint = f"; did you mean {meant}?" if meant else suggestion(name, accepted)
    return f": no such entry, set to '{brief(value)}'{hint} (accepted: {', '.join(accepted)})"


MOST_LINES = 20  # largest number of messages about one table


def _lines(
    model: type[Entries],
    error: ValidationError,
    entry: str,
    between: str,
    dimension: Dimension | None,
) -> list[str]:
    """The messages about all errors that pydantic finds: entry, value and accepted values.

    `between` is the text between the name of the table and that of the entry.
    """
    messages = []
    every = error.errors()
    misspelt = [str(item["loc"][-1]) for item in every if item["type"] == "extra_forbidden"]
    for problem in every:
        holder = model
        for part in problem["loc"][:-1]:
            holder = holder.nested.get(str(part), holder)
        if problem["type"] == "entries":
            path = [str(part + 1 if isinstance(part, int) else part) for part in problem["loc"]]
            for own_name, text in problem["ctx"]["refusals"]:
                dotted = ".".join([*path, *filter(None, [own_name])])
                messages.append(f"{entry}{between if entry and dotted else ''}{dotted}{text}")
            continue
        *parents, last = problem["loc"]
        parent_keys = [str(part + 1 if isinstance(part, int) else part) for part in parents]
        name = brief(last + 1 if isinstance(last, int) else last)
        if problem["type"] == "missing" and any(suggestion(word, [name]) for word in misspelt):
            continue  # the message about the misspelt name covers it
        at = f"{entry}{between if entry else ''}{'.'.join([*parent_keys, name])}"
        messages.append(
            at
            + _refusal(
                holder,
                problem,
                name,
                ".".join([*([entry] if entry else []), *parent_keys]),
                dimension,
            )
        )
    if len(messages) > MOST_LINES:
        messages[MOST_LINES:] = [
            f"{entry or 'the scene'}: {len(messages) - MOST_LINES} more entries are not accepted"
        ]
    return messages


def _refusal(
    holder: type[Entries], problem: Any, name: str, table: str, dimension: Dimension | None
) -> str:
    """The message about an error, behind the name of the entry; `table` is the enclosing table."""
    if problem["type"] in ("extra_forbidden", "no_such_attribute"):
        return holder.refused(name, problem["input"], dimension)
    if problem["type"] == "missing":
        rule = rule_of(holder, name)
        return f": is missing (accepted: {rule.accepted_in(dimension) if rule else 'a table'})"
    if problem["type"] == "value_error":
        return str(problem["ctx"]["error"])
    text = brief(problem["input"])
    if problem["type"] == "list_type":
        return f": '{text}' is no list of tables (accepted: [[{table}.{name}]])"
    if name.isdecimal():
        return f": '{text}' is no table (accepted: [[{table}]])"
    model = holder.nested.get(name, holder)
    return f": '{text}' is no table (accepted: a table with {', '.join(model.names(dimension))})"


def rule_of(model: type[Entries], name: str) -> Rule | None:
    """The rule of an entry of a model, None for an entry that has none and for a table."""
    field = model.model_fields.get(name)
    return (
        next((rule for rule in field.metadata if isinstance(rule, Rule)), None) if field else None
    )


# ---- materials

OF_BODIES = ()  # of no script: entries of bodies
# The words of the laws in edp/kernels/laws.cpp.
LAW_WORDS = ("svk", "neohookean", "mooney-rivlin", "ogden", "incompressible")
LAW = word(
    "svk",
    LAW_WORDS,
    "constitutive law: St. Venant-Kirchhoff (5), compressible neo-Hookean (6), or another",
    OF_BODIES,
)
YOUNG = real(7e6, 1e-6, 1e18, "Pa", "Young's modulus E", OF_BODIES)
NU = real(
    0.45,
    0,
    0.5,
    "-",
    "Poisson's ratio; the paper says only nu -> 0.5; 0.5: J = 1, of all laws but svk",
    OF_BODIES,
)
DENSITY = real(1722, 1e-15, 1e12, "kg/m3", "reference density", OF_BODIES)
DAMPING = ("viscosity", "bulk_viscosity", "relaxation_modulus", "relaxation_time")
# Largest nu in the speed of waves. The stiffness by a larger nu acts on the volume of elements.
STIFFEST = 0.45
# The entries of some laws beside young and nu. Those of ogden replace young.
LAW_ENTRIES = {"mooney-rivlin": ("share",), "ogden": ("alpha", "mu")}


class OfMaterial(Entries):
    """The entries of a material, which a body and the top of a scene may have, too."""

    law: Annotated[str | None, LAW] = None
    young: Annotated[float | None, YOUNG] = None
    nu: Annotated[float | None, NU] = None
    density: Annotated[float | None, DENSITY] = None
    share: Annotated[
        float | None, number(0.0, 1.0, "-", "mooney-rivlin: part of I2 in the shear modulus")
    ] = None
    alpha: Annotated[
        list[float] | None, Numbers(-30.0, 30.0, 3, "ogden: exponents of one to three terms")
    ] = None
    mu: Annotated[
        list[float] | None,
        Numbers(-1e18, 1e18, 3, "ogden: moduli of the terms [Pa], in place of young"),
    ] = None
    viscosity: Annotated[
        float | None,
        real(
            0,
            0,
            1e18,
            "Pa s",
            "viscosity eta of the material: beside the law's stress 2 eta D, D the rate of deformation",
            OF_BODIES,
        ),
    ] = None
    bulk_viscosity: Annotated[
        float | None,
        real(0, 0, 1e18, "Pa s", "viscosity zeta of volume: beside it zeta tr(D) I", OF_BODIES),
    ] = None
    relaxation_modulus: Annotated[
        float | None,
        real(
            0,
            0,
            1e18,
            "Pa",
            "shear modulus G of a Maxwell branch beside the law, which relaxes in relaxation_time; 0 "
            "= none",
            OF_BODIES,
        ),
    ] = None
    relaxation_time: Annotated[
        float | None,
        real(0, 0, 1e9, "s", "its time tau: G exp(-t/tau) is left of G after t", OF_BODIES),
    ] = None
    loss: Annotated[
        float | None,
        real(
            0,
            0,
            10,
            "-",
            "loss factor tan delta of shear at the first mode of the disc or ball: sets viscosity; 0 "
            "= by viscosity",
            OF_BODIES,
        ),
    ] = None

    @classmethod
    def refused(cls, name: str, value: Any, dimension: Dimension | None) -> str:
        if name == "law_parameters":
            return _no_more(name, value)
        return super().refused(name, value, dimension)


class Material(OfMaterial):
    """The material of a body; `law` is a constitutive law, and the classes below are the laws.

    The laws are in edp/program/law. The damping is of the Kelvin-Voigt type with `viscosity` and
    `bulk_viscosity` [Pa s], or with `loss`, the loss factor at the first mode. A Maxwell branch has
    `relaxation_modulus` [Pa] and `relaxation_time` [s].
    """

    law: Annotated[str, LAW]
    young: Annotated[float, YOUNG]
    nu: Annotated[float, NU]
    density: Annotated[float, DENSITY]

    @classmethod
    def names(cls, dimension: Dimension | None) -> list[str]:
        """The names of the entries, without those of other laws."""
        law = cls.model_fields["law"]
        others = set() if law.is_required() else {"share", "alpha", "mu"}
        others -= set(LAW_ENTRIES.get(law.default, ()))
        return [name for name in super().names(dimension) if name not in others]

    def refusals(self) -> Iterator[tuple[str, str]]:
        own, taken = type(self).model_fields["law"], LAW_ENTRIES.get(self.law, ())
        if not own.is_required() and self.law != own.default:
            other = LAWS[self.law].__name__ if self.law in LAWS else "Material"
            yield "law", f": '{self.law}' is another law (accepted: {other})"
            return
        for law, entries in LAW_ENTRIES.items():
            for entry in entries:
                if entry in self and entry not in taken:
                    yield entry, f": of law = {law}, not of {self.law} (accepted: without it)"
                if entry not in self and entry in taken:
                    accepted = "" if not (rule := rule_of(OfMaterial, entry)) else rule.accepted
                    yield entry, f": is missing, of law = {self.law} (accepted: {accepted})"
        if self.law == "incompressible" and self.nu != 0.5:
            yield "nu", f": {self.nu:g} of law = incompressible (accepted: 0.5)"
        elif 0.4999 < self.nu < 0.5:
            accepted = "0 to 0.4999, or 0.5: J = 1"
            yield "nu", f": {self.nu:g} is out of range (accepted: {accepted})"
        limit = self.nu / (1 - 2 * self.nu) if self.nu < 0.5 else np.inf  # lambda / (2 mu)
        if self.law == "mooney-rivlin" and (self.share or 0.0) > limit:
            yield (
                "share",
                f": {self.share:g} with a Poisson's ratio that is too small (accepted: to "
                f"lambda/(2 mu), {limit:g})",
            )
        if self.alpha and self.mu:
            yield from self._of_terms(self.alpha, self.mu)

    def _of_terms(self, alpha: list[float], mu: list[float]) -> Iterator[tuple[str, str]]:
        """Yields what the terms of ogden lack."""
        if len(alpha) != len(mu):
            yield "mu", f": '{brief(mu)}' beside {len(alpha)} of alpha (accepted: as many)"
            return
        for k, (exponent, modulus) in enumerate(zip(alpha, mu), 1):
            if exponent * modulus <= 0:
                yield (
                    f"mu.{k}",
                    f": {modulus:g} with the exponent {exponent:g} (accepted: an exponent other "
                    "than 0, and a modulus of its sign)",
                )
                return
        stiffness = self.stiffness_of_terms
        if self.young is not None and not np.isclose(self.young, stiffness, rtol=1e-6):
            yield (
                "young",
                f": {self.young:g} beside alpha and mu, which make it {stiffness:.9g} (accepted: "
                "without it)",
            )

    @property
    def stiffness_of_terms(self) -> float:
        """Young's modulus [Pa] of the terms of ogden: half the sum of mu alpha is the shear modulus."""
        return float((1 + self.nu) * np.dot(self.mu or [0.0], self.alpha or [0.0]))

    @property
    def numbers(self) -> list[float]:
        """The numbers of the law for the kernels (edp/kernels/laws.cpp): a share of the shear modulus,
        or each exponent with such a share.
        """
        if self.law != "ogden":
            return [self.share] if self.share is not None else []
        parts = np.multiply(self.mu or [], self.alpha or [])
        return np.column_stack([self.alpha or [], parts / parts.sum()]).ravel().tolist()

    @property
    def damped(self) -> bool:
        """Whether it has any damping."""
        return any((self.viscosity, self.bulk_viscosity, self.relaxation_modulus, self.loss))

    @property
    def damping(self) -> tuple[float, ...]:
        """The values of DAMPING."""
        return tuple(float(getattr(self, name) or 0.0) for name in DAMPING)

    def moduli(self, thickness: float) -> tuple[float, float]:
        """lambda + 2 mu and mu [Pa] in a wave across a body of this thickness [m]. Damping adds to
        them: they are absolute values at omega = pi / transit (stiffen() of
        edp/program/run/scales.idp).

        The part of lambda above nu = STIFFEST acts on the volume of elements and not in waves.
        """
        nu = min(self.nu, STIFFEST)
        mu, wave = self.young / (2 * (1 + nu)), self.young * (1 - nu) / ((1 + nu) * (1 - 2 * nu))
        if not self.damped:
            return wave, mu
        viscosity, bulk_viscosity, modulus, time = self.damping
        turn = 1j * math.pi * math.sqrt(wave / self.density) / thickness
        branch = modulus * turn / (1 / (time or 1) + turn)
        shear = abs(mu + turn * viscosity + branch)
        return abs(wave - 2 * mu + turn * bulk_viscosity) + 2 * shear, shear


class SaintVenantKirchhoff(Material):
    """St. Venant-Kirchhoff law, S = lambda tr(E) I + 2 mu E, paper (5)."""

    law: Annotated[str, LAW] = "svk"


class NeoHookean(Material):
    """Compressible neo-Hookean law, paper (6)."""

    law: Annotated[str, LAW] = "neohookean"


class Incompressible(Material):
    """Incompressible neo-Hookean law, J = 1."""

    law: Annotated[str, LAW] = "incompressible"
    nu: Annotated[float, NU] = 0.5


class MooneyRivlin(Material):
    """Mooney-Rivlin law, W = mu/2 ((1 - s) I1 + s I2) and terms of det F; s is the `share`."""

    law: Annotated[str, LAW] = "mooney-rivlin"


class Ogden(Material):
    """Ogden's law, W = sum of mu_k/alpha_k (l1^alpha_k + l2^alpha_k + l3^alpha_k - 3) and terms of
    det F, with one to three terms; `young` follows from them.
    """

    law: Annotated[str, LAW] = "ogden"
    young: Annotated[float | None, YOUNG] = None  # type: ignore[assignment]


LAWS: dict[str, type[Material]] = {
    model.model_fields["law"].default: model
    for model in (SaintVenantKirchhoff, NeoHookean, Incompressible, MooneyRivlin, Ogden)
}
MATERIAL = tuple(OfMaterial.model_fields)
NOT_RIGID = tuple(
    name for name in MATERIAL if name != "density"
)  # entries that a rigid body has not


# ---- conditions at the boundary of a body


class Support(Entries):
    """A part of a body's boundary that is held or moves with a given displacement."""

    where: Annotated[str | dict[str, Any], Where(SIDES)]
    fix: Annotated[
        str | None,
        Parameter("", "word", None, "", "what is held", words=("all", "x", "y", "z", "normal")),
    ] = None
    motion: Annotated[Timed | None, Function("displacement [m], a function of t for each axis")] = (
        None
    )
    release: Annotated[float | None, number(1e-12, LONGEST, "s", "time from which it is free")] = (
        None
    )


class Gas(Entries):
    """A gas in a closed cavity, with p V^n = const."""

    gauge_pressure: Annotated[
        float,
        number(
            -MOST_PRESSURE,
            MOST_PRESSURE,
            "Pa",
            "over the pressure outside, in equilibrium with the body at the start",
        ),
    ]
    exponent: Annotated[
        float | None, number(0.0, 10.0, "", "n of p V^n; 1: isothermal, 1.4: air")
    ] = None
    ambient_pressure: Annotated[
        float | None, number(0.0, MOST_PRESSURE, "Pa", "outside; an atmosphere where it is open")
    ] = None
    given_shape: Annotated[
        str | None,
        Parameter(
            "",
            "word",
            None,
            "",
            "of the body: unstressed (default), or inflated as at the start",
            words=("unstressed", "inflated"),
        ),
    ] = None


class Load(Entries):
    """A stress on a part of a body's boundary: one of `traction`, `pressure` and `gas`."""

    nested = {"gas": Gas}
    where: Annotated[str | dict[str, Any], Where(SIDES)]
    traction: Annotated[
        Timed | None, Function("per reference area [Pa], a function of t for each axis")
    ] = None
    pressure: Annotated[
        Timed | None, Function("follows the surface [Pa], a function of t", single=True)
    ] = None
    gas: Gas | None = None

    @property
    def kinds(self) -> list[str]:
        """Which stresses it has."""
        return [kind for kind in ("traction", "pressure", "gas") if kind in self]

    def refusals(self) -> Iterator[tuple[str, str]]:
        if len(self.kinds) != 1:
            has = " and ".join(self.kinds) or "no stress"
            yield "", f": has {has} (accepted: one of traction, pressure, gas)"


# ---- bodies

FIELDS = ("initial_velocity", "initial_displacement")  # entries that are functions of place


class Body(OfMaterial):
    """The entries of bodies of all shapes; the shapes are the classes below.

    `material` sets law, young, nu, density and damping together. A rigid body needs only a density
    or a mass.
    """

    shape: ClassVar[str]
    heading = ("shape",)
    dimensions: ClassVar[tuple[Dimension, ...]] = (PLANE_STRAIN,)
    nested = {"support": Support, "load": Load}
    only = {
        "mesh_stretch": (PLANE_STRAIN, AXISYMMETRIC),
        "angle": (PLANE_STRAIN, SOLID), "turn": (SOLID,), "spin": (PLANE_STRAIN, SOLID),
    }  # fmt: skip

    name: Annotated[str | None, Name("of its own")] = None
    position: Annotated[Components | None, Place("of the centre of mass [m]")]
    velocity: Annotated[Components | None, Place("of the centre of mass [m/s]")] = None
    mesh_size: Annotated[
        float | None, real(0, 0, 1e9, "m", "largest element size; 0 = by accuracy", OF_BODIES)
    ] = None
    contact_mesh_size: Annotated[
        float | None,
        real(0, 0, 1e9, "m", "element size at the contact boundary; 0 = from accuracy", OF_BODIES),
    ] = None
    mesh_stretch: Annotated[
        float | None,
        number(
            0.0,
            MOST_STRETCH,
            "",
            "length of the elements across the normal of the first contact over that along it, from"
            " 1; 0 = by accuracy where a face lands flat, else 1",
        ),
    ] = None
    support: Annotated[list[Support] | None, BeforeValidator(several)] = None
    load: Annotated[list[Load] | None, BeforeValidator(several)] = None
    rigid: Annotated[bool | None, Flag("moves without deforming")] = None
    mass: Annotated[
        float | None, number(1e-12, LONGEST, "", "of a rigid body [kg, in the plane kg/m]")
    ] = None
    inertia: Annotated[
        Components | None,
        InSpace(number(1e-18, LONGEST, ""), "of a rigid body [kg m2]", about_z=False),
    ] = None
    angle: Annotated[float | None, number(-MOST_TURN, MOST_TURN, "deg", "turned by, about z")] = (
        None
    )
    turn: Annotated[
        list[float] | None,
        Vector("turned about a vector of this length [degrees]", -MOST_TURN, MOST_TURN, 3),
    ] = None
    speed: Annotated[
        float | None, real(0, 0, 1e9, "m/s", "in place of velocity, with direction", OF_BODIES)
    ] = None
    direction: Annotated[
        float | None,
        number(
            -MOST_TURN, MOST_TURN, "deg", "of the speed, in the plane of x and y, from the x axis"
        ),
    ] = None
    spin: Annotated[
        Components | None,
        InSpace(
            real(0, -1e12, 1e12, "rad/s", "spin at the start, counter-clockwise", OF_BODIES),
            "angular velocity [rad/s]; in space a vector",
        ),
    ] = None
    initial_velocity: Annotated[
        Placed | None, OfPlace("of the points of the body [m/s], on top of velocity and spin")
    ] = None
    initial_displacement: Annotated[
        Placed | None, OfPlace("of the points of the body [m], which deforms it")
    ] = None

    @model_validator(mode="before")
    @classmethod
    def _of_material(cls, entries: Any) -> Any:
        """Replaces the entry `material` by the entries of the material; entries of the body win."""
        if not isinstance(entries, dict):
            return entries
        if not isinstance(entries.get("material"), Material | None):
            text = brief(entries["material"])
            raise BadInput(
                f"material: '{text}' is no material (accepted: NeoHookean(young=..., nu=..., density=...), say)"
            )
        own = {name: value for name, value in entries.items() if name != "material"}
        return (entries["material"].table() if "material" in entries else {}) | own

    def refusals(self) -> Iterator[tuple[str, str]]:
        if self.velocity is not None and (self.speed is not None or self.direction is not None):
            yield (
                "velocity",
                f": '{self.value_text('velocity')}' stands beside speed or direction (accepted: "
                "velocity, or speed with direction)",
            )
        elif (self.speed is None) != (self.direction is None):
            accepted = "speed [m/s] with direction [deg], counter-clockwise from x"
            missing = "direction" if self.direction is None else "speed"
            yield missing, f": is missing (accepted: {accepted})"
        if 0 < (stretch := self.mesh_stretch or 0.0) < 1:
            accepted = f"0, or from 1 to {MOST_STRETCH:g}"
            yield "mesh_stretch", f": {stretch:g} is below 1 (accepted: {accepted})"
        if self.angle is not None and self.turn is not None:
            accepted = "angle about z, or turn = [x, y, z]"
            yield (
                "angle",
                f": '{self.value_text('angle')}' stands beside turn (accepted: {accepted})",
            )
        if not self.rigid:
            for name in [name for name in ("mass", "inertia") if name in self][:1]:
                yield name, ": is of a rigid body (accepted: with rigid = true, or density)"
            return
        for name in [name for name in (*NOT_RIGID, "support", *FIELDS) if name in self][:1]:
            accepted = "density, or mass; without rigid = true"
            yield name, f": a rigid body has none (accepted: {accepted})"
        if "mass" in self and "density" in self:
            yield "mass", ": stands beside density (accepted: one of them)"

    @property
    def material(self) -> Material | None:
        """The body's own material; None unless law, young, nu and density are all set."""
        own = {name: getattr(self, name) for name in MATERIAL if name in self}
        law = LAWS.get(own.get("law", ""), Material)
        needed = {name for name in MATERIAL if law.model_fields[name].is_required()}
        return law(**own) if needed | {"law", "nu"} <= set(own) else None

    @property
    def sizes(self) -> list[Any]:
        """The values of the shape's own entries, in the order of the model."""
        return [
            getattr(self, name) for name in type(self).model_fields if name not in Body.model_fields
        ]

    def table(self) -> dict[str, Any]:
        """The table `[[body]]`."""
        return {"shape": self.shape} | super().table()


class Drawn(Body):
    """A body whose shape is drawn: by vertices or in a file, with an origin of its own."""

    position: Annotated[
        Components | None,
        Place("of the centre of mass, or with placement = 'as-drawn' of the origin [m]"),
    ] = None
    placement: Annotated[
        str | None, Parameter("", "word", None, "-", "what `position` places", words=PLACEMENTS)
    ] = None

    @property
    def is_placed_as_drawn(self) -> bool:
        """Whether `position` is that of the drawing's origin."""
        return self.placement == "as-drawn"

    def refusals(self) -> Iterator[tuple[str, str]]:
        yield from super().refusals()
        if self.position is None and not self.is_placed_as_drawn:
            accepted = "that of the centre of mass, or placement = 'as-drawn'"
            yield "position", f": is missing (accepted: {accepted})"


class Hollow(Body):
    """The entries of a body with a wall."""

    radius: Annotated[float, number(meaning="outer radius")]
    inner_radius: Annotated[float, number(meaning="inner radius")]

    def refusals(self) -> Iterator[tuple[str, str]]:
        yield from super().refusals()
        if self.inner_radius >= self.radius:
            inner, outer = self.inner_radius, self.radius
            yield "inner_radius", f": {inner:g} is not less than the radius {outer:g}"


class Disc(Body):
    """A disc in plane strain."""

    shape = "disc"
    radius: Annotated[float, number(meaning="radius")]


class Ellipse(Body):
    """An ellipse in plane strain."""

    shape = "ellipse"
    semi_axes: Annotated[
        list[float], Vector("half its width and half its height [m]", 1e-9, count=2)
    ]


class Rectangle(Body):
    """A rectangle in plane strain."""

    shape = "rectangle"
    width: Annotated[float, number(meaning="width")]
    height: Annotated[float, number(meaning="height")]


class Ring(Hollow):
    """A ring in plane strain."""

    shape = "ring"


class Polygon(Drawn):
    """A polygon in plane strain, or the section of a body of revolution.

    The section leads from the axis to the axis, or lies beside the axis.
    """

    shape = "polygon"
    dimensions = (PLANE_STRAIN, AXISYMMETRIC)
    only = Drawn.only | {"holes": (PLANE_STRAIN,)}
    vertices: Annotated[list[list[float]], Points(3, "corners [m], each once, in order")]
    holes: Annotated[list[list[list[float]]] | None, Polygons("holes in it")] = None


class Ball(Body):
    """A ball, as a body of revolution or in space."""

    shape = "ball"
    dimensions = (AXISYMMETRIC, SOLID)
    radius: Annotated[float, number(meaning="radius")]


class Shell(Hollow):
    """A hollow ball, of revolution or in space."""

    shape = "shell"
    dimensions = (AXISYMMETRIC, SOLID)


class Ellipsoid(Body):
    """An ellipsoid of revolution, with a radius and half a height."""

    shape = "ellipsoid"
    dimensions = (AXISYMMETRIC,)
    semi_axes: Annotated[list[float], Vector("radius and half the height [m]", 1e-9, count=2)]


class Cylinder(Body):
    """A cylinder about the y axis, as a body of revolution or in space."""

    shape = "cylinder"
    dimensions = (AXISYMMETRIC, SOLID)
    radius: Annotated[float, number(meaning="radius")]
    height: Annotated[float, number(meaning="height")]


class Tube(Hollow):
    """A tube about the y axis, of revolution or in space."""

    shape = "tube"
    dimensions = (AXISYMMETRIC, SOLID)
    height: Annotated[float, number(meaning="height")]


class Torus(Body):
    """A torus (O-ring) of revolution; `section` is the radius of its circular section."""

    shape = "torus"
    dimensions = (AXISYMMETRIC,)
    radius: Annotated[float, number(meaning="from the axis to the middle of the section")]
    section: Annotated[float, number(meaning="radius of the section")]

    def refusals(self) -> Iterator[tuple[str, str]]:
        yield from super().refusals()
        if self.section >= self.radius:
            accepted = f"below radius, {self.radius:g} m"
            yield "section", f": {self.section:g} m reaches the axis (accepted: {accepted})"


class Box(Body):
    """A box in space."""

    shape = "box"
    dimensions = (SOLID,)
    width: Annotated[float, number(meaning="along x")]
    height: Annotated[float, number(meaning="along y")]
    depth: Annotated[float, number(meaning="along z")]


class Mesh(Drawn):
    """A body from a mesh or a CAD file, or from arrays: `points`, `cells` and `labels`.

    The arrays may be those of numpy or meshio. Messages about them count vertices from 1.
    """

    shape = "mesh"
    dimensions = (PLANE_STRAIN, AXISYMMETRIC, SOLID)
    file: Annotated[str | None, Text("path, from the folder of the scene on")] = None
    points: Annotated[
        list[list[float]] | None,
        Rows((2, 3), "points of a mesh, in place of a file"),
        Field(repr=False),
    ] = None
    cells: Annotated[
        list[list[int]] | None,
        Rows((3, 4), "corners of its triangles or tetrahedra, as numbers of points", True),
        Field(repr=False),
    ] = None
    labels: Annotated[
        dict[str, list[list[int]]] | None,
        Parts(
            Rows((2, 3), whole=True),
            "parts of its boundary, for `where`; 'contact' may come into contact (without it all), "
            "'symmetry' is on the axis of revolution",
        ),
        Field(repr=False),
    ] = None
    scale: Annotated[
        float | None,
        number(1e-9, 1e9, "m", "a unit of length of the file or points; STEP declares its own"),
    ] = None

    def refusals(self) -> Iterator[tuple[str, str]]:
        yield from super().refusals()
        arrays = [name for name in ("points", "cells", "labels") if name in self]
        missing = [name for name in ("points", "cells") if arrays and name not in self]
        if arrays and self.file is not None:
            accepted = "a file, or points and cells"
            yield "file", f": stands beside {arrays[0]} (accepted: {accepted})"
        elif missing:
            yield missing[0], ": is missing (accepted: points and cells, or a file)"


BODIES: dict[str, type[Body]] = {
    model.shape: model
    for model in (
        Disc,
        Ellipse,
        Rectangle,
        Ring,
        Ball,
        Shell,
        Ellipsoid,
        Box,
        Cylinder,
        Polygon,
        Tube,
        Torus,
        Mesh,
    )
}


# ---- rigid obstacles


class OfContact(Entries):
    """The entries of contact that a pair and an obstacle may have of their own."""

    penalty: Annotated[
        float | str | None,
        real(
            "auto",
            1e-12,
            1e100,
            "Pa/m^m",
            "contact stiffness k of (10); auto = stiff beside the body, from young, the width of the "
            "contact and the exponent",
        ),
    ] = None
    friction_static: Annotated[
        float | None,
        real(
            0,
            0,
            10,
            "-",
            "static coefficient mu_e of (12), for |v_T| < slip_velocity; at least friction_dynamic",
        ),
    ] = None
    friction_dynamic: Annotated[
        float | str | None,
        real("auto", 0, 10, "-", "dynamic coefficient mu_d of (12); auto = friction_static"),
    ] = None

    default_static: ClassVar[float | None] = None  # friction_static; None: that of the scene

    def refusals(self) -> Iterator[tuple[str, str]]:
        static, dynamic = self.friction_static, self.friction_dynamic
        if static is None:
            static = self.default_static
        if static is not None and isinstance(dynamic, float) and dynamic > static:
            yield (
                "friction_dynamic",
                f": {dynamic:g} is larger than friction_static {static:g} (accepted: 0 to "
                "friction_static)",
            )

    @classmethod
    def refused(cls, name: str, value: Any, dimension: Dimension | None) -> str:
        return _of_all(name, value) or super().refused(name, value, dimension)


OWN = tuple(OfContact.model_fields)


class Obstacle(OfContact):
    """The entries of rigid obstacles of all kinds; the kinds are the classes below."""

    kind: ClassVar[str]
    heading = ("kind",)
    dimensions: ClassVar[tuple[Dimension, ...]] = (PLANE_STRAIN, AXISYMMETRIC, SOLID)
    name: Annotated[str | None, Name("of its own")] = None
    velocity: Annotated[Components | None, Place("[m/s]")] = None
    motion: Annotated[Timed | None, Function("displacement [m], a function of t for each axis")] = (
        None
    )
    rotation: Annotated[
        Timed | None, Function("turned by [degrees], a function of t", single=True)
    ] = None
    pivot: Annotated[list[float] | None, Vector("what it turns about [m]")] = None
    axis: Annotated[
        list[float] | None, Vector("in space, the direction that it turns about", count=3)
    ] = None

    def refusals(self) -> Iterator[tuple[str, str]]:
        yield from super().refusals()
        for name in ("pivot", "axis"):
            if name in self and self.rotation is None:
                yield name, ": stands without rotation (accepted: with it)"
        if self.velocity is not None and any(name in self for name in ("motion", "rotation")):
            yield "velocity", ": stands beside motion or rotation (accepted: one of them)"
        if self.axis is not None and not any(self.axis):
            text = self.value_text("axis")
            yield "axis", f": '{text}' has no direction (accepted: other than 0)"

    def table(self) -> dict[str, Any]:
        """The table `[[obstacle]]`."""
        return {"kind": self.kind} | super().table()


class Plane(Obstacle):
    """The half-space below a plane, by default the floor y = 0."""

    kind = "plane"
    point: Annotated[list[float] | None, Vector("on it [m]; default 0")] = None
    normal: Annotated[list[float] | None, Vector("out of it; default along y")] = None


class Circle(Obstacle):
    """A solid disc in the plane."""

    kind = "circle"
    dimensions = (PLANE_STRAIN,)
    centre: Annotated[Components, Place("[m]")]
    radius: Annotated[float, number(meaning="radius")]


class Bowl(Obstacle):
    """A concave obstacle: the solid outside a circle or sphere."""

    kind = "bowl"
    centre: Annotated[Components, Place("[m]")]
    radius: Annotated[float, number(meaning="radius")]


class Sphere(Obstacle):
    """A solid ball, of revolution or in space."""

    kind = "sphere"
    dimensions = (AXISYMMETRIC, SOLID)
    centre: Annotated[Components, Place("[m]")]
    radius: Annotated[float, number(meaning="radius")]


class Polyline(Obstacle):
    """A chain of straight walls, solid to the right of its direction."""

    kind = "polyline"
    dimensions = (PLANE_STRAIN, AXISYMMETRIC)
    only = {"closed": (PLANE_STRAIN,)}
    vertices: Annotated[list[list[float]], Points(2, "corners [m]")]
    closed: Annotated[bool | None, Flag("whether the last joins the first")] = None
    rounding: Annotated[
        float | None,
        number(0.0, LONGEST, "m", "of convex corners; sides lie as far outside the vertices"),
    ] = None
    fillet: Annotated[
        float | None,
        number(0.0, LONGEST, "m", "radius that cuts convex corners; sides stay on the vertices"),
    ] = None

    def refusals(self) -> Iterator[tuple[str, str]]:
        yield from super().refusals()
        if self.rounding and self.fillet:
            yield "rounding", f": {self.rounding:g} m beside fillet (accepted: one of them)"


class Surface(Obstacle):
    """A closed surface in space from an STL file or a mesh."""

    kind = "surface"
    dimensions = (SOLID,)
    file: Annotated[
        str, Text("path, from the folder of the scene on", "the path of an STL file or a mesh")
    ]
    scale: Annotated[float | None, number(1e-9, 1e9, "m", "a unit of length of the file")] = None
    position: Annotated[list[float] | None, Vector("of the file's origin [m]", count=3)] = None
    turn: Annotated[
        list[float] | None,
        Vector("about a vector of this length [degrees]", -MOST_TURN, MOST_TURN, 3),
    ] = None
    rounding: Annotated[
        float | None, number(0.0, LONGEST, "m", "how far it reaches out of the file's triangles")
    ] = None


class Implicit(Obstacle):
    """A surface given by an expression in x, y (, z) for the signed distance, positive outside."""

    kind = "implicit"
    distance: Annotated[
        Timed, Function("expression in x, y (, z) of the signed distance [m]", single=True)
    ]


OBSTACLES: dict[str, type[Obstacle]] = {
    model.kind: model for model in (Plane, Circle, Sphere, Bowl, Polyline, Surface, Implicit)
}


# ---- contact


class Pair(OfContact):
    """The entries of one contact pair, a body and an obstacle or two bodies, given by their names.

    They replace the entries of the whole scene.
    """

    bodies: Annotated[Sequence[str] | None, Partners("two names")] = None


class Contact(OfContact):
    """Contact and friction of the whole scene, paper (10) to (13)."""

    nested = {"pair": Pair}
    default_static = 0.0
    exponent: Annotated[float | None, real(1, 1, 4, "-", "contact exponent m of (10)")] = None
    slip_velocity: Annotated[
        float | str | None,
        real(
            "auto",
            1e-15,
            1e9,
            "m/s",
            "epsilon of (12) and (13); auto = a hundredth of the speeds of the scene",
        ),
    ] = None
    regularization: Annotated[
        str | None,
        word(
            "linear",
            ("linear", "linear-printed", "sqrt", "tanh"),
            "phi of (13); linear-printed as the paper prints it; sqrt and tanh stay below mu_e for "
            "|v_T| < slip_velocity",
        ),
    ] = None
    friction_transition: Annotated[
        str | None,
        word(
            "jump",
            ("jump", "smooth"),
            "from static to dynamic: the paper's jump at slip_velocity, or a half cosine up to twice "
            "that (resolve it: dt (mu_e - mu_d) times the deceleration below slip_velocity)",
        ),
    ] = None
    penalty_damping: Annotated[
        float | None,
        real(
            0,
            0,
            1e9,
            "s",
            "retardation time tau of the penalty: a closing contact takes t_N + tau dt_N/dt instead of "
            "t_N of (10), never below 0; 0 = none. It takes energy (penalty_damping_work)",
        ),
    ] = None
    self_contact: Annotated[
        str | None,
        Parameter(
            "",
            "word",
            None,
            "-",
            "whether bodies may come into contact with themselves",
            words=("auto", "on", "off"),
        ),
    ] = None
    pair: Annotated[list[Pair] | None, BeforeValidator(several)] = None

    @classmethod
    def refused(cls, name: str, value: Any, dimension: Dimension | None) -> str:
        if name.startswith("pairing"):
            return _no_more(name, value)
        return super().refused(name, value, dimension)


CONTACT = tuple(name for name in Contact.model_fields if name not in ("self_contact", "pair"))


def _of_all(name: str, value: Any) -> str:
    """The message about an entry that belongs to the contact of the whole scene; else empty."""
    if name not in CONTACT:
        return ""
    return f": '{brief(value)}' holds for the whole scene (accepted: in [contact]; here {', '.join(OWN)})"


# ---- the top of a scene

# Former entries and what has taken their place.
FORMER = {
    "law_parameters": "share of mooney-rivlin, alpha and mu of ogden",
    "angle": "body.1.direction, the angle from the x axis: -60 for an impact at 60 degrees",
    "height": "body.1.position, that of the centre of mass",
    "block_width": "body.2.width",
    "block_height": "body.2.height",
    "pairing": "closest points, of all scenes; pairs of points are in edp/disc-block.edp",
    "pairing_range": "the flag -pairing_range of edp/disc-block.edp",
}


def _no_more(name: str, value: Any) -> str:
    """The message about a former entry, behind its name."""
    return f": '{brief(value)}' is no entry any more (accepted: {FORMER[name]})"


class Top(OfMaterial):
    """The entries at the top of a scene.

    They control the run, and set the material and mesh sizes of bodies without their own.
    """

    title: Annotated[str | None, Text("a line about it")] = None
    script: Annotated[str | None, Text("script of edp/")] = None
    dimension: Annotated[
        str | None,
        Parameter("", "word", None, "-", "what it is computed in", words=tuple(DIMENSIONS)),
    ] = None
    symmetry: Annotated[
        str | None,
        Parameter(
            "",
            "word",
            None,
            "-",
            "the part that is computed: in the plane the half x >= 0, in space the half z >= 0, or of "
            "that the half x >= 0; auto = the least that represents the scene",
            words=("auto", "full", "half", "quarter"),
        ),
    ] = None
    only = {"symmetry": (PLANE_STRAIN, SOLID)}
    mesh_size: Annotated[
        float | None, real(0, 0, 1e9, "m", "element size in the bulk; 0 = from accuracy", OF_BODIES)
    ] = None
    contact_mesh_size: Annotated[
        float | None,
        real(0, 0, 1e9, "m", "element size at the contact boundary; 0 = from accuracy", OF_BODIES),
    ] = None
    gravity: Annotated[
        float | None,
        real(
            0, 0, 1e12, "m/s2", "gravity, along -y; another direction: body_force_x, body_force_y"
        ),
    ] = None
    body_force_x: Annotated[
        float | None,
        real(
            0,
            -1e12,
            1e12,
            "m/s2",
            "constant body force b of (1), along the plane",
            ("bodies", "bodies-3d"),
        ),
    ] = None
    body_force_y: Annotated[
        float | None,
        real(
            0,
            -1e12,
            1e12,
            "m/s2",
            "constant body force b of (1), away from the plane; gravity comes on top",
        ),
    ] = None
    volume: Annotated[
        str | None,
        word(
            "auto",
            ("plain", "projected", "auto"),
            "resistance to change of volume: plain = at points, which locks as nu -> 0.5; projected ="
            " what is beyond that of nu = 0.45 in the mean of each element; auto = projected, where "
            "degree=1 plain",
        ),
    ] = None
    degree: Annotated[
        int | None, integer(2, 1, 2, "-", "polynomial degree of the displacement")
    ] = None
    integrator: Annotated[
        str | None,
        word(
            "energy-momentum",
            ("energy-momentum", "midpoint", "backward-euler", "bdf2", "central-difference", "auto"),
            "time integrator; central-difference: explicit, in substeps that resolve the waves in "
            "the bodies, contact and friction solved in each; auto: central-difference or "
            "energy-momentum, whichever is cheaper by the estimated number of operations",
        ),
    ] = None
    dt: Annotated[float | None, real(0, 0, 1e9, "s", "time step; 0 = adaptive")] = None
    accuracy: Annotated[
        float | None,
        real(
            0.005,
            1e-5,
            0.4,
            "-",
            "requested relative accuracy: of impulse and thresholded contact time relative to themselves, "
            "rebound velocities and spin relative to the speed, energies and friction work to the largest "
            "energy; mesh and step that are not given follow from it",
        ),
    ] = None
    accuracy_of: Annotated[
        str | None,
        word(
            "promised",
            ("promised", "friction_work", "peak_force", "contact_time"),
            "one more number to which the accuracy applies, relative to itself: it costs more"
            " because these numbers scatter more",
        ),
    ] = None
    tolerance: Annotated[
        float | None,
        real(
            5e-12,
            1e-15,
            0.0001,
            "-",
            "largest work of the residual in a step, over the energy at the start",
        ),
    ] = None
    breakdown: Annotated[
        str | None,
        word(
            "stop",
            ("stop", "continue"),
            "what a run does under svk when det F <= 0 or a point loses four fifths of its volume in "
            "the smallest step",
        ),
    ] = None
    chatter: Annotated[
        str | None,
        word(
            "stop",
            ("stop", "continue"),
            "what a run does when the body leaves the obstacle and is back within a transit of its "
            "waves twenty times in a row",
        ),
    ] = None
    end_time: Annotated[
        float | None,
        real(
            0,
            0,
            1e9,
            "s",
            "end of the run; 0 = until the first impact is over, with the contacts that follow it at "
            "once",
        ),
    ] = None
    start: Annotated[
        str | None,
        word(
            "given",
            ("given", "equilibrium"),
            "the bodies at t = 0: as given, or at rest in equilibrium under body force, loads, gas and "
            "contact, reached from the given shape and place by slow loading",
        ),
    ] = None
    until: Annotated[
        str | None,
        word(
            "impact",
            ("impact", "rest"),
            "what ends the run, at end_time at the latest: the end of the impact, or under gravity, "
            "with viscosity or friction, that all rests",
        ),
    ] = None
    fields: Annotated[int | None, integer(0, 0, 10000, "-", "number of field snapshots (VTU)")] = (
        None
    )
    modes: Annotated[
        int | None,
        integer(
            0,
            0,
            500,
            "-",
            "number of natural modes of the free bodies, with their energies at the end of the run; 0"
            " = none",
        ),
    ] = None
    checkpoint_every: Annotated[
        int | None,
        integer(
            0,
            0,
            1000000000,
            "steps",
            "a checkpoint every so many steps, from which a killed run goes on; 0 = none; the answer "
            "stays the same",
        ),
    ] = None
    without: Annotated[
        str | None,
        word(
            "none",
            ("none", "flight", "friction", "body-force", "frozen-factorisation", "contact-culling"),
            "leave out one saving, to measure what it saves",
        ),
    ] = None

    @classmethod
    def refused(cls, name: str, value: Any, dimension: Dimension | None) -> str:
        """The message about an unknown entry, with the table that has this entry, if any."""
        if name in FORMER:
            return _no_more(name, value)
        of_bodies = {entry for model in BODIES.values() for entry in model.names(dimension)}
        meant = (
            f"body.1.{name}" if name in of_bodies else f"contact.{name}" if name in CONTACT else ""
        )
        accepted = [*cls.names(dimension), "body", "obstacle", "contact"]
        if not meant and not suggestion(name, accepted):
            meant = _nearest(name, of_bodies, CONTACT)
        return _no_such(name, value, accepted, meant)


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


def read(content: dict[str, Any], dimension: Dimension) -> Tables:
    """The tables of a scene; raises BadInput with a line for each error in any of them."""
    top = {name: value for name, value in content.items() if name not in (*KINDS, "contact")}
    read_top, bodies, obstacles, contact = gathered((
        lambda: Top.read("", top, dimension), lambda: tables(content, "body", dimension),
        lambda: tables(content, "obstacle", dimension),
        lambda: Contact.read("contact", content.get("contact", {}), dimension)))  # fmt: skip
    return Tables(read_top, bodies, obstacles, contact)


def tables(content: dict[str, Any], key: str, dimension: Dimension) -> list[Any]:
    """The bodies or obstacles of a scene's tables `[[key]]`."""
    listed_ones = enumerate(listed(content, key), 1)
    return gathered(
        [partial(of_table, f"{key}.{k}", table, key, dimension) for k, table in listed_ones]
    )


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
    return models[name].read(entry, own, dimension)


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
