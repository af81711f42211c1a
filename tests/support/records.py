"""Records of small runs in tests/records, evaluated without FreeFEM: two discs with friction that meet
off their centres, a disc that hits the plane obliquely with friction, a quarter of a ball in space, a
ball of revolution with modes, and a disc that falls until it rests. `python -m tests.support.records` makes them again.
"""

import json
import shutil
import tarfile
import tempfile
from pathlib import Path

import ffimpact as ff
from ffimpact import scene
from ffimpact.freefem import freefem
from ffimpact.output.evaluate import evaluate
from ffimpact.scenes import assembly
from ffimpact.scenes.mirror import symmetric_along

RECORDS = Path(__file__).parents[1] / "records"
FILES = ("record.json", "scene.toml", "history.csv", "contacts.bin", "states.bin", "modes.bin")
FALL = {"law": "neohookean", "loss": 4, "loss_model": "kelvin-voigt", "speed": 0, "gravity": 9.81, "until": "rest", "body.1.position.2": 0.06}
RUNS = {
    "slide": ("disc-oblique", {"fields": 3, "degree": 1}),
    "discs": ("two-discs", {"fields": 2, "contact.friction_static": 0.3}),
    "ball": ("ball", {"fields": 2, "degree": 1, "mesh_size": 0.04, "contact_mesh_size": 0.03}),
    "axisymmetric": ("ball-axisymmetric", {"fields": 3, "modes": 4}),
    "rest": ("disc-normal", {"fields": 0} | FALL),
}


def evaluated(name: str, folder: Path) -> ff.Result:
    """The record, evaluated in the folder."""
    shutil.unpack_archive(RECORDS / f"{name}.tar.xz", folder)
    evaluate(folder)
    return ff.load(folder)


def make(name: str, folder: Path) -> None:
    """Runs the scene by FreeFEM alone and packs its record, with entries that the program adds."""
    of, values = RUNS[name]
    loaded, raw = scene.load(of).override({"accuracy": 0.4} | values), folder / "raw"
    flags, _, used = assembly.prepare(loaded, folder)
    program = freefem.find()
    ended = program.call(f"edp/program/{loaded.kind.script}.edp", *freefem.words_of(flags | {"out": raw}))
    assert ended.returncode == 0, ended.stderr
    (raw / "scene.toml").write_text(used)
    record = json.loads((raw / "record.json").read_text())
    added = {"script": loaded.kind.script, "version": ff.__version__, "asked": {}, "estimate": False}
    record |= {"estimated_error": None, "released": [], "total_seconds": 1.0}
    record |= {"symmetric_along": symmetric_along(loaded), "provenance": added}
    (raw / "record.json").write_text(json.dumps(record))
    with tarfile.open(RECORDS / f"{name}.tar.xz", "w:xz", preset=9) as packed:
        for file in FILES:
            if (raw / file).exists():
                packed.add(raw / file, file)


if __name__ == "__main__":
    for name in RUNS:
        with tempfile.TemporaryDirectory() as folder:
            make(name, Path(folder))
