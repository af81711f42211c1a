"""The JSON schema of scene files, from the models of model.py and the table of parameters: editors
complete and check TOML files with it (ffimpact schema)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from .input import parameters
from .input.dimension import SCRIPTS
from .input.parameters import Parameter
from .model import BODIES, OBSTACLES, Contact, Entries, Load, Material, Pair, Scene, Support
from .scenes.bodies import MATERIAL, SIZES

__all__ = ["FILE", "schema", "text"]

FILE = Path(__file__).parent / "scenes/scene.schema.json"  # what the built-in scenes name
DRAFT = "https://json-schema.org/draft/2020-12/schema"


def schema() -> dict[str, Any]:
    """The schema of a scene file: one of bodies and obstacles in tables, or one of the paper's cases."""
    shared = {name: rule(parameters.PARAMETERS[name]) for name in (*MATERIAL, *SIZES)}
    of_bodies = {
        "type": "object",
        "properties": entries(Scene, leave=("bodies", "obstacles", "contact", "folder"))
        | shared
        | {
            "script": {"type": "string"},
            "body": {
                "type": "array",
                "minItems": 1,
                "items": {"oneOf": [body(one) for one in BODIES]},
            },
            "obstacle": {"type": "array", "items": {"oneOf": [obstacle(one) for one in OBSTACLES]}},
            "contact": {
                "type": "object",
                "properties": entries(Contact, leave=("pair",)) | {"pair": tables(Pair)},
                "additionalProperties": False,
            },
        },
        "required": ["body"],
        "additionalProperties": False,
    }
    scripts = sorted(
        {script for one in parameters.PARAMETERS.values() for script in one.scripts} - set(SCRIPTS)
    )
    case = {
        "type": "object",
        "properties": {"title": {"type": "string"}, "script": {"enum": scripts}}
        | {name: rule(parameters.PARAMETERS[name]) for name in parameters.names()},
        "additionalProperties": False,
    }
    return {"$schema": DRAFT, "title": "ffimpact scene", "oneOf": [of_bodies, case]}


def text() -> str:
    """The schema as the text of a file."""
    return json.dumps(schema(), indent=1, ensure_ascii=False) + "\n"


def rule(one: Parameter) -> dict[str, Any]:
    """What is accepted of a parameter, with its unit and meaning."""
    told = {
        "description": f"{one.help} [{one.unit}]" if one.unit not in ("", "-") else one.help,
        "default": one.default,
    }
    if one.kind == "word":
        return told | {"enum": list(one.words)}
    if one.kind == "numbers":
        return told | {"type": ["string", "number", "array"]}
    number = {
        "type": "integer" if one.kind == "int" else "number",
        "minimum": one.low,
        "maximum": one.high,
    }
    return told | ({"anyOf": [number, {"enum": list(one.words)}]} if one.words else number)


def entries(model: type[Entries], leave: tuple[str, ...] = ()) -> dict[str, Any]:
    """The entries of a model: those that are parameters by their rule, the others by their type."""
    known = parameters.PARAMETERS
    own = model.model_json_schema(mode="validation").get("properties", {})
    found: dict[str, Any] = {}
    for name, field in model.model_fields.items():
        if name in leave:
            continue
        if name in known and not (model in BODIES.values() and name == "radius"):
            found[name] = rule(known[name])
        else:
            told = {
                key: value
                for key, value in own.get(name, {}).items()
                if key not in ("title", "default")
            }
            found[name] = _without_null(told) or {"description": field.description or ""}
    return found


def _without_null(told: dict[str, Any]) -> dict[str, Any]:
    """A type that may be left out, not null: TOML has none."""
    kinds = [one for one in told.pop("anyOf", []) if one != {"type": "null"}]
    if kinds and not any("$ref" in str(one) for one in kinds):
        told |= kinds[0] if len(kinds) == 1 else {"anyOf": kinds}
    return {key: value for key, value in told.items() if "$ref" not in str(value)}


def tables(model: type[Entries]) -> dict[str, Any]:
    """A list of tables of a model."""
    needed = [name for name, field in model.model_fields.items() if field.is_required()]
    one = {
        "type": "object",
        "properties": entries(model),
        "required": needed,
        "additionalProperties": False,
    }
    return {"type": "array", "items": one}


def body(shape: str) -> dict[str, Any]:
    """A table [[body]] of a shape."""
    model = BODIES[shape]
    own = entries(model, leave=("material", "support", "load"))
    needed = [name for name, field in model.model_fields.items() if field.is_required()]
    return {
        "type": "object",
        "properties": {"shape": {"const": shape}}
        | entries(Material)
        | own
        | {"support": tables(Support), "load": tables(Load)},
        "required": ["shape", *(name for name in needed if name != "position"), "position"],
        "additionalProperties": False,
    }


def obstacle(kind: str) -> dict[str, Any]:
    """A table [[obstacle]] of a kind."""
    model = OBSTACLES[kind]
    needed = [name for name, field in model.model_fields.items() if field.is_required()]
    return {
        "type": "object",
        "properties": {"kind": {"const": kind}} | entries(model),
        "required": ["kind", *needed],
        "additionalProperties": False,
    }
