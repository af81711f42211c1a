"""Sections 3.2 and 3.3: the disc on the free block, the ball in space and beside discs, and the
meaning of a constant energy."""

import numpy as np

from ffimpact.output.results import mechanical_energy

from .judging import (
    CONSTANT,
    DIFFERS,
    Lost,
    Results,
    both_times,
    finished,
    graded,
    lost,
    states,
    when,
)

BLOCK = {"svk": "disc-block", "neohookean": "disc-block-neohookean"}
# Tolerance of momentum over the momentum of the disc; a smaller change counts as conserved.
MOMENTUM = 1e-8
DISC, DISC_NEO, BALL, BALL_NEO = "disc-normal", "disc-normal-neohookean", "ball-axisymmetric-svk", "ball-axisymmetric"
ACCELERATIONS = "-and-".join((DISC, DISC_NEO, BALL, BALL_NEO)) + ".png"  # make ball-comparison
# The same four runs, all with k = 1e10 Pa/m.
LIKE_FOR_LIKE = "same-penalty/" + ACCELERATIONS
STEPS, SOLID, SOLID_MAP = "conservation", "ball", "calibrate-ball-3d"
# Permitted difference between two runs of one ball besides their error estimates, as between two
# programs in V12.
SAME = 0.005
# Our results: (the name of their error estimate, unit).
SOLID_NUMBERS = {"impulse": ("impulse", "N s"), "rebound_vy": ("rebound", "m/s"),
                 "thresholded_contact_time": ("thresholded_contact_time", "s")}


ON_BLOCK = {"runs": " ".join(BLOCK.values()), "lost": lost(BLOCK["svk"])}


@states("Section 3.2", "a disc at 10 m/s on a free block: the disc is reflected",
        figures="disc-block/velocity disc-block-neohookean/velocity", laws="Upwards after the contact, {}.", **ON_BLOCK)
def rebounds(results: Results, law: str) -> tuple[bool, str]:
    """With a law: whether the velocity of the disc after contact, upwards, exceeds its error
    estimate."""
    (_, disc), _, error = _velocities(results, BLOCK[law])
    return disc > error, f"{disc:.2f} ± {error:.1g} m/s"


@states("Section 3.2", "the block is directed downwards", figures="disc-block/shapes", laws="Upwards after the contact, {}.", **ON_BLOCK)
def downwards(results: Results, law: str) -> tuple[bool, str]:
    """With a law: whether momentum is conserved and the velocity of the block is between those for
    restitution e = 0 and e = 1.

    These are -m v/(m + M), where the bodies stay together, and twice that, for an elastic impact.
    """
    (start, disc), block, error = _velocities(results, BLOCK[law])
    end = results.summary(BLOCK[law])
    m, M = end["mass_1"], end["mass_2"]
    together = m * start / (m + M)
    missing = abs((m * disc + M * block) / (m * start) - 1)
    return missing < MOMENTUM and 2 * together < block < together, (
        f"{block:.4f} ± {m / M * error:.1g} m/s, e = {(block - disc) / start:.3f} (between {together:.3f} for e = 0 and "
        f"{2 * together:.3f} m/s for e = 1; momentum kept to {missing:.0e})")


@states("Section 3.2, figure 9a", "the variation of the disc's energy, drawn and not described; judged here: in the contact the disc gives "
        "energy to the block, after it each keeps its own", figures="disc-block/energies", laws="After the contact, of the energy at the "
        "start, {}. After the contact kinetic and elastic energy of each go on to change into each other.", **ON_BLOCK)
def passes(results: Results, law: str) -> tuple[bool, str]:
    """With a law: whether the disc loses energy and the block gains energy over the run.

    In the flight after contact the kinetic and elastic energy of each body must be constant to 1e-9
    of the initial energy.
    """
    history, end = results.history(BLOCK[law]), results.summary(BLOCK[law])
    disc, block = (100 * (history[f"kinetic_{b}"] + history[f"elastic_{b}"]) / mechanical_energy(history)[0] for b in (1, 2))
    flight = slice(np.flatnonzero(history["normal_force"] > 0)[-1], None)
    after = max(np.ptp(own[flight]) if len(own[flight]) > 1 else np.inf for own in (disc, block)) / 100
    shares = [100 * end[f"vibration_energy_{b}"] / end["energy_initial"] for b in (1, 2)]
    return disc[-1] < disc[0] and block[-1] > block[0] and after < CONSTANT, (
        f"the disc keeps {disc[-1]:.1f} % ({shares[0]:.1f} % as vibration), the block has {block[-1]:.1f} % ({shares[1]:.1f} %), each "
        f"constant to {after:.0e}; in the contact the disc was down to {disc.min():.1f} %, at {1e3 * history['t'][disc.argmin()]:.0f} ms")


@states("Section 3.2, figure 9b", "the total energy of disc and block is constant", figures="disc-block/energies", exact=True,
        laws="Over the whole run, {}.", **ON_BLOCK)
def total_energy(results: Results, law: str) -> tuple[bool, str]:
    """With a law: whether kinetic, elastic and contact energy together are constant to 1e-9 of the
    initial value over the whole run."""
    history = results.history(BLOCK[law])
    energy = mechanical_energy(history)
    moved, largest = np.ptp(energy) / energy[0], (history["contact"] / energy[0]).max()
    return moved < CONSTANT, f"constant to {moved:.0e}, at most {100 * largest:.1f} % of it in the contact"


def _velocities(results: Results, name: str) -> tuple[tuple[float, float], float, float]:
    """Upward velocities [m/s] of the disc before and after contact, of the block after contact, and
    the error estimate for the disc, or nan."""
    history, estimated = results.history(name), results.summary(name)["estimated_error"] or {}
    start = history["vy_1"][0]
    return (start, history["vy_1"][-1]), history["vy_2"][-1], abs(start) * estimated.get("rebound", np.nan)


@states("Sections 3.2, 3.3", "that the energy is constant tests the numerical convergence and the steps", STEPS)
def converges(results: Results) -> tuple[str, str, Lost]:
    """Agrees if the energy drift of both schemes falls with every smaller step, at least as its
    square root.

    Partly if this holds for BDF2 only: energy-momentum conserves energy for any step, even if the
    result has not converged.
    """
    rows, tells, words = finished(results, STEPS), {}, []
    for scheme, group in rows.groupby("integrator", sort=False):
        group = group.sort_values("dt", ascending=False)
        drift, dt = group.energy_drift.to_numpy(), group.dt.to_numpy()
        order = np.log(drift[0] / drift[-1]) / np.log(dt[0] / dt[-1]) if len(group) > 2 else -np.inf
        tells[scheme] = bool(order >= 0.5 and (np.diff(drift) < 0).all())
        words.append(f"{scheme}: drift {drift[0]:.0e} to {drift[-1]:.0e} (order {order:.1f}), rebound {group.rebound_vy.iloc[0]:.3f} to "
                     f"{group.rebound_vy.iloc[-1]:.3f} m/s")
    bdf2, own = (tells.get(scheme, False) for scheme in ("bdf2", "energy-momentum"))
    text = "" if own else ("A scheme that conserves at any step says nothing of convergence by it: error bars here are from refined meshes "
                           "and steps.")
    text = f"from the step {1e6 * rows.dt.max():g} to {1e6 * rows.dt.min():g} μs on one mesh; {'; '.join(words)}. {text}"
    return graded(bdf2 and own, bdf2), text, list(rows.ellipticity_lost_time)


@states("Section 3.3, figure 10", "normal impact of the ball, SVK, without friction: the energy is constant", f"{BALL} {BALL_NEO} {DISC}",
        f"{BALL}/energies", lost(BALL), exact=True)
def conserves(results: Results) -> tuple[str, str]:
    """Agrees below 1e-9 of the initial energy for SVK."""
    ball, neo, disc = (results.summary(name)["energy_drift"] for name in (BALL, BALL_NEO, DISC))
    return graded(ball < CONSTANT), (
        f"constant to {ball:.0e} over the whole run (the neo-Hookean ball to {neo:.0e}, the SVK disc to {disc:.0e}).")


@states("Section 3.3", "the approach extends to three-dimensional bodies, and contact is modelled in an identical way",
        f"{SOLID} {BALL_NEO} {SOLID_MAP}", f"{SOLID}/shapes {SOLID}/force")
def in_space(results: Results) -> tuple[str, str]:
    """Agrees if ball and body of revolution (neo-Hookean) have the same impulse, rebound (over the
    speed) and time above 1 % of the peak.

    The tolerance is 0.5 % plus both error estimates. Every run in three dimensions, also with SVK
    on coarse meshes, must conserve energy to 1e-9. Partly if only the energy is conserved.
    """
    solid, plane = results.summary(SOLID), results.summary(BALL_NEO)
    coarse, words, same = finished(results, SOLID_MAP), [], []
    for name, (key, unit) in SOLID_NUMBERS.items():
        error = sum((end["estimated_error"] or {}).get(key, np.nan) for end in (solid, plane))
        apart = abs(solid[name] - plane[name]) / (results.scene(SOLID)["speed"] if key == "rebound" else abs(plane[name]))
        same.append(bool(apart <= SAME + error))
        words.append(f"{name.replace('_', ' ')} {solid[name]:.5g} and {plane[name]:.5g} {unit}, {100 * apart:.2f} % apart (errors together "
                     f"{100 * error:.2f} %)")
    drift = max(solid["energy_drift"], coarse.energy_drift.max() if len(coarse) else np.inf)
    return graded(all(same), True) if drift < CONSTANT else DIFFERS, (
        f"neo-Hookean, in three dimensions and as a body of revolution: {'; '.join(words)}. Energy constant to {drift:.0e} in all "
        f"{1 + len(coarse)} runs in three dimensions, {len(coarse)} of them with SVK on coarse meshes.")


BESIDE = {"figures": f"{ACCELERATIONS} {LIKE_FOR_LIKE}", "lost": lost(DISC, BALL)}


@states("Section 3.3, figure 11", "of disc SVK, disc neo-Hookean and ball SVK at 8 m/s the ball's contact is the longest",
        f"{DISC} {DISC_NEO} {BALL} {BALL_NEO}", **BESIDE)
def longest(results: Results) -> tuple[str, str]:
    """Agrees if the contact of the ball is longer than that of both discs, by contact_time and by
    the time above 1 % of the peak force."""
    disc, disc_neo, ball, ball_neo = (results.summary(name) for name in (DISC, DISC_NEO, BALL, BALL_NEO))
    return graded(all(ball[key] > max(disc[key], disc_neo[key]) for key in ("contact_time", "thresholded_contact_time"))), (
        f"ball SVK {both_times(ball)}, {when(ball['ellipticity_lost_time'], 'ellipticity lost')}; disc SVK {both_times(disc)}, "
        f"neo-Hookean {both_times(disc_neo)}. (Neo-Hookean ball: {both_times(ball_neo)}.)")


@states("Sections 3.1, 3.3, figure 11", "the contact force is the integral of the acceleration times the density, A_CM its mean; "
        "the accelerations of disc SVK, disc neo-Hookean and ball SVK", f"{DISC} {DISC_NEO} {BALL}", exact=True, **BESIDE)
def accelerations(results: Results) -> tuple[str, str]:
    """Agrees if in every step of all three runs the contact force is the change of momentum over
    the step, to 1e-8 of the largest force."""
    apart, words = [], []
    for name in (DISC, DISC_NEO, BALL):
        history = results.history(name)
        force, mass = history["normal_force"], history["momentum_y"][0] / history["vy"][0]
        apart.append(np.abs(np.diff(history["momentum_y"]) / history["dt"][1:] - force[1:]).max() / force.max())
        words.append(f"{name} {1e-3 * force.max() / mass:.2f} at {1e3 * history['t'][force.argmax()]:.2f} ms")
    return graded(max(apart) < MOMENTUM), (
        f"force and change of momentum are the same to {max(apart):.0e}; largest acceleration [10³ m/s²]: {', '.join(words)}.")
