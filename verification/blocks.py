"""V16: two blocks with different meshes are pressed together (pressed.edp). The pressure must be
uniform."""

from collections.abc import Iterator
from pathlib import Path

from .case import Row
from .measure import measure, prepared

# Penalty in E / length. The deviation of the pressure is proportional to penalty times element size
# over E.
PENALTY = 10


def pressed(folder: Path, elements: int) -> Iterator[Row]:
    """Two blocks of 1 x 0.5 with E = 1 between two planes that compress them by 0.3 %.

    Elements have the size 1/elements below and 0.7 times this size above.
    """
    def block(y: float, size: float) -> dict:
        return {"shape": "rectangle", "width": 1, "height": 0.5, "position": [0, y], "mesh_size": size, "contact_mesh_size": size}
    planes = [{"kind": "plane", "point": [0, 0], "normal": [0, 1]},
              {"kind": "plane", "point": [0, 1], "normal": [0, -1], "velocity": [0, -1e-4]}]
    scene = {"law": "neohookean", "young": 1, "nu": 0.3, "density": 1, "accuracy": 0.05, "integrator": "backward-euler", "dt": 1,
             "end_time": 30, "tolerance": 1e-10, "body": [block(0.25, 1 / elements), block(0.75, 0.7 / elements)], "obstacle": planes,
             "contact": {"penalty": PENALTY}}
    numbers = measure("pressed", **prepared(folder, scene), out=folder)
    yield Row("area", 1 / elements, numbers["area"], 1)
    yield Row("force on the planes", 1 / elements, numbers["balance"], 0)
    yield Row("pressure: root mean square deviation", 1 / elements, numbers["uneven"], 0, 1)


def blocks(folder: Path) -> Iterator[Row]:
    for elements in (4, 8, 16):
        yield from pressed(folder / f"{elements}", elements)
