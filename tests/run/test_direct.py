"""FreeFem++ without Python: its result folder is as safe, and no input reaches a shell as a
command."""

import os
import resource
import signal
import subprocess
import time
import tomllib
from pathlib import Path

import pytest

from ffimpact import scene
from ffimpact.failure import Busy, Unreadable
from ffimpact.freefem import freefem
from ffimpact.input import parameters
from ffimpact.mesh import mesh
from ffimpact.output import folder, results
from ffimpact.running import run
from tests.support.direct import COARSE, call, start

# A name with special characters of shells.
ODD = "it's; touch pwned #$(touch pwned)`touch pwned`\"\\ *"


def names(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


RESULTS = {"scene.toml", "history.csv", "contacts.csv", "summary.json"}


@pytest.mark.few(2)
@pytest.mark.parametrize("name", [ODD, "-out", "-", "--", "a b/c d", "é", "a\nb"])
def test_any_name_will_do(tmp_path, name):
    """Folders, meshes and checkpoints may have any name: the run works, and no command in a name is
    executed."""
    flags = ("-checkpoint_every", "5", "-fields", "2")
    given = name if name != "-out" else "./-out"
    assert call(*COARSE, *flags, "-out", given, cwd=tmp_path)[0::2] == (0, "")
    assert RESULTS | {"fields.pvd", "fields/0000.vtu", "fields/0001.vtu", "fields/contact.csv",
                      "fields/contact.pvd", "fields/contact-0000.vtp", "fields/contact-0001.vtp"} == names(tmp_path / name)
    mesh.write(mesh.disc(0.05, 0.02, 0.01, True), tmp_path / name / "my.msh")
    assert call(*COARSE, "-mesh", f"{given}/my.msh", "-out", "out", cwd=tmp_path)[0::2] == (0, "")
    code, _, error = call(*COARSE, "-restart", f"{given}/x", "-out", "out", cwd=tmp_path)
    assert code == 14 and error.count("\n") == 1 and "no such file" in error
    assert not list(tmp_path.rglob("pwned"))


def test_any_name_will_do_for_python(tmp_path):
    """The same through Python, which passes its paths to the script."""
    result = run.run(scene.load("disc-normal"), {"accuracy": 0.4, "law": "neohookean", "nu": 0.4, "checkpoint_every": 5}, tmp_path / ODD)
    assert result.summary["status"] == "ok" and not list(tmp_path.rglob("pwned"))


def test_second_run_on_a_folder_is_refused(tmp_path):
    """The lock belongs to the kernel: the second run is refused with 14 while the first one lives,
    and no longer, even if it is killed."""
    first = start(*COARSE, "-dt", "1e-6", "-out", "out", cwd=tmp_path)
    end = time.monotonic() + 20
    while not (tmp_path / "out/unfinished/history.csv").exists() and time.monotonic() < end:
        time.sleep(0.01)
    code, _, error = call(*COARSE, "-out", str(tmp_path / "out/"), cwd=tmp_path)
    assert code == 14 and error.startswith("ffimpact: out: ") and "another run" in error and error.count("\n") == 1
    with pytest.raises(Busy):
        run.run(scene.load("disc-normal"), {"accuracy": 0.4}, tmp_path / "out")
    assert first.poll() is None
    first.kill()
    first.communicate()
    assert call(*COARSE, "-out", "out", cwd=tmp_path)[0] == 0
    assert names(tmp_path / "out") == RESULTS


def test_run_in_a_folder_that_python_is_at_is_refused(tmp_path):
    """Python makes the files of DIR in DIR.part. While that is locked, DIR is in use."""
    (tmp_path / "out.part").mkdir()
    lock = folder.lock_folder(tmp_path / "out.part", tmp_path / "out")
    code, _, error = call(*COARSE, "-out", "out", cwd=tmp_path)
    os.close(lock)
    assert code == 14 and "another run" in error


def test_files_of_others_are_left_alone(tmp_path):
    """A folder that the program has not made is refused with 14, as through Python."""
    (tmp_path / "out").mkdir()
    (tmp_path / "out/thesis.tex").write_text("years of work")
    code, _, error = call(*COARSE, "-out", "out", cwd=tmp_path)
    assert code == 14 and "files of others" in error and error.count("\n") == 1 and names(tmp_path) == {"out/thesis.tex"}
    (tmp_path / "out").rename(tmp_path / "unfinished")
    assert call(*COARSE, "-out", "out", cwd=tmp_path)[0] == 0
    (tmp_path / "unfinished").rename(tmp_path / "out/unfinished")
    code, _, error = call(*COARSE, "-out", "out", cwd=tmp_path)
    assert code == 14 and "files of others" in error and (tmp_path / "out/unfinished/thesis.tex").exists()


@pytest.mark.parametrize("name", ["out/unfinished", "unfinished/", "unfinished/deeper"])
def test_the_folder_of_a_run_under_way_is_no_folder_of_results(tmp_path, name):
    """DIR/unfinished, which a run in DIR would remove, is refused as -out and --out with 14: a
    finished run in it would be lost."""
    code, _, error = call(*COARSE, "-out", name, cwd=tmp_path)
    assert code == 14 and "is in a folder unfinished" in error and error.count("\n") == 1 and not names(tmp_path)
    with pytest.raises(Unreadable, match="is in a folder unfinished"):
        folder.result_folder(tmp_path / name)


def test_a_run_killed_while_its_files_took_their_places_goes_on(tmp_path, monkeypatch):
    """After kill -9 while some files are in their final places and others are not, the run
    continues from the checkpoint to the same result."""
    assert call(*COARSE, "-fields", "2", "-out", "straight", cwd=tmp_path)[0] == 0
    (tmp_path / "mv").write_text("""#!/bin/sh
if [ "$2" = scene.toml ]; then PATH=${PATH#*:}; mv "$2" "$3" ..; kill -9 0; fi
PATH=${PATH#*:}; exec mv "$@"\n""")
    (tmp_path / "mv").chmod(0o755)
    flags = (*COARSE, "-fields", "2", "-checkpoint_every", "5", "-out", "out")
    with monkeypatch.context() as patched:
        patched.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
        assert call(*flags, cwd=tmp_path, process_group=0)[0] == -signal.SIGKILL
    assert (tmp_path / "out/history.csv").exists() and not (tmp_path / "out/summary.json").exists()
    assert call(*flags, "-restart", "out/checkpoint", cwd=tmp_path)[0::2] == (0, "")
    assert names(tmp_path / "out") == names(tmp_path / "straight")
    assert (tmp_path / "out/history.csv").read_bytes() == (tmp_path / "straight/history.csv").read_bytes()


def test_an_interrupt_while_files_take_their_places_is_no_success(tmp_path, monkeypatch):
    """Ctrl-C reaches the commands for which FreeFEM waits, but not FreeFEM: exit code 130, no
    results reported, none partly in place."""
    (tmp_path / "mv").write_text("#!/bin/sh\nkill -INT 0\n")
    (tmp_path / "mv").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    code, said, _ = call(*COARSE, "-out", "out", cwd=tmp_path, process_group=0)
    assert code == 130 and "results in" not in said and not (tmp_path / "out/summary.json").exists()


def test_an_earlier_run_that_cannot_be_put_aside(tmp_path):
    """On a mount point, which cannot be renamed, a second run is refused with 14 before it begins,
    and through Python any run."""
    disk = tmp_path / "disk"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "none", disk], capture_output=True).returncode:
        pytest.skip("nothing can be mounted here")
    try:
        assert call(*COARSE, "-out", "disk", cwd=tmp_path)[0] == 0
        code, said, error = call(*COARSE, "-speed", "3", "-out", "disk", cwd=tmp_path)
        assert code == 14 and "cannot be put aside" in error and "progress" not in said and names(disk) == RESULTS
        with pytest.raises(Unreadable, match="cannot be put aside"):
            folder.finished_in(disk, force=False)
    finally:
        subprocess.run(["umount", disk], check=True)


def test_earlier_runs(tmp_path):
    """Another scene or mesh moves the folder aside. The same scene replaces files of the program
    and keeps files of the user."""
    assert call(*COARSE, "-fields", "4", "-out", "out", cwd=tmp_path)[0] == 0
    for name in ("notes.txt", "fields/mine.txt", ".hidden"):
        (tmp_path / "out" / name).write_text("mine")
    first = (tmp_path / "out/summary.json").read_bytes()
    code, said, _ = call(*COARSE, "-fields", "4", "-checkpoint_every", "5", "-out", "out/", cwd=tmp_path)
    assert code == 0 and "earlier run" not in said and [path.name for path in tmp_path.iterdir()] == ["out"]
    assert {"notes.txt", "fields/mine.txt", ".hidden"} < names(tmp_path / "out") and (tmp_path / "out/summary.json").read_bytes() != first
    before = {name: (tmp_path / "out" / name).read_bytes() for name in names(tmp_path / "out")}
    code, said, _ = call(*COARSE, "-speed", "7", "-out", "out", cwd=tmp_path)
    assert code == 0 and f"is now in {tmp_path}/out.1\n" in said and names(tmp_path / "out") == RESULTS
    assert before == {name: (tmp_path / "out.1" / name).read_bytes() for name in names(tmp_path / "out.1")}
    mesh.write(mesh.disc(0.05, 0.02, 0.01, True), tmp_path / "my.msh")
    assert f"{tmp_path}/out.2\n" in call(*COARSE, "-speed", "7", "-mesh", "my.msh", "-out", "out", cwd=tmp_path)[1]


def test_failure_does_not_cost_an_earlier_result(tmp_path):
    """A failed run moves a finished one of the same folder aside, complete. Bad input does not move
    it."""
    assert call(*COARSE, "-out", "out", cwd=tmp_path)[0] == 0
    before = (tmp_path / "out/history.csv").read_bytes()
    assert call(*COARSE, "-speed", "0", "-out", "out", cwd=tmp_path)[0] == 10
    assert names(tmp_path) == {f"out/{name}" for name in RESULTS}
    assert call("-accuracy", "0.4", "-speed", "60", "-out", "out", cwd=tmp_path)[0] in (11, 12)
    assert names(tmp_path / "out") == {"scene.toml", "history.csv", "contacts.csv", "failure.json"} and (tmp_path / "out.1/history.csv").read_bytes() == before


@pytest.mark.few(1)
@pytest.mark.parametrize("size", [0, 200, 3000, 6000])
def test_full_disk(tmp_path, size):
    """If files cannot grow, the exit code is 14 with one line, there are no finished results, and
    an earlier result stays."""
    assert call(*COARSE, "-out", "out", cwd=tmp_path)[0] == 0
    before = {name: (tmp_path / name).read_bytes() for name in names(tmp_path)}

    # As on a full disk, a write fails without the signal.
    def small_files():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    for flags in (("-out", "out", "-speed", "7"), ("-out", "new/out"), ("-out", "new/out", "-fields", "2")):
        code, _, error = call(*COARSE, *flags, cwd=tmp_path, preexec_fn=small_files, restore_signals=False)
        assert code == 14 and error.startswith("ffimpact: out: ") and error.count("\n") == 1, error
        assert before == {name: (tmp_path / name).read_bytes() for name in names(tmp_path)} and not (tmp_path / "new").exists()


@pytest.mark.few(1)
@pytest.mark.parametrize("files", [2, 3, 4, 5, 6, 8, 10])
def test_full_disk_of_its_own(tmp_path, files):
    """On a disk that accepts a limited number of files, whichever file is the first that does not
    fit: exit code 14 with one line.

    With more space the run continues from its last checkpoint, or from the start.
    """
    program, disk = freefem.find(), tmp_path / "disk"
    disk.mkdir()
    words = program.words(parameters.ROOT / "edp/disc-plane.edp", *COARSE, "-fields", "4", "-checkpoint_every", "10", "-out", "disk/out")
    script = (f"mount -t tmpfs -o nr_inodes={files} none disk || exit 77; \"$@\" > said 2> error; echo $? > code; ls -R disk > left\n"
              "mount -o remount,nr_inodes=100 disk && rm -f said\n"
              "if [ -e disk/out/checkpoint ]; then \"$@\" -restart disk/out/checkpoint; else \"$@\"; fi > said || exit 1; ls disk/out > finished")
    process = subprocess.run(["unshare", "-rm", "sh", "-c", script, "sh", *words], cwd=tmp_path, env=program.environment, capture_output=True, text=True, timeout=60)
    if process.returncode == 77 or "unshare" in process.stderr:
        pytest.skip("no disk of one's own here")
    assert process.returncode == 0, process.stderr
    error = (tmp_path / "error").read_text()
    assert (tmp_path / "code").read_text() == "14\n" and error.startswith("ffimpact: ") and error.count("\n") == 1, error
    assert "summary.json" not in (tmp_path / "left").read_text()
    assert set((tmp_path / "finished").read_text().split()) == RESULTS | {"fields", "fields.pvd"}


@pytest.mark.parametrize("given", [
    {"speed": ("+8", 8), "spin": ("-.5", -0.5), "fields": ("2e0", 2), "radius": ("5E-2", 0.05), "height": ("0.000", 0), "young": ("7e06", 7e6),
     "nu": ("00.1234567890123", 0.1234567890123), "checkpoint_every": ("1E3", 1000)},
    {"speed": (".5", 0.5), "spin": ("-00012.3456789", -12.3456789)}, {"speed": ("007", 7)}, {"speed": ("+007.1234567890123", 7.1234567890123)}])
def test_numbers_are_written_as_toml(tmp_path, given):
    """scene.toml has numbers of flags in TOML's format, to the last digit."""
    assert call("-accuracy", "0.4", "-law", "neohookean", "-end_time", "1e-5", *freefem.words_of({name: text for name, (text, _) in given.items()}), "-out", "out",
                cwd=tmp_path)[0] == 0
    found = tomllib.loads((tmp_path / "out/scene.toml").read_text())
    assert {name: found[name] for name in given} == {name: value for name, (_, value) in given.items()}


@pytest.mark.parametrize("script, accuracy", [("disc-plane", "0.01"), ("disc-block", "0.03")])
def test_a_stiff_penalty_does_not_cost(tmp_path, script, accuracy):
    """With ten and a hundred times the automatic penalty there are as many steps and at most 1.5
    times as many iterations.

    Steps do not follow single points that bounce. Impulse and rebound stay within the accuracy, and
    the energy balance closes.
    """
    ends = {}
    for times in (1, 10, 100):
        out = tmp_path / str(times)
        assert start("-accuracy", accuracy, "-penalty", str(times * 1e10), "-out", out, cwd=tmp_path, script=script).wait(60) == 0
        end = ends[times] = results.read_summary(out)
        assert end["steps"] < 1.1 * ends[1]["steps"] and end["newton_iterations"] < 1.5 * ends[1]["newton_iterations"]
        assert [end[name] for name in ("impulse", "restitution")] == pytest.approx([ends[1][name] for name in ("impulse", "restitution")], rel=0.01)
        assert end["energy_drift"] < 1e-9
