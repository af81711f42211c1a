"""Contact with a factorisation that is kept: the solver of its systems and their tolerance do not
change the results."""

import numpy as np
import pytest

from ffimpact.freefem import freefem
from ffimpact.output import results

BALL = dict(law="neohookean", speed=12, angle=60, slip_velocity=0.1, accuracy=0.2, mesh_size=0.03, contact_mesh_size=0.015, end_time=3e-3)
# Without a jump of the law a step has one solution.
SMOOTH = BALL | dict(friction_static=0.6, friction_dynamic=0.6)


def history(folder, flags: dict) -> dict:
    """The history of edp/program/ball-plane.edp."""
    done = freefem.find().call("edp/program/ball-plane.edp", *freefem.words_of(flags | {"out": folder / "out"}), timeout=300)
    assert done.returncode == 0, done.stderr
    return results.read_history(folder / "out")


def assert_same(result: dict, expected: dict) -> None:
    """Asserts that all columns but the count of iterations agree to 1e-6 of their largest value,
    and that the energy is balanced to 1e-9."""
    for name in set(expected) - {"newton_iterations", "balance"}:
        np.testing.assert_allclose(result[name], expected[name], rtol=0, atol=1e-6 * np.abs(expected[name]).max(), err_msg=name)
    assert np.abs(result["balance"]).max() < 1e-9 * expected["kinetic"][0]


@pytest.mark.robustness
@pytest.mark.parametrize("flags", [SMOOTH, BALL | dict(angle=90)], ids=["friction", "normal"])
def test_contact_is_solved_as_far_as_it_matters(tmp_path, flags):
    """Kernels, which solve contact on a kept factorisation to a tolerance relative to the residual of
    the step, and scripts, which assemble and factorise all anew, give the same results."""
    kernels, other = (history(tmp_path / without, flags | {"without": without}) for without in ("none", "kernels"))
    assert_same(kernels, other)


@pytest.mark.robustness
def test_jump_of_the_coefficient(tmp_path):
    """With a jump of the coefficient a step may have two solutions, and the path of the iteration
    selects one.

    Energy is balanced. Impulse and friction work agree up to the effect of the choice at one point.
    """
    flags = BALL | dict(friction_static=0.7, friction_dynamic=0.5)
    kernels, other = (history(tmp_path / without, flags | {"without": without}) for without in ("none", "kernels"))
    assert np.abs(kernels["balance"]).max() < 1e-8 * kernels["kinetic"][0]
    for name, share in (("vx", 2e-3), ("vy", 2e-3), ("friction_work", 2e-2)):
        assert abs(kernels[name][-1] - other[name][-1]) <= share * np.abs(other[name]).max(), name
