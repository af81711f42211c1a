"""Numbers, warnings, states, pictures and reports of stored records (tests/support/records.py)."""

import functools
from importlib.util import find_spec

import matplotlib.pyplot as plt
import numpy as np
import pytest
from PIL import Image

import ffimpact as ff
from ffimpact.__main__ import main
from ffimpact.output.results import mechanical_energy
from ffimpact.report import compare, contact, drawing, impacts, movie, report
from tests.support import loop
from tests.support.records import evaluated

PICTURES = {
    "slide": {"energies", "velocity", "force", "rolling", "shapes", "flight", "contact"},
    "discs": {"energies", "velocity", "force", "shapes", "contact"},
    "ball": {"energies", "velocity", "force", "shapes", "contact"},
    "axisymmetric": {"energies", "velocity", "force", "shapes", "contact", "vibration"},
    "rest": {"energies", "velocity", "force", "bounces", "height"},
}


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """result(name): a stored run, evaluated once."""
    return functools.cache(lambda name: evaluated(name, tmp_path_factory.mktemp("records") / name))


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


# ---- numbers

def test_bodies_exchange_momentum(result):
    """Two discs: opposite impulses, which are the changes of momentum; friction and energy add up."""
    run = result("discs")
    history = run.history
    for axis in "xy":
        assert run[f"impulse_{axis}_1"] == pytest.approx(-run[f"impulse_{axis}_2"], rel=1e-9)
        assert run[f"impulse_{axis}_1"] == pytest.approx(history[f"momentum_{axis}_1"].iloc[-1] - history[f"momentum_{axis}_1"][0], rel=1e-6)
    assert run["impulse"] == pytest.approx(np.hypot(run["impulse_x_1"], run["impulse_y_1"]), rel=0.02)
    assert run["energy_initial"] == pytest.approx(run["energy_final"] + run["friction_work"], rel=1e-9)
    assert run["friction_work"] == pytest.approx(run["creep_work"] + run["slip_work"], rel=0.03)
    row, = run.contacts.itertuples()
    assert (row.body, row.partner) == (1, 2) and run["restitution"] == pytest.approx(row.separation / row.approach, rel=1e-6)
    assert run["mass_1"] == pytest.approx(1722 * np.pi * 0.05**2, rel=1e-3) and run.units["impulse"] == "N s/m"


def test_a_ball_has_no_thickness(result):
    """Numbers of a quarter and of revolution are those of the whole ball: no unit is per metre. They
    are the same impact, on coarse meshes of the ball in space."""
    ball, flat = result("ball"), result("axisymmetric")
    for run in (ball, flat):
        assert run.units["impulse"] == "N s" and run.units["peak_force"] == "N"
        assert run["impulse"] == pytest.approx((run.history.normal_force * run.history.dt).sum(), rel=1e-6)
        assert run["energy_initial"] == pytest.approx(32 * run["mass"], rel=1e-3)
    assert flat["mass"] == pytest.approx(4 / 3 * np.pi * 0.05**3 * 1722, rel=1e-3)
    assert ball["impulse"] / ball["mass"] == pytest.approx(flat["impulse"] / flat["mass"], rel=0.03)
    assert [words.split(":")[0] for words in ball.warnings] == ["contact points", "locking"] and not flat.warnings


def test_rest_follows_the_bounces(result):
    """A disc falls by 10 mm, bounces twice with loss and rests on the plane under its weight."""
    run = result("rest")
    assert run["bounces"] == 2 and run["ended"] == "rest" and 0.05 < run["rest_time"] < run.history.t.iloc[-1]
    first = run.contacts.iloc[0]
    assert first.approach == pytest.approx(np.sqrt(2 * 9.81 * 0.01), rel=1e-2) and first.restitution == pytest.approx(first.separation / first.approach)
    assert run["first_restitutions"][0] == pytest.approx(first.restitution)
    assert run.history.normal_force.iloc[-1] == pytest.approx(9.81 * run["mass"], rel=0.05)
    (warning,) = run.warnings
    assert warning.startswith("penalty: it stores 10 %")


# ---- states

@pytest.mark.parametrize("name", ["discs", "ball", "axisymmetric"])
def test_contact_points_carry_the_force(result, name):
    """Pressure times weight adds up to the normal load of the history, once for each body."""
    run = result(name)
    points, bodies = contact.read(run.folder), 2 if name == "discs" else 1
    loads = run.history.normal_load if name == "discs" else run.history.normal_force
    for t in np.unique(points.t):
        here = points.t == t
        force = (points.pressure * points.weight)[here].sum() / bodies
        assert force == pytest.approx(loads[(run.history.t - t).abs().idxmin()], rel=1e-5)


def test_states_are_those_of_the_history(result):
    """Mean velocities of the states are those of the history; the largest von Mises stress of a kept
    state is at most that of the run. A point is followed."""
    run = result("discs")
    states = run.fields
    assert len(states) == 2 and len(states.times) == 2
    assert 0 < states[-1].von_mises.max() <= 1.001 * run["max_von_mises"]
    assert states[-1].to_meshio().point_data["von_mises"].max() == states[-1].von_mises.max()
    path = run.probe(0, 0, body=1)
    centre = [np.interp(t, run.history.t, run.history.x_1) for t in states.times]
    assert path.x.to_numpy() == pytest.approx(centre, abs=2e-3) and np.ptp(path.x) > 1e-3


# ---- pictures

@pytest.mark.parametrize("name", PICTURES)
def test_pictures_of_a_run(result, name):
    """Each picture has a title and curves; names are those of the files."""
    drawn = drawing.pictures(result(name).folder)
    figures = {key: picture() for key, picture in drawn.items() if key != "solid"}
    assert {key for key, figure in figures.items() if figure} == PICTURES[name]
    for figure in filter(None, figures.values()):
        assert figure.get_suptitle() and any(axes.has_data() for axes in figure.findobj(plt.Axes))


def test_friction_is_drawn_within_its_limits(result):
    """The friction force lies between the broken lines of the static limit. Centre and rim have their
    velocities, and the path has the outline at touch, at the lowest place and at the end."""
    run = result("slide")
    drawn = drawing.pictures(run.folder)
    (axes,) = [axes for axes in drawn["force"]().axes[:3] if axes.get_ylabel().startswith("friction")]
    limits = [line.get_ydata() for line in axes.lines if str(line.get_label()).startswith("static limit")]
    force = axes.lines[-1].get_ydata()
    assert np.abs(force).max() > 1 and (np.abs(force) <= 1.0001 * np.abs(limits[0]) + 1e-9).all()
    speeds = {line.get_label(): line.get_ydata() for line in drawn["rolling"]().axes[0].lines}
    assert speeds["centre, along x"][-1] == pytest.approx(run.history.vx.iloc[-1])
    assert speeds["rim, −ωR"][-1] == pytest.approx(-0.05 * run.history.spin.iloc[-1])
    words = [text.get_text().split(",")[0] for text in drawn["flight"]().axes[0].get_legend().get_texts()]
    assert words[:4] == ["centre of mass", "touch", "lowest", "end of the run"]


def test_a_picture_of_ones_own(result, monkeypatch):
    """It is drawn with a title where it has something to show. Its loop encloses the energy that
    translation has lost."""
    monkeypatch.setitem(drawing.MORE, "loop", loop.draw)
    run = result("axisymmetric")
    lost = run["energy_initial"] - run["translation_energy"]
    assert lost > 1 and loop.lost({name: run.history[name].to_numpy() for name in run.history}) == pytest.approx(lost, rel=1e-9)
    figure = drawing.pictures(run.folder)["loop"]()
    assert figure.get_suptitle() and f"{lost:.4g} J" in figure.axes[0].get_legend().get_texts()[0].get_text()
    assert drawing.pictures(result("discs").folder)["loop"]() is None


def test_energies_add_up(result):
    """The dashed line is the sum of energies and losses, and constant."""
    run = result("discs")
    lines = {line.get_label(): line.get_ydata() for line in run.plot.energies().lines}
    sum_of_all = lines["total + lost"]
    assert np.ptp(sum_of_all) < 1e-9 * sum_of_all.max()
    history = {name: run.history[name].to_numpy() for name in run.history}
    assert lines["total"] == pytest.approx(mechanical_energy(history))
    assert lines["kinetic"] == pytest.approx(history["kinetic_1"] + history["kinetic_2"])


def test_shapes_are_whole_bodies(result):
    """The mirror image of the computed half is drawn, the obstacle below it, the unit at the scale."""
    run = result("axisymmetric")
    ax = run.plot.shapes(time=0.0)
    assert ax.get_xlim()[0] == pytest.approx(-ax.get_xlim()[1]) and ax.get_xlim()[1] > 0.05
    assert len(ax.collections) == 3 and ax.figure.axes[-1].get_ylabel() == "von Mises stress [MPa]"
    assert run.plot.shapes(field="displacement").figure.axes[-1].get_ylabel() == "displacement [m]"
    with pytest.raises(ff.BadInput, match="field: 'stres' is not known"):
        run.plot.shapes(field="stres")
    with pytest.raises(ff.Unreadable, match="has no states"):
        result("rest").plot.shapes()


def test_pictures_by_method(result):
    """A figure, or a line that names the pictures that the run has."""
    assert len(result("rest").plot.heights().axes[0].lines[1].get_xdata()) == 2  # impacts
    assert result("rest").plot.bounces().axes[0].get_ylabel() == "restitution"
    assert result("axisymmetric").plot.modes().axes[1].get_ylabel() == "energy of a mode [J]"
    assert result("discs").plot.contact().axes and result("discs").plot.bodies().axes
    with pytest.raises(ff.BadInput, match="plot: the run has no picture 'vibration' .accepted: energies, velocity, force"):
        result("discs").plot.modes()


def test_light_impacts_are_not_drawn(result, tmp_path):
    """Restitution is drawn over several impacts without grazing ones. A damaged table is named."""
    rows = result("rest").contacts
    figure = impacts.draw(rows.to_records(), ["disc"], ["plane"])
    drawn = figure.axes[0].lines[0].get_xdata()
    assert drawn == pytest.approx(1e3 * rows.start[rows.restitution.notna()]) and len(drawn) == 2
    light = rows.assign(impulse=[1.0] + [1e-3] * (len(rows) - 1)).to_records()
    assert impacts.draw(light, ["disc"], ["plane"]) is None and impacts.draw(rows[:1].to_records(), ["disc"], ["plane"]) is None
    (tmp_path / "contacts.csv").write_text("body\n1\n")
    with pytest.raises(ff.Unreadable, match="contacts.csv cannot be read: it lacks the columns partner, start"):
        impacts.read(tmp_path)


def test_forces_and_velocities_by_body(result):
    """Lines have the names of bodies; a given panel is used and returned."""
    figure, panels = plt.subplots(2)
    assert result("discs").plot.force(ax=panels[0]) is panels[0] and result("discs").plot.energies(ax=panels[1]) is panels[1]
    assert [line.get_label() for line in panels[0].lines] == ["normal", "friction"]
    assert panels[0].lines[0].get_ydata().max() == pytest.approx(1e-3 * result("discs")["peak_force"])
    axes = result("discs").plot.velocities()
    assert {line.get_label() for line in axes.lines} == {"vx left", "vx right", "vy left", "vy right"}
    force = result("ball").plot.force(filter="CFC 1000")
    assert force.get_ylabel() == "force [kN]" and [line.get_label() for line in force.lines][0] == "normal, CFC 1000"


def test_runs_are_compared(result, tmp_path, monkeypatch, capsys):
    """The command prints both reports and draws one figure: of a disc and a ball accelerations."""
    monkeypatch.setattr(report, "draw", lambda record: None)
    folders = [str(result(name).folder) for name in ("slide", "axisymmetric")]
    assert main(["compare", *folders, "--out", str(tmp_path)]) == 0
    assert (tmp_path / "slide-and-axisymmetric.png").stat().st_size > 20_000 and capsys.readouterr().out.count("finished earlier") == 2
    history = result("discs").record.history
    assert compare.contact_force(history) == pytest.approx(np.hypot(history["force_x_1"], history["force_y_1"]))
    assert compare.mass_of(result("axisymmetric").record) == pytest.approx(result("axisymmetric")["mass"])


def test_a_film_of_a_run(result, tmp_path):
    """It has the frames asked for."""
    movie.write(tmp_path / "film.gif", result("axisymmetric").record, 2)
    with Image.open(tmp_path / "film.gif") as image:
        assert image.n_frames == 2


@pytest.mark.parametrize("name", ["slide", "axisymmetric"])
def test_a_body_between_two_states_is_between_them(result, name):
    """This is the body of a frame."""
    motion = movie.Motion(result(name).folder / "fields.pvd", name == "axisymmetric")
    middle = (motion.times[0] + motion.times[1]) / 2
    assert motion.at(middle)[0].points == pytest.approx((motion.bodies[0].points + motion.bodies[1].points) / 2, abs=1e-12)


@pytest.mark.skipif(not find_spec("k3d"), reason="k3d is not installed")
@pytest.mark.parametrize("name", ["discs", "ball"])
def test_a_player_of_a_run(result, tmp_path, name):
    """One HTML page without network."""
    text = result(name).view(tmp_path / "impact.html").read_text()
    assert len(text) > 1e5 and "<script" in text[:10_000]


# ---- reports

@pytest.mark.parametrize("name", PICTURES)
def test_reports(result, name):
    """Table, text and HTML have the main numbers with their units; a run agrees with itself."""
    run = result(name)
    text = report.report(run.record, verbose=True)
    assert "peak force" in text and "not estimated" in text and ("N s/m" in text) == (name in ("slide", "discs", "rest"))
    assert ("bounces" in report.report(run.record)) == (name == "rest") and str(run["steps"]) in text
    assert "<caption>" in run._repr_html_() and all(word in repr(run) for word in ("peak_force", "impulse"))
    assert name != "discs" or ("rebound_vx" not in run.table.index and "rebound_vx_2" in run.table.index)
    table = ff.compare(run, run.folder)
    assert (table["run 1"] == table["run 2"]).all() and table.agree.isna().all()
