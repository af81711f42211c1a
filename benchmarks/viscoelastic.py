"""Damped impacts of a ball and a disc.

The ball is a Kelvin-Voigt solid at low speed. Its 1 - e over v^(1/5), slope and coefficient are
compared with quasi-static theory (Kuwabara, Kono 1987; Brilliantov, Spahn, Hertzsch, Poeschel
1996). The same ball also has a Maxwell branch. The restitution and the contact time of the disc are
computed over the loss factor, and over the relaxation time of a Maxwell branch.

Quasi-static theory for the approach x: F = k (x^(3/2) + 3/2 A x^(1/2) x'), k = 4/3 E* R^(1/2), E* =
4 mu (lambda + mu)/(lambda + 2 mu), and

  1 - e = 1.730 A (k/m)^(2/5) v^(1/5) + O(A^2)

with A = (eta d/dmu + zeta d/dlambda) ln E*. Reason: Hertz' motion dissipates at the same rate as a
flat punch as wide as the contact, 2 b x'^2 (eta d/dmu + zeta d/dlambda) E*, because the elastic
energy is a minimum for a prescribed motion of the punch. Brilliantov et al. have A = zeta^2/(zeta +
2 eta) (1 - nu^2)(1 - 2 nu)/(E nu^2). This is the same for zeta/lambda = eta/mu, and 0 for zeta = 0.

A branch with modulus G and relaxation time tau dissipates in Hertz' motion, to first order in G,

  D = G (d/dmu - 2/3 d/dlambda) E* times the double integral of exp(-|t - s|/tau) min(b(t), b(s))
  x'(t) x'(s).

The branch acts on the deviator: the bulk modulus lambda + 2/3 mu does not relax. D follows from the
same punches with the half-widths b at the two times, since the displacement under a punch and the
bulge of the surface beside it do not depend on the moduli.
"""

import itertools
import math
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

from ffimpact.progress import in_turn
from ffimpact.report.figures import BLUE, GREEN, GREY, ORANGE, STYLE, save
from ffimpact.sweeps import study
from verification import commands

from . import page

YOUNG, NU, DENSITY, RADIUS = 7e6, 0.3, 1722.0, 0.05
MU, LAMBDA = YOUNG / (2 * (1 + NU)), YOUNG * NU / ((1 + NU) * (1 - 2 * NU))
MASS = DENSITY * 4 / 3 * math.pi * RADIUS**3
SPRING = 4 / 3 * YOUNG / (1 - NU**2) * math.sqrt(RADIUS)  # k [N/m^(3/2)]
TIME = 1e-4  # eta/mu, zeta/lambda [s]
RELAXES = (0.01 * MU, 0.005)  # G [Pa], tau [s] of the branch of the ball
KINDS = {"elastic": (0.0, 0.0), "both": (TIME * MU, TIME * LAMBDA), "shear": (TIME * MU, 0.0), "branch": RELAXES}
COLOURS, WORDS = {"both": BLUE, "shear": ORANGE}, {"both": "η/μ = ζ/λ", "shear": "η alone"}
SPEEDS = (1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0)  # [m/s]; sqrt(E/rho) is 64
# Largest speed that is compared with theory [m/s]. Up to this speed the contact is small (b/R <
# 0.04) and long.
SLOW = 1e-2
# Factor of the usual penalty. The energy stored in the penalty is not damped.
STIFF = 30.0
LOSSES = (0.0, 0.01, 0.03, 0.1, 0.3, 1.0)
# Relaxation time over the contact time without damping.
TIMES = (0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0)
BRANCH = 0.5  # modulus of the branch over mu
DISC = {"law": "neohookean", "nu": 0.45, "speed": 4.0, "young": YOUNG, "density": DENSITY, "radius": RADIUS, "fields": 0, "accuracy": 0.01}
# Permitted deviations: of 1 - e relative to theory, of its exponent from 1/5, and of the energy
# balance.
AGREE, STRAIGHT, CLOSED = 0.02, 0.005, 1e-9
LIMIT = 300.0  # longest time of a run [s]
BALL_FORMATS = {"viscous": "", "speed": "g", "b/R": ".4f", "T/own": ".1f", "1 - e": ".5f", "theory": ".5f", "off [%]": "+.1f",
                "first order": ".5f", "contact [ms]": ".3f", "theory [ms]": ".3f", "lost [%]": ".3f", "balance": ".0e"}
DISC_FORMATS = {"loss": "g", "tau/T": "g", "e": ".4f", "contact [ms]": ".3f", "lost [%]": ".2f", "balance": ".0e"}


def main(argv: list[str]) -> int:
    """Runs all missing impacts, prints the tables, writes viscoelastic.csv and .png.

    Returns 0 if slow balls agree with theory and all energy balances close.
    """
    parser = commands.command("viscoelastic", __doc__, page=True)
    options = parser.parse_args(argv)
    tables = [make(options.out) for make in in_turn("viscoelastic", (balls, discs))]
    draw(*tables, options.out / "viscoelastic.png")
    shown = {"": tables[0][list(BALL_FORMATS)], "disc": tables[1][list(DISC_FORMATS)]}
    return page.finish(options, pd.concat(tables), report(*tables), holds(*tables), argv,
                       "Damped impacts", shown, files="{csv,png}")


# ---- theory

def coefficient(eta: float, zeta: float) -> float:
    """The coefficient A [s]."""
    return eta * (1 / MU + 1 / (LAMBDA + MU) - 2 / (LAMBDA + 2 * MU)) + zeta * (1 / (LAMBDA + MU) - 1 / (LAMBDA + 2 * MU))


def brilliantov(eta: float, zeta: float) -> float:
    """The coefficient A of Brilliantov et al. 1996 [s], with their viscosities 2 eta of shear and
    zeta + 2 eta/3 of volume."""
    return zeta**2 / (zeta + 2 * eta) * (1 - NU**2) * (1 - 2 * NU) / (YOUNG * NU**2)


def first_order(a: float, speed: float) -> float:
    """1 - e to first order in A.

    This is (3 A/m v) times the integral of k x^(1/2) |x'| over the elastic motion, which is a beta
    function.
    """
    beta = math.gamma(0.6) * math.gamma(1.5) / math.gamma(2.1)
    return 3 * a * 0.4 * beta * 1.25**0.6 * (SPRING / MASS) ** 0.4 * speed**0.2


def impact(a: float, speed: float, steps: int = 4000) -> tuple[float, float]:
    """Restitution and contact time [s] of m x'' = -k (x^(3/2) + 3/2 A x^(1/2) x') until the force
    is 0, by the Runge-Kutta method."""
    unit = (1.25 * MASS * speed**2 / SPRING) ** 0.4 / speed
    rate, state, t = SPRING / MASS, np.array([0.0, speed]), 0.0

    def slope(y: np.ndarray) -> np.ndarray:
        x = max(y[0], 0.0)
        return np.array([y[1], -rate * (x**1.5 + 1.5 * a * math.sqrt(x) * y[1])])

    while t < unit or (state[0] > 0 and slope(state)[1] < 0):
        h = unit / steps
        first = slope(state)
        second = slope(state + h / 2 * first)
        third = slope(state + h / 2 * second)
        state, t = state + h / 6 * (first + 2 * second + 2 * third + slope(state + h * third)), t + h
    return -state[1] / speed, t


def lost_to_branch(speed: float, steps: int = 2000) -> float:
    """The share of its energy that the ball loses to the branch RELAXES.

    It is D for Hertz' motion x = x0 sin^(4/5), as x' = v (1 - (x/x0)^(5/2))^(1/2).
    """
    depth = (1.25 * MASS * speed**2 / SPRING) ** 0.4
    ends = np.linspace(0, math.pi, steps + 1)
    middle, x = (ends[1:] + ends[:-1]) / 2, depth * np.abs(np.sin(ends)) ** 0.8
    pace = 0.8 * depth / speed * np.sin(middle) ** -0.2 * math.pi / steps
    t, increments, width = np.cumsum(pace) - pace / 2, np.diff(x), np.sqrt(RADIUS * depth * np.sin(middle) ** 0.8)
    kernel = np.exp(-np.abs(t[:, None] - t) / RELAXES[1]) * np.minimum(width[:, None], width)
    of_deviator = coefficient(RELAXES[0], -2 / 3 * RELAXES[0])
    return YOUNG / (1 - NU**2) * of_deviator * increments @ kernel @ increments / (MASS * speed**2 / 2)


def theory(kind: str, speed: float) -> tuple[float, float]:
    """1 - e and contact time [s] of a ball of the kind `kind`."""
    if kind == "branch":
        return 1 - math.sqrt(1 - lost_to_branch(speed)), impact(0, speed)[1]
    e, contact = impact(coefficient(*KINDS[kind]), speed)
    return 1 - e if kind != "elastic" else 0.0, contact


# ---- the runs

def damping(kind: str) -> dict:
    """The entries of a ball of the kind `kind`."""
    first, second = (float(f"{value:.6g}") for value in KINDS[kind])
    return {"branches": [[first, second]]} if kind == "branch" else {"viscosity": first, "bulk_viscosity": second}


def balls(out: Path) -> pd.DataFrame:
    """A row for each kind and speed."""
    bar = math.sqrt(YOUNG / DENSITY)
    base = {"law": "neohookean", "young": YOUNG, "nu": NU, "density": DENSITY, "fields": 0, "accuracy": 0.002}
    cases = list(itertools.product(KINDS, SPEEDS))
    points = [{"speed": speed, "penalty": float(f"{STIFF * YOUNG * 200 / math.pi / (1.31 * RADIUS * (speed / bar) ** 0.4):.4g}")}
              | damping(kind) for kind, speed in cases]
    table, rows = study.study(points, out / "ball", base, LIMIT, "ball-axisymmetric"), []
    period = 2 * math.pi * RADIUS / 2.65 / math.sqrt(MU / DENSITY)
    for (kind, speed), (_, run) in zip(cases, table.iterrows()):
        expected, contact = theory(kind, speed)
        width, lost = math.sqrt(RADIUS * (1.25 * MASS * speed**2 / SPRING) ** 0.4), 1 - run.restitution
        row = {"viscous": kind, "speed": speed, "b/R": width / RADIUS, "T/own": contact / period, "theory": expected,
               "first order": first_order(coefficient(*KINDS[kind]), speed) if kind in COLOURS else math.nan, "theory [ms]": 1e3 * contact}
        row |= measured(run) | {"contact [ms]": 1e3 * run.contact_time, "1 - e": lost}
        rows.append(row | {"off [%]": 100 * (lost / expected - 1) if expected else math.nan})
    return pd.DataFrame(rows)


def discs(out: Path) -> pd.DataFrame:
    """A row for each loss factor and each relaxation time."""
    viscous = study.study([{"loss": loss, "loss_model": "kelvin-voigt"} for loss in LOSSES], out / "disc", DISC, LIMIT)
    contact = viscous.thresholded_contact_time.iloc[0]
    mu = YOUNG / (2 * (1 + DISC["nu"]))
    points = [{"branches": [[float(f"{BRANCH * mu:.6g}"), float(f"{share * contact:.4g}")]]} for share in TIMES]
    relaxing = study.study(points, out / "disc", DISC, LIMIT)
    rows = [{"loss": loss} | measured(run) for loss, (_, run) in zip(LOSSES, viscous.iterrows())]
    rows += [{"tau/T": share} | measured(run) for share, (_, run) in zip(TIMES, relaxing.iterrows())]
    return pd.DataFrame(rows)


def measured(run: pd.Series) -> dict[str, float]:
    """The columns that both tables have in common."""
    work = run.get("viscous_work", 0.0)
    return {"e": run.restitution, "contact [ms]": 1e3 * run.thresholded_contact_time, "balance": run.energy_drift, "exit": run.exit,
            "lost [%]": 100 * (0.0 if pd.isna(work) else work) / run.energy_initial, "warnings": run.warnings}


# ---- report

def exponents(ball: pd.DataFrame) -> dict[str, float]:
    """The exponents of 1 - e in v for slow impacts, by kind."""
    slow = {kind: ball[(ball.viscous == kind) & (ball.speed <= SLOW)] for kind in COLOURS}
    return {kind: float(np.polyfit(np.log(rows.speed), np.log(rows["1 - e"]), 1)[0]) for kind, rows in slow.items()}


def holds(ball: pd.DataFrame, disc: pd.DataFrame) -> bool:
    """Whether 1 - e of slow balls and its exponent agree with theory, and every energy balance
    closes."""
    slow = ball[(ball.viscous != "elastic") & (ball.speed <= SLOW)]
    return bool((slow["off [%]"].abs() <= 100 * AGREE).all()
                and all(abs(exponent - 0.2) <= STRAIGHT for exponent in exponents(ball).values())
                and (pd.concat([ball, disc]).balance < CLOSED).all())


def report(ball: pd.DataFrame, disc: pd.DataFrame) -> str:
    """The report: tables, findings and verdict."""
    slow, fits = ball[(ball.viscous != "elastic") & (ball.speed <= SLOW)], exponents(ball)
    least, largest = disc.loc[disc["tau/T"].notna(), "e"].idxmin(), max(disc.balance.max(), ball.balance.max())
    ours, theirs = ([function(*KINDS[kind]) for kind in COLOURS] for function in (coefficient, brilliantov))
    off, fitted = slow["off [%]"], ", ".join(f"{fit:.4f} ({kind})" for kind, fit in fits.items())
    branch = ball[(ball.viscous == "branch") & (ball.speed <= SLOW)]
    peak = branch.loc[branch["1 - e"].idxmax()]
    lines = [
        f"Ball of revolution on a rigid plane, neo-Hookean, E = {1e-6 * YOUNG:g} MPa, nu = {NU:g}, R = {RADIUS:g} m, penalty {STIFF:g}",
        f"times the usual one. viscous: none (elastic), eta/mu = zeta/lambda = {TIME:g} s (both), eta alone (shear), a Maxwell branch of",
        f"{RELAXES[0] / MU:g} mu and {1e3 * RELAXES[1]:g} ms (branch; its theory is of first order in G). Theory of the others:",
        f"quasi-static, F = k (x^(3/2) + 3/2 A x^(1/2) x'), integrated; A = {ours[0]:.3g} s (both), {ours[1]:.3g} s (shear). That of Brilliantov",
        f"et al. 1996 is {theirs[0]:.3g} and {theirs[1]:.3g} s: the same where both viscosities go with the moduli; without the second one it",
        "says that nothing is lost, which the runs refute (the head of benchmarks/viscoelastic.py derives A).", "",
        "- b/R: Hertz' half-width; T/own: contact time over the period of the ball's first mode.",
        "- first order: 1.730 A (k/m)^(2/5) v^(1/5); lost: viscous_work over the energy at the start.", "",
        study.table(ball, BALL_FORMATS), "",
        f"- Range of the theory: up to {SLOW:g} m/s, b/R = {slow['b/R'].max():.3f} and {slow['T/own'].min():.0f} periods; there 1 - e is",
        f"  off by {off.min():+.1f} to {off.max():+.1f} %, and grows as v to the {fitted}.",
        "- Beyond, the contact is not small: a ball is stiffer than Hertz' half-space, as contact times say, and strains are finite.",
        f"- The branch takes most at {peak.speed:g} m/s, where the contact lasts {peak['contact [ms]'] / 1e3 / RELAXES[1]:.1f} tau.", "",
        f"Disc, neo-Hookean, nu = {DISC['nu']:g}, {DISC['speed']:g} m/s: over loss, tan delta of shear at its first mode; over tau of a",
        f"Maxwell branch of {BRANCH:g} mu, T the contact time without it (above 1 % of the peak force, as in the table).", "",
        study.table(disc, DISC_FORMATS), "",
        f"- A Maxwell branch takes most at tau = {disc['tau/T'][least]:g} T (e = {disc.e[least]:.3f}); far below it flows, far above it is",
        "  a spring, and the contact is shorter.",
        f"- Warnings: {study.warned(pd.concat([ball, disc]).warnings) or 'none'}.", "",
        f"Slow balls agree with quasi-static theory to {100 * AGREE:g} % of 1 - e, its exponent to {STRAIGHT:g} of 1/5, and every balance",
        f"of energy closes to {CLOSED:g} (largest {largest:.0e}): the requirement {'holds' if holds(ball, disc) else 'FAILS'}."]
    return "\n".join(lines)


def draw(ball: pd.DataFrame, disc: pd.DataFrame, path: Path) -> None:
    """Draws 1 - e of the ball over v^(1/5), and with the branch over v.

    Further panels show restitution and contact time of the disc over loss factor and relaxation
    time.
    """
    with plt.rc_context(STYLE):
        figure, ((viscous, branch), discs) = plt.subplots(2, 2, figsize=(9, 6.8))
        speeds = np.geomspace(min(SPEEDS), max(SPEEDS), 40)
        for kind, colour in COLOURS.items():
            rows, a = ball[ball.viscous == kind], coefficient(*KINDS[kind])
            viscous.plot(speeds**0.2, [first_order(a, v) for v in speeds], color=colour, linewidth=1, linestyle=":")
            viscous.plot(speeds**0.2, [1 - impact(a, v, 400)[0] for v in speeds], color=colour, linewidth=1)
            viscous.plot(rows.speed**0.2, rows["1 - e"], "o", color=colour, markersize=4, label=WORDS[kind])
        elastic, rows = (ball[ball.viscous == kind] for kind in ("elastic", "branch"))
        viscous.plot(elastic.speed**0.2, elastic["1 - e"], "s", color=GREEN, markersize=3, label="elastic")
        viscous.set(xlabel="$v^{1/5}$ [(m/s)$^{1/5}$]", title="ball; lines: quasi-static theory, dotted: first order")
        branch.semilogx(speeds, [theory("branch", v)[0] for v in speeds], color=BLUE, linewidth=1, label="theory, first order in G")
        branch.semilogx(rows.speed, rows["1 - e"], "o", color=BLUE, markersize=4, label="runs")
        branch.set(xlabel="$v$ [m/s]", ylim=(0, None), title=f"ball, Maxwell branch of {RELAXES[0] / MU:g} μ, {1e3 * RELAXES[1]:g} ms")
        for panel in (viscous, branch):
            panel.set_ylabel("$1 - e$")
            low, high = panel.get_xlim()
            panel.axvspan(SLOW**(0.2 if panel is viscous else 1), high, color=GREY, alpha=0.15, linewidth=0, label="contact no longer small")
            panel.set_xlim(low, high)
            panel.legend()
        for panel, x, words in zip(discs, ("loss", "tau/T"), ("loss factor tan δ", "relaxation time / contact time")):
            rows, beside = disc[disc[x].notna()], panel.twinx()
            panel.plot(rows[x], rows.e, "o-", color=BLUE, markersize=4)
            beside.plot(rows[x], rows["contact [ms]"], "s--", color=ORANGE, markersize=3)
            panel.set_xscale("symlog", linthresh=0.01) if x == "loss" else panel.set_xscale("log")
            panel.set(xlabel=words, title="disc, Kelvin–Voigt" if x == "loss" else f"disc, Maxwell branch of {BRANCH:g} μ")
            panel.set_ylabel("restitution $e$", color=BLUE)
            beside.set_ylabel("contact time [ms]", color=ORANGE)
            beside.spines["right"].set_visible(True)
            panel.axhline(disc.e.iloc[0], color=BLUE, linewidth=0.6, linestyle=":", label="$e$ without damping")
            panel.legend(loc="center", bbox_to_anchor=(0.3, 0.06) if x == "loss" else (0.5, 0.8))
        for panel in figure.axes[:4]:
            panel.grid(alpha=0.3)
        save(figure, path)
