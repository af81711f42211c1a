"""Impact of nonlinear deformable bodies: run() turns a scene into a result.

    import ffimpact as ff
    rubber = ff.NeoHookean(young=7e6, nu=0.45, density=1722)
    disc = ff.Disc(radius=0.05, material=rubber, position=(0, 0.051), velocity=(0, -8))
    result = ff.run(ff.Scene(bodies=[disc], obstacles=[ff.Plane()]), accuracy=0.005)
    result["impulse"], result.errors["impulse"], result.plot.force()

The public names are listed in __init__.pyi. Each name is loaded from its module on first use.
"""

from importlib.metadata import version

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
__version__ = version("ffimpact")
