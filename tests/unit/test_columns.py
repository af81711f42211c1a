"""The table of what a run records: it is complete, and the scripts and stored runs have its names."""

import json
import re
from pathlib import Path

import pytest

from ffimpact import scene
from ffimpact.output.columns import ENTRIES, FILES, NEEDS, units
from ffimpact.places import ROOT

SCRIPTS = ROOT / "edp/program/run"
STORED = json.loads((Path(__file__).parents[1] / "support/recorded.json").read_text())
UNITS = {*("", "1", "s", "m", "m2", "m/s", "rad/s", "degrees", "kg/m", "byte"),
         *("N/m", "N s/m", "N m/m", "N m s/m", "J/m", "Pa")}
# Conditions in the scripts of what some columns need.
CONDITIONS = {"penaltyDamping > 0": "penalty_damped", "damped": "damped", "hasMetals": "metals",
              "projected": "projected", "solid": "solid"}


@pytest.mark.parametrize("file", FILES)
def test_every_column_has_a_unit_and_a_meaning(file):
    """The unit is one of those of the program, the meaning no empty text; what a column needs is a
    word that is explained. No name stands twice."""
    rows = [row for table in FILES[file] for row in table]
    assert {row.unit for row in rows} <= UNITS
    assert all(row.meaning.strip() == row.meaning != "" for row in rows)
    assert {row.needs for row in rows} <= {"", *NEEDS} and all(row.whole or row.part for row in rows)
    for kind in ("whole", "part"):
        names = [row.name for row in rows if getattr(row, kind)]
        assert len(names) == len(set(names))


@pytest.mark.parametrize("stored", STORED, ids=[run["scene"] for run in STORED])
def test_a_scene_has_the_columns_that_its_run_has_recorded(stored):
    """Names and order of the table are those of stored runs: two bodies; damped ones with projected
    volume; supports; a rigid body; a gas; three dimensions."""
    used = scene.load(stored["scene"]).override(stored["set"])
    written = stored["summary.json"].split(",")
    assert used.columns == stored["history.csv"].split(",")
    assert [name for name in written if name in used.numbers] == used.numbers
    others = {row.name for row in ENTRIES} | {"kernels", "reverse_slip_time"}   # of older versions
    assert set(written) - set(used.numbers) <= others


def names_of(text: str, call: str) -> list[tuple[str, str]]:
    """The names in calls of `call` in a script, each with what the scene needs, by the condition
    around the call."""
    found, needs, inside = [], "", False
    for line in text.splitlines():
        if match := re.match(r"  if \((.*?)\) \{(.*)", line):
            needs, inside = CONDITIONS[match[1]], "}" not in match[2]
        elif not inside:
            needs = ""
        found += [(name, needs) for name in re.findall(rf'{call}\("(\w+)"', line)]
        inside = inside and not line.startswith("  }")
    return found


@pytest.mark.parametrize("table, kind, name", [
    (0, "whole", "columns"), (0, "part", "columnsOfBody"), (1, "part", "columnsOfSupport"),
    (2, "part", "columnsOfGas"), (3, "part", "columnsOfLayer")])
def test_scripts_write_the_columns_of_the_table(table, kind, name):
    """columns.idp lists the names of the table in its order, under the same conditions."""
    text = (SCRIPTS / "columns.idp").read_text()
    listed = re.search(rf"macro {name}\(act\)(.*?)//\n", text, re.S)[1]
    expected = [(row.name, row.needs) for row in FILES["history.csv"][table] if getattr(row, kind) and row.needs != "directed"]
    assert names_of(listed, "act") == [row for row in expected if row[0] != "t"]


@pytest.mark.parametrize("script", ["edp/paper/record.idp", "edp/disc-block.edp"])
def test_scripts_of_the_paper_write_names_of_the_table(script):
    """The columns of history.csv that a script of the paper writes are columns of the program's."""
    head = re.search(r'history << ("t,dt.*?)<< endl;', (ROOT / script).read_text(), re.S)[1]
    written = {name for text in re.findall('"(.*?)"', head) for name in text.split(",") if len(name) > 1 or name in "txy"}
    known = {row.name for table in FILES["history.csv"] for row in table}
    assert len(written) > 10 and written <= known | {"", "_"}


def test_units_are_per_metre_in_plane_strain_alone():
    """A number or column of a body has the unit of its bare name; of balls the last /m is left out."""
    plane, ball = (units(per_metre, ["mass_2", "other_1"]) for per_metre in ("/m", ""))
    assert (plane["peak_force"], ball["peak_force"]) == ("N/m", "N")
    assert (plane["mass_2"], ball["mass_2"]) == ("kg/m", "kg") and "other_1" not in plane
    assert plane["force_x_2"] == "N/m" and "dofs_2" not in plane
    assert plane["vx"] == ball["vx"] == "m/s" and ball["angular_momentum"] == "N m s"
