"""Sections 3.1 and 3.3: the contact times printed in the paper, over maps of nu and k, which the
paper does not state.

Each time is compared alone, and all times together. A map is a sweep over nu and k, on several
coarse meshes if runs lose ellipticity. Between runs the time is interpolated in the logarithm of k.
Runs with det F <= 0 are not valid results.
"""

from collections.abc import Iterable
from itertools import combinations, product
from typing import NamedTuple

import numpy as np
import pandas as pd

from ffimpact.sweeps import sweep_figures

from .bodies import BALL, BALL_NEO, DISC, DISC_NEO
from .judging import Results, bar, both_times, finished, graded, loaded, lost, states, when

DISC_MAP, OBLIQUE_MAP, BALL_MAP, SOLID_MAP = "calibrate", "calibrate-oblique", "calibrate-ball", "calibrate-ball-3d"
# The maps of each contact time of the paper.
MAPS = {"disc": (DISC_MAP,), "oblique disc": (OBLIQUE_MAP,), "ball": (BALL_MAP, SOLID_MAP)}
EVERY = [name for maps in MAPS.values() for name in maps]
# Angles [degrees from the plane]: normal incidence is pi/2 in the paper; OTHER would be pi/3 from
# the normal.
ANGLE, OTHER = 60.0, 30.0
FINE = 400  # number of interpolated values of k
Ranges = list[tuple[float, float]]


# ---- one contact time, one map

@states("Section 3.1", "oblique disc, SVK, 12 m/s at π/3, μ_d = 0.5, μ_e = 0.7: contact time 0.0045 s, as the paper may have run it",
        f"{OBLIQUE_MAP} disc-oblique-svk oblique", f"{OBLIQUE_MAP} disc-oblique-svk/force")
def oblique_time(results: Results) -> tuple[str, str]:
    """As ball_time(), at 60 degrees from the plane. The words also report 30 degrees."""
    rows, neo = results.table(OBLIQUE_MAP), finished(results, "oblique")
    other = _met(rows[(rows.exit == 0) & (rows.angle == OTHER) & rows.breakdown_time.isna()], OBLIQUE_MAP)
    contact_times = {nu: bar(neo, "contact_time", nu=nu) for nu in neo.nu}
    converged = ", ".join(f"{1e3 * time:.2f} ± {1e3 * error:.2f} ms (ν = {nu:g})" for nu, (time, error) in contact_times.items())
    return _over_meshes(OBLIQUE_MAP, rows[rows.angle == ANGLE], f"At {OTHER:g}° from the plane it is met on {_where(other)}. (The run of "
                        f"disc-oblique-svk: {both_times(results.summary('disc-oblique-svk'))}; the neo-Hookean disc, another law, "
                        f"converges to {converged}.)")


@states("Section 3.3", "the 2D disc at 8 m/s: contact time 0.0048 s", f"{DISC_MAP} {DISC}", f"{DISC_MAP} {DISC}/force")
def disc_time(results: Results) -> tuple[str, str]:
    """Agrees if some (ν, k) of the map, with ellipticity kept, gives this time with SVK: the paper
    states neither."""
    rows, figure = finished(results, DISC_MAP), loaded(DISC_MAP).figure
    rows = rows[(rows.law == "svk") & rows.ellipticity_lost_time.isna()]
    met, above = ({nu: ranges for nu, ranges in sweep_figures.level_set(figure | {"colour": name}, rows).items() if ranges}
                  for name in ("contact_time", "thresholded_contact_time"))
    return graded(bool(met)), (
        f"with SVK met for {_each(met) or 'no ν and k'} [Pa/m] (the time above 1 % of the peak force for "
        f"{'ν = ' + ', '.join(f'{nu:g}' for nu in above) if above else 'no ν'}); the default run (ν = 0.45, k = 10¹⁰ Pa/m) gives "
        f"{both_times(results.summary(DISC))}.")


@states("Section 3.3, figure 10", "ball, SVK, 8 m/s: contact time 0.00603 s, as the paper may have run it: as a body of revolution",
        f"{BALL_MAP} {BALL} {BALL_NEO}", f"{BALL_MAP} {BALL}/force")
def ball_time(results: Results) -> tuple[str, str]:
    """Searches a map of (ν, k) on coarse meshes, as the paper states none of these.

    Agrees if some (ν, k) gives the time, to half a unit of its last digit, on every mesh with
    ellipticity kept. Partly if some (ν, k) gives it on some mesh only, or with ellipticity lost.
    Else it does not agree. Runs with det F ≤ 0 are not valid results.
    """
    return _over_meshes(BALL_MAP, results.table(BALL_MAP), f"(The run of {BALL}: {both_times(results.summary(BALL))}; the neo-Hookean "
                        f"ball, another law, converges to {both_times(results.summary(BALL_NEO))}.)")


@states("Section 3.3, figure 10", "ball, SVK, 8 m/s: contact time 0.00603 s, as the paper may have run it: in three dimensions",
        f"{SOLID_MAP} ball")
def ball_time_3d(results: Results) -> tuple[str, str]:
    """As ball_time(), on meshes of tetrahedra."""
    return _over_meshes(SOLID_MAP, results.table(SOLID_MAP), "(The neo-Hookean ball in three dimensions, another law, gives "
                        f"{both_times(results.summary('ball'))}.)")


def _over_meshes(name: str, every: pd.DataFrame, beside: str) -> tuple[str, str]:
    """Verdict and words for a printed time over a map on several meshes, from its rows `every`, by
    the criterion of ball_time()."""
    rows, meshes, time = every[every.exit == 0], every.mesh_size.unique(), loaded(name).figure["level"]
    whole = rows[rows.breakdown_time.isna()]  # no element is inverted
    met, sound = _met(whole, name), _met(whole[whole.ellipticity_lost_time.isna()], name)
    independent = [nu for nu in rows.nu.unique() if _shared(*(sound.get((h, nu), []) for h in meshes))]
    nearest = whole.loc[(whole.contact_time - time).abs().idxmin()] if len(whole) else None
    same = "" if nearest is None else f"; nearest ν = {nearest.nu:g}, k = {nearest.penalty:.2g} Pa/m: " + ", ".join(
        f"{1e3 * row.contact_time:.3f} ms on {1e3 * row.mesh_size:g} mm ({when(row.ellipticity_lost_time, 'ellipticity lost')}, "
        f"{when(row.breakdown_time, 'det F ≤ 0')})"
        for row in rows[(rows.nu == nearest.nu) & (rows.penalty == nearest.penalty)].itertuples())
    everywhere = "ν = " + ", ".join(f"{nu:g}" for nu in independent) if independent else "no ν and k: the number is not mesh-independent"
    return graded(bool(independent), bool(met)), (
        f"of {len(rows)} runs over ν, k and mesh {len(rows) - len(whole)} invert elements (det F ≤ 0). Between the others it is met on "
        f"{_where(met)}; with ellipticity kept on {_where(sound)}; so on all meshes for {everywhere}{same}. {beside}")


def _met(rows: pd.DataFrame, name: str) -> dict[tuple[float, float], Ranges]:
    """The ranges of k that give the paper's contact time, for each (mesh size, ν) of a map for
    which they exist."""
    figure = loaded(name).figure
    return {(h, nu): ranges for h, group in rows.groupby("mesh_size", sort=False)
            for nu, ranges in sweep_figures.level_set(figure, group).items() if ranges}


def _shared(*lists: Ranges) -> Ranges:
    """The values of k that are in a range of every list."""
    parts = [(max(low for low, _ in chosen), min(high for _, high in chosen)) for chosen in product(*lists)]
    return [(low, high) for low, high in parts if low <= high]


def _where(met: dict[tuple[float, float], Ranges]) -> str:
    """The meshes, ν and k of `_met` in words."""
    words = []
    for h in dict.fromkeys(h for h, _ in met):
        every = {nu: ranges for (mesh, nu), ranges in met.items() if mesh == h}
        ends = [k for ranges in every.values() for interval in ranges for k in interval]
        words.append(f"{1e3 * h:g} mm (ν = {', '.join(f'{nu:g}' for nu in every)}, k = {min(ends):.2g} to {max(ends):.2g} Pa/m)")
    return ", ".join(words) or "no mesh"


def _each(met: dict[float, Ranges]) -> str:
    """The ranges of k for each ν, in words."""
    return "; ".join(f"ν = {nu:g}: k = {sweep_figures.spans(ranges)}" for nu, ranges in met.items())


# ---- all contact times, all maps

@states("Sections 3.1, 3.3", "one material and one contact for all: with the same ν and k 4.8 ms of the disc, 4.5 ms of the oblique disc, "
        "6.03 ms of the ball", " ".join(EVERY))
def at_once(results: Results) -> tuple[str, str]:
    """Searches the ν that all maps have for a k with all three times, with SVK, with the angle from
    the plane or from the normal.

    A time is reproduced if it lies, to half a unit of its last digit, within the error bar of the
    runs or, on coarse meshes, between them. Agrees if some (ν, k) gives all three with ellipticity
    kept; partly if some does with ellipticity lost; else it does not agree.
    """
    whole, sound = ({angle: _joint(results, angle, kept) for angle in (ANGLE, OTHER)} for kept in (False, True))
    met, kept = ({angle: _onset(maps) for angle, maps in maps_by_angle.items()} for maps_by_angle in (whole, sound))
    words = []
    for angle, maps in whole.items():
        nearest = min(maps, key=lambda entry: entry.miss, default=None)
        words.append(f"oblique at {angle:g}°: " + (f"all three for {_each(met[angle])}" if met[angle] else "no ν and k for all three") + (
            f"; nearest ν = {nearest.nu:g}, k = {nearest.k:.2g} Pa/m: {', '.join(nearest.times)}, off by up to {100 * nearest.miss:.1f} %"
            if nearest else ""))
    by_number = {name: _onset(_joint(results, ANGLE, False, [name])) for name in MAPS}
    alone = ". ".join(f"{name}: {_each(intervals) or 'nowhere'}" for name, intervals in by_number.items())
    both = {pair: {nu: shared for nu in by_number[pair[0]] if (shared := _shared(*(by_number[name].get(nu, []) for name in pair)))}
            for pair in combinations(MAPS, 2)}
    pairs = ". ".join(f"{first} and {second}: {_each(intervals) or 'nowhere'}" for (first, second), intervals in both.items())
    return graded(any(kept.values()), any(met.values())), (
        f"{'. '.join(words)}. Two at once, oblique at {ANGLE:g}° [Pa/m]: {pairs}. Each alone: {alone}.")


class Together(NamedTuple):
    """For a ν of all maps: the ranges `met` of k [Pa/m] with all times; the k with the smallest
    miss; this relative miss; the times at this k."""

    nu: float
    met: Ranges
    k: float
    miss: float
    times: list[str]


def _joint(results: Results, angle: float, kept: bool, names: Iterable[str] = MAPS) -> list[Together]:
    """Evaluates the maps of these times together over the k that they share. `kept`: only from runs
    that keep ellipticity."""
    maps = {name: _between(results, name, angle, kept) for name in names}
    entries = []
    for nu in sorted(set.intersection(*(set(table) for table in maps.values()))):
        low, high = max(table[nu].index[0] for table in maps.values()), min(table[nu].index[-1] for table in maps.values())
        if low < high:
            k = np.geomspace(low, high, FINE)
            bounds = {name: _bounds(k, table[nu]) for name, table in maps.items()}
            worst = np.max([_miss(name, *pair) for name, pair in bounds.items()], axis=0)
            best = int(np.argmin(worst))
            times = [f"{name} {1e3 * smallest[best]:.2f} to {1e3 * largest[best]:.2f} ms" for name, (smallest, largest) in bounds.items()]
            entries.append(Together(nu, sweep_figures.ranges(k, worst <= 0), float(k[best]), float(worst[best]), times))
    return entries


def _onset(maps: list[Together]) -> dict[float, Ranges]:
    """The ranges of k for each ν that gives all times."""
    return {entry.nu: entry.met for entry in maps if entry.met}


def _miss(name: str, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """The relative distance of the paper's time, known to half a unit of its last digit, from the
    interval low to high; 0 inside."""
    figure = loaded(MAPS[name][0]).figure
    return np.maximum(0, np.maximum(low - figure["level"], figure["level"] - high) - figure["band"]) / figure["level"]


def _bounds(k: np.ndarray, table: pd.DataFrame) -> tuple[np.ndarray, np.ndarray]:
    """The smallest and largest times of _between() at k, interpolated in the logarithm of k."""
    return tuple(np.interp(np.log(k), np.log(table.index), table[name]) for name in ("low", "high"))


def _between(results: Results, number: str, angle: float, kept: bool) -> dict[float, pd.DataFrame]:
    """The smallest and largest contact time, `low` and `high`, over the runs on all meshes with
    error bars, by k.

    There is a table for each ν of the maps of a contact time with two values of k or more.
    """
    parts = []
    for name in MAPS[number]:
        rows = finished(results, name)
        for column, value in (("law", "svk"), ("angle", angle)):
            rows = rows[rows[column] == value] if column in rows else rows
        rows = rows[rows.breakdown_time.isna()] if "breakdown_time" in rows else rows
        rows = rows[rows.ellipticity_lost_time.isna()] if kept else rows
        error = np.nan_to_num(sweep_figures.bars(rows, "contact_time"))
        parts.append(rows.assign(low=rows.contact_time - error, high=rows.contact_time + error))
    groups = {nu: group.groupby("penalty").agg({"low": "min", "high": "max"}) for nu, group in pd.concat(parts).groupby("nu")}
    return {nu: table for nu, table in groups.items() if len(table) > 1}


@states("Section 3.3", "the contact time is always larger of the ball when the laws are similar", laws="{}.",
        runs=f"{DISC_MAP} {BALL_MAP} {SOLID_MAP} {DISC} {BALL} {DISC_NEO} {BALL_NEO}", lost=lost(DISC, BALL))
def always_longer(results: Results, law: str) -> tuple[bool, str]:
    """With a law for both bodies: whether the contact of the ball is longer than that of the disc
    at 8 m/s.

    The times are contact_time and the time above 1 % of the peak force; for SVK also all ν and k
    that both maps have.
    """
    disc, ball = (results.summary(name) for name in ((DISC, BALL) if law == "svk" else (DISC_NEO, BALL_NEO)))
    longer = all(ball[key] > disc[key] for key in ("contact_time", "thresholded_contact_time"))
    words = f"ball {both_times(ball)}, disc {both_times(disc)}"
    if law != "svk":
        return longer, words
    least = _least_excess(results)
    return longer and bool(least) and min(least.values()) > 0, words + "; over the maps, at least " + ", ".join(
        f"{1e3 * excess:+.2f} ms (ν = {nu:g})" for nu, excess in least.items())


def _least_excess(results: Results) -> dict[float, float]:
    """The least difference [s] between the contact times of ball and disc over k, error bars and
    meshes, for each ν of both maps."""
    disc, ball = (_between(results, name, ANGLE, False) for name in ("disc", "ball"))
    excess = {}
    for nu in sorted(set(disc) & set(ball)):
        k = np.geomspace(max(disc[nu].index[0], ball[nu].index[0]), min(disc[nu].index[-1], ball[nu].index[-1]), FINE)
        excess[nu] = float((_bounds(k, ball[nu])[0] - _bounds(k, disc[nu])[1]).min())
    return excess
