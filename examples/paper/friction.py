"""Figures 3 to 6a and the oblique impact of section 3.1: friction laws, angles, forces, energies,
sliding and sticking.

The histories come from the sweep friction-jump, with both laws on two meshes, with mu_e = 0.7 and,
as a control, with mu_e = mu_d = 0.5.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd

from ffimpact.output.results import mechanical_energy
from ffimpact.report.impacts import spectrum
from ffimpact.sweeps import study
from ffimpact.sweeps.sweep_figures import bars

from . import stick_slip
from .friction_laws import VALUES
from .judging import (
    CONSTANT,
    LAWS,
    OPEN,
    History,
    Lost,
    Results,
    both,
    finished,
    graded,
    lost,
    maxima,
    of_laws,
    states,
    touching,
)

# Speed [m/s] and angle [degrees from the plane]. In the paper normal incidence is pi/2.
JUMP, SPEED, ANGLE = "friction-jump", 12.0, 60.0
# Angle [degrees from the plane] if the paper measured pi/3 from the normal.
FLAT = 30.0
STATIC, DYNAMIC, EPSILON = VALUES.values()
# Permitted difference between a tabulated law and its formula.
EXACT = 1e-9
APART = 1.0  # smallest difference of angles [degrees]
# The sweep, and the factor between its two steps.
STEPS, STEP_RATIO = "friction-steps", 4
TABULATED = "friction-laws/friction-laws.png"
ENERGIES = "disc-oblique-svk/energies disc-oblique/energies"
LOST, LOST_STEPS = (lost((sweep, {"law": "svk", "friction_static": STATIC})) for sweep in (JUMP, STEPS))


def impact(results: Results, law: str, static: float = STATIC, sweep: str = JUMP) -> list[History]:
    """The histories of the oblique impact on both meshes, or with both steps."""
    return results.histories(sweep, law=law, friction_static=static)


# ---- the laws

@states("Figure 3, equations (12), (13)", "the regularisations φ¹, φ², φ³ with ε = 0.1, φ³ with v/(2ε) between −ε and ε, and the law with "
        "μ_e = 0.7 below ε and μ_d = 0.5 above", figures=TABULATED)
def friction_laws(results: Results) -> tuple[str, str]:
    """Agrees if every tabulated curve equals its formula to 1e-9, φ³ in the form linear-printed."""
    laws = results.friction_laws()
    formulas = {"φ¹": ("b", "sqrt", lambda v: v / np.hypot(v, EPSILON)), "φ²": ("b", "tanh", lambda v: np.tanh(v / EPSILON)),
                "φ³ with v/(2ε)": ("b", "linear-printed", _steps(1 / 2)), "μ_e, μ_d": ("c", "linear", _steps(STATIC, DYNAMIC))}
    apart = {name: _apart(laws, panel, law, formula) for name, (panel, law, formula) in formulas.items()}
    return graded(max(apart.values()) < EXACT), (
        "largest deviation of the law as tabulated (friction-laws/laws.csv) from its formula: "
        + ", ".join(f"{name} {value:.0e}" for name, value in apart.items()) + " (of the last with v/ε below ε).")


@states("Equation (13)", "φ³ = v/(2ε) between −ε and ε is the function adopted", figures=TABULATED)
def adopted(results: Results) -> tuple[str, str]:
    """Agrees if the default law of the runs (linear) equals (13) as printed, to 1e-9."""
    printed, used = (_apart(results.friction_laws(), "b", "linear", _steps(slope)) for slope in (1 / 2, 1))
    return graded(printed < EXACT), (
        f"two laws (friction-laws/laws.csv): the one that runs use deviates from (13) as printed by up to {printed:.3f}, and from v/ε by "
        f"{used:.0e}. As printed φ³ jumps from 0.5 to 1 at |v| = ε, v/ε is continuous; the printed one is there as regularization = "
        f"linear-printed.")


def _steps(slope: float, beyond: float = 1.0) -> Callable[[np.ndarray], np.ndarray]:
    """A law with the value slope v/ε below ε and a constant value above."""
    return lambda v: np.where(np.abs(v) < EPSILON, slope * v / EPSILON, beyond * np.sign(v))


def _apart(laws: pd.DataFrame, panel: str, law: str, formula: Callable) -> float:
    """Largest deviation of a tabulated curve, with the jump, from a formula in the velocity. As in
    the program, |v| = ε is sliding."""
    curve = laws[(laws.panel == panel) & (laws.law == law)]
    v = np.where((curve.side == "stick") | (np.abs(curve.v) >= EPSILON), curve.v, np.sign(curve.v) * EPSILON)
    return float(np.abs(curve.ratio - formula(v)).max())


# ---- figures 4 and 5

@states("Section 3.1, figure 4b", "the angles of incidence and reflection are different", f"{JUMP} oblique", lost=LOST,
        figures="disc-oblique-svk/flight disc-oblique/flight",
        laws=f"from the plane {ANGLE:g}° in; out, {{}}. (The bar of SVK is between two coarse meshes.)")
def angles(results: Results, law: str) -> tuple[bool, str]:
    """With a law: whether the angles differ by more than a degree plus the error bar in finished
    runs; neo-Hookean for every ν."""
    rows = finished(results, JUMP if law == "svk" else "oblique")
    rows = rows[(rows.law == law) & (rows.friction_static == STATIC)] if law == "svk" else rows
    (x, dx), (y, dy) = ((rows[name].to_numpy(), bars(rows, name)) for name in ("rebound_vx", "rebound_vy"))
    out, error = np.degrees(np.arctan2(y, x)), np.degrees(np.hypot(x * dy, y * dx) / np.hypot(x, y) ** 2)
    return len(rows) > 0 and bool((abs(out - ANGLE) > APART + error).all()), ", ".join(
        f"{angle:.1f} ± {off:.1g}°" + (f" (ν = {nu:g})" if law != "svk" else "")
        for angle, off, nu in zip(out, error, rows.get("nu", [np.nan] * len(rows))))


@states("Section 3.1, figure 5a", "the normal force oscillates", JUMP, "disc-oblique-svk/force disc-oblique/force", LOST,
        laws="maxima that stand out by more than 5 % of the largest force, on two meshes; {}.")
def oscillates(results: Results, law: str) -> tuple[bool, str]:
    """With a law: whether the force has several maxima of a prominence above 5 % of its largest
    value, on both meshes."""
    counts = [maxima(history["normal_force"], 0.05 * history["normal_force"].max()) for history in impact(results, law)]
    return min(counts) > 1, f"{both(counts)} maxima"


@states("Section 3.1, figure 5a", "the oscillations are due to the multiple reflections of the impact waves on the disc's boundary",
        JUMP, lost=LOST, laws="{}.")
def reflected(results: Results, law: str) -> tuple[str, str, str]:
    """Compares the spectrum of the force, without its slow part, with the natural modes of the disc
    (modes.csv).

    Waves between the boundaries make up these modes. For SVK, peaks that both meshes have are
    compared with modes with 1 % of the vibration energy. A peak belongs to a mode if their
    difference is below the frequency resolution of the contact, 1/(2T). Agrees if all peaks do;
    partly if some do; not if none does. It is not decided if most of all frequencies are as near to
    a mode, as then any peak would be.
    """
    both = zip(impact(results, law), results.modes(JUMP, law=law, friction_static=STATIC))
    peaks, modes, width, chance = zip(*(_oscillation(*arguments) for arguments in both))
    common = [peak for peak in peaks[0] if any(abs(peak - other) < max(width) for other in peaks[1])]
    near = [peak for peak in common if all(np.abs(frequencies - peak).min(initial=np.inf) < width[0] for frequencies in modes)]
    verdict = OPEN if near and max(chance) > 0.5 else graded(bool(near) and len(near) == len(common), bool(near))
    remark = " The modes lie nearer to each other than an impact of this length tells apart." if verdict == OPEN else ""
    return verdict, (f"peaks of both meshes at {', '.join(f'{peak:.0f}' for peak in common) or 'no frequency'} Hz, "
                     f"{len(near)} of {len(common)} within {width[0]:.0f} Hz of such a mode, as are {100 * max(chance):.0f} % of all "
                     f"frequencies from {min(frequencies.min() for frequencies in modes):.0f} to "
                     f"{max(frequencies.max() for frequencies in modes):.0f} Hz"), remark


def _oscillation(history: History, modes: np.recarray) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Analyses the normal force minus the half sine and the sine that fit it best.

    Returns the peaks of its spectrum [Hz] between the lowest and the highest mode, of at least a
    quarter of the largest; the modes with 1 % of the vibration energy; half of the frequency
    resolution of the contact; and the share of all frequencies that is as near to such a mode.
    """
    steps = touching(history)
    t, dt, force = (history[name][steps] for name in ("t", "dt", "normal_force"))
    start, length = t[0] - dt[0], t[-1] - t[0] + dt[0]
    push = np.sin(np.pi * np.outer((t - dt / 2 - start) / length, (1, 2)))
    slow, *_ = np.linalg.lstsq(push * np.sqrt(dt)[:, None], force * np.sqrt(dt), rcond=None)
    frequencies = np.linspace(modes.frequency.min(), modes.frequency.max(), 1000)
    heights = spectrum(t, dt, force - push @ slow, frequencies)
    inner = heights[1:-1]
    peaks = frequencies[1:-1][(inner > heights[:-2]) & (inner > heights[2:]) & (inner > 0.25 * heights.max())]
    strong = modes.frequency[modes.energy > 0.01 * modes.energy.sum()]
    width = 1 / (2 * length)
    return peaks, strong, width, float((np.abs(frequencies[:, None] - strong).min(axis=1) < width).mean())


@states("Section 3.1, figure 5b", "an instability born from the alternation of static and dynamic friction", JUMP,
        f"{JUMP} disc-oblique-svk/rolling", LOST,
        laws="how many times the whole load changes between sliding and sticking, on two meshes; {}.")
def alternates(results: Results, law: str) -> tuple[str, str, str]:
    """For SVK: agrees if the coefficient of the whole load changes more than twice and more often
    than in the control.

    The control has equal coefficients, hence no jump. The excess must be larger than the change by
    mesh and step. Partly if it changes no more often than in the control.
    """
    jump, control = ([load_changes(history) for history in impact(results, law, static)] for static in (STATIC, DYNAMIC))
    alternate, more = min(jump) > 2, min(jump) - max(control) > max(np.ptp(jump), np.ptp(control))
    remark = "" if more else (" The points alternate between sliding and sticking, but the jump of the coefficient is not what makes "
                              "them: equal coefficients do the same.")
    return graded(alternate and more, alternate), f"{both(jump, '.1f')} times, in the control {both(control, '.1f')}", remark


@states("Section 3.1, figure 5b",
        "the instability is characterised by a discontinuity in the acceleration due to the sudden change in the type of friction",
        STEPS, lost=LOST_STEPS, laws="largest changes of the acceleration in a step; {}.")
def discontinuous(results: Results, law: str) -> tuple[str, str, str]:
    """For SVK, on the tangential acceleration of the centre (friction force over mass) with steps
    of 20 and 5 μs.

    It jumps if its largest changes from step to step (mean of five) fall by less than the square
    root of the steps, while those of the normal acceleration fall by more. Agrees if it jumps and
    the change exceeds that of equal coefficients by at least half of the excess of μ_e over μ_d.
    Partly if it jumps equally for equal coefficients. Not if it does not jump.
    """
    jump, control = ([_changes(history) for history in impact(results, law, static, STEPS)] for static in (STATIC, DYNAMIC))
    # The exponents of the step in these changes.
    (along, across), (ratio, _) = (np.log(np.divide(*pair)) / np.log(STEP_RATIO) for pair in (jump, control))
    jumps, more = along < 0.5 < across, min(mine[0] / other[0] for mine, other in zip(jump, control)) > (1 + STATIC / DYNAMIC) / 2
    remark = "" if more or not jumps else " Equal coefficients, where nothing changes suddenly but the direction, do the same."
    return graded(jumps and more, jumps), (
        f"{' to '.join(f'{change:.0f}' for change, _ in jump)} m/s² along the plane (as the step to the power {along:.2f}; across it "
        f"{across:.2f}), with equal coefficients {' to '.join(f'{change:.0f}' for change, _ in control)} ({ratio:.2f})"), remark


def _changes(history: History) -> tuple[float, float]:
    """The mean of the five largest changes from step to step of the tangential and normal
    acceleration of the centre in contact [m/s2]."""
    steps, mass = touching(history), history["momentum_y"][0] / history["vy"][0]
    return tuple(float(np.sort(np.abs(np.diff(history[name][steps])))[-5:].mean() / abs(mass))
                 for name in ("friction_force", "normal_force"))


def load_changes(history: History) -> float:
    """The number of times that the whole normal load changes between sliding and sticking.

    It is the sum of the changes of the sliding share, weighted with the load over its mean.
    """
    steps = touching(history)
    load, share = history["normal_force"][steps], history["sliding_fraction"][steps]
    return float((0.5 * (load[1:] + load[:-1]) * np.abs(np.diff(share))).sum() / load.mean())


# ---- energies, figure 6a

@states("Section 3.1, figure 6a", "the energy is constant before and after the contact, and falls in it by friction", JUMP, ENERGIES,
        LOST, exact=True, laws="before the contact the flight is exact; {}.")
def energy(results: Results, law: str) -> tuple[bool, str]:
    """With a law, on both meshes: whether the total energy is constant after contact to 1e-9 of its
    initial value.

    It must also never grow in contact, and fall over the contact.
    """
    after, grows, gone = (max(values) for values in zip(*map(_losses, impact(results, law))))
    return after < CONSTANT and grows < CONSTANT and gone > CONSTANT, (
        f"constant to {after:.0e} after the contact, rises in it by at most {grows:.0e}, {100 * gone:.1f} % lost")


def _losses(history: History) -> tuple[float, float, float]:
    """Relative to the initial energy: its range after contact, its largest rise in a step, and its
    loss.

    The range is inf if there is no step after contact.
    """
    energies, last = mechanical_energy(history) / mechanical_energy(history)[0], touching(history)[-1]
    after = np.ptp(energies[last:]) if len(energies) > last + 1 else np.inf
    return float(after), max(0.0, float(np.diff(energies).max())), float(1 - energies[-1])


@states("Section 3.1, figure 6a", "the elastic energy is null before the contact and in it fluctuates together with the kinetic energy",
        JUMP, ENERGIES, LOST, laws="of the total at the start, on two meshes; {}.")
def elastic(results: Results, law: str) -> tuple[str, str, str]:
    """For SVK, on both meshes: agrees if the elastic energy is zero before contact to 1e-9 of the
    initial total and fluctuates in contact.

    Its changes in contact must be opposite to those of the kinetic energy (correlation below -0.9),
    and it must have several maxima with a prominence above 1 % of the total. Partly if it rises and
    falls once.
    """
    before, mirror, share, counts = zip(*map(_exchange, impact(results, law)))
    exchanged, fluctuates = max(before) < CONSTANT and max(mirror) < -0.9, min(counts) > 1
    return graded(exchanged and fluctuates, exchanged), (
        f"{max(before):.0e} before, in it up to {100 * max(share):.0f} % with {both(counts)} maxima, correlation with the kinetic "
        f"{max(mirror):.3f}"), "" if fluctuates else " With SVK it rises and falls once."


def _exchange(history: History) -> tuple[float, float, float, int]:
    """Properties of the elastic energy.

    Returns its share of the total before contact, the correlation of its changes in a step with
    those of the kinetic energy, its largest share, and the number of maxima with a prominence above
    1 % of the total.
    """
    steps, start = touching(history), mechanical_energy(history)[0]
    mirror = np.corrcoef(*(np.diff(history[name])[steps[1:] - 1] for name in ("kinetic", "elastic")))[0, 1]
    return (float(abs(history["elastic"][:max(steps[0], 1)]).max() / start), float(mirror), float(history["elastic"].max() / start),
            maxima(history["elastic"][steps], 0.01 * start))


# ---- sliding, sticking, rolling

def _searched(results: Results) -> list[Path]:
    """The runs of the search for sliding and sticking, and the runs that give the restitution."""
    return [*(study.place(results.folder / "stick-slip", point) for point in stick_slip.grid(stick_slip.AXES)),
            *results.folders("disc-oblique-svk", "disc-oblique")]


@states("Section 3.1", "the disc slides first and sticks in about the last third of the contact, in which the energy is constant again",
        _searched, "stick-slip/stick-slip.png")
def sliding_first(results: Results) -> tuple[str, str, Lost]:
    """Evaluates the search over ε, k and ν for SVK, at 60° (normal incidence is π/2 in the paper)
    and at 30° from the plane.

    Agrees if all runs of one angle slide first and then stick with constant energy; partly if some
    runs of any angle do. The energy is constant if at most 5 % of the friction work is done in the
    last third.
    """
    every = results.stick_slip()
    every = every[every.exit == 0]
    sentences, counts = [], {}
    for (angle, law), rows in every.groupby(["angle", "law"], sort=False):
        order, both = int(rows["order"].sum()), int((rows["order"] & rows["quiet"]).sum())
        counts |= {angle: (both, len(rows))} if law == "svk" else {}
        sentences.append(f"{angle:g}°, {LAWS[law]}: {order} of {len(rows)} runs, {both} of them with at most "
                         f"{100 * stick_slip.QUIET:g} % of the friction work in the last third")
    normal = SPEED * np.sin(np.radians(ANGLE))
    restitution = {name: results.summary(name)["rebound_vy"] / normal for name in ("disc-oblique-svk", "disc-oblique")}
    shares = " and ".join(f"{slip_share(e):.2f} with the e = {e:.3f} of {name}" for name, e in restitution.items())
    met = [angle for angle, (both, _) in counts.items() if both]
    explained = "" if ANGLE in met else ", which explains it: the disc sticks long before two thirds, and slips back at the end"
    only = f" With SVK the order appears only at {FLAT:g}° from the plane, which is π/3 from the normal." if met == [FLAT] else ""
    return graded(any(both == runs for both, runs in counts.values()), bool(met)), (
        f"slides first and sticks last: {'; '.join(sentences)}. The slip of a rigid disc ends at the share v_t/(3 μ_d (1 + e) v_n) of the "
        f"normal impulse, {shares}{explained}. At {FLAT:g}° from the plane it would end at "
        f"{slip_share(restitution['disc-oblique'], FLAT):.2f}.{only}"
    ), list(every[every.law == "svk"].ellipticity_lost_time)


def slip_share(e: float, angle: float = ANGLE) -> float:
    """The share of the normal impulse at which a rigid disc stops sliding. With I = m R²/2 each
    unit of friction impulse reduces its slip by 3/m."""
    return 1 / (3 * DYNAMIC * (1 + e) * np.tan(np.radians(angle)))


@states("Section 3.1, figure 4", "in the last third of the contact the disc rolls without sliding", f"{JUMP} disc-oblique-svk disc-rolling",
        "disc-oblique-svk/rolling disc-rolling/rolling", LOST)
def rolls(results: Results) -> tuple[str, str]:
    """With a law, on both meshes: whether v_x and -ω R differ by less than 5 % of v_x, as means
    over the last third of the contact."""
    radius = results.scene("disc-oblique-svk")["radius"]

    def judge(results: Results, law: str) -> tuple[bool, str]:
        means = [_last_third(history, radius) for history in impact(results, law)]
        return all(abs(rim - centre) < 0.05 * abs(centre) for centre, rim in means), " and ".join(
            f"v_x = {centre:.2f}, −ω R = {rim:.2f} m/s" for centre, rim in means)
    own = results.summary("disc-rolling")["rebound_vx"] / results.scene("disc-rolling")["speed"]
    return of_laws(judge, results,
                   "means over the last third, on two meshes; {}. (Set down on the plane, in a scene of our own that the verdict does not "
                   f"rest on, it comes to roll at {own:.3f} v₀; rigid: 2/3.)")


def _last_third(history: History, radius: float) -> tuple[float, float]:
    """Means over the last third of the contact of the velocity of the centre and of -ω R [m/s]."""
    t, steps = history["t"], touching(history)
    start, end = t[steps[0]] - history["dt"][steps[0]], t[steps[-1]]
    last = steps[t[steps] > start + 2 / 3 * (end - start)]
    weights = history["dt"][last]
    return float(np.average(history["vx"][last], weights=weights)), float(np.average(-radius * history["spin"][last], weights=weights))


@states("Conclusions", "smooth slip can be reproduced", JUMP, "disc-oblique-svk/rolling", LOST,
        laws="share of the contact time in which all of the load slides, on two meshes; {}.")
def smooth_slip(results: Results, law: str) -> tuple[bool, str]:
    """With a law, on both meshes: whether all of the load (99 %) slides for at least 5 % of the
    contact time."""
    shares = []
    for history in impact(results, law):
        steps = touching(history)
        slides = (history["sliding_fraction"][steps] > 0.99) & (history["normal_force"][steps] > 0)
        shares.append(float(history["dt"][steps][slides].sum() / history["dt"][steps].sum()))
    return min(shares) >= 0.05, " and ".join(f"{100 * share:.0f} %" for share in shares)
