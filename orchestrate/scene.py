"""Scenes as data: a TOML file names the FreeFEM script and the parameters that differ from their defaults, or lists bodies (multibody.py)."""

import tempfile
import tomllib
from dataclasses import dataclass, replace
from pathlib import Path

from .input import parameters
from .mesh import mesh
from .output import estimate
from .freefem.describe import describe
from .failure import BadInput, brief

SCENES = Path(__file__).resolve().parent / "scenes"


@dataclass(frozen=True)
class Scene:
    """`script` is a file edp/<script>.edp; `values` holds EVERY parameter that it takes, in SI units."""

    name: str
    title: str
    script: str
    values: dict[str, parameters.Value]
    released: tuple[str, ...] = ()      # sentences: what was fixed for others that are set now

    def override(self, given: dict[str, parameters.Value]) -> "Scene":
        """The same scene with some parameters set (text or values), and open again what it had fixed for them (FOLLOWS); BadInput where one is not accepted."""
        checked = self.check(given)
        opened = parameters.released(self.values, checked)
        said = tuple(parameters.release(name, self.values[name], [cause for cause in parameters.FOLLOWS[name] if cause in checked]) for name in opened)
        return replace(self, values=self.values | opened | checked, released=self.released + said)

    def check(self, given: dict[str, parameters.Value]) -> dict[str, parameters.Value]:
        """The given entries of such a scene, checked one by one and converted; BadInput."""
        return parameters.check(given, self.script)

    @property
    def asked(self) -> dict:
        """What decides the answer: two scenes that agree in it are one run."""
        return parameters.decisive(self.values)

    @property
    def given(self) -> dict:
        """The scene as a file says it."""
        return {"script": self.script} | self.values

    @property
    def mesh_name(self) -> str:
        """The file of the mesh in a run's folder."""
        return "mesh.msh"

    @property
    def sizes(self) -> dict[str, float]:
        """Mesh sizes that are not in `values`: none."""
        return {}

    @property
    def scaled(self) -> estimate.Scaled:
        """What it is overridden by for larger or smaller elements and steps."""
        return estimate.other

    @property
    def numbers(self) -> list[str]:
        """The numbers of summary.json."""
        return of_bodies("summary", describe(script=self.script))

    @property
    def columns(self) -> list[str]:
        """The columns of history.csv."""
        return of_bodies("columns", describe(script=self.script))

    @property
    def of_files(self) -> bool:
        """Never: a mesh of the user's comes beside the scene."""
        return False

    @property
    def meshed(self) -> bool:
        """Whether Python makes the mesh, with gmsh; else the script does."""
        return self.script in parameters.table()["mesh"].scripts

    def description(self, foreign: bytes | None = None) -> dict:
        """What the scripts say of the scene, on the mesh `foreign` (FreeFEM's .msh) where there is one; BadInput where they refuse it."""
        if foreign is None:
            return describe(self.values, self.script)
        parameters.taken("mesh", self.script)
        with tempfile.NamedTemporaryFile(suffix=".msh") as file:
            file.write(foreign)
            file.flush()
            return describe(self.values | {"mesh": file.name}, self.script)

    def prepare(self, where: Path, foreign: bytes | None = None) -> tuple[dict[str, parameters.Value | Path], dict, str]:
        """The flags of a run in the folder `where`, the scene as it will be used, and the text of its scene.toml, "" where the script writes it. Puts
        into the folder what the flags name: the mesh, `foreign` or our own, of the sizes and the part of the body that the description says."""
        said, file = self.description(foreign), where / self.mesh_name
        if not self.meshed:
            return self.values, said["used"], ""
        if foreign is not None:
            file.write_bytes(foreign)
        else:
            sizes = (said["used"][name] for name in ("radius", "mesh_size", "contact_mesh_size"))
            mesh.write(mesh.disc(*sizes, said["half"], said["touch_arc"]), file)
        return self.values | {"mesh": file}, said["used"], ""


def of_bodies(what: str, said: dict, bodies: int = 0) -> list[str]:
    """The columns of history.csv, or the numbers of summary.json, of a scene that describes itself so, with its or so many bodies; those of each
    of several have the suffixes _1, _2 ..."""
    bodies = bodies or said["bodies"]
    return said[what] + [f"{name}_{b}" for b in range(1, bodies + 1) for name in said[f"body_{what}"] if bodies > 1]


def built_in() -> list[str]:
    """Names of the scenes that come with the program."""
    return sorted(path.stem for path in SCENES.glob("*.toml"))


def read_toml(path: Path, missing: str) -> tuple[str, dict]:
    """The text of a TOML file and what it says; BadInput with the words `missing` where there is none, or why it cannot be read."""
    try:
        if path.exists() and not path.is_file() and not path.is_dir():   # reading a pipe or a device might never end
            raise BadInput(f"{path}: is no file")
        text = path.read_text("utf-8")
        return text, tomllib.loads(text)
    except (FileNotFoundError, IsADirectoryError, NotADirectoryError):
        raise BadInput(missing) from None
    except RecursionError:
        raise BadInput(f"{path}: cannot be read: nested too deep") from None
    except (OSError, ValueError) as error:
        raise BadInput(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from None


def load(name: str) -> "Scene | multibody.Multibody":
    """A built-in scene, or the scene of a TOML file: title, script and any parameters, all at top level; or one with bodies.

    The scene.toml of a result folder is such a file too. BadInput when there is no such scene, on a TOML error
    and on an unknown key.
    """
    path = SCENES / f"{name}.toml" if name in built_in() else Path(name)
    _, given = read_toml(path, f"{name}: no such scene (built in: {', '.join(built_in())}; or the path of a TOML file)")
    try:
        return _read(given, path)
    except BadInput as error:
        raise BadInput(f"{path}: {error}") if path.parent != SCENES else error from None


def _read(given: dict, path: Path) -> "Scene | multibody.Multibody":
    from .input import dimension
    from .scenes import multibody
    if {"body", "obstacle", "contact", "dimension"} & set(given):
        return multibody.read(given, path.parent, path.stem)
    if not given:
        raise BadInput("says nothing (accepted: a scene, as the built-in ones in orchestrate/scenes)")
    script, title = given.pop("script", "disc-plane"), given.pop("title", path.stem)
    scripts = [word for word in describe()["scripts"].split("|") if word not in dimension.SCRIPTS]
    if script in dimension.SCRIPTS:
        raise BadInput(f"body: is missing, which script = '{brief(script)}' needs (accepted: one table [[body]] or more)")
    if script not in scripts:
        raise BadInput(f"script: '{brief(script)}' is not known (accepted: {'|'.join(scripts)})")
    return Scene(path.stem, title, script, parameters.defaults(script) | parameters.check(given, script))
