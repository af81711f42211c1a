"""The friction laws of the paper's scripts (edp/paper/friction.idp), tabulated by the real FreeFem++,
and their figure."""

import numpy as np
import pytest

from examples.paper import friction_laws
from ffimpact.__main__ import guarded
from ffimpact.failure import Failure

STATIC, DYNAMIC, EPSILON = 0.7, 0.5, 0.02
CLOSED_FORMS = {"sqrt": lambda s: s / np.sqrt(s**2 + 1), "tanh": np.tanh, "linear": lambda s: np.clip(s, -1, 1),
                "linear-printed": lambda s: np.where(abs(s) < 1, s / 2, np.sign(s))}


@pytest.fixture(scope="module")
def laws(tmp_path_factory):
    values = dict(friction_static=STATIC, friction_dynamic=DYNAMIC, slip_velocity=EPSILON)
    table = friction_laws.tabulate(tmp_path_factory.mktemp("laws"), values)
    return table.assign(size_=table.v / EPSILON)


@pytest.mark.parametrize("law", CLOSED_FORMS)
def test_regularisations_are_their_closed_forms(laws, law):
    """With equal coefficients of 1 the ratio is phi of (13), with v/eps for linear and v/(2 eps)
    for the printed form."""
    points = laws[(laws.panel == "b") & (laws.law == law) & (abs(abs(laws.size_) - 1) > 1e-9)]
    assert len(points) > 700
    assert points.ratio.to_numpy() == pytest.approx(CLOSED_FORMS[law](points.size_.to_numpy()), abs=1e-12)


def test_coulomb_is_the_limit(laws):
    """For a small slip velocity the law is Coulomb's step: the sign of the velocity, and any value
    at rest."""
    points = laws[laws.panel == "a"]
    moving = abs(points.size_) > 1e-5
    assert (points.ratio[moving] == np.sign(points.v[moving])).all() and points.ratio.abs().max() == 1


def test_jump_from_static_to_dynamic(laws):
    """The ratio reaches mu_e within the slip velocity and is mu_d beyond it."""
    points = laws[laws.panel == "c"]
    stick, slip = points[points.side == "stick"], points[points.side == "slip"]
    assert stick.ratio.max() == pytest.approx(STATIC, rel=1e-9) and stick.size_.abs().max() < 1
    assert slip.ratio.abs().to_numpy() == pytest.approx(DYNAMIC) and slip.size_.abs().min() == pytest.approx(1)


def test_all_laws_are_odd(laws):
    """Friction opposes the velocity in both directions."""
    for _, points in laws.groupby(["panel", "law"]):
        assert points.ratio.to_numpy() == pytest.approx(-points.ratio.to_numpy()[::-1], abs=1e-15)
        assert (points.ratio * points.v >= 0).all()


def test_picture(tmp_path, capsys):
    """The command writes the table and the figure, and prints the path of the figure."""
    assert guarded(friction_laws.main, ["--out", str(tmp_path / "laws")]) == 0
    assert capsys.readouterr().out.strip().endswith("friction-laws.png")
    assert (tmp_path / "laws/friction-laws.png").stat().st_size > 20_000 and (tmp_path / "laws/laws.csv").exists()


def test_bad_coefficients_are_named(tmp_path):
    """The script refuses a dynamic coefficient above the static one with exit code 10."""
    with pytest.raises(Failure, match="friction_dynamic: 0.5 is out of range .accepted: 0 to 0.2.") as caught:
        friction_laws.tabulate(tmp_path, dict(friction_static=0.2, friction_dynamic=0.5))
    assert caught.value.code == 10


@pytest.mark.parametrize("arguments, line", [
    (["--friction_static", "x"], "friction_static: 'x' is not a number"),
    (["--slip_velocity", "0"], "slip_velocity: 0 is out of range"),
    (["--friction_static", "0", "--friction_dynamic", "0"], "friction_static: 0.0 is out of range"),
])
def test_bad_input_is_one_line(tmp_path, capsys, arguments, line):
    """Bad input gives exit code 10 and one line."""
    assert guarded(friction_laws.main, ["--out", str(tmp_path / "laws"), *arguments]) == 10
    error = capsys.readouterr().err
    assert error.startswith(f"ffimpact: {line}") and error.count("\n") == 1
