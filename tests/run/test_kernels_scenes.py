"""Built-in scenes by the scripts alone and by the compiled kernels have the same results."""

import pytest

from ffimpact import scene
from ffimpact.failure import NotInstalled
from ffimpact.running import run

# A block on its corner, a disc in a concave obstacle and a disc of St. Venant-Kirchhoff material that loses ellipticity
# amplify round-off; a ball on a beam takes minutes by scripts.
LEFT_OUT = {"ball-beam", "block-corner", "disc-bowl", "disc-oblique-svk"}
# With a jump of the coefficient a step may have two solutions, and the path of the iterations selects one.
JUMPS = {"ball-oblique", "disc-oblique", "disc-step", "disc-corner"}
LONG = {"disc-rest", "disc-rolling", "roller"}
NEED_KERNELS = {"hollow-ball", "drop-weight"}   # contact with itself, rigid bodies
NAMES = sorted(set(scene.built_in()) - LEFT_OUT - LONG - NEED_KERNELS)


@pytest.mark.few(4)
@pytest.mark.parametrize("name", NAMES)
def test_scenes_by_scripts_alone(tmp_path, name):
    """Impulse, peak force and energies agree to 1e-6, to 1e-2 where the coefficient of friction jumps."""
    with_kernels, scripts = (
        run.run(scene.load(name), {"accuracy": 0.05, "fields": 0, "without": without}, tmp_path / without, estimate=False).summary
        for without in ("none", "kernels")
    )
    if not with_kernels["kernels"]:
        pytest.skip("no compiler here")
    assert not scripts["kernels"] and with_kernels["steps"] == scripts["steps"]
    tolerance = 1e-2 if name in JUMPS else 1e-6
    for number, scale in (("impulse", None), ("peak_force", None), ("energy_final", "energy_initial"), ("friction_work", "energy_initial")):
        size = abs(with_kernels[scale or number])
        assert scripts[number] == pytest.approx(with_kernels[number], rel=0, abs=tolerance * size), number


@pytest.mark.parametrize("name", sorted(NEED_KERNELS))
def test_scenes_that_need_kernels_say_so(tmp_path, name):
    """Exit code 13, and the entry."""
    with pytest.raises(NotInstalled, match="self_contact|rigid"):
        run.run(scene.load(name), {"accuracy": 0.1, "without": "kernels"}, tmp_path / "out", estimate=False)


def test_there_are_nineteen_scenes():
    """The comparison covers nineteen scenes."""
    assert len(NAMES) == 19
