"""Tables as the text of a TOML file."""

import json
import re

from ..failure import BadInput, brief


def to_toml(table: dict, path: str = "") -> str:
    """The text of a TOML file of tables, lists of tables and values, numbers with all their digits: read again it is the same table."""
    text = "".join(f"{_key(key)} = {_written(value)}\n" for key, value in table.items() if not _tables(value))
    for key, value in table.items():
        for one in _tables(value):
            name = _at(path, _key(key))
            text += f"\n{f'[{name}]' if isinstance(value, dict) else f'[[{name}]]'}\n{to_toml(one, name)}"
    return text


def _key(key: str) -> str:
    return key if re.fullmatch("[A-Za-z0-9_-]+", key) else _written(key)


def _written(value) -> str:
    """A value as TOML writes it: text as JSON does, but DEL; times and dates as Python does."""
    if isinstance(value, str):
        if re.search("[\ud800-\udfff]", value):             # a path of other bytes
            raise BadInput(f"'{brief(value)}': is no text in UTF-8, in which scenes are written down (accepted: names and paths that are)")
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_written, value))}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{_key(key)} = {_written(one)}' for key, one in value.items())}}}"
    return str(value).lower() if isinstance(value, bool) else str(value)


def _tables(value) -> list[dict]:
    """The tables that a value is or lists."""
    listed = [value] if isinstance(value, dict) else value if isinstance(value, list) else []
    return listed if all(isinstance(one, dict) for one in listed) else []


def _at(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key
