"""Sections 3.1 and 3.3: the contact times that the paper prints, each over maps of the nu and k that it does not state, and all of them at
once.

A map is a sweep over nu and k, for those that lose ellipticity on several coarse meshes; what lies between its runs is interpolated in the
logarithm of k. Runs with det F <= 0 are no answers.
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
MAPS = {"disc": (DISC_MAP,), "oblique disc": (OBLIQUE_MAP,), "ball": (BALL_MAP, SOLID_MAP)}   # of each number of the paper
EVERY = [name for maps in MAPS.values() for name in maps]
ANGLE, OTHER = 60.0, 30.0   # degrees from the plane: normal incidence is pi/2 in the paper; and what pi/3 from the normal would be
FINE = 400                  # values of k between those of the runs
Ranges = list[tuple[float, float]]


# ---- one number, one map

@states("Section 3.1", "oblique disc, SVK, 12 m/s at π/3, μ_d = 0.5, μ_e = 0.7: contact time 0.0045 s, as the paper may have run it",
        f"{OBLIQUE_MAP} disc-oblique-svk oblique", f"{OBLIQUE_MAP} disc-oblique-svk/force")
def oblique_time(results: Results) -> tuple[str, str]:
    """As the ball's time, at 60 degrees from the plane; 30 degrees stand beside."""
    rows, neo = results.table(OBLIQUE_MAP), finished(results, "oblique")
    other = _met(rows[(rows.exit == 0) & (rows.angle == OTHER) & rows.breakdown_time.isna()], OBLIQUE_MAP)
    found = {nu: bar(neo, "contact_time", nu=nu) for nu in neo.nu}
    converged = ", ".join(f"{1e3 * time:.2f} ± {1e3 * error:.2f} ms (ν = {nu:g})" for nu, (time, error) in found.items())
    return _over_meshes(OBLIQUE_MAP, rows[rows.angle == ANGLE], f"At {OTHER:g}° from the plane it is met on {_where(other)}. (The run of "
                        f"disc-oblique-svk: {both_times(results.summary('disc-oblique-svk'))}; the neo-Hookean disc, another law, "
                        f"converges to {converged}.)")


@states("Section 3.3", "the 2D disc at 8 m/s: contact time 0.0048 s", f"{DISC_MAP} {DISC}", f"{DISC_MAP} {DISC}/force")
def disc_time(results: Results) -> tuple[str, str]:
    """Agrees where some (ν, k) of the map, with ellipticity kept, meet it with SVK: the paper states neither."""
    rows, given = finished(results, DISC_MAP), loaded(DISC_MAP).figure
    rows = rows[(rows.law == "svk") & rows.ellipticity_lost_time.isna()]
    met, above = ({nu: ranges for nu, ranges in sweep_figures.level_set(given | {"colour": name}, rows).items() if ranges}
                  for name in ("contact_time", "thresholded_contact_time"))
    return graded(bool(met)), (
        f"with SVK met for {_each(met) or 'no ν and k'} [Pa/m] (the time above 1 % of the peak force for "
        f"{'ν = ' + ', '.join(f'{nu:g}' for nu in above) if above else 'no ν'}); the default run (ν = 0.45, k = 10¹⁰ Pa/m) gives "
        f"{both_times(results.summary(DISC))}.")


@states("Section 3.3, figure 10", "ball, SVK, 8 m/s: contact time 0.00603 s, as the paper may have run it: as a body of revolution",
        f"{BALL_MAP} {BALL} {BALL_NEO}", f"{BALL_MAP} {BALL}/force")
def ball_time(results: Results) -> tuple[str, str]:
    """Over a map of (ν, k) on coarse meshes, as the paper states none of these: agrees where some (ν, k) meets it, to half a unit of its
    last digit, on every mesh with ellipticity kept; partly where one meets it on some mesh only, or with ellipticity lost; else not. Runs
    with det F ≤ 0 are no answers."""
    return _over_meshes(BALL_MAP, results.table(BALL_MAP), f"(The run of {BALL}: {both_times(results.summary(BALL))}; the neo-Hookean "
                        f"ball, another law, converges to {both_times(results.summary(BALL_NEO))}.)")


@states("Section 3.3, figure 10", "ball, SVK, 8 m/s: contact time 0.00603 s, as the paper may have run it: in three dimensions",
        f"{SOLID_MAP} ball")
def ball_time_3d(results: Results) -> tuple[str, str]:
    """As the ball's time as a body of revolution, on meshes of tetrahedra."""
    return _over_meshes(SOLID_MAP, results.table(SOLID_MAP), "(The neo-Hookean ball in three dimensions, another law, gives "
                        f"{both_times(results.summary('ball'))}.)")


def _over_meshes(name: str, every: pd.DataFrame, beside: str) -> tuple[str, str]:
    """A printed time over a map on several meshes, from the rows `every` of it, by the rule of ball_time()."""
    rows, meshes, time = every[every.exit == 0], every.mesh_size.unique(), loaded(name).figure["level"]
    whole = rows[rows.breakdown_time.isna()]      # in which no element is inverted
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
    """For each (mesh size, ν) of a map that meets the paper's contact time, the ranges of k that do."""
    figure = loaded(name).figure
    return {(h, nu): ranges for h, group in rows.groupby("mesh_size", sort=False)
            for nu, ranges in sweep_figures.level_set(figure, group).items() if ranges}


def _shared(*each: Ranges) -> Ranges:
    """The k that are in a range of every list."""
    parts = [(max(low for low, _ in chosen), min(high for _, high in chosen)) for chosen in product(*each)]
    return [(low, high) for low, high in parts if low <= high]


def _where(met: dict[tuple[float, float], Ranges]) -> str:
    """The meshes, ν and k that `_met` found, in words."""
    words = []
    for h in dict.fromkeys(h for h, _ in met):
        every = {nu: ranges for (mesh, nu), ranges in met.items() if mesh == h}
        ends = [k for ranges in every.values() for each in ranges for k in each]
        words.append(f"{1e3 * h:g} mm (ν = {', '.join(f'{nu:g}' for nu in every)}, k = {min(ends):.2g} to {max(ends):.2g} Pa/m)")
    return ", ".join(words) or "no mesh"


def _each(met: dict[float, Ranges]) -> str:
    """The ranges of k for each ν, in words."""
    return "; ".join(f"ν = {nu:g}: k = {sweep_figures.spans(ranges)}" for nu, ranges in met.items())


# ---- all numbers, all maps

@states("Sections 3.1, 3.3", "one material and one contact for all: with the same ν and k 4.8 ms of the disc, 4.5 ms of the oblique disc, "
        "6.03 ms of the ball", " ".join(EVERY))
def at_once(results: Results) -> tuple[str, str]:
    """On the ν that all maps have, with SVK, the angle from the plane or the normal. A number is met where it lies, to half a unit of its
    last digit, within the error bar of the runs, or, on coarse meshes, between them. Agrees where some (ν, k) meets all three with
    ellipticity kept; partly where one does whatever is lost; else not."""
    whole, sound = ({angle: _joint(results, angle, kept) for angle in (ANGLE, OTHER)} for kept in (False, True))
    met, kept = ({angle: _meeting(maps) for angle, maps in found.items()} for found in (whole, sound))
    words = []
    for angle, maps in whole.items():
        nearest = min(maps, key=lambda each: each.miss, default=None)
        words.append(f"oblique at {angle:g}°: " + (f"all three for {_each(met[angle])}" if met[angle] else "no ν and k for all three") + (
            f"; nearest ν = {nearest.nu:g}, k = {nearest.k:.2g} Pa/m: {', '.join(nearest.times)}, off by up to {100 * nearest.miss:.1f} %"
            if nearest else ""))
    each = {name: _meeting(_joint(results, ANGLE, False, [name])) for name in MAPS}
    alone = ". ".join(f"{name}: {_each(found) or 'nowhere'}" for name, found in each.items())
    both = {pair: {nu: shared for nu in each[pair[0]] if (shared := _shared(*(each[name].get(nu, []) for name in pair)))}
            for pair in combinations(MAPS, 2)}
    pairs = ". ".join(f"{first} and {second}: {_each(found) or 'nowhere'}" for (first, second), found in both.items())
    return graded(any(kept.values()), any(met.values())), (
        f"{'. '.join(words)}. Two at once, oblique at {ANGLE:g}° [Pa/m]: {pairs}. Each alone: {alone}.")


class Together(NamedTuple):
    """Of a ν of all maps: the ranges of k [Pa/m] that meet all numbers; the k that misses them by least, by what share of one, and the
    times there."""

    nu: float
    met: Ranges
    k: float
    miss: float
    times: list[str]


def _joint(results: Results, angle: float, kept: bool, names: Iterable[str] = MAPS) -> list[Together]:
    """The maps of these numbers at once, over the k that they share; kept: from runs alone that keep ellipticity."""
    maps = {name: _between(results, name, angle, kept) for name in names}
    found = []
    for nu in sorted(set.intersection(*(set(each) for each in maps.values()))):
        low, high = max(each[nu].index[0] for each in maps.values()), min(each[nu].index[-1] for each in maps.values())
        if low < high:
            k = np.geomspace(low, high, FINE)
            bounds = {name: _bounds(k, each[nu]) for name, each in maps.items()}
            worst = np.max([_miss(name, *each) for name, each in bounds.items()], axis=0)
            best = int(np.argmin(worst))
            times = [f"{name} {1e3 * least[best]:.2f} to {1e3 * most[best]:.2f} ms" for name, (least, most) in bounds.items()]
            found.append(Together(nu, sweep_figures.ranges(k, worst <= 0), float(k[best]), float(worst[best]), times))
    return found


def _meeting(maps: list[Together]) -> dict[float, Ranges]:
    """For each ν that meets the numbers, the ranges of k that do."""
    return {each.nu: each.met for each in maps if each.met}


def _miss(name: str, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """By what share of it the paper's time, known to half a unit of its last digit, is outside of what lies from low to high; 0 inside."""
    figure = loaded(MAPS[name][0]).figure
    return np.maximum(0, np.maximum(low - figure["level"], figure["level"] - high) - figure["band"]) / figure["level"]


def _bounds(k: np.ndarray, each: pd.DataFrame) -> tuple[np.ndarray, np.ndarray]:
    """The smallest and largest times of _between() at k, interpolated in its logarithm."""
    return tuple(np.interp(np.log(k), np.log(each.index), each[name]) for name in ("low", "high"))


def _between(results: Results, number: str, angle: float, kept: bool) -> dict[float, pd.DataFrame]:
    """For each ν of the maps of a number with two k or more: low and high, the smallest and the largest contact time of the runs on all
    meshes, error bars included, by k."""
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
    return {nu: each for nu, each in groups.items() if len(each) > 1}


@states("Section 3.3", "the contact time is always larger of the ball when the laws are similar", laws="{}.",
        runs=f"{DISC_MAP} {BALL_MAP} {SOLID_MAP} {DISC} {BALL} {DISC_NEO} {BALL_NEO}", lost=lost(DISC, BALL))
def always_longer(results: Results, law: str) -> tuple[bool, str]:
    """With a law for both: where the ball's is longer than the disc's at 8 m/s, by contact_time and by the time above 1 % of the peak
    force; with SVK for every ν and k that the maps of both have, too."""
    disc, ball = (results.summary(name) for name in ((DISC, BALL) if law == "svk" else (DISC_NEO, BALL_NEO)))
    longer = all(ball[key] > disc[key] for key in ("contact_time", "thresholded_contact_time"))
    words = f"ball {both_times(ball)}, disc {both_times(disc)}"
    if law != "svk":
        return longer, words
    least = _least_excess(results)
    return longer and bool(least) and min(least.values()) > 0, words + "; over the maps, at least " + ", ".join(
        f"{1e3 * excess:+.2f} ms (ν = {nu:g})" for nu, excess in least.items())


def _least_excess(results: Results) -> dict[float, float]:
    """For each ν of the maps of disc and ball by how much [s] the ball's contact is longer at least, over k, error bars and meshes."""
    disc, ball = (_between(results, name, ANGLE, False) for name in ("disc", "ball"))
    found = {}
    for nu in sorted(set(disc) & set(ball)):
        k = np.geomspace(max(disc[nu].index[0], ball[nu].index[0]), min(disc[nu].index[-1], ball[nu].index[-1]), FINE)
        found[nu] = float((_bounds(k, ball[nu])[0] - _bounds(k, disc[nu])[1]).min())
    return found
