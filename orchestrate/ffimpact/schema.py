"""The JSON schema of scene files, made from the models in input/ and the table of
parameters. Editors complete and check TOML files with it (`ffimpact schema`).
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from pydantic.json_schema import models_json_schema

from .input.contact import Contact
from .input.entries import Entries
from .input.models import Top
from .input.obstacles import OBSTACLES
from .input.shapes import BODIES

__all__ = ["FILE", "schema", "text"]

# The built-in scenes refer to this file.
FILE = Path(__file__).parent / "scenes/scene.schema.json"
DRAFT = "https://json-schema.org/draft/2020-12/schema"


def schema() -> dict[str, Any]:
    """Returns the schema of a scene file, which has either tables of bodies and obstacles or the
    parameters of a case of the paper.
    """
    models: list[type[Entries]] = [Top, Contact, *BODIES.values(), *OBSTACLES.values()]
    _, made = models_json_schema([(entry_model, "validation") for entry_model in models])
    definitions: dict[str, Any] = {name: _plain(part) for name, part in made["$defs"].items()}
    for word, table in (("shape", BODIES), ("kind", OBSTACLES)):
        for name, model in table.items():
            definition = definitions[model.__name__]
            definition["properties"] = {word: {"const": name}} | definition["properties"]
            definition["required"] = [word, *definition.get("required", [])]
    of_bodies = definitions.pop("Top")
    of_bodies["properties"] |= {
        "body": {"type": "array", "minItems": 1, "items": {"oneOf": _references(BODIES)}},
        "obstacle": {"type": "array", "items": {"oneOf": _references(OBSTACLES)}},
        "contact": {"$ref": "#/$defs/Contact"},
    }
    of_bodies["required"] = ["body"]
    return {"$schema": DRAFT, "title": "ffimpact scene", **of_bodies, "$defs": definitions}


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
        return [_plain(item) for item in made]
    if not isinstance(made, dict):
        return made
    kinds = [kind for kind in made.get("anyOf", []) if kind != {"type": "null"}]
    cleaned = {
        name: _plain(value)
        for name, value in made.items()
        if name != "anyOf"
        and not (name == "title" and isinstance(value, str))
        and not (name == "default" and value is None)
    }
    if len(kinds) == 1:
        cleaned |= _plain(kinds[0])
    elif kinds:
        cleaned["anyOf"] = _plain(kinds)
    return cleaned
