"""nu -> 0.5 (edp/program/law/volume.idp): volume as the mean over an element, without locking, in
scripts and kernels."""

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.output import vtu
from ffimpact.report import drawing
from ffimpact.running import run
from verification.measure import measure


@pytest.mark.robustness
@pytest.mark.parametrize("script, size, tens", [("spinning", 0.03, 3), ("spinning-3d", 0.04, 4)])
def test_a_spinning_body_keeps_energy_and_momenta(script, size, tens):
    """A free body spins and vibrates for a hundred turns at nu = 0.4999.

    The ball has 40 steps per turn; with 30 some steps fail, which a run would halve.
    """
    numbers = measure(script, law="neohookean", nu=0.4999, spin=200, exponent=tens, tolerance=5e-14, mesh_size=size, contact_mesh_size=size)
    assert numbers["state"] == 0 and max(numbers["energy"], numbers["momentum"], numbers["angular"]) < 1e-9


@pytest.mark.robustness
def test_the_history_has_their_pressure(tmp_path):
    """The mean pressure in the last row equals the mean of the field over its deformed area, to 2
    %.

    The largest pressure exceeds that of the field, which is averaged around vertices, by less than
    a half. The figure is drawn. A plain body does not have these columns, and the scene knows which
    bodies have them.
    """
    result = run.run(scene.load("disc-normal-incompressible"), {"accuracy": 0.02, "end_time": 2e-3, "fields": 2}, tmp_path / "held", estimate=False)
    shot = vtu.read(result.folder / "fields/0001.vtu")
    field, moved = shot.fields["pressure"], shot.points + shot.fields["displacement"][:, :2]
    a, b, c = (moved[shot.triangles[:, k]] for k in range(3))
    area = abs(np.linalg.det(np.stack([b - a, c - a], axis=1)))
    assert result.history["hydrostatic_pressure"][-1] == pytest.approx(np.average(field[shot.triangles].mean(axis=1), weights=area), rel=0.02)
    assert field.max() < result.history["max_hydrostatic_pressure"][-1] < 1.5 * field.max()
    drawing.draw(result.folder)
    assert (result.folder / "figures/pressure.png").stat().st_size > 5000
    plain = run.run(scene.load("disc-normal"), {"accuracy": 0.2, "fields": 0}, tmp_path / "plain", estimate=False)
    assert list(result.history) == scene.load("disc-normal-incompressible").columns
    assert list(plain.history) == scene.load("disc-normal").columns == [name for name in result.history if "hydrostatic" not in name]
