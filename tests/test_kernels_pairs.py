"""The compiled gap between bodies (edp/kernels/pairs.hpp) against the scripts that define it."""

import pytest

from verification.measure import measure

CASES = [("pair", {}), ("pair", dict(degree=1, tilt=0.7)), ("pair", dict(depth=0.1, noise=0.1, tilt=2.5)), ("pair", dict(depth=0, noise=0)), ("pair-3d", {}),
         ("pair-3d", dict(degree=1, tilt=0.7)), ("pair-3d", dict(corner=1, depth=0.1)), ("pair-3d", dict(corner=2, depth=0.1, degree=1))]


@pytest.mark.parametrize("script, case", CASES)
def test_gaps_rows_and_springs_are_those_of_the_scripts(script, case):
    """In the plane and in space, at faces, edges and vertices, in random steps, turns and slides: the same slots and unknowns, and all numbers to round-off."""
    found = measure(script, **case)
    if not found["built"]:
        pytest.skip("no compiler here")
    assert found["slotsOff"] == 0 and max(found[name] for name in ("gapsOff", "rowsOff", "springsOff")) < 1e-12
    assert found["springs"] > 0 or script == "pair-3d" or "noise" in case
