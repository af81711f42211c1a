"""Runs of bodies with a law by its energy (law = "energy")."""

import pytest

import ffimpact as ff
from ffimpact.failure import MaterialFailed

MU = 2.4e6
TEXT = "mu/2*(I1-3) - mu*log(J) + la/2*log(J)^2"
COARSE = {"accuracy": 0.15}


def impact(material, speed=5.0, layers=(), **entries):
    disc = ff.Disc(radius=0.05, material=material, position=(0, 0.0501), velocity=(0, -speed), layer=list(layers) or None)
    return ff.Scene(bodies=[disc], obstacles=[ff.Plane()], **COARSE | entries)


def neohookean(nu=0.45, **more):
    return ff.NeoHookean(young=2 * MU * (1 + nu), nu=nu, density=1722, **more)


def energy(nu=0.45, text=TEXT, **more):
    return ff.Hyperelastic(text, mu=MU, la=2 * MU * nu / (1 - 2 * nu), density=1722, **more)


@pytest.mark.parametrize("more", [
    {"viscosity": 300.0, "bulk_viscosity": 100.0},
    {"loss": 0.1},
    {"branches": [[1e6, 1e-3]], "bulk_branches": [[1e6, 1e-3]]},
], ids=lambda more: next(iter(more)))
def test_damping_is_that_of_the_written_law(more, tmp_path):
    """Viscosity, flat loss and branches beside an energy dissipate what they do beside the same law,
    to the 1e-10 of round-off in iterations."""
    written, own = (ff.run(impact(material, end_time=0.006), out=tmp_path / name) for name, material in
                    (("written", neohookean(**more)), ("energy", energy(**more))))
    for name in ("impulse", "viscous_work", "contact_time"):
        assert own[name] == pytest.approx(written[name], rel=1e-10), name
    assert own["viscous_work"] > 0 and own["energy_drift"] < 1e-9


@pytest.mark.parametrize("outside", ["written", "energy"])
def test_layers_have_energies(outside, tmp_path):
    """A layer with the energy of its body and other numbers, or with a written law, is the layer of the
    written law."""
    soft = {"written": neohookean(), "energy": energy()}[outside]
    core = {"young": 4 * MU * (1 + 9 / 22), "nu": 9 / 22, "law": "neohookean"}   # lambda = 9 MU, mu = 2 MU
    other = {"parameters": {"mu": 2 * MU, "la": 9 * MU}, "law": "energy", "energy": TEXT}
    runs = [ff.run(impact(body, layers=[ff.Layer(radius=0.03, **entries)]), out=tmp_path / str(k))
            for k, (body, entries) in enumerate(((neohookean(), core), (soft, other), (energy(), core)))]
    for own in runs[1:]:
        for name in ("impulse", "contact_time"):
            assert own[name] == pytest.approx(runs[0][name], rel=1e-10), name
        assert own["energy_drift"] < 1e-9


def test_a_run_ends_where_the_energy_is_no_number(tmp_path):
    """Beyond the chains of Gent's law: exit code 12, with time and place."""
    with pytest.raises(MaterialFailed, match="a stress is not a number at t = .* s near X = "):
        ff.run(impact(ff.Gent(MU, 0.05, k=10 * MU, density=1722), speed=25), out=tmp_path)


@pytest.mark.parametrize("text, locks", [(TEXT, False), ("mu/2*(I1-3 - 2*log(J) + la/mu*log(J)^2)", True)], ids=["a term", "in a product"])
def test_an_energy_whose_volume_is_no_term_of_its_own_locks(text, locks, tmp_path):
    """At nu = 0.499 a warning by name says so, and only then."""
    result = ff.run(impact(energy(0.499, text), accuracy=0.3), out=tmp_path)
    warned = [line for line in result.warnings if line.startswith("locking: quadratic elements are too stiff at nu = 0.499 at points")]
    assert bool(warned) == locks and all("a term of J alone" in line for line in warned)


def test_a_volume_term_acts_on_elements_with_its_own_function(tmp_path):
    """K/2 (J - 1)^2 in place of K/2 (ln J)^2 at nu = 0.499 changes the impulse by less than a
    thousandth, as J is 1 to some 1e-3; the energy is exact to 1e-9."""
    text = "mu/2*(I1*J^(-2/3)-3) + (la + 2/3*mu)/2*{}^2"
    logarithm, quadratic = (ff.run(impact(energy(0.499, text.format(U))), out=tmp_path / name) for name, U in (("log", "log(J)"), ("J", "(J-1)")))
    assert 0 < abs(quadratic["impulse"] / logarithm["impulse"] - 1) < 1e-3
    assert quadratic["energy_drift"] < 1e-9
