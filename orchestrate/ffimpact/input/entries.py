"""The base of all tables of a scene: pydantic models whose errors are BadInput, one line each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from inspect import Parameter as Keyword, Signature
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self

from pydantic import (
    BaseModel,
    ConfigDict,
    ModelWrapValidatorHandler,
    PrivateAttr,
    ValidationError,
    model_serializer,
    model_validator,
)
from pydantic.fields import FieldInfo
from pydantic_core import PydanticCustomError

from ..failure import BadInput, brief, printable, suggestion
from .dimension import Dimension
from .parameter import Rule, plain

__all__ = ["Context", "Entries", "FORMER", "no_more", "no_such", "rule_of", "several"]

if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
else:
    ModelMetaclass = type(BaseModel)

# Former entries and what has taken their place.
FORMER = {
    "law_parameters": "share of mooney-rivlin, alpha and mu of ogden",
    "relaxation_modulus": "branches = [[G, tau]], the modulus in Pa and the time in s",
    "relaxation_time": "branches = [[G, tau]], the modulus in Pa and the time in s",
    "angle": "body.1.direction, the angle from the x axis: -60 for an impact at 60 degrees",
    "height": "body.1.position, that of the centre of mass",
    "block_width": "body.2.width",
    "block_height": "body.2.height",
    "pairing": "closest points, of all scenes; pairs of points are in edp/disc-block.edp",
    "pairing_range": "the flag -pairing_range of edp/disc-block.edp",
}


@dataclass(frozen=True)
class Context:
    """What a table takes from its scene: the dimension, the folder from which files are sought, the
    end_time [s] up to which functions of time are used, and the entries at the top.
    """

    dimension: Dimension
    folder: Path = Path()
    end_time: float = 0.0
    top: Entries | None = None


class _Made(ModelMetaclass):
    """The metaclass of models: Python constructors raise BadInput and ignore entries that are None.

    BadInput replaces pydantic's ValidationError.
    """

    def __call__(cls, *unnamed: Any, **entries: Any) -> Any:
        model: Any = cls  # a subclass of Entries
        entries = model.named(unnamed, entries)
        singular = {f"{name}s": name for name in model.nested}  # supports=[...] is support=[...]
        set_entries = {
            singular.get(name, name): plain(value)
            for name, value in entries.items()
            if value is not None
        }
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
        keywords[1:1] = [
            Keyword(name, Keyword.KEYWORD_ONLY, default=None, annotation=text)
            for name, text in model.aliases.items()
        ]
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
    aliases: ClassVar[dict[str, str]] = {}  # keywords that set several entries, with their meaning
    _entry: str = PrivateAttr("")  # the name of the table in the scene: body.2
    _given: dict[str, Any] = PrivateAttr(default_factory=dict)
    _context: Context | None = PrivateAttr(None)

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
        self.forget_derived()

    def forget_derived(self) -> None:
        """Removes the values of cached properties, which follow from the entries."""
        for name in self.__dict__.keys() - type(self).model_fields.keys():
            del self.__dict__[name]

    @classmethod
    def __pydantic_init_subclass__(cls, **keywords: Any) -> None:
        """Gives rules the meanings that stand behind them."""
        for field in cls.model_fields.values():
            texts = [item for item in field.metadata if isinstance(item, str)]
            rules = [item for item in field.metadata if not isinstance(item, str)]
            if texts:
                field.metadata = [rules[0].means(*texts), *rules[1:]]

    @classmethod
    def named(cls, unnamed: tuple[Any, ...], entries: dict[str, Any]) -> dict[str, Any]:
        """The entries by name of a call in Python. Raises BadInput for arguments without a name."""
        if unnamed:
            accepted = ", ".join(cls.__signature__.parameters)
            raise BadInput(
                f"{cls.__name__}: '{brief(unnamed[0])}' has no name (accepted: entries by name: {accepted})"
            )
        return entries

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
            (name, value) for name, value in self.entries() if type(self).model_fields[name].repr
        ]

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and self.table() == other.table()

    def __contains__(self, name: str) -> bool:
        return getattr(self, name, None) is not None

    def entries(self) -> Iterator[tuple[str, Any]]:
        """Yields the entries that are set with their values."""
        for name in type(self).model_fields:
            if (value := getattr(self, name)) is not None:
                yield name, value

    @property
    def context(self) -> Context:
        """What the table takes from its scene. Raises BadInput if it is in none."""
        if self._context is None:
            raise BadInput(f"{type(self).__name__}: is in no scene (accepted: one of a Scene)")
        return self._context

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
        return {name: _table(value) for name, value in self.entries()}

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
        return no_such(name, value, [*cls.heading, *cls.names(dimension)])

    @classmethod
    def from_table(cls, entry: str, table: Any, dimension: Dimension | None) -> Self:
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
                {printable(name): table[name] for name in table if name not in others},
                context={"of": dimension},
            )
        except ValidationError as error:
            messages += _lines(cls, error, entry, ".", dimension)
        if messages:
            raise BadInput(*messages)
        model._stands_at(entry, table)
        return model

    def _nested(self) -> Iterator[tuple[str, Entries]]:
        """Yields the tables in this table with the dotted names of their entries in it."""
        for name, value in self.entries():
            if isinstance(value, Entries):
                yield name, value
            elif name in self.nested:
                yield from ((f"{name}.{k}", model) for k, model in enumerate(value, 1))

    def _stands_at(self, entry: str, table: dict[str, Any]) -> None:
        self._entry, self._given = entry, table
        for path, model in self._nested():
            name, _, k = path.partition(".")
            model._stands_at(self.at(path), table[name][int(k) - 1] if k else table[name])

    def bind(self, context: Context) -> None:
        """Puts the table into a scene, from which it takes the context."""
        self._context = context
        for _, model in self._nested():
            model.bind(context)


def _table(value: Any) -> Any:
    if isinstance(value, Entries):
        return value.table()
    return [_table(item) for item in value] if isinstance(value, list | tuple) else plain(value)


def no_such(name: str, value: Any, accepted: list[str], meant: str = "") -> str:
    """The message about an unknown entry, behind its name; it may mean the entry `meant`."""
    hint = f"; did you mean {meant}?" if meant else suggestion(name, accepted)
    return f": no such entry, set to '{brief(value)}'{hint} (accepted: {', '.join(accepted)})"


def no_more(name: str, value: Any) -> str:
    """The message about a former entry, behind its name."""
    return f": '{brief(value)}' is no entry any more (accepted: {FORMER[name]})"


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


def several(value: Any) -> Any:
    """Returns a single table as a list with one element, and any other value unchanged."""
    return [value] if isinstance(value, Entries) else value
