"""Evaluates the contacts of a run from what FreeFEM has recorded in contacts.bin: a row of
contacts.csv for every interval of contact of a contact pair, and the restitution and angles of
the whole run.

The normal n of an interval is the direction of its normal impulse. Where a circle or sphere is in
contact with an obstacle or another one, the normals before and after contact are those of the
first and the last step with a tenth of the peak force; if both turn about their centres, the line
between these. The velocity jump is the impulse over the reduced mass of the pair. Numbers without
a meaning are None:

- separation, slip_after, angle_out and all restitutions if the contact is not over;
- angles, all restitutions and impulse_ratio without one normal: the impulse along n is below 0.99
  of the impulse, as in a concave obstacle;
- restitution, restitution_poisson and restitution_energetic if the interval is no impact: the
  approach is below a quarter of the velocity jump, so most of the impulse is that of weight,
  vibration or other contact pairs, or the pair does not separate;
- restitution_tangential and angles if slip_before or the speed of the centres is below a twentieth
  of the velocity jump, and so has no direction;
- velocities, normals and numbers that follow from them, if a body is in contact with itself. The
  force is then the sum of the sizes of the normal forces, because the resultant is zero.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .columns import CONTACTS, RUN_NUMBERS
from .fields import read_arrays

__all__ = [
    "RECORDED",
    "THRESHOLD",
    "Interval",
    "Motion",
    "along",
    "impulse_ratio",
    "intervals_of",
    "is_impact",
    "of_run",
    "ratio",
    "thresholds",
    "with_self_contact",
    "write_contacts",
]

RECORDED = "contacts.bin"  # written by edp/program/run/contacts.idp
THRESHOLD = 0.01  # of the largest force, for thresholded contact times
MIN_DIRECTION_SHARE, MIN_APPROACH_SHARE, MIN_NORMAL_SHARE = (
    0.05,
    0.25,
    0.99,
)  # shares of the velocity jump, and of the impulse (above)
FIRST = 3  # number of bounces in first_restitutions
# columns without a meaning where a body is in contact with itself
OF_TWO = (
    *("normal_x", "normal_y", "normal_z"),
    *("approach", "separation", "slip_before", "slip_after"),
)


@dataclass(frozen=True)
class Motion:
    """Velocities [m/s] of a body relative to its counter-body before or after an interval: along
    the normal, at the point of first contact (`normal`) and of the centres (`centres_normal`),
    and their size (`centres_speed`); along the surface, at that point (`slip`) and of the
    centres (`centres_slip`), (3,); the normal `n` (3,).
    """

    normal: float
    centres_normal: float
    centres_speed: float
    slip: np.ndarray
    centres_slip: np.ndarray
    n: np.ndarray


class Interval:
    """One interval of contact: `rows` (steps, 41) and `head` (14,) as recorded, the reduced mass
    [kg/m], whether the integrator takes forces at the ends of steps (`means_of_ends`), and whether
    there is friction.
    """

    def __init__(
        self,
        rows: np.ndarray,
        head: np.ndarray,
        pair: Mapping[str, Any],
        reduced: float,
        means_of_ends: bool,
        friction: bool,
    ):
        self.pair, self.rows = pair, rows
        self.own = pair["body"] == pair["counter_body"]  # contact of a body with itself
        self.start, self.end, self.over = head[1], head[2], bool(head[3])
        self.energies, self.viscous_work = head[4:7], head[7]
        self.radii, self.arms, self.levers = head[8:10], head[10:12], head[12:14]
        self.step, self.middle = rows[:, 2], rows[:, 1]
        self.force, self.all, self.friction = self._forces(means_of_ends)
        impulses = self.force * self.step
        self.impulse = float(impulses.sum())
        self.total = self.step @ self.all
        self.tangential = self.step @ self.friction if friction else np.zeros(3)
        self.normal_impulse = impulses @ rows[:, 6:9]
        size = float(np.linalg.norm(self.normal_impulse))
        self.normal = self.normal_impulse / size if size > 0 else self.normal_impulse
        self.jump = self.impulse / reduced
        self.peak = max(0.0, float(self.force.max()))
        # steps with a tenth of the peak: single points have other normals
        firm = np.flatnonzero(self.force >= 0.1 * self.peak)
        self.before = self._motion(0, 0, firm[0])
        self.after = self._motion(len(rows) - 1, 1, firm[-1])
        self.straight = size > 0 and size >= MIN_NORMAL_SHARE * self.impulse
        self.impact = is_impact(self.over and self.straight, self.before, self.after, self.jump)
        self.phase_impulse, self.phase_work = self._phases(impulses)

    def _forces(self, means_of_ends: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Means over each step: size of the normal resultant (steps,), all forces and friction
        (steps, 3)."""
        force, total = self.rows[:, 3].copy(), self.rows[:, 9:12].copy()
        friction = total - force[:, None] * self.rows[:, 6:9]
        if means_of_ends:
            for values in (force, total, friction):
                values[1:] += values[:-1].copy()
                values *= 0.5
        return force, total, friction

    def _motion(self, row: int, after: int, firm: int) -> Motion:
        """The motion before the first step (`after` 0) or after the last (1). Of circles and
        spheres the normal is that of step `firm`. Of two about their centres of mass, or of one and
        a round obstacle, it is the line between their centres.
        """
        rows = self.rows
        centres, velocity, rim, line = (
            rows[row, k + 3 * after : k + 3 * after + 3] for k in (12, 18, 24, 30)
        )
        n = self.normal
        body, other = self.pair["body"], self.pair["counter_body"]
        if self.radii[0] != 0 and (other < 0 or self.radii[1] != 0):
            n = rows[firm, 6:9]
            if line.any() and other != body and self.arms.sum() == 0:
                n = line / (np.copysign(1.0, n @ line) * np.linalg.norm(line))
        return Motion(
            float(n @ velocity),
            float(n @ centres),
            float(np.linalg.norm(centres)),
            velocity - (n @ velocity) * n + np.cross(rim, n),
            centres - (n @ centres) * n,
            n,
        )

    def _phases(self, impulses: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Normal impulse (2,), and work of the normal force on the body, lost and gained (2,),
        while the pair approaches (0) and while it separates (1). A step in which the normal
        velocity changes its sign belongs to both.
        """
        n = self.rows[:, 6:9]
        before, after = (np.einsum("ij,ij->i", self.rows[:, k : k + 3], n) for k in (18, 21))
        turns = before * after < 0
        share = np.where(turns, before / np.where(turns, before - after, 1.0), 1.0)
        approaches = before < 0
        impulse, work = np.zeros(2), np.zeros(2)
        first = (
            np.where(approaches, -1, 1)
            * impulses
            * np.where(turns, share * before, before + after)
            / 2
        )
        second = np.where(
            turns, np.where(approaches, 1, -1) * impulses * (1 - share) * after / 2, 0.0
        )
        for phase, mine in ((0, approaches), (1, ~approaches)):
            impulse[phase] += (share * impulses)[mine].sum() + ((1 - share) * impulses)[~mine].sum()
            work[phase] += first[mine].sum() + second[~mine].sum()
        return impulse, work

    def row(self) -> dict[str, float | None]:
        """The columns of contacts.csv."""
        least, before, after = MIN_DIRECTION_SHARE * self.jump, self.before, self.after
        slip_after = along(before.slip, after.slip, before.n, after.n, 1e-9 * self.jump)
        slipped = along(
            before.centres_slip, after.centres_slip, before.n, after.n, 1e-9 * self.jump
        )
        slip = float(np.linalg.norm(before.slip))
        first, last = thresholds(
            self.middle, self.step, self.force, self.start, self.end, self.over
        )
        work, creep = float(self.rows[:, 4].sum()), float(self.rows[:, 5].sum())
        energetic = ratio(self.phase_work[1], self.phase_work[0], self.impact)
        other = self.pair["counter_body"]
        values = [
            1 + self.pair["body"],
            other if other < 0 else other + 1,
            self.start,
            self.end,
            int(self.over),
            self.end - self.start,
            last - first,
            self.impulse,
            *self.total,
            self.peak,
            self.middle[self.force.argmax()] if self.peak > 0 else 0.0,
            *self.normal,
            -before.normal,
            after.normal if self.over else None,
            *self.levers,
            slip,
            slip_after if self.over else None,
            ratio(after.normal, -before.normal, self.impact),
            ratio(self.phase_impulse[1], self.phase_impulse[0], self.impact),
            math.sqrt(energetic) if energetic is not None and energetic >= 0 else None,
            ratio(-slip_after, slip, self.over and self.straight and slip > least),
            impulse_ratio(self.normal_impulse, self.tangential) if self.straight else None,
            _steepness(-before.centres_normal, float(np.linalg.norm(before.centres_slip)))
            if self.straight and before.centres_speed > least
            else None,
            _steepness(after.centres_normal, slipped)
            if self.over and self.straight and after.centres_speed > least
            else None,
            work,
            creep,
            work - creep,
            *self.energies,
            self.viscous_work,
        ]
        row = dict(zip((column.name for column in CONTACTS), values, strict=True))
        return row | (dict.fromkeys(OF_TWO) if self.own else {})


def intervals_of(folder: Path, diagnostics: Mapping[str, Any]) -> list[Interval]:
    """The intervals of the run in `folder` in the order in which they ended; those that bore no
    load are left out."""
    arrays, _ = read_arrays(folder / RECORDED)
    rows, heads = arrays["rows"].reshape(-1, 41), arrays["intervals"].reshape(-1, 14)
    bodies, result = diagnostics["bodies"], []
    for k in np.argsort(heads[:, 2], kind="stable"):
        own = rows[rows[:, 0] == k]
        if not len(own):
            continue
        pair = diagnostics["pairs"][int(heads[k, 0])]
        mass = bodies[pair["body"]]["mass"]
        if pair["counter_body"] >= 0:
            mass *= bodies[pair["counter_body"]]["mass"] / (
                mass + bodies[pair["counter_body"]]["mass"]
            )
        result.append(
            Interval(
                own,
                heads[k],
                pair,
                mass,
                bool(diagnostics["means_of_ends"]),
                bool(diagnostics["friction"]),
            )
        )
    return result


def write_contacts(path: Path, intervals: list[Interval], damped: bool) -> None:
    """Writes contacts.csv; a number without a meaning is an empty cell."""
    names = [column.name for column in CONTACTS if damped or column.needs != "damped"]
    lines = [",".join(names)]
    for interval in intervals:
        row = interval.row()
        lines.append(",".join("" if row[name] is None else f"{row[name]:.12g}" for name in names))
    path.write_text("\n".join(lines) + "\n")


def with_self_contact(record: dict[str, Any], intervals: list[Interval]) -> dict[str, Any]:
    """The record of a run. If bodies are in contact with themselves only, its contacts are those of
    self-contact. Otherwise it is unchanged, and self-contact does not count.
    """
    own = sorted((i.start, i.end, i.over) for i in intervals if i.own)
    if record["diagnostics"]["contact_intervals"] or not own:
        return record
    joined = 1
    until = own[0][1]
    for start, end, _ in own[1:]:
        joined += int(start > until)
        until = max(until, end)
    facts = {
        "contact_start": own[0][0],
        "contact_end": until,
        "contact_intervals": joined,
        "in_contact": int(not all(over for *_, over in own)),
    }
    return record | {"diagnostics": record["diagnostics"] | facts}


def of_run(intervals: list[Interval]) -> dict[str, Any]:
    """The numbers RUN_NUMBERS (columns.py) of summary.json but thresholded_contact_time and rest_time. Contacts
    of bodies with themselves do not count.
    """
    intervals = [interval for interval in intervals if not interval.own]
    pairs = {id(interval.pair) for interval in intervals}
    jump, size = (
        sum(interval.jump for interval in intervals),
        sum(interval.impulse for interval in intervals),
    )
    normal, friction = (
        sum((getattr(interval, name) for interval in intervals), np.zeros(3))
        for name in ("normal_impulse", "tangential")
    )
    impacts, last = 0, None
    for current in intervals:
        if last is None or (
            last.after.normal > 0 and -current.before.normal > MIN_APPROACH_SHARE * current.jump
        ):
            impacts += 1
        last = current
    along_one = (
        len(pairs) == 1
        and 0 < np.linalg.norm(normal)
        and bool(np.linalg.norm(normal) >= MIN_NORMAL_SHARE * size)
    )
    numbers: dict[str, Any] = dict.fromkeys(
        column.name
        for column in RUN_NUMBERS
        if column.name not in ("thresholded_contact_time", "rest_time")
    )
    bounces = [interval for interval in intervals if interval.impact]
    numbers["bounces"] = len(bounces)
    numbers["first_restitutions"] = [
        bounce.after.normal / -bounce.before.normal for bounce in bounces[:FIRST]
    ]
    if last is None or not along_one:
        return numbers
    before, after, least = intervals[0].before, last.after, MIN_DIRECTION_SHARE * jump
    single = impacts == 1 and last.over
    slip = float(np.linalg.norm(before.slip))
    slip_after = along(before.slip, after.slip, before.n, after.n, 0.0)
    numbers["restitution"] = ratio(
        after.normal, -before.normal, is_impact(single, before, after, jump)
    )
    numbers["restitution_tangential"] = ratio(-slip_after, slip, single and slip > least)
    numbers["impulse_ratio"] = impulse_ratio(normal, friction)
    if before.centres_speed > least:
        numbers["angle_in"] = _steepness(
            -before.centres_normal, float(np.linalg.norm(before.centres_slip))
        )
    if single and after.centres_speed > least:
        numbers["angle_out"] = _steepness(
            after.centres_normal,
            along(before.centres_slip, after.centres_slip, before.n, after.n, 1e-9 * jump),
        )
    return numbers


# ---- formulas


def thresholds(
    middle: np.ndarray,
    step: np.ndarray,
    force: np.ndarray,
    start: float,
    end: float,
    over: bool,
    threshold: float = THRESHOLD,
) -> tuple[float, float]:
    """The first and the last instant [s] at which the force passes `threshold` times its maximum,
    or the end if it is above and the contact is not over. `middle` and `step` (n,) [s] are the
    steps from the first to the last with load, `force` (n,) their mean forces. The force is
    linear between the middles, and zero at start and end; in the steps of these it acts in a
    share of the step only.
    """
    t, f = np.array([start, *middle, end]), np.array([0.0, *force, 0.0])
    level = threshold * force.max()
    after, before = t[1] + step[0] / 2, t[-2] - step[-1] / 2
    if t[1] - step[0] / 2 < start < after:
        f[1] *= step[0] / (after - start)
        t[1] = (start + after) / 2
    if over and before < end < t[-2] + step[-1] / 2:
        f[-2] *= step[-1] / (end - before)
        t[-2] = (before + end) / 2
    above = np.flatnonzero(f[1:-1] >= level) + 1
    a, b = above[0], above[-1]
    first = max(start, t[a] - (t[a] - t[a - 1]) * (f[a] - level) / (f[a] - f[a - 1]))
    last = end
    if b < len(middle) or over:
        last = min(end, t[b] + (t[b + 1] - t[b]) * (f[b] - level) / (f[b] - f[b + 1]))
    return float(first), float(last)


def is_impact(over: bool, before: Motion, after: Motion, jump: float) -> bool:
    """Whether an interval that is over is an impact: driven by its approach, and ended by a
    separation."""
    return bool(over and -before.normal > MIN_APPROACH_SHARE * jump and after.normal >= 0)


def along(
    first: np.ndarray, second: np.ndarray, n: np.ndarray, n_after: np.ndarray, least: float
) -> float:
    """A velocity `second` along the surface in the direction of `first`, turned as the normal turns
    from `n` to `n_after` (Rodrigues); its size if `first` is smaller than `least` and so has no
    direction.
    """
    size = float(np.linalg.norm(first))
    if size < least or size == 0:
        return float(np.linalg.norm(second))
    about = np.cross(n, n_after)
    once = np.cross(about, first)
    turned = first + once + np.cross(about, once) / (1 + n @ n_after)
    return float(turned @ second) / size


def impulse_ratio(normal: np.ndarray, friction: np.ndarray) -> float | None:
    """The impulse along the counter-body over that across it; of the friction impulse (3,) its
    share along `normal` (3,) counts as normal."""
    size = float(np.linalg.norm(normal))
    inward = float(friction @ normal) / max(size, 1e-300)
    tangential = friction - inward / max(size, 1e-300) * normal
    return ratio(float(np.linalg.norm(tangential)), size + inward, size > 0)


def ratio(above: float, below: float, defined: bool) -> float | None:
    """above / below if it is defined and `below` is positive, else None."""
    return float(above / below) if defined and below > 0 else None


def _steepness(normal: float, along_surface: float) -> float:
    """The angle of a velocity to the surface [deg]."""
    return math.degrees(math.atan2(normal, along_surface))
