"""What the FreeFEM scripts say of themselves, of a scene and of its results: asked of
edp/describe*.edp, never read from their source.
"""

import copy
import json
import subprocess
from functools import cache

from ..failure import BadInput, NotInstalled
from . import freefem

__all__ = ["describe", "describe_results"]

LIMIT = 60  # s; an answer takes some tenths


def describe(values: dict | None = None, script: str = "disc-plane") -> dict:
    """The answer of edp/describe.edp to the parameters in `values` of a scene of
    edp/<script>.edp: scripts, parameters (rows of the table), and of the scene bodies (how
    many), `used` (every parameter as used, SI units), half (is half the body enough?),
    touch_arc [rad], accuracy_made.

    BadInput where the script refuses the values; NotInstalled without FreeFem++.
    """
    if not values and script == "disc-plane":
        return copy.deepcopy(freefem.find().description)
    return json.loads(
        _ask(freefem.DESCRIBE, *freefem.words_of({"script": script} | (values or {})))
    )


def describe_results(values: dict | None = None, script: str = "disc-plane") -> dict:
    """The answer of edp/describe-results.edp for the same: bodies, columns (of history.csv),
    summary (the numbers of summary.json), body_columns and body_summary (of each of several
    bodies), damped (what all four have beside, where bodies are damped), projected (what both
    columns have where volume is projected, of nu above plain_nu), contact_columns (of
    contacts.csv), and by file and name `meanings`: unit, words. Raises as describe().
    """
    return json.loads(
        _ask("edp/describe-results.edp", *freefem.words_of({"script": script} | (values or {})))
    )


@cache
def _ask(asked: str, *flags: str) -> str:
    program = freefem.find()
    try:
        answer = program.call(asked, *flags, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        raise NotInstalled(
            f"{program.command} does not finish {asked} in {LIMIT} s; the machine is too busy, or {freefem.HOW}"
        ) from None
    if answer.returncode == 0:
        return answer.stdout
    if answer.returncode == 10 and (said := freefem.said_in(answer.stderr)):
        raise BadInput(said)
    raise NotInstalled(
        f"{program.command} does not run {asked} (exit code {answer.returncode}); {freefem.HOW}"
    )
