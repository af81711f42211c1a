"""The Python interface in a notebook: every cell runs, and tables and figures are shown."""

import os
import subprocess
import sys
from importlib.util import find_spec

import pytest

from tests.support.block import CELLS, HISTORY, PLAYER, PLOTS, RESULT, STATE, STUDY, SWEEP

nbformat = pytest.importorskip("nbformat")
if missing := [name for name in ("nbclient", "ipykernel") if find_spec(name) is None]:
    pytest.skip(f"not installed: {', '.join(missing)}", allow_module_level=True)

# This runs in a process of its own: nbclient imports ipykernel, and the program takes a process
# with ipykernel for a notebook.
EXECUTE = """
import nbclient, nbformat
notebook = nbformat.read("block.ipynb", 4)
nbclient.NotebookClient(notebook, timeout=300, allow_errors=True).execute()
nbformat.write(notebook, "executed.ipynb")
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("notebook")


@pytest.fixture(scope="module")
def outputs(folder):
    """The outputs of each cell, after the whole notebook ran in an empty folder."""
    cells = [nbformat.v4.new_code_cell(cell.strip()) for cell in CELLS]
    nbformat.write(nbformat.v4.new_notebook(cells=cells), folder / "block.ipynb")
    # The kernel draws into the notebook.
    environment = {name: value for name, value in os.environ.items() if name != "MPLBACKEND"}
    done = subprocess.run([sys.executable, "-c", EXECUTE], cwd=folder, env=environment, capture_output=True, text=True, timeout=400)
    assert done.returncode == 0, done.stderr
    return {cell: made.outputs for cell, made in zip(CELLS, nbformat.read(folder / "executed.ipynb", 4).cells)}


def count(outputs: list, kind: str) -> int:
    """The number of outputs that can be shown as `kind`."""
    return sum(kind in output.get("data", {}) for output in outputs)


def test_no_cell_fails(outputs):
    """All cells run in their order in one kernel."""
    assert not [output for made in outputs.values() for output in made if output.output_type == "error"]


def test_results_and_tables_are_html(outputs):
    """A result and the table of a sweep are shown as tables."""
    assert count(outputs[RESULT], "text/html") == 1 and count(outputs[SWEEP], "text/html") == 1


@pytest.mark.parametrize("cell, pictures", [(HISTORY, 1), (PLOTS, 3), (STUDY, 1)], ids=["history", "plots", "study"])
def test_figures_are_shown(outputs, cell, pictures):
    """A cell that draws shows each of its figures once."""
    assert count(outputs[cell], "image/png") == pictures


@pytest.mark.parametrize("cell", [STATE, PLAYER], ids=["state", "player"])
def test_states_and_player(folder, outputs, cell):
    """Both print a line; the player is a file."""
    (message,) = ["".join(output.text for output in outputs[cell] if output.output_type == "stream" and output.name == "stdout")]
    assert message.count("\n") == 1 and (folder / "impact.html").stat().st_size > 1e4
