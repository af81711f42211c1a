"""Points inside a body near one of its vertices: the corners of a narrow block press into two
discs."""

import numpy as np
import pytest

from ffimpact.running import run
from ffimpact.scene import read as read_scene


def narrow(width: float, height: float, x: float, off: float, speed: float, friction: float) -> dict:
    """A block between two discs."""
    disc = {"shape": "disc", "radius": 0.05}
    return {"law": "neohookean", "young": 7e6, "nu": 0.45, "density": 1722, "accuracy": 0.05, "contact": {"friction_static": friction},
            "body": [disc | {"position": [-x, -off], "velocity": [5, 0]}, {"shape": "rectangle", "width": width, "height": height, "position": [0, 0]},
                     disc | {"position": [x, off], "velocity": [speed, 0]}]}


@pytest.mark.few(1)
@pytest.mark.parametrize("case", [dict(width=0.06, height=0.1, x=0.081, off=0, speed=0, friction=0.3), dict(width=0.1, height=0.06, x=0.102, off=0.04, speed=-5, friction=0)],
                         ids=["struck, with friction", "pressed at its corners"])
def test_vertices_cost_no_steps(case, tmp_path):
    """Nearly every step converges in few iterations, with about one factorisation per step; energy
    and momenta are conserved.

    The normals of an edge and of its vertex could alternate.
    """
    result = run.run(read_scene(narrow(**case), tmp_path, "narrow"), {"fields": 0}, tmp_path / "run", estimate=False)
    s, h = result.summary, result.history
    assert s["rejected_steps"] <= 5 and s["factorizations"] < 1.5 * s["steps"] and s["newton_iterations"] < 20 * s["steps"]
    assert s["energy_drift"] < 1e-9
    brought = s["mass_1"] * 5
    for name, scale in (("momentum_x", brought), ("momentum_y", brought), ("angular_momentum", 0.05 * brought)):
        assert np.ptp(h[name]) < 1e-9 * scale, name
    assert s["impulse_x_1"] + s["impulse_x_2"] + s["impulse_x_3"] == pytest.approx(0, abs=1e-7 * abs(s["impulse_x_1"]))
