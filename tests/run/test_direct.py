"""FreeFem++ without Python: its result folder is as safe, and no input reaches a shell as a
command."""

import resource
import signal
import subprocess
import time
from pathlib import Path

import pytest

from ffimpact import scene
from ffimpact.__main__ import main
from ffimpact.freefem import freefem
from ffimpact.output import results
from ffimpact.output.evaluate import evaluate
from ffimpact.running import run
from tests.support.direct import COARSE, call, start, words

# A name with special characters of shells.
ODD = "it's; touch pwned #$(touch pwned)`touch pwned`\"\\ *"


def names(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


RESULTS = {"history.csv", "contacts.csv", "summary.json", "last-state"}


@pytest.mark.few(2)
@pytest.mark.parametrize("name", [ODD, "-out", "-", "--", "a b/c d", "é", "a\nb"])
def test_any_name_will_do(tmp_path, name):
    """Folders, meshes and checkpoints may have any name: the run works, and no command in a name is
    executed."""
    flags = ("-checkpoint_every", "5", "-fields", "2")
    path = name if name != "-out" else "./-out"
    assert call(*COARSE, *flags, "-out", path, cwd=tmp_path)[0::2] == (0, "")
    assert RESULTS | {"fields.pvd", "fields/0000.vtu", "fields/0001.vtu", "fields/contact.csv",
                      "fields/contact.pvd", "fields/contact-0000.vtu", "fields/contact-0001.vtu"} == names(tmp_path / name)
    assert main(["evaluate", str(tmp_path / name)]) == 14      # there is nothing left to evaluate
    code, _, error = call(*COARSE, "-restart", f"{path}/x", "-out", "other", cwd=tmp_path)
    assert code == 14 and error.count("\n") == 1 and "no such file" in error
    assert not list(tmp_path.rglob("pwned"))


def test_any_name_will_do_for_python(tmp_path):
    """The same through Python, which passes its paths to the script."""
    result = run.run(scene.load("disc-normal"), {"accuracy": 0.4, "law": "neohookean", "nu": 0.4, "checkpoint_every": 5}, tmp_path / ODD)
    assert result.summary["status"] == "ok" and not list(tmp_path.rglob("pwned"))


def test_second_run_on_a_folder_is_refused(tmp_path):
    """The second run is refused with 14 as long as the first one lives, and no longer, even if it was killed."""
    first = start(*COARSE, "-dt", "1e-6", "-out", "out", cwd=tmp_path)
    end = time.monotonic() + 20
    while not (tmp_path / "out/history.csv").exists() and time.monotonic() < end:
        time.sleep(0.01)
    code, _, error = call(*COARSE, "-out", str(tmp_path / "out/"), cwd=tmp_path)
    assert code == 14 and error.startswith("ffimpact: out: ") and "another run" in error and error.count("\n") == 1
    assert first.poll() is None
    first.kill()
    first.communicate()
    assert call(*COARSE, "-out", "out", cwd=tmp_path)[0] == 0
    assert names(tmp_path / "out") == RESULTS


def test_a_finished_run_is_not_overwritten(tmp_path):
    """A second run in the folder of a finished one is refused with 14, of whatever scene; that of a failed one is taken, and files of others stay."""
    (tmp_path / "out").mkdir()
    (tmp_path / "out/notes.txt").write_text("mine")
    assert call("-accuracy", "0.4", "-speed", "60", "-out", "out", cwd=tmp_path)[0] in (11, 12)
    assert names(tmp_path / "out") == {"history.csv", "contacts.csv", "failure.json", "notes.txt"}
    assert call(*COARSE, "-out", "out", cwd=tmp_path)[0] == 0
    before = {name: (tmp_path / "out" / name).read_bytes() for name in names(tmp_path / "out")}
    assert set(before) == RESULTS | {"notes.txt"}
    for flags in ((), ("-speed", "7")):
        code, _, error = call(*COARSE, *flags, "-out", "out", cwd=tmp_path)
        assert code == 14 and "has a finished run" in error and error.count("\n") == 1
    assert before == {name: (tmp_path / "out" / name).read_bytes() for name in names(tmp_path / "out")}


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
    for flags in (("-out", "new/out"), ("-out", "new/out", "-fields", "2")):
        code, _, error = call(*COARSE, *flags, cwd=tmp_path, preexec_fn=small_files, restore_signals=False)
        assert code == 14 and error.startswith("ffimpact: out: ") and error.count("\n") == 1, error
        assert before == {name: (tmp_path / name).read_bytes() for name in names(tmp_path)} and not (tmp_path / "new").exists()


@pytest.mark.few(1)
@pytest.mark.parametrize("files", [2, 3, 4, 5, 6, 8, 9])
def test_full_disk_of_its_own(tmp_path, files):
    """On a disk that accepts a limited number of files, whichever file is the first that does not
    fit: exit code 14 with one line.

    With more space the run continues from its last checkpoint, or from the start.
    """
    program, disk = freefem.find(), tmp_path / "disk"
    disk.mkdir()
    command = words(dict(law="neohookean", nu=0.4, accuracy=0.4, fields=4, checkpoint_every=10, out="disk/out"))
    script = (f"mount -t tmpfs -o nr_inodes={files} none disk || exit 77; \"$@\" > said 2> error; echo $? > code; ls -R disk > left\n"
              "mount -o remount,nr_inodes=100 disk && rm -f said\n"
              "if [ -e disk/out/checkpoint ]; then \"$@\" -restart disk/out/checkpoint; else \"$@\"; fi > said || exit 1; ls disk/out > finished")
    process = subprocess.run(["unshare", "-rm", "sh", "-c", script, "sh", *command], cwd=tmp_path, env=program.environment, capture_output=True, text=True, timeout=60)
    if process.returncode == 77 or "unshare" in process.stderr:
        pytest.skip("no disk of one's own here")
    assert process.returncode == 0, process.stderr
    error = (tmp_path / "error").read_text()
    assert (tmp_path / "code").read_text() == "14\n" and error.startswith("ffimpact: ") and error.count("\n") == 1, error
    assert "summary.json" not in (tmp_path / "left").read_text()
    assert set((tmp_path / "finished").read_text().split()) == {"history.csv", "contacts.bin", "states.bin", "record.json", "last-state"}


@pytest.mark.parametrize("kind, accuracy", [("disc", "0.01"), ("disc-block", "0.03")])
def test_a_stiff_penalty_does_not_cost(tmp_path, kind, accuracy):
    """With ten and a hundred times the automatic penalty there are as many steps and at most 1.5
    times as many iterations.

    Steps do not follow single points that bounce. Impulse and rebound stay within the accuracy, and
    the energy balance closes.
    """
    ends = {}
    for times in (1, 10, 100):
        out = tmp_path / str(times)
        assert start("-accuracy", accuracy, "-penalty", str(times * 1e10), "-out", out, cwd=tmp_path, kind=kind).wait(60) == 0
        evaluate(out)
        end = ends[times] = results.read_summary(out)
        assert end["steps"] < 1.1 * ends[1]["steps"] and end["newton_iterations"] < 1.5 * ends[1]["newton_iterations"]
        assert [end[name] for name in ("impulse", "restitution")] == pytest.approx([ends[1][name] for name in ("impulse", "restitution")], rel=0.01)
        assert end["energy_drift"] < 1e-9
