"""Sets entries of a scene's tables by dotted names, and resets the entries that depend on them to
automatic.
"""

import copy
import re
import tomllib
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from ..failure import BadInput, brief
from ..geometry import time_functions
from ..input import parameters
from ..input.models import listed
from ..input.parameters import Table

__all__ = ["dependents", "files_renamed", "reset_dependents", "set_entry", "toml_value"]

# Entries that set the size of a body, beside `radius`.
SHAPE = (
    "shape",
    "semi_axes",
    "width",
    "height",
    "depth",
    "inner_radius",
    "section",
    "vertices",
    "file",
    "scale",
)
EVERYWHERE = ("penalty", "dt")  # entries that depend on every body
SIZES = ("mesh_size", "contact_mesh_size")  # likewise at the top of a scene


def set_entry(content: Table, name: str, value: Any) -> Table:
    """Returns the tables of a file with one entry set.

    Names are dotted: "body.2.young", "contact.pair.1.penalty", "body.1.velocity.2". Tables and
    components of a list are counted from 1. The value None removes the entry of a table: the
    program then chooses its value. Raises BadInput if the scene has no such table or component.
    """
    changed = copy.deepcopy(content)
    container: Any = changed
    path = ""
    *parents, last = name.split(".")
    for step, following in zip(parents, [*parents[1:], last]):
        path = f"{path}.{step}" if path else step
        if isinstance(container, dict) and step not in container and path == "contact":
            container[step] = {}
        key = _key(container, step, path, name)
        if key not in container if isinstance(container, dict) else False:
            raise BadInput(
                f"{brief(name)}: there is no {brief(path)} in the scene (accepted: {', '.join(container)})"
            )
        container = container[key]
        if not isinstance(container, dict | list):
            raise BadInput(
                f"{brief(name)}: {path} is '{brief(container)}' and has no entry {brief(following)}"
            )
    key = _key(container, last, name, name)
    if value is None and isinstance(container, dict):
        container.pop(key, None)
    else:
        container[key] = value
    return changed


def dependents(content: Table, names: list[str]) -> dict[str, Any]:
    """Returns the entries that reset_dependents() would reset, with their values, by dotted names."""
    rest = copy.deepcopy(content)
    reset_dependents(rest, names)
    after = dict(_tables(rest))
    return {
        f"{path}.{key}".lstrip("."): value
        for path, table in _tables(content)
        for key, value in table.items()
        if key in parameters.DEPENDS_ON and key not in after[path]
    }


def reset_dependents(content: Table, names: list[str]) -> tuple[str, ...]:
    """Resets entries that depend on the changed entries `names` (DEPENDS_ON) to automatic: removes
    them from the tables `content`. Returns one message for each.

    Coefficients of friction and sizes of a body depend on entries of the same table; penalty, step
    and the sizes at the top of the scene depend on those of every body.
    """
    places = [_table_of(name) for name in names]
    messages = []
    for path, table in list(_tables(content)):
        for key in [
            key for key in parameters.DEPENDS_ON if key in table and (path, key) not in places
        ]:
            causes = parameters.DEPENDS_ON[key]
            changed_names = [
                name
                for name, (where, entry) in zip(names, places)
                if (where == path or key in EVERYWHERE or (key in SIZES and not path))
                and (
                    entry in causes
                    or "radius" in causes
                    and entry in SHAPE
                    and where.startswith("body.")
                )
            ]
            if changed_names and table[key] not in (
                "auto",
                0,
                "none",
                parameters.KEPT.get(key),
            ):
                value, name = table.pop(key), f"{path}.{key}".lstrip(".")
                fixed = f"{value:g}" if isinstance(value, float) else brief(value)
                messages.append(
                    f"{name} is reset to automatic: the value {fixed} of the scene belonged to "
                    f"its own {', '.join(changed_names)}"
                )
    return tuple(messages)


def _tables(value: Any, path: str = "") -> Iterator[tuple[str, Table]]:
    """Yields all tables in a table or a list, with their dotted names."""
    if isinstance(value, dict):
        yield path, value
    for key, item in (
        value.items()
        if isinstance(value, dict)
        else enumerate(value, 1)
        if isinstance(value, list)
        else ()
    ):
        yield from _tables(item, f"{path}.{key}".lstrip("."))


def _table_of(name: str) -> tuple[str, str]:
    """Returns the dotted name of the table that holds an entry, and the entry in it."""
    parts = name.split(".")
    depth = (
        3
        if parts[:2] == ["contact", "pair"]
        else {"body": 2, "obstacle": 2, "contact": 1}.get(parts[0], 0)
    )
    return ".".join(parts[:depth]), ".".join(parts[depth : depth + 1])


def _key(container: Table | list[Any], step: str, path: str, name: str) -> str | int:
    """Returns the key of one part of a dotted name; in a list it is the index from 0."""
    if not step:
        raise BadInput(
            f"{brief(name)}: has an empty part (accepted: names and numbers with single dots between them)"
        )
    if isinstance(container, dict):
        return step
    if not re.fullmatch("[0-9]{1,6}", step) or not 1 <= int(step) <= len(container):
        before = path.removesuffix(f".{step}")
        numbers = (
            f"{before}.1 to {before}.{len(container)}" if len(container) > 1 else f"{before}.1"
        )
        raise BadInput(
            f"{brief(name)}: there is no {brief(path)} in the scene (accepted: {numbers})"
        )
    return int(step) - 1


def toml_value(value: Any) -> Any:
    """Returns the value of a text by TOML's rules, or the text itself if it has none. Numbers and
    arrays of numpy become plain numbers and lists.
    """
    if not isinstance(value, str):
        return value.tolist() if isinstance(value, np.generic | np.ndarray) else value
    try:
        return tomllib.loads(f"value = {value}")["value"] if "\n" not in value else value
    except ValueError:  # no TOML, or a number with more digits than Python reads
        return value


def files_renamed(content: Table, rename: Callable[[str, str], str]) -> Table:
    """Returns the tables of a scene with rename(label, name) in place of the names of all files: of
    bodies and obstacles, and of CSV files of supports, loads and driven obstacles. A label is unique
    in the scene.
    """
    bodies = []
    for b, body in enumerate(listed(content, "body"), 1):
        changed = _with_file(f"body{b}", body, rename)
        for key, names in (("support", ("motion",)), ("load", ("traction", "pressure"))):
            if key in body:
                changed[key] = [
                    _csv_renamed(f"body-{b}-{key}-{k}", table, names, rename)
                    for k, table in enumerate(listed(body, key), 1)
                ]
        bodies.append(changed)
    obstacles = [
        _csv_renamed(
            f"obstacle-{k}",
            _with_file(f"obstacle{k}", table, rename),
            ("motion", "rotation"),
            rename,
        )
        for k, table in enumerate(listed(content, "obstacle"), 1)
    ]
    return (
        content
        | ({"body": bodies} if bodies else {})
        | ({"obstacle": obstacles} if obstacles else {})
    )


def _with_file(label: str, table: Table, rename: Callable[[str, str], str]) -> Table:
    if "file" not in table:
        return dict(table)
    return table | {"file": rename(table.get("name", label), str(table["file"]))}


def _csv_renamed(
    label: str, table: Table, names: tuple[str, ...], rename: Callable[[str, str], str]
) -> Table:
    files = {name: table[name] for name in names if time_functions.is_csv(table.get(name))}
    return table | {name: rename(f"{label}-{name}", file) for name, file in files.items()}
