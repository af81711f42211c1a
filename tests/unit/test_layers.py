"""Layers of a body: what is refused, and the mesh between them."""

import math

import numpy as np
import pytest

import ffimpact as ff
from ffimpact.failure import BadInput
from ffimpact.mesh.mesh import INTERFACE, interfaces
from ffimpact.scenes import assembly

RADIUS = 0.05
RUBBER = {"law": "neohookean", "young": 7e6, "nu": 0.45, "density": 1722.0}
LOW = {"kind": "half-plane", "point": [0, 0.01], "normal": [0.3, -1]}


def scene(*layers, dimension="plane-strain", shape="disc", size=0.02, accuracy=0.02, **more) -> ff.Scene:
    """A body with layers above a plane."""
    of_shape = {} if shape == "rectangle" else {"radius": RADIUS}
    body = {"shape": shape, "position": [0, 0.06], "velocity": [0, -1], "layer": list(layers), "mesh_size": size} | of_shape | RUBBER | more
    return ff.Scene.read({"dimension": dimension, "accuracy": accuracy, "body": [body], "obstacle": [{"kind": "plane"}]})


def made(*layers, **more) -> assembly.Assembly:
    return assembly.assemble(scene(*layers, **more).ready())


def areas(built: assembly.Assembly) -> np.ndarray:
    """The areas of the triangles of each material, over those of all."""
    a, b, c = (built.mesh.points[built.mesh.triangles[:, k]] for k in range(3))
    own = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    assert (own > 0).all()
    return np.bincount(built.arrays["mesh.materials"], own) / own.sum()


def test_a_layer_takes_what_it_does_not_set_from_its_body():
    """The keyword `layers` is that of the table `layer`; a Material sets law and moduli together."""
    steel = ff.NeoHookean(young=1e9, nu=0.3, density=7800)
    body = ff.Disc(radius=RADIUS, position=(0, 0.06), velocity=(0, -1), layers=[ff.Layer(radius=0.03, young=1e6), ff.Layer(radius=0.02, material=steel)],
                   **RUBBER)  # fmt: skip
    read = ff.Scene(bodies=[body], obstacles=[ff.Plane()]).ready().bodies[0]
    own, soft, hard = read.materials
    assert (soft.young, soft.nu, soft.density, soft.law) == (1e6, 0.45, 1722, "neohookean")
    assert (hard.young, hard.nu, hard.density) == (1e9, 0.3, 7800) and own.young == 7e6 and read.made_of == own


@pytest.mark.parametrize("layers, more, words", [
    ([{"radius": 0.05}], {}, ["body.1.layer.1.radius: 0.05", "between 0 and 0.05"]),
    ([{"radius": 0.07}], {}, ["body.1.layer.1.radius: 0.07", "between 0 and 0.05"]),
    ([{"radius": 0.049_999_5}], {}, ["body.1.layer.1.radius", "1e-06 m apart"]),
    ([{"radius": 0.03}, {"radius": 0.030_000_5}], {}, ["body.1.layer.1.radius", "1e-06 m apart"]),
    ([{"radius": 0.02}], {"shape": "ring", "inner_radius": 0.03}, ["body.1.layer.1.radius: 0.02", "between 0.03 and 0.05"]),
    ([{"radius": 0.02}], {"shape": "rectangle", "width": 0.05, "height": 0.05}, ["body.1.layer.1.radius: 0.02", "is not round"]),
    ([{"radius": 0.02, "where": LOW}], {}, ["body.1.layer.1.where", "one of radius, where"]),
    ([{"young": 1e6}], {}, ["body.1.layer.1.radius: is missing", "one of radius, where"]),
    ([{"radius": 0.02, "where": "left"}], {}, ["body.1.layer.1.where: 'left' is no region"]),
    ([{"where": {"kind": "disc", "centre": [0, 0], "radius": 5e-7}}], {}, ["body.1.layer.1.where", "5e-07 m thin"]),
    ([{"where": {"kind": "box", "low": [0, 0], "high": [0.01, 5e-7]}}], {}, ["body.1.layer.1.where", "5e-07 m thin"]),
    ([{"where": {"kind": "box", "low": [1, 1], "high": [2, 2]}}], {}, ["body.1.layer.1: has no part of 'body1'"]),
    ([{"where": {"kind": "box", "low": [0, 0], "high": [0.01, 0.01]}}] * 2, {}, ["body.1.layer.1: has no part of 'body1'"]),
    ([{"radius": 0.02}] * 1000, {}, ["body.1.layer: 1000 of them", "up to 100"]),
    ([{"radius": 0.02, "nu": 0.6}], {}, ["body.1.layer.1.nu: 0.6"]),
    ([{"radius": 0.02, "nu": 0.49995}], {}, ["body.1.layer.1.nu: 0.49995"]),
    ([{"radius": 0.02, "yung": 1}], {}, ["body.1.layer.1.yung: no such entry", "young"]),
    ([{"radius": 0.02}], {"rigid": True, "law": None, "young": None, "nu": None}, ["body.1.layer: a rigid body has none"]),
    ([{"where": {"kind": "disc", "centre": [0.02, 0], "radius": 0.01}}], {"dimension": "axisymmetric", "shape": "ball"}, ["body.1.layer.1.where", "is not of revolution"]),
    ([{"radius": 0.05}], {"dimension": "3d", "shape": "cylinder", "height": 0.05, "position": [0, 0.06, 0], "velocity": [0, -1, 0]}, ["body.1.layer.1.radius: 0.05", "between 0 and 0.05"]),
    ([{"radius": 0.02}], {"dimension": "3d", "shape": "box", "width": 0.1, "depth": 0.1, "height": 0.1, "position": [0, 0.06, 0], "velocity": [0, -1, 0]}, ["body.1.layer.1.radius: 0.02", "is not round"]),
])  # fmt: skip
def test_what_is_no_layer_is_refused_in_one_line(layers, more, words):
    with pytest.raises(BadInput) as caught:
        entries = {name: value for name, value in more.items() if value is not None}
        dropped = [name for name, value in more.items() if value is None]
        read = {name: value for name, value in RUBBER.items() if name not in dropped}
        build(layers, entries, read)
    lines = str(caught.value).splitlines()
    assert len(lines) == 1 and all(word in lines[0] for word in words), lines


def build(layers, more, material):
    of_shape = {} if more.get("shape") in ("rectangle", "box") else {"radius": RADIUS}
    top = {"dimension": more.get("dimension", "plane-strain")}
    body = {"shape": "disc", "position": [0, 0.06], "velocity": [0, -1], "layer": layers} | of_shape | material
    body |= {name: value for name, value in more.items() if name != "dimension"}
    if more.get("rigid"):
        body |= {"density": 1000.0}
    assembly.assemble(ff.Scene.read(top | {"body": [body], "obstacle": [{"kind": "plane"}], "contact": {"penalty": 1e9}}).ready())


@pytest.mark.parametrize("kind, spin", [("plane-strain", 0.0), ("plane-strain", 1.0), ("axisymmetric", None)])
def test_a_mesh_follows_circles_about_the_centre(kind, spin):
    """Sides between layers have their label, and their ends lie on the circle; smaller radii win."""
    built = made({"radius": 0.03, "young": 1e6}, {"radius": 0.045, "young": 2e6}, {"radius": 0.01, "young": 3e6}, dimension=kind,
                 shape="disc" if spin is not None else "ball", **({"spin": spin} if spin else {}))  # fmt: skip
    between = built.mesh.edges[built.mesh.labels == INTERFACE]
    radius = np.linalg.norm(built.mesh.points[between] - built.centres[0], axis=2)
    assert np.ptp(radius, axis=1).max() < 1e-15 and {round(r, 6) for r in radius.ravel()} == {0.01, 0.03, 0.045}
    share = areas(built)[[3, 1, 2, 0]]
    assert np.cumsum(share)[:3] == pytest.approx([0.04, 0.36, 0.81], rel=0.08)
    assert (built.arrays["mesh.arc_of"][built.mesh.labels == INTERFACE] > 0).all()


@pytest.mark.parametrize("kind, spin", [("plane-strain", 0.0), ("plane-strain", 1.0), ("axisymmetric", None)])
def test_elements_between_a_core_and_a_thin_cover(kind, spin):
    """Sides on the circle are no longer than the cover is thick, also of a half, so that no curved element folds over."""
    shape = {"shape": "disc" if spin is not None else "ball", **({"spin": spin} if spin else {})}
    built = made({"radius": 0.047}, dimension=kind, **shape)
    ends = built.mesh.points[built.mesh.edges[built.mesh.labels == INTERFACE]]
    assert np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).max() < 1.3 * 0.003


@pytest.mark.parametrize("kind", ["plane-strain", "axisymmetric"])
def test_elements_at_layers_follow_the_accuracy(kind):
    """So that the coarser runs of an error estimate have longer ones, too: by the factor 2 for four times the accuracy.
    They never bend by more than a third of the cover."""
    longest = {}
    for accuracy in (0.005, 0.02, 0.4):
        read = scene({"radius": 0.046}, dimension=kind, shape="disc" if kind == "plane-strain" else "ball", size=0.0, accuracy=accuracy)
        built = assembly.assemble(read.ready())
        ends = built.mesh.points[built.mesh.edges[built.mesh.labels == INTERFACE]]
        longest[accuracy] = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).max()
    assert longest[0.02] == pytest.approx(0.004, rel=0.2) and longest[0.005] == pytest.approx(0.002, rel=0.2)
    assert longest[0.4] > 0.008 and longest[0.4] ** 2 / (8 * 0.046) < 0.004 / 3


def test_regions_cut_along_straight_lines_and_the_later_one_wins():
    """A circular segment, a box across the outline, and a disc on its corner: their areas are exact but for
    the chords of circles."""
    height, normal = 0.01 / math.hypot(0.3, 1), LOW["normal"]
    assert normal[1] < 0
    angle = math.acos(height / RADIUS)
    segment = (angle - math.sin(angle) * math.cos(angle)) / math.pi
    assert areas(made({"where": LOW}, size=0.004)) == pytest.approx([segment, 1 - segment], abs=2e-3)
    box = {"kind": "box", "low": [-0.01, -0.02], "high": [0.02, 0.02]}
    disc = {"kind": "disc", "centre": [0.02, 0.02], "radius": 0.01}
    whole = math.pi * RADIUS**2
    shares = np.array([0.03 * 0.04 - math.pi * 1e-4 / 4, math.pi * 1e-4]) / whole
    assert areas(made({"where": box}, {"where": disc}, size=0.004))[1:] == pytest.approx(shares, rel=0.03)


def test_plies_that_touch_have_one_line_between_them():
    """The edges of two boxes on each other, and on the outline, are one line of sides."""
    plies = [{"where": {"kind": "box", "low": [-1, -0.025 + 0.01 * k], "high": [1, -0.015 + 0.01 * k]}, "young": 1e6 * (k + 1)} for k in range(5)]
    built = made(*plies, shape="rectangle", width=0.1, height=0.05, size=0.01)
    assert areas(built) == pytest.approx([0, *[0.2] * 5], abs=1e-12)
    ends = built.mesh.points[built.mesh.edges[built.mesh.labels == INTERFACE]] - built.centres[0]
    assert abs(ends[:, 0, 1] - ends[:, 1, 1]).max() < 1e-12 and np.unique(ends[..., 1].round(9)).tolist() == pytest.approx([-0.015, -0.005, 0.005, 0.015])
    length = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).sum()
    assert length == pytest.approx(4 * 0.1 / (1 if built.mesh.points[:, 0].min() < 0 else 2), abs=1e-12)


@pytest.mark.parametrize("layers, shares", [
    ([{"kind": "box", "low": (-0.03, -0.01, -0.02), "high": (0.03, 1, 0.02)}], [0.8, 0.2]),
    ([{"kind": "half-space", "point": (0, 0, 0), "normal": (0, 1, 0)}, {"kind": "half-space", "point": (0, 0.02, 0), "normal": (0, 2, 0)}], [1 / 2, 1 / 3, 1 / 6]),
    ([{"kind": "half-space", "point": (0, 0, 0), "normal": (1, 1, 1)}], [1 / 2, 1 / 2]),
])  # fmt: skip
def test_solids_are_cut_by_planes(layers, shares):
    """The volumes of the layers of a turned box are exact."""
    body = ff.Box(width=0.1, height=0.06, depth=0.08, layers=[ff.Layer(where=where) for where in layers], position=(0, 0.1, 0), velocity=(0, -1, 0),
                  turn=(10, 20, 30), **RUBBER)  # fmt: skip
    built = assembly.assemble(ff.Scene(bodies=[body], obstacles=[ff.Plane()], accuracy=0.05).ready())
    assert np.bincount(built.arrays["mesh.materials"], built.mesh.volumes) == pytest.approx(np.array(shares) * 0.1 * 0.06 * 0.08, rel=1e-9)


def test_faces_between_layers_of_a_ball_are_on_a_sphere():
    """Vertices to round-off, so that the faces are curved."""
    body = ff.Ball(radius=RADIUS, position=(0, 0.06, 0), velocity=(0, -1, 0), layers=[ff.Layer(radius=0.03)], **RUBBER)
    built = assembly.assemble(ff.Scene(bodies=[body], obstacles=[ff.Plane()], accuracy=0.05).ready())
    between = built.mesh.labels == INTERFACE
    radius = np.linalg.norm(built.mesh.points[built.mesh.faces[between]] - built.centres[0], axis=2)
    assert between.sum() > 20 and radius == pytest.approx(0.03, rel=1e-12) and (built.arrays["mesh.arc_of"][between] == 1).all()


@pytest.mark.parametrize("shape, inner, turn", [(ff.Cylinder, 0.0, (0, 0, 0)), (ff.Cylinder, 0.0, (10, 20, 30)), (ff.Tube, 0.02, (70, 0, 0))])
def test_layers_about_the_axis_of_a_cylinder(shape, inner, turn):
    """Vertices between layers are on a cylinder to round-off; volumes are pi h (R^2 - r^2) up to the chords of
    circles, also of a quarter."""
    hollow = {"inner_radius": inner} if inner else {}
    body = shape(radius=RADIUS, height=0.06, position=(0, 0.1, 0), velocity=(0, -1, 0), turn=turn, layers=[ff.Layer(radius=0.03), ff.Layer(radius=0.045)],
                 **hollow, **RUBBER)  # fmt: skip
    ready = ff.Scene(bodies=[body], obstacles=[ff.Plane()], accuracy=0.05).ready()
    built = assembly.assemble(ready)
    axis = ready.bodies[0].placed_at(0.0, np.zeros(3)).rotation[:, 1]
    between = built.mesh.labels == INTERFACE
    arms = np.cross(built.mesh.points[built.mesh.faces[between]] - built.centres[0], axis)
    radius = np.linalg.norm(arms, axis=2)
    assert np.ptp(radius, axis=1).max() < 1e-15 and {round(r, 12) for r in radius.ravel()} == {0.03, 0.045}
    assert (built.arrays["mesh.arc_of"][between] >= 0).all()
    part = 4 if turn == (0, 0, 0) else 1
    steps = np.array([inner, 0.03, 0.045, RADIUS])
    volumes = np.bincount(built.arrays["mesh.materials"], built.mesh.volumes)[[1, 2, 0]]
    assert volumes == pytest.approx(math.pi * 0.06 * np.diff(steps**2) / part, rel=0.08)


def test_a_thin_cover_in_space():
    """Flat cells of a cover of 1.9 mm belong to it, though their middles are below the sphere that their faces cut."""
    body = ff.Ball(radius=0.0214, position=(0, 0.022, 0), velocity=(1, -3, 0), layers=[ff.Layer(radius=0.0195, young=6e7)], **RUBBER)
    built = assembly.assemble(ff.Scene(bodies=[body], obstacles=[ff.Plane()], accuracy=0.06).ready())
    own, core = np.bincount(built.arrays["mesh.materials"], built.mesh.volumes)
    assert core / (own + core) == pytest.approx((0.0195 / 0.0214) ** 3, rel=0.02)


def test_sides_between_cells_of_different_layers():
    cells = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2]])
    assert np.sort(interfaces(cells, np.array([0, 1, 1]))).tolist() == [[1, 2]] and len(interfaces(cells, np.zeros(3, dtype=int))) == 0


def test_a_given_mesh_has_layers_where_its_sides_are():
    """A square of two triangles: a layer on one side of the diagonal, and one that cuts both."""
    mesh = ff.Mesh(points=[[0, 0], [1, 0], [1, 1], [0, 1]], cells=[[0, 1, 2], [0, 2, 3]], position=(0, 1), velocity=(0, -1),
                   layers=[ff.Layer(where={"kind": "half-plane", "point": [0, 0], "normal": [1, -1]}, young=1e6)], **RUBBER)  # fmt: skip
    assert assembly.assemble(ff.Scene(bodies=[mesh], obstacles=[ff.Plane()]).ready()).arrays["mesh.materials"].tolist() == [1, 0]
    mesh.layer = [ff.Layer(where={"kind": "half-plane", "point": [0, 0.1], "normal": [1, 0]}, young=1e6)]
    with pytest.raises(BadInput, match="body.1.layer: the mesh of 'body1' does not follow it"):
        assembly.assemble(ff.Scene(bodies=[mesh], obstacles=[ff.Plane()]).ready())


def test_the_scene_as_used_reads_back_equal():
    """Also with layers whose loss makes branches."""
    read = scene({"name": "core", "radius": 0.03, "young": 1e6, "loss": 0.1}, {"where": LOW, "viscosity": 5.0})
    built = assembly.assemble(read.ready())
    again = assembly.assemble(ff.Scene.read(built.used))
    assert again.data == built.data and built.used["body"][0]["layer"][0]["name"] == "core"


def test_only_mirrored_layers_let_half_a_disc_do():
    """A box off x = 0 needs the whole disc; circles about the centre and a horizontal cut do not."""
    from ffimpact.scenes.mirror import copies

    flat = {"kind": "half-plane", "point": [0, 0], "normal": [0, 1]}
    assert copies(scene({"radius": 0.02}).ready()) == copies(scene({"where": flat}).ready()) == 2
    assert copies(scene({"where": LOW}).ready()) == copies(scene({"where": flat}, angle=10.0).ready()) == 1


def test_a_side_on_the_plane_of_symmetry_is_no_arc():
    """A layer so small beside the elements that one side is its whole diameter."""
    built = made({"radius": 0.03, "young": 1e6}, {"radius": 0.015, "young": 3e6}, size=0.05, contact_mesh_size=0.05)
    points, sides = built.mesh.points, built.mesh.sides
    on_axis = np.abs(points[sides][:, :, 0]).max(axis=1) == 0
    lengths = np.linalg.norm(np.diff(points[sides[on_axis]], axis=1)[:, 0], axis=1)
    assert lengths.max() == pytest.approx(0.03)
    assert (built.arrays["mesh.arc_of"][on_axis] == -1).all()
