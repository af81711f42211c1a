"""Sweeps: the file and its errors, the table, killed and simultaneous sweeps, Snakemake, trends,
maps and histories."""

import errno
import os
import re
import shutil
import subprocess
import sys

import pandas as pd
import pytest

from ffimpact import scene
from ffimpact.__main__ import main
from ffimpact.failure import BadInput
from ffimpact.input import parameters
from ffimpact.report.figures import plt
from ffimpact.running import run
from ffimpact.sweeps import study, sweep, sweep_figures
from tests.support.cli import call, is_alive, start, wait_for
from tests.support.sweep import COARSE, DRAWN, SIX, orphans, table, write

# ---- the file

def test_points_are_products_of_axes_and_zips(tmp_path):
    """Every combination of lists, ranges and zips, with the first axis slowest. Each point appears
    again with its refinement."""
    plan = sweep.load(str(write(tmp_path, 'scene = "disc-oblique"\n[product]\nspeed = { from = 1, to = 100, points = 3, spacing = "log" }\n'
                                '[[zip]]\nnu = [0.3, 0.4]\nlaw = ["svk", "neohookean"]\n[refine]\naccuracy = 0.001\n')))
    assert [tuple(point.values()) for point in plan.points] == [
        (v, n, law) for v in (1.0, 10.0, 100.0) for n, law in ((0.3, "svk"), (0.4, "neohookean"))]
    assert plan.axes == ["speed", "nu", "law"] and plan.scene == "disc-oblique" and plan.base == {"fields": 0}
    assert plan.runs == plan.points + [point | {"accuracy": 0.001} for point in plan.points]
    assert plan.collect == scene.load("disc-oblique").numbers and "contact_time" in plan.collect


@pytest.mark.parametrize("text, words", [
    ("[product]\nspede = [1]", "spede: no such entry, set to '1'"),
    ("[product]\nspeed = [1, -2]", "speed: -2 is out of range"),
    ("[product]\nspeed = []", "speed: [] (accepted: at least one value, none twice)"),
    ("[product]\nspeed = [1, 1.0]", "none twice"),
    ("[product]\nspeed = 3", "speed: '3' is not accepted (accepted: a list of values, or a range)"),
    ("[product]\nspeed = { from = 1, to = 3 }", "is no range (accepted: from, to, points and perhaps spacing)"),
    ("[product]\nspeed = { from = 1, to = 3, points = 1 }", "points = 1 (accepted: 2 to"),
    ("[product]\nspeed = { from = 0, to = 3, points = 3, spacing = 'log' }", "from 0 to 3 (accepted for log: above 0)"),
    ("[product]\nspeed = { from = 1, to = 3, points = 3, spacing = 'odd' }", "'odd' is not known (accepted: linear|log)"),
    ("[product]\nspeed = { from = 1, to = 3, points = 30000 }", "points = 30000"),
    ("[product]\nspeed = { from = 1, to = 3, points = 2000 }\nnu = { from = 0.1, to = 0.4, points = 20 }", "40000 runs (accepted: up to 20000)"),
    ("", "nothing varies"),
    ("[product]\nspeed = [1]\n[set]\nspeed = 2", "set: speed is given twice"),
    ("[product]\nspeed = [1]\n[refine]\nspeed = 2", "refine: speed is given twice"),
    ("[product]\nspeed = [1]\n[[zip]]\nspeed = [2]", "product: speed is given twice"),
    ("[[zip]]\nspeed = [2]\nnu = [0.1, 0.2]", "zip: speed has 1 values, nu has 2 values (accepted: lists of one length)"),
    ("[zip]\nspeed = [2]", "zip: "),
    ("points = 3\n[product]\nspeed = [1]", "points: no such entry (accepted: title"),
    ("scene = 'nothing'\n[product]\nspeed = [1]", "nothing: no such scene"),
    ("scene = 3\n[product]\nspeed = [1]", "scene: '3' is not accepted"),
    ("collect = ['contact_tim']\n[product]\nspeed = [1]", "collect: 'contact_tim' is not known; did you mean contact_time? (accepted: contact_time"),
    ("limit = 0\n[product]\nspeed = [1]", "limit: 0 (accepted: 1 to 1e6 seconds)"),
    ("[product]\nspeed = [1]\n[figure]\nx = 'nu'\ny = 'impulse'", "figure: x = 'nu' (accepted: speed)"),
    ("[product]\nspeed = [1]\n[figure]\nx = 'speed'\ny = 'inpulse'", "figure: y = 'inpulse' (accepted: contact_time"),
    ("[product]\nspeed = [1]\n[figure]\nx = 'speed'\ny = 'impulse'\nby = 'nu'", "figure: by = 'nu' (accepted: speed)"),
    ("[product]\nspeed = [1]\n[figure]\nkind = 'pie'", "figure: kind 'pie' is not known (accepted: lines|map|histories)"),
    ("[product]\nspeed = [1]\n[figure]\nkind = 'histories'", "figure: y is missing"),
    ("[product]\nspeed = [1]\n[figure]\nx = 'speed'\ny = 'impulse'\ncolour = 'impulse'", "figure: colour: no such entry for lines"),
    ("[product", "cannot be read"),
    ("[product]\nspeed = [1" + "0" * 400 + "]", "is out of range"),
    ("[product]\nspeed = { from = 1, to = inf, points = 3 }", "at least one value, none twice"),
    ("[product]\nlaw = { from = 1, to = 2, points = 3 }", "a range needs a parameter that is a number"),
    ("collect = ['impulse', 'impulse']\n[product]\nspeed = [1]", "'impulse' is given twice"),
    ("[[zip]]\nspeed = [1, 1]\nnu = [0.1, 0.1]", "two points are the same"),
    ("[set]\naccuracy = 0.1\n[product]\nspeed = [1]\n[refine]\naccuracy = 0.1", "refine: accuracy as in the runs themselves"),
    ("[product]\nspeed = [1]\n[refine]\naccuracy = 5e-3", "refine: accuracy as in the runs themselves"),
    ("[product]\nspeed = [1]\n[refine]\naccuracy = 0.01", "refine: accuracy = 0.01 is not finer (accepted: above 0, below 0.005)"),
    ("scene = '" + "x" * 300 + "'\n[product]\nspeed = [1]", "cannot be read: File name too long"),
    ("[product]\nspeed = [1, 2]\nnu = [0.1, 0.2]\n[figure]\nx = 'speed'\ny = 'impulse'", "speed does not tell the points apart"),
    ("[product]\nspeed = [1]\n[figure]\nx = 'speed'\ny = 'impulse'\nby = 'speed'", "does not tell the points apart"),
    ("[product]\nspeed = [1]\n[figure]\nx = ['speed']\ny = 'impulse'", "x = ['speed'] (accepted: speed)"),
    ("[product]\nspeed = [1]\n[figure]\ny = 'impulse'", "x is missing (accepted: speed)"),
    ("[product]\nspeed = [1]\n[figure]\nx = 'speed'", "y is missing (accepted: one or several of contact_time"),
    ("[product]\nspeed = [1]\n[figure]\nkind = ['lines']", "is not known; did you mean lines? (accepted: lines|map|histories)"),
    ("[product]\nspeed = [1]\n[figure]\nkind = 'histories'\ny = 'foo'\nby = 'speed'", "y = 'foo' (accepted: t, dt, normal_force"),
    ("[product]\nspeed = [1]\nnu = [0.1, 0.2]\n[figure]\nkind = 'map'\nx = 'speed'\ny = 'nu'\ncolour = 'impulse'", "x = 'speed' (accepted for a map"),
    ("[product]\nlaw = ['svk', 'neohookean']\nnu = [0.1, 0.2]\n[figure]\nkind = 'map'\nx = 'law'\ny = 'nu'\ncolour = 'impulse'", "x = 'law' (accepted for a map"),
    ("[product]\nspeed = [1, 2]\nnu = [0, 0.2]\n[figure]\nkind = 'map'\nx = 'speed'\ny = 'nu'\ncolour = 'impulse'\nlevel = 1", "y = 'nu' has values up to 0"),
    ("[product]\nspeed = [1, 2]\nnu = [0.1, 0.2]\n[figure]\nkind = 'map'\nx = 'speed'\ny = 'nu'\ncolour = 'impulse'\nlevel = nan", "level = nan (accepted: a number"),
    ("[product]\nspeed = [1, 2]\nnu = [0.1, 0.2]\n[figure]\nkind = 'map'\nx = 'speed'\ny = 'nu'\ncolour = 'impulse'\nlevel = 1\nband = -1", "band = -1"),
])
def test_bad_files_are_one_line(tmp_path, text, words):
    """The line has the file, the entry, the value and what is accepted. Nothing has run."""
    path = write(tmp_path, text)
    with pytest.raises(BadInput) as error:
        sweep.load(str(path))
    assert str(path) in str(error.value) and words in str(error.value) and "\n" not in str(error.value)
    assert error.value.code == 10


@pytest.mark.parametrize("name", sweep.built_in())
def test_built_in_sweeps_are_sound(name):
    """Each loads, has a title and a figure, nu in its title or as varied parameter, and a target in
    the Makefile.

    No point leaves entries automatic that its scene fixes: an axis of the static coefficient has
    the dynamic one beside it.
    """
    plan = sweep.load(name)
    scene = sweep.scene.load(plan.scene)
    assert not {message for point in plan.points for message in scene.override(plan.base | point).released}
    assert "nu" in plan.axes or "ν = " in sweep_figures.constants(plan)
    assert plan.title != name and plan.figure and f" {name}" in (parameters.ROOT / "Makefile").read_text()


# ---- the table

def test_table_and_figure(fake, tmp_path, capsys):
    """There is a row for each point in the order of the file, with every collected number; a
    figure, the file itself, and no incomplete files."""
    out = tmp_path / "out"
    assert sweep.main([str(write(tmp_path, DRAWN)), "--out", str(out)]) == 0
    rows = table(out)
    assert rows[["speed", "nu"]].values.tolist() == [[v, n] for v in (4, 6, 8) for n in (0.3, 0.4)]
    assert (rows.exit == 0).all() and (rows.impulse == 208.2).all() and fake.starts() == 6
    assert {path.name for path in out.iterdir()} == {"runs", "sweep.csv", "sweep.png", "sweep.toml"}
    assert (out / "sweep.toml").read_text() == DRAWN and plt.imread(out / "sweep.png").std() > 0
    output = capsys.readouterr().out
    assert "6 of 6 points finished" in output and "ν = 0.3: contact time over speed" in output and "no error bars" in output
    assert "\nunits: speed m/s, contact_time s" in output


@pytest.mark.few(2)
@pytest.mark.parametrize("mode, code, returned", [("material", 12, 0), ("step", 11, 0), ("crash", 1, 1)])
def test_failed_points_are_kept_with_their_reason(fake, tmp_path, capsys, mode, code, returned):
    """They do not stop the others. Reproducible failures are reused, killed runs run again, which
    is reported on stderr."""
    fake(mode)
    path, out = write(tmp_path, DRAWN), tmp_path / "out"
    assert main(["sweep", str(path), "--out", str(out)]) == returned
    rows, captured = table(out), capsys.readouterr()
    assert (rows.exit == code).all() and rows.message.notna().all() and "0 of 6 points finished" in captured.out
    assert rows.impulse.isna().all(), "what a failed run came to is no result"
    assert f"failed, exit {code}: speed=4.0,nu=0.3" in captured.out
    assert captured.err.count("\n") == returned and (
        "6 of 6 points have no answer" in captured.err and "runs again" in captured.err) == (returned == 1)
    assert main(["sweep", str(path), "--out", str(out)]) == returned and fake.starts() == (12 if returned else 6)


def test_bad_input_of_a_point_is_said_with_its_code(fake, tmp_path, capsys):
    """A point that cannot run is a row, and the sweep ends with its exit code and one line."""
    assert main(["sweep", str(write(tmp_path, "[product]\nmesh_size = [0.02, 1.0]\n")), "--out", str(tmp_path / "out")]) == 10
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1 and "1 of 2 points have no answer, first: mesh_size=1.0: body.1.mesh_size: 1 does not fit the thickness of 'disc'" in captured.err
    assert table(tmp_path / "out").exit.tolist() == [0, 10] and "again" not in captured.err


def test_a_parameter_with_the_name_of_a_result_keeps_its_values(fake, tmp_path):
    """No number of the summary has the name of a parameter."""
    out = tmp_path / "out"
    assert sweep.main([str(write(tmp_path, COARSE + "[product]\nspin = [-100, 0, 100]\n")), "--out", str(out)]) == 0
    rows = table(out)
    assert rows.spin.tolist() == [-100, 0, 100] and rows.rebound_spin.tolist() == [0, 0, 0]


@pytest.mark.parametrize("text", ["[]", '{"exit_code": 11}', '{"exit_code": 11, "provenance": {}}', '{"exit_code": 12, "provenance": null}'])
def test_damaged_folders_are_run_again(fake, tmp_path, text):
    """An invalid failure.json stops nothing."""
    path, out = write(tmp_path, COARSE + "[product]\nspeed = [4]\n"), tmp_path / "out"
    plan = sweep.load(str(path))
    place = study.place(out, plan.points[0])
    place.mkdir(parents=True)
    (place / "failure.json").write_text(text)
    assert sweep.main([str(path), "--out", str(out)]) == 0 and (table(out).exit == 0).all()


def test_a_full_disk_is_a_row(fake, tmp_path, monkeypatch):
    """If a run cannot be written, its row has exit code 14."""
    def full(*_, **__):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "file")
    monkeypatch.setattr(run, "run", full)
    rows = sweep.table(sweep.load(str(write(tmp_path, SIX))), tmp_path / "out")
    assert (rows.exit == 14).all() and rows.message.str.contains("No space left on device").all()


def test_error_bars_are_what_refining_changes(tmp_path):
    """With [refine] the number is that of the refined run, and its error the difference to the
    plain one."""
    text = "collect = ['impulse', 'dofs']\n[set]\ndegree = 1\nend_time = 1e-3\naccuracy = 0.02\n[product]\nspeed = [4, 8]\n[refine]\naccuracy = 0.005\n"
    plan = sweep.load(str(write(tmp_path, text)))
    rows = sweep.collect(plan, tmp_path / "out")
    plain, fine = (study.study([point | extra for point in plan.points], tmp_path / "out", plan.base, 60.0) for extra in ({}, plan.refine))
    assert plain.reused.all() and fine.reused.all() and (plain.dofs != fine.dofs).all()
    assert rows.impulse.tolist() == fine.impulse.tolist() and (rows.impulse_error > 0).all()
    assert rows.impulse_error.tolist() == (fine.impulse - plain.impulse).abs().tolist()
    assert (rows.impulse_error < 0.06 * rows.impulse).all()


@pytest.mark.parametrize("after", [pytest.param(0.0, marks=pytest.mark.robustness), 0.3, pytest.param(0.8, marks=pytest.mark.robustness)])
def test_killed_driver_leaves_nothing_running_and_is_taken_up(fake, tmp_path, monkeypatch, after):
    """kill -9 of the Python process ends its FreeFem++ processes. The same command runs only
    unfinished points, and the table is the same."""
    path, out, calm = write(tmp_path, DRAWN), tmp_path / "out", tmp_path / "calm"
    assert main(["sweep", str(path), "--out", str(calm)]) == 0
    first = fake.starts()
    monkeypatch.setenv("FAKE", "brief")
    process = start("sweep", str(path), "--out", str(out))
    wait_for(lambda: fake.starts() >= first + study.CORES)
    try:
        process.wait(after)
    except subprocess.TimeoutExpired:
        pass
    process.kill()
    process.wait()
    wait_for(lambda: not any(map(is_alive, fake.pids())))
    done, before = len([path for path in (out / "runs").glob("*/summary.json") if path.parent.suffix != ".part"]), fake.starts()
    monkeypatch.setenv("FAKE", "ok")
    assert main(["sweep", str(path), "--out", str(out)]) == 0 and fake.starts() - before == 6 - done
    pd.testing.assert_frame_equal(table(out), table(calm))
    assert not orphans(out)


def test_snakemake_gives_the_same_table(fake, tmp_path):
    """Each run is a job. The results equal those of the sweep command, which finds nothing left to
    do."""
    pytest.importorskip("snakemake", reason="the optional snakemake is not installed")
    path, out, calm = write(tmp_path, DRAWN), tmp_path / "out", tmp_path / "calm"
    assert call("sweep", str(path), "--out", str(calm))[0] == 0
    done = subprocess.run([sys.executable, "-m", "snakemake", "-s", str(parameters.ROOT / "orchestrate/ffimpact/Snakefile"), "--cores", "2",
                           "--config", f"sweep={path}", f"out={out}"], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert fake.starts() == 12 and "7 of 7 steps (100%) done" in done.stderr
    pd.testing.assert_frame_equal(table(out), table(calm))
    assert call("sweep", str(path), "--out", str(out))[0] == 0 and fake.starts() == 12
    # Only the missing run is made again.
    shutil.rmtree(study.place(out, {"speed": 4.0, "nu": 0.3}))
    (out / "sweep.csv").unlink()
    again = subprocess.run(done.args, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert again.returncode == 0 and fake.starts() == 13, again.stderr
    pd.testing.assert_frame_equal(table(out), table(calm))


@pytest.mark.parametrize("settings, stars", [
    ("law = 'svk'\n[product]\nspeed = [4, 8]", 1), ("law = 'neohookean'\n[product]\nspeed = [4, 8]", 0),
    ("law = 'svk'\n[product]\nspeed = [4, 8]\nlaw = ['neohookean', 'svk']", 1), ("young = 5e6\n[product]\nspeed = [4, 8]", 0),
    ("viscosity = 10\n[product]\nspeed = [4, 8]", 0)])
def test_the_papers_star_stands_in_studies_of_its_scene(fake, tmp_path, settings, stars):
    """The paper's number is drawn only if one of the curves has its law and scene."""
    by = "by = 'law'\n" if "'neohookean', 'svk'" in settings else ""
    settings = settings.replace("law = 'svk'\n", "") if by else settings
    text = f"[set]\n{settings}\n[figure]\nx = 'speed'\ny = 'contact_time'\n{by}"
    plan = sweep.load(str(write(tmp_path, text)))
    rows = pd.DataFrame(plan.points).assign(exit=0, contact_time=4.7e-3)
    figure = sweep_figures.draw_lines(plan, rows, tmp_path)
    assert sum(line.get_marker() == "*" for line in figure.axes[0].lines) == stars
    plt.close(figure)


def test_words_as_axes(fake, tmp_path, capsys):
    """A parameter with words may vary, be an axis of a figure and be in the table."""
    text = COARSE + '[product]\nlaw = ["svk", "neohookean"]\nspeed = [4, 8]\n[figure]\nx = "law"\ny = "contact_time"\nby = "speed"\n'
    assert sweep.main([str(write(tmp_path, text)), "--out", str(tmp_path / "out")]) == 0
    assert "| neohookean |" in capsys.readouterr().out and (tmp_path / "out/sweep.png").exists()


def test_the_sweep_of_the_docs_is_sound(tmp_path):
    """The example of docs/how-to/sweeps.md is accepted."""
    text = (parameters.ROOT / "docs/how-to/sweeps.md").read_text()
    example = re.search(r"```\n(scene = \"disc-normal\".*?)```", text, re.S)[1]
    plan = sweep.load(str(write(tmp_path, example)))
    assert len(plan.points) == 32 and plan.refine and plan.figure


def test_a_refused_point_keeps_no_other(fake, tmp_path, capsys):
    """A refused point, also the first one, is a row with exit code 10 that is reported. The others
    run, and --open does not list it."""
    shutil.copy(parameters.ROOT / "orchestrate/ffimpact/scenes/two-discs.toml", tmp_path / "two.toml")
    path = write(tmp_path, 'scene = "two.toml"\ncollect = ["impulse"]\n[product]\n"body.1.position.1" = [0.05, -0.06]\n')
    plan = sweep.load(str(path))
    place = study.place(tmp_path / "out", plan.points[0])
    outcomes = study.outcomes(plan.points, tmp_path / "out", plan.base, sweep.scene.load(plan.scene))
    assert list(outcomes) == [place] and outcomes[place]["exit"] == 10 and "overlaps 'right'" in outcomes[place]["message"]
    path.write_text('scene = "disc-normal"\ncollect = ["contact_time"]\n' + COARSE + '[[zip]]\ndirection = [-60, -90]\nsymmetry = ["half", "half"]\n')
    capsys.readouterr()
    assert main(["sweep", str(path), "--out", str(tmp_path / "plane")]) == 10
    captured, rows = capsys.readouterr(), table(tmp_path / "plane")
    assert list(rows.exit) == [10, 0] and rows.contact_time.notna().tolist() == [False, True]
    assert "first: direction=-60,symmetry=half: symmetry: half" in captured.err and captured.err.count("\n") == 1 and "failed, exit 10: direction=-60,symmetry=half" in captured.out
    # No point is left.
    assert main(["sweep", str(write(tmp_path, 'scene = "two.toml"\n[product]\n"body.1.position.1" = [0.05, 0.06]\n')), "--list"]) == 10
