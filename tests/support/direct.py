"""Helpers that start FreeFem++ themselves, on a scene that Python has prepared."""

import subprocess
import tempfile
from functools import cache
from pathlib import Path

from ffimpact.freefem import freefem
from ffimpact.input import parameters
from ffimpact.output.evaluate import evaluate
from ffimpact.scene import read
from ffimpact.scenes import assembly
from ffimpact.scenes.entries import toml_value
from verification.measure import impact

COARSE = ("-law", "neohookean", "-nu", "0.4", "-accuracy", "0.4")
OF_THE_RUN = ("out", "restart")  # flags that are no entries of the scene
_FOLDERS: list[tempfile.TemporaryDirectory] = []


@cache
def _prepared(kind: str, entries: tuple) -> tuple[str, dict]:
    """The script and the flags of an impact with these entries. Its mesh and scene.bin are in a folder of their own."""
    _FOLDERS.append(tempfile.TemporaryDirectory())
    folder = Path(_FOLDERS[-1].name)
    scene = read(impact(kind, **dict(entries)), folder, kind)
    return scene.kind.script, assembly.prepare(scene, folder)[0]


def case(values: dict, kind: str = "disc") -> tuple[str, ...]:
    """Script and flags of an impact with these entries (verification.measure.impact()) and flags of the run.

    With `scene`, a file, `values` are the flags of the script edp/program/<kind>.edp."""
    if "scene" in values:
        return str(parameters.ROOT / f"edp/program/{kind}.edp"), *freefem.words_of(values)
    entries = tuple((name, toml_value(value)) for name, value in values.items() if name not in OF_THE_RUN)
    script, flags = _prepared(kind, entries)
    of_the_run = {name: value for name, value in values.items() if name in OF_THE_RUN}
    return str(parameters.ROOT / f"edp/program/{script}.edp"), *freefem.words_of(flags | of_the_run)


def used(values: dict, kind: str = "disc") -> dict:
    """The entries of the first body, of the contact and of the scene of such an impact, as used."""
    tables = assembly.assemble(read(impact(kind, **values), parameters.ROOT, kind)).used
    return tables | tables["contact"] | tables["body"][0]


def words(values: dict, kind: str = "disc") -> list[str]:
    """The command of FreeFem++ for such an impact."""
    return freefem.find().words(*case(values, kind))


def start(*flags: str, cwd: Path, kind: str = "disc", **options) -> subprocess.Popen:
    values = dict(zip((flag.removeprefix("-") for flag in flags[::2]), flags[1::2]))
    return subprocess.Popen(words(values, kind), cwd=cwd, text=True, env=freefem.find().environment, stdin=subprocess.DEVNULL,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)


def call(*flags: str, cwd: Path, **options) -> tuple[int, str, str]:
    process = start(*flags, cwd=cwd, **options)
    out, error = process.communicate(timeout=60)
    if "-out" in flags[:-1]:
        evaluate(cwd / flags[flags.index("-out") + 1])
    return process.returncode, out, error
