"""Central differences: contact and friction are solved on the lumped mass.

Hence only waves in the bodies determine the substeps of a step.
"""

import pytest

from tests.support.explicit import EXPLICIT, OBLIQUE
from verification.measure import bodies, disc


@pytest.mark.robustness
def test_kernels_do_what_the_scripts_say(tmp_path):
    """Friction in substeps agrees with and without kernels to round-off, on a plane and on a
    circle.

    On the circle no point of the active set is in contact at the start of a substep.
    """
    few = OBLIQUE | EXPLICIT | {"end_time": 2e-4}
    body = {"shape": "disc", "radius": 0.05, "position": [0.0, 0.0501], "velocity": [4.0, -7.0], "law": "neohookean", "young": 7e6, "nu": 0.4, "density": 1722.0}
    circle = {"accuracy": 0.2, "end_time": 2e-4, "contact": {"friction_static": 0.5}, "body": [body],
              "obstacle": [{"kind": "circle", "centre": [0.0, -0.1], "radius": 0.1}]}
    for start in (lambda out, **more: disc(out, **few | more), lambda out, **more: bodies(out, circle, **EXPLICIT | more)):
        ours, theirs = start(tmp_path / "with"), start(tmp_path / "without", without="kernels")
        for name in ("impulse", "friction_work"):
            assert ours.summary[name] == pytest.approx(theirs.summary[name], rel=1e-7) and ours.summary[name] > 0, name
