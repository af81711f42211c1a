"""The scene strip-gravity (benchmarks/scenes/) with CalculiX (ccx), one thread: the same grid as
ngsolve_strip.py, elements CPE8, *DYNAMIC with its usual damping, large displacements."""

import json
import os
import resource
import subprocess
from pathlib import Path

import numpy as np
import strip


def model(o) -> tuple[str, np.ndarray]:
    """The text of the input file, and the weight of each node in the centre of mass."""
    columns, rows = strip.grid(o)
    number = -np.ones((2 * columns + 1, 2 * rows + 1), dtype=int)
    used = ~(np.arange(2 * columns + 1)[:, None] % 2 * (np.arange(2 * rows + 1)[None] % 2)).astype(bool)
    number[used] = 1 + np.arange(used.sum())
    nodes, elements, weights = [], [], np.zeros(used.sum())
    for i, j in np.argwhere(used):
        nodes.append(f"{number[i, j]}, {i * o.width / (2 * columns):.12g}, {j * o.height / (2 * rows):.12g}")
    around = np.array([(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)])
    for e, (i, j) in enumerate(np.ndindex(columns, rows), 1):
        own = [number[2 * i + a, 2 * j + b] for a, b in around]
        elements.append(", ".join(map(str, [e, *own])))
        weights[np.array(own) - 1] += np.array([-1 / 12] * 4 + [1 / 3] * 4) / (columns * rows)
    left = "\n".join(f"{n}," for n in number[0] if n > 0)
    text = "\n".join([
        "*NODE, NSET=Nall", *nodes, "*ELEMENT, TYPE=CPE8, ELSET=Eall", *elements, "*NSET, NSET=Left", left,
        "*MATERIAL, NAME=rubber", "*ELASTIC", f"{o.young}, {o.nu}", "*DENSITY", f"{o.density}",
        "*SOLID SECTION, ELSET=Eall, MATERIAL=rubber", "1.", "*BOUNDARY", "Left, 1, 2", "*AMPLITUDE, NAME=Step", "0., 1., 1000., 1.",
        f"*STEP, NLGEOM, INC={strip.steps(o) + 1}", "*DYNAMIC, DIRECT", f"{o.dt}, {o.end_time}",
        "*DLOAD, AMPLITUDE=Step", f"Eall, GRAV, {o.gravity}, 0., -1., 0.", "*NODE PRINT, NSET=Nall", "U", "*END STEP", ""])
    return text, weights


def heights(printed: str, weights: np.ndarray) -> list[float]:
    """The height of the centre of mass over that at the start after each step [m]."""
    found = []
    for block in printed.split("displacements")[1:]:
        rows = [line.split() for line in block.splitlines()[1:]]
        table = np.array([row for row in rows if len(row) == 4], dtype=float)
        found.append(float(weights[table[:, 0].astype(int) - 1] @ table[:, 2]))
    return found


if __name__ == "__main__":
    options = strip.arguments("CalculiX")
    text, weights = model(options)
    Path("strip.inp").write_text(text)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(["ccx", "strip"], env=os.environ | {"OMP_NUM_THREADS": "1"}, stdout=subprocess.DEVNULL, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    sag = strip.sag(heights(Path("strip.dat").read_text(), weights))
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(json.dumps({"sag": sag, "dofs": 2 * len(weights), "cpu_seconds": seconds}))
