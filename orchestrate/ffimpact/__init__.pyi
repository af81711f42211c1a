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
from .fitting.experiments import (
    Experiment as Experiment,
)
from .fitting.fit import (
    fit as fit,
)
from .fitting.fitted import (
    Fit as Fit,
)
from .fitting.literature import (
    materials as materials,
    shore as shore,
    typical as typical,
)
from .input.bodies import (
    Body as Body,
)
from .input.conditions import (
    Gas as Gas,
    Load as Load,
    Support as Support,
)
from .input.contact import (
    Contact as Contact,
    Pair as Pair,
)
from .input.hyperelastic import (
    ArrudaBoyce as ArrudaBoyce,
    BlatzKo as BlatzKo,
    Gent as Gent,
    Hyperfoam as Hyperfoam,
    Yeoh as Yeoh,
)
from .input.layers import (
    Layer as Layer,
)
from .input.materials import (
    Hyperelastic as Hyperelastic,
    Incompressible as Incompressible,
    Material as Material,
    Metal as Metal,
    MooneyRivlin as MooneyRivlin,
    NeoHookean as NeoHookean,
    Ogden as Ogden,
    SaintVenantKirchhoff as SaintVenantKirchhoff,
)
from .input.obstacles import (
    Bowl as Bowl,
    Circle as Circle,
    Implicit as Implicit,
    Obstacle as Obstacle,
    Plane as Plane,
    Polyline as Polyline,
    Sphere as Sphere,
    Surface as Surface,
)
from .input.shapes import (
    Ball as Ball,
    Box as Box,
    Cylinder as Cylinder,
    Disc as Disc,
    Ellipse as Ellipse,
    Ellipsoid as Ellipsoid,
    Mesh as Mesh,
    Polygon as Polygon,
    Rectangle as Rectangle,
    Ring as Ring,
    Shell as Shell,
    Torus as Torus,
    Tube as Tube,
)
from .recording import (
    Bounces as Bounces,
    bounces as bounces,
)
from .result import (
    Progress as Progress,
    Result as Result,
    compare as compare,
    load as load,
)
from .scene import (
    Scene as Scene,
)
from .spectrum import (
    Spectrum as Spectrum,
    dma as dma,
)

__version__: str
