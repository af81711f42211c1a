"""nu -> 0.5 (edp/program/law/volume.idp): volume as the mean over an element, without locking."""

import pytest

from ffimpact.failure import BadInput
from ffimpact.output import vtu
from ffimpact.places import ROOT
from ffimpact.scene import read
from verification.measure import bodies, disc, impact

IMPACT = {"law": "neohookean", "nu": 0.4999, "speed": 4, "accuracy": 0.1, "tolerance": 1e-15}
RUBBED = {"angle": 60, "friction_static": 0.3}
SCENES = {"disc": ("disc", RUBBED), "svk": ("disc", {"law": "svk", "speed": 2}), "ball": ("ball-axisymmetric", {}),
          "space": ("ball", RUBBED | {"end_time": 5e-4}), "two bodies": ("disc-block", RUBBED | {"end_time": 1e-3})}


@pytest.mark.few(1)
@pytest.mark.parametrize("name", SCENES)
def test_an_impact_keeps_energy_and_momenta(tmp_path, name):
    """At nu = 0.4999 the balances close to 1e-9. The summary has the projected volume."""
    script, flags = SCENES[name]
    summary = disc(tmp_path, script, **IMPACT | flags).summary
    assert summary["volume"] == "projected" and not any("locking" in warning for warning in summary["warnings"])
    assert summary["energy_drift"] < 1e-9 and summary["momentum_drift"] < 1e-9 and (summary["angular_momentum_drift"] or 0) < 1e-9


def test_up_to_nu_045_nothing_changes(tmp_path):
    """At the paper's nu the history is equal, byte by byte, to that with all of lambda at points.
    """
    for volume in ("auto", "plain"):
        run = disc(tmp_path / volume, law="neohookean", nu=0.45, accuracy=0.3, volume=volume)
        assert run.summary["volume"] == "plain"
    assert (tmp_path / "auto/run/history.csv").read_bytes() == (tmp_path / "plain/run/history.csv").read_bytes()


def test_bodies_of_a_scene_each_have_theirs(tmp_path):
    """One of two discs is nearly incompressible or has J = 1: energy and momenta are constant.

    The nearly incompressible disc takes as many iterations as nu = 0.45.
    """
    def scene(nu, law="neohookean"):
        body = {"shape": "disc", "radius": 0.05, "law": "neohookean", "young": 7e6, "density": 1722.0}
        return {"accuracy": 0.2, "body": [body | {"name": "a", "position": [0, 0.051], "velocity": [0, -3], "nu": nu, "law": law},
                                          body | {"name": "b", "position": [0.02, -0.051], "velocity": [0, 0], "nu": 0.3}]}
    runs = [bodies(tmp_path / str(arguments[0]), scene(*arguments)).summary for arguments in ((0.45,), (0.4999,), (0.5, "incompressible"))]
    assert [run["volume"] for run in runs] == ["plain", "projected", "projected"]
    assert max(run["energy_drift"] for run in runs) < 1e-9 and runs[1]["newton_iterations"] < 1.3 * runs[0]["newton_iterations"]
    assert runs[2]["impulse"] == pytest.approx(runs[1]["impulse"], rel=2e-3)
    with pytest.raises(BadInput, match="nu: 0.49995 is out of range .accepted: 0 to 0.4999, or 0.5: J = 1"):
        bodies(tmp_path / "refused", scene(0.49995))


def test_linear_elements_are_refused(tmp_path):
    """An element of degree 1 has one volume: its projection, if requested, is an error, as is an
    unknown name."""
    with pytest.raises(BadInput, match="volume: 'mean' is not known"):
        read(impact(volume="mean"), ROOT, "scene")
    with pytest.raises(BadInput, match="degree: '1', but volume = 'projected' needs another value"):
        disc(tmp_path, volume="projected", degree=1)


HELD = {"law": "incompressible", "nu": 0.5, "accuracy": 0.1, "speed": 4}


@pytest.mark.few(1)
@pytest.mark.parametrize("name", SCENES)
def test_incompressible_bodies_keep_their_volume(tmp_path, name):
    """J = 1: the mean volume of every element is constant to 1e-6, energy and momenta to 1e-9."""
    script, flags = SCENES[name]
    values = HELD | {"tolerance": 1e-14} | {key: value for key, value in flags.items() if key != "law"}
    summary = disc(tmp_path, script, **values).summary
    assert summary["volume_change"] < 1e-6 and summary["energy_drift"] < 1e-9
    assert summary["volume_spread"] >= 1 - summary["min_jacobian"] - 1e-6
    assert summary["momentum_drift"] < 1e-9 and (summary["angular_momentum_drift"] or 0) < 1e-9


def test_snapshots_have_their_own_pressures(tmp_path):
    """The pressure of a body with J = 1 is zero before contact, positive near contact under load,
    and -tr/3 of the stress."""
    disc(tmp_path, **HELD | {"fields": 5})
    shots = [vtu.read(path).fields for _, path in vtu.series(tmp_path / "run/fields.pvd")]
    assert all(shot["pressure"] == pytest.approx(-shot["cauchy_stress"][:, :3].sum(axis=1) / 3, rel=1e-6, abs=1e-3) for shot in shots)
    largest = [abs(shot["pressure"]).max() for shot in shots]
    assert largest[0] < 1e-6 * max(largest) and max(shot["pressure"].max() for shot in shots[1:]) > 1e5


def test_it_is_the_limit_of_nu(tmp_path):
    """The results for nu = 0.4999 tend to those of J = 1, with the same number of iterations to a
    quarter."""
    held = disc(tmp_path / "held", **HELD | {"accuracy": 0.02}).summary
    near = disc(tmp_path / "near", **HELD | {"accuracy": 0.02, "law": "neohookean", "nu": 0.4999}).summary
    assert held["impulse"] == pytest.approx(near["impulse"], rel=1e-3) and held["rebound_vy"] == pytest.approx(near["rebound_vy"], rel=2e-3)
    assert held["newton_iterations"] < 1.25 * near["newton_iterations"]
    assert near["volume_change"] > 1e-6 > held["volume_change"]


@pytest.mark.parametrize("law, own, script", [("neohookean", {}, "disc"), ("mooney-rivlin", {"share": 0.3}, "disc"),
                                              ("ogden", {"alpha": [1.3, 5], "mu": [0.6 * 14e6 / 3 / 1.3, 0.4 * 14e6 / 3 / 5]}, "ball-axisymmetric")])
def test_laws_with_j_1(tmp_path, law, own, script):
    """nu = 0.5 means J = 1 for any law of J: volume and energy are constant.

    In the plane the two invariants are then equal, and Mooney-Rivlin is neo-Hookean.
    """
    summary = disc(tmp_path / "one", script, **HELD | {"law": law} | own).summary
    assert summary["volume_change"] < 1e-6 and summary["energy_drift"] < 1e-9 and summary["volume"] == "projected"
    if script == "disc":
        named = disc(tmp_path / "named", script, **HELD).summary
        assert summary["impulse"] == pytest.approx(named["impulse"], rel=1e-5) and summary["contact_time"] == pytest.approx(named["contact_time"], rel=1e-4)


@pytest.mark.few(2)
@pytest.mark.parametrize("flags", [{"nu": 0.4}, {"degree": 1}, {"volume": "plain"}, {"integrator": "bdf2"}, {"integrator": "central-difference"}, {"law": "svk"}])
def test_what_cannot_be_incompressible_is_refused(tmp_path, flags):
    """One line with what is accepted: nu = 0.5, a law of J, quadratic elements with projected
    volume, the energy-momentum step."""
    with pytest.raises(BadInput, match="nu: 0.4 of law = incompressible .accepted: 0.5|: '.*', but nu = 0.5 .J = 1. needs another value .accepted: "):
        disc(tmp_path, **HELD | flags)
