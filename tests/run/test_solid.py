"""Pictures of bodies in three dimensions: surfaces and pressure, and the behaviour without PyVista.
"""

import re
from importlib.util import find_spec

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.__main__ import main
from ffimpact.output import vtu
from ffimpact.report import contact, drawing, figures, movie, solid
from ffimpact.running import run
from tests.support.solid import RADIUS
from tests.support.triangles import areas

COARSE = {"mesh_size": 0.025, "contact_mesh_size": 0.012, "accuracy": 0.1, "fields": 5}


@pytest.fixture(scope="module")
def ball(tmp_path_factory):
    """ball(symmetry): a coarse impact at 2 m/s."""
    made = {}

    def at(symmetry: str):
        if symmetry not in made:
            made[symmetry] = run.run(scene.load("ball"), COARSE | {"speed": 2, "symmetry": symmetry}, tmp_path_factory.mktemp(symmetry) / "out", estimate=False)
        return made[symmetry]
    return at


@pytest.fixture
def no_pyvista(monkeypatch):
    """A Python without PyVista, whatever is installed."""
    monkeypatch.setattr(solid, "PROBE", "import no_such_module")
    solid.missing.cache_clear()
    yield
    solid.missing.cache_clear()


def area(skin: vtu.Skin, points: np.ndarray) -> float:
    a, b, c = (skin.at(points)[skin.triangles[:, k]] for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


@pytest.mark.few(1)
@pytest.mark.parametrize("symmetry", ["quarter", "half", "full"])
def test_surface_of_the_whole_and_of_the_cut_ball(ball, symmetry):
    """For any computed part the whole ball has 4 pi R^2 and no inner faces, to 1 %.

    The cut ball has 3/4 of this and two half discs, or half of it and a disc. Elements of the full
    ball do not follow the plane of the cut: there the cut is larger than the disc.
    """
    axes = solid.AXES.get(symmetry, ())
    body = solid.whole(vtu.read_solid(vtu.series(ball(symmetry).folder / "fields.pvd")[0][1]), axes)
    left = ~solid.in_front(body, axes)
    (every, _), (cut, _) = solid.skin(body.tetrahedra, body.layers), solid.skin(body.tetrahedra[left], body.layers[left])
    assert area(every, body.points) == pytest.approx(4 * np.pi * RADIUS**2, rel=0.01)
    places = body.points + body.fields["displacement"]  # at the start; the mesh of a part is moved there
    assert np.linalg.norm(every.at(places) - (0, RADIUS, 0), axis=1) == pytest.approx(RADIUS, rel=0.01)
    flat = (4 if symmetry == "quarter" else 3) * np.pi * RADIUS**2
    if symmetry == "full":
        assert flat < area(cut, body.points) < area(every, body.points)
    else:
        assert area(cut, body.points) == pytest.approx(flat, rel=0.01)


def test_mirror_image_moves_as_a_mirror_image(ball):
    """Displacement and stress of the image: only x and u_x change their signs."""
    part = vtu.read_solid(vtu.series(ball("quarter").folder / "fields.pvd")[2][1])
    both = solid.whole(part, (0,))
    n = len(part.points)
    for k in range(n, len(both.points), 7):
        twin = np.flatnonzero((np.abs(part.points * (-1, 1, 1) - both.points[k]) < 1e-12).all(axis=1))
        assert len(twin) == 1 and both.fields["displacement"][k] == pytest.approx(part.fields["displacement"][twin[0]] * (-1, 1, 1))
        assert both.fields["von_mises"][k] == part.fields["von_mises"][twin[0]]
    assert len(part.tetrahedra) == len(both.tetrahedra) / 2


def test_pressure_on_the_surface_bears_the_force(ball):
    """The sum of the drawn pressure over the whole surface is the normal force of the history
    within 2 %, and zero without load."""
    result = ball("quarter")
    table, history = contact.read(result.folder), result.history
    t = table.t[table.pressure.argmax()]
    axes = (0, 2)
    body = solid.whole(vtu.read_solid(vtu.series(result.folder / "fields.pvd")[0][1]), axes)
    skin, _ = solid.skin(body.tetrahedra, body.layers)
    vertices = skin.at(body.points)
    drawn = solid.Pressure(table, axes, vertices)
    a, b, c = (vertices[skin.triangles[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    force = (drawn.at(t)[skin.triangles].mean(axis=1) * areas).sum()
    assert force == pytest.approx(history["normal_force"][np.abs(history["t"] - t).argmin()], rel=0.02)
    assert drawn.at(t).max() <= drawn.largest and not drawn.at(0.9 * table.t.min()).any()


def test_without_pyvista_the_rest_is_drawn(ball, no_pyvista, capsys):
    """All other figures are drawn, one line reports what is missing, and the exit code is 0. The
    film shows the section."""
    result = ball("quarter")
    (result.folder / "figures/solid.png").unlink(missing_ok=True)
    assert main(["figures", str(result.folder)]) == 0
    captured = capsys.readouterr()
    assert "contact.png" in captured.out and "solid.png" not in captured.out and not (result.folder / "figures/solid.png").exists()
    assert re.fullmatch(r"ffimpact: without figures/solid.png: PyVista is not installed \(\S+ -m pip install pyvista vtk\)\n", captured.err)
    stage = movie.stage_of(result)
    stage.show(2e-3)
    assert isinstance(stage, movie.PlaneStage)
    figures.plt.close(stage.figure)


def test_a_crash_of_the_renderer_is_said_and_harms_nothing(ball, monkeypatch, capfd):
    """VTK crashes without OpenGL: a test process crashes instead of the program."""
    monkeypatch.setattr(solid, "PROBE", "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)")
    solid.missing.cache_clear()
    assert main(["figures", str(ball("quarter").folder)]) == 0
    solid.missing.cache_clear()
    assert "PyVista cannot render here" in capfd.readouterr().err


@pytest.mark.robustness
def test_a_run_says_nothing_of_it(ball, no_pyvista, tmp_path, capfd):
    """`make ball` without PyVista draws its figures and prints nothing on stderr."""
    settings = [f"{name}={value}" for name, value in COARSE.items()]
    assert main(["run", "ball", "--set", *settings, "end_time=2e-4", "speed=2", "--out", str(tmp_path / "out")]) == 0
    assert capfd.readouterr().err == "" and (tmp_path / "out/figures/energies.png").exists()


@pytest.mark.skipif(not find_spec("pyvista"), reason="PyVista is not installed")
@pytest.mark.parametrize("symmetry", ["quarter", "half"])
def test_picture_and_film(ball, symmetry):
    """solid.png, and a stage whose views show the body, change with time and show no pressure
    before contact."""
    result = ball(symmetry)
    if reason := solid.missing():
        pytest.skip(reason)
    assert result.folder / "figures/solid.png" in drawing.draw(result.folder)
    stage = movie.stage_of(result)
    assert isinstance(stage, movie.SolidStage)
    start = [picture.get_array().copy() for picture in stage.pictures]
    stage.show(float(stage.times[len(stage.times) // 2]))
    for before, picture in zip(start, stage.pictures):
        now = picture.get_array()
        assert (now.min(axis=2) < 250).mean() > 0.15 and (now != before).any()
    red = [((image[..., 0] > 150) & (image[..., 1] < 90)).sum() for image in (start[1], stage.pictures[1].get_array())]
    assert red[0] == 0 < red[1]
    figures.plt.close(stage.figure)


@pytest.mark.robustness
def test_whole_ball_is_cut_for_figures_and_films(ball, no_pyvista, tmp_path):
    """Without a plane of symmetry in the mesh and without PyVista the section is a disc of the
    ball's radius with one closed outline.

    Its shapes are drawn.
    """
    result = ball("full")
    t, path = vtu.series(result.folder / "fields.pvd")[0]
    snapshot = vtu.read(path)
    assert areas(snapshot).sum() == pytest.approx(np.pi * RADIUS**2, rel=0.02)
    outline = figures.pose_at(t, path, result.history).outline
    assert len(outline) > 12 and np.hypot(*(outline - (0, RADIUS)).T) == pytest.approx(RADIUS, rel=0.03)
    assert "shapes" in {drawn.stem for drawn in drawing.draw(result.folder)}
    stage = movie.stage_of(result)
    assert isinstance(stage, movie.PlaneStage)
    stage.show(stage.times[1])
    figures.plt.close("all")


def test_obstacles_are_in_the_views(ball):
    """For a scene of one body the plane y = 0 is shown, for a scene of bodies its obstacles."""
    result = ball("quarter")
    views = solid.Views(vtu.series(result.folder / "fields.pvd"), contact.read(result.folder), result.scene)
    assert [obstacle.kind for obstacle in views.rigid] == ["plane"]
    assert views.rigid[0].gap(np.array([[0.1, 0.02, 0.3]])) == pytest.approx([0.02])
    among = dict(script="bodies-3d", dimension="3d", symmetry="quarter", obstacle=[dict(kind="sphere", centre=[0, -0.1, 0], radius=0.05)])
    views = solid.Views(vtu.series(result.folder / "fields.pvd"), contact.read(result.folder), among)
    assert [obstacle.kind for obstacle in views.rigid] == ["sphere"] and views.at(views.times[1]).t == pytest.approx(views.times[1])
