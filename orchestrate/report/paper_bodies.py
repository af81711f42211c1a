"""Sections 3.2 and 3.3: the disc on the free block, the ball beside the discs, and what a constant energy says."""

from collections.abc import Callable
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd

from ..sweeps import sweep, sweep_figures
from .paper_judging import AGREES, CONSTANT, DIFFERS, PARTLY, Finding, History, Results, both_times, finished, of_both, states, total, when

BLOCK = {"svk": "disc-block", "neohookean": "disc-block-neohookean"}
MOMENTUM = 1e-8             # of the disc's momentum: below, that of both bodies is kept
DISC, DISC_NEO, BALL, BALL_NEO = "disc-normal", "disc-normal-neohookean", "ball-axisymmetric-svk", "ball-axisymmetric"
ACCELERATIONS = "-and-".join((DISC, DISC_NEO, BALL, BALL_NEO)) + ".png"   # make ball-comparison
STEPS, MAP = "conservation", "calibrate-ball"


@states("Section 3.2", "a disc at 10 m/s on a free block: the disc is reflected")
def rebounds(results: Results) -> Finding:
    """With a law: where its velocity upwards after the contact is more than the estimated error of it."""
    def of(name: str) -> tuple[bool, str]:
        (_, disc), _, error = _velocities(results, name)
        return disc > error, f"{disc:.2f} ± {error:.1g} m/s"
    return _on_block(of, "Upwards after the contact", ".", [results.picture(name, "velocity") for name in BLOCK.values()], results)


@states("Section 3.2", "the block is directed downwards")
def downwards(results: Results) -> Finding:
    """With a law: where momentum is kept and the block's velocity lies between those of bodies that stay together (restitution e = 0) and of
    an elastic impact (e = 1): -m v/(m + M) and twice that."""
    def of(name: str) -> tuple[bool, str]:
        (start, disc), block, error = _velocities(results, name)
        end = results.summary(name)
        m, M = end["mass_1"], end["mass_2"]
        together = m * start / (m + M)
        missing = abs((m * disc + M * block) / (m * start) - 1)
        return missing < MOMENTUM and 2 * together < block < together, (
            f"{block:.4f} ± {m / M * error:.1g} m/s, e = {(block - disc) / start:.3f} (between {together:.3f} for e = 0 and {2 * together:.3f} m/s for "
            f"e = 1; momentum kept to {missing:.0e})")
    return _on_block(of, "Upwards after the contact", ".", [results.picture("disc-block", "shapes")], results)


@states("Section 3.2, figure 9a", "the variation of the disc's energy, drawn and not described; judged here: in the contact the disc gives energy to the "
        "block, after it each keeps its own")
def passes(results: Results) -> Finding:
    """With a law: where the disc ends with less than at the start and the block with more, and each keeps kinetic and elastic energy
    together to 1e-9 of the start's in the flight after the last touch."""
    def of(name: str) -> tuple[bool, str]:
        history, end = results.history(name), results.summary(name)
        disc, block = (100 * (history[f"kinetic_{b}"] + history[f"elastic_{b}"]) / total(history)[0] for b in (1, 2))
        flight = slice(np.flatnonzero(history["normal_force"] > 0)[-1], None)
        after = max(np.ptp(own[flight]) if len(own[flight]) > 1 else np.inf for own in (disc, block)) / 100
        shares = [100 * end[f"vibration_energy_{b}"] / end["energy_initial"] for b in (1, 2)]
        return disc[-1] < disc[0] and block[-1] > block[0] and after < CONSTANT, (
            f"the disc keeps {disc[-1]:.1f} % ({shares[0]:.1f} % as vibration), the block has {block[-1]:.1f} % ({shares[1]:.1f} %), each constant to {after:.0e}; "
            f"in the contact the disc was down to {disc.min():.1f} %, at {1e3 * history['t'][disc.argmin()]:.0f} ms")
    return _on_block(of, "After the contact, of the energy at the start", ". After the contact kinetic and elastic energy of each go on to change into each other.",
                     [results.picture("disc-block", "energies")], results)


@states("Section 3.2, figure 9b", "the total energy of disc and block is constant", exact=True)
def total_energy(results: Results) -> Finding:
    """With a law: where kinetic, elastic and contact energy together change by less than 1e-9 of the start's over the whole run."""
    def of(name: str) -> tuple[bool, str]:
        history = results.history(name)
        moved = np.ptp(total(history)) / total(history)[0]
        return moved < CONSTANT, f"constant to {moved:.0e}, at most {100 * (history['contact'] / total(history)[0]).max():.1f} % of it in the contact"
    return _on_block(of, "Over the whole run", ".", [results.picture("disc-block", "energies")], results)


def _on_block(of: Callable[[str], tuple[bool, str]], before: str, after: str, figures: list[Path], results: Results) -> Finding:
    """What holds of the disc on the block with both laws; `of` gives (holds, words) of a run."""
    verdict, words = of_both(lambda law: of(BLOCK[law]))
    return Finding(verdict, f"{before}, {words}{after}", figures, [results.run(name) for name in BLOCK.values()],
                   [results.summary(BLOCK["svk"])["ellipticity_lost_time"]])


def _velocities(results: Results, name: str) -> tuple[tuple[float, float], float, float]:
    """Upward velocities [m/s] of the disc before and after, of the block after, and the estimated error of the disc's; nan if it is not known."""
    history, estimated = results.history(name), results.summary(name)["estimated_error"]
    start = history["vy_1"][0]
    return (start, history["vy_1"][-1]), history["vy_2"][-1], abs(start) * (estimated["rebound"] if estimated else np.nan)


@states("Sections 3.2, 3.3", "that the energy is constant tests the numerical convergence and the steps")
def converges(results: Results) -> Finding:
    """Agrees where with both schemes the drift of the energy falls with every smaller step, at least as its square root; partly where it does
    with BDF2 alone: energy-momentum conserves at any step, also where its answer has not converged."""
    rows, tells, words = finished(results, STEPS), {}, []
    for scheme, group in rows.groupby("integrator", sort=False):
        group = group.sort_values("dt", ascending=False)
        drift, dt = group.energy_drift.to_numpy(), group.dt.to_numpy()
        order = np.log(drift[0] / drift[-1]) / np.log(dt[0] / dt[-1]) if len(group) > 2 else -np.inf
        tells[scheme] = bool(order >= 0.5 and (np.diff(drift) < 0).all())
        words.append(f"{scheme}: drift {drift[0]:.0e} to {drift[-1]:.0e} (order {order:.1f}), rebound {group.rebound_vy.iloc[0]:.3f} to {group.rebound_vy.iloc[-1]:.3f} m/s")
    bdf2, own = (tells.get(scheme, False) for scheme in ("bdf2", "energy-momentum"))
    return Finding(AGREES if bdf2 and own else PARTLY if bdf2 else DIFFERS, f"from the step {1e6 * rows.dt.max():g} to {1e6 * rows.dt.min():g} μs on one mesh; {'; '.join(words)}. "
                   + ("" if own else "A scheme that conserves at any step says nothing of convergence by it: error bars here are from refined meshes and steps."),
                   results.drawn(STEPS), results.sweep_runs(STEPS), list(rows.ellipticity_lost_time))


@states("Section 3.3", "the 2D disc at 8 m/s: contact time 0.0048 s")
def disc_time(results: Results) -> Finding:
    """Agrees where some (ν, k) of the map, with ellipticity kept, meet it with SVK: the paper states neither."""
    rows, given = finished(results, "calibrate"), sweep.load("calibrate").figure
    rows = rows[(rows.law == "svk") & rows.ellipticity_lost_time.isna()]
    met, above = ({nu: ranges for nu, ranges in sweep_figures.level_set(given | {"colour": name}, rows).items() if ranges} for name in ("contact_time", "thresholded_contact_time"))
    text = "; ".join(f"ν = {nu:g}: k = {sweep_figures.spans(ranges)}" for nu, ranges in met.items())
    return Finding(AGREES if met else DIFFERS, f"with SVK met for {text or 'no ν and k'} [Pa/m] (the time above 1 % of the peak force for "
                   f"{'ν = ' + ', '.join(f'{nu:g}' for nu in above) if above else 'no ν'}); the default run (ν = 0.45, k = 10¹⁰ Pa/m) gives "
                   f"{both_times(results.summary(DISC))}.",
                   [*results.drawn("calibrate"), results.picture(DISC, "force")], results.sweep_runs("calibrate") + [results.run(DISC)])


@states("Section 3.3, figure 10", "normal impact of the ball, SVK, without friction: the energy is constant", exact=True)
def conserves(results: Results) -> Finding:
    """Agrees below 1e-9 of the energy at the start, with SVK."""
    drift = {name: results.summary(name)["energy_drift"] for name in (BALL, BALL_NEO, DISC)}
    return Finding(AGREES if drift[BALL] < CONSTANT else DIFFERS,
                   f"constant to {drift[BALL]:.0e} over the whole run (the neo-Hookean ball to {drift[BALL_NEO]:.0e}, the SVK disc to {drift[DISC]:.0e}).",
                   [results.picture(BALL, "energies")], [results.run(name) for name in drift], [results.summary(BALL)["ellipticity_lost_time"]])


@states("Section 3.3, figure 10", "ball, SVK, 8 m/s: contact time 0.00603 s, as the paper may have run it")
def ball_time(results: Results) -> Finding:
    """Over a map of (ν, k) on coarse meshes, as the paper states none of these: agrees where some (ν, k) meets it, to half a unit of its last digit, on every
    mesh with ellipticity kept; partly where one meets it on some mesh only, or with ellipticity lost; else not. Runs with det F ≤ 0 are no answers."""
    rows, meshes, time = finished(results, MAP), results.table(MAP).mesh_size.unique(), sweep.load(MAP).figure["level"]
    whole = rows[rows.breakdown_time.isna()]
    met, sound = _meeting(whole), _meeting(whole[whole.ellipticity_lost_time.isna()])
    independent = [nu for nu in rows.nu.unique() if _together([sound.get((h, nu), []) for h in meshes])]
    nearest = whole.loc[(whole.contact_time - time).abs().idxmin()] if len(whole) else None
    same = "" if nearest is None else f"; nearest ν = {nearest.nu:g}, k = {nearest.penalty:.2g}: " + ", ".join(
        f"{1e3 * row.contact_time:.3f} ms on {1e3 * row.mesh_size:g} mm ({when(row.ellipticity_lost_time, 'ellipticity lost')}, {when(row.breakdown_time, 'det F ≤ 0')})"
        for row in rows[(rows.nu == nearest.nu) & (rows.penalty == nearest.penalty)].itertuples())
    return Finding(AGREES if independent else PARTLY if met else DIFFERS,
                   f"of {len(rows)} runs over ν, k and mesh {len(rows) - len(whole)} invert elements (det F ≤ 0). Between the others it is met on {_where(met)}; with ellipticity kept "
                   f"on {_where(sound)}; so on all meshes for {'ν = ' + ', '.join(f'{nu:g}' for nu in independent) if independent else 'no ν and k: the number is not mesh-independent'}"
                   f"{same}. (The run of {BALL}: {both_times(results.summary(BALL))}; the neo-Hookean ball, another law, converges to {both_times(results.summary(BALL_NEO))}.)",
                   [*results.drawn(MAP), results.picture(BALL, "force")], [*results.sweep_runs(MAP), results.run(BALL), results.run(BALL_NEO)])


def _meeting(rows: pd.DataFrame) -> dict[tuple[float, float], list[tuple[float, float]]]:
    """For each (mesh size, ν) of the map of the ball that meets the paper's contact time, the ranges of k that do, between the runs interpolated."""
    figure = sweep.load(MAP).figure
    return {(h, nu): ranges for h, group in rows.groupby("mesh_size", sort=False) for nu, ranges in sweep_figures.level_set(figure, group).items() if ranges}


def _together(each: list[list[tuple[float, float]]]) -> bool:
    """Whether some k is in a range of every list."""
    return bool(each) and any(max(low for low, _ in chosen) <= min(high for _, high in chosen) for chosen in product(*each))


def _where(met: dict[tuple[float, float], list[tuple[float, float]]]) -> str:
    """The meshes, ν and k that `_meeting` found, in words."""
    words = []
    for h in dict.fromkeys(h for h, _ in met):
        every = {nu: ranges for (mesh, nu), ranges in met.items() if mesh == h}
        ends = [k for ranges in every.values() for each in ranges for k in each]
        words.append(f"{1e3 * h:g} mm (ν = {', '.join(f'{nu:g}' for nu in every)}, k = {min(ends):.2g} to {max(ends):.2g} Pa/m)")
    return ", ".join(words) or "no mesh"


@states("Section 3.3, figure 11", "of disc SVK, disc neo-Hookean and ball SVK at 8 m/s the ball's contact is the longest")
def longest(results: Results) -> Finding:
    """Agrees where the ball's is longer than both discs', by contact_time and by the time above 1 % of the peak force."""
    ends = {name: results.summary(name) for name in (DISC, DISC_NEO, BALL)}
    longer = all(ends[BALL][key] > max(ends[DISC][key], ends[DISC_NEO][key]) for key in ("contact_time", "thresholded_contact_time"))
    lost = ends[BALL]["ellipticity_lost_time"]
    return Finding(AGREES if longer else DIFFERS,
                   f"ball SVK {both_times(ends[BALL])}, {when(lost, 'ellipticity lost')}; disc SVK {both_times(ends[DISC])}, "
                   f"neo-Hookean {both_times(ends[DISC_NEO])}. (Neo-Hookean ball: {both_times(results.summary(BALL_NEO))}.)", [results.folder / ACCELERATIONS],
                   [results.run(name) for name in (*ends, BALL_NEO)], [ends[name]["ellipticity_lost_time"] for name in (DISC, BALL)])


@states("Sections 3.1, 3.3, figure 11", "the contact force is the integral of the acceleration times the density, A_CM its mean; "
        "the accelerations of disc SVK, disc neo-Hookean and ball SVK", exact=True)
def accelerations(results: Results) -> Finding:
    """Agrees where in all three runs and every step the contact force is the change of momentum over the step to 1e-8 of the largest force."""
    apart, words = [], []
    for name in (DISC, DISC_NEO, BALL):
        history = results.history(name)
        force, mass = history["normal_force"], _mass(history)
        apart.append(np.abs(np.diff(history["momentum_y"]) / history["dt"][1:] - force[1:]).max() / force.max())
        words.append(f"{name} {1e-3 * force.max() / mass:.2f} at {1e3 * history['t'][force.argmax()]:.2f} ms")
    return Finding(AGREES if max(apart) < MOMENTUM else DIFFERS,
                   f"force and change of momentum are the same to {max(apart):.0e}; largest acceleration [10³ m/s²]: {', '.join(words)}.",
                   [results.folder / ACCELERATIONS], [results.run(name) for name in (DISC, DISC_NEO, BALL)],
                   [results.summary(name)["ellipticity_lost_time"] for name in (DISC, BALL)])


def _mass(history: History) -> float:
    """Of the body [kg, in plane strain kg/m]."""
    return float(history["momentum_y"][0] / history["vy"][0])
