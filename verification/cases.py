"""All cases of `make verify`. The tolerances were fixed before the cases were run."""

import tomllib
from collections.abc import Iterator
from pathlib import Path

from ffimpact.report.literature import REFERENCE

from .bars import bouncing, relaxing, two
from .blocks import blocks
from .case import Case, Row
from .cattaneo import annuli, shear
from .first_touch import forces, touches
from .hertz import ellipse, impacts, pressed
from .impact import bars, rigids
from .manufactured import in_space, in_time
from .measure import disc
from .oblique_ball import REBOUNDS, curve
from .rigid_disc import oblique
from .rod import rods
from .rubber import decays, membranes
from .sliding_block import block


def independent(folder: Path) -> Iterator[Row]:
    """V12: disc-normal and ball-axisymmetric for several values of `accuracy`.

    Expected are the converged results of NGSolve and GetFEM (reference/converged.toml).
    """
    for peers in tomllib.loads((REFERENCE / "converged.toml").read_text())["run"]:
        kind = peers["kind"]
        body = kind.partition("-")[0]
        for accuracy in (0.02, 0.005, 0.0025, 0.00125, 0.0006):
            summary = disc(folder, kind=kind, accuracy=accuracy, **peers["when"]).summary
            for key, words in (("contact_time", "contact time"), ("impulse", "impulse"), ("rebound_vy", "rebound")):
                yield Row(f"{body}: {words}", accuracy, summary[key], peers["numbers"][key]["value"])


CASES = (
    Case("V1 space", "manufactured motions at large strain, L² error of the displacement", "element size", 0.15, in_space,
         by_order=True, note="Both laws on the unit square, and on the disc and the ball (axisymmetric) with curved elements, energy-momentum steps so small "
                             "that only the error in space is seen."),
    Case("V1 time", "manufactured motions at large strain, L² error of the displacement", "time step", 0.15, in_time,
         by_order=True, note="A motion that P2 holds exactly, so that only the error in time is seen."),
    Case("V4", "bar on a wall: contact 2L/c, stress ρcv, restitution 1", "element size / length", 0.01, bars,
         note="v/c = 8·10⁻⁴, steps of half an element's transit. A second-order scheme smears the front over h^(2/3): the order "
              "to expect. The stress is the mean of the middle 80 % of the contact."),
    Case("V5", "clamped rod against a wall: contact in [1, 2], stress 1/2, period 3, energy 1/8", "element size / length", 0.01,
         rods, note="Compressed by 5·10⁻⁵, let go, scaled back to the linear rod; the finite strain leaves 5·10⁻⁵ in the energy."
                    " Penalty 1000 E/L. Mean stress: impulse over contact time; middle: t in [1.1, 1.9]."),
    Case("V6", "cylinder and ball pressed on a plane: Hertz", "element size / b", 0.02, pressed, beside=ellipse,
         note="b/R = 0.005, neo-Hookean, ν = 0.3, penalty 10 E*/h; b and p₀ are those of the ellipse fitted to the tractions at "
              "the contact points. Their error against the exact ellipse is over p₀: root of the mean square in |x| < b, and the largest in |x| < 0.9 b."),
    Case("V7", "ball on a plane, and two balls head-on (V15): Hertz' impact", "radius of the contact / radius", 0.02, impacts,
         note="Bodies of revolution, neo-Hookean, ν = 0.3, closing at 1 m/s down to 1 mm/s, mesh, step and penalty of the default accuracy: "
              "what is seen is the finite ball, stiffer than Hertz' half-space by a share of the order of the contact's radius."),
    Case("V8", "rigid body on the penalty: depth and contact time", "time step [s]", 0.01, rigids,
         note="E = 10¹² Pa; the depth is the largest at the steps. m = 1.5 and 2 besides m = 1."),
    Case("V9", "stiff block: sliding to a stop, starting to slide, creeping", "time step [s]", 0.01, block,
         note="The slip velocity goes with the step. The block starts in the equilibrium of a rigid one; its weight shortens "
              "it by 0.5 % of the penetration, it vibrates, and its normal load with it: by that the start and the creep are off "
              "once the step resolves it."),
    Case("V10", "stiff oblique disc: sliding throughout, rolling", "penalty × radius / E", 0.03, oblique,
         note="With the measured restitution. A stiff penalty leaves the disc's own compliance, which springs back along the "
              "plane; a soft one lets it sink in (0.8 % of its radius at the softest), which shortens the lever of friction."),
    Case("V11", "Cook's membrane at ν = 0.4999, plane strain: its tip, in the mean volume of elements", "element size / side", 0.01, membranes,
         note="Neo-Hookean, under the published load, and a small one; expected by Taylor–Hood elements of high order on the same equations."),
    Case("V12", "normal impact against NGSolve and GetFEM", "accuracy", 0.005, independent,
         note="Disc SVK, ball neo-Hookean (NGSolve alone). Their converged values, written independently on the same equations. The contact time scatters with mesh and step, by up "
              "to 1.5 % on the coarser ones."),
    Case("V13", "two bars, head-on: contact 2L/c, stress ρcv, velocities exchanged", "element size / length", 0.01, two,
         note="v/c = 10⁻⁴, penalty 1000 E/L; the second bar has elements of nine tenths of the first one's."),
    Case("V14", "bouncing bar under gravity: contacts in [1, 5/3] and [11/3, 13/3]", "element size / length", 0.01, bouncing,
         note="Gravity and height a thousandth of those of Doyen, Ern and Piperno, for the linear theory. Contact: a force above 1 % of the largest."),
    Case("V16", "two blocks with unlike meshes pressed together: the same pressure everywhere", "element size / width", 0.01, blocks,
         note="Penalty 10 E/width. Where both bodies take both roles the pressure at a contact point deviates with penalty × element size / E."),
    Case("V17", "ball, obliquely: rigid, sliding throughout and rolling; elastic, Maw, Barber and Fawcett", "radius of the contact / radius", 0.05, REBOUNDS,
         beside=curve, note="In three dimensions. Rigid: with the measured restitution. Elastic: ν = 0.45, share of the slip at the contact that is lost and regained "
                            "backwards, 1 + β. Theory is of half-spaces: what a ball differs from them falls with the contact's radius, and counts most where it sticks "
                            "(small ψ₁). Elements are half the contact's radius; on finer ones it is larger, at ψ₁ = 0.6 by half or more."),
    Case("V18", "the first microseconds of a disc on the plane: a bar on a wall above every point", "element size / b", 0.05, touches, beside=forces,
         note="Until R v/(2 c_L²), 13 µs at 8 m/s, b = R v/c_L; rubber of the paper, ν = 0.45, neo-Hookean, penalty 20 ρ c_L²/h (6.6·10¹² Pa/m). Expected: 2ρUv√(2Rvt) with "
              "the speed U of the law's plane shock, 4 % above c_L at 8 m/s; on the finest mesh also that with c_L."),
    Case("V19", "bar with a Maxwell branch on a wall: contact 2L/c, restitution of the standard linear solid", "element size / length", 0.01, relaxing,
         note="v/c = 10⁻⁴, branch of half the bar's modulus, penalty 1000 E/L; expected by the inverse Laplace transform of the force on the wall."),
    Case("V24", "first mode of a viscous body: its decay over exp(−ηω²t/(2μ))", "time step / period", 0.01, decays,
         note="Kelvin–Voigt, ζ/λ = η/μ: the mode stays that of the elastic body. Disc, and ball in three dimensions."),
    Case("annulus", "cylinder pressed on a plane, then sheared: stick and slip of Cattaneo and Mindlin", "element size / b", 0.02, annuli, beside=shear,
         note="b/R = 0.02, neo-Hookean, ν = 0.45, μ = 0.1, Q some μP/2, pressed without friction; linear regularisation, ε = 0.003 of the plane's speed: what sticks creeps by "
              "less than 0.3 % of its way. c and q are those of the P and Q that are measured; tractions are means over edges."),
)
