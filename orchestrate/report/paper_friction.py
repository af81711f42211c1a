"""Figures 3 to 6a and the oblique impact of section 3.1: friction laws, angles, forces, energies, sliding and sticking.

The histories are those of the sweep friction-jump, with both laws on two meshes, with mu_e = 0.7 and, as the control, with mu_e = mu_d = 0.5.
"""

import numpy as np
import pandas as pd

from ..studies import stick_slip, study
from .friction_laws import VALUES
from .paper_judging import (AGREES, CONSTANT, DIFFERS, LAWS, PARTLY, Finding, History, Results, bar, both_times, finished, maxima, of_both, states,
                            total, touching, when, within)

JUMP, SPEED, ANGLE = "friction-jump", 12.0, 60.0   # m/s, degrees from the plane: the paper's normal incidence is pi/2
EXACT = 1e-9                # a tabulated law and its formula
APART = 1.0                 # degrees


def lost(results: Results) -> list[float | None]:
    """When the oblique impact with SVK loses ellipticity on both meshes [s]."""
    return [end["ellipticity_lost_time"] for end in results.summaries(JUMP, law="svk", friction_static=VALUES["friction_static"])]


def impact(results: Results, law: str, static: float = VALUES["friction_static"]) -> list[History]:
    """The oblique impact on both meshes."""
    return results.histories(JUMP, law=law, friction_static=static)


@states("Figure 3, equations (12), (13)", "the regularisations φ¹, φ², φ³ with ε = 0.1, φ³ with v/(2ε) between −ε and ε, and the law with μ_e = 0.7 below ε and "
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


@states("Section 3.1", "oblique disc, SVK, 12 m/s at π/3, μ_d = 0.5, μ_e = 0.7: contact time 0.0045 s, as the paper may have run it")
def oblique_time(results: Results) -> Finding:
    """Half a unit of the last digit: agrees where both of two coarse meshes meet it with SVK, partly where one does, or ellipticity is lost."""
    runs = [results.summary("disc-oblique-svk"), results.summaries(JUMP, law="svk", friction_static=VALUES["friction_static"])[-1]]
    met = [within(end["contact_time"], 4.5e-3, 0.5e-4) for end in runs]
    rows = finished(results, "oblique")
    other = ", ".join(f"{1e3 * time:.2f} ± {1e3 * error:.2f} ms (ν = {nu:g})" for nu, (time, error) in ((nu, bar(rows, "contact_time", nu=nu)) for nu in rows.nu))
    return Finding(AGREES if all(met) else PARTLY if any(met) else DIFFERS, "on two coarse meshes " + "; ".join(
        f"{both_times(end)}, {end['dofs']} dofs, {when(end['ellipticity_lost_time'], 'ellipticity lost')}, {when(end['breakdown_time'], 'det F ≤ 0')}" for end in runs)
        + f". Where ellipticity is lost no mesh is the answer. (The neo-Hookean disc, another law, converges to {other}.)",
        [results.picture("disc-oblique-svk", "force")], [results.run("disc-oblique-svk"), *results.sweep_runs(JUMP), *results.sweep_runs("oblique")],
        [end["ellipticity_lost_time"] for end in runs])


@states("Section 3.1, figure 5a", "the normal force oscillates")
def oscillates(results: Results) -> Finding:
    """With a law: where the force has several maxima that stand out by more than 5 % of its largest value, on both meshes."""
    def of(law: str) -> tuple[bool, str]:
        counts = [maxima(history["normal_force"], 0.05 * history["normal_force"].max()) for history in impact(results, law)]
        return min(counts) > 1, f"{' and '.join(map(str, counts))} maxima"
    verdict, words = of_both(of)
    return Finding(verdict, f"maxima that stand out by more than 5 % of the largest force, on two meshes; {words}. Their cause is not judged here.",
                   [results.picture("disc-oblique-svk", "force"), results.picture("disc-oblique", "force")], results.sweep_runs(JUMP), lost(results))


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
    return Finding(DIFFERS if not alternate else AGREES if more else PARTLY, "how many times the whole load changes between sliding and sticking, on two meshes; "
                   + "; ".join(words) + "." + said, [*results.drawn(JUMP), results.picture("disc-oblique-svk", "rolling")], results.sweep_runs(JUMP), lost(results))


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
    return Finding(verdict, f"before the contact the flight is exact; {words}.", [results.picture("disc-oblique-svk", "energies"), results.picture("disc-oblique", "energies")],
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
    """Over the search of ε, k, ν with SVK at 60° (the paper calls normal incidence π/2): agrees where all runs do both, partly where some
    do. Constant energy: at most 5 % of the friction work in the last third."""
    every = results.stick_slip()
    counts = {}
    for law in LAWS:
        rows = every[(every.exit == 0) & (every.law == law)]
        counts[law] = int((rows["order"] & rows["quiet"]).sum()), len(rows), int(rows["order"].sum())
    both, runs, _ = counts["svk"]
    said = ", ".join(f"{LAWS[law]}: {order} of {n} runs, {both} of them with at most {100 * stick_slip.QUIET:g} % of the friction work in the last third"
                     for law, (both, n, order) in counts.items())
    restitution = {name: results.summary(name)["rebound_vy"] / _normal() for name in ("disc-oblique-svk", "disc-oblique")}
    shares = " and ".join(f"{slip_share(e):.2f} with the e = {e:.3f} of {name}" for name, e in restitution.items())
    explained = "" if both else ", which explains it: the disc sticks long before two thirds, and slips back at the end"
    return Finding(AGREES if runs and both == runs else PARTLY if both else DIFFERS, f"slides first and sticks last: {said}. The slip of a rigid disc ends at the share "
                   f"v_t/(3 μ_d (1 + e) v_n) of the normal impulse, {shares}{explained}.",
                   [results.folder / "stick-slip/stick-slip.png"],
                   [*(study.place(results.folder / "stick-slip", point) for point in stick_slip.grid(stick_slip.AXES)), *map(results.run, restitution)],
                   list(every[(every.exit == 0) & (every.law == "svk")].ellipticity_lost_time))


def _normal() -> float:
    return SPEED * np.sin(np.radians(ANGLE))


def slip_share(e: float) -> float:
    """The share of the normal impulse at which a rigid disc (I = m R²/2, so that each unit of friction impulse takes 3/m of its slip) stops to slide."""
    return SPEED * np.cos(np.radians(ANGLE)) / (3 * VALUES["friction_dynamic"] * (1 + e) * _normal())


@states("Section 3.1, figure 4", "in the last third of the contact the disc rolls without sliding")
def rolls(results: Results) -> Finding:
    """With a law, on both meshes: where v_x and -ω R differ by less than 5 % of v_x, as the mean over the last third of the contact."""
    radius = results.scene("disc-oblique-svk")["radius"]

    def of(law: str) -> tuple[bool, str]:
        means = [_last_third(history, radius) for history in impact(results, law)]
        return all(abs(rim - centre) < 0.05 * abs(centre) for centre, rim in means), " and ".join(f"v_x = {centre:.2f}, −ω R = {rim:.2f} m/s" for centre, rim in means)
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
    return Finding(verdict, f"share of the contact time in which all of the load slides, on two meshes; {words}.", [results.picture("disc-oblique-svk", "rolling")],
                   results.sweep_runs(JUMP), lost(results))
