"""The dimension in which a scene is computed: the entry `dimension` at the top of its file.

y points up in all dimensions.
"""

from dataclasses import dataclass

from .parameter import Parameter, Table

__all__ = [
    "AXISYMMETRIC",
    "DIMENSIONS",
    "Dimension",
    "PLANE_STRAIN",
    "SOLID",
    "of_scene",
    "per_metre",
]


@dataclass(frozen=True)
class Dimension:
    """A dimension and its FreeFEM scripts.

    `script` is the file edp/program/<script>.edp for scenes of bodies. `axes` is the number of components
    of a point.
    """

    name: str
    script: str
    axes: int


PLANE_STRAIN = Dimension("plane-strain", "bodies", 2)
AXISYMMETRIC = Dimension("axisymmetric", "bodies-axisymmetric", 2)
SOLID = Dimension("3d", "bodies-3d", 3)
DIMENSIONS = {dimension.name: dimension for dimension in (PLANE_STRAIN, AXISYMMETRIC, SOLID)}


def of_scene(content: Table) -> Dimension:
    """The dimension of a scene's tables; raises BadInput for an unknown word."""
    rule = Parameter("dimension", "word", PLANE_STRAIN.name, "-", "", words=tuple(DIMENSIONS))
    return DIMENSIONS[str(rule.check(content.get("dimension", rule.default)))]


def per_metre(script: str) -> str:
    """The suffix of the units of forces and energies of a script.

    In plane strain they are per metre of thickness ("/m"); in other dimensions the suffix is empty.
    """
    return "" if script in (AXISYMMETRIC.script, SOLID.script) else "/m"
