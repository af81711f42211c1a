"""The Python interface: scenes as models, runs, sweeps, comparisons, figures."""

import json
import subprocess
import sys
import tomllib

import jsonschema
import numpy as np
import pandas as pd
import pytest

import ffimpact as ff
from ffimpact import scene as files, schema
from ffimpact.__main__ import main
from ffimpact.output.results import read_history
from tests.support.api import drop


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    return ff.run(
        drop(), accuracy=0.1, fields=6, figures=False, out=tmp_path_factory.mktemp("api") / "run"
    )


# ---- scenes


@pytest.mark.parametrize("name", [name for name in files.built_in() if files.load(name).bodies])
def test_a_built_in_scene_of_bodies_is_the_same_written_and_read_again(tmp_path, name):
    """The scene as objects has the same bodies, obstacles and parameters as read from its file."""
    scene, read = ff.Scene.load(name), files.load(name)
    assert ff.Scene.load(scene.save(tmp_path / "scene.toml")) == scene
    again = scene.ready()
    assert (
        again.values == read.values
        and again.contact_values == read.contact_values
        and len(again.pairs) == len(read.pairs)
    )
    assert [(body.own_name, body.made_of, body.bulk_size) for body in again.bodies] == [
        (body.own_name, body.made_of, body.bulk_size) for body in read.bodies
    ]


# ---- results


def test_numbers_have_errors_and_units(result):
    """The impulse is that of the momentum, and its error bar the estimated share of it. A missing
    number is reported by name."""
    assert result["impulse"] == pytest.approx(
        1722 * np.pi * 0.05**2 * (8 + result["rebound_vy"]), rel=1e-3
    )
    assert result.errors["impulse"] == pytest.approx(
        result.summary["estimated_error"]["impulse"] * result["impulse"]
    )
    assert result.errors["rebound_vy"] == pytest.approx(
        result.summary["estimated_error"]["rebound"] * 8, rel=0.01
    )
    assert result.units["impulse"] == "N s/m" and result.units["t"] == "s"
    assert result.scene["body"][0]["young"] == 7e6 and isinstance(result.warnings, list)
    with pytest.raises(ff.BadInput, match="impulse"):
        result["impuls"]
    for contents in (result.summary, read_history(result.folder)):
        with pytest.raises(
            ff.Unreadable, match="'normal_forc' is not known.*(accepted: .*)"
        ) as raised:
            contents["normal_forc"]
        assert "\n" not in str(raised.value) and "delete" not in str(raised.value)
    assert "did you mean normal_force?" in str(raised.value)
    with pytest.raises(ff.BadInput, match="field: 'von_mise' is not known; did you mean von_mises"):
        result.plot.shapes(field="von_mise")


def test_units_of_a_ball_are_those_of_the_whole(tmp_path):
    """Only results in plane strain are per metre of thickness. Speeds keep their unit."""
    ball = ff.run(
        "ball-axisymmetric", accuracy=0.2, estimate=False, figures=False, out=tmp_path / "ball"
    )
    assert [ball.units[name] for name in ("impulse", "peak_force", "energy_initial", "mass")] == [
        "N s",
        "N",
        "J",
        "kg",
    ]
    assert ball.units["rebound_vy"] == "m/s"


def test_tables(result):
    assert isinstance(
        result.history, pd.DataFrame
    ) and result.history.normal_force.max() == pytest.approx(result["peak_force"])
    assert list(result.contacts.body) == [1] and "impulse" in result.table.index
    lines = repr(result).splitlines()
    assert 5 < len(lines) <= 14 and any(
        "impulse" in line and "±" in line and "N s/m" in line for line in lines
    )


def test_a_force_is_filtered(result):
    """Filtered forces keep the impulse and are drawn before the unfiltered ones. Without a filter
    they are those of the history."""
    plt = pytest.importorskip("matplotlib.pyplot")
    force, raw = result.force(filter="CFC 1000"), result.force()
    step = force.t[1] - force.t[0]
    assert force.normal_force.sum() * step == pytest.approx(result["impulse"], rel=0.01)
    assert raw.normal_force.equals(result.history.normal_force)
    assert force.normal_force.max() == pytest.approx(raw.normal_force.max(), rel=0.1)
    lines = result.plot.force(filter="CFC 1000").lines
    assert lines[0].get_label() == "normal, CFC 1000"
    assert lines[0].get_ydata() == pytest.approx(1e-3 * force.normal_force)
    assert lines[1].get_ydata() == pytest.approx(1e-3 * raw.normal_force)
    with pytest.raises(ff.BadInput, match="^filter: 'CFC 10' is no channel frequency class"):
        result.plot.force(filter="CFC 10")
    plt.close("all")


def test_states_are_arrays(result):
    """The lowest point, followed by probe(), moves as the states say. The centre of mass of the coarse
    mesh is 2.4e-6 m off that of the disc."""
    states = result.fields
    assert len(states) == len(states.times) and states[-1].von_mises.max() > 0
    lowest = states[0].positions[:, 1].argmin()
    path = result.probe(0, -0.05)
    moves = [state.positions[lowest, 1] for state in states]
    assert path.y.to_numpy() == pytest.approx(np.array(moves), abs=5e-6)


def test_a_state_is_a_grid(result):
    pytest.importorskip("pyvista")
    grid = result.fields[-1].to_pyvista()
    assert grid["von_mises"].max() == result.fields[-1].von_mises.max()


def test_a_player_is_one_file(result, tmp_path):
    path = result.view(tmp_path / "new folder/impact.html")
    assert path.stat().st_size > 1e5 and "<script" in path.read_text()[:10_000]


def test_a_player_shows_itself_as_html(result):
    """A notebook, and a page that keeps its output, contains the whole animation."""
    shown = result.view()._repr_html_()
    assert len(shown) > 1e5 and shown.startswith("<iframe") and "&lt;script" in shown[:10_000]


def test_a_run_that_is_there_is_not_made_again(result):
    assert ff.run(drop(), accuracy=0.1, fields=6, figures=False, out=result.folder).reused
    assert ff.load(result.folder)["impulse"] == result["impulse"]
    with pytest.raises(ff.Unreadable):
        ff.load("nowhere")


def test_comparison_says_what_agrees(result):
    """A run agrees with itself, and not with a run of another impulse."""
    other = ff.load(result.folder)
    assert ff.compare(result, other).agree.all()
    other.summary = other.summary | {"impulse": 2 * result["impulse"]}
    assert not ff.compare(result, other, names=["impulse"]).agree.any()


def test_results_are_compared_one_by_one_or_as_a_list(result):
    """An object that is not a result is refused in one line. A number that a run does not have is
    omitted."""
    assert ff.compare([result, result]).equals(ff.compare(result, result))
    with pytest.raises(ff.BadInput, match="'7' is no result"):
        ff.compare(result, 7)
    result.summary["made_up"] = None
    assert "made_up" not in result and "impulse" in result
    del result.summary["made_up"]


def test_a_result_is_of_one_run(tmp_path):
    """If another run has replaced the run in the folder, later reading raises an error."""
    first = ff.run(drop(), accuracy=0.2, estimate=False, figures=False, out=tmp_path / "run")
    ff.run(
        drop(),
        {"body.1.velocity.2": -4},
        accuracy=0.2,
        estimate=False,
        figures=False,
        out=tmp_path / "run",
    )
    with pytest.raises(ff.Unreadable, match="another run"):
        _ = first.history


def test_states_are_as_many_as_the_scene_says(tmp_path):
    """There are none if the scene requests none, and some if the entry is automatic."""
    none = ff.run(
        drop(fields=0), accuracy=0.3, estimate=False, figures=False, out=tmp_path / "none"
    )
    some = ff.run(drop(), accuracy=0.3, estimate=False, figures=False, out=tmp_path / "some")
    assert len(none.fields) == 0 < len(some.fields) <= 41


def test_a_sweep(tmp_path):
    """There is a row for each combination, in order. A failed run is a row with its code, existing
    runs are reused, error bars are drawn."""
    values = {"body.1.velocity.2": [-2, -4], "contact.friction_static": [0.1]}
    study = ff.sweep(drop(accuracy=0.2, fields=0), values, workers=2, out=tmp_path / "study")
    assert list(study.table["body.1.velocity.2"]) == [-2, -4] and (study.table.exit == 0).all()
    assert study.table.impulse[1] > 1.8 * study.table.impulse[0]
    ax = study.plot(x="body.1.velocity.2", y="restitution", by="contact.friction_static")
    assert ax.get_legend() and len(ax.containers) == 1
    made = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("summary.json")}
    ff.sweep(drop(accuracy=0.2, fields=0), values, workers=2, out=tmp_path / "study")
    assert len(made) == 2 and made == {
        path: path.stat().st_mtime_ns for path in tmp_path.rglob("summary.json")
    }
    with pytest.raises(ff.BadInput, match="impuls"):
        study.plot(x="body.1.velocity.2", y="impuls")
    study.axes, study.table["whole"] = [*study.axes, "whole"], [[0, -2], [0, -4]]
    with pytest.raises(ff.BadInput, match=r"'whole' .*\[0, -2\].* component"):
        study.plot(x="whole", y="impulse")


def test_a_sweep_of_a_file_and_one_in_python_are_the_same_study(tmp_path):
    """They have the same folders. A sweep with more values computes the new ones alone; the errors
    of the numbers are columns where they are estimated."""
    drop(accuracy=0.3).save(tmp_path / "drop.toml")
    file = tmp_path / "speeds.toml"
    file.write_text(
        'scene = "drop.toml"\nestimate = true\n[product]\nbody.1.velocity.2 = [-2, -4]\n'
    )
    assert main(["sweep", str(file), "--out", str(tmp_path / "study")]) == 0
    values = {"body.1.velocity.2": [-2, -4, -30]}
    study = ff.sweep(tmp_path / "drop.toml", values, fields=0, out=tmp_path / "study")
    assert list(study.table.reused) == [True, True, False] and (study.table.exit == 0).all()
    rows = pd.read_csv(tmp_path / "study/sweep.csv")
    assert rows.impulse_error.to_numpy() == pytest.approx(study.table.impulse_error[:2].to_numpy())
    assert study.results[0].errors["impulse"] == pytest.approx(rows.impulse_error[0])
    again = ff.sweep(
        tmp_path / "drop.toml",
        {"body.1.velocity.2": [-2]},
        fields=0,
        force=True,
        out=tmp_path / "study",
    )
    assert not again.table.reused[0]


def test_a_value_that_is_refused_is_a_row(tmp_path):
    """Unless all are refused."""
    scene = drop(accuracy=0.3, fields=0)
    study = ff.sweep(scene, {"body.1.nu": [0.3, 0.7]}, estimate=False, out=tmp_path)
    assert (
        list(study.table.exit) == [0, 10]
        and "0.7" in study.table.message[1]
        and study.results[1] is None
    )


def test_entries_of_a_sweep_hold_in_all_its_runs(tmp_path):
    """Common entries apply to all runs. Without an estimate no run has errors."""
    study = ff.sweep(
        drop(accuracy=0.3, fields=0),
        {"body.1.velocity.2": [-2]},
        {"body.1.young": 2e6},
        estimate=False,
        out=tmp_path,
    )
    assert study.results[0].scene["body"][0]["young"] == 2e6 and not study.results[0].errors


def test_importing_it_changes_nothing_global():
    """Importing changes neither settings and docstrings of matplotlib nor signals nor warning
    filters."""
    state = (
        "import json, signal, warnings, matplotlib.pyplot, pandas, pydantic, scipy.spatial, matplotlib as mpl; from matplotlib.lines import Line2D; "
        "state = lambda: [str(dict(mpl.rcParams)), str(signal.getsignal(signal.SIGINT)), str(signal.getsignal(signal.SIGTERM)), "
        "str(warnings.filters), Line2D.set.__doc__]; before = state(); "
    )
    code = (
        state
        + "import ffimpact as ff; [getattr(ff, name) for name in ff.__all__]; import ffimpact.plot; print(json.dumps(before == state()))"
    )
    done = subprocess.run(
        [sys.executable, "-W", "default", "-c", code], capture_output=True, text=True
    )
    assert done.returncode == 0 and json.loads(done.stdout), done.stderr


# ---- the schema of scene files


@pytest.fixture(scope="module")
def validator():
    document = json.loads(schema.text())
    jsonschema.Draft202012Validator.check_schema(document)
    return jsonschema.Draft202012Validator(document)


@pytest.mark.parametrize("name", files.built_in())
def test_built_in_scenes_are_valid_by_the_schema(validator, name):
    """They contain the name of the schema for editors."""
    text = (files.SCENES / f"{name}.toml").read_text()
    assert validator.is_valid(tomllib.loads(text))
    assert text.startswith(f"#:schema {schema.FILE.name}\n")


@pytest.mark.parametrize(
    "changed",
    [
        {"accuracy": 3},
        {"accurcy": 0.1},
        {"body": [{"shape": "disc", "radius": 0.05, "position": [0, 1], "yong": 3}]},
        {"body": [{"shape": "disc", "position": [0, 1]}]},
        {"contact": {"regularization": "cubic"}},
    ],
)
def test_the_schema_refuses_what_the_program_refuses(validator, changed):
    assert validator.is_valid(drop().table()) and not validator.is_valid(drop().table() | changed)


def test_python_and_the_command_leave_the_same_folder(tmp_path):
    """The same files, with figures by default and without them on request."""
    path = tmp_path / "drop.toml"
    drop(accuracy=0.4, fields=2).save(path)

    def files(name: str) -> set[str]:
        folder = tmp_path / name
        return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}

    ff.run(path, estimate=False, out=tmp_path / "python")
    ff.run(path, estimate=False, figures=False, out=tmp_path / "plain")
    words = ["run", str(path), "--no-estimate", "--out"]
    assert main([*words, str(tmp_path / "command")]) == 0
    assert main([*words, str(tmp_path / "without"), "--no-figures"]) == 0
    assert files("python") == files("command") >= {"figures/energies.png", "summary.json"}
    assert (
        files("plain")
        == files("without")
        == {name for name in files("python") if not name.startswith("figures/")}
    )


def test_a_run_is_watched_and_stopped(tmp_path):
    """The function sees time, steps and history; what it stops has no estimate and is not reused."""
    seen = []

    def watch(progress: ff.Progress) -> bool:
        seen.append((progress.t, len(progress.history)))
        return progress.steps > 20

    given = {"dt": 1e-6, "fields": 0, "end_time": 0.05}  # 50,000 steps
    result = ff.run(drop(**given), figures=False, out=tmp_path / "run", watch=watch)
    assert result["ended"] == "stopped" and result["steps"] < 40_000 and not result.errors
    assert (
        len(seen) > 1
        and seen[-1][0] > seen[0][0]
        and result.history.t.iloc[-1] >= 0.9999 * seen[-1][0]
    )
    assert not (result.folder / "stop").exists()
    again = ff.run(drop(**given), figures=False, out=tmp_path / "run", watch=lambda progress: True)
    assert not again.reused and again["ended"] == "stopped"
    end = again.history.t.iloc[-1] + 2e-5
    longer = again.extend(end, estimate=False, figures=False)
    assert longer["ended"] == "end_time" and longer.history.t.iloc[-1] == pytest.approx(end)


def test_a_short_run_is_stopped_too(tmp_path):
    """A run of a tenth of a second is asked to stop at the first look: it ends before its impact is
    over, or counts as stopped if it was faster; no finer run follows, and nothing is estimated."""
    seen: list[int] = []

    def watch(progress: ff.Progress) -> bool:
        seen.append(progress.steps)
        return True

    result = ff.run(drop(accuracy=0.1), figures=False, out=tmp_path / "run", watch=watch)
    assert result["ended"] == "stopped" and seen and not result.errors
    assert not any(words.startswith("not over") for words in result.summary["warnings"])


def test_an_error_of_the_function_that_watches_ends_the_run(tmp_path):
    def watch(progress: ff.Progress) -> None:
        raise ValueError("mine")

    with pytest.raises(ValueError, match="mine"):
        ff.run(drop(accuracy=0.2), out=tmp_path / "run", watch=watch)
    assert not (tmp_path / "run/summary.json").exists()


def test_without_estimate_there_is_one_run(tmp_path, capsys):
    """The option --no-estimate makes no second run. Report and summary say that the error is not
    estimated."""
    path = tmp_path / "drop.toml"
    drop(accuracy=0.4, fields=0).save(path)
    assert (
        main(["run", str(path), "--no-estimate", "--no-figures", "--out", str(tmp_path / "a")]) == 0
    )
    result = ff.load(tmp_path / "a")
    assert (
        "not estimated" in capsys.readouterr().out and "error estimate" in result.summary["skipped"]
    )
    assert result["estimated_error"] is None and not result.errors
    assert "refinements" not in result.summary  # an entry of the second run


def test_a_misspelt_argument_is_named():
    """An argument of run() that is misspelt is no entry of the scene."""
    with pytest.raises(ff.BadInput, match="watc: no such argument; did you mean watch"):
        ff.run("disc-normal", watc=print)
