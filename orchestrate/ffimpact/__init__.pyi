"""The public names of `import ffimpact`, each with the module that it is loaded from on first
use.
"""

from .api import (
    Plan as Plan,
    Study as Study,
    plan as plan,
    run as run,
    sweep as sweep,
)
from .failure import (
    BadInput as BadInput,
    Busy as Busy,
    Failure as Failure,
    MaterialFailed as MaterialFailed,
    NotInstalled as NotInstalled,
    StepFailed as StepFailed,
    TooLong as TooLong,
    Unreadable as Unreadable,
)
from .input.models import (
    Ball as Ball,
    Body as Body,
    Bowl as Bowl,
    Box as Box,
    Circle as Circle,
    Contact as Contact,
    Cylinder as Cylinder,
    Disc as Disc,
    Ellipse as Ellipse,
    Ellipsoid as Ellipsoid,
    Gas as Gas,
    Implicit as Implicit,
    Incompressible as Incompressible,
    Load as Load,
    Material as Material,
    Mesh as Mesh,
    MooneyRivlin as MooneyRivlin,
    NeoHookean as NeoHookean,
    Obstacle as Obstacle,
    Ogden as Ogden,
    Pair as Pair,
    Plane as Plane,
    Polygon as Polygon,
    Polyline as Polyline,
    Rectangle as Rectangle,
    Ring as Ring,
    SaintVenantKirchhoff as SaintVenantKirchhoff,
    Shell as Shell,
    Sphere as Sphere,
    Support as Support,
    Surface as Surface,
    Torus as Torus,
    Tube as Tube,
)
from .model import (
    Scene as Scene,
)
from .result import (
    Progress as Progress,
    Result as Result,
    compare as compare,
    load as load,
)

__version__: str
