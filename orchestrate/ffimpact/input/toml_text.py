"""Writes the tables of a scene as the text of a TOML file."""

import re
from typing import Any

import numpy as np
import tomli_w

from ..failure import BadInput, brief
from .parameter import Table

__all__ = ["to_toml"]


def to_toml(table: Table) -> str:
    """The text of a TOML file with the tables, lists of tables and values of `table`.

    Numbers keep all their digits: reading the text gives the same table. Raises BadInput if a text
    is not UTF-8, as the bytes of a path may not be.
    """
    return tomli_w.dumps(_plain(table))


def _plain(value: Any) -> Any:
    """A value with Python's numbers and lists in place of numpy's."""
    if isinstance(value, dict):
        return {_plain(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, str) and re.search("[\ud800-\udfff]", value):
        raise BadInput(
            f"'{brief(value)}': is no text in UTF-8, in which scenes are written down (accepted: names and paths that are)"
        )
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value
