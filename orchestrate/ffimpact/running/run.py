"""Runs one scene in one result folder, as the run contract states.

A failed run leaves its files for inspection (log.txt, history.csv, scene.toml, failure.json) in the
folder DIR. If DIR holds an earlier finished run, the files of the failed run go to DIR.failed. The
module output/folder.py makes, locks and replaces folders.
"""

import hashlib
import json
import logging
import math
import os
import re
import subprocess
import time
from collections.abc import Iterable
from dataclasses import replace as changed
from functools import cache
from pathlib import Path

from .. import __version__
from ..failure import BadInput, Failure, TooLong, Unreadable
from ..freefem import freefem
from ..input.parameters import Table, Value
from ..input.toml_text import to_toml
from ..mesh import mesh
from ..output import estimate as estimates, notes
from ..output.fields import write_fields
from ..output.folder import (
    checkpoints,
    clear,
    failed_beside,
    finished_in,
    replace,
    result_folder,
    staging,
    unfinished,
)
from ..output.results import (
    Record,
    check_files,
    digest,
    files_of,
    read_answers,
    read_history,
    read_json,
    read_scene,
    read_summary,
    write_json,
)
from ..places import INSTALLED, PACKAGE, RESULTS, ROOT, shown
from ..progress import Line, work
from ..scene import Scene, load
from ..scenes.mirror import symmetric_along
from .forecast import cure, runs
from .outcome import FAILURES
from .plan import Plan, measure
from .solver import LAST_STATE, Earlier, Solver, Watch

log = logging.getLogger("ffimpact")

__all__ = [
    "DECISIVE",
    "states",
    "code_hash",
    "commit",
    "extended",
    "plan",
    "reusable",
    "run",
]

SCRIPTS = (".edp", ".idp", ".hpp", ".cpp")
STOPPED = "stopped"  # entry `ended` of a run that `watch` has ended
STATES = 60  # states that a run keeps by default, for figures and the player
# Folders of the package on which results depend: what makes mesh and scene, and starts the solver.
DECISIVE = ("freefem", "geometry", "input", "mesh", "scenes")
# Modules of other folders on which the error estimates depend.
ESTIMATING = ("output/estimate", "output/notes", "output/rest", "output/results")


def run(
    scene: Scene,
    overrides: dict[str, Value] | None = None,
    out: Path | str | None = None,
    *,
    force: bool = False,
    progress: bool | None = None,
    estimate: bool = True,
    watch: Watch | None = None,
    earlier: Earlier | None = None,
) -> Record:
    """Runs `scene`, with the parameters `overrides`, in the folder `out` (default:
    results/<scene>), or reuses the finished run in that folder. Returns the Record of the run.

    `force` runs again from the start, even if the folder is up to date. Otherwise an interrupted
    run continues from its last checkpoint. Progress is shown unless `progress` is False
    (progress.py). With `estimate` coarser runs estimate the error; finer runs follow until the
    error is below the requested accuracy (output/estimate.py). If `watch` ends the run, it has no
    estimate and is never reused. With `earlier` the run goes on from the end of an earlier one, of
    the same scene up to end_time. Raises Failure with the exit code of the run contract.
    """
    started = time.monotonic()
    scene = scene.override(overrides or {})
    folder = result_folder(Path(out or RESULTS / scene.name))
    finished = finished_in(folder, force)
    if not force and (there := reusable(scene, folder, estimate)):
        if watch:
            log.warning("%s: is reused, so watch sees nothing (force=True runs it again)", folder)
        return there

    program = freefem.find()
    mesh.start_gmsh()
    with Line(scene.name, runs(estimate), progress) as line, staging(folder) as (stage, lock):
        # Another process may have finished the run in the meantime.
        if not force and (there := reusable(scene, folder, estimate)):
            return there
        provenance = {
            "script": scene.kind.script,
            "version": __version__,
            "code": code_hash(),
            "freefem": program.version,
            "gmsh": mesh.start_gmsh().__version__,
        }
        request_entries = {
            "asked": scene.decisive_entries,
            "estimate": estimate and _estimate_hash(),
        } | ({"extends": read_summary(earlier.folder)["provenance"]["summary"]} if earlier else {})
        request = request_entries | provenance
        if force or unfinished(stage) != request:
            clear(stage)
            write_json(stage / "checkpoint.json", request)

        try:
            with Solver(program, scene, stage, lock, line, estimate, watch, earlier) as solve:
                solve({}, stage)
                estimate = estimate and not solve.stopped
                estimated = (
                    estimates.settle(
                        stage,
                        scene.values | scene.sizes,
                        solve.own_mesh,
                        solve,
                        read_answers,
                        solve.scaled,
                    )
                    if estimate
                    else {}
                )
        except Failure as failure:
            # A script that reaches its end, with success or failure, removes its checkpoint.
            if checkpoints(stage):
                failure.folder = stage
            # Failures of these three kinds leave no files.
            elif failure.code not in (TooLong.code, BadInput.code, Unreadable.code):
                failure.folder = failed_beside(folder) if finished else folder
                write_fields(stage)
                _keep_failed(stage, failure, scene, provenance | request_entries)
                _put(stage, failure.folder, scene)
            raise
        provenance |= request_entries | {
            "git": commit(code=provenance["code"]),
            "mesh": _sha256(stage / scene.mesh_name),
        }
        write_fields(stage)
        _tell_used(stage / "scene.toml", scene)
        # also if the run has come to its end before it was seen that it was asked to stop
        estimated |= {"ended": STOPPED} if solve.stopped else {}
        _finish(stage, scene, estimated | {"total_seconds": time.monotonic() - started}, provenance)
        _put(stage, folder, scene)
    return Record(folder, read_summary(folder), reused=False)


def extended(folder: Path, summary: Table, end_time: Value) -> tuple[Scene, Earlier]:
    """Returns the scene of the finished run in `folder` with a later end_time, and the run from whose
    end it goes on. Raises BadInput or Unreadable if it cannot go on.
    """
    if not (folder / LAST_STATE).exists() or summary["provenance"].get("code") != code_hash():
        raise Unreadable(
            f"{folder}: its end is not that of a run of this version, so it cannot go on (accepted: run it again)"
        )
    earlier = Earlier(folder, load(folder / "scene.toml"))
    scene = earlier.scene.override({"end_time": end_time})
    reached = float(read_history(folder)["t"][-1])
    if (later := scene.number("end_time")) <= reached:
        raise BadInput(
            f"end_time: {later:g} is not after the end of the run (accepted: above {reached:.9g} s)"
        )
    return scene, earlier


def plan(
    scene: Scene,
    overrides: dict[str, Value] | None = None,
    *,
    estimate: bool = True,
) -> Plan:
    """Foretells what run() with these arguments will take. Writes nothing. Raises Failure as
    run().
    """
    scene = scene.override(overrides or {})
    mesh.start_gmsh()
    with work("foretelling the run"):
        made = measure(scene, estimate)
    if not made.is_long:
        return made
    with work("seeking an entry that makes the run short"):
        return changed(made, advice=cure(scene, made.total_seconds, estimate))


def states(scene: Scene) -> dict[str, Value]:
    """Returns the default of the entry `fields` if the scene leaves it open, else nothing."""
    return {"fields": STATES} if scene.fields is None else {}


def _put(stage: Path, folder: Path, scene: Scene) -> None:
    """Moves a run from `stage` to `folder`. In its log the path of `stage` is replaced by that of
    `folder`.
    """
    log = stage / "log.txt"
    log.write_text(log.read_text(errors="replace").replace(str(stage), str(shown(folder))))
    replace(stage, folder, _same_scene(folder, scene))


def _tell_used(path: Path, scene: Scene) -> None:
    """Puts the integrator that `auto` took into scene.toml, and tells in comments what was
    requested where other values were used: the integrator, and the accuracy if finer runs made the
    answer.
    """
    used, taken = read_scene(path.parent), read_summary(path.parent)["integrator"]
    text = path.read_text("utf-8")
    if not math.isclose(used["accuracy"], accuracy := scene.number("accuracy")):
        why = f"requested: {accuracy:g}; mesh and steps are those of this value, for the estimated error"
        text = re.sub(r"(?m)^(accuracy = \S+)\n", rf"\1   # {why}\n", text, count=1)
    if used["integrator"] != taken:
        line = f'integrator = "{taken}"   # requested: {used["integrator"]}\n'
        text = re.sub(r"(?m)^integrator = \S+\n", line, text, count=1)
    path.write_text(text, "utf-8")


def _finish(stage: Path, scene: Scene, estimated: Table, provenance: Table) -> None:
    """Adds the results `estimated` of the error estimate and the provenance to summary.json. The
    complete file is put in place by a rename, as the last step.
    """
    summary = read_summary(stage)
    estimated |= notes.settled(
        *(summary.get(kind, []) + estimated.get(kind, []) for kind in ("warnings", "notes"))
    )
    estimated["skipped"] = estimated.get("skipped", []) + [
        name
        for name in summary["skipped"]
        if name != "error estimate" or not estimated.get("estimated_error")
    ]
    summary |= (
        {
            "estimated_error": None,
            "released": list(scene.released),
            "symmetric_along": symmetric_along(scene),
        }
        | estimated
        | {"provenance": provenance | {"files": files_of(stage)}}
    )
    summary["provenance"]["summary"] = digest(summary)
    (stage / "summary.json").unlink()
    write_json(stage / "summary.json.part", summary)
    os.replace(stage / "summary.json.part", stage / "summary.json")


def _keep_failed(stage: Path, failure: Failure, scene: Scene, provenance: Table) -> None:
    """Writes failure.json with the entries that the script wrote, or else with status and message
    of the failure. Removes summary.json.
    """
    (stage / "summary.json").unlink(missing_ok=True)
    if not (stage / "scene.toml").exists():
        (stage / "scene.toml").write_text(
            to_toml(scene.with_files_in(stage, scene.content)), "utf-8"
        )
    record = {"status": FAILURES.get(failure.code, "crashed"), "message": str(failure)} | read_json(
        stage / "failure.json"
    )
    write_json(
        stage / "failure.json", record | {"exit_code": failure.code, "provenance": provenance}
    )


# ---- reuse


def reusable(scene: Scene, folder: Path, estimate: bool = False) -> Record | None:
    """Returns the finished run in `folder` if it has the same scene and code, and an error
    estimate where `estimate` is set; else None. Raises Unreadable if the folder was not written by
    this program.
    """
    summary = finished_in(folder, force=False)
    if (
        summary
        and (folder / "history.csv").exists()
        and summary.get("provenance", {}).get("code") == code_hash()
        and (summary["provenance"].get("estimate") == _estimate_hash() or not estimate)
        and summary.get("ended") != STOPPED
        and read_scene(folder)
        and _same_scene(folder, scene)
    ):
        check_files(folder)
        return Record(folder, summary, reused=True)
    return None


def code_hash() -> str:
    """Returns the sha256 of the code that results depend on besides the scene: the FreeFEM scripts,
    their kernels and the Python modules in the folders DECISIVE.
    """
    scripts = [path for path in (ROOT / "edp").rglob("*") if path.suffix in SCRIPTS]
    modules = [path for folder in DECISIVE for path in (PACKAGE / folder).glob("*.py")]
    return _hash(sorted(scripts) + sorted(modules))


def _estimate_hash() -> str:
    return _hash(PACKAGE / f"{module}.py" for module in ESTIMATING)


def _hash(files: Iterable[Path]) -> str:
    digest = hashlib.sha256()
    for path in files:
        digest.update(f"{path.name}\n".encode() + path.read_bytes())
    return digest.hexdigest()


def _same_scene(folder: Path, scene: Scene) -> bool:
    """Returns whether the finished or failed run in `folder` has this scene, whatever the version of
    the code.
    """
    name = "summary.json" if (folder / "summary.json").exists() else "failure.json"
    try:
        provenance = json.loads((folder / name).read_text())["provenance"]
        same_mesh = provenance["gmsh"] == mesh.start_gmsh().__version__
        same_script, request = provenance["script"] == scene.kind.script, provenance["asked"]
    except (FileNotFoundError, ValueError, KeyError, TypeError):  # it has no such record
        return False
    return bool(same_mesh and same_script and request == scene.decisive_entries)


# ---- provenance


def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


@cache
def commit(digits: int = 40, code: str = "") -> str:
    """Returns the git commit, with -dirty if the source tree differs from it. git is asked once for
    each `code`, of which the argument is a hash. If the program is installed, the answer is
    "unknown": the surrounding folder may belong to another repository.
    """
    if INSTALLED:
        return "unknown"
    try:
        return subprocess.run(
            ["git", "describe", "--always", "--dirty", f"--abbrev={digits}", "--exclude=*"],
            cwd=ROOT,
            capture_output=True,
            text=True,
            check=True,
        ).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
