"""Other programs on our scenes: which script stands beside which scene, and, where NGSolve is installed, its answers beside ours."""

import pytest

from orchestrate import run, scene
from orchestrate.input.parameters import ROOT
from orchestrate.studies import bench, peers


def test_every_scene_has_its_script():
    """NGSolve has all bodies, GetFEM the disc; whoever is asked in the bench is there."""
    there = {path.stem for path in (ROOT / "verification/peers").glob("*.py")}
    assert {f"ngsolve_{body}" for body in peers.BODIES.values()} | {"getfem_disc"} <= there
    for asked in (bench.PEERS, bench.PEERS_QUICK):
        for name, others in asked.items():
            body = peers.BODIES[bench.CASES[name].scene]
            assert {f"{program}_{body}" for program, *_ in others if program != "textbook"} <= there


@pytest.mark.parametrize("name, sizes, step, form", [("ball", (0.025, 0.01), 1e-4, "tuned"), ("ball-axisymmetric", (0.016, 0.005), 1e-4, "tuned"),
                                                     ("disc-normal", (0.016, 0.005), 1e-4, "tuned"), ("disc-normal", (0.016, 0.005), 2.5e-5, "newmark")])
def test_ngsolve_says_the_same(name, sizes, step, form, tmp_path):
    """Its own coarse mesh of the same sizes, the same step: impulse and rebound within 0.5 %, contact time within 2 %; by Newmark's average acceleration, which
    shares nothing with our step and keeps no energy, too, with a smaller one."""
    if not peers.find("ngsolve"):
        pytest.skip("ngsolve is not installed")
    flags = {"law": "neohookean", "penalty": 1.5e10}
    theirs, reason = peers.run("ngsolve", form, *sizes, step, 120, scene=name, **flags)
    given = flags | {"mesh_size": sizes[0], "contact_mesh_size": sizes[1], "dt": step, "fields": 0}
    ours = run.run(scene.load(name), given, tmp_path / "out", estimate=False).summary
    assert theirs, reason
    assert theirs["impulse"] == pytest.approx(ours["impulse"], rel=5e-3) and theirs["rebound_vy"] == pytest.approx(ours["rebound_vy"], rel=5e-3)
    assert theirs["contact_time"] == pytest.approx(ours["contact_time"], rel=0.02)
