"""Files of named arrays, numbers and texts, from which the FreeFEM scripts take a scene. The format
is that of edp/kernels/input.cpp.
"""

import struct
import zlib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

__all__ = ["Entries", "joined", "packed", "table", "unpacked"]

Entries = dict[str, Any]  # numbers, texts, lists and arrays by name
WORD = b"ffinput1"
HEAD = "<48s8sqq"  # of an entry: name, kind, rows, columns
NUMBERS = {"real": "<f8", "whole": "<i8"}


def table(name: str, rows: Sequence[Mapping[str, Any]]) -> Entries:
    """Returns the number of rows as the entry `name`, and the columns of the rows as arrays
    `name.column`, none if there are no rows.
    """
    columns = rows[0] if rows else ()
    return {name: len(rows)} | {
        f"{name}.{column}": np.array([row[column] for row in rows]) for column in columns
    }


def joined(name: str, lists: Sequence[Any]) -> Entries:
    """Returns lists of numbers behind each other as the entry `name`, and where each begins, and
    the last ends, as `name.first`.
    """
    first = np.cumsum([0, *map(len, lists)])
    return {f"{name}.first": first} | ({name: np.concatenate(lists)} if lists else {})


def packed(entries: Mapping[str, Any]) -> bytes:
    """Returns the bytes of a file with these entries. An array of floating-point numbers is real,
    one of integers or booleans is whole; a list of texts, which may be empty, is text.
    """
    rest = b"".join(_entry(name, value) for name, value in entries.items())
    return WORD + struct.pack("<qq", zlib.crc32(rest), len(rest)) + rest


def unpacked(data: bytes) -> Entries:
    """Returns the entries of a file: numbers as arrays (rows, columns), texts as lists, whose last
    one may be empty.
    """
    entries: Entries = {}
    at = len(WORD) + 16
    while at < len(data):
        *names, rows, columns = struct.unpack_from(HEAD, data, at)
        name, kind = (word.rstrip(b"\0").decode() for word in names)
        first = at + struct.calcsize(HEAD)
        at = first + rows * columns * (8 if kind in NUMBERS else 1)
        if kind in NUMBERS:
            entries[name] = np.frombuffer(data[first:at], NUMBERS[kind]).reshape(rows, columns)
        else:
            entries[name] = data[first:at].decode().split("\0")
    return entries


def _entry(name: str, value: Any) -> bytes:
    """Returns the bytes of an entry: its head and its numbers."""
    array = np.asarray(value)
    if array.dtype.kind == "U":
        data = b"".join(text.encode() + b"\0" for text in np.atleast_1d(array).tolist())
        data += bytes(-len(data) % 8)
        return _head(name, "text", (1, len(data))) + data
    kind = "real" if array.dtype.kind == "f" else "whole"
    array = np.atleast_1d(array).astype(NUMBERS[kind])
    return _head(name, kind, (array.shape + (1,))[:2]) + array.tobytes()


def _head(name: str, kind: str, shape: tuple[int, ...]) -> bytes:
    return struct.pack(HEAD, name.encode(), kind.encode(), *shape)
