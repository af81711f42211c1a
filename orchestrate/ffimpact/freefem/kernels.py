"""Builds the compiled kernels of edp/kernels as a plugin for the installed FreeFem++. A word on the
command line of a script loads the plugin.
"""

import re
import shutil
import subprocess
from collections.abc import Mapping
from functools import partial
from pathlib import Path

from ..places import ROOT
from .compiled import QUIET, compiled

__all__ = ["HOW", "SOURCES", "build"]

SOURCES = ROOT / "edp/kernels"
LIBRARIES = ("-lcholmod", "-lumfpack")
HOW = (
    "they need g++, ff-c++ and the headers of FreeFem++, SuiteSparse and Eigen, and a cache folder "
    "(XDG_CACHE_HOME) that can be written: apt-get install g++ libfreefem++-dev libsuitesparse-dev "
    "libeigen3-dev"
)
# Compiler flags, tried in this order. Without OpenMP the kernels use one thread.
THREADS = ("-fopenmp",), ()


def build(command: str, version: str, environment: Mapping[str, str]) -> str:
    """Returns the command-line word with which a script loads the plugin of the present sources for
    this FreeFem++. If the plugin is missing, ff-c++ builds it: that in the folder of FreeFem++ or,
    where FreeFem++ is a script elsewhere, that of the search path. The word is empty if that fails.
    """
    beside = Path(command).resolve().with_name("ff-c++")
    maker = beside if beside.exists() else Path(shutil.which("ff-c++") or beside)
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
    # The version of the interface through which the scripts call the kernels.
    interface = re.search(
        r"(?m)^load (kernels\d+)$", (ROOT / "edp/program/kernels.idp").read_text()
    )[1]
    # FreeFEM puts its own folders before any name, so that the path first leads up to the root.
    return f'-D{interface}="{"../" * 40}{str(plugin.with_suffix("")).lstrip("/")}"'


def _make(command: str, maker: Path, environment: Mapping[str, str], folder: Path) -> None:
    """Builds kernels.so in a folder and checks that FreeFem++ loads it. Raises OSError or
    subprocess.SubprocessError.
    """
    # Compiles a copy in `folder`, because names of other folders may confuse ff-c++.
    shutil.copytree(SOURCES, folder, dirs_exist_ok=True)
    for flags in THREADS:
        made = subprocess.run(
            [maker, *flags, "kernels.cpp", *LIBRARIES],
            cwd=folder,
            env=environment,
            check=not flags,
            timeout=1800,
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
