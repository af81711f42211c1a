"""`integrator = auto`: explicit steps if they are cheaper by their number, else the default. The
choice is reported."""

import pytest

from ffimpact import scene
from ffimpact.output import results
from ffimpact.running import run
from verification.measure import disc, impact

BALL = {"law": "neohookean", "nu": 0.4, "accuracy": 0.1, "integrator": "auto"}
# Small elements near contact: many substeps.
FINE = BALL | {"mesh_size": 0.02, "contact_mesh_size": 0.0008, "accuracy": 0.02}


@pytest.mark.parametrize("script, flags, chosen, why", [
    ("disc", BALL | {"accuracy": 0.0025, "end_time": 1e-3}, "central-difference", "implicit steps (a step takes "),
    ("disc", FINE | {"end_time": 1e-3}, "energy-momentum", "explicit steps (a step takes "),
    ("disc", BALL | {"loss": 0.1, "loss_model": "kelvin-voigt", "end_time": 1e-3}, "energy-momentum", "explicit steps (viscosity or relaxation needs implicit steps)")], ids=["small elements", "fine contact", "viscous"])
def test_the_cheaper_one_is_taken_and_said(tmp_path, script, flags, chosen, why):
    """The choice depends on the substeps of a step and the unknowns.

    The summary and the scene as used have the integrator, `skipped` has the reason, and the run
    equals that of this integrator to round-off.
    """
    tables = impact(script, **flags)
    taken, named = (run.run(scene.read(tables | {"integrator": word}, tmp_path, word), {}, tmp_path / word, estimate=False)
                    for word in ("auto", chosen))
    assert taken.summary["integrator"] == chosen == results.read_scene(taken.folder)["integrator"]
    assert any(words.startswith(why) for words in taken.summary["skipped"])
    history = results.read_history(taken.folder)
    for name, column in results.read_history(named.folder).items():
        assert history[name] == pytest.approx(column, rel=0, abs=1e-10 * max(abs(column))), name


def test_parts_are_dearer_between_bodies(tmp_path):
    """If gap Jacobians change, each substep solves contact several times.

    Two discs take implicit steps for a number of substeps for which a disc on a plane takes
    explicit ones.
    """
    summary = run.run(scene.load("two-discs"), {"integrator": "auto", "accuracy": 0.02, "contact.friction_static": 0.0}, tmp_path, estimate=False).summary
    parts = int(next(words for words in summary["skipped"] if "explicit substeps" in words).split("takes ")[1].split()[0])
    assert summary["integrator"] == "energy-momentum" and parts < summary["dofs"]**0.4


def test_the_count_of_parts_is_that_of_the_run(tmp_path):
    """The choice uses the number of substeps of a step, for half and quarter bodies as for whole
    ones."""
    for script, accuracy in (("ball", 0.005), ("disc", 0.005), ("ball-axisymmetric", 0.005)):
        result = disc(tmp_path / script, script, **BALL | {"accuracy": accuracy})
        sentence = next(words for words in result.summary["skipped"] if "explicit substeps" in words)
        parts = result.history["newton_iterations"].max()
        assert int(sentence.split("takes ")[1].split()[0]) == pytest.approx(parts, abs=1), script
