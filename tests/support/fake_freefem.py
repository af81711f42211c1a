"""A substitute for FreeFem++ in tests: the same flags, files and exit codes, without physics.

The variable FAKE selects the behaviour: ok (default), silent (exit 0, no summary), nan, step (11),
material (12), crash, plugin, slow (a minute), brief (half a second), old, ten, noplugin. Every
start for a run adds a line to the file FAKE_COUNT. It starts quickly: it imports the standard library only.
"""

import json
import math
import os
import shutil
import struct
import sys
import time
from pathlib import Path

COLUMNS = ("t dt normal_force friction_force kinetic elastic contact friction_work external_work balance momentum_x momentum_y "
           "angular_momentum vx vy spin max_penetration contact_size sliding_fraction min_jacobian min_stretch newton_iterations min_ellipticity")
# The real FreeFem++ answers version.edp, which needs no physics.
REAL = os.environ.get("FAKE_REAL") or shutil.which("FreeFem++")
BANNERS = {"old": '{"version": "4.6"}', "ten": '-- FreeFem++ v4.10 (date - git no git)\n{"version": "4.1"}'}
ENERGY, MASS, SPEED, CONTACT = 432.8, 13.525, 8.0, 4.67e-3


def write_history(folder: Path, rows: int = 200, bad: bool = False) -> None:
    """Writes the history of a bounce: half a sine of force with waves, and energies that add up to
    ENERGY."""
    vy, dt = -SPEED, CONTACT / (rows - 10)
    lines = [COLUMNS.replace(" ", ",")]
    for i in range(rows):
        t = i * dt
        phase = math.pi * t / CONTACT
        force = max(0.0, 70e3 * math.sin(phase) * (1 + 0.15 * math.sin(12 * phase)))
        vy = -SPEED * math.cos(min(phase, math.pi)) * (1 - 0.075 * min(t / CONTACT, 1))
        contact = 8 * (force / 70e3) ** 2
        kinetic = 0.5 * MASS * vy**2 + 20 * math.sin(phase) ** 2
        value = dict(t=t, dt=dt, normal_force=force, kinetic=kinetic, contact=contact, elastic=ENERGY - kinetic - contact,
                     balance=1e-11 * ENERGY * math.sin(7 * phase + 1), momentum_y=MASS * vy, vy=vy, min_jacobian=0.8,
                     min_stretch=0.7, newton_iterations=3)
        if bad and i == 7:
            value["elastic"] = math.nan
        lines.append(",".join(f"{value.get(name, 0.0):.17g}" for name in COLUMNS.split()))
    (folder / "history.csv").write_text("\n".join(lines) + "\n")


def write_fields(folder: Path, count: int) -> None:
    """Writes snapshots of half a disc of quadratic triangles (fan of rings) that is compressed and
    released."""
    (folder / "fields").mkdir(exist_ok=True)
    rings, sectors, radius = 12, 24, 0.05
    points = [(radius * i / (2 * rings) * math.sin(math.pi * j / (2 * sectors)),
               radius - radius * i / (2 * rings) * math.cos(math.pi * j / (2 * sectors)))
              for i in range(2 * rings + 1) for j in range(2 * sectors + 1)]
    node = lambda i, j: i * (2 * sectors + 1) + j   # noqa: E731
    cells = []
    for i in range(0, 2 * rings, 2):
        for j in range(0, 2 * sectors, 2):
            cells.append([node(i, j), node(i + 2, j), node(i + 2, j + 2),
                          node(i + 1, j), node(i + 2, j + 1), node(i + 1, j + 1)])
            if i:
                cells.append([node(i, j), node(i + 2, j + 2), node(i, j + 2),
                              node(i + 1, j + 1), node(i + 1, j + 2), node(i, j + 1)])
    sets = []
    for k in range(count):
        t = 1.1 * CONTACT * k / max(count - 1, 1)
        squeeze = 0.35 * max(0.0, math.sin(math.pi * t / CONTACT))
        lift = max(0.0, t - CONTACT) * SPEED
        displacement = [(0.6 * squeeze * x, -squeeze * y * (1 - 0.3 * y / 0.1) + lift, 0.0) for x, y in points]
        stress = [1e6 * squeeze * (1.2 - y / 0.1) for x, y in points]
        _write_vtu(folder / f"fields/{k:04d}.vtu", points, cells, displacement, stress)
        sets.append(f'<DataSet timestep="{t:.9g}" file="fields/{k:04d}.vtu"/>')
    (folder / "fields.pvd").write_text('<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1"><Collection>\n'
                                       + "\n".join(sets) + "\n</Collection></VTKFile>\n")


def _write_vtu(path: Path, points, cells, displacement, stress) -> None:
    def array(name, rows, kind="Float64", width=1):
        text = "\n".join(" ".join(f"{v:.9g}" for v in row) for row in rows)
        components = f' NumberOfComponents="{width}"' if width > 1 else ""
        return f'<DataArray type="{kind}" Name="{name}"{components} format="ascii">\n{text}\n</DataArray>'
    path.write_text(
        '<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>'
        f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">\n<Points>'
        + array("Points", [(x, y, 0.0) for x, y in points], width=3) + "</Points>\n<Cells>"
        + array("connectivity", cells, "Int64") + array("offsets", [[6 * (k + 1)] for k in range(len(cells))], "Int64")
        + array("types", [[22]] * len(cells), "UInt8") + "</Cells>\n<PointData>"
        + array("displacement", displacement, width=3) + array("velocity", displacement, width=3)
        + array("jacobian", [[0.9]] * len(points)) + array("von_mises", [[s] for s in stress])
        + "</PointData>\n</Piece></UnstructuredGrid></VTKFile>\n")


SCENE = """title = "A disc falls normally on a rigid plane"
script = "bodies"
dimension = "plane-strain"
symmetry = "half"
gravity = 0.0
degree = 2
integrator = "energy-momentum"
accuracy = 0.005
end_time = 0.0
until = "impact"
fields = 9

[[body]]
name = "disc"
shape = "disc"
radius = 0.05
position = [0, 0.05]
speed = 8
direction = -90
law = "svk"
young = 7e6
nu = 0.45
density = 1722.0
mesh_size = 0.016
contact_mesh_size = 0.005

[[obstacle]]
name = "plane"
kind = "plane"
point = [0.0, 0.0]
normal = [0.0, 1.0]

[contact]
penalty = 1e10
friction_static = 0.0
friction_dynamic = 0.0
exponent = 1.0
slip_velocity = 0.02
regularization = "linear"
"""


def write_scene(folder: Path) -> None:
    """Writes a scene.toml. The snapshots show half a disc."""
    (folder / "scene.toml").write_text(SCENE)


def summary(status: str = "ok", message: str = "") -> dict:
    """The content of summary.json without provenance."""
    return dict(status=status, message=message, ended="impact", integrator="energy-momentum", warnings=[], contact_time=CONTACT, contact_intervals=1,
                peak_force=70e3, impulse=208.2,
                rebound_vx=0.0, rebound_vy=7.394, rebound_spin=0.0, energy_initial=ENERGY, energy_final=ENERGY, vibration_energy=60.0,
                friction_work=0.0, energy_drift=1e-11, momentum_drift=1e-12, min_jacobian=0.8, min_stretch=0.7,
                breakdown_time=None, max_penetration=6e-6, sliding_time=0.0, sticking_time=0.0, steps=199, rejected_steps=3,
                newton_iterations=700, factorizations=9, dofs=1510, wall_seconds=0.1, cpu_seconds=0.1, thresholded_contact_time=0.99 * CONTACT, mass=MASS,
                phase_seconds=dict(assembly=0.01, factor=0.02, solve=0.03, contact=0.01, output=0.01),
                skipped=["half of the disc", "friction", "gravity", "error estimate"])


def whole(data: bytes, name: str) -> int:
    """The whole number `name` in a file of ffimpact.freefem.arrays: name, kind, rows, columns, value."""
    at = data.index(name.encode().ljust(48, b"\0") + b"whole")
    return struct.unpack_from("<qqq", data, at + 56)[2]


def main(arguments: list[str]) -> int:
    mode = os.environ.get("FAKE", "ok")
    if any("/version.edp" in word for word in arguments):
        if mode == "noplugin":
            print("Load error: Element_QF")
            return 2
        if mode in BANNERS:
            print(BANNERS[mode])
            return 0
        os.execv(REAL, [REAL, *arguments])
    if count := os.environ.get("FAKE_COUNT"):
        with open(count, "a") as file:
            print(os.getpid(), file=file)
    script = next(i for i, word in enumerate(arguments) if word.endswith(".edp"))
    flags = [word for word in arguments[script + 1:] if not word.startswith("-D")]
    values = {name[1:]: text for name, text in zip(flags[::2], flags[1::2])}
    folder = Path(values.pop("out"))
    fields = whole(Path(values.pop("scene")).read_bytes(), "fields")
    for k in range(1, 4):
        print(f"progress {k / 4} t={k * 1e-3} steps={k * 50}", flush=True)
    if mode in ("slow", "brief"):
        time.sleep(60 if mode == "slow" else 0.5)
    if mode in ("step", "material"):
        code, message = (11, "step: no convergence at t = 1.2e-3 s, dt = 1e-9 s, residual 3e-4") if mode == "step" else (
            12, "material: det F = -0.1 at t = 2.1e-3 s, x = 0.001 m, y = 0.002 m")
        write_history(folder)
        (folder / "failure.json").write_text(json.dumps(summary(mode, message)))
        print(f"ffimpact: {message}", file=sys.stderr)
        return code
    if mode == "chatter":
        # The output stops in the middle of a line, as that of a full buffer does.
        print("progress 0.5 t=", end="", flush=True)
        print("ffimpact: chatter", file=sys.stderr)
        return 11
    if mode == "crash":
        print("some assertion failed", flush=True)
        os.abort()
    if mode == "plugin":
        print("Load error: Element_QF")
        return 2
    write_history(folder, bad=mode == "nan")
    if fields:
        write_fields(folder, fields)
    if mode != "silent":
        (folder / "summary.json").write_text(json.dumps(summary()))
    return 0


if __name__ == "__main__":
    sys.exit(0 if "try.edp" in sys.argv else main(sys.argv[1:]))   # kernels.build() tries the plugin
