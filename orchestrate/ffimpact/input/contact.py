"""Contact and friction: of the whole scene, and of contact pairs. Units are SI."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import BeforeValidator, PrivateAttr

from ..failure import brief
from ..geometry import implicit
from .dimension import Dimension
from .entries import Entries, no_more, several
from .parameter import Parameter, Value, real, word
from .rules import Expression, Partners

__all__ = ["CONTACT", "Contact", "OWN", "OfContact", "Pair"]


class OfContact(Entries):
    """The entries of contact that a pair and an obstacle may have of their own."""

    penalty: Annotated[
        float | str | None,
        real("auto", 1e-12, 1e100, "Pa/m^m"),
        "contact stiffness k of (10); auto = stiff beside the body, from young, the width of the "
        "contact and the exponent",
    ] = None
    friction_static: Annotated[
        float | None,
        real(0, 0, 10, "-"),
        "static coefficient mu_e of (12), for |v_T| < slip_velocity; at least friction_dynamic",
    ] = None
    friction_dynamic: Annotated[
        float | str | None,
        real("auto", 0, 10, "-"),
        "dynamic coefficient mu_d of (12); auto = friction_static",
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

    @property
    def own(self) -> dict[str, Value]:
        """The entries that are set, of those that a pair may have."""
        return {name: getattr(self, name) for name in OWN if name in self}


OWN = tuple(OfContact.model_fields)


class Pair(OfContact):
    """The entries of one contact pair, a body and an obstacle or two bodies, given by their names.

    They replace the entries of the whole scene.
    """

    bodies: Annotated[Sequence[str] | None, Partners(), "two names"] = None
    _surfaces: tuple[int, int] = PrivateAttr((0, 0))

    @classmethod
    def between(cls, first: int, second: int, entry: str, own: dict[str, Any]) -> Pair:
        """The pair of two surfaces with entries of its own, which the table `entry` sets."""
        pair = cls.model_construct(**own)
        pair._surfaces, pair._entry = (first, second), entry
        return pair

    @property
    def first(self) -> int:
        """The index of its body, from 0."""
        return self._surfaces[0]

    @property
    def second(self) -> int:
        """The index of its other body, or -1 - k for obstacle k."""
        return self._surfaces[1]


class Contact(OfContact):
    """Contact and friction of the whole scene, paper (10) to (13)."""

    nested = {"pair": Pair}
    default_static = 0.0
    friction: Annotated[
        float | str | None,
        Expression(),
        "mu_f of (12), in place of both coefficients: a number, or an expression of the slip "
        "velocity v [m/s] and the pressure p [Pa] such as '0.3 + 0.4*exp(-v/0.05)'",
    ] = None
    exponent: Annotated[float | None, real(1, 1, 4, "-"), "contact exponent m of (10)"] = None
    slip_velocity: Annotated[
        float | str | None,
        real("auto", 1e-15, 1e9, "m/s"),
        "epsilon of (12) and (13); auto = a hundredth of the speeds of the scene",
    ] = None
    regularization: Annotated[
        str | None,
        word("linear", ("linear", "linear-printed", "sqrt", "tanh")),
        "phi of (13); linear-printed as the paper prints it; sqrt and tanh stay below mu_e for "
        "|v_T| < slip_velocity",
    ] = None
    friction_transition: Annotated[
        str | None,
        word("jump", ("jump", "smooth")),
        "from static to dynamic: the paper's jump at slip_velocity, or a half cosine up to twice "
        "that (resolve it: dt (mu_e - mu_d) times the deceleration below slip_velocity)",
    ] = None
    penalty_damping: Annotated[
        float | None,
        real(0, 0, 1e9, "s"),
        "retardation time tau of the penalty: a closing contact takes t_N + tau dt_N/dt instead of "
        "t_N of (10), never below 0; 0 = none. It takes energy (penalty_damping_work)",
    ] = None
    adhesion: Annotated[
        float | None,
        real(0, 0, 1e9, "J/m2"),
        "energy w of adhesion: surfaces within adhesion_range of each other attract each other, "
        "and to part them takes w",
    ] = None
    adhesion_range: Annotated[
        float | None,
        real(0, 0, 1.0, "m"),
        "gap from which on adhesion acts; the largest traction is 1.5 adhesion/adhesion_range",
    ] = None
    self_contact: Annotated[
        str | None,
        Parameter("", "word", None, "-", words=("auto", "on", "off")),
        "whether bodies may come into contact with themselves",
    ] = None
    pair: Annotated[list[Pair] | None, BeforeValidator(several)] = None

    def refusals(self) -> Iterator[tuple[str, str]]:
        yield from super().refusals()
        for name, other in (("adhesion", "adhesion_range"), ("adhesion_range", "adhesion")):
            if getattr(self, name) and not getattr(self, other):
                yield other, f": is missing, beside {name} (accepted: more than 0)"
        if self.adhesion and self.friction:
            yield "friction", ": beside adhesion (accepted: one of the two)"
        if self.friction is None:
            return
        for name in ("friction_static", "friction_dynamic"):
            if name in self:
                yield name, ": beside friction (accepted: one of the two)"
        if self.regularization == "linear-printed":
            yield (
                "regularization",
                ": 'linear-printed' beside friction (accepted: linear|sqrt|tanh)",
            )

    @property
    def friction_code(self) -> tuple[float, ...]:
        """The expression `friction` of v and p as the kernels evaluate it; empty without one."""
        if self.friction is None:
            return ()
        return implicit.program(self.at("friction"), self.friction, "vp")

    def friction_at(self, v: np.ndarray, p: np.ndarray) -> np.ndarray:
        """mu_f (n,) of the expression at slip velocities [m/s] (n,) and pressures [Pa] (n,)."""
        with np.errstate(all="ignore"):
            return implicit.run(self.friction_code, np.column_stack([v, p]))[0]

    @classmethod
    def refused(cls, name: str, value: Any, dimension: Dimension | None) -> str:
        if name.startswith("pairing"):
            return no_more(name, value)
        return super().refused(name, value, dimension)


CONTACT = tuple(
    name for name in Contact.model_fields if name not in ("self_contact", "pair", "friction")
)


def _of_all(name: str, value: Any) -> str:
    """The message about an entry that belongs to the contact of the whole scene; else empty."""
    if name not in (*CONTACT, "friction"):
        return ""
    return f": '{brief(value)}' holds for the whole scene (accepted: in [contact]; here {', '.join(OWN)})"
