"""What the page of the paper's statements is made from: the targets of make, one after another in this process, with one line of progress
for all."""

import os
import re
import shlex
import subprocess

from .. import __main__ as program
from ..failure import BadInput
from ..places import ROOT
from ..progress import Line

# about how long each takes on two cores [s], for the time left; whatever is not named: USUAL
SECONDS = {"disc-normal": 3, "disc-oblique": 40, "disc-rolling": 10, "friction-laws": 3, "oblique": 36, "friction-jump": 6,
           "friction-steps": 11, "slip-limit": 6, "contact-time-svk": 90, "law-comparison": 6, "contact-time-neohookean": 90, "pairing": 15,
           "calibrate": 115, "calibrate-oblique": 62, "calibrate-ball": 13, "calibrate-ball-3d": 27, "conservation": 8, "stick-slip": 70,
           "verify": 200}
USUAL = 20


def make(targets: list[str]) -> int:
    """Runs what make would run for each; the exit code of the first that fails, else 0."""
    wanted = {target: commands(target) for target in targets}
    with Line("paper", {target: SECONDS.get(target, USUAL) for target in targets}) as line:
        for k, (target, each) in enumerate(wanted.items(), 1):
            with line.part(target, f"{k} of {len(wanted)}"):
                for words in each:
                    if code := program.main(words):
                        return code
    return 0


def commands(target: str) -> list[list[str]]:
    """The words after `python -m orchestrate` in each line of the recipe of a target."""
    plain = {name: value for name, value in os.environ.items() if name not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL")}
    said = subprocess.run(["make", "-n", "-s", target, "ARGS="], cwd=ROOT, env=plain, capture_output=True, text=True).stdout
    recipe = re.findall(r" -m orchestrate (.*)$", said, re.MULTILINE)
    if not recipe:
        raise BadInput(f"--make: '{target}' is no target that runs the program (accepted: see make)")
    return [shlex.split(line) for line in recipe]
