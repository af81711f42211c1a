"""Sweeps: the file and its errors, the table, kills and two drivers at once, Snakemake, trends, maps and histories."""

import errno
import fcntl
import os
import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from ffimpact.__main__ import main
from ffimpact.failure import BadInput
from ffimpact.freefem.describe import describe_results
from ffimpact.input import parameters
from ffimpact.output import results
from ffimpact.report.figures import plt
from ffimpact.running import run
from ffimpact.sweeps import study, sweep, sweep_figures
from test_cli import call, is_alive, start, wait_for

COARSE = "[set]\nmesh_size = 0.02\ncontact_mesh_size = 0.01\n"
SIX = COARSE + "[product]\nspeed = { from = 4, to = 8, points = 3 }\nnu = [0.3, 0.4]\n"
DRAWN = SIX + '[figure]\nx = "speed"\ny = "contact_time"\nby = "nu"\n'
TIMINGS = ["seconds"]


def write(folder: Path, text: str) -> Path:
    folder.mkdir(exist_ok=True)
    path = folder / "case.toml"
    path.write_text(text)
    return path


def table(out: Path) -> pd.DataFrame:
    return pd.read_csv(out / "sweep.csv").drop(columns=TIMINGS)


# ---- the file

def test_points_are_products_of_axes_and_zips(tmp_path):
    """Every combination of lists, ranges and zips, the first axis slowest; each point again with what refines it."""
    wanted = sweep.load(str(write(tmp_path, 'scene = "disc-oblique"\n[product]\nspeed = { from = 1, to = 100, points = 3, spacing = "log" }\n'
                                  '[[zip]]\nnu = [0.3, 0.4]\nlaw = ["svk", "neohookean"]\n[refine]\naccuracy = 0.001\n')))
    assert [tuple(point.values()) for point in wanted.points] == [
        (v, n, law) for v in (1.0, 10.0, 100.0) for n, law in ((0.3, "svk"), (0.4, "neohookean"))]
    assert wanted.axes == ["speed", "nu", "law"] and wanted.scene == "disc-oblique" and wanted.base == {"fields": 0}
    assert wanted.runs == wanted.points + [point | {"accuracy": 0.001} for point in wanted.points]
    assert wanted.collect == describe_results()["summary"] and "contact_time" in wanted.collect


@pytest.mark.parametrize("text, words", [
    ("[product]\nspede = [1]", "spede: no such parameter; did you mean speed"),
    ("[product]\nspeed = [1, -2]", "speed: -2 is out of range"),
    ("[product]\nspeed = []", "speed: [] (accepted: at least one value, none twice)"),
    ("[product]\nspeed = [1, 1.0]", "none twice"),
    ("[product]\nspeed = 3", "speed: '3' is not accepted (accepted: a list of values, or a range)"),
    ("[product]\nspeed = { from = 1, to = 3 }", "is no range (accepted: from, to, points and perhaps spacing)"),
    ("[product]\nspeed = { from = 1, to = 3, points = 1 }", "points = 1 (accepted: 2 to"),
    ("[product]\nspeed = { from = 0, to = 3, points = 3, spacing = 'log' }", "from 0.0 to 3.0 (accepted for log: above 0)"),
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
    ("[product]\nspeed = { from = 1, to = inf, points = 3 }", "speed: inf is out of range"),
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
    """The line names the file, the entry, the value and what is accepted; nothing has run."""
    path = write(tmp_path, text)
    with pytest.raises(BadInput) as error:
        sweep.load(str(path))
    assert str(path) in str(error.value) and words in str(error.value) and "\n" not in str(error.value)
    assert error.value.code == 10


@pytest.mark.robustness
def test_unknown_sweep_and_run():
    """Exit code 10, one line, what there is."""
    code, _, err = call("sweep", "nothing")
    assert code == 10 and "built in: calibrate, calibrate-ball, calibrate-ball-3d, calibrate-oblique, conservation, contact-time-neohookean" in err and err.count("\n") == 1
    code, _, err = call("sweep", "law-comparison", "--run", "speed=3")
    assert code == 10 and "--run: 'speed=3' is no run of law-comparison (accepted: see --list)" in err


@pytest.mark.parametrize("name", sweep.built_in())
def test_built_in_sweeps_are_sound(name):
    """Each loads, has a title and a figure, says nu in its title or as what varies, and has its target in the Makefile. No point leaves open what its scene fixes: an axis
    over the static coefficient has the dynamic one beside it."""
    wanted = sweep.load(name)
    given = sweep.scene.load(wanted.scene)
    assert not {said for point in wanted.points for said in given.override(wanted.base | point).released}
    assert "nu" in wanted.axes or "ν = " in sweep_figures._constants(wanted)
    assert wanted.title != name and wanted.figure and f" {name}" in (parameters.ROOT / "Makefile").read_text()


# ---- the table

def test_table_and_figure(fake, tmp_path, capsys):
    """A row a point in the order of the file, every collected number, a figure, the file itself, and no half-written files."""
    out = tmp_path / "out"
    assert sweep.main([str(write(tmp_path, DRAWN)), "--out", str(out)]) == 0
    rows = table(out)
    assert rows[["speed", "nu"]].values.tolist() == [[v, n] for v in (4, 6, 8) for n in (0.3, 0.4)]
    assert (rows.exit == 0).all() and (rows.impulse == 208.2).all() and fake.starts() == 6
    assert {path.name for path in out.iterdir()} == {"runs", "sweep.csv", "sweep.png", "sweep.toml"}
    assert (out / "sweep.toml").read_text() == DRAWN and plt.imread(out / "sweep.png").std() > 0
    said = capsys.readouterr().out
    assert "6 of 6 points finished" in said and "ν = 0.3: contact time over speed" in said and "no error bars" in said
    assert "\nunits: speed m/s, contact_time s" in said
    assert all(results.read_scene(folder)["mesh_size"] == 0.02 for folder in (out / "runs").iterdir())


@pytest.mark.few(2)
@pytest.mark.parametrize("mode, code, returned", [("material", 12, 0), ("step", 11, 0), ("crash", 1, 1)])
def test_failed_points_are_kept_with_their_reason(fake, tmp_path, capsys, mode, code, returned):
    """They do not stop the rest; what would fail again is not run again, what was killed is, and that is said on stderr."""
    fake(mode)
    path, out = write(tmp_path, DRAWN), tmp_path / "out"
    assert main(["sweep", str(path), "--out", str(out)]) == returned
    rows, said = table(out), capsys.readouterr()
    assert (rows.exit == code).all() and rows.message.notna().all() and "0 of 6 points finished" in said.out
    assert rows.impulse.isna().all(), "what a failed run came to is no result"
    assert f"failed, exit {code}: speed=4.0,nu=0.3" in said.out
    assert said.err.count("\n") == returned and ("6 of 6 points have no answer" in said.err and "runs again" in said.err) == (returned == 1)
    assert main(["sweep", str(path), "--out", str(out)]) == returned and fake.starts() == (12 if returned else 6)


def test_bad_input_of_a_point_is_said_with_its_code(fake, tmp_path, capsys):
    """A point that cannot be run is a row like any other, and the sweep ends with its exit code and one line."""
    assert main(["sweep", str(write(tmp_path, "[product]\nmesh_size = [0.02, 1.0]\n")), "--out", str(tmp_path / "out")]) == 10
    said = capsys.readouterr()
    assert said.err.count("\n") == 1 and "1 of 2 points have no answer, first: mesh_size=1.0: mesh_size: 1 is larger than the radius 0.05" in said.err
    assert table(tmp_path / "out").exit.tolist() == [0, 10] and "again" not in said.err


def test_a_parameter_with_the_name_of_a_result_keeps_its_values(fake, tmp_path):
    """No number of the summary has the name of a parameter."""
    out = tmp_path / "out"
    assert sweep.main([str(write(tmp_path, COARSE + "[product]\nspin = [-100, 0, 100]\n")), "--out", str(out)]) == 0
    rows = table(out)
    assert rows.spin.tolist() == [-100, 0, 100] and rows.rebound_spin.tolist() == [0, 0, 0]


@pytest.mark.parametrize("text", ["[]", '{"exit_code": 11}', '{"exit_code": 11, "provenance": {}}', '{"exit_code": 12, "provenance": null}'])
def test_damaged_folders_are_run_again(fake, tmp_path, text):
    """A failure.json that is none stops nothing."""
    path, out = write(tmp_path, COARSE + "[product]\nspeed = [4]\n"), tmp_path / "out"
    wanted = sweep.load(str(path))
    place = study.place(out, wanted.points[0])
    place.mkdir(parents=True)
    (place / "failure.json").write_text(text)
    assert sweep.main([str(path), "--out", str(out)]) == 0 and (table(out).exit == 0).all()


def test_a_full_disk_is_a_row(fake, tmp_path, monkeypatch):
    """Where a run cannot be written its row says so with exit code 14."""
    def full(*_, **__):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "file")
    monkeypatch.setattr(run, "run", full)
    rows = sweep.table(sweep.load(str(write(tmp_path, SIX))), tmp_path / "out")
    assert (rows.exit == 14).all() and rows.message.str.contains("No space left on device").all()


@pytest.mark.robustness
def test_another_sweep_does_not_come_in_between(fake, tmp_path, monkeypatch, capsys):
    """While a sweep runs, a driver with another sweep file on the same folder is refused; afterwards it is not."""
    path, out, other = write(tmp_path, SIX), tmp_path / "out", write(tmp_path / "other", SIX + "[[zip]]\ndt = [1e-5]\n")
    monkeypatch.setenv("FAKE", "brief")
    process = start("sweep", str(path), "--out", str(out))
    wait_for(lambda: fake.starts() >= 1)
    assert main(["sweep", str(other), "--out", str(out)]) == 14
    assert "is being written by another sweep" in capsys.readouterr().err
    assert process.wait(60) == 0 and (out / "sweep.toml").read_text() == SIX
    monkeypatch.setenv("FAKE", "ok")
    assert main(["sweep", str(other), "--out", str(out)]) == 0 and len(table(out)) == 6


def test_error_bars_are_what_refining_changes(tmp_path):
    """With [refine] the number is that of the refined run, its error the difference to the plain one."""
    text = "collect = ['impulse', 'dofs']\n[set]\ndegree = 1\nend_time = 1e-3\naccuracy = 0.02\n[product]\nspeed = [4, 8]\n[refine]\naccuracy = 0.005\n"
    wanted = sweep.load(str(write(tmp_path, text)))
    rows = sweep.collect(wanted, tmp_path / "out")
    plain, fine = (study.study([point | extra for point in wanted.points], tmp_path / "out", wanted.base, 60.0) for extra in ({}, wanted.refine))
    assert plain.reused.all() and fine.reused.all() and (plain.dofs != fine.dofs).all()
    assert rows.impulse.tolist() == fine.impulse.tolist() and (rows.impulse_error > 0).all()
    assert rows.impulse_error.tolist() == (fine.impulse - plain.impulse).abs().tolist()
    assert (rows.impulse_error < 0.05 * rows.impulse).all()


# ---- kills

def orphans(out: Path) -> list[Path]:
    return [path for path in (out / "runs").glob("*.part")] if (out / "runs").exists() else []


@pytest.mark.parametrize("after", [pytest.param(0.0, marks=pytest.mark.robustness), 0.3, pytest.param(0.8, marks=pytest.mark.robustness)])
def test_killed_driver_leaves_nothing_running_and_is_taken_up(fake, tmp_path, monkeypatch, after):
    """kill -9 of the driver ends its FreeFem++; the same command runs only what is not finished; the table is the same."""
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


@pytest.mark.robustness
def test_killed_freefem_costs_its_point_only(fake, tmp_path, monkeypatch):
    """kill -9 of a FreeFem++: its point fails and says so, the others go on; the same command runs that point only."""
    path, out = write(tmp_path, DRAWN), tmp_path / "out"
    monkeypatch.setenv("FAKE", "brief")
    process = start("sweep", str(path), "--out", str(out))
    wait_for(lambda: fake.starts() >= 1)
    os.kill(fake.pids()[0], signal.SIGKILL)
    said, _ = process.communicate(timeout=60)
    assert process.returncode == 1 and "5 of 6 points finished" in said and "was killed by SIGKILL" in said
    before = fake.starts()
    assert main(["sweep", str(path), "--out", str(out)]) == 0 and fake.starts() == before + 1
    assert (table(out).exit == 0).all()


@pytest.mark.robustness
def test_two_drivers_share_a_folder(fake, tmp_path, monkeypatch):
    """Both end well with the same table, and no point is run twice."""
    path, out = write(tmp_path, DRAWN), tmp_path / "out"
    monkeypatch.setenv("FAKE", "brief")
    both = [start("sweep", str(path), "--out", str(out)) for _ in range(2)]
    for process in both:
        said, err = process.communicate(timeout=60)
        assert process.returncode == 0 and "6 of 6 points finished" in said, err
    assert fake.starts() == 6 and (table(out).exit == 0).all() and not orphans(out)


@pytest.mark.robustness
@pytest.mark.few(1)
@pytest.mark.parametrize("dies", [False, True])
def test_driver_waits_for_one_that_just_begins(fake, tmp_path, dies):
    """A driver that finds another between locking the folder and writing sweep.toml waits, then shares the folder; it has
    the folder to itself where the other dies over it."""
    path, out = write(tmp_path, SIX), tmp_path / "out"
    out.mkdir()
    first = os.open(out, os.O_RDONLY)
    fcntl.flock(first, fcntl.LOCK_EX)
    process = start("sweep", str(path), "--out", str(out))
    with pytest.raises(subprocess.TimeoutExpired):
        process.wait(2)
    if dies:
        os.close(first)
    else:
        (out / "sweep.toml").write_text(SIX)
        fcntl.flock(first, fcntl.LOCK_SH)
    said, err = process.communicate(timeout=60)
    assert process.returncode == 0 and "6 of 6 points finished" in said, err


@pytest.mark.robustness
def test_one_run_of_the_list(fake, tmp_path, capsys):
    """--list names the runs, --run does one of them; the sweep then takes it as done."""
    path, out = write(tmp_path, SIX), tmp_path / "out"
    assert main(["sweep", str(path), "--out", str(out), "--list"]) == 0
    names = capsys.readouterr().out.split()
    assert len(names) == 6 and names[1] == "speed=4.0,nu=0.4"
    assert main(["sweep", str(path), "--out", str(out), "--run", names[1]]) == 0 and fake.starts() == 1
    assert not (out / "sweep.csv").exists()
    assert main(["sweep", str(path), "--out", str(out)]) == 0 and fake.starts() == 6


def test_snakemake_gives_the_same_table(fake, tmp_path):
    """One job a run, the same results as the driver, which finds nothing left to do."""
    pytest.importorskip("snakemake", reason="the optional snakemake is not installed")
    path, out, calm = write(tmp_path, DRAWN), tmp_path / "out", tmp_path / "calm"
    assert call("sweep", str(path), "--out", str(calm))[0] == 0
    done = subprocess.run([sys.executable, "-m", "snakemake", "-s", str(parameters.ROOT / "orchestrate/ffimpact/Snakefile"), "--cores", "2",
                           "--config", f"sweep={path}", f"out={out}"], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert fake.starts() == 12 and "7 of 7 steps (100%) done" in done.stderr
    pd.testing.assert_frame_equal(table(out), table(calm))
    assert call("sweep", str(path), "--out", str(out))[0] == 0 and fake.starts() == 12
    shutil.rmtree(study.place(out, {"speed": 4.0, "nu": 0.3}))       # what is missing, and only that, is made again
    (out / "sweep.csv").unlink()
    again = subprocess.run(done.args, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert again.returncode == 0 and fake.starts() == 13, again.stderr
    pd.testing.assert_frame_equal(table(out), table(calm))


@pytest.mark.robustness
def test_snakemake_takes_names_with_blanks(tmp_path):
    """The names of runs and the folder may have blanks, as a pressure over time has."""
    pytest.importorskip("snakemake", reason="the optional snakemake is not installed")
    disc = '[[body]]\nname = "{}"\nshape = "disc"\nradius = 0.05\nposition = [{}, 0]\nvelocity = [{}, 0]\n'
    (tmp_path / "pair.toml").write_text('law = "neohookean"\nyoung = 7e6\nnu = 0.3\ndensity = 1722\nend_time = 1e-4\naccuracy = 0.3\n'
                                        + disc.format("a", 0, 0) + disc.format("b", 0.2, -3)
                                        + '[[body.load]]\nwhere = "outer"\npressure = "1e3 * t"\n')
    path = write(tmp_path, 'scene = "pair.toml"\n[product]\n"body.2.load.1.pressure" = ["1e3 * t", "2e3 * t"]\n')
    done = subprocess.run([sys.executable, "-m", "snakemake", "-s", str(parameters.ROOT / "orchestrate/ffimpact/Snakefile"), "--cores", "2",
                           "--config", f"sweep={path}", f"out={tmp_path / 'its out'}"], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0 and "3 of 3 steps (100%) done" in done.stderr, done.stderr
    assert list(table(tmp_path / "its out").exit) == [0, 0]


# ---- what figures say

def rows_over_speed(values, error=0.01) -> pd.DataFrame:
    return pd.DataFrame({"speed": np.arange(1.0, 1 + len(values)), "contact_time": 1e-3 * np.array(values), "exit": 0,
                         "contact_time_error": 1e-3 * error})


def test_trend_counts_rises_beyond_the_error_bar():
    """A rise counts as one where it exceeds the error bars of both its ends, added in squares."""
    said = sweep_figures.trend(rows_over_speed([5.0, 4.8, 4.81, 4.7, 4.9, 4.6]), "speed", "contact_time", "")
    assert "falls from 5 to 4.6 ms; of 5 steps 2 rise, 1 of them by more than their error bar" in said and "largest by 0.2 ms" in said
    assert "0 of them by more" in sweep_figures.trend(rows_over_speed([5, 4.8, 4.9, 4.7, 4.6], 0.1), "speed", "contact_time", "")
    assert "0 rise" in sweep_figures.trend(rows_over_speed([5, 4.9, 4.8]), "speed", "contact_time", "")
    failed = rows_over_speed([5, 4.9, 4.8]).assign(exit=[0, 0, 12])
    assert "too few points" in sweep_figures.trend(failed, "speed", "contact_time", "")


@pytest.mark.parametrize("values, error, course", [
    ([5, 4.8, 4.81, 4.7, 4.9, 4.6], 0.01, sweep_figures.FALLS), ([4.6, 4.9, 4.7, 5], 0.01, sweep_figures.RISES),
    ([5, 4.4, 4.3, 4.5, 4.9], 0.01, sweep_figures.MINIMUM), ([4.3, 4.9, 5, 4.8, 4.4], 0.01, sweep_figures.MAXIMUM),
    ([5, 4.4, 4.3, 4.5, 4.9], np.nan, sweep_figures.MINIMUM), ([5, 4.6, 4.4, 4.3, 4.35], 0.02, sweep_figures.FALLS),
    ([4.5, 5, 4.2, 4.6], 0.01, sweep_figures.UNEVEN), ([5, 4.8, 4.9, 4.7, 4.6], 0.2, sweep_figures.LEVEL)])
def test_a_trend_is_the_course_of_the_curve(values, error, course):
    """A curve falls where it ends at its lowest and begins at its highest value, beyond twice the error
    bars; a minimum is named, with its place. Turned upside down, the curve does the opposite."""
    there, opposite = rows_over_speed(values, error), {sweep_figures.FALLS: sweep_figures.RISES,
                                                       sweep_figures.MINIMUM: sweep_figures.MAXIMUM}
    found = sweep_figures.steps_against(there, "speed", "contact_time")
    assert found.course == course and found.falls == (course == sweep_figures.FALLS)
    said = sweep_figures.trend(there, "speed", "contact_time", "")
    assert f"contact time over speed: {course}" in said
    assert ("4.3 at speed = 3 m/s" in said) == (course == sweep_figures.MINIMUM)
    turned = sweep_figures.steps_against(rows_over_speed([10 - value for value in values], error), "speed", "contact_time")
    assert turned.course == (opposite | {other: one for one, other in opposite.items()}).get(course, course)


@pytest.mark.robustness
def test_table_and_figure_have_the_same_error_bars(fake, tmp_path, monkeypatch):
    """The error bars that are printed in the table are those that the figure draws, curve by curve."""
    text = DRAWN.replace("[figure]", "[refine]\naccuracy = 1e-3\n[figure]").replace("[product]", "accuracy = 5e-3\n[product]")
    wanted = sweep.load(str(write(tmp_path, text)))
    rows = sweep.table(wanted, tmp_path / "out").assign(contact_time_error=[1e-6, 4e-5, 6e-5, 2e-6, 3e-6, 5e-5])
    said = sweep.report(wanted, rows, tmp_path / "out").splitlines()
    column = [name.strip() for name in next(line for line in said if line.startswith("|")).split("|")].index("contact_time")
    printed = [float(line.split("|")[column].split("±")[1]) for line in said if line.startswith("|") and "±" in line]
    drawn, bar = {}, plt.Axes.errorbar
    monkeypatch.setattr(plt.Axes, "errorbar", lambda axes, x, y, error, **more: drawn.update({more["label"]: 1e-3 * error})
                        or bar(axes, x, y, error, **more))
    sweep_figures.draw(wanted, rows, tmp_path / "out")
    for nu, words in ((0.3, "ν = 0.3"), (0.4, "ν = 0.4")):
        assert np.array(printed)[rows.nu == nu] == pytest.approx(drawn[words], rel=0.03)
    assert min(printed) > 2e-5                     # of no point what two runs have alike by chance


@pytest.mark.parametrize("given, stars", [
    ("law = 'svk'\n[product]\nspeed = [4, 8]", 1), ("law = 'neohookean'\n[product]\nspeed = [4, 8]", 0),
    ("law = 'svk'\n[product]\nspeed = [4, 8]\nlaw = ['neohookean', 'svk']", 1), ("young = 5e6\n[product]\nspeed = [4, 8]", 0),
    ("viscosity = 10\n[product]\nspeed = [4, 8]", 0)])
def test_the_papers_star_stands_in_studies_of_its_scene(fake, tmp_path, given, stars):
    """The paper's number is drawn where one of the curves is of its law and scene, and nowhere else."""
    by = "by = 'law'\n" if "'neohookean', 'svk'" in given else ""
    given = given.replace("law = 'svk'\n", "") if by else given
    text = f"[set]\n{given}\n[figure]\nx = 'speed'\ny = 'contact_time'\n{by}"
    wanted = sweep.load(str(write(tmp_path, text)))
    rows = pd.DataFrame(wanted.points).assign(exit=0, contact_time=4.7e-3)
    figure = sweep_figures._lines(wanted, rows, tmp_path)
    assert sum(line.get_marker() == "*" for line in figure.axes[0].lines) == stars
    plt.close(figure)


def test_trend_does_not_trust_one_small_difference():
    """A point whose two runs agree by chance has the error bar of its curve."""
    rows = rows_over_speed([5.0, 4.8, 4.9, 4.7, 4.6]).assign(contact_time_error=[1e-4, 0, 0, 1e-4, 1e-4])
    assert "1 rise, 0 of them by more" in sweep_figures.trend(rows, "speed", "contact_time", "")


def test_set_of_a_level():
    """The range of y in which the level is met within its band, interpolated in the logarithm."""
    group = pd.DataFrame({"nu": 0.3, "penalty": [1e9, 1e10, 1e11], "contact_time": [5e-3, 4.8e-3, 4.6e-3], "exit": 0})
    figure = {"x": "nu", "y": "penalty", "colour": "contact_time", "level": 4.8e-3, "band": 1e-4}
    lines = sweep_figures._set(figure, "", group)
    assert "4.8 ± 0.1 ms is met" in lines[0] and lines[1] == "  ν = 0.3: k [Pa/m^m] 3.2e+09 to 3.2e+10"
    assert sweep_figures._set(figure | {"level": 1.0}, "", group)[1] == "  ν = 0.3: no k [Pa/m^m]"


def test_distance_of_histories():
    """||b - a|| / ||a|| in L2 over time, on different time steps."""
    fine, coarse = np.linspace(0, 1, 2001), np.linspace(0, 1, 101)
    a, b = (fine, np.sin(np.pi * fine)), (coarse, 1.1 * np.sin(np.pi * coarse))
    assert sweep_figures.distance(a, b) == pytest.approx(0.1, rel=1e-3) and sweep_figures.distance(a, a) == 0


@pytest.mark.robustness
@pytest.mark.parametrize("figure, words", [
    ('kind = "map"\nx = "nu"\ny = "speed"\ncolour = "contact_time"\nlevel = 4.67e-3\nband = 1e-5', "4.67 ± 0.01 ms is met"),
    ('kind = "histories"\ny = "normal_force"\npanel = "speed"\nby = "nu"', "speed = 4 m/s: relative L2 difference of normal force, ν = 0.3 and ν = 0.4: 0.0 %"),
])
def test_other_figures(fake, tmp_path, capsys, figure, words):
    """Maps and histories are drawn and put into words."""
    out = tmp_path / "out"
    assert sweep.main([str(write(tmp_path, SIX + f"[figure]\n{figure}\n")), "--out", str(out)]) == 0
    assert words in capsys.readouterr().out and plt.imread(out / "sweep.png").std() > 0


def test_words_as_axes(fake, tmp_path, capsys):
    """A parameter with words may vary, be an axis of a figure and stand in the table."""
    text = COARSE + '[product]\nlaw = ["svk", "neohookean"]\nspeed = [4, 8]\n[figure]\nx = "law"\ny = "contact_time"\nby = "speed"\n'
    assert sweep.main([str(write(tmp_path, text)), "--out", str(tmp_path / "out")]) == 0
    assert "| neohookean |" in capsys.readouterr().out and (tmp_path / "out/sweep.png").exists()


def test_the_sweep_of_the_docs_is_sound(tmp_path):
    """What docs/sweeps.md shows is accepted as it stands."""
    text = (parameters.ROOT / "docs/sweeps.md").read_text()
    example = re.search(r"```\n(scene = \"disc-normal\".*?)```", text, re.S)[1]
    wanted = sweep.load(str(write(tmp_path, example)))
    assert len(wanted.points) == 32 and wanted.refine and wanted.figure


def test_a_refused_point_keeps_no_other(fake, tmp_path, capsys):
    """A point that the scene refuses, the first one too, is a row with exit code 10 that is named; the others run, and --open lists it no more."""
    shutil.copy(parameters.ROOT / "orchestrate/ffimpact/scenes/two-discs.toml", tmp_path / "two.toml")
    path = write(tmp_path, 'scene = "two.toml"\ncollect = ["impulse"]\n[product]\n"body.1.position.1" = [0.05, -0.06]\n')
    wanted = sweep.load(str(path))
    place = study.place(tmp_path / "out", wanted.points[0])
    found = study.outcomes(wanted.points, tmp_path / "out", wanted.base, sweep.scene.load(wanted.scene))
    assert list(found) == [place] and found[place]["exit"] == 10 and "overlaps 'right'" in found[place]["message"]
    path.write_text('scene = "disc-normal"\ncollect = ["contact_time"]\n' + COARSE + '[[zip]]\nangle = [60, 90]\nsymmetry = ["half", "half"]\n')
    capsys.readouterr()
    assert main(["sweep", str(path), "--out", str(tmp_path / "plane")]) == 10
    said, rows = capsys.readouterr(), table(tmp_path / "plane")
    assert list(rows.exit) == [10, 0] and rows.contact_time.notna().tolist() == [False, True]
    assert "first: angle=60.0,symmetry=half: symmetry: half" in said.err and said.err.count("\n") == 1 and "failed, exit 10: angle=60.0,symmetry=half" in said.out
    assert main(["sweep", str(write(tmp_path, 'scene = "two.toml"\n[product]\n"body.1.position.1" = [0.05, 0.06]\n')), "--list"]) == 10   # none is left
