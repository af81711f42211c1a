"""disc-normal with the real FreeFem++: content of the result folder, and agreement of runs with and
without Python."""

import pytest

from ffimpact import scene
from ffimpact.failure import Failure
from ffimpact.freefem import freefem
from ffimpact.output import results
from ffimpact.running import run
from tests.support.end_to_end import COARSE, call, direct


@pytest.mark.robustness
def test_own_mesh_of_a_slow_impact_gives_what_gmsh_gives(tmp_path):
    """At 1e-5 of the wave speed of a bar the contact is 1/220 of the radius wide.

    Direct runs on meshes of half the disc and of the whole agree with Python runs on gmsh meshes to
    the requested accuracy.
    """
    values = {"law": "neohookean", "nu": 0.4, "speed": 6.38e-4, "penalty": "auto", "accuracy": 0.005, "fields": 0}
    theirs = run.run(scene.load("disc-normal"), values, tmp_path / "python", estimate=False).summary
    for symmetry in ("half", "full"):
        process = direct(*freefem.words_of(values | {"symmetry": symmetry, "out": tmp_path / symmetry}))
        assert process.returncode == 0, process.stdout + process.stderr
        ours = results.read_summary(tmp_path / symmetry)
        for key in ("thresholded_contact_time", "impulse"):
            assert ours[key] == pytest.approx(theirs[key], rel=values["accuracy"]), key


@pytest.mark.robustness
def test_a_step_longer_than_the_contact_ends_in_its_first_try(tmp_path):
    """In three dimensions, too, a step of ten contact times with friction is abandoned after the
    usual work of one step, without a second try."""
    with pytest.raises(Failure, match=r"smallest step tried 0\.05 s.* dt = 0\.05 s is too long for its friction"):
        run.run(scene.load("ball-oblique"), {"dt": 0.05, "accuracy": 0.4, "fields": 0}, tmp_path / "out", estimate=False)


@pytest.mark.robustness
def test_a_sensible_penalty_does_not_chatter(tmp_path):
    """The same coarse disc with the default penalty gives no warning about chatter."""
    process = call(*(f"{name}={value}" for name, value in COARSE.items()), out=tmp_path / "out")
    assert process.returncode == 0 and not any("chatter" in warning for warning in results.read_summary(tmp_path / "out")["warnings"])


@pytest.mark.robustness
def test_hopping_is_no_chatter(tmp_path):
    """A disc that hops under gravity returns within a transit time many times, but not
    consecutively: no failure, no warning."""
    process = direct("-law", "neohookean", "-speed", "0", "-height", "1e-5", "-gravity", "9.81", "-end_time", "0.7", "-accuracy", "0.4", "-degree", "1",
                     "-mesh_size", "0.01", "-contact_mesh_size", "0.01", "-out", str(tmp_path / "out"))
    summary = results.read_summary(tmp_path / "out")
    assert process.returncode == 0 and summary["contact_intervals"] > 40 and not any(
        "chatter" in warning for warning in summary["warnings"])


@pytest.mark.robustness
def test_touches_after_the_impact_are_no_chatter(tmp_path):
    """A rod strikes one of twice its length and stays behind at rest beside it (St. Venant: e = 1/2).

    Then its face touches the other one many times, with less than a thousandth of the peak force.
    """
    rod = {"shape": "rectangle", "height": 0.01, "mesh_size": 0.00125}
    content = {"law": "neohookean", "young": 1e6, "nu": 0.0, "density": 1000, "accuracy": 0.02, "end_time": 0.008,
               "body": [rod | {"width": 0.05, "position": [-0.0251, 0], "velocity": [0.1, 0]}, rod | {"width": 0.1, "position": [0.05, 0]}]}
    summary = run.run(scene.read(content, tmp_path, "rods"), {}, tmp_path / "out", estimate=False).summary
    assert summary["contact_intervals"] > 20 and summary["restitution"] == pytest.approx(0.5, abs=0.02)
    assert not any("chatter" in warning for warning in summary["warnings"])
