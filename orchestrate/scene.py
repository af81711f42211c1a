"""Scenes as data: a TOML file names the FreeFEM script and the parameters that differ from their defaults."""

import tomllib
from dataclasses import dataclass, replace
from pathlib import Path

from . import parameters
from .describe import describe
from .failure import BadInput

SCENES = Path(__file__).resolve().parent / "scenes"


@dataclass(frozen=True)
class Scene:
    """`script` is a file edp/<script>.edp; `values` holds EVERY parameter of the table, in SI units."""

    name: str
    title: str
    script: str
    values: dict[str, parameters.Value]

    def override(self, given: dict[str, parameters.Value]) -> "Scene":
        """The same scene with some parameters set (text or values); BadInput where one is not accepted."""
        return replace(self, values=self.values | parameters.check(given))


def built_in() -> list[str]:
    """Names of the scenes that come with the program."""
    return sorted(path.stem for path in SCENES.glob("*.toml"))


def read_toml(path: Path, missing: str) -> tuple[str, dict]:
    """The text of a TOML file and what it says; BadInput with the words `missing` where there is none, or why it cannot be read."""
    try:
        if path.exists() and not path.is_file() and not path.is_dir():   # reading a pipe or a device might never end
            raise BadInput(f"{path}: is no file")
        text = path.read_text()
        return text, tomllib.loads(text)
    except (FileNotFoundError, IsADirectoryError, NotADirectoryError):
        raise BadInput(missing) from None
    except RecursionError:
        raise BadInput(f"{path}: cannot be read: nested too deep") from None
    except (OSError, ValueError) as error:
        raise BadInput(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from None


def load(name: str) -> Scene:
    """A built-in scene, or the scene of a TOML file: title, script and any parameters, all at top level.

    The scene.toml of a result folder is such a file too. BadInput when there is no such scene, on a TOML error
    and on an unknown key.
    """
    path = SCENES / f"{name}.toml" if name in built_in() else Path(name)
    _, given = read_toml(path, f"{name}: no such scene (built in: {', '.join(built_in())}; or the path of a TOML file)")
    script, title = given.pop("script", "disc-plane"), given.pop("title", path.stem)
    scripts = describe()["scripts"]
    if script not in scripts:
        raise BadInput(f"{path}: script: '{script}' is not known (accepted: {'|'.join(scripts)})")
    try:
        values = parameters.defaults() | parameters.check(given)
    except BadInput as error:
        raise BadInput(f"{path}: {error}") if path.parent != SCENES else error from None
    return Scene(path.stem, title, script, values)
