"""The dimension in which a scene is computed: the entry `dimension` at the top of its file.

y points up in all dimensions.
"""

from dataclasses import dataclass

from .parameters import Parameter

__all__ = [
    "AXISYMMETRIC",
    "DIMENSIONS",
    "Dimension",
    "PLANE_STRAIN",
    "SCRIPTS",
    "SOLID",
    "of_scene",
    "per_metre",
]


@dataclass(frozen=True)
class Dimension:
    """A dimension and its FreeFEM scripts.

    `script` is the file edp/program/<script>.edp for scenes of bodies. `axes` is the number of components
    of a point. `like` is the script whose element sizes, step and penalty apply to contact pairs:
    that of a disc or of a ball that hits a plane. `cases` are the scripts of the paper's cases.
    """

    name: str
    script: str
    axes: int
    like: str
    cases: tuple[str, ...]


PLANE_STRAIN = Dimension("plane-strain", "bodies", 2, "disc-plane", ("disc-plane", "disc-block"))
AXISYMMETRIC = Dimension(
    "axisymmetric", "bodies-axisymmetric", 2, "ball-plane", ("ball-axisymmetric",)
)
SOLID = Dimension("3d", "bodies-3d", 3, "ball-plane", ("ball-plane",))
DIMENSIONS = {dimension.name: dimension for dimension in (PLANE_STRAIN, AXISYMMETRIC, SOLID)}
SCRIPTS = tuple(dimension.script for dimension in DIMENSIONS.values())


def of_scene(content: dict) -> Dimension:
    """The dimension of a scene's tables; raises BadInput for an unknown word."""
    rule = Parameter("dimension", "word", PLANE_STRAIN.name, "-", "", words=tuple(DIMENSIONS))
    return DIMENSIONS[rule.check(content.get("dimension", rule.default))]


def per_metre(script: str) -> str:
    """The suffix of the units of forces and energies of a script.

    In plane strain they are per metre of thickness ("/m"); in other dimensions the suffix is empty.
    """
    return (
        ""
        if any(
            script in (dimension.script, *dimension.cases) for dimension in (AXISYMMETRIC, SOLID)
        )
        else "/m"
    )
