"""Impact of nonlinear deformable bodies: scenes in, results out.

    import ffimpact as ff
    rubber = ff.NeoHookean(young=7e6, nu=0.45, density=1722)
    scene = ff.Scene(bodies=[ff.Disc(radius=0.05, material=rubber, position=(0, 0.051), velocity=(0, -8))], obstacles=[ff.Plane()])
    result = ff.run(scene, accuracy=0.005)
    result["impulse"], result.errors["impulse"], result.plot.force()

What is listed in __all__ is loaded when it is first used.
"""

from __future__ import annotations

import importlib
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .api import Study, run, sweep
    from .failure import (
        BadInput,
        Busy,
        Failure,
        MaterialFailed,
        NotInstalled,
        StepFailed,
        TooLong,
        Unreadable,
    )
    from .model import (
        Ball,
        Body,
        Bowl,
        Box,
        Circle,
        Contact,
        Cylinder,
        Disc,
        Ellipse,
        Ellipsoid,
        Gas,
        Implicit,
        Incompressible,
        Load,
        Material,
        Mesh,
        MooneyRivlin,
        NeoHookean,
        Obstacle,
        Ogden,
        Pair,
        Plane,
        Polygon,
        Polyline,
        Rectangle,
        Ring,
        SaintVenantKirchhoff,
        Scene,
        Shell,
        Sphere,
        Support,
        Surface,
        Torus,
        Tube,
    )
    from .result import Result, compare, load

__version__ = version("ffimpact")

_MODULES = {
    "api": ("Study", "run", "sweep"),
    "failure": (
        "BadInput",
        "Busy",
        "Failure",
        "MaterialFailed",
        "NotInstalled",
        "StepFailed",
        "TooLong",
        "Unreadable",
    ),
    "model": (
        "Ball",
        "Body",
        "Bowl",
        "Box",
        "Circle",
        "Contact",
        "Cylinder",
        "Disc",
        "Ellipse",
        "Ellipsoid",
        "Gas",
        "Implicit",
        "Incompressible",
        "Load",
        "Material",
        "Mesh",
        "MooneyRivlin",
        "NeoHookean",
        "Obstacle",
        "Ogden",
        "Pair",
        "Plane",
        "Polygon",
        "Polyline",
        "Rectangle",
        "Ring",
        "SaintVenantKirchhoff",
        "Scene",
        "Shell",
        "Sphere",
        "Support",
        "Surface",
        "Torus",
        "Tube",
    ),
    "result": ("Result", "compare", "load"),
}
_HOME = {name: module for module, names in _MODULES.items() for name in names}
__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'ffimpact' has no attribute '{name}'")
    return getattr(importlib.import_module(f".{_HOME[name]}", __name__), name)


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
