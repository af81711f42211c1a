"""Random scenes for tests of the error estimates and of robustness. Equal seeds, equal scenes."""

import math
import random
from collections.abc import Sequence
from pathlib import Path

from ffimpact.sweeps.study import Point

# Young's modulus [Pa], density [kg/m3] and nu of materials from gel to steel; rounded handbook
# values.
MATERIALS = {"gel": (3e4, 1050.0, 0.45), "soft rubber": (1e5, 1000.0, 0.4), "foam": (1e6, 100.0, 0.0), "rubber": (7e6, 1722.0, 0.45),
             "cork": (3e7, 200.0, 0.05), "ptfe": (5e8, 2200.0, 0.46), "nylon": (2.5e9, 1150.0, 0.4), "wood": (1e10, 700.0, 0.3),
             "lead": (1.6e10, 11340.0, 0.44), "glass": (7e10, 2500.0, 0.22), "aluminium": (7e10, 2700.0, 0.33),
             "steel": (2.1e11, 7850.0, 0.3)}
# A mixture of all dimensions: the number of each scene in sixty, and its requested accuracies.
# Scenes with two bodies and in space are expensive.
MIXTURE = {"disc-normal": (24, (0.005, 0.01, 0.02)), "disc-block": (10, (0.01, 0.02, 0.05)), "ball-axisymmetric": (12, (0.005, 0.01, 0.02)),
           "two-discs": (10, (0.01, 0.02, 0.05)), "ball": (4, (0.1,))}
# Requested accuracies of scenes that test the error estimates with few elements and steps.
COARSE = (0.03, 0.05, 0.1)
# Bounds of the speed over sqrt(E/density). Above its bound svk breaks down.
SLOWEST, FASTEST = 5e-4, {"svk": 0.1, "neohookean": 0.18}
# Upper bound of the speed of bodies that fall on a corner, over sqrt(E/density).
FASTEST_CORNER = 0.05


def bar_speed(young: float, density: float) -> float:
    """The wave speed of a bar, c = sqrt(E/rho) [m/s], which scales the impact speeds."""
    return (young / density) ** 0.5


def draw(seed: int, count: int, hard: bool = False, scene: str = "disc-normal") -> list[Point]:
    """`count` impacts of a disc with random material, law, speed and radius.

    Some are oblique or spinning, some have friction or another exponent of the penalty law. `hard`
    adds gravity, other integrators, linear elements, and other accuracies, penalties and friction
    laws. The points override the entries of `scene`, a key of SCENES. Scenes on a block have no
    gravity, and balls of revolution keep their axis.
    """
    chance = random.Random(seed)
    points = [_scene(chance, hard) for _ in range(count)]
    return [SCENES[scene](chance, point) for point in points]


def mixture(seed: int, count: int) -> list[tuple[str, Point]]:
    """About `count` scenes of all dimensions with one body or two, as name and overrides.

    Some scenes have friction. The kinds of scenes are spread evenly over the list.
    """
    entries = []
    for scene, (share, accuracies) in MIXTURE.items():
        chance = random.Random(f"{seed} {scene}")
        many = max(1, round(count * share / 60))
        for k in range(many):
            point = SCENES[scene](chance, _scene(chance, False))
            entries.append(((k + 0.5) / many, scene, point | {"accuracy": chance.choice(accuracies)}))
    return [(scene, point) for _, scene, point in sorted(entries, key=lambda entry: entry[0])]


def coarse(seed: int, count: int, accuracies: Sequence[float] = COARSE) -> list[tuple[str, Point]]:
    """`count` discs and balls of revolution in turn, drawn as in draw(), at each accuracy in
    `accuracies`.

    A fifth of them is nearly incompressible.
    """
    chance, entries = random.Random(f"{seed} coarse"), []
    for k in range(count):
        scene = ("disc-normal", "ball-axisymmetric")[k % 2]
        point = SCENES[scene](chance, _scene(chance, False))
        if chance.random() < 0.2:
            point["nu"] = chance.choice([0.48, 0.49, 0.499, 0.4999])
        entries.append((scene, point | {"accuracy": accuracies[k // 2 % len(accuracies)]}))
    return entries


def _placed(point: Point, axes: int = 2) -> Point:
    """An impact with the entries of its scene: direction instead of the angle to the plane, position
    instead of the height above it."""
    own = {name: value for name, value in point.items() if name not in ("angle", "height")}
    return own | {"direction": -point.get("angle", 90.0), "position": [0.0, _round(point["radius"] + point.get("height", 0.0)), 0.0][:axes]}


def _on_plane(chance: random.Random, point: Point) -> Point:
    return _placed(point)


def _of_revolution(chance: random.Random, point: Point) -> Point:
    return _placed({name: value for name, value in point.items() if name not in ("angle", "spin", "symmetry")})


def _on_block(chance: random.Random, point: Point) -> Point:
    """A disc on a free block of the same material; width and height are multiples of the radius."""
    across, deep = chance.choice([5, 10, 20]), chance.choice([2, 4])
    radius = point["radius"]
    kept = _placed({name: value for name, value in point.items() if name not in ("gravity", "height")})
    own = {f"body.1.{name}": kept.pop(name) for name in ("radius", "speed", "spin", "direction", "position") if name in kept}
    return kept | own | {"body.2.width": across * radius, "body.2.height": deep * radius, "body.2.position": [0.0, -deep * radius / 2]}


def _on_another(chance: random.Random, point: Point) -> Point:
    """A disc and another disc, off centre. The other disc may differ in radius and stiffness. Both
    drift."""
    radius, speed, other = point["radius"], point["speed"], point["radius"] * chance.choice([0.5, 1, 1, 2])
    apart, off = radius + other, chance.choice([0, 0.2, 0.4, 0.6]) * (radius + other)
    drift = [_round(chance.uniform(-2, 2) * speed) for _ in "xy"]
    overrides = {name: point[name] for name in ("law", "young", "density", "nu")}
    overrides |= {"body.1.radius": radius, "body.2.radius": other, "body.1.position": [0.0, 0.0],
                  "body.2.position": [_round(1.05 * apart), _round(off)], "body.1.velocity": [speed + drift[0], drift[1]],
                  "body.2.velocity": drift}
    if chance.random() < 0.3:
        overrides["body.2.young"] = 10 * point["young"]
    if "spin" in point:
        overrides["body.1.spin"] = point["spin"]
    contact = {"friction_static": 0.0, "friction_dynamic": 0.0} | {
        name: point[name] for name in ("friction_static", "friction_dynamic", "exponent") if name in point}
    return overrides | {f"contact.{name}": value for name, value in contact.items()}


def _on_corner(chance: random.Random, point: Point) -> Point:
    """A square or rectangular block that falls on one of its corners."""
    width, height, speed = 2 * point["radius"], 2 * point["radius"] * chance.choice([0.3, 0.6, 1]), min(
        point["speed"], FASTEST_CORNER * bar_speed(point["young"], point["density"]))
    overrides = {name: point[name] for name in ("law", "young", "density", "nu", "accuracy") if name in point}
    overrides |= {"body.1.width": width, "body.1.height": height, "body.1.angle": _round(chance.uniform(10, 80)),
                  "body.1.position": [0.0, _round(0.51 * (width**2 + height**2) ** 0.5)],
                  "body.1.velocity": [_round(chance.choice([0, 0.5, 1]) * speed), -_round(speed)]}
    contact = {"friction_static": 0.0, "friction_dynamic": 0.0} | {
        name: point[name] for name in ("friction_static", "friction_dynamic", "exponent") if name in point}
    return overrides | {f"contact.{name}": value for name, value in contact.items()}


def _in_space(chance: random.Random, point: Point) -> Point:
    """A ball in space. Its speed is bounded, as the elements are coarse."""
    kept = {name: value for name, value in point.items() if name not in ("symmetry", "spin", "exponent")}
    return _placed(kept, 3) | {"law": "neohookean", "speed": _round(min(point["speed"], 0.05 * bar_speed(point["young"], point["density"])))}


SCENES = {"disc-normal": _on_plane, "disc-block": _on_block, "ball-axisymmetric": _of_revolution, "two-discs": _on_another,
          "block-corner": _on_corner, "ball": _in_space}


def words(point: Point) -> str:
    """A scene as a line of a table: law, material, speed over c and unusual entries."""
    named = {value[:2]: name for name, value in MATERIALS.items()}
    is_usual = point["nu"] == MATERIALS[named[point["young"], point["density"]]][2]
    names = {"law", "young", "density", "nu" if is_usual else "", "speed", "friction_static", "friction_dynamic", "body.1.position",
             "body.1.velocity", "body.2.velocity", "position", "body.2.position"}
    point = {name.removeprefix("contact."): value for name, value in point.items()}
    if "body.1.speed" in point:
        point["speed"] = point.pop("body.1.speed")
    if "speed" in point:
        speed = point["speed"]
    elif "body.1.velocity" in point and isinstance(point["body.1.velocity"], list):
        speed = max(abs(a - b) for a, b in zip(point["body.1.velocity"], point.get("body.2.velocity", [0, 0])))
    else:
        # Bodies that strike flat give the velocity as components along one axis.
        speed = sum(abs(value) for name, value in point.items() if ".velocity" in name)
    parts = [point["law"], named[point["young"], point["density"]], f"v/c {speed / bar_speed(point['young'], point['density']):.2g}"]
    if point.get("friction_static"):
        parts.append(f"friction {point['friction_static']:g}, {point['friction_dynamic']:g}")
    return ", ".join(parts + [f"{name} {value:g}" if isinstance(value, float) else f"{name} {value}" for name, value in point.items()
                              if name not in names])


def _scene(chance: random.Random, hard: bool) -> Point:
    young, density, nu = chance.choice(list(MATERIALS.values()))
    law = chance.choice(list(FASTEST))
    c, radius = bar_speed(young, density), chance.choice([0.005, 0.05, 0.5])
    speed = c * SLOWEST * (FASTEST[law] / SLOWEST) ** chance.random()
    point = {"law": law, "young": young, "density": density, "nu": nu, "radius": radius, "speed": _round(speed)}
    kind = chance.choice(["normal", "normal", "smooth oblique", "oblique", "oblique", "spin"])
    if "oblique" in kind:
        point["angle"] = chance.choice([30.0, 45.0, 60.0, 75.0])
    if kind == "spin":
        point["spin"] = _round(chance.uniform(-1, 1) * speed / radius)
    if kind in ("oblique", "spin"):
        static = chance.choice([0.1, 0.3, 0.7])
        point |= {"friction_static": static, "friction_dynamic": _round(static * chance.choice([0.7, 1.0]))}
    if chance.random() < 0.2:
        point["exponent"] = 1.5
    return point | (_harder(chance, point, c) if hard else {})


def _harder(chance: random.Random, point: Point, c: float) -> Point:
    """Further options that a user may set, among them rubber and damping. Each appears in a small
    share of the scenes."""
    more: Point = {"accuracy": chance.choice([0.002, 0.005, 0.01, 0.03])}
    if chance.random() < 0.15:
        more["integrator"] = chance.choice(["midpoint", "bdf2", "backward-euler"])
    if chance.random() < 0.1:
        more["degree"] = 1
    if chance.random() < 0.15:
        more["penalty"] = _round(point["young"] / point["radius"] * 10 ** chance.uniform(0.5, 3)) if "exponent" not in point else "auto"
    if chance.random() < 0.1:
        more |= {"gravity": _round(0.01 * c**2 / point["radius"] * chance.random()), "height": _round(chance.random() * point["radius"])}
    if "friction_static" in point and chance.random() < 0.3:
        more["regularization"] = chance.choice(["sqrt", "tanh"])
    if chance.random() < 0.1:
        more["symmetry"] = "full"
    # A generator of its own leaves the numbers that are drawn above unchanged.
    beside = random.Random(repr(point | more))
    if beside.random() < 0.2:
        more["nu"] = beside.choice([0.49, 0.499, 0.4999])
        if point["law"] == "neohookean" and not more.keys() & {"integrator", "degree"} and beside.random() < 0.5:
            more |= {"law": "incompressible", "nu": 0.5}
    if more.get("integrator", "midpoint") == "midpoint" and beside.random() < 0.15:
        more |= {"loss": beside.choice([0.01, 0.1, 0.5]), "loss_model": "kelvin-voigt"}
    return more


def _round(value: float) -> float:
    return float(f"{value:.3g}")


OWN = Path(__file__).with_name("scenes")  # folder of scenes that are not among the built-in ones

# ---- faces that strike flat

# The number of each scene in sixty, and its requested accuracies. Scenes in space are expensive.
FLAT_MIXTURE = {"block-wall": (18, (0.02, 0.05, 0.1)), "two-bars": (14, (0.02, 0.05, 0.1)), "polygon-wall": (14, (0.02, 0.05, 0.1)),
                "cylinder-wall": (10, (0.02, 0.05, 0.1)), "box-wall": (4, (0.1,))}
FLAT_NU = (0.0, 0.0, 0.1, 0.2, 0.3, 0.4, 0.45, 0.49)


def flat(seed: int, count: int) -> list[tuple[str, Point]]:
    """About `count` bodies whose faces strike planes or each other flat, in all dimensions, as
    scene and overrides."""
    entries = []
    for scene, (share, accuracies) in FLAT_MIXTURE.items():
        chance = random.Random(f"{seed} {scene}")
        many = max(1, round(count * share / 60))
        for k in range(many):
            young, density, _ = MATERIALS[chance.choice(list(MATERIALS))]
            speed = bar_speed(young, density) * math.exp(chance.uniform(math.log(SLOWEST), math.log(FASTEST_FLAT)))
            point = {"young": young, "density": density, "nu": chance.choice(FLAT_NU), "law": chance.choice(["svk", "neohookean"]),
                     "accuracy": chance.choice(accuracies)}
            point |= {name: value if isinstance(value, list) else float(f"{value:.3g}") for name, value in
                      FLAT_SHAPES[scene](chance, speed).items()}
            entries.append(((k + 0.5) / many, scene, point))
    return [(scene, point) for _, scene, point in sorted(entries, key=lambda entry: entry[0])]


def _block(chance: random.Random, speed: float) -> Point:
    height, width = (0.1 * chance.choice([0.25, 0.5, 1.0, 2.0]) for _ in range(2))
    return {"body.1.width": width, "body.1.height": height, "body.1.position.2": height / 2, "body.1.velocity.2": -speed}


def _bars(chance: random.Random, speed: float) -> Point:
    lengths, height = [0.1 * chance.choice([0.5, 1.0, 2.0]) for _ in range(2)], 0.1 * chance.choice([0.2, 0.5])
    sides = {f"body.{k}.{name}": value for k, length, side in ((1, lengths[0], -1), (2, lengths[1], 1)) for name, value in
             {"width": length, "height": height, "position.1": side * length / 2, "velocity.1": -side * speed / 2}.items()}
    return sides


def _polygon(chance: random.Random, speed: float) -> Point:
    """A trapezoid that lies on its longer or its shorter side."""
    base, top, height = (0.1 * chance.uniform(*ends) for ends in ((0.5, 2), (0.3, 1), (0.5, 2)))
    corners = [[-base / 2, 0.0], [base / 2, 0.0], [top / 2, height], [-top / 2, height]]
    corners = [[float(f"{x:.3g}") for x in corner] for corner in corners]
    lowest = height * (base + 2 * top) / (3 * (base + top))
    return {"body.1.vertices": corners, "body.1.position.2": lowest * 1.01, "body.1.velocity.2": -speed}


def _cylinder(chance: random.Random, speed: float) -> Point:
    radius, height = 0.05 * chance.choice([0.3, 1.0, 2.0]), 0.1 * chance.choice([0.5, 1.0, 2.0])
    return {"body.1.radius": radius, "body.1.height": height, "body.1.position": height / 2, "body.1.velocity": -speed}


def _box(chance: random.Random, speed: float) -> Point:
    width, height, depth = (0.1 * chance.choice([0.5, 1.0]) for _ in range(3))
    return {"body.1.width": width, "body.1.height": height, "body.1.depth": depth, "body.1.position.2": height / 2,
            "body.1.velocity.2": -speed}


FASTEST_FLAT = 0.03  # upper bound of the speed over sqrt(E/density)
FLAT_SHAPES = {"block-wall": _block, "two-bars": _bars, "polygon-wall": _polygon, "cylinder-wall": _cylinder, "box-wall": _box}


# ---- supports, loads, rigid bodies and obstacles that move

# The number of each scene in sixty.
HELD_MIXTURE = {"drop-weight": 15, "disc-beam": 15, "hollow-ball": 15, "roller": 15}
HELD_ACCURACIES = (0.02, 0.05, 0.1)
FASTEST_HELD = 0.06  # upper bound of the speed over sqrt(E/density)


def held(seed: int, count: int) -> list[tuple[str, Point]]:
    """About `count` scenes with supports, loads, rigid bodies and moving obstacles, as scene and
    overrides."""
    entries = []
    for scene, share in HELD_MIXTURE.items():
        chance = random.Random(f"{seed} {scene}")
        many = max(1, round(count * share / 60))
        for k in range(many):
            young, density, nu = MATERIALS[chance.choice(list(MATERIALS))]
            speed = bar_speed(young, density) * FASTEST_HELD * math.exp(-chance.uniform(0, math.log(20)))
            point = {"young": young, "density": density, "nu": nu, "law": chance.choice(["svk", "neohookean"]),
                     "accuracy": chance.choice(HELD_ACCURACIES)}
            shape = HELD_SHAPES[scene](chance, speed, bar_speed(young, density), point)
            point |= {name: _round(value) if isinstance(value, float) else value for name, value in shape.items()}
            entries.append(((k + 0.5) / many, scene, point))
    return [(scene, point) for _, scene, point in sorted(entries, key=lambda entry: entry[0])]


def _weight(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    """A rigid disc on a block that lies on the ground.

    Its mass is 1 to 10 times the mass of the block.
    """
    radius, width, height = 0.03 * chance.choice([0.5, 1.0, 2.0]), 0.15 * chance.choice([0.5, 1.0]), 0.04 * chance.choice([0.5, 1.0, 2.0])
    mass = material["density"] * width * height * math.exp(chance.uniform(0, math.log(10)))
    lasts = 8 * height / c * (mass / (material["density"] * width * height)) ** 0.5 + 4 * height / c
    return {"body.1.radius": radius, "body.1.mass": mass, "body.1.position.2": 1.01 * radius + height, "body.1.velocity.2": -speed,
            "body.2.width": width, "body.2.height": height, "body.2.position.2": height / 2, "end_time": lasts,
            "gravity": chance.choice([0.0, 2e-4]) * c**2 / height, "obstacle.1.friction_static": chance.choice([0.1, 0.4, 0.8])}


def _on_beam(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    width, height, radius = 0.2 * chance.choice([1.0, 1.5]), 0.04 * chance.choice([1.0, 1.5]), 0.05 * chance.choice([0.5, 1.0])
    return {"body.1.radius": radius, "body.1.position.2": height / 2 + 1.02 * radius, "body.1.velocity.2": -speed,
            "body.2.width": width, "body.2.height": height, "body.1.young": material["young"] * chance.choice([1.0, 1.0, 5.0])}


def _hollow(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    inner = 0.05 * chance.choice([0.6, 0.7, 0.8])
    return {"body.1.inner_radius": inner, "body.1.velocity.2": -speed,
            "body.1.load.1.gas.gauge_pressure": material["young"] * chance.choice([0.002, 0.01, 0.02]),
            "body.1.load.1.gas.exponent": chance.choice([1.0, 1.4])}


def _roller(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    """An obstacle that moves down and rotates. Its speed is `speed` at the onset of contact."""
    deep, height = 0.001 * chance.uniform(1.5, 5.0), 0.04 * chance.choice([0.5, 1.0])
    lasts = _round(math.pi * deep / speed)
    static = chance.choice([0.1, 0.3, 0.7])
    return {"body.1.height": height, "obstacle.1.centre.2": 0.051 + height / 2, "end_time": lasts,
            "obstacle.1.motion.2": f"-{deep:.3g}*sin(pi*t/{lasts})",
            "obstacle.1.rotation": f"-{chance.choice([0.0, 10.0, 60.0]) / lasts:.4g}*t",
            "contact.friction_static": static, "contact.friction_dynamic": static * chance.choice([0.7, 1.0])}


HELD_SHAPES = {"drop-weight": _weight, "disc-beam": _on_beam, "hollow-ball": _hollow, "roller": _roller}


# ---- bodies of revolution on curved surfaces, hollow bodies, rubber, unlike materials, strips, layers
# and losses that do not depend on frequency

# By family: the number of each scene in thirty.
OTHER_MIXTURE = {"curved": {"ball-sphere": 10, "ellipsoid-bowl": 8, "ellipsoid-cylinder": 12},
                 "hollow": {"shell-wall": 10, "gas-shell": 12, "ring-circle": 8},
                 "incompressible": {"block-circle": 14, "disc-normal": 8, "ball-axisymmetric": 8},
                 "unlike": {"disc-slab": 16, "ball-cylinder": 14},
                 "strips": {"disc-strip": 12, "ball-plate": 10, "disc-free-strip": 8}}
# The same of bodies with layers, with a loss that does not depend on frequency, and of metals.
LAYER_MIXTURE = {"layered": {"layered-disc": 12, "layered-ball": 10, "layered-pad": 8},
                 "lossy": {"lossy-disc": 12, "lossy-ball": 10, "lossy-pad": 8},
                 "metals": {"metal-disc": 12, "metal-ball": 10, "metal-pad": 8}}
FAMILIES = OTHER_MIXTURE | LAYER_MIXTURE
OTHER_ACCURACIES = (0.02, 0.05, 0.1)
FASTEST_OTHER = 0.08  # upper bound of the speed over sqrt(E/density)
NEARLY = (0.49, 0.495, 0.499)  # Poisson's ratios
UNLIKE = (0.0333, 0.1, 0.3, 3.0, 10.0, 30.0)  # ratios of Young's moduli
YIELDS, HARDENINGS = (1e-3, 3e-3, 1e-2), (0.0, 0.01, 0.05)  # over Young's modulus
SLOWER = 0.2  # speeds of metals over those of others
LOSSES = (0.03, 0.1, 0.3, 0.6)  # loss factors that do not depend on frequency


def others(seed: int, count: int) -> list[tuple[str, Point]]:
    """About `count` scenes of each family in OTHER_MIXTURE, as scene and overrides."""
    return _of_families(seed, count, OTHER_MIXTURE)


def layers(seed: int, count: int) -> list[tuple[str, Point]]:
    """The same of the families in LAYER_MIXTURE."""
    return _of_families(seed, count, LAYER_MIXTURE)


def _of_families(seed: int, count: int, mixture: dict[str, dict[str, int]]) -> list[tuple[str, Point]]:
    entries = []
    for family, shares in mixture.items():
        for scene, share in shares.items():
            chance = random.Random(f"{seed} {family} {scene}")
            many = max(1, round(count * share / 30))
            for k in range(many):
                young, density, nu = MATERIALS[chance.choice(list(MATERIALS))]
                c = bar_speed(young, density)
                speed = c * FASTEST_OTHER * math.exp(-chance.uniform(0, math.log(40)))
                point = {"young": young, "density": density, "nu": chance.choice(NEARLY) if family == "incompressible" else nu,
                         "law": "neohookean", "accuracy": chance.choice(OTHER_ACCURACIES)}
                point |= _rounded(OTHER_SHAPES[scene](chance, speed, c, point))
                entries.append(((k + 0.5) / many, scene, point))
    return [(scene, point) for _, scene, point in sorted(entries, key=lambda entry: entry[0])]


def family(scene: str) -> str:
    """The family of a scene: a key of FAMILIES, or else the scene itself."""
    return next((name for name, shares in FAMILIES.items() if scene in shares), scene)


def _rounded(value):
    """The numbers in overrides, to three digits."""
    if isinstance(value, dict):
        return {name: _rounded(item) for name, item in value.items()}
    if isinstance(value, list):
        return [_rounded(item) for item in value]
    return _round(value) if isinstance(value, float) else value


def _friction(chance: random.Random) -> Point:
    static = chance.choice([0.0, 0.2, 0.5])
    return {"contact.friction_static": static, "contact.friction_dynamic": static * chance.choice([0.7, 1.0])}


def _ball_sphere(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    radius = 0.05 * chance.choice([0.3, 1.0, 3.0])
    return {"obstacle.1.radius": radius, "obstacle.1.centre": [0.0, -radius], "body.1.velocity": -speed} | _friction(chance)


def _ellipsoid_bowl(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    half, bowl = 0.03 * chance.choice([0.7, 1.0, 2.0]), 0.1 * chance.choice([1.5, 3.0])
    # The ellipsoid is more strongly curved at its lowest point than the bowl.
    half = max(half, 1.2 * 0.05**2 / bowl)
    return {"body.1.semi_axes": [0.05, half], "body.1.position": 1.01 * half, "body.1.velocity": -speed,
            "obstacle.1.radius": bowl, "obstacle.1.centre": [0.0, bowl]} | _friction(chance)


def _ellipsoid_cylinder(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    half, height = 0.025 * chance.choice([0.7, 1.0, 2.0]), 0.04 * chance.choice([0.5, 1.0, 2.0])
    return {"body.1.semi_axes": [0.04, half], "body.1.position": half + height / 2 + 0.0003, "body.1.velocity": -speed,
            "body.2.height": height, "body.2.young": material["young"] * chance.choice([1.0, 3.0, 10.0])} | _friction(chance)


def _shell(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    return {"body.1.inner_radius": 0.05 * chance.choice([0.5, 0.7, 0.85]), "body.1.velocity": -speed} | _friction(chance)


def _gas_shell(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    return _shell(chance, speed, c, material) | {
        "body.1.load.1.gas.gauge_pressure": material["young"] * chance.choice([0.002, 0.01, 0.02])}


def _ring(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    off = 0.1 * chance.choice([0.0, 0.2, 0.4])
    return {"body.1.inner_radius": 0.05 * chance.choice([0.5, 0.7, 0.8]), "body.1.velocity.2": -speed,
            "body.1.position": [off, (0.1001**2 - off**2) ** 0.5 - 0.05 + 0.0002]} | _friction(chance)


def _block_circle(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    angle, off = chance.choice([0.0, 10.0, 25.0]), 0.03 * chance.random()
    turn = math.radians(angle)  # the lower face, 0.025 from the centre, is just above the disc
    return {"body.1.angle": angle, "body.1.velocity": [speed * chance.choice([0.0, 0.5]), -speed],
            "body.1.position": [off, (0.0653 + off * math.sin(turn)) / math.cos(turn)]} | _friction(chance)


def _rubber(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    return {"speed": speed}


def _slab(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    stiffer = chance.choice(UNLIKE)
    speed *= min(1.0, stiffer**0.5)
    return {"body.1.young": material["young"] * stiffer, "body.1.density": material["density"] * chance.choice([0.3, 1.0, 3.0]),
            "body.1.velocity": [speed * chance.choice([0.0, 0.5]), -speed],
            "body.2.height": 0.04, "body.2.width": 0.2 * chance.choice([0.5, 1.0])} | _friction(chance)


def _ball_cylinder(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    stiffer = chance.choice(UNLIKE)
    return {"body.1.young": material["young"] * stiffer, "body.1.velocity": -speed * min(1.0, stiffer**0.5),
            "body.2.height": 0.1, "body.2.radius": 0.15 * chance.choice([0.5, 1.0])} | _friction(chance)


def _strip(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    return {"body.1.position": [0.02 * chance.choice([0, 1, 2]), 0.0303], "body.1.velocity.2": -speed,
            "body.2.width": 0.2 * chance.choice([0.6, 1.0, 1.4])}


def _plate(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    return {"body.1.velocity": -speed, "body.2.radius": 0.1 * chance.choice([0.6, 1.0, 1.4])}


def _other_layer(chance: random.Random, material: Point) -> tuple[Point, float]:
    """The entries of a layer of another material, half of them with a loss, and the factor of the speed
    of waves in the softer material."""
    stiffer = chance.choice(UNLIKE)
    layer = {"young": material["young"] * stiffer, "density": material["density"] * chance.choice([0.3, 1.0, 3.0])}
    layer |= {"loss": chance.choice(LOSSES)} if chance.random() < 0.5 else {}
    return {f"layer.1.{name}": value for name, value in layer.items()}, min(1.0, stiffer**0.5)


def _layered_disc(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    layer, slower = _other_layer(chance, material)
    entries = {"layer.1.radius": 0.05 * chance.choice([0.5, 0.8, 0.93]), "velocity": [speed * slower * chance.choice([0.0, 0.5]), -speed * slower]}
    return {f"body.1.{name}": value for name, value in (layer | entries).items()} | _friction(chance)


def _layered_ball(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    layer, slower = _other_layer(chance, material)
    entries = {"layer.1.radius": 0.05 * chance.choice([0.5, 0.8, 0.93]), "velocity": -speed * slower}
    return {f"body.1.{name}": value for name, value in (layer | entries).items()} | _friction(chance)


def _layered_pad(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    layer, slower = _other_layer(chance, material)
    edge = {"kind": "half-plane", "point": [0.0, chance.choice([-0.01, 0.0, 0.014])], "normal": [0.0, 1.0]}
    return {f"body.2.{name}": value for name, value in layer.items()} | {
        "body.2.layer.1.where": edge, "body.1.velocity": [speed * slower * chance.choice([0.0, 0.5]), -speed * slower],
        "body.1.young": material["young"] * chance.choice([1.0, 10.0])} | _friction(chance)


def _lossy_disc(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    return {"loss": chance.choice(LOSSES), "body.1.velocity": [speed * chance.choice([0.0, 0.5]), -speed]} | _friction(chance)


def _lossy_ball(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    return {"loss": chance.choice(LOSSES), "body.1.velocity": -speed} | _friction(chance)


def _lossy_pad(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    return {"body.2.loss": chance.choice(LOSSES), "body.1.young": material["young"] * chance.choice([1.0, 10.0]),
            "body.1.velocity": [speed * chance.choice([0.0, 0.5]), -speed]} | _friction(chance)


def _metal(chance: random.Random, material: Point) -> Point:
    """The entries of a metal."""
    young = material["young"]
    return {"law": "metal", "yield_stress": young * chance.choice(YIELDS), "hardening": young * chance.choice(HARDENINGS)}


def _metal_disc(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    return _metal(chance, material) | {"body.1.velocity": [SLOWER * speed * chance.choice([0.0, 0.5]), -SLOWER * speed]} | _friction(chance)


def _metal_ball(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    return _metal(chance, material) | {"body.1.velocity": -SLOWER * speed} | _friction(chance)


def _metal_pad(chance: random.Random, speed: float, c: float, material: Point) -> Point:
    return {f"body.2.{name}": value for name, value in _metal(chance, material).items()} | {
        "body.1.velocity": [SLOWER * speed * chance.choice([0.0, 0.5]), -SLOWER * speed]} | _friction(chance)


OTHER_SHAPES = {"ball-sphere": _ball_sphere, "ellipsoid-bowl": _ellipsoid_bowl, "ellipsoid-cylinder": _ellipsoid_cylinder,
                "shell-wall": _shell, "gas-shell": _gas_shell, "ring-circle": _ring, "block-circle": _block_circle,
                "disc-normal": _rubber, "ball-axisymmetric": _rubber, "disc-slab": _slab, "ball-cylinder": _ball_cylinder,
                "disc-strip": _strip, "ball-plate": _plate, "disc-free-strip": _strip,
                "layered-disc": _layered_disc, "layered-ball": _layered_ball, "layered-pad": _layered_pad,
                "lossy-disc": _lossy_disc, "lossy-ball": _lossy_ball, "lossy-pad": _lossy_pad,
                "metal-disc": _metal_disc, "metal-ball": _metal_ball, "metal-pad": _metal_pad}
