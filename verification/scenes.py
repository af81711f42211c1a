"""Scenes of bodies as tables for ffimpact.scene: discs of radius 0.05 m on coarse meshes."""

RADIUS = 0.05
SOFT = {"law": "neohookean", "young": 7e6, "nu": 0.45, "density": 1722, "accuracy": 0.05}


def disc(x: float, y: float, vx: float, vy: float, **more) -> dict:
    """A [[body]] table."""
    return {"shape": "disc", "radius": RADIUS, "position": [x, y], "velocity": [vx, vy]} | more


def scene(*bodies: dict, obstacles: tuple[dict, ...] = (), friction: float = 0, **more) -> dict:
    """The tables of a scene. `more` holds entries of the top level."""
    contact = {"friction_static": friction} | {key: more.pop(key) for key in ("penalty", "exponent", "slip_velocity") if key in more}
    return SOFT | more | {"body": list(bodies), "obstacle": list(obstacles), "contact": contact}


def plane(point: tuple[float, float] = (0, 0), normal: tuple[float, float] = (0, 1), **more) -> dict:
    """An [[obstacle]] table."""
    return {"kind": "plane", "point": list(point), "normal": list(normal)} | more


HITS = {
    "centred": scene(disc(-0.0501, 0, 4, 0), disc(0.0501, 0, -4, 0)),
    "off-centre": scene(disc(-0.055, 0, 4, 0), disc(0.055, 0.04, -4, 0)),
    "oblique, one at rest": scene(disc(-0.055, 0, 8, 1), disc(0.055, 0.01, 0, 0)),
    "spinning": scene(disc(-0.055, 0, 4, 1, spin=30), disc(0.055, 0.03, -4, -1, spin=-10)),
    "rubbing": scene(disc(-0.055, 0, 4, 1, spin=30), disc(0.055, 0.03, -4, -1, spin=-10), friction=0.3),
    "unlike": scene(disc(-0.055, 0, 4, 1, law="svk"), disc(0.055, 0.02, -2, 0, young=2e6, nu=0.3, density=900)),
    "three": scene(disc(-0.105, 0, 5, 0), disc(0, 0.01, 0, 0), disc(0.105, -0.02, -3, 0), friction=0.2, end_time=1e-2),
}
