"""Queries the FreeFEM script edp/program/describe.edp, which describes the scripts and a scene. The
source of the scripts is never parsed.
"""

import copy
import json
import subprocess
from functools import cache

from ..failure import BadInput, NotInstalled
from . import freefem

__all__ = ["describe"]

LIMIT = 60  # time limit of a query [s]


def describe(values: dict | None = None, script: str = "disc-plane") -> dict:
    """Returns the answer of edp/program/describe.edp for a scene of edp/program/<script>.edp with the parameters
    `values`: scripts, parameters (rows of the table), bodies (number of bodies), `used` (every
    parameter with the value that is used, SI units), half (whether half the body is sufficient),
    touch_arc [rad] and accuracy_made.

    Raises BadInput if the script refuses the values, and NotInstalled without FreeFem++.
    """
    if not values and script == "disc-plane":
        return copy.deepcopy(freefem.find().description)
    return json.loads(
        _ask(freefem.DESCRIBE, *freefem.words_of({"script": script} | (values or {})))
    )


@cache
def _ask(script: str, *flags: str) -> str:
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
