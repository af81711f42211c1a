"""Figures 3 to 6a and the oblique impact of section 3.1: friction laws, angles, forces, energies, sliding and sticking.

The histories are those of the sweep friction-jump, with both laws on two meshes, with mu_e = 0.7 and, as the control, with mu_e = mu_d = 0.5.
"""

import numpy as np
import pandas as pd

from ..studies import stick_slip
from ..sweeps import study
from ..report.friction_laws import VALUES
from .judging import AGREES, CONSTANT, DIFFERS, LAWS, OPEN, PARTLY, Finding, History, Results, bar, finished, maxima, of_both, states, total, touching
from ..report.vibration import spectrum

JUMP, SPEED, ANGLE, FLAT = "friction-jump", 12.0, 60.0, 30.0   # m/s, degrees from the plane: the paper's normal incidence is pi/2; FLAT: as if pi/3 were from the normal
EXACT = 1e-9                # a tabulated law and its formula
APART = 1.0                 # degrees
STEPS, STEP_RATIO = "friction-steps", 4   # the sweep, and how many times smaller its refined step is


def lost(results: Results) -> list[float | None]:
    """When the oblique impact with SVK loses ellipticity on both meshes [s]."""
    return [end["ellipticity_lost_time"] for end in results.summaries(JUMP, law="svk", friction_static=VALUES["friction_static"])]


def impact(results: Results, law: str, static: float = VALUES["friction_static"]) -> list[History]:
    """The oblique impact on both meshes."""
    return results.histories(JUMP, law=law, friction_static=static)


@states("Figure 3, equations (12), (13)", "the regularisations φ¹, φ², φ³ with ε = 0.1, φ³ with v/(2ε) between −ε and ε, and the law with μ_e = 0.7 below ε "
                                          "and "
        "μ_d = 0.5 above")
def friction_laws(results: Results) -> Finding:
    """Agrees where every tabulated curve is its formula, φ³ in the form linear-printed, to 1e-9."""
    laws, epsilon = results.friction_laws(), VALUES["slip_velocity"]
    step = lambda v, middle: np.where(np.abs(v) < epsilon, middle, np.sign(v))   # noqa: E731
    formulas = {"φ¹": ("b", "sqrt", lambda v: v / np.hypot(v, epsilon)), "φ²": ("b", "tanh", lambda v: np.tanh(v / epsilon)),
                "φ³ with v/(2ε)": ("b", "linear-printed", lambda v: step(v, v / (2 * epsilon))),
                "μ_e, μ_d": ("c", "linear", lambda v: np.where(np.abs(v) < epsilon, VALUES["friction_static"] * v / epsilon, VALUES["friction_dynamic"] * np.sign(v)))}
    apart = {name: _apart(laws, panel, law, of) for name, (panel, law, of) in formulas.items()}
    return Finding(AGREES if max(apart.values()) < EXACT else DIFFERS, "largest deviation of the law as tabulated (friction-laws/laws.csv) from its formula: "
                   + ", ".join(f"{name} {value:.0e}" for name, value in apart.items()) + " (of the last with v/ε below ε).", [_laws(results)])


@states("Equation (13)", "φ³ = v/(2ε) between −ε and ε is the function adopted")
def adopted(results: Results) -> Finding:
    """Agrees where the law that runs use by default (linear) is (13) as printed, to 1e-9."""
    laws, epsilon = results.friction_laws(), VALUES["slip_velocity"]
    printed, used = (_apart(laws, "b", "linear", lambda v, n=n: np.where(np.abs(v) < epsilon, v / (n * epsilon), np.sign(v))) for n in (2, 1))
    return Finding(AGREES if printed < EXACT else DIFFERS,
                   f"two laws (friction-laws/laws.csv): the one that runs use deviates from (13) as printed by up to {printed:.3f}, and from v/ε by "
                   f"{used:.0e}. As printed φ³ jumps from 0.5 to 1 at |v| = ε, v/ε is continuous; the printed one is there as regularization = linear-printed.",
                   [_laws(results)])


def _laws(results: Results):
    return results.folder / "friction-laws/friction-laws.png"


def _apart(laws: pd.DataFrame, panel: str, law: str, formula) -> float:
    """Largest deviation of a tabulated curve, with the jump, from a formula of the velocity; |v| = ε counts as sliding, as in the program."""
    curve = laws[(laws.panel == panel) & (laws.law == law) & (laws.transition == "jump")]
    v = np.where((curve.side == "stick") | (np.abs(curve.v) >= VALUES["slip_velocity"]), curve.v, np.sign(curve.v) * VALUES["slip_velocity"])
    return float(np.abs(curve.ratio - formula(v)).max())


@states("Section 3.1, figure 4b", "the angles of incidence and reflection are different")
def angles(results: Results) -> Finding:
    """With a law: where on finished runs they differ by more than a degree and the error bar; neo-Hookean for every ν."""
    def of(law: str) -> tuple[bool, str]:
        rows = finished(results, JUMP if law == "svk" else "oblique")
        rows = rows[(rows.law == law) & (rows.friction_static == VALUES["friction_static"])] if law == "svk" else rows
        found = [_angle(rows, k) for k in range(len(rows))]
        return bool(found) and all(abs(out - ANGLE) > APART + error for out, error in found), ", ".join(
            f"{out:.1f} ± {error:.1g}°" + (f" (ν = {nu:g})" if law != "svk" else "") for (out, error), nu in zip(found, rows.get("nu", [np.nan] * len(rows))))
    verdict, words = of_both(of)
    return Finding(verdict, f"from the plane {ANGLE:g}° in; out, {words}. (The bar of SVK is between two coarse meshes.)",
                   [results.picture("disc-oblique-svk", "flight"), results.picture("disc-oblique", "flight")],
                   results.sweep_runs(JUMP) + results.sweep_runs("oblique"), lost(results))


def _angle(rows: pd.DataFrame, k: int) -> tuple[float, float]:
    """Angle of reflection of the k-th row and its error bar [degrees]."""
    one = {"index": rows.index[k]}
    (x, dx), (y, dy) = (bar(rows.assign(index=rows.index), name, **one) for name in ("rebound_vx", "rebound_vy"))
    return float(np.degrees(np.arctan2(y, x))), float(np.degrees(np.hypot(x * dy, y * dx) / np.hypot(x, y) ** 2))


@states("Section 3.1, figure 5a", "the normal force oscillates")
def oscillates(results: Results) -> Finding:
    """With a law: where the force has several maxima that stand out by more than 5 % of its largest value, on both meshes."""
    def of(law: str) -> tuple[bool, str]:
        counts = [maxima(history["normal_force"], 0.05 * history["normal_force"].max()) for history in impact(results, law)]
        return min(counts) > 1, f"{' and '.join(map(str, counts))} maxima"
    verdict, words = of_both(of)
    return Finding(verdict, f"maxima that stand out by more than 5 % of the largest force, on two meshes; {words}.",
                   [results.picture("disc-oblique-svk", "force"), results.picture("disc-oblique", "force")], results.sweep_runs(JUMP), lost(results))


@states("Section 3.1, figure 5a", "the oscillations are due to the multiple reflections of the impact waves on the disc's boundary")
def reflected(results: Results) -> Finding:
    """By the spectrum of the force less its slow push, beside the natural modes of the disc (modes.csv): what waves between its boundaries make up. With SVK,
    of the peaks that both meshes have: partly where some, agrees where all lie nearer to a mode with 1 % of the vibration than the contact time tells
    frequencies apart, 1/(2T); but not decided where most of the frequencies do, as then any peak would; not where none does."""
    found, words = {}, []
    for law in LAWS:
        peaks, modes, width, chance = zip(*(_oscillation(*each) for each in zip(impact(results, law), results.modes(JUMP, law=law, friction_static=VALUES["friction_static"]))))
        common = [peak for peak in peaks[0] if any(abs(peak - other) < max(width) for other in peaks[1])]
        near = [peak for peak in common if all(np.abs(each - peak).min(initial=np.inf) < width[0] for each in modes)]
        found[law] = common, near, max(chance)
        words.append(f"{LAWS[law]}: peaks of both meshes at {', '.join(f'{peak:.0f}' for peak in common) or 'no frequency'} Hz, {len(near)} of {len(common)} "
                     f"within {width[0]:.0f} Hz "
                     f"of such a mode, as are {100 * max(chance):.0f} % of all frequencies from {min(each.min() for each in modes):.0f} to "
                     f"{max(each.max() for each in modes):.0f} Hz")
    common, near, chance = found["svk"]
    verdict = DIFFERS if not near else OPEN if chance > 0.5 else AGREES if len(near) == len(common) else PARTLY
    said = " The modes lie nearer to each other than an impact of this length tells apart." if verdict == OPEN else ""
    return Finding(verdict, "; ".join(words) + "." + said, results.drawn(JUMP), results.sweep_runs(JUMP), lost(results))


def _oscillation(history: History, modes: np.recarray) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Of the normal force less the half sine and the sine that fit it best: peaks of its spectrum [Hz] from the lowest to the highest mode, a quarter of the
    largest or more; the modes with 1 % of the vibration; half of what the contact time tells apart; the share of all frequencies that is as near to such a
    mode."""
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


@states("Section 3.1, figure 5b", "an instability born from the alternation of static and dynamic friction")
def alternates(results: Results) -> Finding:
    """With SVK: agrees where the whole load changes its coefficient more than twice and, by more than mesh and step change it, more often than
    with equal coefficients, where nothing jumps; partly where it does so no more often than this control."""
    found, words = {}, []
    for law in LAWS:
        jump, control = ([load_changes(history) for history in impact(results, law, VALUES[name])] for name in ("friction_static", "friction_dynamic"))
        error = max(np.ptp(jump), np.ptp(control))
        found[law] = min(jump) > 2, min(jump) - max(control) > error
        words.append(f"{LAWS[law]}: {' and '.join(f'{n:.1f}' for n in jump)} times, in the control {' and '.join(f'{n:.1f}' for n in control)}")
    alternate, more = found["svk"]
    said = "" if more else " The points alternate between sliding and sticking, but the jump of the coefficient is not what makes them: equal coefficients do the same."
    return Finding(DIFFERS if not alternate else AGREES if more else PARTLY, "how many times the whole load changes between sliding and sticking, on two "
                                                                             "meshes; "
                   + "; ".join(words) + "." + said, [*results.drawn(JUMP), results.picture("disc-oblique-svk", "rolling")], results.sweep_runs(JUMP), lost(results))


@states("Section 3.1, figure 5b", "the instability is characterised by a discontinuity in the acceleration due to the sudden change in the type of friction")
def discontinuous(results: Results) -> Finding:
    """With SVK, on the acceleration of the centre along the plane (friction force over mass) with steps of 20 and 5 μs: it jumps where its largest changes from
    step to step (mean of five) fall by less than the square root of the steps, while those of the acceleration across the plane fall by more. Agrees where
    it jumps, and by at least half of what μ_e exceeds μ_d by more than with equal coefficients; partly where it jumps with equal coefficients alike; not
    where it does not."""
    found, words = {}, []
    for law in LAWS:
        jump, control = ([_changes(history) for history in results.histories(STEPS, law=law, friction_static=VALUES[name])] for name in ("friction_static", "friction_dynamic"))
        (along, across), (ratio, _) = (_orders(*each) for each in (jump, control))
        excess = min(mine[0] / other[0] for mine, other in zip(jump, control))
        found[law] = along < 0.5 < across, excess > (1 + VALUES["friction_static"] / VALUES["friction_dynamic"]) / 2
        words.append(f"{LAWS[law]}: {' to '.join(f'{change:.0f}' for change, _ in jump)} m/s² along the plane (as the step to the power {along:.2f}; across "
                     f"it {across:.2f}), "
                     f"with equal coefficients {' to '.join(f'{change:.0f}' for change, _ in control)} ({ratio:.2f})")
    jumps, more = found["svk"]
    said = "" if more or not jumps else " Equal coefficients, where nothing changes suddenly but the direction, do the same."
    return Finding(DIFFERS if not jumps else AGREES if more else PARTLY, "largest changes of the acceleration in a step; " + "; ".join(words) + "." + said,
                   results.drawn(STEPS), results.sweep_runs(STEPS), [end["ellipticity_lost_time"] for end in results.summaries(STEPS, law="svk", friction_static=VALUES["friction_static"])])


def _changes(history: History) -> tuple[float, float]:
    """The mean of the five largest changes from step to step in the contact of the acceleration of the centre along and across the plane [m/s2]."""
    steps, mass = touching(history), history["momentum_y"][0] / history["vy"][0]
    return tuple(float(np.sort(np.abs(np.diff(history[name][steps])))[-5:].mean() / abs(mass)) for name in ("friction_force", "normal_force"))


def _orders(coarse: tuple[float, float], fine: tuple[float, float]) -> list[float]:
    """The power of the step with which these changes go."""
    return [float(np.log(a / b) / np.log(STEP_RATIO)) for a, b in zip(coarse, fine)]


def load_changes(history: History) -> float:
    """How many times the whole normal load changes between sliding and sticking: the changes of the share that slides, weighted with the
    load over its mean."""
    steps = touching(history)
    load, share = history["normal_force"][steps], history["sliding_fraction"][steps]
    return float((0.5 * (load[1:] + load[:-1]) * np.abs(np.diff(share))).sum() / load.mean())


@states("Section 3.1, figure 6a", "the energy is constant before and after the contact, and falls in it by friction", exact=True)
def energy(results: Results) -> Finding:
    """With a law, on both meshes: where the total changes by less than 1e-9 of its start after the last touch, never grows in the contact,
    and falls over it."""
    def of(law: str) -> tuple[bool, str]:
        after, grows, lost = (max(values) for values in zip(*map(_losses, impact(results, law))))
        return after < CONSTANT and grows < CONSTANT and lost > CONSTANT, f"constant to {after:.0e} after the contact, rises in it by at most {grows:.0e}, {100 * lost:.1f} % lost"
    verdict, words = of_both(of)
    return Finding(verdict, f"before the contact the flight is exact; "
                            f"{words}.", [results.picture("disc-oblique-svk", "energies"), results.picture("disc-oblique", "energies")],
                   results.sweep_runs(JUMP), lost(results))


def _losses(history: History) -> tuple[float, float, float]:
    """Of the energy at the start: its range after the last touch, its largest rise of a step, what is lost; inf where no step is after."""
    energies, last = total(history) / total(history)[0], touching(history)[-1]
    after = np.ptp(energies[last:]) if len(energies) > last + 1 else np.inf
    return float(after), max(0.0, float(np.diff(energies).max())), float(1 - energies[-1])


@states("Section 3.1, figure 6a", "the elastic energy is null before the contact and in it fluctuates together with the kinetic energy")
def elastic(results: Results) -> Finding:
    """With SVK, on both meshes: agrees where it is null to 1e-9 of the total at the start, its changes in the contact mirror those of the
    kinetic energy (correlation below -0.9), and it has several maxima that stand out by more than 1 % of the total; partly where it rises and
    falls once."""
    found, words = {}, []
    for law in LAWS:
        before, mirror, most, counts = zip(*map(_exchange, impact(results, law)))
        found[law] = max(before) < CONSTANT and max(mirror) < -0.9, min(counts) > 1
        words.append(f"{LAWS[law]}: {max(before):.0e} before, in it up to {100 * max(most):.0f} % with "
                     f"{' and '.join(map(str, counts))} maxima, correlation with the kinetic {max(mirror):.3f}")
    exchanged, fluctuates = found["svk"]
    said = "" if fluctuates else " With SVK it rises and falls once."
    return Finding(DIFFERS if not exchanged else AGREES if fluctuates else PARTLY, f"of the total at the start, on two meshes; {'; '.join(words)}." + said,
                   [results.picture("disc-oblique-svk", "energies"), results.picture("disc-oblique", "energies")],
                   results.sweep_runs(JUMP), lost(results))


def _exchange(history: History) -> tuple[float, float, float, int]:
    """Of the elastic energy: its share of the total before the contact, the correlation of its changes in a step with those of the kinetic energy, its
    largest share, and the maxima that stand out by more than 1 % of the total."""
    steps, start = touching(history), total(history)[0]
    mirror = np.corrcoef(*(np.diff(history[name])[steps[1:] - 1] for name in ("kinetic", "elastic")))[0, 1]
    return (float(abs(history["elastic"][:max(steps[0], 1)]).max() / start), float(mirror), float(history["elastic"].max() / start),
            maxima(history["elastic"][steps], 0.01 * start))


@states("Section 3.1", "the disc slides first and sticks in about the last third of the contact, in which the energy is constant again")
def sliding_first(results: Results) -> Finding:
    """Over the search of ε, k, ν with SVK, at 60° (the paper calls normal incidence π/2) and at 30° from the plane: agrees where all runs of one angle do both,
    partly where some of any do. Constant energy: at most 5 % of the friction work in the last third."""
    every = results.stick_slip()
    every = every[every.exit == 0]
    told, counts = [], {}
    for (angle, law), rows in every.groupby(["angle", "law"], sort=False):
        order, both = int(rows["order"].sum()), int((rows["order"] & rows["quiet"]).sum())
        counts |= {angle: (both, len(rows))} if law == "svk" else {}
        told.append(f"{angle:g}°, {LAWS[law]}: {order} of {len(rows)} runs, {both} of them with at most {100 * stick_slip.QUIET:g} % of the friction work in "
                    f"the last third")
    restitution = {name: results.summary(name)["rebound_vy"] / _normal() for name in ("disc-oblique-svk", "disc-oblique")}
    shares = " and ".join(f"{slip_share(e):.2f} with the e = {e:.3f} of {name}" for name, e in restitution.items())
    met = [angle for angle, (both, _) in counts.items() if both]
    explained = "" if ANGLE in met else ", which explains it: the disc sticks long before two thirds, and slips back at the end"
    only = f" With SVK the order appears only at {FLAT:g}° from the plane, which is π/3 from the normal." if met == [FLAT] else ""
    return Finding(AGREES if any(both == runs for both, runs in counts.values()) else PARTLY if met else DIFFERS, f"slides first and sticks last: "
                                                                                                                  f"{'; '.join(told)}. "
                   f"The slip of a rigid disc ends at the share v_t/(3 μ_d (1 + e) v_n) of the normal impulse, {shares}{explained}. At {FLAT:g}° from the "
                   f"plane it would end at "
                   f"{slip_share(restitution['disc-oblique'], FLAT):.2f}.{only}",
                   [results.folder / "stick-slip/stick-slip.png"],
                   [*(study.place(results.folder / "stick-slip", point) for point in stick_slip.grid(stick_slip.AXES)), *map(results.run, restitution)],
                   list(every[every.law == "svk"].ellipticity_lost_time))


def _normal(angle: float = ANGLE) -> float:
    return SPEED * np.sin(np.radians(angle))


def slip_share(e: float, angle: float = ANGLE) -> float:
    """The share of the normal impulse at which a rigid disc (I = m R²/2, so that each unit of friction impulse takes 3/m of its slip) stops to slide."""
    return SPEED * np.cos(np.radians(angle)) / (3 * VALUES["friction_dynamic"] * (1 + e) * _normal(angle))


@states("Section 3.1, figure 4", "in the last third of the contact the disc rolls without sliding")
def rolls(results: Results) -> Finding:
    """With a law, on both meshes: where v_x and -ω R differ by less than 5 % of v_x, as the mean over the last third of the contact."""
    radius = results.scene("disc-oblique-svk")["radius"]

    def of(law: str) -> tuple[bool, str]:
        means = [_last_third(history, radius) for history in impact(results, law)]
        return all(abs(rim - centre) < 0.05 * abs(centre) for centre, rim in means), " and ".join(f"v_x = {centre:.2f}, −ω R = {rim:.2f} "
                                                                                                  f"m/s" for centre, rim in means)
    verdict, words = of_both(of)
    end, used = results.summary("disc-rolling"), results.scene("disc-rolling")
    return Finding(verdict, f"means over the last third, on two meshes; {words}. (Set down on the plane, in a scene of our own that the "
                   f"verdict does not rest on, it comes to roll at {end['rebound_vx'] / used['speed']:.3f} v₀; rigid: 2/3.)",
                   [results.picture("disc-oblique-svk", "rolling"), results.picture("disc-rolling", "rolling")],
                   [*results.sweep_runs(JUMP), results.run("disc-oblique-svk"), results.run("disc-rolling")], lost(results))


def _last_third(history: History, radius: float) -> tuple[float, float]:
    """Means over the last third of the contact of the velocity of the centre and of -ω R [m/s]."""
    t, steps = history["t"], touching(history)
    start, end = t[steps[0]] - history["dt"][steps[0]], t[steps[-1]]
    last = steps[t[steps] > start + 2 / 3 * (end - start)]
    weights = history["dt"][last]
    return float(np.average(history["vx"][last], weights=weights)), float(np.average(-radius * history["spin"][last], weights=weights))


@states("Conclusions", "smooth slip can be reproduced")
def smooth_slip(results: Results) -> Finding:
    """With a law, on both meshes: where all of the load (99 %) slides for at least 5 % of the contact time."""
    def of(law: str) -> tuple[bool, str]:
        shares = []
        for history in impact(results, law):
            steps = touching(history)
            slides = (history["sliding_fraction"][steps] > 0.99) & (history["normal_force"][steps] > 0)
            shares.append(float(history["dt"][steps][slides].sum() / history["dt"][steps].sum()))
        return min(shares) >= 0.05, " and ".join(f"{100 * share:.0f} %" for share in shares)
    verdict, words = of_both(of)
    return Finding(verdict, f"share of the contact time in which all of the load slides, on two meshes; "
                            f"{words}.", [results.picture("disc-oblique-svk", "rolling")],
                   results.sweep_runs(JUMP), lost(results))
