"""What a scene of bodies is computed in: the entry `dimension` at the top of its file. y is up in
each.
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
    "of",
    "per_metre",
]


@dataclass(frozen=True)
class Dimension:
    """`script` is a file edp/<script>.edp; `axes` the components of a point; `like` the script
    whose rules of sizes stand for two bodies that meet: those of a disc or of a ball that hits
    a plane; `cases` the scripts of the paper's bodies.
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
DIMENSIONS = {one.name: one for one in (PLANE_STRAIN, AXISYMMETRIC, SOLID)}
SCRIPTS = tuple(one.script for one in DIMENSIONS.values())


def of(given: dict) -> Dimension:
    """That of a scene's tables; BadInput for a word that is none."""
    rule = Parameter("dimension", "word", PLANE_STRAIN.name, "-", "", words=tuple(DIMENSIONS))
    return DIMENSIONS[rule.check(given.get("dimension", rule.default))]


def per_metre(script: str) -> str:
    """Behind the units of forces and energies of a script: plane strain is per metre of
    thickness, a ball is not.
    """
    return "" if any(script in (one.script, *one.cases) for one in (AXISYMMETRIC, SOLID)) else "/m"
