"""What the process of a run has left: a finished record, or the reason of its failure."""

import signal
from pathlib import Path

import numpy as np

from ..failure import Failure, NotInstalled, Unreadable, of_code
from ..freefem import freefem
from ..output.results import read_history, read_json, read_summary

__all__ = ["FAILURES", "check"]

FAILURES = {
    10: "bad input",
    11: "step failed",
    12: "material broke down",
    13: "not installed",
    14: "unreadable",
}


def check(stage: Path, exit_code: int, message: str) -> None:
    """Raises Failure unless FreeFem++ ended with exit code 0 and left a finished summary and a
    finite history. The exit code 0 alone does not prove success.

    The failure has the exit code of the process. Its message is that of the failure.json that the
    script wrote, or else `message`.
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
                raise Failure(
                    f"history.csv: {name} is not finite from row {1 + np.argmin(np.isfinite(column))} on"
                )
        return
    log = (stage / "log.txt").read_text(errors="replace")
    message = read_json(stage / "failure.json").get("message") or message
    if exit_code in FAILURES and message:
        raise of_code(exit_code, message)
    if exit_code == -signal.SIGXFSZ:
        raise Unreadable(
            "out: a file of the run is larger than files may be here; raise ulimit -f, or ask for fewer fields or steps"
        )
    if "Load error" in log:
        raise NotInstalled(f"FreeFem++ lacks a plugin: {_tail(stage)}; {freefem.HOW}")
    how = (
        f"was killed by {signal.Signals(-exit_code).name}"
        if exit_code < 0
        else f"stopped with exit code {exit_code}"
    )
    goes_on = (
        "; the same command goes on from the last checkpoint"
        if (stage / "checkpoint").exists()
        else ""
    )
    raise Failure(f"FreeFem++ {how}; {_tail(stage)}{goes_on}")


def _tail(stage: Path) -> str:
    lines = [line.strip() for line in (stage / "log.txt").read_text(errors="replace").splitlines()]
    ending = (
        [line for line in lines if line and not line.startswith(("progress ", "body "))]
        or lines[-1:]
        or ["nothing"]
    )
    return "end of its log: " + " | ".join(ending[-4:])
