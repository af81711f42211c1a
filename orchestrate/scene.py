"""Scenes as files: the built-in ones and those of one's own."""

import tomllib
from pathlib import Path

from .failure import BadInput
from .scenes.scene import Scene, read

SCENES = Path(__file__).resolve().parent / "scenes"


def built_in() -> list[str]:
    """Names of the scenes that come with the program."""
    return sorted(path.stem for path in SCENES.glob("*.toml"))


def read_toml(path: Path, missing: str) -> tuple[str, dict]:
    """The text of a TOML file and what it says; BadInput with the words `missing` where there is none, or why it cannot be read."""
    try:
        if path.exists() and not path.is_file() and not path.is_dir():   # reading a pipe or a device might never end
            raise BadInput(f"{path}: is no file")
        text = path.read_text("utf-8-sig")          # some editors write a byte order mark
        return text, tomllib.loads(text)
    except (FileNotFoundError, IsADirectoryError, NotADirectoryError):
        raise BadInput(missing) from None
    except RecursionError:
        raise BadInput(f"{path}: cannot be read: nested too deep") from None
    except (OSError, ValueError) as error:
        raise BadInput(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from None


def load(name: str | Path) -> Scene:
    """A built-in scene, or the scene of a TOML file: title, script and any parameters, all at top level; or one with bodies.

    The scene.toml of a result folder is such a file too. BadInput when there is no such scene, on a TOML error
    and on an unknown key.
    """
    name = str(name)
    path = SCENES / f"{name}.toml" if name in built_in() else Path(name)
    words = ("file (accepted: the path of a TOML scene, or a built-in one)" if name.endswith(".toml") else
             f"scene (built in: {', '.join(built_in())}; or the path of a TOML file)")
    _, given = read_toml(path, f"{name}: no such {words}")
    try:
        return read(given, path.parent, path.stem)
    except BadInput as error:
        raise BadInput(f"{path}: {error}") if path.parent != SCENES else error from None
