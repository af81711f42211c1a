"""Kelvin-Voigt damping and Maxwell branches (edp/kernels/stress-terms.hpp).

Tested are exact decay, objectivity and the exact energy balance, in the kernels.
"""

import itertools

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq

import ffimpact as ff
from ffimpact.failure import BadInput
from ffimpact.input.damping import Damping, flat
from ffimpact.places import ROOT
from ffimpact.running import run
from ffimpact.scene import read
from ffimpact.scenes import assembly
from tests.support.direct import used
from verification.measure import bodies, disc, impact, measure

IMPACT = {"law": "neohookean", "nu": 0.4, "speed": 4, "angle": 60, "friction_static": 0.3, "accuracy": 0.1}


def of_loss(nu: float) -> float:
    """The viscosity of loss = 0.1 for the disc."""
    return 0.1 * 0.05 * np.sqrt(7e6 / (2 * (1 + nu)) * 1722) / 2.35


NU = 0.3
ETA = 100.0
# Zeta/lambda = eta/mu, hence the same ratio eta_E/E.
PROPORTIONAL = {"nu": NU, "viscosity": ETA, "bulk_viscosity": ETA * 2 * NU / (1 - 2 * NU)}
MODES = {"extension": ("damped-mode", {"nu": 0.0, "viscosity": of_loss(0.0)}), "with volume": ("damped-mode", {"law": "neohookean"} | PROPORTIONAL),
         "midpoint": ("damped-mode", {"integrator": "midpoint"} | PROPORTIONAL),
         "shear": ("damped-mode-3d", {"symmetry": "full", "nu": NU, "viscosity": of_loss(NU), "mesh_size": 0.03, "contact_mesh_size": 0.03})}


@pytest.mark.parametrize("name", MODES)
def test_a_mode_decays_as_theory_has_it(name):
    """The first mode of a free body decays as exp(-eta omega^2 t/(2 mu)) to 1 %, in shear for any
    zeta.

    Each step takes energy, and the balance closes. Rotations take no energy and change neither
    stress nor work.
    """
    script, flags = MODES[name]
    numbers = measure(script, **{"mesh_size": 0.015, "contact_mesh_size": 0.015, "tolerance": 1e-12} | flags)
    assert numbers["state"] == 0 and numbers["decay"] == pytest.approx(1, abs=0.01)
    assert numbers["balance"] < 1e-9 and numbers["least"] > 0
    assert numbers["turned"] < 1e-12 and numbers["objective"] < 1e-12


BRANCHES = [((0.4, 0.3),), ((0.4, 1.0),), ((0.4, 3.0),), ((0.2, 0.1), (0.3, 1.0), (0.1, 10.0))]


def damped_mode(omega, branches, t):
    """The coordinate x of a mode with x = 0 and x' = 1 at the start, at the time t [s]; branches: each
    modulus over that of the law, and time [s]."""
    share, tau = np.transpose(branches)
    n = len(branches)
    A = np.zeros((n + 2, n + 2))           # of x, x' and the strain of the spring of each branch
    A[0, 1] = 1
    A[1, 0], A[1, 2:] = -omega**2, -omega**2 * share
    A[2:, 1], A[2:, 2:] = 1, -np.diag(1 / tau)
    return expm(A * t)[0, 1]


@pytest.mark.few(3)
@pytest.mark.parametrize("name", ["extension", "shear", "midpoint"])
@pytest.mark.parametrize("branches", BRANCHES, ids=str)
def test_a_mode_with_branches_is_the_exact_one(name, branches):
    """The first mode of a free body, for nu = 0 or in shear, with branches whose moduli are these
    shares of mu and whose times are these over 1/omega.

    Its coordinate after three periods is that of the linear equation to 1 %. Each step takes energy, the
    balance closes, and rotations change nothing.
    """
    script, flags, mu = _free_body(name)
    omega = measure(script, **flags | {"viscosity": 1e-9})["omega"]
    numbers = measure(script, **flags | branched(mu, omega, branches))
    exact = damped_mode(omega, [(share, time / omega) for share, time in branches], numbers["seconds"])
    assert numbers["state"] == 0 and omega * numbers["place"] == pytest.approx(omega * exact, abs=0.01)
    assert numbers["balance"] < (1e-6 if name == "midpoint" else 1e-9) and numbers["least"] > 0
    assert numbers["turned"] < 1e-12 and numbers["objective"] < 1e-12


def _free_body(name):
    """Script and flags of a free body for nu = 0 or in shear, and mu [Pa]."""
    size, nu = (0.03, NU) if name == "shear" else (0.015, 0.0)
    flags = {"nu": nu, "mesh_size": size, "contact_mesh_size": size, "tolerance": 1e-12, "law": "neohookean"}
    flags |= {"symmetry": "full"} if name == "shear" else {"integrator": "midpoint"} if name == "midpoint" else {}
    return "damped-mode-3d" if name == "shear" else "damped-mode", flags, 7e6 / (2 * (1 + nu))


def branched(mu, omega, branches):
    """The entries of branches of shear, and of volume with the same shares for nu = 0, K = 2 mu/3."""
    pairs = [(share * mu, time / omega) for share, time in branches]
    return {"branches": tuple(pairs), "bulk_branches": tuple((2 / 3 * modulus, time) for modulus, time in pairs)}


def test_a_mode_with_branches_converges_to_the_exact_one():
    """The error is of second order in the step; extrapolated from three steps it is below 1e-6."""
    script, flags, mu = _free_body("extension")
    omega = measure(script, **flags | {"viscosity": 1e-9})["omega"]
    runs = [measure(script, **flags | branched(mu, omega, BRANCHES[-1]), exponent=n) for n in (1, 2, 4)]
    exact = omega * damped_mode(omega, [(share, time / omega) for share, time in BRANCHES[-1]], runs[0]["seconds"])
    places = [omega * run["place"] for run in runs]
    errors = [place - exact for place in places]
    assert 3.5 < errors[0] / errors[1] < 4.5 and 3.5 < errors[1] / errors[2] < 4.5
    first, second = ((4 * fine - coarse) / 3 for coarse, fine in itertools.pairwise(places))
    assert abs((16 * second - first) / 15 - exact) < 1e-6


@pytest.mark.parametrize("nu", [0.0, 0.45])
def test_loss_is_that_of_the_first_mode(nu):
    """`loss` is eta omega/mu at the first mode of the disc, and the scene as used has the
    viscosity."""
    numbers = measure("damped-mode", nu=nu, viscosity=of_loss(nu), mesh_size=0.015, contact_mesh_size=0.015, tolerance=1e-12)
    assert numbers["tangent"] == pytest.approx(0.1, rel=0.01)
    assert used({"nu": nu, "loss": 0.1, "loss_model": "kelvin-voigt"})["viscosity"] == pytest.approx(of_loss(nu))


@pytest.mark.few(2)
@pytest.mark.parametrize("script, flags", [("disc", {}), ("disc", {"law": "svk"}), ("ball-axisymmetric", {"angle": None}),
                                           ("ball", {"end_time": 5e-4})])
@pytest.mark.parametrize("damping", [{"viscosity": 20, "bulk_viscosity": 10}, {"branches": [[2e6, 1e-3]]}], ids=["viscous", "relaxing"])
def test_an_impact_with_friction_closes_its_balance(tmp_path, script, flags, damping):
    """`viscous_work` never falls, closes the balance to 1e-9, and during contact equals that of
    contacts.csv."""
    values = {name: value for name, value in (IMPACT | damping | flags).items() if value is not None}
    run = disc(tmp_path / "none", script, **values | {"tolerance": 1e-14})
    work = run.history["viscous_work"]
    assert run.summary["energy_drift"] < 1e-9 and np.diff(work).min() >= 0 and work[-1] == run.summary["viscous_work"] > 1e-3 * run.summary["energy_initial"]
    assert "damping" not in run.summary["skipped"]
    assert run.summary["momentum_drift"] < 1e-9
    rows = np.genfromtxt(tmp_path / "none/run/contacts.csv", delimiter=",", names=True)
    assert 0 < np.sum(rows["viscous_work"]) <= work[-1] * (1 + 1e-9)


def test_restitution_falls_with_viscosity(tmp_path):
    """More viscosity gives less rebound. Without viscosity the run only reports that it was
    skipped."""
    runs = [disc(tmp_path / str(eta), **IMPACT | {"angle": 90, "friction_static": 0}, viscosity=eta) for eta in (0, 20, 80, 300)]
    assert (np.diff([run.summary["restitution"] for run in runs]) < -1e-3).all()
    assert "viscous_work" not in runs[0].summary and "viscous_work" not in runs[0].history and "damping" in runs[0].summary["skipped"]


def test_steps_go_with_a_short_relaxation(tmp_path):
    """Adaptive steps are short enough for the relaxation time: the work of the branch agrees with
    steps of a twentieth of it, to the accuracy."""
    flags = {"law": "neohookean", "nu": 0.3, "speed": 6, "accuracy": 0.1, "branches": [[2.7e6, 1e-4]]}
    summary, fine = (disc(tmp_path / str(dt), "ball-axisymmetric", **flags, dt=dt).summary for dt in (0, 5e-6))
    assert summary["viscous_work"] == pytest.approx(fine["viscous_work"], rel=0.1) and not any(warning.startswith("relaxation") for warning in summary["warnings"])
    assert summary["energy_final"] == pytest.approx(fine["energy_final"], abs=0.02 * fine["energy_initial"])


def scene(**more):
    body = {"shape": "disc", "radius": 0.05, "velocity": [0, -3], "law": "neohookean", "young": 7e6, "nu": 0.4, "density": 1722.0}
    return {"accuracy": 0.2, "end_time": 6e-3, "body": [body | {"name": "damped", "position": [0, 0.051]} | more, body | {"name": "elastic", "position": [0.2, 0.051], "loss": 0}],
            "obstacle": [{"kind": "plane", "point": [0, 0], "normal": [0, 1]}]}


@pytest.mark.parametrize("damping", [{"viscosity": 20}, {"branches": [[2e6, 1e-3]]}], ids=["viscous", "relaxing"])
def test_each_body_has_its_own(tmp_path, damping):
    """One of two bodies is damped. Its work is the total work, and the columns are those that the
    scene announces."""
    run = bodies(tmp_path, scene(**damping))
    assert run.summary["viscous_work_1"] == run.summary["viscous_work"] > 0 == run.summary["viscous_work_2"]
    assert run.summary["energy_drift"] < 1e-9 and list(run.history) == read(scene(**damping), ROOT, "scene").columns
    assert not read(scene(), ROOT, "scene").damped


def test_a_body_has_the_viscosity_of_its_loss():
    """With Kelvin-Voigt a loss becomes the viscosity of a disc of equal thickness, in the scene as used, which reads
    back equal.

    The loss of a body has priority over a viscosity at the top.
    """
    made = assembly.assemble(read({"viscosity": 3.0} | scene(loss=0.1, loss_model="kelvin-voigt"), ROOT, "scene"))
    damped, elastic = made.used["body"]
    assert damped["viscosity"] == pytest.approx(used({"nu": 0.4, "loss": 0.1, "loss_model": "kelvin-voigt"})["viscosity"]) and elastic["viscosity"] == 0
    assert made.arrays["materials.viscosity"].tolist()[0] == [damped["viscosity"], 0.0]
    assert assembly.assemble(read(made.used, ROOT, "scene")).data == made.data


@pytest.mark.parametrize("flags, message", [({"viscosity": -1}, "viscosity: -1 is out of range"), ({"bulk_viscosity": "nan"}, "bulk_viscosity: 'nan' is not a number"),
                                            ({"loss": 11}, "loss: 11 is out of range"), ({"loss": 0.1, "viscosity": 3}, "viscosity: .*accepted: one of the two"), ({"loss": 0.1, "viscosity": 3, "loss_model": "kelvin-voigt"}, "accepted: one of the two"),
                                            ({"relaxation_time": 1e-3}, "relaxation_time: '0.001' is no entry any more .accepted: branches"),
                                            ({"branches": [[1e6, 0]]}, "branches.1.2: 0 is out of range"), ({"branches": [1e6, 1]}, "branches.1: '1000000.0' is no pair"),
                                            ({"loss": 0.1, "loss_model": "flat", "branches": [[1e6, 1]]}, "branches: .*accepted: one of the two"),
                                            ({"loss": 3, "loss_model": "flat"}, "loss: 3 deviates by .* branches .accepted: to 5 %"),
                                            ({"loss": 0.1, "loss_model": "flat", "loss_range": [10, 1]}, "loss_range: .*does not grow")])
def test_bad_values_are_refused(flags, message):
    """Negative, invalid, too large or contradictory values give one line with what is accepted, for
    a disc and for a body."""
    with pytest.raises(BadInput, match=message):
        assembly.assemble(read(impact(**flags), ROOT, "scene"))
    with pytest.raises(BadInput, match=message):
        assembly.assemble(read(scene(**flags), ROOT, "scene"))


def test_integrators_that_would_not_count_it_are_refused(tmp_path):
    """Damping requires an integrator that evaluates forces in the middle of a step."""
    with pytest.raises(BadInput, match="integrator: 'bdf2', but viscosity or relaxation needs another value"):
        disc(tmp_path, viscosity=1, integrator="bdf2")


# ---- stiffness in an impact

BRANCH = {"dimension": "axisymmetric", "law": "mooney-rivlin", "share": 0.2, "young": 4455100, "nu": 0.49, "density": 1150,
          "branches": [[1e7, 1.087e-3]], "accuracy": 0.02,
          "body": [{"shape": "ball", "radius": 0.03, "position": [0, 0.03001], "velocity": [0, -3.8859]}],
          "obstacle": [{"kind": "plane", "point": [0, 0], "normal": [0, 1]}]}


def test_a_ten_times_stiffer_penalty_changes_restitution_within_its_error(tmp_path):
    """The automatic penalty takes account of a branch that is 7 times as stiff as the law."""
    results = [run.run(read(BRANCH, tmp_path, "branch"), {}, tmp_path / "automatic")]
    stiffer = 10 * results[0].scene["contact"]["penalty"]
    results.append(run.run(read(BRANCH | {"contact": {"penalty": stiffer}}, tmp_path, "branch"), {}, tmp_path / "stiffer"))
    own, other = (result.summary["restitution"] for result in results)
    assert abs(own - other) < results[0].summary["estimated_error"]["rebound"]
    assert 0.6 < own < 0.65 and not any(words.startswith("penalty") for words in results[0].summary["warnings"])


@pytest.mark.parametrize("loss", [0.15, 0.5])
def test_the_penalty_of_a_viscous_disc_hardly_changes_its_rebound(tmp_path, loss):
    """On the same mesh a 30 times stiffer penalty changes it by less than a fifth of the accuracy."""
    flags = {"young": 1e7, "density": 1000.0, "radius": 0.05, "nu": 0.3, "law": "neohookean", "speed": 2.0, "loss": loss, "loss_model": "kelvin-voigt"}
    entries = used(flags)
    meshed = flags | {name: entries[name] for name in ("mesh_size", "contact_mesh_size")}
    own, other = (disc(tmp_path, **meshed, penalty=factor * entries["penalty"]).summary["rebound_vy"] / 2 for factor in (1, 30))
    assert abs(own - other) < entries["accuracy"] / 5


@pytest.mark.parametrize("script", ["disc", "ball-axisymmetric"])
def test_a_branch_that_does_not_relax_is_part_of_the_law(script):
    """For nu = 0 branches of shear and volume, G and 2 G/3, add 2 G to young. Penalty, slip velocity
    and mesh are those of the stiffer law without a branch; the loss of these is 1e-7."""
    soft = used({"young": 1e6, "nu": 0, "branches": [[2e6, 1e4]], "bulk_branches": [[4e6 / 3, 1e4]]}, script)
    stiff = used({"young": 5e6, "nu": 0}, script)
    for name in ("penalty", "slip_velocity", "mesh_size", "contact_mesh_size"):
        assert soft[name] == pytest.approx(stiff[name], rel=1e-6), name


def test_viscosity_stiffens_at_the_frequency_of_the_impact():
    """The impact of a disc lasts T = 6.5 R/c with c^2 = E/rho: E = young |1 + i pi eta/(mu T)| for
    nu = 0, to be solved for E. The half-width of contact, and with it the element size, is
    proportional to E^(-1/4)."""
    young, density, radius, eta = 1e6, 1000.0, 0.05, 2e3
    rate = np.pi / 6.5 / radius * eta / (young / 2) / np.sqrt(density)
    modulus = brentq(lambda E: E - young * np.sqrt(1 + rate**2 * E), young, 100 * young)
    common = {"young": young, "nu": 0, "density": density, "radius": radius, "speed": 2}
    plain, damped = (used(common | {"viscosity": value})["contact_mesh_size"] for value in (0, eta))
    assert damped / plain == pytest.approx((young / modulus) ** 0.25, rel=1e-9) and modulus > 1.9 * young


def test_waves_are_faster_by_damping(tmp_path):
    """Branches that do not relax add 4/3 G + K to lambda + 2 mu, for the front of a flat strike and for
    steps alike."""
    box = {"shape": "rectangle", "width": 0.1, "height": 0.05, "position": [0, 0.026], "velocity": [0, -1]}
    content = {"law": "neohookean", "nu": 0, "density": 1000, "accuracy": 0.1, "end_time": 1e-5, "body": [box], "obstacle": BRANCH["obstacle"]}
    branch = {"young": 1e6, "branches": [[2e6, 1e4]], "bulk_branches": [[4e6 / 3, 1e4]]}
    scenes = [read(content | more, tmp_path, "box") for more in (branch, {"young": 5e6})]
    speeds = [scene.bodies[0].wave_speed for scene in scenes]
    assert speeds[0] == pytest.approx(np.sqrt(5e6 / 1000), rel=1e-6) == pytest.approx(speeds[1], rel=1e-6)
    steps = [run.run(scene, {}, tmp_path / f"{k}", estimate=False).history["dt"].max() for k, scene in enumerate(scenes)]
    assert steps[0] == pytest.approx(steps[1], rel=1e-6)


# ---- loss over frequency


@pytest.mark.parametrize("frequency", [1, 100, 10000])
def test_a_sheared_pad_has_the_loss_of_its_series(tmp_path, frequency):
    """tan delta of force over displacement of an incompressible pad, without inertia, is that of the
    branches to 0.5 %, over four decades."""
    ends, young = [1, 1e4], 1e7
    rubber = ff.Incompressible(young=young, density=0.01, loss=0.2, loss_model="flat", loss_range=ends)
    moved = ff.Support(where="top", motion=[f"1e-6*sin(2*pi*{frequency}*t)", 0])
    pad = ff.Rectangle(width=0.01, height=0.01, position=(0, 0.005), mesh_size=0.00125, material=rubber, support=[ff.Support(where="bottom"), moved])
    result = ff.run(ff.Scene(bodies=[pad], end_time=3 / frequency, dt=1 / (100 * frequency)), out=tmp_path / "pad", estimate=False, figures=False)
    t = result.history["t"] - result.history["dt"] / 2
    phase, last = 2 * np.pi * frequency * t, np.array(t > 2 / frequency)
    parts = np.column_stack([np.sin(phase), np.cos(phase), np.ones(len(t)), phase])[last]
    stored, lost, *_ = np.linalg.lstsq(parts, np.array(result.history["support_force_x_2"])[last], rcond=None)[0]
    series = Damping(branches=flat(0.2, *ends).branches(young / 3)).shear(young / 3, 2 * np.pi * frequency)
    assert lost / stored == pytest.approx(series.imag / series.real, rel=5e-3)
    assert result["energy_drift"] < 1e-9


def test_restitution_over_speed_shows_the_loss_model(tmp_path):
    """From 1 mm/s to 0.1 m/s a ball with a flat loss keeps its restitution within 0.1 %; with
    Kelvin-Voigt 1 - e grows with the fifth root of the speed (Kuwabara and Kono 1987). Contact times fall with that root."""
    speeds = [1e-3, 1e-2, 1e-1]
    slopes = {}
    for model in ("flat", "kelvin-voigt"):
        ball = {"speed": 1e-3, "nu": 0.45, "accuracy": 0.02, "penalty": "auto", "body.1.loss": 0.05, "body.1.loss_model": model}
        ball |= {"body.1.loss_range": [1, 3000]} if model == "flat" else {}
        runs = [ff.run(ff.Scene.load("ball-axisymmetric").override(ball | {"speed": speed}), out=tmp_path / f"{model} {speed}", estimate=False, figures=False) for speed in speeds]
        lost = [1 - run["restitution"] for run in runs]
        slopes[model] = np.diff(np.log(lost)) / np.diff(np.log(speeds))
        assert np.diff(np.log([run["contact_time"] for run in runs])) / np.diff(np.log(speeds)) == pytest.approx(-0.2, abs=0.015)
        assert max(run["energy_drift"] for run in runs) < 1e-9
        if model == "flat":
            assert np.ptp(lost) < 1e-3
    assert abs(slopes["flat"]).max() < 0.01 and slopes["kelvin-voigt"] == pytest.approx(0.2, abs=0.04)
