"""Sweeps: the file and its errors, the table, killed and simultaneous sweeps, Snakemake, trends,
maps and histories."""

import fcntl
import os
import signal
import subprocess
import sys

import numpy as np
import pytest

from ffimpact.__main__ import main
from ffimpact.input import parameters
from ffimpact.report.figures import plt
from ffimpact.sweeps import sweep, sweep_figures
from tests.support.cli import call, start, wait_for
from tests.support.sweep import DRAWN, SIX, orphans, table, write


@pytest.mark.robustness
def test_unknown_sweep_and_run():
    """Exit code 10 and one line with the existing names."""
    code, _, err = call("sweep", "nothing")
    assert code == 10 and "built in: calibrate, calibrate-ball, calibrate-ball-3d, calibrate-oblique, closest-points, conservation, contact-time-neohookean" in err and err.count("\n") == 1
    code, _, err = call("sweep", "law-comparison", "--run", "speed=3")
    assert code == 10 and "--run: 'speed=3' is no run of law-comparison (accepted: see --list)" in err


@pytest.mark.robustness
def test_another_sweep_does_not_come_in_between(fake, tmp_path, monkeypatch, capsys):
    """While a sweep runs, another sweep file with the same folder is refused; afterwards it is not.
    """
    path, out, other = write(tmp_path, SIX), tmp_path / "out", write(tmp_path / "other", SIX + "[[zip]]\ndt = [1e-5]\n")
    monkeypatch.setenv("FAKE", "brief")
    process = start("sweep", str(path), "--out", str(out))
    wait_for(lambda: fake.starts() >= 1)
    assert main(["sweep", str(other), "--out", str(out)]) == 14
    assert "is being written by another sweep" in capsys.readouterr().err
    assert process.wait(60) == 0 and (out / "sweep.toml").read_text() == SIX
    monkeypatch.setenv("FAKE", "ok")
    assert main(["sweep", str(other), "--out", str(out)]) == 0 and len(table(out)) == 6


@pytest.mark.robustness
def test_killed_freefem_costs_its_point_only(fake, tmp_path, monkeypatch):
    """After kill -9 of a FreeFem++ its point fails with a message and the others continue. The same
    command repeats this point only."""
    path, out = write(tmp_path, DRAWN), tmp_path / "out"
    monkeypatch.setenv("FAKE", "brief")
    process = start("sweep", str(path), "--out", str(out))
    wait_for(lambda: fake.starts() >= 1)
    os.kill(fake.pids()[0], signal.SIGKILL)
    output, _ = process.communicate(timeout=60)
    assert process.returncode == 1 and "5 of 6 points finished" in output and "was killed by SIGKILL" in output
    before = fake.starts()
    assert main(["sweep", str(path), "--out", str(out)]) == 0 and fake.starts() == before + 1
    assert (table(out).exit == 0).all()


@pytest.mark.robustness
def test_two_drivers_share_a_folder(fake, tmp_path, monkeypatch):
    """Both processes finish with the same table, and no point runs twice."""
    path, out = write(tmp_path, DRAWN), tmp_path / "out"
    monkeypatch.setenv("FAKE", "brief")
    both = [start("sweep", str(path), "--out", str(out)) for _ in range(2)]
    for process in both:
        output, err = process.communicate(timeout=60)
        assert process.returncode == 0 and "6 of 6 points finished" in output, err
    assert fake.starts() == 6 and (table(out).exit == 0).all() and not orphans(out)


@pytest.mark.robustness
@pytest.mark.few(1)
@pytest.mark.parametrize("dies", [False, True])
def test_driver_waits_for_one_that_just_begins(fake, tmp_path, dies):
    """A process that finds another one between locking the folder and writing sweep.toml waits,
    then shares the folder.

    If the other one dies meanwhile, it has the folder alone.
    """
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
    output, err = process.communicate(timeout=60)
    assert process.returncode == 0 and "6 of 6 points finished" in output, err


@pytest.mark.robustness
def test_one_run_of_the_list(fake, tmp_path, capsys):
    """--list prints the names of the runs, --run executes one of them, and the sweep reuses it."""
    path, out = write(tmp_path, SIX), tmp_path / "out"
    assert main(["sweep", str(path), "--out", str(out), "--list"]) == 0
    names = capsys.readouterr().out.split()
    assert len(names) == 6 and names[1] == "speed=4.0,nu=0.4"
    assert main(["sweep", str(path), "--out", str(out), "--run", names[1]]) == 0 and fake.starts() == 1
    assert not (out / "sweep.csv").exists()
    assert main(["sweep", str(path), "--out", str(out)]) == 0 and fake.starts() == 6


@pytest.mark.robustness
def test_snakemake_takes_names_with_blanks(tmp_path):
    """The names of runs and the folder may contain blanks, as an expression of time does."""
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


@pytest.mark.robustness
def test_table_and_figure_have_the_same_error_bars(fake, tmp_path, monkeypatch):
    """The error bars in the table equal those of the figure, curve by curve."""
    text = DRAWN.replace("[figure]", "[refine]\naccuracy = 1e-3\n[figure]").replace("[product]", "accuracy = 5e-3\n[product]")
    plan = sweep.load(str(write(tmp_path, text)))
    rows = sweep.table(plan, tmp_path / "out").assign(contact_time_error=[1e-6, 4e-5, 6e-5, 2e-6, 3e-6, 5e-5])
    lines = sweep.report(plan, rows, tmp_path / "out").splitlines()
    column = [name.strip() for name in next(line for line in lines if line.startswith("|")).split("|")].index("contact_time")
    printed = [float(line.split("|")[column].split("±")[1]) for line in lines if line.startswith("|") and "±" in line]
    drawn, bar = {}, plt.Axes.errorbar
    monkeypatch.setattr(plt.Axes, "errorbar", lambda axes, x, y, error, **more: drawn.update({more["label"]: 1e-3 * error})
                        or bar(axes, x, y, error, **more))
    sweep_figures.draw(plan, rows, tmp_path / "out")
    for nu, words in ((0.3, "ν = 0.3"), (0.4, "ν = 0.4")):
        assert np.array(printed)[rows.nu == nu] == pytest.approx(drawn[words], rel=0.03)
    # No point has the error bar of two runs that agree by chance.
    assert min(printed) > 2e-5


@pytest.mark.robustness
@pytest.mark.parametrize("figure, words", [
    ('kind = "map"\nx = "nu"\ny = "speed"\ncolour = "contact_time"\nlevel = 4.67e-3\nband = 1e-5', "4.67 ± 0.01 ms is met"),
    ('kind = "histories"\ny = "normal_force"\npanel = "speed"\nby = "nu"', "speed = 4 m/s: relative L2 difference of normal force, ν = 0.3 and ν = 0.4: 0.0 %"),
])
def test_other_figures(fake, tmp_path, capsys, figure, words):
    """Maps and histories are drawn and described in words."""
    out = tmp_path / "out"
    assert sweep.main([str(write(tmp_path, SIX + f"[figure]\n{figure}\n")), "--out", str(out)]) == 0
    assert words in capsys.readouterr().out and plt.imread(out / "sweep.png").std() > 0
