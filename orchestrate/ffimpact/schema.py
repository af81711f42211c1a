"""The JSON schema of scene files, made from the models in input/models.py and the table of
parameters. Editors complete and check TOML files with it (`ffimpact schema`).
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from pydantic.json_schema import models_json_schema

from .input import parameters
from .input.dimension import SCRIPTS
from .input.models import BODIES, OBSTACLES, Contact, Top

__all__ = ["FILE", "schema", "text"]

# The built-in scenes refer to this file.
FILE = Path(__file__).parent / "scenes/scene.schema.json"
DRAFT = "https://json-schema.org/draft/2020-12/schema"


def schema() -> dict[str, Any]:
    """Returns the schema of a scene file, which has either tables of bodies and obstacles or the
    parameters of a case of the paper.
    """
    models = [Top, Contact, *BODIES.values(), *OBSTACLES.values()]
    _, made = models_json_schema([(one, "validation") for one in models])
    known: dict[str, Any] = {name: _plain(one) for name, one in made["$defs"].items()}
    for word, table in (("shape", BODIES), ("kind", OBSTACLES)):
        for name, model in table.items():
            one = known[model.__name__]
            one["properties"] = {word: {"const": name}} | one["properties"]
            one["required"] = [word, *one.get("required", [])]
    of_bodies = known.pop("Top")
    of_bodies["properties"] |= {
        "body": {"type": "array", "minItems": 1, "items": {"oneOf": _references(BODIES)}},
        "obstacle": {"type": "array", "items": {"oneOf": _references(OBSTACLES)}},
        "contact": {"$ref": "#/$defs/Contact"},
    }
    of_bodies["required"] = ["body"]
    scripts = sorted(
        {name for one in parameters.PARAMETERS.values() for name in one.scripts} - set(SCRIPTS)
    )
    case = {
        "type": "object",
        "properties": {"title": {"type": "string"}, "script": {"enum": scripts}}
        | {
            name: one.schema() | {"description": one.meaning}
            for name, one in parameters.PARAMETERS.items()
        },
        "additionalProperties": False,
    }
    return {"$schema": DRAFT, "title": "ffimpact scene", "oneOf": [of_bodies, case], "$defs": known}


def text() -> str:
    """Returns the schema as the text of a JSON file."""
    return json.dumps(schema(), indent=1, ensure_ascii=False) + "\n"


def _references(table: dict[str, Any]) -> list[dict[str, str]]:
    return [{"$ref": f"#/$defs/{model.__name__}"} for model in table.values()]


def _plain(made: Any) -> Any:
    """Returns a schema without null, which TOML does not have, and without titles that repeat
    names.
    """
    if isinstance(made, list):
        return [_plain(one) for one in made]
    if not isinstance(made, dict):
        return made
    kinds = [one for one in made.get("anyOf", []) if one != {"type": "null"}]
    found = {
        name: _plain(value)
        for name, value in made.items()
        if name != "anyOf"
        and not (name == "title" and isinstance(value, str))
        and not (name == "default" and value is None)
    }
    if len(kinds) == 1:
        found |= _plain(kinds[0])
    elif kinds:
        found["anyOf"] = _plain(kinds)
    return found
