"""The compiled kernels of edp/kernels: a plugin built for the FreeFem++ at hand, where a compiler
is, and named on its command line.
"""

import re
import shutil
import subprocess
from collections.abc import Mapping
from functools import partial
from pathlib import Path

from ..places import ROOT
from .compiled import QUIET, compiled

__all__ = ["SOURCES", "build"]

SOURCES = ROOT / "edp/kernels"
LIBRARIES = ("-lcholmod", "-lumfpack")
THREADS = ("-fopenmp",), ()  # where the compiler has no OpenMP: one thread


def build(command: str, version: str, environment: Mapping[str, str]) -> str:
    """The word on a command line with which a script loads the plugin made of the present
    sources for this FreeFem++. The plugin is built where it is missing, by the ff-c++ beside
    FreeFem++. Where that fails the word is empty, and the scripts run without kernels.
    """
    maker = Path(command).resolve().with_name("ff-c++")
    if not maker.exists():
        return ""
    made_of = [
        version,
        str(maker),
        str(maker.stat().st_mtime_ns),
        *(path.read_text() for path in sorted(SOURCES.iterdir())),
    ]
    plugin = compiled("kernels.so", made_of, partial(_make, command, maker, environment))
    if not plugin or re.search(r'["\\\n]', str(plugin)):
        return ""
    interface = re.search(r"IFMACRO\((kernels\d+)\)", (ROOT / "edp/kernels.idp").read_text())[
        1
    ]  # the calls that the scripts know
    # FreeFEM puts its own folders before any name: from each of them up to the root
    return f'-D{interface}="{"../" * 40}{str(plugin.with_suffix("")).lstrip("/")}"'


def _make(command: str, maker: Path, environment: Mapping[str, str], folder: Path) -> None:
    """kernels.so in a folder, tried."""
    shutil.copytree(
        SOURCES, folder, dirs_exist_ok=True
    )  # the names of other folders may confuse ff-c++
    for flags in THREADS:
        made = subprocess.run(
            [maker, *flags, "kernels.cpp", *LIBRARIES],
            cwd=folder,
            env=environment,
            check=not flags,
            timeout=300,
            **QUIET,
        )
        if made.returncode == 0:
            break
    (folder / "try.edp").write_text('load "./kernels"\n')
    subprocess.run(
        [command, "-nw", "-ne", "-v", "0", "try.edp"],
        cwd=folder,
        env=environment,
        check=True,
        timeout=60,
        **QUIET,
    )
