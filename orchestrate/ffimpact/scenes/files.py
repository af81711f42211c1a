"""Reads files: the built-in scenes and TOML files of the user."""

import re
import tomllib
from pathlib import Path

from ..failure import BadInput, suggestion
from ..input import parameters
from ..input.parameters import Table

__all__ = ["SCENES", "absent", "built_in", "read_toml"]

SCENES = Path(__file__).resolve().parent


def built_in() -> list[str]:
    """Returns the names of the built-in scenes."""
    return sorted(path.stem for path in SCENES.glob("*.toml"))


def read_toml(path: Path, missing: str) -> tuple[str, Table]:
    """Returns the text of a TOML file and its tables. Raises BadInput with the message `missing` if
    there is no such file, or with the reason why the file cannot be read.
    """
    try:
        # Reading a pipe or a device might never end.
        if path.exists() and not path.is_file() and not path.is_dir():
            raise BadInput(f"{path}: is no file")
        text = path.read_text("utf-8-sig")  # some editors write a byte order mark
        return text, tomllib.loads(text)
    except (FileNotFoundError, IsADirectoryError, NotADirectoryError):
        raise BadInput(missing) from None
    except RecursionError:
        raise BadInput(f"{path}: cannot be read: nested too deep") from None
    except (OSError, ValueError) as error:
        why = f"cannot be read: {getattr(error, 'strerror', None) or error}"
        raise BadInput(f"{path}: {_unit_in(path, error) or why}") from None


def _unit_in(path: Path, error: Exception) -> str:
    """Returns a message if a TOML error is due to a number that is written with its unit, else an
    empty text. The message contains the entry in the line of the error.
    """
    if not (line := re.search(r"at line ([0-9]+)", str(error))):
        return ""
    entry, _, value = path.read_text("utf-8").splitlines()[int(line[1]) - 1].partition("=")
    entry, value = entry.strip(), value.partition("#")[0].strip()
    rule = parameters.PARAMETERS.get(entry)
    message = parameters.with_unit(value, rule.unit if rule else "")
    return message and f"{entry}: '{value}' {message}" + (
        f" (accepted: {rule.accepted})" if rule else ""
    )


def absent(name: str, kind: str, names: list[str]) -> str:
    """Returns the message for a name that is neither a built-in scene (or sweep) nor an existing
    file.
    """
    hint = suggestion(name.removesuffix(".toml"), names)
    if name.endswith(".toml"):
        return (
            f"{name}: no such file{hint} (accepted: the path of a TOML {kind}, or a built-in one)"
        )
    return (
        f"{name}: no such {kind}{hint} (built in: {', '.join(names)}; or the path of a TOML file)"
    )
