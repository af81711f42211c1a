"""Energies of laws as expressions: what is accepted, their moduli, and the laws of the literature."""

import numpy as np
import pytest

import ffimpact as ff
from ffimpact import scene
from ffimpact.__main__ import main
from ffimpact.failure import BadInput
from ffimpact.input.energies import energy
from ffimpact.input.toml_text import to_toml

NEOHOOKEAN = "mu/2*(I1-3) - mu*log(J) + la/2*log(J)^2"
PLANE = [{"kind": "plane"}]


def made(text, nu=None, **parameters):
    return ff.Hyperelastic(text, density=1100, nu=nu, parameters=parameters)


def disc(**entries):
    return {"body": [{"shape": "disc", "radius": 0.05, "position": [0, 0.06], "velocity": [0, -1]} | entries], "obstacle": PLANE}


@pytest.mark.parametrize("text, parameters, lame, mu", [
    (NEOHOOKEAN, {"mu": 2e6, "la": 8e6}, 8e6, 2e6),
    ("c10*(I1-3) + c20*(I1-3)^2 - 2*c10*log(J) + k/2*log(J)^2", {"c10": 1e6, "c20": 2e5, "k": 1e7}, 1e7 + 8 * 2e5, 2e6),
    ("l/8*(I1-3)^2 + m/4*(I1^2 - 2*I2 - 2*I1 + 3)", {"l": 3e6, "m": 2e6}, 3e6, 2e6),   # St. Venant-Kirchhoff
    ("mu/2*(I2/J^2 + 2*J - 5)", {"mu": 2e6}, 2e6, 2e6),
    ("m/p*(L1^p + L2^p + L3^p - 3 - p*log(J)) + k/2*log(L1*L2*L3)^2", {"m": 1e6, "p": 3, "k": 5e6}, 5e6, 1.5e6),
    ("c*(I1*J^(-2/3)-3) + K/2*(J-1)^2", {"c": 1e6, "K": 1e7}, 1e7 - 4e6 / 3, 2e6),
])
def test_moduli_at_rest(text, parameters, lame, mu):
    """lambda and mu of textbooks, young and nu of them."""
    assert energy(text, parameters).moduli(held=False) == pytest.approx((lame, mu), rel=1e-14)
    follow = made(text, **parameters).made
    assert follow["nu"] == pytest.approx(lame / 2 / (lame + mu), rel=1e-14)
    assert follow["young"] == pytest.approx(mu * (3 * lame + 2 * mu) / (lame + mu), rel=1e-14)


def test_slopes_are_those_of_values():
    """dW/dL agrees with differences of W, for invariants and for stretches."""
    points = np.random.default_rng(0).uniform(0.6, 1.6, (20, 3))
    for text in ("I1*I2/J + exp(I1/J) - sqrt(I2)*log(J)", "L1*L2*L3 + L1^3.5 + L2^3.5/L1 + log(J)*exp(L3)"):
        W = energy(text, {})
        for k, step in enumerate(1e-5 * np.eye(3)):
            slope = (W.values(W.code, points + step) - W.values(W.code, points - step)) / 2e-5
            assert W.slopes(W.code, points)[:, k] == pytest.approx(slope, rel=1e-8, abs=1e-8)


@pytest.mark.parametrize("text, parameters, what", [
    ("", {}, "energy: '' is no expression"),
    ("  ", {}, "energy: '  ' is no expression"),
    ("I1 - 3 +" + "0" * 1000, {}, "energy: 1008 characters (accepted: up to 1000)"),
    ("I1-3", {}, "energy: has the stress 2 Pa at rest (accepted: 0, or nu = 0.5: J = 1)"),
    ("2*log(J) - (I1-3) + 3*log(J)^2", {}, "energy: has the shear modulus -2 Pa at rest (accepted: more than 0)"),
    ("I1/2 - log(J) - 5*log(J)^2", {}, "energy: has the bulk modulus -9.33333 Pa at rest (accepted: more than 0)"),
    (NEOHOOKEAN, {"mu": 1, "la": 1e5}, "energy: makes Poisson's ratio 0.499995 (accepted: up to 0.4999, or nu = 0.5: J = 1)"),
    ("log(J-1)", {}, "energy: has no value or no derivative at or near rest, I1 = I2 = 3, J = 1"),
    ("sqrt(I1-3)", {}, "energy: has no value or no derivative at or near rest"),
    ("(I1-3)^1.5 + I1 - 2*log(J)", {}, "energy: has no value or no derivative at or near rest"),
    ("sqrt(-J)", {}, "energy: has no value or no derivative at or near rest"),
    ("I1^1e9", {}, "energy: has no value or no derivative at or near rest"),
    ("I1 - 2*log(J) + 1/(J-1)", {}, "energy: has no value or no derivative at or near rest"),
    ("L1 + I1", {}, "energy: has invariants beside stretches (accepted: I1, I2, J or L1, L2, L3, J)"),
    ("2*L1^2 + L2^2 + L3^2 - 2*log(L1*J) + log(J)^2", {}, "energy: changes when stretches change places (accepted: symmetric in L1, L2, L3)"),
    ("c*I1", {}, "energy: 'c' has no number (accepted: I1, I2, J or L1, L2, L3, J, and names in parameters)"),
    ("i1 - 2*log(J)", {}, "energy: 'i1' has no number"),
    ("I1 - 2*log(J) + log(J)^2", {"c": 3}, "parameters.c: is not in energy (accepted: without it)"),
    ("I1 - 2*log(J) + log(J)^2", {"J": 3}, "parameters.J: is a name of energy itself (accepted: another name)"),
    (NEOHOOKEAN, {"mu": "x", "la": 1}, "parameters.mu: 'x' is not a number"),
    (NEOHOOKEAN, {"mu": 1e19, "la": 1}, "parameters.mu: 1e+19 is out of range"),
    ("abs(J-1)", {}, "energy: 'abs(J - 1)' in 'abs(J-1)' is not known (accepted: numbers, pi, "),
    ("__import__('os').system('true')", {}, "energy: '__import__('os').system('true')' in"),
    ("(lambda: I1)()", {}, "energy: '(lambda: I1)()' in"),
    ("[I1 for I1 in J]", {}, "energy: '[I1 for I1 in J]' in"),
    ("I1.real", {}, "energy: 'I1.real' in"),
    ("I1^J", {}, "energy: '^ J' in 'I1^J' is not known"),
    ("I1 +", {}, "energy: 'I1 +' is no expression"),
])
def test_what_is_refused(text, parameters, what):
    """One line with the entry and the reason; exit code 10 on the command line."""
    with pytest.raises(BadInput) as refused:
        made(text, **parameters)
    assert str(refused.value).startswith(f"Hyperelastic: {what}") and "\n" not in str(refused.value)


def test_a_refused_energy_ends_a_command_with_exit_code_10(tmp_path, capsys):
    file = tmp_path / "scene.toml"
    for parameters, what in (({"mu": 1e6}, "body.1.energy: 'la' has no number"), ({"mu": -1e6, "la": 1e7}, "body.1.energy: has the shear modulus -1e+06 Pa"),
                             ({"mu": 1e6, "la": 1e7, "b": 3}, "body.1.parameters.b: is not in energy"), ([1], "body.1.parameters: '[1]' is no table")):
        file.write_text(to_toml(disc(law="energy", density=1100, energy=NEOHOOKEAN, parameters=parameters)))
        assert main(["run", str(file), "--out", str(tmp_path / "out")]) == 10
        error = capsys.readouterr().err
        assert what in error and error.count("\n") == 1


@pytest.mark.parametrize("entries, what", [
    ({"law": "energy"}, "energy: is missing, of law = energy"),
    ({"law": "svk", "young": 1e6, "nu": 0.3, "energy": NEOHOOKEAN}, "energy: of law = energy, not of svk"),
    ({"law": "svk", "young": 1e6, "nu": 0.3, "parameters": {}}, "parameters: of law = energy, not of svk"),
    ({"law": "energy", "energy": NEOHOOKEAN, "parameters": {"mu": 1e6, "la": 1e6}, "nu": 0.3}, "nu: 0.3 beside energy, which makes it 0.25 (accepted: without it or 0.5: J = 1)"),
    ({"law": "energy", "energy": NEOHOOKEAN, "parameters": {"mu": 1e6, "la": 1e6}, "young": 7e6}, "young: 7e+06 beside energy, which makes it 2500000 (accepted: without it)"),
])
def test_entries_that_do_not_agree(entries, what):
    with pytest.raises(BadInput, match="energy|parameters|nu|young") as refused:
        ff.Scene.read(disc(density=1100, **entries)).ready()
    assert what in str(refused.value)


def test_a_table_comes_back(tmp_path):
    """A scene file, its body and the material of that are what they were made from."""
    rubber = ff.Hyperelastic(NEOHOOKEAN, mu=1e6, la=8e6, density=1100, viscosity=30)
    assert rubber.parameters == {"mu": 1e6, "la": 8e6}
    ball = ff.Disc(radius=0.05, material=rubber, position=(0, 0.06), velocity=(0, -1))
    file = ff.Scene(bodies=[ball], obstacles=[ff.Plane()]).save(tmp_path / "scene.toml")
    again = ff.Scene.load(file).bodies[0]
    assert again.material == rubber and again.made_of.numbers == rubber.numbers
    assert again.made_of.nu == pytest.approx(4 / 9) and again.made_of.young == pytest.approx(26e6 / 9)


def test_entries_that_follow_are_reset():
    """`energy` and its numbers make young and nu, except nu = 0.5; another law is without them."""
    svk = scene.load("disc-normal")
    W = svk.override({"law": "energy", "energy": NEOHOOKEAN, "parameters": {"mu": 1e6, "la": 8e6}})
    assert W.bodies[0].made_of.nu == pytest.approx(4 / 9) and sum("is reset" in line for line in W.released) >= 2
    softer = W.override({"parameters.la": 2e6})
    assert softer.bodies[0].made_of.nu == pytest.approx(1 / 3)
    held = W.override({"nu": 0.5}).override({"parameters.mu": 3e6})
    assert held.bodies[0].made_of.nu == 0.5 and held.bodies[0].made_of.young == pytest.approx(9e6)
    other = W.override({"law": "neohookean", "young": 1e6, "nu": 0.3})
    assert other.bodies[0].made_of.numbers == [] and "energy" not in other.bodies[0].made_of


def test_a_layer_and_a_body_take_their_own_energies():
    """A layer takes the energy of its body with numbers of its own, or a law without one."""
    core = {"radius": 0.02, "parameters": {"mu": 4e6, "la": 8e6}}
    steel = {"radius": 0.01, "law": "neohookean", "young": 1e9, "nu": 0.3}
    tables = disc(law="energy", density=1100, energy=NEOHOOKEAN, parameters={"mu": 1e6, "la": 8e6}, layer=[core, steel])
    body, inner, centre = ff.Scene.read(tables).ready().bodies[0].materials
    assert (body.nu, inner.nu, centre.nu) == pytest.approx((4 / 9, 1 / 3, 0.3))
    assert centre.numbers == [] and inner.numbers[3:] != body.numbers[3:]


def points(count=30):
    return np.random.default_rng(4).uniform(0.7, 1.5, (count, 3))


@pytest.mark.parametrize("material, formula", [
    (ff.Yeoh(1e6, -1e5, 2e4, k=9e6, density=1), lambda L, I, J: 1e6 * (I - 3) - 1e5 * (I - 3) ** 2 + 2e4 * (I - 3) ** 3 + 9e6 / 4 * (J**2 - 1 - 2 * np.log(J))),
    (ff.Gent(2e6, 30, k=9e6, density=1), lambda L, I, J: -30e6 * np.log(1 - (I - 3) / 30) + 9e6 / 4 * (J**2 - 1 - 2 * np.log(J))),
    (ff.ArrudaBoyce(2e6, 8, k=9e6, density=1), lambda L, I, J: 2e6 * ((I - 3) / 2 + (I**2 - 9) / 160 + 11 * (I**3 - 27) / 67200 + 19 * (I**4 - 81) / 3584000
                                                + 519 * (I**5 - 243) / 2759680000) + 9e6 / 4 * (J**2 - 1 - 2 * np.log(J))),
    (ff.BlatzKo(2e6, density=1), lambda L, I, J: 1e6 * ((1 / L**2).sum(axis=1) + 2 * J - 5)),
    (ff.Hyperfoam([1e6, 2e5], [2, -3], [0.2, 0], density=1), lambda L, I, J: 5e5 * ((L**2).sum(axis=1) - 3 + (J ** (-2 / 3) - 1) * 3)
                                                + 4e5 / 9 * ((L**-3.0).sum(axis=1) - 3 + 3 * np.log(J))),
], ids=["Yeoh", "Gent", "Arruda-Boyce", "Blatz-Ko", "hyperfoam"])
def test_laws_of_the_literature_have_their_energies(material, formula):
    """Values at random stretches are those of the formula of the literature."""
    L, W = points(), material.expression
    J = L.prod(axis=1)
    expected = formula(L, (L**2).sum(axis=1) * J ** (-2 / 3), J)
    assert W.values(W.code, L) == pytest.approx(expected, rel=1e-12, abs=1e-6)


def test_laws_of_rubber_without_k_keep_the_volume():
    assert ff.Gent(1e6, 30, density=1100).made == pytest.approx({"nu": 0.5, "young": 3e6})
    assert ff.Yeoh(1e6, k=1e9, density=1100).made["nu"] < 0.5
    with pytest.raises(BadInput, match="as many as of mu and alpha"):
        ff.Hyperfoam([1e6], [2, 3], [0.2], density=1)


def test_only_a_term_of_the_volume_alone_acts_on_elements():
    """J alone: K of all its terms; multiplied by something else: none."""
    alone, mixed = energy(NEOHOOKEAN, {"mu": 1e6, "la": 1e9}), energy("mu/2*(I1-3 - 2*log(J) + la/mu*log(J)^2)", {"mu": 1e6, "la": 1e9})
    assert alone.numbers(False)[1] == pytest.approx(1e9) and mixed.numbers(False)[1] == 0
