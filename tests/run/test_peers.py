"""Other programs for our scenes: the script of each scene and, if NGSolve is installed, its results
beside ours."""

import pandas as pd
import pytest

from benchmarks import bench, equal_errors, layers, peers
from ffimpact import scene
from ffimpact.input.parameters import ROOT
from ffimpact.running import run
from verification import measure


def test_every_scene_has_its_script():
    """NGSolve has all bodies, GetFEM the disc. The scripts of the bench exist."""
    there = {path.stem for path in (ROOT / "benchmarks/programs").glob("*.py")}
    assert {f"ngsolve_{body}" for body in peers.BODIES.values()} | {"getfem_disc"} <= there
    assert {"ngsolve_two_bodies", "ffimpact_run"} <= there
    for programs in (bench.PEERS, bench.PEERS_QUICK):
        for name, others in programs.items():
            body = peers.BODIES[bench.CASES[name].scene]
            assert {f"{program}_{body}" for program, *_ in others if program != "textbook"} <= there


@pytest.mark.parametrize("name, sizes, step, form", [("ball", (0.025, 0.01), 1e-4, "tuned"), ("ball-axisymmetric", (0.016, 0.005), 1e-4, "tuned"),
                                                     ("disc-normal", (0.016, 0.005), 1e-4, "tuned"), ("disc-normal", (0.016, 0.005), 2.5e-5, "newmark")])
def test_ngsolve_says_the_same(name, sizes, step, form, tmp_path):
    """On its own coarse mesh of equal sizes with equal steps: impulse and rebound within 0.5 %,
    contact time within 2 %.

    This also holds for Newmark's average acceleration, which is independent of our step and does
    not conserve energy, with a smaller step.
    """
    if not peers.find("ngsolve"):
        pytest.skip("ngsolve is not installed")
    flags = {"law": "neohookean", "penalty": 1.5e10}
    theirs, reason = peers.run("ngsolve", form, *sizes, step, 120, scene=name, **flags)
    values = flags | {"mesh_size": sizes[0], "contact_mesh_size": sizes[1], "dt": step, "fields": 0}
    ours = run.run(scene.load(name), values, tmp_path / "out", estimate=False).summary
    assert theirs, reason
    assert theirs["impulse"] == pytest.approx(ours["impulse"], rel=5e-3) and theirs["rebound_vy"] == pytest.approx(ours["rebound_vy"], rel=5e-3)
    assert theirs["contact_time"] == pytest.approx(ours["contact_time"], rel=0.02)


def test_ngsolve_says_the_same_with_friction(tmp_path):
    """The oblique disc with static and dynamic coefficient: rebound, spin and impulse agree within
    0.5 % in both forms; energy with friction work is conserved."""
    if not peers.find("ngsolve"):
        pytest.skip("ngsolve is not installed")
    sizes, values = (0.016, 0.005), {"law": "neohookean", "speed": 12.0}
    case = equal_errors.CASES["oblique"]
    ours = equal_errors.answers(case, equal_errors.OURS, peers.ours(60, "disc-oblique", mesh_size=sizes[0], contact_mesh_size=sizes[1], dt=1e-4, fields=0, **values)[0])
    # The plain form takes mu of the previous step.
    for form, limit in (("tuned", 0.5), ("plain", 0.7)):
        theirs, reason = peers.run("ngsolve", form, *sizes, 1e-4, 120, scene="disc-oblique", tolerance=1e-8, **values)
        assert theirs, reason
        assert equal_errors.errors(case, equal_errors.answers(case, form, theirs), ours)["error"] < limit
        assert theirs["energy_drift"] < 1e-4 and theirs["friction_work"] > 30


def test_ngsolve_says_the_same_of_a_clamped_beam(tmp_path):
    """The first contact of a disc on a beam with clamped ends.

    Impulse, velocity of the disc and the time above 1 % of the peak agree within 0.5 %, on coarse
    meshes of either program.
    """
    if not peers.find("ngsolve"):
        pytest.skip("ngsolve is not installed")
    material = {"nu": 0.45, "young": 7e6, "density": 1722.0}
    beam = {"width": 0.3, "height": 0.06}
    theirs, reason = peers.two_bodies(200, clamped=1, radius=0.05, speed=4.0, penalty=1e10, **beam, **material)
    assert theirs, reason
    disc = {"shape": "disc", "radius": 0.05, "position": [0, 0.0801], "velocity": [0, -4]}
    held = {"shape": "rectangle", "position": [0, 0], "support": [{"where": "left"}, {"where": "right"}]}
    ours = measure.bodies(tmp_path, {"law": "neohookean", "accuracy": 4e-3, "end_time": 6e-3, "contact": {"penalty": 1e10},
                                     "body": [disc, held | beam]} | material).summary
    assert theirs["impulse"] == pytest.approx(ours["impulse"], rel=5e-3)
    assert theirs["velocity_upper"] == pytest.approx(ours["rebound_vy_1"], rel=5e-3)
    assert theirs["contact_time_1_percent"] == pytest.approx(ours["thresholded_contact_time"], rel=5e-3)


def test_ngsolve_says_the_same_of_a_layered_ball(tmp_path):
    """On the same coarse mesh: impulse and rebound to 0.02 %, the other answers to 1 %. Without its core the ball is another."""
    if not peers.find("ngsolve"):
        pytest.skip("ngsolve is not installed")
    table = pd.DataFrame(layers.compare(layers.LEVELS[0], tmp_path)[0]).set_index("answer")
    assert (table.differ[["impulse", "rebound_vy"]] < 2e-4).all() and (table.differ < 0.01).all()
    assert (table["without core"] > 0.015).all()


def test_ours_beside_the_peers():
    """This program runs by the interface of the other programs: its summary, and imports, set-up
    and time integration that add up to most of its process."""
    numbers, reason = peers.ours(60, "disc-normal", accuracy=0.1, fields=0)
    assert numbers, reason
    parts = [numbers[f"{part}_seconds"] for part in ("imports", "setup", "cpu")]
    assert min(parts) > 0 and 0.6 < sum(parts) / numbers["process_seconds"] < 1.05
    assert numbers["impulse"] == pytest.approx(208.2, rel=0.01)
    assert peers.ours(60, "disc-normal", speed=-1)[1].startswith("exit code")
