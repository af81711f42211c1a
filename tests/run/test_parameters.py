"""The table of parameters, and scenes made of it."""

import pytest

from ffimpact.failure import BadInput
from ffimpact.freefem.describe import describe
from ffimpact.input import parameters
from ffimpact.input.table import LAWS, SCRIPTS


def test_the_scripts_take_what_the_table_says():
    """Every script starts with its parameters at their defaults and has the same laws."""
    description = describe()
    assert description["laws"].split("|") == list(LAWS) and description["scripts"].split("|") == list(SCRIPTS)
    for script in SCRIPTS:
        assert set(describe(script=script)["used"]) == set(parameters.names(script))


def test_each_script_takes_its_own_parameters():
    """A parameter that a script does not take is bad input with the scripts that do, with and
    without Python."""
    assert "block_width" in parameters.names("disc-block") and "block_width" not in parameters.names("disc-plane")
    assert parameters.check({"block_width": 3}, "disc-block") == {"block_width": 3.0}
    for script, name, value in (("disc-plane", "block_width", 3), ("bodies", "radius", 1)):
        with pytest.raises(BadInput) as error:
            parameters.check({name: value}, script)
        with pytest.raises(BadInput) as refusal:
            describe({name: value}, script)
        assert str(error.value) == str(refusal.value) == f"{name}: {script} takes no such parameter (accepted: in {'|'.join(parameters.PARAMETERS[name].scripts)})"
    with pytest.raises(BadInput, match="script: 'ball' is not known .accepted: disc-plane|disc-block|ball-axisymmetric|ball-plane|bodies|bodies-3d"):
        describe({}, "ball")
