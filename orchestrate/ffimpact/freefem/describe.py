"""Queries the FreeFEM script edp/program/outline.edp, which checks mesh files and finds their
circles.
"""

import json
import subprocess
from pathlib import Path
from typing import Any

from ..failure import BadInput, NotInstalled
from . import freefem

__all__ = ["outline_of"]

LIMIT = 60  # time limit of a query [s]


def outline_of(mesh: Path) -> dict[str, Any]:
    """Returns the circles of a mesh file (x, y, radius) [m] and the number of the circle of each of
    its boundary edges, -1 for a straight one: circles, circle_of.

    Raises BadInput if edp/program/outline.edp refuses the mesh, and NotInstalled without FreeFem++.
    """
    answer: dict[str, Any] = json.loads(_answer("edp/program/outline.edp", "-mesh", str(mesh)))
    return answer


def _answer(script: str, *flags: str) -> str:
    program = freefem.find()
    try:
        answer = program.call(script, *flags, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        raise NotInstalled(
            f"{program.command} does not finish {script} in {LIMIT} s; "
            f"the machine is too busy, or {freefem.HOW}"
        ) from None
    if answer.returncode == 0:
        return answer.stdout
    if answer.returncode == 10 and (message := freefem.said_in(answer.stderr)):
        raise BadInput(message)
    raise NotInstalled(
        f"{program.command} does not run {script} (exit code {answer.returncode}); {freefem.HOW}"
    )
