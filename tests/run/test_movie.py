"""The film of a scene: its frames, its file, and the cases without ffmpeg and with interrupted
drawing."""

import os
import re

import numpy as np
import pytest
from PIL import Image

from ffimpact.__main__ import main
from ffimpact.output import results, vtu
from ffimpact.report import movie

FFMPEG = """#!/bin/sh
# keeps the raw frames that it gets, in the file that the last argument names
for file; do :; done
exec cat > "$file"
"""


@pytest.fixture
def no_ffmpeg(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))


@pytest.fixture
def ffmpeg(tmp_path, monkeypatch):
    """ffmpeg(script): replaces ffmpeg by the script."""
    def put(script: str) -> None:
        (tmp_path / "ffmpeg").write_text(script)
        (tmp_path / "ffmpeg").chmod(0o755)
        monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    return put


def test_film_has_the_frames_and_seconds_asked_for(fake, no_ffmpeg, tmp_path, capsys):
    """Without ffmpeg there is a GIF with the requested frames, which lasts 8 s. Its path is
    printed."""
    assert movie.main(["disc-normal", "--frames", "8", "--out", str(tmp_path / "out")]) == 0
    film = tmp_path / "out/disc-normal.gif"
    assert capsys.readouterr().out.strip() == str(film)
    with Image.open(film) as image:
        assert image.n_frames == 8 and image.info["duration"] * image.n_frames == pytest.approx(8000)
    assert len(vtu.series(tmp_path / "out/fields.pvd")) == 8


def test_results_of_the_scene_are_left_alone(fake, no_ffmpeg, tmp_path, monkeypatch):
    """Without --out the film and its run are in results/movies/SCENE."""
    monkeypatch.chdir(tmp_path)
    movie.main(["disc-normal", "--frames", "2"])
    assert [path.name for path in (tmp_path / "results").iterdir()] == ["movies"]
    assert (tmp_path / "results/movies/disc-normal/disc-normal.gif").exists()


def test_film_is_drawn_again_only_for_another_run(fake, no_ffmpeg, tmp_path, monkeypatch):
    """For the same scene and number of frames nothing is run or drawn again. A film older than its
    run is drawn again."""
    drawn = []
    monkeypatch.setattr(movie, "write", lambda film, *_: drawn.append(film) or film.write_bytes(b"GIF"))
    call = lambda *more: movie.main(["disc-normal", "--frames", "3", "--out", str(tmp_path / "out"), *more])   # noqa: E731
    call()
    call()
    # The run, and the two coarser runs for its error estimate, the second maybe ended at its start.
    first = fake.starts()
    assert len(drawn) == 1 and first in (2, 3)
    os.utime(tmp_path / "out/disc-normal.gif", (0, 0))
    call()
    assert len(drawn) == 2 and fake.starts() == first
    call("--set", "speed=4")
    assert len(drawn) == 3 and fake.starts() > first


def stop_at_third_frame(writer, monkeypatch) -> None:
    grab, grabbed = writer.grab_frame, []

    def grab_frame(self, **options):
        if len(grabbed) == 2:
            raise KeyboardInterrupt
        grabbed.append(grab(self, **options))
    monkeypatch.setattr(writer, "grab_frame", grab_frame)


@pytest.mark.parametrize("form", ["gif", "mp4"])
def test_stopped_drawing_leaves_no_film(fake, ffmpeg, tmp_path, monkeypatch, capsys, form):
    """Interruption between two frames gives exit code 130. The run stays, without an incomplete
    film or its .part."""
    ffmpeg(FFMPEG)
    stop_at_third_frame(movie.PillowWriter if form == "gif" else movie.FFMpegWriter, monkeypatch)
    assert main(["movie", "disc-normal", "--frames", "4", "--format", form, "--out", str(tmp_path / "out")]) == 130
    assert (tmp_path / "out/summary.json").exists() and not list((tmp_path / "out").glob(f"*{form}*"))


@pytest.mark.robustness
def test_mp4_wherever_there_is_ffmpeg(fake, ffmpeg, tmp_path):
    """ffmpeg gets every frame with one even size, as H.264 requires. --format gif does not use it.
    """
    ffmpeg(FFMPEG)
    movie.main(["disc-normal", "--frames", "4", "--out", str(tmp_path / "out")])
    movie.main(["disc-normal", "--frames", "4", "--format", "gif", "--out", str(tmp_path / "out")])
    with Image.open(tmp_path / "out/disc-normal.gif") as image:
        width, height = (side // 2 * 2 for side in image.size)
    assert (tmp_path / "out/disc-normal.mp4").stat().st_size == 4 * 4 * width * height


@pytest.mark.parametrize("arguments, code, words", [
    (["disc-nowhere"], 10, "disc-nowhere: no such scene"), (["disc-normal", "--frames", "1"], 10, "--frames: 1 is out of range"),
    (["disc-normal", "--set", "sped=8"], 10, "sped: no such entry"), (["disc-normal", "--format", "avi"], 10, "--format: 'avi' is not known .accepted: mp4, gif."),
    (["disc-normal", "--format", "mp4"], 13, "ffmpeg not found.*apt-get install ffmpeg.*--format gif")])
def test_bad_calls_are_one_line(fake, no_ffmpeg, tmp_path, capsys, arguments, code, words):
    """One line and the exit code, before anything runs."""
    assert main(["movie", *arguments, "--out", str(tmp_path / "out")]) == code
    error = capsys.readouterr().err
    assert error.count("\n") == 1 and re.search(words, error)
    assert fake.starts() == 0


def test_ffmpeg_that_fails_is_one_line(fake, ffmpeg, tmp_path, capsys):
    """An ffmpeg that cannot write (for instance without H.264) gives exit code 13, one line and no
    film."""
    ffmpeg("#!/bin/sh\necho Unknown encoder >&2\nexit 1\n")
    assert main(["movie", "disc-normal", "--frames", "3", "--out", str(tmp_path / "out")]) == 13
    error = capsys.readouterr().err
    assert error.startswith("ffimpact: ffmpeg could not write the film") and error.count("\n") == 1
    assert not list((tmp_path / "out").glob("*mp4*"))


def test_body_between_two_snapshots(finished_folder):
    """At the time of a snapshot the film shows its body, midway between two the mean, beyond the
    ends the first and the last."""
    motion = movie.Motion(finished_folder / "fields.pvd", half=True)
    body, line = motion.at(motion.times[3:5].mean())
    assert body.points == pytest.approx((motion.bodies[3].points + motion.bodies[4].points) / 2)
    assert body.stress == pytest.approx((motion.bodies[3].stress + motion.bodies[4].stress) / 2)
    assert line is None  # half a disc does not rotate
    for t, k in ((motion.times[3], 3), (-1.0, 0), (1.0, -1)):
        assert (motion.at(t)[0].points == motion.bodies[k].points).all()


def test_frames_differ_in_time_and_nothing_else(finished_folder):
    """Between frames the time, the marks on both force curves and the diameter move. Axes and
    colour scale do not change."""
    result = results.Record(finished_folder, {}, reused=True)
    history = result.history
    history["friction_force"] = -0.3 * history["normal_force"]
    motion = movie.Motion(finished_folder / "fields.pvd", half=True)
    motion.diameters = np.array([body.points[:5] for body in motion.bodies])  # as for a whole body
    stage = movie.PlaneStage(result, motion)
    seen = []
    for t in (1e-3, 2e-3):
        stage.show(t)
        force = np.interp(t, history["t"], history["normal_force"]) / 1e3
        assert stage.above.get_title() == f"t = {1e3 * t:.2f} ms" and stage.now.get_xdata()[0] == pytest.approx(1e3 * t)
        assert stage.dots["normal"].get_ydata() == pytest.approx([force])
        assert stage.dots["friction"].get_ydata() == pytest.approx([-0.3 * force])
        seen.append((stage.above.get_xlim(), stage.above.get_ylim(), stage.picture.get_clim(), len(stage.above.collections)))
        assert stage.marks[0].get_xydata() == pytest.approx(motion.at(t)[0].points[:5])
    assert seen[0] == seen[1]
