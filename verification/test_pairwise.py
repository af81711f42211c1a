"""Pairwise contact (14), (15) in the time integration: a disc on a free block without friction
(paper, section 3.2)."""

import numpy as np
import pytest

from ffimpact.failure import Failure

# The disc starts above the block, out of the range of the pairs of points.
SCENE = {"height": 0.3, "radius": 0.5, "speed": 10, "nu": 0.4, "law": "neohookean", "accuracy": 0.02}
# Over the energy, the momentum, and the momentum times its lever at the start.
CONSERVED = 1e-9


@pytest.fixture(name="block")
def _block(disc):
    return lambda **flags: disc(kind="disc-block", **(SCENE | flags))


def drift(values: np.ndarray, scale: float) -> float:
    return abs(values - values[0]).max() / scale


@pytest.mark.few(2)
@pytest.mark.parametrize("flags", [{}, {"law": "svk"}, {"angle": 60}, {"angle": 60, "law": "svk", "spin": 20}, {"degree": 1}, {"exponent": 2}], ids=str)
def test_energy_and_momenta_are_conserved(block, flags):
    """Energy, both momenta and angular momentum are constant over an impact with contact."""
    run = block(pairing="pairwise", **flags)
    momentum = abs(run.history["momentum_y"][0])
    assert run.summary["status"] == "ok" and run.summary["impulse_y_1"] > momentum
    assert run.summary["energy_drift"] < CONSERVED
    for name, scale in (("momentum_x", momentum), ("momentum_y", momentum), ("angular_momentum", momentum * SCENE["radius"])):
        assert drift(run.history[name], scale) < CONSERVED, name


@pytest.mark.few(1)
@pytest.mark.parametrize("law", ["neohookean", "svk"])
def test_it_agrees_with_closest_points(block, law):
    """For a range of one element and half an element, rebound velocities agree to 1 % of the speed,
    the impulse to 1 %, the contact time to 4 %."""
    nearest, usual = block(law=law).summary, block(law=law, pairing="pairwise").summary
    width = 0.06  # the element size is 0.12 m
    for summary in (usual, block(law=law, pairing="pairwise", pairing_range=width).summary):
        for name in ("rebound_vy_1", "rebound_vy_2"):
            assert summary[name] == pytest.approx(nearest[name], abs=0.01 * SCENE["speed"])
        assert summary["impulse_y_1"] == pytest.approx(nearest["impulse_y_1"], rel=0.01)
        assert summary["thresholded_contact_time"] == pytest.approx(nearest["thresholded_contact_time"], rel=0.04)


def test_half_and_whole_are_the_same(block):
    """The mirror images of half a body count as the points of the whole body do: to the accuracy, as
    the meshes differ."""
    half, whole = (block(pairing="pairwise", symmetry=part).summary for part in ("half", "full"))
    for name in ("rebound_vy_1", "rebound_vy_2", "impulse_y_1", "contact_time", "energy_initial"):
        assert half[name] == pytest.approx(whole[name], rel=SCENE["accuracy"])


def test_a_range_below_the_distance_of_points_is_said(block):
    """If the range is so small that points slip between each other, the run warns; it does not warn
    for a range of an element."""
    assert any(warning.startswith("pairing range: ") for warning in block(pairing="pairwise", pairing_range=0.02, end_time=0.045).summary["warnings"])
    assert not any(warning.startswith("pairing range: ") for warning in block(pairing="pairwise").summary["warnings"])


def test_the_printed_form_keeps_energy_and_chatters(block):
    """The force -k d jumps when points come into range. The scheme conserves energy, but the bodies
    separate and come into contact repeatedly; how often depends on the steps."""
    result = block(pairing="pairwise-printed", chatter="continue")
    assert result.summary["energy_drift"] < CONSERVED
    assert drift(result.history["momentum_y"], abs(result.history["momentum_y"][0])) < CONSERVED
    assert result.summary["contact_intervals"] > 2 and block().summary["contact_intervals"] == 1


@pytest.mark.few(2)
@pytest.mark.parametrize("flags, words", [
    ({"friction_static": 0.3}, "pairing: pairwise has no slip, and so no friction (accepted: friction_static 0, or closest-point)"),
    ({"pairing": "pairwise-printed", "exponent": 2}, "pairing: pairwise-printed has a law of its own"),
    ({"pairing_range": 0}, "pairing_range: 0 is out of range (accepted: auto, 1e-12 to 1e+09)"),
    ({"pairing": "pairs"}, "pairing: 'pairs' is not known")], ids=str)
def test_refusals(disc, flags, words):
    with pytest.raises(Failure) as failure:
        disc(**({"kind": "disc-block", "pairing": "pairwise"} | SCENE | flags))
    assert failure.value.code == 10 or "exit code 10" in str(failure.value)
    assert words in str(failure.value)
