"""Decides the warnings and notes of a run from its record (`diagnostics` of record.json), its
history and its intervals of contact.

A sentence is `name: fact: meaning: take ...`. A warning reports that a result may be wrong. A
note is a remark about a number that holds in every such scene, as about the peak force of a hard
impact. The sentences of error estimates are made in estimate.py.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from ..input.damping import Damping
from ..input.parameters import Table
from . import points
from .contacts import THRESHOLD, Interval, thresholds
from .numbers import numbers_of

__all__ = [
    "Evidence",
    "Sentence",
    "note",
    "peak_uncertainty",
    "percent",
    "rounded",
    "sentences",
    "warn",
]

# With 10 points and more of the whole body the largest pressure of Hertz' contact is within 2 %,
# its half-width within 3 %, and of
# impacts the peak force within 0.6 % and the thresholded contact time within 0.5 % of those on far
# finer meshes; with 8 and fewer these
# errors are up to 3, 19, 1.5 and 1.1 %. An edge has three points. In space with 90 points and more
# peak force and contact
# time are within 1 and 0.3 %, with 36 and fewer within 6 %; a face has six.
FEWEST_POINTS = {2: 9, 3: 60}
FEWEST_STEPS = 15  # in contact
SOFTEST = 0.02  # penetration over the compression of the bodies, by their energies
# Penetrations above these limits by less than this factor change nothing that a reader could see.
TRIFLE = 1.25
DEEPEST, UNSEEN = 0.05, 0.01  # penetration over the radius or half thickness
CREEP = 0.05  # velocity of sticking points over that of the centre
JUMPS = 0.01  # share of points and steps in a jump of the friction law
LOOSEST = 0.1  # slip velocity over the speeds of the scene
LOCKING_LINEAR, LOCKING_QUADRATIC = 0.4, 0.495  # Poisson's ratio from which on elements lock
SPREAD = 0.1  # det F at a point relative to its mean over the element
DIFFERENT_MASS = 0.01  # relative to the mesh of a file
# Speed over the bar wave speed. A penalty ten times larger on a mesh twice as fine moves the peak
# force by 1 % at most up to 0.01, by 7 to
# 18 % at 0.1, in twelve materials: by POINTWISE at most. Impulse and restitution hardly change: the
# peak is that of single contact points.
HARD, POINTWISE = 0.03, 0.2
PEAK_WIDTH, PEAK_SHARE = (
    0.5,
    0.8,
)  # a time over the transit time of a wave; a mean force over the peak
IN_ZONE = 3  # elements in the cohesive zone of adhesion
BOUNCES = 5  # smallest number of short flights of a rigid body that are a warning
BENT = 0.1  # deviation of a function of time from a straight line in a step
CORNER = 0.05  # share of the impulse that begins at a sharp corner
# A pair of density and modulus that no material has: waves faster than in diamond (18 km/s);
# lighter than all but
# aerogels and metallic microlattices, and stiffer than these.
FASTEST_WAVE, LIGHTEST, STIFFEST_LIGHT = 2e4, 10.0, 1e5  # m/s, kg/m3, Pa

Sentence = tuple[str, str]  # "warning" or "note", and its text


@dataclass(frozen=True)
class Evidence:
    """What warnings are decided from: the record of a run, the columns of history.csv, the
    intervals of contact."""

    record: Mapping[str, Any]
    history: Mapping[str, np.ndarray]
    intervals: Sequence[Interval]

    @property
    def facts(self) -> Table:
        """The diagnostics of the record."""
        return dict(self.record["diagnostics"])

    @property
    def bodies(self) -> list[Table]:
        """The bodies of the record."""
        return list(self.facts["bodies"])

    @cached_property
    def pairs(self) -> list[Table]:
        """The contact pairs of the record, with what their points bore (points.of_pairs)."""
        return points.of_pairs(self.facts["pairs"], self.intervals)

    @property
    def corner_share(self) -> float | None:
        """The share of contacts that began at a sharp corner in the impulse (points.corner_share)."""
        return points.corner_share(self.facts["pairs"], self.intervals, self.facts["transit"])

    @cached_property
    def forces(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Middle and length [s] of the steps with iterations, and their mean normal forces [N/m],
        (n,) each."""
        normal = self.history["normal_force"].copy()
        if self.facts["means_of_ends"]:
            normal[1:] = (normal[1:] + normal[:-1]) / 2
        solved = self.history["newton_iterations"] > 0
        step = self.history["dt"][solved]
        return self.history["t"][solved] - step / 2, step, normal[solved]

    @cached_property
    def numbers(self) -> Table:
        """The numbers of the run (numbers.numbers_of)."""
        return numbers_of(self.facts, self.history, self.forces)

    @property
    def pull(self) -> float:
        """The size of the acceleration by gravity and body forces [m/s2]."""
        return float(np.linalg.norm(self.facts["acceleration"]))

    @property
    def largest_force(self) -> float:
        """The largest mean normal force of a step [N/m]."""
        return float(max(self.forces[2], default=0.0))

    @property
    def loaded_steps(self) -> int:
        """The number of steps in contact."""
        return int((self.forces[2] > 0).sum())

    @property
    def penalty_share(self) -> float:
        """The energy of the penalty over the elastic energy, when the latter is largest in contact;
        0 without contact or elastic energy."""
        penalty, elastic = self.history["contact"], self.history["elastic"]
        largest = np.where(penalty > 0, elastic, 0.0).argmax()
        if penalty[largest] == 0 or elastic[largest] == 0:
            return 0.0
        return float(penalty[largest] / elastic[largest])

    def thresholds(self, threshold: float = THRESHOLD) -> tuple[float, float] | None:
        """The instants [s] at which the normal force of the run crosses `threshold` times its
        maximum; None without contact."""
        middle, step, force = self.forces
        loaded = np.flatnonzero(force > 0)
        if not len(loaded) or self.numbers["contact_start"] is None:
            return None
        part = slice(loaded[0], loaded[-1] + 1)
        open_ended = bool(self.facts["in_contact"])
        end = self.facts["time"] if open_ended else self.facts["contact_end"]
        return thresholds(
            middle[part],
            step[part],
            force[part],
            self.numbers["contact_start"],
            end,
            not open_ended,
            threshold,
        )

    @property
    def later_contact_possible(self) -> bool:
        """Whether the run ended before a contact that may belong to the impact, or one that vibration
        alone may cause within twice the duration of the impact."""
        again, until = self.facts["contact_again_at"], self.facts["impact_until"]
        near = (
            self.facts["vibrates_again"] and again - until <= until - self.numbers["contact_start"]
        )
        return bool(again >= 0 and (again <= until or near))

    @property
    def is_pushed_in(self) -> bool:
        """Whether a support pushes its part into an obstacle."""
        return bool(self.facts["held"][1] >= 0)

    @property
    def slowest_wave(self) -> float:
        """The smallest bar wave speed sqrt(E/rho) of the bodies [m/s]."""
        return min(_wave(body) for body in self.bodies)

    @property
    def request(self) -> str:
        """The requested accuracy as a clause."""
        return f": the requested accuracy is {percent(self.facts['accuracy'])}"

    @property
    def conserving(self) -> str:
        """What keeps energy and momenta better."""
        return "a smaller dt, or " + (
            "a finer mesh"
            if self.facts["integrator"] == "energy-momentum"
            else "integrator=energy-momentum"
        )

    @property
    def body(self) -> str:
        """The body, or one of several."""
        return "a body" if len(self.bodies) > 1 else "the body"

    @property
    def counter_body(self) -> str:
        """What the bodies come into contact with."""
        if len(self.bodies) > 1:
            return "the others"
        return self.obstacle(0) if len(self.facts["obstacles"]) == 1 else "the obstacles"

    def near(self, extreme: Sequence[float]) -> str:
        """The place of an extreme (value, time, X, Y, Z)."""
        coordinates = ", ".join(f"{x:g}" for x in extreme[2 : 2 + self.facts["dimension"]])
        return f" near X = ({coordinates}) m"

    def obstacle(self, number: int) -> str:
        """The name of an obstacle."""
        return str(self.facts["obstacles"][number]["name"])

    def pair(self, pair: Mapping[str, Any]) -> str:
        """The names of a contact pair."""
        body, other = pair["body"], pair["counter_body"]
        if other == body:
            return f"{self.bodies[body]['name']} and itself"
        second = self.bodies[other]["name"] if other >= 0 else self.obstacle(-1 - other)
        return f"{self.bodies[body]['name']} and {second}"

    def radius(self, pair: Mapping[str, Any]) -> float:
        """Half the smaller thickness of a pair, or the radius of the obstacle if it is smaller
        [m]."""
        sizes = [
            float(self.bodies[k]["thickness"]) / 2
            for k in (pair["body"], pair["counter_body"])
            if k >= 0
        ]
        corner = float(pair["corner_radius"])
        return min([*sizes, corner] if corner > 0 else sizes)

    def finer(self, sizes: str, pair: Mapping[str, Any] | None = None) -> str:
        """The advice to refine the bodies of a pair, or all: by `sizes` of the scene, or by the
        mesh of a file."""
        numbers = (
            range(len(self.bodies))
            if pair is None
            else [k for k in (pair["body"], pair["counter_body"]) if k >= 0]
        )
        of_file = [bool(self.bodies[k]["of_file"]) for k in numbers]
        if not any(of_file):
            return sizes
        return "a finer mesh in the file" + ("" if all(of_file) else f" and {sizes}")


def sentences(evidence: Evidence) -> dict[str, list[str]]:
    """The `warnings` and `notes` of summary.json."""
    messages: dict[str, list[str]] = {"warnings": [], "notes": []}
    for rule in RULES:
        for kind, text in rule(evidence):
            messages["warnings" if kind == "warning" else "notes"].append(text)
    return messages


def warn(text: str) -> Sentence:
    """A sentence that is a warning."""
    return "warning", text


def note(text: str) -> Sentence:
    """A sentence that is a note."""
    return "note", text


def rounded(value: float) -> str:
    """A number with two digits."""
    if value == 0:
        return "0"
    unit = 10.0 ** (math.floor(math.log10(abs(value))) - 1)
    return f"{round(value / unit) * unit:g}"


def percent(share: float) -> str:
    """A share in per cent, with two digits."""
    return f"{rounded(100 * share)} %"


def _others(count: int) -> str:
    if count < 2:
        return ""
    return f" (and those of {count - 1} other contact pair{'s' if count > 2 else ''})"


def _wave(body: Mapping[str, Any]) -> float:
    return math.sqrt(body["young"] / body["density"])


# ---- the scene


def _units(e: Evidence) -> Iterator[Sentence]:
    """A density in g/cm3 is a thousandth of that in kg/m3."""
    for body in e.bodies:
        light = body["density"] < LIGHTEST and body["young"] > STIFFEST_LIGHT
        if not body["rigid"] and (_wave(body) > FASTEST_WAVE or light):
            yield warn(
                f"density: {body['density']:g} kg/m3 beside young = {body['young']:g} Pa, is it in "
                "g/cm3?: no known material is as light and as "
                f"stiff, its wave speed sqrt(E/rho) would be {rounded(_wave(body))} m/s: take "
                "kg/m3 for the density and Pa for young"
            )


def _law(e: Evidence) -> Iterator[Sentence]:
    lost, broken = e.facts["ellipticity_lost"], e.facts["breakdown"]
    if lost[1] >= 0:
        yield warn(
            f"ellipticity: lost from t = {lost[1]:g} s on, the solution then depends on the mesh: "
            f"first{e.near(lost)}, smallest eigenvalue of the "
            f"acoustic tensor {rounded(e.numbers['min_ellipticity'])} mu: take a lower speed, or "
            "law=neohookean"
        )
    if broken[1] >= 0:
        yield warn(
            f"breakdown: det F <= 0 from t = {broken[1]:g} s on, elements are inverted: "
            f"first{e.near(broken)}. The results after that time have no "
            "physical meaning: take a lower speed, or law=neohookean"
        )


def _volume(e: Evidence) -> Iterator[Sentence]:
    """The advice: volume=plain, whose elements do not lock below LOCKING_QUADRATIC. A finer mesh does
    not help, because the difference at the edge of a contact grows with it.
    """
    spread, nu = e.facts["volume_spread"], max(body["nu"] for body in e.bodies)
    if spread[0] > SPREAD:
        instead = (
            "volume=plain"
            if nu < LOCKING_QUADRATIC
            else "a lower speed or load, or nu=0.49 with volume=plain"
        )
        yield warn(
            f"volume: at t = {spread[1]:g} s det F at a point differs by {percent(spread[0])} from "
            f"its mean over the element (up to {percent(SPREAD)} "
            f"is small){e.near(spread)}: only the mean volume of an element is constrained. "
            "Strains and stresses there have an error of this size, while impulse and rebound "
            f"hardly change: take {instead}"
        )


def _shape(e: Evidence) -> Iterator[Sentence]:
    """Curved edges and faces enclose more than the straight ones of a file."""
    curved = "faces on spheres and cylinders" if e.facts["dimension"] == 3 else "edges on circles"
    for body in e.bodies:
        more = body["mass"] / body["straight_mass"] - 1
        if body["of_file"] and abs(more) > DIFFERENT_MASS:
            yield warn(
                f"mass: {body['name']} has {percent(abs(more))} {'more' if more > 0 else 'less'} "
                "than the mesh in its file: up to "
                f"{percent(DIFFERENT_MASS)} is small. The program rounds {curved} of a file: take "
                "a finer mesh. Flat facets that are meant to stay "
                "flat need angles of more than 30 degrees between them"
            )


def _overlap(e: Evidence) -> Iterator[Sentence]:
    first = e.facts["overlap"]
    body, other = map(int, first[5:])  # -1: the mirror image
    if first[1] < 0:
        return
    another = other >= 0 and other != body
    instead = "set self_contact of the body, " if other == body else ""
    if another or (other >= 0 and e.bodies[body]["self_contact"]):
        instead = "take a file in which this part is contact boundary, "
    who = (
        f"{e.bodies[body]['name']} and {e.bodies[other]['name']} pass through each other"
        if another
        else f"{e.body} passes through itself"
    )
    yield warn(
        f"overlap: {who} from t = {first[1]:g} s on: first{e.near(first)}. No contact force acts "
        "there, and the results after that time have no "
        f"physical meaning: {instead}end the run before that time, or take a lower speed or a "
        "stiffer body"
    )


# ---- conservation and the friction law


def _balances(e: Evidence) -> Iterator[Sentence]:
    accuracy, integrator, instead = (
        e.facts["accuracy"],
        e.facts["integrator"],
        f": take {e.conserving}",
    )
    drift, momentum, angular = (
        e.numbers[name] for name in ("energy_drift", "momentum_drift", "angular_momentum_drift")
    )
    if drift > accuracy:
        yield warn(
            f"energy: the {integrator} integrator "
            f"{'lost' if e.facts['worst_balance'] < 0 else 'gained'} {percent(drift)} of the "
            f"energy supplied{e.request}. Speeds and forces have an error of this size{instead}"
        )
    if momentum > accuracy:
        yield warn(
            f"momentum: the {integrator} integrator is off by {percent(momentum)} of the fastest "
            f"motion{e.request}. The impulse differs from the time "
            f"integral of the forces{instead}"
        )
    if (angular or 0) > accuracy:
        yield warn(
            f"angular momentum: the {integrator} integrator is off by {percent(angular)} of the "
            f"fastest motion{e.request}, at the rim. Spins have an "
            f"error of this size{instead}"
        )


def _chatter(e: Evidence) -> Iterator[Sentence]:
    if e.facts["chatter"]:
        yield warn(e.facts["chatter"])


# ---- contact


def _contact(e: Evidence) -> Iterator[Sentence]:
    facts, numbers = e.facts, e.numbers
    if not numbers["contact_intervals"]:
        touches = len(e.bodies) > 1 or facts["obstacles"]
        if touches and not facts["supports_move"] and not facts["loads"]:
            none = " and ".join(
                ["the bodies"] if len(e.bodies) > 1 else ["the body", e.counter_body]
            )
            yield warn(f"no contact: {none} have not come into contact by the end_time")
        return
    used = facts["penalty_used"]
    limit, requested = facts["penalty_limit"], facts["stiffest_penalty"]
    if facts["explicit"] and limit < requested * (1 - 1e-9):
        yield warn(
            f"explicit penalty: {rounded(limit)} Pa/m are used in place of the requested "
            f"{rounded(requested)} Pa/m: with a stiffer penalty single nodes "
            "bounce faster than the waves in the bodies: take "
            f"{e.finer('a smaller contact_mesh_size')}, or integrator=energy-momentum"
        )
    # The share of the penetration is (m + 1)/2 times that of the energy. The estimate includes a
    # wave front that elements resolve.
    front, rise = numbers["front_transit"] or 0, numbers["front_rise"] or 0
    depth = e.penalty_share * (facts["exponent_used"] + 1) / 2
    if (
        (rise == 0 or rise > front)
        and not e.is_pushed_in
        and not all(body["rigid"] for body in e.bodies)
        and depth > TRIFLE * SOFTEST
    ):
        yield warn(
            f"penalty: it stores {percent(e.penalty_share)} of the elastic energy at its "
            f"largest: up to {percent(2 * SOFTEST / (facts['exponent_used'] + 1))} is small. The "
            "contact is softer than that of a rigid plane: take a penalty of at least "
            f"{rounded(used * depth / SOFTEST)}"
        )
    if e.largest_force > 0:
        yield from _peak(e)
    if e.loaded_steps < FEWEST_STEPS and (e.loaded_steps or not e.is_pushed_in):
        yield warn(
            f"steps: {e.loaded_steps} steps in contact: at least {FEWEST_STEPS} are needed: "
            "take a smaller dt, or a smaller accuracy"
        )
    if not facts["in_contact"]:
        yield from _end_of_contact(e)


def peak_uncertainty(e: Evidence) -> float | None:
    """The share of the largest force that penalty and mesh may change; None if its error estimate
    includes that change.
    """
    if not e.numbers["contact_intervals"] or not e.largest_force > 0:
        return None
    lasting, peak = _lasting(e)
    if _oscillates(e):
        return max(POINTWISE, 1 - lasting / peak)
    return POINTWISE if _is_hard(e) else None


def _peak(e: Evidence) -> Iterator[Sentence]:
    """The mean force over half a transit time of a wave, beside the peak, and the speed of the
    impact."""
    if _oscillates(e):
        yield warn(
            f"peak force: its mean over {rounded(PEAK_WIDTH)} of the transit time of a wave is at "
            f"most {rounded(_lasting(e)[0])} N{e.facts['per_metre']}: the "
            "force oscillates on the penalty, as in the impact of a flat face. Penalty and mesh "
            "change the peak by as much as it is above this mean: use "
            "the impulse, or this mean"
        )
    elif _is_hard(e):
        yield note(
            "peak force: single contact points dominate it, at "
            f"{percent(_fastest(e) / e.slowest_wave)} of the wave speed: above {percent(HARD)} of "
            f"sqrt(E/rho) penalty and mesh change it by up to {percent(POINTWISE)}, which its "
            "error estimate contains: use the impulse instead"
        )


def _lasting(e: Evidence) -> tuple[float, float]:
    """The largest mean force over half a transit time of a wave that begins or ends at the peak,
    and the peak [N/m]."""
    _, step, force = e.forces
    width = PEAK_WIDTH * e.facts["transit"]
    peak = int(force.argmax())
    lasting = max(
        _mean_over(step[peak:], force[peak:], width),
        _mean_over(step[peak::-1], force[peak::-1], width),
    )
    return lasting, float(force[peak])


def _oscillates(e: Evidence) -> bool:
    """Whether the peak is a short one of a force that oscillates on the penalty."""
    lasting, peak = _lasting(e)
    return bool(
        (e.numbers["front_transit"] or not _is_hard(e))
        and lasting < PEAK_SHARE * peak
        and not e.facts["in_contact"]
    )


def _fastest(e: Evidence) -> float:
    """The largest approach velocity of an impact [m/s]."""
    speeds = [-interval.before.normal for interval in e.intervals]
    return max([float(e.facts["impact_speed"]), *speeds])


def _is_hard(e: Evidence) -> bool:
    return _fastest(e) > HARD * e.slowest_wave


def _mean_over(step: np.ndarray, force: np.ndarray, width: float) -> float:
    """The mean of a force over the first `width` [s] of its steps; the force is zero beyond
    them."""
    share = np.clip(width - (np.cumsum(step) - step), 0, step)
    return float(share @ force) / width


def _end_of_contact(e: Evidence) -> Iterator[Sentence]:
    accuracy, lasting = e.facts["accuracy"], e.numbers["contact_time"]
    crossings = e.thresholds()
    if crossings is None:
        crossings = (-1.0, -1.0)
    # A half sine spends 0.3 % of its time below 1 % of its peak at either end, Hertz' force on a
    # cylinder 0.7 %.
    grazes = e.facts["contact_end"] - crossings[1]
    falls = e.pull * grazes
    if grazes > max(0.01, accuracy) * lasting:
        yield note(
            f"contact time: the force is below {percent(THRESHOLD)} of its peak for the last "
            f"{percent(grazes / lasting)} of it: the end of contact is "
            "uncertain by as much: use thresholded_contact_time"
        )
    early, late = (e.thresholds(threshold) for threshold in (2 * THRESHOLD, THRESHOLD / 2))
    if early and late:
        middle, _, force = e.forces
        between = (middle[1:] > early[1]) & (middle[1:] < late[1])
        if (between & (np.diff(force) > 0)).any() and late[1] - early[1] > accuracy * lasting:
            yield note(
                "thresholded contact time: uncertain by "
                f"{percent((late[1] - early[1]) / lasting)}, the force oscillates about "
                f"{percent(THRESHOLD)} of its "
                "peak: the end of contact moves by this much between thresholds of "
                f"{percent(2 * THRESHOLD)} and {percent(THRESHOLD / 2)} of the "
                f"peak{e.request}"
            )
    fastest = e.facts["fastest_motion"]
    if falls > accuracy * fastest:
        yield warn(
            f"rebound: gravity changes the speed by {percent(falls / fastest)} while the force is "
            f"below {percent(THRESHOLD)} of its "
            f"peak{e.request}: the rebound velocity is uncertain by as much"
        )


def _obstacles(e: Evidence) -> Iterator[Sentence]:
    for number, obstacle in enumerate(e.facts["obstacles"]):
        if obstacle["crossed"] > 0:
            yield warn(
                f"through: contact points passed through {e.obstacle(number)} "
                f"({obstacle['crossed']} times): the obstacle is too thin for the "
                "penetration, and the results are not those of a rigid obstacle: take a larger "
                "penalty, or a thicker obstacle"
            )
    sunk = e.facts["sunk"]
    if sunk[1] >= 0:
        body, into = map(int, sunk[5:])
        yield warn(
            f"sinks: {e.bodies[body]['name']} is up to {rounded(sunk[0])} m inside "
            f"{e.obstacle(into)}{e.near(sunk)}, at t = {sunk[1]:g} s, at a part of "
            "its boundary that is no contact boundary: no contact force acts there, and the "
            "results are not those of a body on a rigid obstacle: take "
            "a file with a contact boundary there"
        )


def _pairs(e: Evidence) -> Iterator[Sentence]:
    """The worst contact pair of each kind by name: penetration, contact points, and what passes
    between these."""
    pairs = e.pairs
    deep = [pair for pair in pairs if pair["deepest"] > TRIFLE * DEEPEST * e.radius(pair)]
    if deep and not e.is_pushed_in:
        worst = max(pairs, key=lambda pair: pair["deepest"] / e.radius(pair))
        share = worst["deepest"] / e.radius(worst)
        penalty = e.facts["penalty_used"] * (share / DEEPEST) ** e.facts["exponent_used"]
        yield warn(
            f"penetration: {percent(share)} of the radius or half thickness: "
            f"{e.pair(worst)}{_others(len(deep))} overlap by that much. Up to "
            f"{percent(DEEPEST)} is small: take a penalty of at least {rounded(penalty)}"
        )
    yield from _points(e)
    unseen = [
        pair
        for pair in pairs
        if pair["blunt"] <= 1
        and pair["deepest"] > max(UNSEEN * e.radius(pair), 2 * pair["at_points"])
    ]
    if unseen:
        worst = max(unseen, key=lambda pair: pair["deepest"])
        yield warn(
            f"unseen contact: {e.pair(worst)}{_others(len(unseen))} overlap by "
            f"{rounded(worst['deepest'])} m at a corner or an edge: the corner lies "
            f"between the contact points, whose penetration is {rounded(worst['at_points'])} m: take "
            f"{e.finer('a smaller contact_mesh_size', worst)}"
        )
    tight = [pair for pair in pairs if pair["blunt"] > 1]
    if not tight:
        return
    worst = max(tight, key=lambda pair: pair["blunt"])
    who, size = e.pair(worst) + _others(len(tight)), rounded(worst["length"])
    if worst["corner_radius"] > 0:
        yield warn(
            f"small obstacle: {who} are in contact where its radius is {worst['corner_radius']:g} "
            f"m: elements of {size} m do not resolve this radius; "
            "elements up to the radius do. The obstacle passes between the contact points: take "
            f"{e.finer('a smaller contact_mesh_size', worst)}"
        )
    else:
        yield warn(
            f"sharp corner: {who} are in contact at a corner without a fillet: no mesh resolves "
            "it, and the corner passes between the contact "
            f"points: take a fillet of at least {size} m, the size of an element"
        )


def _points(e: Evidence) -> Iterator[Sentence]:
    """Too few contact points at the largest force, of pairs with a hundredth of the largest force
    and more.
    """
    pairs, needed = e.pairs, FEWEST_POINTS[e.facts["dimension"]]
    largest = max((pair["peak"] for pair in pairs), default=0)
    rough = [
        pair
        for pair in pairs
        if pair["peak"] > THRESHOLD * largest and pair["points_at_peak"] < needed
    ]
    if not rough:
        return
    worst = min(rough, key=lambda pair: pair["points_at_peak"])
    fewest = worst["points_at_peak"]
    whose = e.pair(worst) if len(pairs) > 1 else "the body"
    yield warn(
        f"contact points: {fewest} of {whose}{_others(len(rough))} carry the largest force: at "
        f"least {needed} are needed. Forces and contact time are "
        f"those of single edges: take {e.finer('a smaller contact_mesh_size', worst)}"
    )


def _corners(e: Evidence) -> Iterator[Sentence]:
    """A right angle that is pressed flat without friction, at constant area, shortens to 0.71 of
    its length from the corner, in the mean of all directions, however small the load; a free
    neo-Hookean surface folds at 0.65 (Hohlfeld, Mahadevan 2011).
    """
    share = e.corner_share or 0
    if share > CORNER:
        yield warn(
            f"corner: {percent(share)} of the impulse comes from contacts that began at a sharp "
            f"corner or edge: up to {percent(CORNER)} is small. Elements "
            "at the corner may fold, and a finer mesh may change the results by more than the "
            "error estimates: round the corner by vertices, or compare "
            f"with {e.finer('half the contact_mesh_size')}"
        )


# ---- supports


def _held(e: Evidence) -> Iterator[Sentence]:
    held = e.facts["held"]
    if e.is_pushed_in:
        support, into = map(int, held[5:])
        yield warn(
            f"held part: support {support + 1} pushes its part up to {rounded(held[0])} m "
            f"into {e.obstacle(into)}{e.near(held)}, at t = {held[1]:g} s: its nodes follow the support, and no "
            "contact force moves them: take a motion that keeps the part outside, or support "
            "another part"
        )


def _sudden(e: Evidence) -> Iterator[Sentence]:
    """A jump of the velocity of a support starts a front. Forces ring behind it by up to a third of
    the force of the front, which may be part of support_peak.
    """
    facts = e.facts
    peak = e.numbers.get(f"support_peak_{facts['sudden_support'] + 1}", 0.0)
    jumps = facts["sudden_speed"] > 1e-6 * facts["fastest_motion"]
    if jumps and facts["sudden_front"] / 3 > facts["accuracy"] * peak:
        yield warn(
            f"sudden support: at t = {facts['sudden_at']:.3g} s the velocity of support "
            f"{facts['sudden_support'] + 1} jumps by {rounded(facts['sudden_speed'])} m/s, at the "
            "start from that of its body. Elements and steps do not resolve the front that it starts, "
            "and forces ring behind it: support_peak may be too large by a third of the front, "
            "which its error estimate does not contain: take a motion that starts and stops smoothly"
        )


def _release(e: Evidence) -> Iterator[Sentence]:
    """The support whose largest force increases most by a release. In an elastic bar the exact force
    changes its sign at the release, not its size.
    """
    rises = [
        (e.numbers[f"support_peak_{k}"] / before, before, k)
        for k, before in enumerate(e.facts["peaks_before_release"], 1)
        if e.facts["first_release"] >= 0 and before > 0
    ]
    ratio, before, k = max(rises, default=(0.0, 0.0, 0))
    if ratio > 1 + e.facts["accuracy"]:
        yield warn(
            f"release: support_peak_{k} is {percent(ratio - 1)} above its value "
            f"{rounded(before)} N{e.facts['per_metre']} before the release at "
            f"t = {e.facts['first_release']:g} s: a sudden release starts a front that elements "
            "and steps do not resolve, and forces ring behind it: take a motion that unloads the "
            "part before its release"
        )


# ---- the end of the run


def _ending(e: Evidence) -> Iterator[Sentence]:
    facts, numbers = e.facts, e.numbers
    mass = sum(body["mass"] for body in e.bodies)
    strikes = numbers["impulse"] > 2 * mass * e.pull * (
        numbers["contact_time"] or 0
    )  # more than twice the impulse of the weight: an impact, not a body at rest
    # Held, loaded or pressed until the end: no end of contact is expected.
    pushed = facts["supports_move"] or facts["pushing_loads"] > 0 or facts["pressed"]
    several = len(e.bodies) > 1
    in_contact = facts["in_contact"] and not pushed and (several or strikes)
    if (
        e.record["ended"] not in ("rest", "stopped")
        and facts["rolling"] == 0
        and (facts["until_rest"] or in_contact)
    ):
        yield warn(
            f"not over: at the end_time {e.body} "
            f"{'does not rest yet' if facts['until_rest'] else 'is still in contact'}: contact "
            "time, impulse and "
            "rebound are those at this time: take a larger end_time"
        )
    if facts["rolling"] > 0:
        moves = "bodies roll or slide" if several else f"{e.body} rolls or slides"
        yield warn(
            f"rest: {moves} on without vibration: viscosity and friction take "
            f"{percent(facts['loss_rate'] / facts['rolling'])} of the kinetic energy, "
            f"{rounded(facts['rolling'])} J{facts['per_metre']}, each second. The run ended there: "
            "give an end_time > 0 to follow the motion"
        )


def _next_contact(e: Evidence) -> Iterator[Sentence]:
    """A contact that may follow, which the run has not computed."""
    facts, again = e.facts, e.facts["contact_again_at"]
    if again < 0:
        return
    who = e.pair(facts["pairs"][facts["pair_ahead"]]) if facts["pair_ahead"] >= 0 else "bodies"
    within = again <= facts["impact_until"]
    cuts = {"end_time": "the end_time cuts the impact", "stopped": "the run was stopped"}
    if e.record["ended"] in cuts:
        why = cuts[e.record["ended"]]
    elif within:
        why = "gravity bends their flight, which ends the run"
    else:
        why = "they vibrate near each other"
    if e.later_contact_possible:
        yield warn(
            f"not over: {who} may strike again, at t = {again:g} s or later, as {why}: contacts "
            f"until t = {facts['impact_until']:g} s belong to the impact. Impulse, rebound and "
            "times do not include that contact and have no error estimate: take a larger end_time"
        )
    else:
        yield note(
            f"touches again: {who} {'come' if facts['surely_again'] else 'may come'} into contact "
            f"again, at t = {again:g} s or later: "
            "the run ended after the first impact: take an end_time > 0 to follow the next one"
        )


def _discretisation(e: Evidence) -> Iterator[Sentence]:
    """Elements that lock, spin that a skipped flight leaves out, steps that are long beside a
    relaxation.

    On the mesh of accuracy 1 % the peak force of a disc is up to 8 % too large at nu = 0.49, by
    4 to 17 % at 0.495 and up to 29 % at 0.498.
    """
    facts, nu = e.facts, max(body["nu"] for body in e.bodies)
    at_points = facts.get("nu_at_points", 0.0 if facts["projected"] else nu)
    if facts["degree"] == 1 and nu > LOCKING_LINEAR:
        yield warn(
            f"locking: linear elements are too stiff at nu = {nu:g}: above {LOCKING_LINEAR} they "
            "lock, and so does the run that estimates the error: take "
            "degree=2"
        )
    if facts["degree"] == 2 and at_points > LOCKING_QUADRATIC - 1e-9:
        yield warn(
            f"locking: quadratic elements are too stiff at nu = {at_points:g} at points: from "
            f"{LOCKING_QUADRATIC} on, with the mesh of accuracy 1 %, peak forces are up to a "
            "third too large and contact times up to 3 % too short: take volume=auto, and the volume "
            "of law=energy as a term of J alone, such as k/2*log(J)^2"
        )
    spun = max(body["spin2"] * (body["reach"] / _wave(body)) ** 2 for body in e.bodies)
    if facts["flown"] and spun > facts["accuracy"]:
        yield warn(
            f"flight: {e.body} is taken as unstressed until contact, but its spin would strain it "
            f"by {percent(spun)}{e.request}: take without=flight, "
            "which integrates the flight in time"
        )
    if facts["bend"] > BENT:
        yield warn(
            f"functions of time: at t = {facts['bend_at']:.3g} s a load or motion changes by "
            f"{percent(facts['bend'])} of its largest value within {facts['dt_largest']:.2g} s, "
            "faster than steps and mesh resolve. Impulse and displacement are exact, waves that "
            "start there are not: take a smaller accuracy, or a smaller mesh_size and dt"
        )
    turn, largest = facts["driven_turn"], facts["most_driven_turn"]
    if turn > largest * (1 + 1e-9):
        yield warn(
            f"driven obstacle: it rotates by {turn:.2g} rad in a step, which makes its forces about "
            f"{percent(turn**2 / 8)} too small: take a dt of at most "
            f"{rounded(facts['dt_largest'] * largest / turn)}"
        )
    lasts = e.numbers["contact_time"] or math.inf
    wrong = max(_of_steps(body, facts["dt_largest"], lasts) for body in e.bodies)
    if wrong > facts["accuracy"]:
        yield warn(
            f"relaxation: steps of {facts['dt_largest']:g} s make the shear modulus of a relaxing "
            f"body wrong by {percent(wrong)}{e.request}, mostly its loss, and the error estimates "
            "hardly include this: take a smaller dt, or viscosity in place of a relaxation this "
            "short"
        )


def _of_steps(body: Table, dt: float, lasts: float) -> float:
    """The error of the complex shear modulus by steps dt [s] in an impact of this duration [s], over
    its amount.
    """
    branches = body.get("branches", [])  # a record of a former version has none
    damping = Damping(branches=list(zip(branches[::2], branches[1::2])))
    mu, omega = body["young"] / (2 * (1 + body["nu"])), math.pi / lasts
    exact = damping.shear(mu, omega)
    return abs(damping.shear_in_steps(mu, omega, dt) - exact) / abs(exact)


def _friction(e: Evidence) -> Iterator[Sentence]:
    """A body whose motion is mirrored about the normal creeps to both sides alike, and so does
    one with hardly any tangential speed."""
    facts = e.facts
    if not facts["friction"]:
        return
    fastest, centre = facts["fastest_motion"], facts["centre_increment"]
    moves = centre > 0.01 * max(facts["slid_increment"], points.whole_load(e.intervals) * fastest)
    if not facts["mirrored"] and facts["creep_increment"] > CREEP * centre and moves:
        yield warn(
            "creep: sticking contact points move at "
            f"{percent(facts['creep_increment'] / max(centre, 1e-300))} of the centre's speed "
            "along "
            f"{e.counter_body}: up to {percent(CREEP)} is small. The regularised friction does not "
            "hold them: take a smaller slip_velocity"
        )
    if facts["slip_velocity"] > LOOSEST * fastest and not facts["starts_at_rest"]:
        yield warn(
            f"slip velocity: {facts['slip_velocity']:g} m/s is "
            f"{percent(facts['slip_velocity'] / fastest)} of the speeds of the scene: up to "
            f"{percent(LOOSEST)} is small. Friction then acts like viscosity: take a smaller "
            "slip_velocity"
        )
    if facts["skipped_sticks"] > 0:
        yield warn(
            f"stick: contact points reversed their slip within a step {facts['skipped_sticks']} "
            f"times under the weight, faster than {facts['slip_velocity']:g} m/s: they may slide "
            "where friction_static would hold them: take a larger slip_velocity, or a smaller dt"
        )
    unsolved = e.numbers["unsolved_jumps"]
    if unsolved > JUMPS * facts["loaded_jumps"]:
        instead = (
            "regularization=linear"
            if facts["regularization"] == "linear-printed"
            else "a smaller dt, or friction_transition=smooth"
        )
        yield warn(
            f"friction: the law has no solution in {percent(unsolved / facts['loaded_jumps'])} of "
            f"the points and steps in contact: {unsolved} of them lie in "
            f"the jump from the static to the dynamic coefficient: take {instead}"
        )


def _bounces(e: Evidence) -> Iterator[Sentence]:
    """A rigid body rests on a penalty without damping: its flights are shorter than its contacts."""
    if not e.facts["friction"] or e.pull == 0:
        return
    if e.numbers.get("penalty_damping_work"):
        return
    stays: dict[tuple[int, int], list[Interval]] = {}
    for interval in sorted(e.intervals, key=lambda interval: interval.start):
        pair = interval.pair["body"], interval.pair["counter_body"]
        if all(e.bodies[k]["rigid"] for k in pair if k >= 0):
            stays.setdefault(pair, []).append(interval)
    short = [
        stay.end - stay.start
        for row in stays.values()
        for stay, later in pairwise(row)
        if later.start - stay.end < stay.end - stay.start
    ]
    if len(short) >= BOUNCES:
        yield warn(
            f"bounces: under their weight rigid bodies had {len(short)} flights that were shorter "
            "than the contact before: without damping the penalty lets them bounce forever. They "
            "slip in each flight, although friction_static would hold them in contact: take "
            f"penalty_damping = {rounded(min(short) / math.pi)}, or start = equilibrium"
        )


def _adhesion(e: Evidence) -> Iterator[Sentence]:
    """The cohesive zone at the edge of a contact, E* w/sigma^2 long, sigma the largest traction. On
    coarser elements points part one by one, each with a force of its own.
    """
    w, attracted = e.facts.get("adhesion", 0.0), e.facts.get("adhesion_range", 0.0)
    soft = [body["young"] / (1 - body["nu"] ** 2) for body in e.bodies if not body["rigid"]]
    if not (w and soft):
        return
    zone, size = min(soft) * w / (1.5 * w / attracted) ** 2, e.facts["smallest_element"]
    if size > zone / IN_ZONE:
        yield warn(
            f"adhesion: surfaces part in a zone of {rounded(zone)} m, in which elements of {rounded(size)} m "
            f"are too large: at least {IN_ZONE} are needed. The force that parts them is too large: "
            "take a smaller contact_mesh_size, or a larger adhesion_range"
        )


def _penalty_damping(e: Evidence) -> Iterator[Sentence]:
    """The energy that the damping of the penalty has taken. It is not a property of a material."""
    taken = e.numbers.get("penalty_damping_work", 0.0)
    if taken > 0:
        yield note(
            f"penalty damping: it has taken {percent(taken / e.facts['supplied_energy'])} of the "
            "energy supplied: impulse, restitution and rebound depend on penalty_damping: "
            "take 0 for impacts of bodies that have their own viscosity or loss"
        )


RULES = (
    _units,
    _law,
    _volume,
    _shape,
    _overlap,
    _balances,
    _chatter,
    _contact,
    _obstacles,
    _pairs,
    _corners,
    _held,
    _sudden,
    _release,
    _ending,
    _next_contact,
    _discretisation,
    _friction,
    _bounces,
    _adhesion,
    _penalty_damping,
)
