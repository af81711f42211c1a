"""The axisymmetric ball: input, output and messages of its scenes, with and without Python."""

import math

import numpy as np
import pandas as pd
import pytest

from ffimpact import scene
from ffimpact.failure import BadInput
from ffimpact.mesh import mesh
from ffimpact.output import estimate, vtu
from ffimpact.report import compare, contact, figures, report
from ffimpact.running import run
from ffimpact.scenes.sizes import Impact
from verification.measure import impact

MASS = 4 / 3 * math.pi * 0.05**3 * 1722


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    record = run.run(scene.load("ball-axisymmetric"), {"accuracy": 0.02, "fields": 3}, tmp_path_factory.mktemp("ball") / "ball")
    report.draw(record)
    return record


def test_run_of_a_whole_ball(result):
    """Energy [J] and momentum [N s] are those of the whole ball, to the geometric error of the
    mesh. Skipped effects are listed, the error is estimated."""
    s = result.summary
    assert s["energy_initial"] == pytest.approx(MASS * 8**2 / 2, rel=1e-3)
    assert s["impulse"] == pytest.approx(MASS * (8 + s["rebound_vy"]), rel=1e-3)
    assert "all but half a meridian plane (axisymmetric)" in s["skipped"] and "error estimate" not in s["skipped"]
    assert s["energy_drift"] < 1e-9 and s["momentum_drift"] < 1e-9
    assert 0 < estimate.largest(s["estimated_error"]) < 0.05


def test_units_are_those_of_a_ball(result):
    """No unit is per metre: in the report and in the figures; the script prints no unit."""
    text = report.report(result, verbose=True)
    assert "N s" in text and "/m" not in text.replace("m/s", "").replace("Pa/m", "").replace("kg/m3", "")
    assert figures.per_metre(result.scene) == "" and figures.per_metre({"script": "bodies"}) == "/m"
    assert "N/m" not in (result.folder / "log.txt").read_text()
    assert {path.stem for path in (result.folder / "figures").iterdir()} == {"energies", "force", "velocity", "shapes", "contact"}


def test_a_disc_beside_a_ball(result, tmp_path, monkeypatch):
    """Figure 11: a disc, per metre, and a ball are compared by the accelerations of their centres,
    v'(t), and by shares of energy."""
    disc = run.run(scene.load("disc-normal-neohookean"), {"accuracy": 0.2}, tmp_path / "disc", estimate=False)
    assert compare.mass_of(disc) == pytest.approx(math.pi * 0.05**2 * 1722, rel=1e-3)
    assert compare.mass_of(result) == pytest.approx(MASS, rel=1e-3)
    monkeypatch.setattr(compare.plt, "close", lambda figure: None)
    compare.draw({"disc": disc, "ball": result}, tmp_path / "both.png")
    force, _, energy, _ = compare.plt.gcf().axes
    assert "acceleration" in force.get_ylabel() and "over that at the start" in energy.get_ylabel()
    totals = [line for line in energy.lines if line.get_linewidth() > 2]
    assert len({line._unscaled_dash_pattern[0] for line in totals}) == len(totals) == 2     # noqa: SLF001 matplotlib tells an offset of dashes nowhere else; totals that lie on one another: dashes in turn
    # The lines that mark the end of contact are excluded.
    h, line = result.history, [line for line in force.lines if len(line.get_ydata()) > 2][1]
    inside = slice(1, None)
    np.testing.assert_allclose(1e3 * line.get_ydata()[inside], np.diff(h["vy"]) / h["dt"][inside], rtol=1e-6, atol=1e-3)


def test_scene_as_used_is_a_scene_again(result):
    """scene.toml is the same run again."""
    again = scene.load(str(result.folder / "scene.toml"))
    assert again.kind.script == "bodies-axisymmetric" and again.contact_values["penalty"] == result.scene["contact"]["penalty"]


def test_fields_are_those_of_a_meridian_plane(result):
    """Snapshots show the half x >= 0. Points on the axis stay on it, and there the circumferential
    stress equals the radial one."""
    snapshot = vtu.read(vtu.series(result.folder / "fields.pvd")[1][1])
    axis = np.abs(snapshot.points[:, 0]) < 1e-12
    assert snapshot.points[:, 0].min() > -1e-12 and axis.sum() > 5
    assert np.abs(snapshot.fields["displacement"][axis, 0]).max() < 1e-15
    stress = snapshot.fields["cauchy_stress"]
    assert np.abs(stress[axis, 0] - stress[axis, 2]).max() < 0.1 * np.abs(stress).max() and np.abs(stress[:, 2]).max() > 0
    assert figures.is_half(result.scene)


@pytest.mark.parametrize("name, value, message", [
    ("direction", -60, "body.1.direction: -60 leads off the axis of revolution"), ("spin", 3, "spin: no such entry"), ("body_force_x", 1, "body_force_x: "),
    ("symmetry", "full", "symmetry: no such entry"), ("angle", 60, "angle: is no entry any more .accepted: body.1.direction")])
def test_what_no_body_of_revolution_has(name, value, message):
    """Only the speed along the axis is possible, no spin and no transverse force: exit code 10 and
    the name."""
    with pytest.raises(BadInput, match=message):
        scene.load("ball-axisymmetric").override({name: value})


@pytest.mark.parametrize("shift, labels, message", [(0.0, True, None), (0.1, True, "its axis is x = 0.1 .accepted: half a meridian plane, to the right of its axis x = 0"),
                                                    (0.0, False, "it lies down to x = -0.04")])
def test_a_mesh_is_half_a_meridian_plane(tmp_path, shift, labels, message):
    """Its axis is on x = 0 with this label. Other meshes are refused with exit code 10."""
    disc = mesh.disc(0.05, 0.02, 0.01, half=labels)
    mesh.write(mesh.Mesh(disc.points + (shift, 0), disc.triangles, disc.edges, disc.labels), tmp_path / "my.msh")
    tables = impact("ball-axisymmetric", file=tmp_path / "my.msh", accuracy=0.4, law="neohookean")
    if message:
        with pytest.raises(BadInput, match=message):
            scene.read(tables, tmp_path, "ball")
    else:
        result = run.run(scene.read(tables, tmp_path, "ball"), {}, tmp_path / "out", estimate=False)
        assert result.summary["energy_initial"] == pytest.approx(MASS * 32, rel=5e-3)


def test_sizes_follow_hertz():
    """Mesh size and penalty of a slower ball scale with the width of Hertz' contact, (v/c)^(2/5); a
    disc has values of its own."""
    fast, slow = (Impact(True, 0.05, 7e6, 0.45, 1722, speed, 0.005) for speed in (1, 0.1))
    narrower = 10 ** -0.4
    assert slow.contact_mesh_size / fast.contact_mesh_size == pytest.approx(narrower, rel=1e-9)
    assert slow.penalty / fast.penalty == pytest.approx(1 / narrower, rel=1e-9)
    disc = [Impact(False, 0.05, 7e6, 0.45, 1722, speed, 0.005).contact_mesh_size for speed in (1, 0.1)]
    assert disc[1] / disc[0] == pytest.approx(10**-0.5, rel=1e-9)


def test_pressure_of_hertz(tmp_path):
    """At the largest force of a slow impact the pressure is p0 sqrt(1 - r^2/a^2) for this force, to
    4 % of p0 (rms over the area).

    The contact radius agrees to 4 %, the distance of contact points (Johnson, Contact mechanics, 4.2). The pressure of twice the
    force does not agree.
    """
    record = run.run(scene.load("ball-axisymmetric"), {"speed": 0.1, "nu": 0.3, "penalty": "auto", "fields": 20, "accuracy": 0.002}, tmp_path / "slow", estimate=False)
    points = pd.DataFrame(contact.read(record.folder))
    force = points.assign(force=points.pressure * points.weight).groupby("t").force.sum()
    now = points[points.t == force.idxmax()]

    def off(load: float) -> tuple[float, float]:
        a = (3 * load * 0.05 * (1 - 0.3**2) / (4 * 7e6)) ** (1 / 3)
        peak = 3 * load / (2 * math.pi * a**2)
        wrong = now.pressure / peak - np.sqrt(np.clip(1 - (now.x / a) ** 2, 0, None))
        return math.sqrt((wrong**2 * now.weight).sum() / now.weight.sum()), now.x.max() / a

    rms, wide = off(force.max())
    assert rms < 0.04 and wide == pytest.approx(1, abs=0.04) and off(2 * force.max())[0] > 2 * rms
