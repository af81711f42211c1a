"""The summary of a run of the paper's scripts, from hand-written answers and histories."""

import json

import pytest

import ffimpact
from ffimpact.failure import Unreadable
from ffimpact.output.paper_script import ANSWERS

COLUMNS = ("t,dt,normal_force,friction_force,kinetic,elastic,contact,friction_work,external_work,balance,momentum_x,momentum_y,angular_momentum,"
           "x,y,vx,vy,spin,max_penetration,sliding_fraction,reverse_fraction,min_jacobian,newton_iterations")
# A body of 2 kg/m: two contacts of one step with 30 and 10 N/m, then a flight.
ROWS = ((0, 0.1, 0, 0, 9, 0, 0, 0, 0, 0, 0, -6, 0, 0, 1, 0, -3, 0, 0, 0, 0, 1, 0),
        (0.1, 0.1, 30, -6, 2.25, 5.75, 0.5, 0.5, 0, 1e-9, 0, -3, 0, 0, 1, 0, -1.5, 0, 0.1, 1, 0, 0.9, 4),
        (0.2, 0.1, 0, 0, 2.25, 6.25, 0, 0.5, 0, 0, 0, -3, 0, 0, 1, 0, -1.5, 0, 0, 0, 0, 0.8, 3),
        (0.3, 0.1, 10, 0, 7, 1.5, 0, 0.5, 0, -2e-9, 0, 4, 0.5, 0, 1, 1, 2, 2, 0, 0, 0, 0.95, 5))


def finished(folder, rows=ROWS, **more):
    answers = {"script": "disc-plane", "law": "svk", "nu": 0.45, "density": 1722, "radius": 0.05, "young": 7e6, "speed": 3, "penalty": 1e9, "exponent": 1,
               "end_time": 0, "contact_start": 0.0, "contact_end": 0.28, "mass": 2.0, "dofs": 100, "unconverged_steps": 0, "cpu_seconds": 1.0,
               "search_seconds": 0, "passed": 0} | more
    (folder / ANSWERS).write_text(json.dumps(answers))
    (folder / "history.csv").write_text("\n".join([COLUMNS, *(",".join(map(str, row)) for row in rows)]) + "\n")
    return ffimpact.load(folder)


def test_the_numbers_of_a_summary(tmp_path):
    """Impulse 30 0.1 + 10 0.1, drift 2e-9/9, vibration 8.5 - 2 (1 + 4)/2 - 0.5 2/2, two contacts."""
    result = finished(tmp_path)
    assert result["impulse"] == pytest.approx(4) and result["energy_drift"] == pytest.approx(2e-9 / 9) and result["contact_intervals"] == 2
    assert result["vibration_energy"] == pytest.approx(3) and (result["rebound_vx"], result["rebound_vy"], result["rebound_spin"]) == (1, 2, 2)
    assert result["contact_time"] == pytest.approx(0.28) and result["peak_force"] == 30 and result["min_jacobian"] == 0.8 and result["newton_iterations"] == 12
    assert result.summary["made_by"] == "script" and result.warnings == [] and dict(result.errors) == {} and result.scene["body"][0]["nu"] == 0.45


def test_what_may_be_wrong_is_a_warning(tmp_path):
    """Steps without convergence, inverted elements, and bodies that pass through each other."""
    inverted = [row if row[0] < 0.2 else (*row[:-2], -0.1, row[-1]) for row in ROWS]
    first, second, third = finished(tmp_path, inverted, unconverged_steps=3, passed=1).warnings
    assert first.startswith("3 steps did not converge") and second.startswith("breakdown: det F <= 0 from 200 ms on") and "slip through each other" in third


@pytest.mark.parametrize("name", [ANSWERS, "history.csv"])
def test_a_damaged_file_is_one_line(tmp_path, name):
    """A file that is cut off is Unreadable, with its name."""
    finished(tmp_path)
    (tmp_path / name).write_text((tmp_path / name).read_text()[:-9])
    with pytest.raises(Unreadable, match=name):
        ffimpact.load(tmp_path)
