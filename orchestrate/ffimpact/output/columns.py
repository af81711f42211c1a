"""The table of what a run records: name, unit and meaning of every column and number, and the
scenes that have it.

Pages, units and the lists of names are made from it. The order of a table is that of its file:
edp/program/run/columns.idp writes the columns of history.csv in it (tests/unit/test_columns.py),
and numbers.py has the values of the numbers. Units are those of plane strain, per metre of
thickness; of balls and bodies of revolution the last "/m" is left out.
"""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

__all__ = [
    "CONTACTS",
    "ENTRIES",
    "FILES",
    "NEEDS",
    "RUN_NUMBERS",
    "Column",
    "Features",
    "recorded",
    "units",
]


class Column(NamedTuple):
    """A column or number. `whole`: there is one of all bodies together. `part`: there is one of
    each of several bodies, of each support, gas or layer, whose name ends in its number (_1, _2
    ...). `needs`: the word of NEEDS without which a scene does not have it, or "".
    """

    name: str
    unit: str = ""
    meaning: str = ""  # an empty one is that of the same name further up
    needs: str = ""
    whole: bool = True
    part: bool = False


def _whole(name: str, unit: str = "", meaning: str = "", needs: str = "") -> Column:
    """A column of all bodies together."""
    return Column(name, unit, meaning, needs)


def _part(name: str, unit: str = "", meaning: str = "", needs: str = "") -> Column:
    """A column of each body, support or gas."""
    return Column(name, unit, meaning, needs, whole=False, part=True)


def _both(name: str, unit: str = "", meaning: str = "", needs: str = "") -> Column:
    """A column of all bodies together and of each."""
    return Column(name, unit, meaning, needs, part=True)


# Words for what some columns need, and in which scenes it is.
NEEDS = {
    "directed": "in runs of the paper's scripts",
    "penalty_damped": "with penalty_damping",
    "damped": "with damped bodies",
    "metals": "with metals",
    "projected": "with projected volume",
    "solid": "in three dimensions",
}


@dataclass(frozen=True)
class Features:
    """What of a scene decides which columns it has; `words` are of NEEDS."""

    words: frozenset[str] = frozenset()
    bodies: int = 1
    supports: int = 0
    loads: int = 0
    gases: tuple[int, ...] = ()  # which of the loads are gases, from 1
    layers: int = 0


# fmt: off
# Normal forces of one body on a plane are parallel: the size of their resultant (normal_force) is
# the sum of their sizes (normal_load). Elsewhere they have many directions, and normal_load is
# larger.
HISTORY = (
    _whole("t", "s", "end of the step"),
    _whole("dt", "s", "its length"),
    _whole("normal_force", "N/m", "normal force, mean over the step: the size of the sum of the "
        "normal tractions of each pair of bodies, summed over the pairs (a floor and a wall are "
        "two counter-bodies, a polyline is one); of a body with itself the sum of the sizes"),
    _whole("normal_load", "N/m", "sum of the sizes of all normal tractions, mean over the step"),
    _whole("friction_force", "N/m", "of one body on the floor along +x, on the body; else the sum "
        "over all contact points, each along the first tangent of its counter-body (the normal "
        "turned by -90 degrees), mean over the step"),
    _both("kinetic", "J/m", "kinetic energy"),
    _both("elastic", "J/m", "elastic energy, that of branches that relax included"),
    _part("force_x", "N/m", "contact force on the body, mean over the step"),
    _part("force_y", "N/m", "likewise"),
    _whole("contact", "J/m", "energy of the contact's penalty, which belongs to no body"),
    _whole("friction_work", "J/m", "energy that friction has taken so far"),
    _whole("external_work", "J/m", "work of gravity, body forces, moving obstacles, supports and "
        "loads so far"),
    _whole("balance", "J/m", "kinetic + elastic + contact + friction_work + viscous_work + "
        "plastic_work + penalty_damping_work - external_work, less the same at the start"),
    _both("momentum_x", "N s/m", "linear momentum along x"),
    _both("momentum_y", "N s/m", "along y"),
    _both("angular_momentum", "N m s/m", "about the centre of mass, about z"),
    _both("x", "m", "centre of mass"),
    _both("y", "m", "centre of mass"),
    _both("vx", "m/s", "its velocity"),
    _both("vy", "m/s", "its velocity"),
    _both("spin", "rad/s", "angular momentum over the inertia of the deformed body, about z"),
    _whole("max_penetration", "m", "largest penetration, of contact points, corners, edges, and of "
        "circles and vertices of polylines in between them"),
    _whole("contact_size", "m", "share of the undeformed outline in contact; in three dimensions "
        "and of revolution its area [m2]"),
    _both("contact_half_width", "m", "from the contact's centre to its farthest point, in the "
        "reference; of several places the largest"),
    _both("max_pressure", "Pa", "largest contact pressure, normal force per undeformed outline, "
        "mean over the step; the largest projected_pressure of fields/contact.csv"),
    _whole("sliding_fraction", "1", "share of the normal load on points with |v_T| >= "
        "slip_velocity in the step"),
    _whole("min_jacobian", "1", "smallest det F"),
    _whole("min_stretch", "1", "smallest principal stretch"),
    _whole("newton_iterations", "", "iterations of the step, of an explicit one its parts; in the "
        "summary of all steps"),
    _whole("min_ellipticity", "1", "smallest eigenvalue of the acoustic tensor over mu: below 0 "
        "the answer depends on the mesh; metals are not watched and count as 1"),
    _whole("reverse_fraction", "1", "share of the normal load that slides against the direction of "
        "the first slip", needs="directed"),
    _whole("penalty_damping_work", "J/m", "energy that the damping of the penalty has taken so "
        "far", needs="penalty_damped"),
    _both("viscous_work", "J/m", "energy that the bodies' viscosity and relaxation have taken so "
        "far", needs="damped"),
    _both("plastic_work", "J/m", "plastic work since the start: heat, and energy stored by hardening", needs="metals"),
    _whole("max_plastic_strain", "1", "largest equivalent plastic strain", needs="metals"),
    _both("hydrostatic_pressure", "Pa", "pressure in the body, -tr/3 of Cauchy's stress as in the "
        "fields: its mean over the deformed volume", needs="projected"),
    _both("max_hydrostatic_pressure", "Pa", "its largest value", needs="projected"),
    _part("force_z", "N/m", "contact force on the body along z", needs="solid"),
    _both("momentum_z", "N s/m", "along z", needs="solid"),
    _both("z", "m", "centre of mass", needs="solid"),
    _both("vz", "m/s", "its velocity", needs="solid"),
    _both("angular_momentum_x", "N m s/m", "about x", needs="solid"),
    _both("angular_momentum_y", "N m s/m", "about y", needs="solid"),
    _both("spin_x", "rad/s", "about x", needs="solid"),
    _both("spin_y", "rad/s", "about y", needs="solid"),
)

HISTORY_OF_SUPPORTS = (
    _part("support_force_x", "N/m", "force of a support on its body, mean over the step"),
    _part("support_force_y", "N/m", "likewise"),
    _part("support_moment", "N m/m", "moment of that force about the middle of what is held, about "
        "z"),
    _whole("support_work", "J/m", "work of supports so far, part of external_work"),
    _part("support_work"),
    _part("support_force_z", "N/m", "force of a support on its body along z", needs="solid"),
    _part("support_moment_x", "N m/m", "its moment about x", needs="solid"),
    _part("support_moment_y", "N m/m", "about y", needs="solid"),
)

HISTORY_OF_LOADS = (
    _whole("load_work", "J/m", "work of loads so far, part of external_work"),
    _part("gas_volume", "m2", "volume of the cavity at the end of the step; in three dimensions "
        "and of revolution [m3]"),
    _part("gas_pressure", "Pa", "pressure in it over that outside"),
)

HISTORY_OF_LAYERS = (
    _part("layer_elastic", "J/m", "elastic energy in the layer, part of elastic"),
    _part("layer_viscous_work", "J/m", "part of viscous_work in the layer", needs="damped"),
    _part("layer_plastic_work", "J/m", "part of plastic_work in the layer", needs="metals"),
)

# Numbers that Python evaluates (output/contacts.py). restitution, restitution_tangential and
# angle_out are None unless the run is one impact that is over, of one contact pair; impulse_ratio
# and angle_in need one pair and one normal. bounces counts all pairs, and
# thresholded_contact_time is that of the total normal force.
RUN_NUMBERS = (
    _whole("thresholded_contact_time", "s", "between the crossings of 1 % of the largest force"),
    _whole("peak_uncertainty", "1", "share by which penalty and mesh may change peak_force, if "
        "single contact points dominate the force or it oscillates on the penalty; else null"),
    _whole("bounces", "", "impacts that are over: intervals of contact with a restitution "
        "(contacts.csv)"),
    _whole("first_restitutions", "1", "list of the restitutions of the first bounces, up to three"),
    _whole("rest_time", "s", "time from which on the kinetic energy is at most accuracy^2 times "
        "the stored energy; null unless the run ended at rest"),
    _whole("restitution", "1", "normal velocity after over that before contact, of the rigid "
        "motion of the point of first contact; null unless it is of one impact that is over, "
        "along one normal, with an approach of at least a quarter of impulse over reduced mass. "
        "With a body on supports it contains the vibration of that body"),
    _whole("restitution_tangential", "1", "minus the slip after over the slip before contact, at "
        "that point; null if the slip before is less than a twentieth of impulse over reduced "
        "mass"),
    _whole("impulse_ratio", "1", "impulse along the counter-body over that across; null if the "
        "normal turns"),
    _whole("angle_in", "degrees", "of the velocity of the centre to the surface before contact, "
        "90: along the normal; null if the normal turns or that velocity is less than a twentieth "
        "of impulse over reduced mass"),
    _whole("angle_out", "degrees", "the same after contact"),
)

# Spins are angular momentum L over the inertia I of the deformed body at the last step; for a free
# body L is constant, and I varies as the body vibrates.
SUMMARY = (
    _whole("contact_time", "s", "from the onset to the end of contact, interpolated within the "
        "steps"),
    *RUN_NUMBERS,
    _whole("contact_start", "s", "onset of contact"),
    _whole("contact_intervals", "", "number of intervals of contact"),
    _whole("peak_force", "N/m", "largest normal_force"),
    _whole("impulse", "N s/m", "integral of normal_force over time, without friction: of two "
        "bodies that meet head-on what each has of momentum"),
    _part("impulse_x", "N s/m", "integral of the contact force on the body"),
    _part("impulse_y", "N s/m", "likewise"),
    _both("rebound_vx", "m/s", "velocity of the centre of mass at the end of contact; at the end "
        "of the run if no contact is over"),
    _both("final_vx", "m/s", "as rebound_vx, at end_time; null unless the run goes on after the "
        "contact"),
    _both("rebound_vy", "m/s", "likewise"),
    _both("final_vy", "m/s", "as rebound_vy, at end_time; null unless the run goes on after the "
        "contact"),
    _both("rebound_spin", "rad/s", "spin at the same time: of a body that vibrates it swings by 1 "
        "or 2 %"),
    _both("final_spin", "rad/s", "as rebound_spin, at end_time; null unless the run goes on after "
        "the contact"),
    _whole("energy_initial", "J/m", "kinetic + elastic + contact energy at the start"),
    _whole("energy_final", "J/m", "the same at the end of contact, or at end_time; of damped bodies at the end of the run"),
    _part("kinetic_final", "J/m", "kinetic energy at the end"),
    _part("elastic_final", "J/m", "elastic energy at the end"),
    _both("vibration_energy", "J/m", "kinetic and elastic energy less translation_energy, "
        "rotation_energy and that of the equilibrium with gases, at the end; without that of stresses "
        "which plastic strain leaves in a body"),
    _whole("translation_energy", "J/m", "of the centres of mass of bodies that nothing holds, at "
        "the end"),
    _whole("rotation_energy", "J/m", "of these L^2/(2 I) at the end, I of the deformed body"),
    _whole("external_work"),
    _whole("friction_work"),
    _whole("creep_work", "J/m", "part of friction_work of points with |v_T| < slip_velocity"),
    _whole("slip_work", "J/m", "the rest of it"),
    _whole("energy_drift", "1", "largest |balance| over the energy supplied. This is the largest "
        "sum of kinetic, elastic, contact and dissipated energy minus the balance, relative to "
        "the obstacles; in an impact the energy at the start"),
    _whole("momentum_drift", "1", "largest difference of a body's momentum, and without obstacles "
        "of all bodies' together, from what contact forces and weight should have given, as a "
        "speed over the fastest motion"),
    _whole("angular_momentum_drift", "1", "the same of angular momentum, as the speed of a rim"),
    _whole("max_von_mises", "Pa", "largest von Mises stress"),
    _whole("max_von_mises_time", "s", "when"),
    _whole("max_von_mises_x", "m", "where, in the reference"),
    _whole("max_von_mises_y", "m", "likewise"),
    _whole("max_von_mises_z", "m", "likewise"),
    _whole("max_pressure"),
    _whole("max_pressure_time", "s", "when"),
    _whole("max_pressure_x", "m", "where, in the reference"),
    _whole("max_pressure_y", "m", "likewise"),
    _whole("max_pressure_z", "m", "likewise"),
    _whole("max_tension", "Pa", "largest principal stress"),
    _whole("max_tension_time", "s", "when"),
    _whole("max_tension_x", "m", "where, in the reference"),
    _whole("max_tension_y", "m", "likewise"),
    _whole("max_tension_z", "m", "likewise"),
    _whole("max_shear", "Pa", "half the largest difference of principal stresses"),
    _whole("max_shear_time", "s", "when"),
    _whole("max_shear_x", "m", "where, in the reference"),
    _whole("max_shear_y", "m", "likewise"),
    _whole("max_shear_z", "m", "likewise"),
    _whole("min_jacobian"),
    _whole("min_stretch"),
    _whole("volume_change", "1", "largest change of the mean volume ratio of an element; null "
        "where volume is plain"),
    _whole("volume_spread", "1", "largest difference of det F at a point from its mean over the "
        "element, over that; null where volume is plain"),
    _whole("min_ellipticity"),
    _whole("ellipticity_lost_time", "s", "when min_ellipticity was first <= 0, null if never"),
    _whole("ellipticity_lost_x", "m", "where"),
    _whole("ellipticity_lost_y", "m", "where"),
    _whole("breakdown_time", "s", "when det F was first <= 0, null if never"),
    _whole("breakdown_x", "m", "where"),
    _whole("breakdown_y", "m", "where"),
    _whole("max_penetration"),
    _whole("corner_share", "1", "share of the impulse of all normal tractions that belongs to "
        "contacts which began at a sharp corner or edge of a body and press both its sides, where "
        "answers converge more slowly"),
    _whole("sliding_time", "s", "sliding_fraction integrated over the contact"),
    _whole("sticking_time", "s", "the rest of it"),
    _whole("unsolved_jumps", "", "points and steps that sit in a jump of the friction law"),
    _whole("resumed_at", "s", "where a killed run went on, null if it was not"),
    _whole("steps", "", "accepted steps"),
    _whole("rejected_steps", "", "steps that were tried again smaller"),
    _whole("newton_iterations"),
    _whole("factorizations", "", "of the matrix"),
    _whole("residual_evaluations", "", "evaluations of the equation of motion"),
    _whole("operator_bytes", "byte", "read in a residual: gradient, its transpose and mass, 8 "
        "bytes a value, 4 an index"),
    _both("mass", "kg/m", "mass"),
    _both("reach", "m", "largest distance from the centre of mass of a body at rest"),
    _both("extent_x", "m", "width of a body at rest, in the plane before it is turned by `angle`; "
        "of several bodies the largest"),
    _both("extent_y", "m", "its height likewise"),
    _both("extent_z", "m", "its depth likewise, null in two dimensions"),
    _whole("dofs", "", "unknowns"),
    _whole("front_transit", "s", "that a wave front takes through an element, where a face strikes "
        "flat; null where none does"),
    _whole("front_rise", "s", "in which that front rises on the penalty"),
    _whole("peak_memory", "byte", "of FreeFem++"),
    _whole("quick_clock", "", "1: the clock of edp/program/clock.c counted the seconds"),
    _whole("cpu_seconds", "s", "processor time of FreeFem++"),
    _whole("start_seconds", "s", "of it until the first step: start of FreeFem++, scene, mesh and "
        "operators"),
    _whole("wall_seconds", "s", "its time"),
    _whole("penalty_damping_work", needs="penalty_damped"),
    _both("viscous_work", needs="damped"),
    _both("plastic_work", needs="metals"),
    _whole("max_plastic_strain", needs="metals"),
    _whole("ellipticity_lost_z", "m", "where", needs="solid"),
    _whole("breakdown_z", "m", "where", needs="solid"),
    _part("impulse_z", "N s/m", "as impulse_x, along z", needs="solid"),
    _both("rebound_vz", "m/s", "as rebound_vx, along z", needs="solid"),
    _both("final_vz", "m/s", "as rebound_vz, at end_time; null unless the run goes on after the "
        "contact", needs="solid"),
    _both("rebound_spin_x", "rad/s", "as rebound_spin, about x", needs="solid"),
    _both("final_spin_x", "rad/s", "as rebound_spin_x, at end_time; null unless the run goes on "
        "after the contact", needs="solid"),
    _both("rebound_spin_y", "rad/s", "as rebound_spin, about y", needs="solid"),
    _both("final_spin_y", "rad/s", "as rebound_spin_y, at end_time; null unless the run goes on "
        "after the contact", needs="solid"),
)

SUMMARY_OF_SUPPORTS = (
    _whole("support_work"),
    _part("support_peak", "N/m", "largest size of a support's force, mean over a full step"),
)

SUMMARY_OF_LOADS = (
    _whole("load_work"),
    _part("gas_pressure_start", "Pa", "pressure of the gas minus that outside at the start"),
    _part("gas_volume_start", "m2", "volume of its cavity at the start; in three dimensions and of "
        "revolution [m3]"),
    _part("gas_radius_start", "m", "largest distance of its body from the centre of mass at the "
        "start"),
)

SUMMARY_OF_LAYERS = (
    _part("layer_elastic_final", "J/m", "elastic energy in the layer at the end"),
    _part("layer_viscous_work", needs="damped"),
    _part("layer_plastic_work", needs="metals"),
)

# Entries of summary.json that are no numbers of a run.
ENTRIES = (
    _whole("status", "", "ok, or the name of the failure"),
    _whole("message", "", "empty, or why the run failed"),
    _whole("ended", "", "what ended the run: impact (it is over), rest, rolling (on, rigid, where "
        "rest was asked for), end_time, or stopped (by the function `watch` of ff.run)"),
    _whole("made_by", "", "script: the run is one of the paper's scripts; else left out"),
    _whole("later_contact_possible", "", "true: the run ended before a possible contact that "
        "belongs to the impact, or that vibration may cause soon after it"),
    _whole("integrator", "", "that of the run; where it was left to the program (auto) `skipped` "
        "says why"),
    _whole("warnings", "", "sentences: what may make an answer wrong (docs/reference/warnings.md)"),
    _whole("notes", "", "sentences likewise: footnotes of numbers, and what stands behind a "
        "warning"),
    _whole("phase_seconds", "s", "wall_seconds by phase; flight: search for the next contact; "
        "other: the rest, with waiting"),
    _whole("total_seconds", "s", "of it all: set-up, meshes, this run and those that estimate its "
        "error, without figures"),
    _whole("skipped", "", "what the scene did not need"),
    _whole("symmetric_along", "", "axes along which the scene is its own mirror image: velocities "
        "along them, and spins about other axes, are zero up to the asymmetry of the mesh, and "
        "have no error estimate"),
    _whole("volume", "", "plain: all of lambda acts at points; projected: what is beyond nu = 0.45 "
        "in the mean of each element"),
    _whole("released", "", "what a scene fixes for its own material and was left to the program, "
        "as that was changed"),
    _whole("estimated_error", "1", "by answer, relative as accuracy is, of max_pressure and "
        "max_penetration over themselves; null where it was not estimated; without impulse, "
        "velocities and times if a later contact is possible"),
    _whole("estimated_error_excludes", "", "what all these runs have alike, and the estimate says "
        "nothing of"),
    _whole("estimate_cpu_seconds", "s", "processor time of the runs beside it"),
    _whole("refinements", "", "finer runs that took its place"),
    _whole("provenance", "", "code, versions, mesh, what was asked for, checksums of the files"),
)

CONTACTS = (
    _whole("body", "", "number of the body, from 1"),
    _whole("partner", "", "k: body k, also the body itself; -k: obstacle k"),
    _whole("start", "s", "first point in contact"),
    _whole("end", "s", "last point out of contact"),
    _whole("over", "", "0: still in contact at the end of the run"),
    _whole("time", "s", "end - start"),
    _whole("thresholded_time", "s", "between 1 % of the largest force of the interval"),
    _whole("impulse"),
    _whole("impulse_x"),
    _whole("impulse_y"),
    _whole("impulse_z"),
    _whole("peak_force"),
    _whole("peak_time", "s", "middle of the step with the largest mean force"),
    _whole("normal_x", "1", "direction of the normal impulse, towards the body"),
    _whole("normal_y", "1", "likewise"),
    _whole("normal_z", "1", "likewise"),
    _whole("approach", "m/s", "normal velocity to the counter-body before contact, of the rigid "
        "motions at the first contact"),
    _whole("separation", "m/s", "the same after contact"),
    _whole("lever", "m", "distance of the centre of mass from the line of the normal force"),
    _whole("partner_lever", "m", "the same of the counter-body, 0 for an obstacle"),
    _whole("slip_before", "m/s", "velocity along the counter-body before contact"),
    _whole("slip_after", "m/s", "velocity along it in the direction of slip_before, after contact"),
    _whole("restitution"),
    _whole("restitution_poisson", "1", "ratio of the impulse during separation to that during "
        "approach"),
    _whole("restitution_energetic", "1", "root of the work of the normal force during separation "
        "over that during approach"),
    _whole("restitution_tangential"),
    _whole("impulse_ratio"),
    _whole("angle_in"),
    _whole("angle_out"),
    _whole("friction_work"),
    _whole("creep_work"),
    _whole("slip_work"),
    _whole("translation_energy"),
    _whole("rotation_energy"),
    _whole("vibration_energy"),
    _whole("viscous_work", "J/m", "energy that viscosity and relaxation took of all bodies from "
        "start to end, whole steps", needs="damped"),
)

# Z, z and the names with _z exist in three dimensions only.
POINTS = (
    _whole("t", "s", "instant"),
    _whole("body", "", "the body of the contact point, from 1"),
    _whole("partner", "", "the counter-body: a body from 1, an obstacle -1, -2 ..."),
    _whole("s", "m", "along the outline from the first contact, the body to the left; in three "
        "dimensions the distance from the first contact"),
    _whole("X", "m", "reference position"),
    _whole("Y", "m", "likewise"),
    _whole("Z", "m", "likewise"),
    _whole("x", "m", "position at the instant"),
    _whole("y", "m", "likewise"),
    _whole("z", "m", "likewise"),
    _whole("weight", "m", "share of the outline that the point stands for; in three dimensions of "
        "the surface [m2]"),
    _whole("pressure", "Pa", "normal traction per reference length, mean over the step"),
    _whole("shear", "Pa", "tangential traction along the normal of the counter-body turned by -90 "
        "degrees"),
    _whole("shear_z", "Pa", "along the second tangent"),
    _whole("slip_velocity", "m/s", "along the first tangent"),
    _whole("slip_velocity_z", "m/s", "along the second"),
    _whole("slides", "", "1: |v_T| >= the parameter slip_velocity"),
    _whole("projected_pressure", "Pa", "L2 projection of the pressure on the shape functions of "
        "the displacement along the outline; it has the same resultant and moment"),
)

# fmt: on
Tables = tuple[tuple[Column, ...], ...]


def _complete(files: Mapping[str, Tables]) -> dict[str, Tables]:
    """The tables of the files with a unit and a meaning in every row."""
    earlier: dict[str, Column] = {}

    def row(column: Column) -> Column:
        if not column.meaning:
            column = column._replace(
                unit=earlier[column.name].unit, meaning=earlier[column.name].meaning
            )
        earlier[column.name] = column
        return column

    return {
        file: tuple(tuple(row(column) for column in table) for table in tables)
        for file, tables in files.items()
    }


# By file: what it has of all bodies together and of each; of supports; of loads; of layers; other
# entries.
FILES = _complete(
    {
        "history.csv": (HISTORY, HISTORY_OF_SUPPORTS, HISTORY_OF_LOADS, HISTORY_OF_LAYERS),
        "summary.json": (
            SUMMARY,
            SUMMARY_OF_SUPPORTS,
            SUMMARY_OF_LOADS,
            SUMMARY_OF_LAYERS,
            ENTRIES,
        ),
        "contacts.csv": (CONTACTS,),
        "fields/contact.csv": (POINTS,),
    }
)


def recorded(file: str, features: Features) -> list[str]:
    """The columns of history.csv, or the numbers of summary.json, of a scene, in their order."""
    bodies, supports, layers = (
        range(1, count + 1) for count in (features.bodies, features.supports, features.layers)
    )
    parts = (
        (True, bodies if features.bodies > 1 else ()),
        (features.supports > 0, supports),
        (features.loads > 0, features.gases),
        (features.layers > 0, layers),
    )
    result: list[str] = []
    for table, (together, numbers) in zip(FILES[file], parts):
        rows = [row for row in table if not row.needs or row.needs in features.words]
        result += [row.name for row in rows if row.whole and together]
        result += [f"{row.name}_{k}" for k in numbers for row in rows if row.part]
    return result


def units(per_metre: str, numbered: Iterable[str] = ()) -> dict[str, str]:
    """The unit of every name in summary.json, history.csv and contacts.csv, also with the numbers of
    bodies, supports and loads that names of `numbered` end in. `per_metre` is "/m" in plane strain,
    else empty (dimension.per_metre).
    """
    endings = {"", *(match[0] for name in numbered if (match := re.search("_[0-9]+$", name)))}
    return {
        row.name + ending: row.unit if per_metre else row.unit.removesuffix("/m")
        for file in ("summary.json", "history.csv", "contacts.csv")
        for table in FILES[file]
        for row in table
        for ending in (endings if row.part else [""])
    }
