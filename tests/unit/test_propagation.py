"""Errors of restitutions, of the angle after contact and of the impulse ratio, which follow from
those of velocities and impulses; errors of a run until rest."""

import json
import math

import pytest

from ffimpact.failure import Unreadable
from ffimpact.output.errors import errors
from ffimpact.output.rest import rest_errors
from ffimpact.output.results import Answers, Record

SHARE = {
    "impulse": 0.01,
    "rebound": 0.004,
    "rebound_spin": 0.006,
    "energy": 0.01,
    "friction_work": 0.01,
}
SPEED, MASS, RADIUS = 10.0, 2.0, 0.05
NORMAL, ALONG = 2.0, math.sqrt(96.0)  # velocity before contact [m/s], of size SPEED
AFTER = (9.0, 1.8)  # velocity of the centre after contact [m/s]
SCENE = """\
radius = 0.05
[[body]]
name = "disc"
{disc}
[[body]]
name = "other"
{other}
"""


def record(folder, disc="", other=None, lever=0.0, mass=1e9) -> Record:
    """A disc that slides over a plane, or over another body at rest with this mass."""
    several = other is not None
    ends, partner = (("_1", "_2"), 2) if several else (("",), -1)
    summary = {"status": "ok", "impulse": 7.6, "restitution": 0.9, "restitution_tangential": 0.4}
    summary |= {"angle_out": 11.3, "impulse_ratio": 0.105, "mass": MASS, "energy_final": 90.0}
    summary |= {"steps": 1, "estimated_error": SHARE}
    columns = {"t": (0, 1), "kinetic": (100, 90), "elastic": (0, 0), "contact": (0, 0)}
    columns |= {"vx": (ALONG, AFTER[0]), "vy": (-NORMAL, AFTER[1])}
    for end, weight, before, after in zip(
        ends, (MASS, mass), ((ALONG, -NORMAL), (0, 0)), (AFTER, (0, 0)), strict=False
    ):
        summary |= {f"mass{end}": weight, f"reach{end}": RADIUS, f"rebound_vx{end}": after[0]}
        summary |= {f"rebound_vy{end}": after[1], f"rebound_spin{end}": 5.0}
        columns |= {
            f"vx{end}": (before[0], after[0]),
            f"vy{end}": (before[1], after[1]),
            f"spin{end}": (0, 5),
        }
    (folder / "summary.json").write_text(json.dumps(summary))
    text = SCENE.format(disc=disc, other=other) if several else "radius = 0.05\n"
    (folder / "scene.toml").write_text(text)
    rows = [
        ",".join(columns),
        *(",".join(str(values[k]) for values in columns.values()) for k in (0, 1)),
    ]
    (folder / "history.csv").write_text("\n".join(rows) + "\n")
    (folder / "contacts.csv").write_text(
        "body,partner,end,approach,lever,partner_lever,slip_before\n"
        f"1,{partner},1.0,{NORMAL},{lever},0,{ALONG}\n"
    )
    return Record(folder, summary, False)


def test_an_oblique_restitution_has_the_error_of_the_normal_velocities(tmp_path):
    """The error of the normal rebound is over the normal approach: at 2 of 10 m/s it is five times
    that over the speed. A rebound at the end of its error bar has a restitution at the end of its
    own."""
    stated = errors(record(tmp_path))
    velocity = SHARE["rebound"] * SPEED
    assert stated["rebound_vy"] == pytest.approx(velocity)
    assert stated["restitution"] == pytest.approx(
        (AFTER[1] + velocity) / NORMAL - AFTER[1] / NORMAL
    )
    assert stated["restitution"] == pytest.approx(0.02)
    rim = SHARE["rebound_spin"] * SPEED
    assert stated["restitution_tangential"] == pytest.approx(math.hypot(velocity, rim) / ALONG)
    turned = math.degrees(math.atan2(AFTER[1], AFTER[0]) - math.atan2(*_across(velocity)))
    assert stated["angle_out"] == pytest.approx(abs(turned), rel=1e-3)
    assert stated["impulse_ratio"] == pytest.approx(math.hypot(MASS * velocity / 7.6, 0.105 * 0.01))
    assert "angle_in" not in stated


def _across(velocity: float) -> tuple[float, float]:
    """The velocity (y, x) after contact, changed by `velocity` at a right angle."""
    size = math.hypot(*AFTER)
    return AFTER[1] - velocity * AFTER[0] / size, AFTER[0] + velocity * AFTER[1] / size


def test_a_lever_adds_the_error_of_the_spin(tmp_path):
    """Where the normal force passes the centre at a distance, the spin has a part in the normal
    velocity."""
    velocity, rim = SHARE["rebound"] * SPEED, SHARE["rebound_spin"] * SPEED
    stated = errors(record(tmp_path, lever=RADIUS / 2))
    assert stated["restitution"] == pytest.approx(math.hypot(velocity, rim / 2) / NORMAL)


def test_two_bodies_and_a_body_on_supports(tmp_path):
    """Both bodies have an error. If one is held, it vibrates: its velocity after contact is of one
    instant, and only the ratio of the impulses has an estimate."""
    velocity = SHARE["rebound"] * SPEED
    assert errors(record(tmp_path, other=""))["restitution"] == pytest.approx(
        math.sqrt(2) * velocity / NORMAL
    )
    stated = errors(record(tmp_path, other='support = [{where = "left"}]'))
    assert not {"restitution", "restitution_tangential", "angle_out"} & set(stated)
    assert stated["impulse_ratio"] > 0
    assert {name[-2:] for name in stated if name.startswith(("rebound", "final"))} == {"_1"}
    alone = record(tmp_path, other=None)
    (tmp_path / "scene.toml").write_text('[[body]]\nname = "bar"\nsupport = [{where = "left"}]\n')
    assert not [name for name in errors(alone) if name.startswith(("rebound", "final"))]


def test_an_impact_that_is_not_over_has_errors_of_the_record_alone(tmp_path):
    """Without the estimates of the whole impact, energies keep theirs, and no other number has one,
    nor nan. A summary that lacks the energy is damaged."""
    cut = record(tmp_path)
    cut.summary["estimated_error"] = {"energy": 0.01, "friction_work": 0.01}
    assert errors(cut) == {"energy_final": pytest.approx(1.0)}
    cut.summary["estimated_error"] = {"friction_work": 0.01}
    with pytest.raises(Unreadable, match="'energy'"):
        errors(cut)


def bounced(restitutions: list[float], time: float, ended: str = "rest") -> Answers:
    """A run in which a body bounced 20 times and came to rest."""
    summary = {"ended": ended, "bounces": 20, "rest_time": time, "first_restitutions": restitutions}
    summary |= {"rebound_vy": 1e-4, "rebound_spin": 0.0, "reach": RADIUS, "energy_final": 1e-3}
    return Answers(summary | {"largest_energy": 1.0}, {}, 4.0, {})


def test_the_errors_of_a_run_until_rest(tmp_path):
    """Restitutions have twice their largest difference. What that does to the sum of the flights,
    t (1 + e)/(1 - e), is the least error of the time of rest. What rests has no other velocity than
    its last."""
    fine, coarse = bounced([0.8, 0.82, 0.81], 4.0), bounced([0.8, 0.81, 0.81], 4.01)
    stated, e, apart = rest_errors(fine, coarse), 0.81, 0.02
    assert stated["first_restitutions"] == pytest.approx(apart)
    total = [(1 + k) / (1 - k) for k in (e - apart / 20, e + apart / 20)]
    assert stated["rest_time"] == pytest.approx(10 * (total[1] / total[0] - 1), rel=0.02)
    count = [1 / math.log(1 / k) for k in (e - apart / 20, e + apart / 20)]
    assert stated["bounces"] == pytest.approx(10 * (count[1] / count[0] - 1), rel=0.02)
    assert stated["rebound"] == pytest.approx(1e-4 / 4.0) and stated["energy"] == pytest.approx(
        1e-3
    )
    later = rest_errors(fine, bounced([0.8, 0.82, 0.81], 5.0))
    assert later["rest_time"] == pytest.approx(0.25) and later["first_restitutions"] == 0
    assert rest_errors(fine, bounced([0.8], 4.0, "end_time")) == {}


def test_a_body_that_is_set_down_has_no_error_of_the_restitution(tmp_path):
    """Its approach is 0."""
    result = record(tmp_path)
    head, *rows = (tmp_path / "contacts.csv").read_text().splitlines()
    where = head.split(",").index("approach")
    cells = [row.split(",") for row in rows]
    rows = [",".join([*row[:where], "0", *row[where + 1 :]]) for row in cells]
    (tmp_path / "contacts.csv").write_text("\n".join([head, *rows]) + "\n")
    assert "restitution" not in errors(result) and "impulse_ratio" in errors(result)
