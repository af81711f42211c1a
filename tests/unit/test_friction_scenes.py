"""Scenes with friction: loading, runs, reports and the figures 4 to 6 of the paper."""

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.report import figures
from ffimpact.report.impact import impact_of
from ffimpact.scene import RUN


@pytest.mark.parametrize("name", scene.built_in())
def test_built_in_scenes_load(name):
    """Every built-in scene has a title, a script of its kind and every parameter."""
    loaded = scene.load(name)
    assert loaded.title != name and set(loaded.values) == set(RUN) & set(loaded.names(loaded.kind))


def test_scenes_of_the_paper():
    """Both oblique scenes are section 3.1: 12 m/s at 60 degrees, 0.7 static, 0.5 dynamic. Only the
    law and the mesh differ."""
    stated = dict(kind="disc", speed=12, angle=60, friction_static=0.7, friction_dynamic=0.5, density=1722, young=7e6, radius=0.05)
    converged, printed = (impact_of(scene.load(name).content) for name in ("disc-oblique", "disc-oblique-svk"))
    assert stated.items() <= converged.items() and stated.items() <= printed.items()
    assert {name for name in {*converged, *printed} if converged.get(name) != printed.get(name)} == {
        "title", "law", "breakdown", "degree", "mesh_size", "contact_mesh_size", "accuracy"}


def test_rigid_rolling_is_the_closed_form():
    """A rigid disc slides with v0 - mu_d g t, gains rim speed twice as fast, and rolls with 2/3 v0
    from v0/(3 mu_d g) on."""
    used = impact_of(scene.load("disc-rolling").content)
    v0, pull = used["speed"], used["friction_dynamic"] * used["gravity"]
    t = np.array([0.0, 0.5, 1.0, 2.0]) * v0 / (3 * pull)
    centre, rim = figures.rigid_rolling(t, used)
    assert centre == pytest.approx(v0 * np.array([1, 5 / 6, 2 / 3, 2 / 3])) and rim == pytest.approx(v0 * np.array([0, 1 / 3, 2 / 3, 2 / 3]))
    spun = figures.rigid_rolling(t, used | {"spin": -v0 / used["radius"]})
    assert np.ptp(spun) == 0  # it rolls from the start
    for other in ({"angle": 60.0}, {"gravity": 0.0}, {"height": 0.1}, {"friction_dynamic": 0.0}):
        assert figures.rigid_rolling(t, used | other) is None
