"""disc-normal with the real FreeFem++: content of the result folder, and agreement of runs with and
without Python."""

import json
import re
import resource
import shutil
import subprocess
import sys

import numpy as np
import pytest

import ffimpact as ff
from ffimpact import scene
from ffimpact.__main__ import main
from ffimpact.failure import NotInstalled
from ffimpact.freefem import freefem
from ffimpact.output import results, vtu
from ffimpact.output.columns import FILES
from ffimpact.report import literature, report
from ffimpact.running import run
from ffimpact.scene import RUN
from ffimpact.scenes import assembly
from tests.support.end_to_end import COARSE, call, direct


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    record = run.run(scene.load("disc-normal"), {}, tmp_path_factory.mktemp("real") / "disc-normal")
    report.draw(record)
    return record


def test_folder_holds_what_the_contract_says(result):
    """scene.toml has every parameter, figures/ every figure of such a run."""
    assert set(RUN) <= set(result.scene)
    assert {p.name for p in (result.folder / "figures").iterdir()} == {
        "contact.png", "energies.png", "force.png", "shapes.png", "velocity.png"}


def test_a_run_records_the_columns_and_numbers_of_the_table(result):
    """The names of a scene by the table are those of the files, in their order."""
    used, written = scene.load("disc-normal"), json.loads((result.folder / "summary.json").read_text())
    assert (result.folder / "history.csv").read_text().splitlines()[0].split(",") == used.columns
    assert [key for key in written if key in used.numbers] == used.numbers
    numbers = {key for key, value in written.items() if type(value) in (int, float)}
    # These come from other runs or from Python.
    assert numbers - {"estimate_cpu_seconds", "refinements", "total_seconds"} <= set(used.numbers)


def test_history_and_summary_agree(result):
    """The numbers of the summary agree with the history."""
    h, s = result.history, result.summary
    assert len(h["t"]) == s["steps"] + (h["dt"][0] == 0)
    assert (np.diff(h["t"]) > 0).all()
    assert h["min_jacobian"].min() == pytest.approx(s["min_jacobian"], rel=1e-3)
    assert abs(h["balance"]).max() / s["energy_initial"] == pytest.approx(s["energy_drift"], rel=1e-2, abs=1e-15)
    assert h["momentum_y"][-1] - h["momentum_y"][0] == pytest.approx(s["impulse"], rel=1e-3)
    assert h["vy"][-1] == pytest.approx(s["rebound_vy"], rel=1e-6)
    assert s["energy_drift"] < 1e-8
    assert h["min_ellipticity"].min() == s["min_ellipticity"] > 0 and s["ellipticity_lost_time"] is None


def test_result_meets_the_independent_programs(result):
    """Contact time, impulse and rebound agree with NGSolve and GetFEM to the 0.5 % accuracy of the
    scene plus their error bars."""
    for key, numbers in literature.references(result.scene).items():
        for number in numbers:
            if "error" in number:
                assert abs(result.summary[key] - number["value"]) <= 5e-3 * number["value"] + number["error"], key


def test_snapshots_can_be_read(result):
    """There are as many snapshots as requested, with the fields for the figures, on points that
    fill half the disc."""
    series = vtu.series(result.folder / "fields.pvd")
    assert len(series) == result.scene["fields"]
    snapshot = vtu.read(series[-1][1])
    assert {"displacement", "velocity", "jacobian", "von_mises", "cauchy_stress"} <= set(snapshot.fields)
    assert snapshot.points[:, 0].min() >= 0 and np.isfinite(snapshot.fields["von_mises"]).all()


def test_von_mises_stress_of_the_snapshots_is_that_of_their_stress(tmp_path):
    """At every node von_mises and pressure follow from cauchy_stress to the digits of the file,
    also on a coarse mesh."""
    result = run.run(scene.load("disc-normal"), {"accuracy": 0.2, "fields": 4}, tmp_path / "out", estimate=False)
    for _, path in vtu.series(result.folder / "fields.pvd"):
        fields = vtu.read_parts(path)[3]
        xx, yy, zz, xy, yz, xz = fields["cauchy_stress"].T
        mises = np.sqrt(((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2) / 2 + 3 * (xy**2 + yz**2 + xz**2))
        np.testing.assert_allclose(fields["von_mises"], mises, atol=1e-7 * np.abs(fields["cauchy_stress"]).max())
        np.testing.assert_allclose(fields["pressure"], -(xx + yy + zz) / 3, atol=1e-7 * np.abs(fields["cauchy_stress"]).max())
        assert mises.max() > 0 and not yz.any() and not xz.any()


def test_freefem_alone_gives_the_same(result, tmp_path):
    """FreeFem++ without Python on the same mesh writes the same history to the last digit."""
    flags, *_ = assembly.prepare(scene.load(str(result.folder / "scene.toml")), tmp_path)
    process = freefem.find().call("edp/program/bodies.edp", *freefem.words_of(flags | {"out": tmp_path / "alone"}))
    assert process.returncode == 0, process.stdout + process.stderr
    assert (tmp_path / "alone/history.csv").read_text() == (result.folder / "history.csv").read_text()


def messages_of(process: subprocess.CompletedProcess) -> list[str]:
    """The lines for the user in the output of a process."""
    return re.findall(r"^ffimpact: (.*)$", process.stdout + process.stderr, re.MULTILINE)


def check_failure(process: subprocess.CompletedProcess, code: int, words: str) -> None:
    """Asserts the exit code and one line without a traceback."""
    assert process.returncode == code, process.stderr
    assert len(messages_of(process)) == 1 and re.search(words, messages_of(process)[0]), process.stderr
    assert "Traceback" not in process.stderr


def test_step_that_cannot_converge_is_11(tmp_path):
    """At 10 km/s no step converges: exit code 11 with the time, the smallest step and the last
    residual, or that points turn inside out."""
    check_failure(call("speed=1e4", "law=neohookean", "accuracy=0.4", "end_time=0.01", out=tmp_path / "out"), 11,
                  r"the step at t = \S+ s did not converge: smallest step tried \S+ s, (work of the residual \S+ .*accepted: \S+\)|on the way points turn inside out)")
    record = json.loads((tmp_path / "out/failure.json").read_text())
    assert record["status"] == "no-convergence" and record["exit_code"] == 11


def test_material_breakdown_is_12(tmp_path):
    """St. Venant-Kirchhoff inverts at 14 m/s: exit code 12 with time, place and smallest stretch,
    and time and place of lost ellipticity."""
    process = call("speed=14", out=tmp_path / "out")
    check_failure(process, 12, r"(det F <= 0|a point loses four fifths of its volume in the smallest step, det F \S+) at t = \S+ s near X = \(\S+, \S+\) m; smallest stretch reached \S+, "
                  r"St. Venant-Kirchhoff had lost ellipticity at t = \S+ s near X = \(\S+, \S+\) m .*breakdown=continue")
    record = json.loads((tmp_path / "out/failure.json").read_text())
    assert record["status"] == "material-breakdown" and 0 < record["ellipticity_lost_time"] < record["breakdown_time"] < 5e-3
    for x, y in re.findall(r"X = \((\S+), (\S+)\)", process.stderr):
        assert np.hypot(float(x), float(y)) <= 0.05 and float(y) < -0.02
    assert not (tmp_path / "out/summary.json").exists()


def test_files_that_may_not_grow_are_14(tmp_path):
    """If no file may exceed 16 kB, the run gives one line with exit code 14 and leaves no files."""
    command = [sys.executable, "-m", "ffimpact", "run", "disc-normal", "--set", "accuracy=0.1", "--out", str(tmp_path / "out")]
    ended = subprocess.run(command, cwd=run.ROOT, capture_output=True, text=True, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (16384, 16384)))
    assert (ended.returncode, ended.stderr.count("\n")) == (14, 1) and "ulimit -f" in ended.stderr and not list(tmp_path.iterdir())


def test_breakdown_can_be_run_through(tmp_path):
    """With breakdown=continue the same impact is computed to its end, and the summary has the time
    of the breakdown."""
    process = call("speed=14", "breakdown=continue", "accuracy=0.1", out=tmp_path / "out")
    assert process.returncode == 0, process.stderr
    summary = results.read_summary(tmp_path / "out")
    assert 0 < summary["breakdown_time"] < 5e-3 and summary["min_jacobian"] <= 0 and summary["rebound_vy"] > 0
    h = results.read_history(tmp_path / "out")
    assert h["t"][np.argmax(h["min_jacobian"] <= 0)] == pytest.approx(summary["breakdown_time"])
    assert h["t"][np.argmax(h["min_ellipticity"] <= 0)] == summary["ellipticity_lost_time"] < summary["breakdown_time"]
    assert np.hypot(summary["ellipticity_lost_x"], summary["ellipticity_lost_y"]) <= 0.05


def test_neohookean_does_not_break_down(tmp_path):
    """The same impact with the neo-Hookean law keeps det F > 0."""
    process = direct("-speed", "14", "-law", "neohookean", "-accuracy", "0.1", "-end_time", "0.006", "-out", str(tmp_path / "out"))
    assert process.returncode == 0
    summary = results.read_summary(tmp_path / "out")
    assert summary["breakdown_time"] is None and summary["min_jacobian"] > 0.2 and summary["energy_drift"] < 1e-8


@pytest.mark.parametrize("environment", [{"FREEFEM": "/no/such/FreeFem++"}, {"PATH": "/no/such/folder"}])
def test_missing_freefem_is_13(tmp_path, environment):
    """Without FreeFem++ the exit code is 13, and the line has the installation command."""
    check_failure(call(out=tmp_path / "out", environment=environment), 13, "not found; run: make setup.*apt-get install freefem")


# ---- steps

def test_a_step_far_too_large_for_friction_ends_early(tmp_path):
    """A fixed step that leaves few steps in the contact with friction gives exit code 11 in one
    line with dt and the largest suitable step.

    The adaptive step of the same impact is smaller.
    """
    flags = ("-law", "neohookean", "-speed", "12", "-angle", "60", "-friction_static", "0.7", "-friction_dynamic", "0.5", "-slip_velocity", "0.1", "-penalty", "1e10")
    process = direct(*flags, "-dt", "4e-4", "-out", str(tmp_path / "out"))
    assert "friction and contact forces did not settle" in process.stderr and "accepted" not in process.stderr
    assert process.returncode == 11 and re.search(r"dt = 0.0004 s is too long for its friction, .* take dt = 0, or up to 0.00024\d+ s", process.stderr)
    assert process.stderr.count("\n") == 1 and json.loads((tmp_path / "out/failure.json").read_text())["steps"] < 6


@pytest.mark.few(1)
@pytest.mark.parametrize("how", ["stop", "continue"])
def test_chatter_is_11_or_a_warning(tmp_path, how):
    """A single node of a coarse mesh on a far too stiff penalty, with steps that resolve it,
    bounces without end.

    The exit code is 11, or with chatter=continue the run finishes with a warning in the summary and
    in print, with and without Python.
    """
    flags = COARSE | {"penalty": "8.39e12", "dt": "4e-6", "chatter": how}
    process = call(*(f"{name}={value}" for name, value in flags.items()), out=tmp_path / "out")
    plain = direct(*freefem.words_of(flags | {"fields": 0, "out": tmp_path / "direct"}))
    message = r"chatter: by t = \S+ s the body .* \d+ times in a row: .*penalty .*finer mesh"
    if how == "stop":
        check_failure(process, 11, message + r" \(chatter=continue runs on\)")
        assert json.loads((tmp_path / "out/failure.json").read_text())["status"] == "chatter"
        assert plain.returncode == 11
    else:
        assert process.returncode == plain.returncode == 0, process.stderr
        summary = results.read_summary(tmp_path / "out")
        assert summary["status"] == "ok" and summary["message"] == "" and any(re.fullmatch(message, warning) for warning in summary["warnings"]) and summary["rebound_vy"] > 0
        assert "warning   chatter: " in process.stdout
        assert any(re.fullmatch(message, warning) for warning in results.read_summary(tmp_path / "direct")["warnings"])


def test_every_number_of_a_run_has_a_unit_and_a_meaning(result):
    """Each key of the summary and each column of the tables that a run writes is one that the table explains (docs/reference/results.md)."""
    meanings = {row.name for tables in FILES.values() for table in tables for row in table}
    assert set(result.summary) <= meanings, set(result.summary) - meanings
    for name in ("history.csv", "contacts.csv", "fields/contact.csv"):
        columns = set((result.folder / name).read_text().partition("\n")[0].split(","))
        assert columns <= meanings, columns - meanings


def test_a_result_is_shown_and_drawn_without_freefem(result, tmp_path, monkeypatch):
    """Units, tables, comparison and figures of a finished run, and its reuse, start no FreeFem++."""
    monkeypatch.setenv("FREEFEM", "/nowhere/FreeFem++")
    with pytest.raises(NotInstalled):
        freefem.find()
    monkeypatch.setattr(freefem, "find", lambda: pytest.fail("FreeFem++ is sought"))
    shown = ff.load(result.folder)
    assert shown.units["peak_force"] == "N/m" and shown.table.unit["rebound_vy"] == "m/s"
    assert "N s/m" in repr(shown) and "N s/m" in shown._repr_html_()
    assert list(ff.compare(shown, result.folder, names="impulse").unit) == ["N s/m"]
    assert shown.plot.force().get_ylabel() and main(["figures", str(result.folder)]) == 0
    assert run.run(scene.load("disc-normal"), {}, result.folder).reused
    shutil.copytree(result.folder, tmp_path / "again")
    assert main(["compare", str(result.folder), str(tmp_path / "again"), "--out", str(tmp_path / "new/out")]) == 0
    assert (tmp_path / "new/out/disc-normal-and-again.png").exists()
