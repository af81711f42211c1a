"""Finds the unstressed shape of bodies whose given shape is that under their gases."""

from __future__ import annotations

import math
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..failure import BadInput, of_code
from ..freefem import freefem
from ..freefem.arrays import packed

if TYPE_CHECKING:
    from ..scene import Scene

__all__ = ["find_unstressed"]

MOST = 40  # iterations
CLOSE = 1e-7  # distance of the given shape from that under the gases, over the extent
REMEMBERED = 5  # number of earlier iterates that the next one combines


def find_unstressed(scene: Scene, flags: Mapping[str, object], where: Path) -> None:
    """Writes the displacement W from the given shape x to the unstressed one X = x + W to the file
    SCENE.unstressed beside the scene, for the run with these flags in the folder `where`.

    In an iteration, edp/program/run/unstressed.idp displaces X by u, into equilibrium with the gases.
    The fixed point W = -u is sought (Sellier, 2011), with Anderson's acceleration. Raises BadInput
    if it is not found.
    """
    file, out = Path(f"{flags['scene']}.unstressed"), where / "unstressed"
    answer = file.with_name(f"{file.name}.next")
    change, off = np.zeros(0), math.inf
    iterates: list[np.ndarray] = []
    residuals: list[np.ndarray] = []
    _write(file, "search", change)
    for _ in range(MOST):
        code, message = freefem.run(
            freefem.find(),
            f"edp/program/{scene.kind.script}.edp",
            {**flags, "out": out},
            where / "log.txt",
        )
        shutil.rmtree(out, ignore_errors=True)
        if not answer.exists():
            if not iterates:
                raise of_code(code, message or f"FreeFem++ stopped with exit code {code}")
            break
        share, extent, *following = np.fromfile(answer, offset=8)  # behind their number
        answer.unlink()
        iterates.append(np.array(following))
        residuals.append(iterates[-1] - (change if change.size else 0.0))
        off = abs(residuals[-1]).max() / extent
        ends = share == 1 and off <= CLOSE
        change = iterates[-1] if ends else _combined(iterates, residuals)
        _write(file, "found" if ends else "search", change)
        if ends:
            return
    raise BadInput(
        f"{_entry(scene)}: no unstressed shape is found; under the gas the last one is "
        f"{off:.2g} of the extent from the given shape (accepted: a smaller gauge_pressure, or "
        "unstressed)"
    )


def _combined(iterates: list[np.ndarray], residuals: list[np.ndarray]) -> np.ndarray:
    """The next iterate: the combination of the last ones with the smallest residual."""
    last = slice(-1 - REMEMBERED, None)
    steps, falls = np.diff(iterates[last], axis=0).T, np.diff(residuals[last], axis=0).T
    if steps.size == 0:
        return iterates[-1]
    improved: np.ndarray = (
        iterates[-1] - steps @ np.linalg.lstsq(falls, residuals[-1], rcond=1e-10)[0]
    )
    return improved


def _write(file: Path, state: str, change: np.ndarray) -> None:
    file.write_bytes(packed({"unstressed.state": state, "unstressed": change}))


def _entry(scene: Scene) -> str:
    """The entry of the first gas under which the given shape of its body is."""
    loads = [load for body in scene.bodies if body.inflated for load in body.loads]
    return next(f"{load.entry}.gas.given_shape" for load in loads if load.inflated)
