"""The table of the parameters of a run: names, defaults, ranges, units and meanings.

Other texts about parameters are generated from this table: schema.py writes the JSON schema for
editors, and docs/pages.py the table of docs/reference/parameters.md. The FreeFEM scripts take the
parameters by these names (edp/program/input/parameters.idp). Numbers are in SI units. The program
chooses a parameter with the value `auto`, or with 0 if the meaning of the parameter says so.
"""

from dataclasses import replace

from .parameter import Parameter, integer, real, word

__all__ = ["LAWS", "PARAMETERS", "SCRIPTS"]

SCRIPTS = ("bodies", "bodies-axisymmetric", "bodies-3d")
OF_BODIES = ("",)  # of no script: entries of bodies
LAWS = ("svk", "neohookean", "mooney-rivlin", "ogden", "incompressible")  # edp/kernels/laws.cpp

# A row without scripts behind the meaning is a parameter of all scripts.
ROWS = (
    word(
        "law",
        "svk",
        LAWS,
        "constitutive law: St. Venant-Kirchhoff (5), compressible neo-Hookean (6), or another",
        OF_BODIES,
    ),
    real("young", 7e6, 1e-6, 1e18, "Pa", "Young's modulus E", OF_BODIES),
    real(
        "nu",
        0.45,
        0,
        0.5,
        "-",
        "Poisson's ratio; the paper says only nu -> 0.5; 0.5: J = 1, of all laws but svk",
        OF_BODIES,
    ),
    real("density", 1722, 1e-15, 1e12, "kg/m3", "reference density", OF_BODIES),
    real(
        "viscosity",
        0,
        0,
        1e18,
        "Pa s",
        "viscosity eta of the material: beside the law's stress 2 eta D, D the rate of deformation",
        OF_BODIES,
    ),
    real(
        "bulk_viscosity",
        0,
        0,
        1e18,
        "Pa s",
        "viscosity zeta of volume: beside it zeta tr(D) I",
        OF_BODIES,
    ),
    real(
        "relaxation_modulus",
        0,
        0,
        1e18,
        "Pa",
        "shear modulus G of a Maxwell branch beside the law, which relaxes in relaxation_time; 0 "
        "= none",
        OF_BODIES,
    ),
    real(
        "relaxation_time",
        0,
        0,
        1e9,
        "s",
        "its time tau: G exp(-t/tau) is left of G after t",
        OF_BODIES,
    ),
    real(
        "loss",
        0,
        0,
        10,
        "-",
        "loss factor tan delta of shear at the first mode of the disc or ball: sets viscosity; 0 "
        "= by viscosity",
        OF_BODIES,
    ),
    real("speed", 0, 0, 1e9, "m/s", "in place of velocity, with direction", OF_BODIES),
    real("spin", 0, -1e12, 1e12, "rad/s", "spin at the start, counter-clockwise", OF_BODIES),
    real(
        "gravity",
        0,
        0,
        1e12,
        "m/s2",
        "gravity, along -y; another direction: body_force_x, body_force_y",
    ),
    real(
        "body_force_x",
        0,
        -1e12,
        1e12,
        "m/s2",
        "constant body force b of (1), along the plane",
        ("bodies", "bodies-3d"),
    ),
    real(
        "body_force_y",
        0,
        -1e12,
        1e12,
        "m/s2",
        "constant body force b of (1), away from the plane; gravity comes on top",
    ),
    real(
        "penalty",
        "auto",
        1e-12,
        1e100,
        "Pa/m^m",
        "contact stiffness k of (10); auto = stiff beside the body, from young, the width of the "
        "contact and the exponent",
    ),
    real("exponent", 1, 1, 4, "-", "contact exponent m of (10)"),
    real(
        "penalty_damping",
        0,
        0,
        1e9,
        "s",
        "retardation time tau of the penalty: a closing contact takes t_N + tau dt_N/dt instead of "
        "t_N of (10), never below 0; 0 = none. It takes energy (penalty_damping_work)",
    ),
    real(
        "friction_static",
        0,
        0,
        10,
        "-",
        "static coefficient mu_e of (12), for |v_T| < slip_velocity; at least friction_dynamic",
    ),
    real(
        "friction_dynamic",
        "auto",
        0,
        10,
        "-",
        "dynamic coefficient mu_d of (12); auto = friction_static",
    ),
    real(
        "slip_velocity",
        "auto",
        1e-15,
        1e9,
        "m/s",
        "epsilon of (12) and (13); auto = a hundredth of the speeds of the scene",
    ),
    word(
        "regularization",
        "linear",
        ("linear", "linear-printed", "sqrt", "tanh"),
        "phi of (13); linear-printed as the paper prints it; sqrt and tanh stay below mu_e for "
        "|v_T| < slip_velocity",
    ),
    word(
        "friction_transition",
        "jump",
        ("jump", "smooth"),
        "from static to dynamic: the paper's jump at slip_velocity, or a half cosine up to twice "
        "that (resolve it: dt (mu_e - mu_d) times the deceleration below slip_velocity)",
    ),
    word(
        "volume",
        "auto",
        ("plain", "projected", "auto"),
        "resistance to change of volume: plain = at points, which locks as nu -> 0.5; projected ="
        " what is beyond that of nu = 0.45 in the mean of each element; auto = projected, where "
        "degree=1 plain",
    ),
    real(
        "mesh_size",
        0,
        0,
        1e9,
        "m",
        "element size in the bulk; 0 = from accuracy",
        OF_BODIES,
    ),
    real(
        "contact_mesh_size",
        0,
        0,
        1e9,
        "m",
        "element size at the contact boundary; 0 = from accuracy",
        OF_BODIES,
    ),
    integer("degree", 2, 1, 2, "-", "polynomial degree of the displacement"),
    word(
        "integrator",
        "energy-momentum",
        (
            "energy-momentum",
            "midpoint",
            "backward-euler",
            "bdf2",
            "central-difference",
            "auto",
        ),
        "time integrator; central-difference: explicit, in substeps that resolve the waves in "
        "the bodies, contact and friction solved in each; auto: central-difference or "
        "energy-momentum, whichever is cheaper by the estimated number of operations",
    ),
    real("dt", 0, 0, 1e9, "s", "time step; 0 = adaptive"),
    real(
        "accuracy",
        0.005,
        1e-5,
        0.4,
        "-",
        "requested relative accuracy: of impulse and thresholded contact time relative to themselves, "
        "rebound velocities and spin relative to the speed, energies and friction work to the largest "
        "energy; mesh and step that are not given follow from it",
    ),
    word(
        "accuracy_of",
        "promised",
        ("promised", "friction_work", "peak_force", "contact_time"),
        "one more number to which the accuracy applies, relative to itself: it costs more"
        " because these numbers scatter more",
    ),
    real(
        "tolerance",
        5e-12,
        1e-15,
        0.0001,
        "-",
        "largest work of the residual in a step, over the energy at the start",
    ),
    word(
        "breakdown",
        "stop",
        ("stop", "continue"),
        "what a run does under svk when det F <= 0 or a point loses four fifths of its volume in "
        "the smallest step",
    ),
    word(
        "chatter",
        "stop",
        ("stop", "continue"),
        "what a run does when the body leaves the obstacle and is back within a transit of its "
        "waves twenty times in a row",
    ),
    real(
        "end_time",
        0,
        0,
        1e9,
        "s",
        "end of the run; 0 = until the first impact is over, with the contacts that follow it at "
        "once",
    ),
    word(
        "start",
        "given",
        ("given", "equilibrium"),
        "the bodies at t = 0: as given, or at rest in equilibrium under body force, loads, gas and "
        "contact, reached from the given shape and place by slow loading",
    ),
    word(
        "until",
        "impact",
        ("impact", "rest"),
        "what ends the run, at end_time at the latest: the end of the impact, or under gravity, "
        "with viscosity or friction, that all rests",
    ),
    integer("fields", 0, 0, 10000, "-", "number of field snapshots (VTU)"),
    integer(
        "modes",
        0,
        0,
        500,
        "-",
        "number of natural modes of the free bodies, with their energies at the end of the run; 0"
        " = none",
    ),
    integer(
        "checkpoint_every",
        0,
        0,
        1000000000,
        "steps",
        "a checkpoint every so many steps, from which a killed run goes on; 0 = none; the answer "
        "stays the same",
    ),
    word(
        "without",
        "none",
        (
            "none",
            "flight",
            "friction",
            "body-force",
            "frozen-factorisation",
            "contact-culling",
        ),
        "leave out one saving, to measure what it saves",
    ),
)
PARAMETERS: dict[str, Parameter] = {
    row.name: replace(row, scripts=tuple(filter(None, row.scripts or SCRIPTS))) for row in ROWS
}
