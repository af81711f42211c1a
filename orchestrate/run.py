"""One scene, one run, one folder: the run contract.

A run happens in the folder DIR.part. Finished, it takes DIR's place by rename, complete: a folder with summary.json is
a finished run. Interrupted, it leaves nothing, or DIR.part where it has made a checkpoint: there the same scene and code
go on. Failed, its files stay for a look (log.txt, history.csv, scene.toml,
failure.json), in DIR, or in DIR.failed where DIR holds an earlier finished run, which is not lost. What a run finds in its
place stays as DIR.1 (.2 ...), unless it is of the same scene: then what the program wrote goes, and what else is there moves over.
"""

import fcntl
import fnmatch
import hashlib
import itertools
import json
import math
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, nullcontext
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from . import estimate as estimates, freefem, mesh
from .describe import describe
from .failure import BadInput, Busy, Failure, TooLong, Unreadable
from .parameters import ROOT, Value, decisive
from .scene import Scene

# what the program writes into a folder
OWN = ("scene.toml", "history.csv", "summary.json", "failure.json", "log.txt", "mesh.msh", "fields.pvd", "fields/[0-9][0-9][0-9][0-9].vtu",
       "figures/energies.png", "figures/velocity.png", "figures/force.png", "figures/rolling.png", "figures/shapes.png", "figures/flight.png",
       "checkpoint", "checkpoint.json", "checkpoint.part", "checkpoint.state", "scene.part", "history.part", "history.cut", "summary.part",
       "summary.json.part", "fields.pvd.part", "fields.part/[0-9][0-9][0-9][0-9].vtu")
OURS = {"scene.toml", "failure.json", "scene.part", "history.part", "checkpoint.json"}   # a folder with one of these is the program's
FAILURES = {10: "bad input", 11: "step failed", 12: "material broke down", 13: "not installed", 14: "unreadable"}


@dataclass(frozen=True)
class RunResult:
    """A finished run. `reused`: it was there already."""

    folder: Path
    summary: dict
    reused: bool

    @cached_property
    def history(self) -> dict[str, np.ndarray]:
        """The columns of history.csv, each (steps,), SI units."""
        return read_history(self.folder)

    @cached_property
    def scene(self) -> dict[str, Value]:
        """Every parameter as used."""
        return read_scene(self.folder)


def run(scene: Scene, overrides: dict[str, Value] | None = None, out: Path | None = None, *,
        mesh_file: Path | None = None, force: bool = False, progress: bool = False, pictures: bool = True, estimate: bool = True) -> RunResult:
    """Runs `scene` with some parameters overridden in the folder `out` (default results/<scene>), or reuses it.

    Raises Failure with the exit code of the run contract. `force` runs again, from the start, even if the folder is up to
    date. With a checkpoint_every > 0 a run that is killed goes on from its last checkpoint when it is asked for again.
    With `estimate` a second, coarser run estimates the error, and finer ones follow until it is below the accuracy (estimate.py).
    """
    scene = scene.override(overrides or {})
    folder = result_folder(out or ROOT / "results" / scene.name)
    if mesh_file:
        mesh_file = _mesh_path(mesh_file)
    foreign = mesh.load(mesh_file) if mesh_file else None
    description = _describe(scene.values, foreign)
    finished = _finished(folder, force)
    if not force and (there := reusable(scene, folder, mesh_file, estimate)):
        return there

    program = freefem.find()
    with _staging(folder) as (stage, lock):
        if not force and (there := reusable(scene, folder, mesh_file, estimate)):   # another run has finished it meanwhile
            return there
        provenance = {"script": scene.script, "code": code_hash(), "freefem": program.version,
                      "gmsh": None if mesh_file else mesh.gmsh_version()}
        asked_for = {"asked": decisive(scene.values), "estimate": estimate}
        asked = asked_for | provenance | {"mesh": _sha256(mesh_file) if mesh_file else None}
        if force or _unfinished(stage) != asked:
            _clear(stage)
            _write_json(stage / "checkpoint.json", asked)

        def solve(values: dict[str, Value], where: Path) -> None:
            with _progress_line(scene.name) if progress else nullcontext() as show:
                _solve(program, scene.script, values, foreign, where, lock, show)

        try:
            solve(scene.values, stage)
            found = estimates.settle(stage, scene.values, foreign is None, solve, read_answers) if estimate else {}
        except Failure as failure:
            if _checkpoints(stage):   # a script that comes to its end, good or bad, removes it
                failure.folder = stage
            elif not isinstance(failure, TooLong) and failure.code not in (BadInput("").code, Unreadable("").code):   # these leave nothing behind
                failure.folder = _failed(folder) if finished else folder
                _keep_failed(stage, failure, scene, provenance | asked_for)
                _say_where(stage, failure.folder)
                _replace(stage, failure.folder, _same_scene(failure.folder, scene, mesh_file))
            raise
        provenance |= asked_for | {"git": _git(), "mesh": _sha256(mesh_file or stage / "mesh.msh")}
        _say_where(stage, folder)
        _finish(stage, found, provenance, pictures)
        _replace(stage, folder, _same_scene(folder, scene, mesh_file))
    return RunResult(folder, read_summary(folder), reused=False)


def _solve(program: freefem.FreeFem, script: str, values: dict[str, Value], foreign: bytes | None, where: Path, lock: int,
           show: freefem.Progress | None) -> None:
    """Runs the script with `values` in the folder `where`: from its checkpoint where there is one, not again where it is finished."""
    if (where / "summary.json").exists():
        return
    goes_on = (where / "checkpoint").exists()
    if not goes_on:
        where.mkdir(exist_ok=True)
        if not (where / "checkpoint.json").exists():   # what makes the folder ours
            _write_json(where / "checkpoint.json", values)
        _write_mesh(where / "mesh.msh", _describe(values, foreign), foreign)
    flags = [text for name, value in values.items() for text in (f"-{name}", str(value))]
    flags += ["-mesh", str(where / "mesh.msh"), "-out", str(where)]
    flags += ["-restart", str(where / "checkpoint")] if goes_on else []
    exit_code, said = freefem.run(program, script, flags, where / "log.txt", show, lock)
    _check(where, exit_code, said)


def _say_where(stage: Path, folder: Path) -> None:
    """The log names the folder that the run ends up in, not the one it was made in."""
    log = stage / "log.txt"
    log.write_text(log.read_text(errors="replace").replace(str(stage), str(shown(folder))))


# ---- what is in a folder

def read_history(folder: Path) -> dict[str, np.ndarray]:
    """The columns of history.csv by name, each (steps,); Unreadable when it is missing or no table of numbers."""
    path = folder / "history.csv"
    try:
        with open(path) as file:
            columns = file.readline().strip().split(",")
            rows = np.loadtxt(file, delimiter=",", ndmin=2)
        return dict(zip(columns, rows.T, strict=True))
    except (OSError, ValueError) as error:
        raise Unreadable(f"{path} cannot be read: {_why(error)}") from None


def read_scene(folder: Path) -> dict[str, Value]:
    """scene.toml: every parameter as used."""
    try:
        return tomllib.loads((folder / "scene.toml").read_text())
    except (OSError, ValueError) as error:
        raise Unreadable(f"{folder / 'scene.toml'} cannot be read: {_why(error)}") from None


def read_answers(folder: Path) -> tuple[dict, dict[str, Value], float]:
    """Of a finished run the summary, with largest_energy of its history [J/m], the scene as used, and the largest speed of the centre of
    mass [m/s]: what energies and velocities are measured by."""
    history = read_history(folder)
    energy = float((history["kinetic"] + history["elastic"] + history["contact"]).max())
    return read_summary(folder) | {"largest_energy": energy}, read_scene(folder), float(np.hypot(history["vx"], history["vy"]).max())


def read_summary(folder: Path) -> dict:
    """summary.json of a finished run."""
    try:
        summary = json.loads((folder / "summary.json").read_text())
        if summary["status"] != "ok":
            raise ValueError(f"status is {summary['status']!r}")
        if not isinstance(summary.get("provenance", {}), dict):
            raise ValueError("provenance is no table")
        return summary
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise Unreadable(f"{folder / 'summary.json'} cannot be read: {_why(error)}") from None


def shown(path: Path) -> Path:
    """A path for the reader: relative where it is below the working folder."""
    return path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path


def _why(error: Exception) -> str:
    return getattr(error, "strerror", None) or f"{type(error).__name__}: {error}"


# ---- reuse

def reusable(scene: Scene, folder: Path, mesh_file: Path | None = None, estimate: bool = False) -> RunResult | None:
    """The finished run in `folder` if it is of this very scene, mesh and code, with an estimate of its error where that is asked for,
    else None; Unreadable if it is not ours."""
    summary = _finished(folder, force=False)
    same = (summary and (folder / "history.csv").exists() and summary.get("provenance", {}).get("code") == code_hash()
            and (summary["provenance"].get("estimate") or not estimate) and read_scene(folder) and _same_scene(folder, scene, mesh_file))
    return RunResult(folder, summary, reused=True) if same else None


def code_hash() -> str:
    """sha256 over what decides a result besides the scene: the FreeFEM scripts and the mesh generator."""
    files = sorted(path for path in (ROOT / "edp").rglob("*") if path.suffix in (".edp", ".idp"))
    digest = hashlib.sha256()
    for path in [*files, *(ROOT / f"orchestrate/{name}.py" for name in ("mesh", "gmsh_file", "estimate"))]:
        digest.update(f"{path.relative_to(ROOT)}\n".encode() + path.read_bytes())
    return digest.hexdigest()


def _failed(folder: Path) -> Path:
    return folder.with_name(folder.name + ".failed")


def _finished(folder: Path, force: bool) -> dict | None:
    """The summary of the finished run in `folder`, None if there is none; Unreadable if the folder is not ours."""
    for path in (folder, _failed(folder)):
        if path.exists() and not path.is_dir():
            raise Unreadable(f"{path} is a file; choose another --out")
        if path.exists() and any(path.iterdir()) and not OURS & set(os.listdir(path)):
            raise Unreadable(f"{path} has files of others in it and no scene.toml; choose another --out")
    if not (folder / "summary.json").exists():
        return None
    try:
        return read_summary(folder)
    except Unreadable as error:
        if force:
            return None
        raise Unreadable(f"{error}; delete the folder, or run again with --force") from None


def _same_scene(folder: Path, scene: Scene, mesh_file: Path | None) -> bool:
    """Whether the run in `folder`, finished or failed, is one of this scene on this mesh, by whatever code."""
    name = "summary.json" if (folder / "summary.json").exists() else "failure.json"
    try:
        provenance = json.loads((folder / name).read_text())["provenance"]
        if mesh_file:
            same_mesh = provenance["mesh"] == _sha256(mesh_file)
        else:
            same_mesh = provenance["gmsh"] == mesh.gmsh_version()
        same_script, asked = provenance["script"] == scene.script, provenance["asked"]
    except (FileNotFoundError, ValueError, KeyError, TypeError):   # it does not say
        return False
    return same_mesh and same_script and asked == decisive(scene.values)


# ---- the mesh

def _describe(values: dict[str, Value], foreign: bytes | None) -> dict:
    """What the scripts say of the scene, on the mesh `foreign` (FreeFEM's .msh) where there is one; BadInput where they refuse it."""
    if foreign is None:
        return describe(values)
    with tempfile.NamedTemporaryFile(suffix=".msh") as file:
        file.write(foreign)
        file.flush()
        return describe(values | {"mesh": file.name})


def _write_mesh(path: Path, description: dict, foreign: bytes | None) -> None:
    """The mesh of a run: `foreign`, or our own, of the sizes and the part of the body that the description says."""
    if foreign is not None:
        path.write_bytes(foreign)
    else:
        sizes = (description["used"][name] for name in ("radius", "mesh_size", "contact_mesh_size"))
        mesh.write(mesh.disc(*sizes, description["half"], description["touch_arc"]), path)


# ---- the folder of a run

def result_folder(out: Path) -> Path:
    """The path of a result folder without links; Unreadable where there cannot be one."""
    try:
        folder = out.resolve()
    except (OSError, RuntimeError) as error:   # a loop of links
        raise Unreadable(f"{out} cannot be made: {getattr(error, 'strerror', None) or error}; choose another --out") from None
    if not folder.name:
        raise Unreadable(f"{out} cannot be the folder of a run; choose another --out")
    return folder


def _mesh_path(given: Path) -> Path:
    try:
        path = given.resolve()
        if path.exists() and not path.is_file():   # reading a pipe or a device might never end
            raise BadInput(f"mesh: {given} is no file")
    except (OSError, RuntimeError) as error:       # a loop of links, a name too long
        raise BadInput(f"mesh: {given} cannot be read: {getattr(error, 'strerror', None) or error}") from None
    return path


@contextmanager
def _staging(folder: Path) -> Iterator[tuple[Path, int]]:
    """The folder DIR.part and its lock, against a second run. Gone in the end, unless it has the checkpoint of a run that is not
    finished. What is in it at first was left by a run that was killed."""
    stage = folder.with_name(folder.name + ".part")
    with ExitStack() as leaving:
        leaving.callback(_take_away, [parent for parent in stage.parents if not parent.exists()])
        lock = leaving.enter_context(_open(_lock(stage, folder)))
        if not folder.exists() and _is_complete(stage):   # killed between the two renames of _replace
            os.rename(stage, folder)
            lock = leaving.enter_context(_open(_lock(stage, folder)))
        if folder.exists():
            leaving.enter_context(_open(_hold(folder, folder)))   # against a run without Python
        _refuse_files_of_others(stage)
        try:
            yield stage, lock
        finally:
            if not _checkpoints(stage):
                shutil.rmtree(stage, ignore_errors=True)


@contextmanager
def _open(file: int) -> Iterator[int]:
    try:
        yield file
    finally:
        os.close(file)


def _take_away(folders: list[Path]) -> None:
    """Removes those of the folders that are empty."""
    for folder in folders:
        try:
            folder.rmdir()
        except OSError:
            pass


def _is_complete(stage: Path) -> bool:
    try:
        return (stage / "checkpoint.json").exists() and "code" in read_summary(stage).get("provenance", {})   # the last that _finish writes
    except Unreadable:
        return False


def _refuse_files_of_others(stage: Path) -> None:
    """What a run makes has checkpoint.json from the first to the last moment; a folder of that name that lacks it is somebody's."""
    if os.listdir(stage) and not (stage / "checkpoint.json").exists():
        raise Unreadable(f"{stage}, where the run would be made, has files of others in it; choose another --out")


def _clear(stage: Path) -> None:
    for checkpoint in _checkpoints(stage):   # first: without the rest they are of no use
        checkpoint.unlink()
    for left_over in sorted(stage.iterdir(), key=lambda path: path.name == "checkpoint.json"):   # last: what makes the folder ours
        shutil.rmtree(left_over) if left_over.is_dir() else left_over.unlink()


def _checkpoints(stage: Path) -> list[Path]:
    """Those of the run in `stage`, and of the runs that estimate its error."""
    return [path for path in (stage / "checkpoint", *stage.glob("*/checkpoint")) if path.exists()]


def _unfinished(stage: Path) -> dict | None:
    """What the run was asked for whose checkpoint is in `stage`, None if there is none; Unreadable if it does not say."""
    if not _checkpoints(stage):
        return None
    try:
        return json.loads((stage / "checkpoint.json").read_text())
    except (OSError, ValueError) as error:
        raise Unreadable(f"{stage / 'checkpoint.json'} cannot be read: {_why(error)}; delete {shown(stage)} to start from the "
                         "beginning, or run with --force") from None


def _lock(stage: Path, folder: Path) -> int:
    """The open folder `stage`, made if need be and locked; Busy where another run holds it."""
    while True:
        try:
            stage.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise Unreadable(f"{stage} cannot be made: {error.strerror}; choose another --out") from None
        try:
            lock = _hold(stage, folder)
        except FileNotFoundError:   # its run has just put it in its place
            continue
        try:
            if os.path.samestat(os.fstat(lock), os.stat(stage)):
                return lock
        except FileNotFoundError:   # likewise, while we locked it
            pass
        os.close(lock)


def _hold(path: Path, folder: Path) -> int:
    """The folder `path` opened and locked; Busy where a run in `folder` holds it."""
    lock = os.open(path, os.O_RDONLY)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(lock)
        raise Busy(f"{folder} is being written by another run; wait, or choose another --out") from None
    return lock


def _replace(stage: Path, folder: Path, same: bool) -> None:
    """Puts `stage` in the place of `folder`, complete or not at all.

    What was there stays as DIR.1 (.2 ...); where it is of the `same` scene, what the program wrote there goes, and what else is there moves over.
    """
    earlier = None
    if folder.exists() and any(folder.iterdir()):
        earlier = next(place for n in itertools.count(1) if not os.path.lexists(place := folder.with_name(f"{folder.name}.{n}")))
        os.rename(folder, earlier)
    os.rename(stage, folder)
    (folder / "checkpoint.json").unlink(missing_ok=True)
    if earlier and not (same and _merge(earlier, folder)):
        print(f"what was in {shown(folder)} before is now in {shown(earlier)}")


def _merge(earlier: Path, folder: Path) -> bool:
    """Takes away what the program wrote in `earlier`, moves the rest to `folder`; False where something is in the way there."""
    (earlier / "summary.json").unlink(missing_ok=True)        # first: no longer a finished run
    for path in sorted(earlier.rglob("*"), reverse=True):     # what is in a folder, then the folder
        name = path.relative_to(earlier).as_posix()
        if path.is_dir() and not path.is_symlink():
            if not any(path.iterdir()):
                path.rmdir()
        elif any(fnmatch.fnmatchcase(name, own) for own in OWN):
            path.unlink()
        elif not os.path.lexists(folder / name):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            os.rename(path, folder / name)
    if any(earlier.iterdir()):
        return False
    earlier.rmdir()
    return True


def _check(stage: Path, exit_code: int, said: str) -> None:
    """Failure unless FreeFem++ ended well AND left a finished summary and a finite history (0 alone says little).

    Its code is that of the process, its words those of the failure.json that the script wrote, else what it `said`.
    """
    if exit_code == 0:
        try:
            read_summary(stage)
            history = read_history(stage)
        except Unreadable as error:
            problem = str(error).replace(f"{stage}/", "")
            raise Failure(f"FreeFem++ ended without a result: {problem}; {_tail(stage)}") from None
        for name, column in history.items():
            if not np.isfinite(column).all():
                raise Failure(f"history.csv: {name} is not finite from row {1 + np.argmin(np.isfinite(column))} on")
        return
    log = (stage / "log.txt").read_text()
    said = _read_json(stage / "failure.json").get("message") or said
    if exit_code in FAILURES and said:
        raise Failure(said, exit_code)
    if "Load error" in log:
        raise Failure(f"FreeFem++ lacks a plugin: {_tail(stage)}; {freefem.HOW}", 13)
    how = f"was killed by {signal.Signals(-exit_code).name}" if exit_code < 0 else f"stopped with exit code {exit_code}"
    goes_on = "; the same command goes on from the last checkpoint" if (stage / "checkpoint").exists() else ""
    raise Failure(f"FreeFem++ {how}; {_tail(stage)}{goes_on}")


def _tail(stage: Path) -> str:
    lines = [line.strip() for line in (stage / "log.txt").read_text().splitlines()]
    return "end of its log: " + " | ".join([line for line in lines if line and not line.startswith("progress ")][-4:])


def _finish(stage: Path, found: dict, provenance: dict, pictures: bool) -> None:
    """Figures, then the summary with what was `found` beside the run and its provenance, last and by rename."""
    summary = read_summary(stage)
    found["warnings"] = summary.get("warnings", []) + found.get("warnings", [])
    if found.get("estimated_error"):
        summary["skipped"] = [name for name in summary["skipped"] if name != "error estimate"]
    summary |= {"estimated_error": None} | found | {"provenance": provenance}
    (stage / "summary.json").unlink()
    _write_json(stage / "summary.json.part", summary)
    if pictures:
        from .report import figures
        try:
            figures.draw(stage, summary["warnings"])
        except Exception as error:   # a picture is no reason to lose a run
            print(f"ffimpact: the figures could not be drawn: {error!r}", file=sys.stderr)
    os.replace(stage / "summary.json.part", stage / "summary.json")


def _keep_failed(stage: Path, failure: Failure, scene: Scene, provenance: dict) -> None:
    """failure.json: the one the script wrote, or what is known; never a summary.json."""
    (stage / "summary.json").unlink(missing_ok=True)
    if not (stage / "scene.toml").exists():
        (stage / "scene.toml").write_text("".join(f"{name} = {json.dumps(value)}\n" for name, value in scene.values.items()))
    record = {"status": FAILURES.get(failure.code, "crashed"), "message": str(failure)} | _read_json(stage / "failure.json")
    _write_json(stage / "failure.json", record | {"exit_code": failure.code, "provenance": provenance})


def _read_json(path: Path) -> dict:
    """What is in a file, {} where there is none or it makes no sense."""
    try:
        content = json.loads(path.read_text())
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) else {}


def _write_json(path: Path, content: dict) -> None:
    path.write_text(json.dumps(content, indent=2) + "\n")


@contextmanager
def _progress_line(name: str) -> Iterator[freefem.Progress]:
    """One line on stderr, gone at the end."""
    from tqdm import tqdm
    with tqdm(total=1.0, desc=name, leave=False, bar_format="{desc} {percentage:3.0f}% |{bar}| {elapsed}{postfix}") as line:
        def show(fraction: float, t: str, steps: str) -> None:
            line.n = min(max(fraction, line.n), 1.0) if math.isfinite(fraction) else line.n
            line.set_postfix_str(f"t = {float(t) * 1e3:.3f} ms, {steps} steps")
        yield show


# ---- provenance

def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _git() -> str:
    """The commit, with -dirty where the tree differs from it."""
    try:
        return subprocess.run(["git", "describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"], cwd=ROOT,
                              capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
