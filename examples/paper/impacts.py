"""Figures 6b, 7 and 8: normal impact of the disc with both laws over the speed, and the conclusions
about it."""

from math import floor, sqrt

import numpy as np
import pandas as pd

from ffimpact.sweeps import sweep_figures
from ffimpact.sweeps.sweep_figures import distance, force

from .judging import AGREES, DIFFERS, OPEN, Lost, Results, bar, finished, graded, lost, states, when

SVK, NEO, FORCES = "contact-time-svk", "contact-time-neohookean", "law-comparison"
LOST = "ellipticity_lost_time"
COUNTS = {"steps": "steps", "newton_iterations": "iterations", "factorizations": "factorisations"}
SLOW, FAST = ((FORCES, {"law": "svk", "speed": speed}) for speed in (1, 10))  # of figure 7
@states("Figure 6b", "normal impact, SVK: the contact time falls with the speed in steps, with small rises between", SVK)
def stepped(results: Results) -> tuple[str, str]:
    """For every ν, below the speed at which ellipticity is lost: agrees if the contact time ends
    lower and rises at least twice in between.

    Each rise must exceed twice its error bar. Partly if it only ends lower.
    """
    trends, words = _trends(results, SVK)
    falls = all(trend and trend.ends_lower for trend in trends)
    rises = all(trend and trend.established >= 2 for trend in trends)
    return graded(falls and rises, falls), words + ("" if rises else " The rises are not told from the errors.")


@states("Section 3.1 and conclusions", "the steps of figure 6b are related to the number of wave reflections: each has one less",
        f"{SVK} disc-normal")
def reflections(results: Results) -> tuple[str, str]:
    """Not decided if no ν has a rise beyond twice its error bar, as there is no step to explain.

    Else it agrees if for every ν the number of rises equals the number of integers that the number
    of transits 2R/c in the contact falls through, for pressure or shear waves of small strain.
    """
    used, words, as_many, steps, fewer = results.scene("disc-normal"), [], [], 0, 0
    for nu, group in results.table(SVK).groupby("nu"):
        trend = sweep_figures.steps_against(group[group.speed < _end(group)], "speed", "contact_time")
        if not trend:
            return OPEN, f"ν = {nu:g}: too few runs finished."
        counts = {wave: (trend.first / transit, trend.last / transit) for wave, transit in _transits(used, nu).items()}
        whole = [floor(first) - floor(last) for first, last in counts.values()]
        as_many.append(trend.established in whole)
        fewer = max(fewer, *whole)
        steps += trend.established
        words.append(f"ν = {nu:g}: {trend.established} rises beyond twice their error bar; " + ", ".join(
            f"{first:.2f} to {last:.2f} transits of {wave} waves" for wave, (first, last) in counts.items()))
    return graded(all(as_many)) if steps else OPEN, f"{'; '.join(words)}. By these numbers the curve would have at most {fewer} such steps."


def _transits(used: dict, nu: float) -> dict[str, float]:
    """The transit times 2R/c [s] of waves of small strain through the disc: c² = (λ + 2μ)/ρ and
    μ/ρ."""
    shear = used["young"] / (2 * (1 + nu))
    pressure = used["young"] * (1 - nu) / ((1 + nu) * (1 - 2 * nu))
    return {wave: 2 * used["radius"] / sqrt(modulus / used["density"]) for wave, modulus in (("pressure", pressure), ("shear", shear))}


@states("Figure 7a", "1 m/s: no noticeable difference between the force histories of SVK and neo-Hookean", FORCES, lost=lost(SLOW))
def same_at_low_speed(results: Results) -> tuple[str, str]:
    """Agrees if the L2 difference over time is at most the change by mesh and step; partly if it is
    below 10 %."""
    distance, error = _distance(results, 1)
    return graded(distance <= error, distance < 0.1), (
        f"they differ by {100 * distance:.1f} % in L2 over time (mesh and step change {100 * error:.1f} %).")


@states("Figure 7b", "10 m/s: the contact lasts longer with SVK", FORCES, lost=lost(FAST))
def longer_at_high_speed(results: Results) -> tuple[str, str]:
    """Agrees if the contact is longer with SVK by more than both error bars."""
    rows = finished(results, FORCES)
    if len(rows[rows.speed == 10]) < 2:
        return DIFFERS, "one of the runs at 10 m/s failed."
    (svk, of_svk), (neo, of_neo) = (_of(rows, law, 10, "contact_time") for law in ("svk", "neohookean"))
    since, (distance, _) = when(lost(FAST)(results)[-1], "ellipticity lost"), _distance(results, 10)
    thresholded = [1e3 * _of(rows, law, 10, "thresholded_contact_time")[0] for law in ("svk", "neohookean")]
    return graded(svk - neo > of_svk + of_neo), (
        f"SVK {1e3 * svk:.3f} ± {1e3 * of_svk:.3f} ms, {since}; neo-Hookean {1e3 * neo:.3f} ± {1e3 * of_neo:.3f} ms (above 1 % of the "
        f"peak force {thresholded[0]:.3f} and {thresholded[1]:.3f} ms); the histories differ by {100 * distance:.0f} % in L2.")


@states("Figure 8", "normal impact, neo-Hookean: the contact time falls monotonically with the speed", NEO)
def monotone(results: Results) -> tuple[str, str]:
    """Agrees if for every ν the contact time falls and no rise exceeds the error bar of its step.

    Partly if the error bars exceed the steps, so that a rise would not be visible; not decided if
    they exceed the whole change.
    """
    trends, words = _trends(results, NEO)
    if any(trend and trend.course == sweep_figures.LEVEL for trend in trends):
        return OPEN, f"{words} The contact time {sweep_figures.LEVEL}."
    good = all(trend and trend.falls and trend.beyond == 0 for trend in trends)
    sharp = all(trend and trend.bar < trend.step for trend in trends)
    remark = "" if sharp else " Many steps are smaller than their error bar: a small rise would not show."
    return graded(good and sharp, good), words + remark


@states("Section 3.1", "the neo-Hookean law demands larger computational times", FORCES, lost=lost(SLOW, FAST))
def slower(results: Results) -> tuple[str, str]:
    """Compares counts, which do not depend on the machine, at 1 and 10 m/s on both meshes at equal
    accuracy.

    A pair of runs supports the statement if any of steps, Newton iterations and factorisations is
    over 10 % more than for SVK and none is as much less. Agrees if all pairs do, partly if some do.
    """
    more, words, seconds = [], [], []
    for speed in (1, 10):
        for neo, svk in zip(*(results.summaries(FORCES, law=law, speed=speed) for law in ("neohookean", "svk"))):
            ratios = [neo[name] / svk[name] for name in COUNTS]
            more.append(max(ratios) > 1.1 and min(ratios) > 1 / 1.1)
            words.append(f"{speed:g} m/s, {svk['dofs']} dofs: "
                         + ", ".join(f"{neo[name]} to {svk[name]} {text}" for name, text in COUNTS.items()))
            seconds.append(f"{neo['cpu_seconds'] / svk['cpu_seconds']:.2f}")
    return graded(all(more), any(more)), (f"neo-Hookean to SVK, {'; '.join(words)}. (Processor times, which scatter with the machine and "
                                          f"do not decide: {', '.join(seconds)} of those with SVK.)")


@states("Conclusions", "as the velocities of incidence are higher, the neo-Hookean disc yields a stiffer behaviour", FORCES,
        lost=lost(SLOW, FAST))
def stiffer(results: Results) -> tuple[str, str]:
    """Agrees if at 10 m/s the neo-Hookean peak force is higher and the contact shorter than for
    SVK.

    The differences must exceed both error bars and be larger, as shares, than at 1 m/s.
    """
    rows, good, words = finished(results, FORCES), [], []
    if len(rows) < 4:
        return DIFFERS, "one of the runs failed."
    for name, sign, what in (("peak_force", 1, "peak force higher"), ("contact_time", -1, "contact shorter")):
        shares = {}
        for speed in (1, 10):
            (svk, of_svk), (neo, of_neo) = (_of(rows, law, speed, name) for law in ("svk", "neohookean"))
            shares[speed] = sign * (neo - svk) / svk, (of_svk + of_neo) / svk
        good.append(shares[10][0] > shares[10][1] and shares[10][0] > shares[1][0])
        words.append(f"{what} by "
                     + " and ".join(f"{100 * share:.1f} ± {100 * error:.1f} % at {speed} m/s" for speed, (share, error) in shares.items()))
    return graded(all(good)), f"than with SVK, {'; '.join(words)}; SVK at 10 m/s: {when(lost(FAST)(results)[-1], 'ellipticity lost')}."


@states("Conclusions", "vibro-impact can be reproduced", f"{SVK} {NEO}")
def vibro_impact(results: Results) -> tuple[str, str, Lost]:
    """Agrees if some impact of figures 6b and 8 has several contact intervals on both meshes: the
    vibrating disc strikes again.

    Not decided if impacts have them on one mesh only, as the result then depends on the mesh.
    """
    rows = pd.concat([finished(results, name).assign(of=name) for name in (SVK, NEO)])
    both = rows[rows.contact_intervals - rows.contact_intervals_error > 1]
    once = int((rows.contact_intervals + rows.contact_intervals_error > 1).sum()) - len(both)
    where = ", ".join(f"{row.of.removeprefix('contact-time-')}, ν = {row.nu:g}, {row.speed:g} m/s" for row in both.itertuples())
    verdict, where = AGREES if len(both) else OPEN if once else DIFFERS, f" ({where})" * bool(where)
    text = f"of {len(rows)} impacts {len(both)} touch more than once on both meshes{where}, {once} on one of them only."
    return verdict, text, list(both[LOST]) if both[LOST].notna().all() else []


def _of(rows: pd.DataFrame, law: str, speed: float, column: str) -> tuple[float, float]:
    """(value, error bar) of a law at a speed. The error bar is at least the root mean square of the
    error bars of both laws."""
    return bar(rows[rows.speed == speed], column, law=law)


def _end(group: pd.DataFrame) -> float:
    """The lowest speed at which ellipticity is lost or a run ends by the law [m/s]; inf if there is
    none."""
    return float(group.speed[group[LOST].notna() | (group.exit == 12)].to_numpy().min(initial=np.inf))


def _trends(results: Results, name: str) -> tuple[list[sweep_figures.Trend | None], str]:
    """The trend of the contact time over the speed for each ν of the sweep, and all trends in
    words.

    Speeds at and above the loss of ellipticity are excluded.
    """
    trends, words = [], []
    for nu, group in results.table(name).groupby("nu"):
        end = _end(group)
        kept = group[group.speed < end]
        trend, above = (sweep_figures.steps_against(kept, "speed", column) for column in ("contact_time", "thresholded_contact_time"))
        trends.append(trend)
        words.append(f"ν = {nu:g}: too few runs finished" if not (trend and above) else
                     f"ν = {nu:g}: {1e3 * trend.first:.3f} to {1e3 * trend.last:.3f} ms (± {1e3 * trend.typical:.3f} ms rms), "
                     f"{trend.against} of {trend.steps} steps rise, {trend.beyond} of them by more than their error bar, "
                     f"{trend.established} by more than twice (of the time above 1 % of the peak force {above.beyond} and "
                     f"{above.established})")
        if np.isfinite(end):
            words[-1] += f"; judged below {end:g} m/s, where ellipticity is lost"
    return trends, "; ".join(words) + "."


def _distance(results: Results, speed: float) -> tuple[float, float]:
    """Relative L2 difference of the refined force histories of both laws at a speed, and the
    largest change by mesh and step."""
    runs = {law: results.histories(FORCES, law=law, speed=speed) for law in ("svk", "neohookean")}
    error = max(distance(force(fine), force(plain)) for plain, fine in runs.values())
    return distance(*(force(runs[law][-1]) for law in ("svk", "neohookean"))), error
