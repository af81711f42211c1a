"""The Python interface: scenes as models, runs, sweeps, comparisons, figures."""

import inspect
import json

import numpy as np
import pytest

import ffimpact as ff
from ffimpact import schema
from ffimpact.__main__ import main
from ffimpact.failure import of_code
from tests.support.api import RUBBER, drop


def test_numpy_and_plain_numbers_are_the_same():
    disc = ff.Disc(
        radius=np.float64(0.05),
        material=RUBBER,
        position=np.array([0, 0.051]),
        velocity=np.array([0.0, -8]),
    )
    assert (
        ff.Scene(bodies=[disc], obstacles=[ff.Plane()], contact=ff.Contact(friction_static=0.3))
        == drop()
    )


def test_entries_are_set_by_dotted_names():
    changed = drop().set(
        **{"body.1.velocity.2": -4, "contact.friction_static": 0.1, "accuracy": 0.02}
    )
    assert (
        changed.bodies[0].velocity == [0.0, -4.0]
        and changed.contact.friction_static == 0.1
        and changed.accuracy == 0.02
    )
    assert changed != drop()


def test_an_entry_set_to_none_is_left_to_the_program():
    """Entries of a scene, of a body and of contact become automatic. A component of a vector cannot
    be None."""
    changed = drop(accuracy=0.02).set({"accuracy": None, "contact.friction_static": None})
    assert changed.accuracy is None and changed.contact == ff.Contact()
    with pytest.raises(ff.BadInput, match="body.1.velocity"):
        drop().set({"body.1.velocity.2": None})


@pytest.mark.parametrize(
    "change, words",
    [
        (lambda scene: setattr(scene.bodies[0], "radius", -1), ("radius", "-1", "1e-09")),
        (lambda scene: setattr(scene.bodies[0], "radis", 1), ("radis", "radius")),
        (lambda scene: setattr(scene, "accuracy", 3), ("accuracy", "3", "0.4")),
        (lambda scene: setattr(scene, "bodies", []), ("body", "missing")),
        (lambda scene: setattr(scene.contact, "penalty", "stiff"), ("penalty", "stiff", "auto")),
        (lambda scene: setattr(scene.bodies[0], "speed", 3), ("velocity", "beside speed or direction")),
        (lambda scene: setattr(scene.contact, "friction_dynamic", 0.4), ("friction_dynamic", "0.4", "static 0.3")),
    ],
)  # fmt: skip
def test_an_entry_is_checked_when_it_is_set(change, words):
    """What is refused changes nothing."""
    scene = drop()
    with pytest.raises(ff.BadInput) as caught:
        change(scene)
    assert all(word in str(caught.value) for word in words) and scene == drop()


def test_an_entry_that_is_set_is_that_of_the_scene():
    scene = drop()
    scene.bodies[0].velocity, scene.accuracy = (0, np.float64(-4)), 0.02
    assert scene == drop(accuracy=0.02).set({"body.1.velocity.2": -4})


def test_a_dumped_scene_is_whole():
    """model_dump() has the shapes of bodies, and gives the scene again."""
    dumped = drop().model_dump()
    assert dumped == drop().table() and dumped["body"][0]["radius"] == 0.05
    assert ff.Scene.read(json.loads(json.dumps(dumped))) == drop()


def test_a_scene_saved_elsewhere_finds_its_files(tmp_path):
    """Meshes, surfaces and tables of a scene are found from the new file."""
    (tmp_path / "away").mkdir()
    table = tmp_path / "away/motion.csv"
    table.write_text("t,x,y\n0,0,0\n1,0,-0.001\n")
    scene = ff.Scene(
        bodies=[ff.Disc(radius=0.05, material=RUBBER, position=(0, 0.051))],
        obstacles=[ff.Plane(motion="motion.csv")], folder=tmp_path / "away", end_time=1,
    )  # fmt: skip
    loaded = ff.Scene.load(scene.save(tmp_path / "it's/new.toml"))
    assert (loaded.folder / loaded.obstacles[0].motion).samefile(table)
    assert loaded.ready().obstacles[0].driven


MATERIAL = {"young": 7e6, "nu": 0.45, "density": 1722}


def moved(motion, **entries) -> ff.Scene:
    """A disc whose left side moves, under a plane that comes down and turns."""
    disc = ff.Disc(radius=0.05, material=RUBBER, position=(0, 0.051),
                   support=ff.Support(where="left", motion=motion))  # fmt: skip
    return ff.Scene(bodies=[disc], **{"end_time": 0.1} | entries)


def test_a_python_function_of_time_is_a_table():
    """Of one component or of all; the table follows the function to 1e-5 of its largest value."""
    whole = moved(lambda t: (0, -0.01 * np.sin(200 * t)))
    single = moved([0, lambda t: -0.01 * np.sin(200 * t)])
    table = whole.table()["body"][0]["support"][0]["motion"]
    assert set(table) == {"t", "x", "y"} and table["t"][-1] == 0.1
    for scene in (whole, single):
        motion = scene.ready().bodies[0].supports[0].functions
        t = np.linspace(0, 0.1, 5000)
        assert abs(motion[1](t) + 0.01 * np.sin(200 * t)).max() < 2e-7 and motion[0].is_zero
    assert ff.Scene.read(whole.table()) == whole
    plane = ff.Plane(rotation=lambda t: 30 * t, pivot=(0, -1))
    turned = moved([0, "t"], obstacles=[plane], end_time=0.5).table()["obstacle"][0]["rotation"]
    assert turned["r"][-1] == 15


@pytest.mark.parametrize(
    "motion, more, words",
    [
        (lambda t: 3, {}, ("body.1.support.1.motion", "2 numbers")),
        (lambda t: (0, "a"), {}, ("body.1.support.1.motion", "2 numbers")),
        (lambda t: (0, float("nan")), {}, ("motion", "not finite at 0 s")),
        (lambda t: (0, t), {"end_time": None}, ("motion", "end_time")),
        ([0, lambda t: float(t > 0.05123)], {}, ("motion.2", "too fast")),
    ],
)  # fmt: skip
def test_what_no_table_follows_is_refused(motion, more, words):
    with pytest.raises(ff.BadInput) as caught:
        moved(motion, **more)
    assert all(word in str(caught.value) for word in words)


def test_a_scene_is_shown_as_a_table():
    lines = repr(drop(accuracy=0.02)).splitlines()
    assert [line.split()[0] for line in lines] == ["Scene", "body", "obstacle", "contact", "run"]
    assert (
        "shape = disc" in lines[1] and "velocity = [0.0, -8.0]" in lines[1] and "0.02" in lines[4]
    )
    assert drop()._repr_html_().count("<tr>") == 4


def test_numbers_of_a_law_have_names():
    """The same in Python and in a file."""
    mooney = ff.MooneyRivlin(share=0.3, **MATERIAL)
    ogden = ff.Ogden(alpha=[1.3, -2], mu=[1e6, -2e6], nu=0.4, density=1722)
    assert mooney.table() == {"law": "mooney-rivlin", "share": 0.3} | MATERIAL
    assert ogden.table() == {
        "law": "ogden",
        "nu": 0.4,
        "density": 1722,
        "alpha": [1.3, -2],
        "mu": [1e6, -2e6],
    }
    for material in (mooney, ogden):
        disc = ff.Disc(radius=1, position=(0, 1), material=material)
        assert disc.material.table() == material.table() and type(disc.material) is type(material)


def test_a_body_may_be_given_as_the_table_of_a_file():
    table = drop().table()
    made = ff.Scene(bodies=table["body"], obstacles=table["obstacle"], contact=drop().contact)
    assert made == drop() and isinstance(made.bodies[0], ff.Disc)


def test_all_that_is_wrong_with_a_scene_is_told_at_once():
    """The message has a line for each error, in whatever table it is."""
    tables = drop().table()
    tables["body"][0] |= {"radius": -1, "velocty": [0, 1], "position": [0, "x"]}
    tables["obstacle"][0] |= {"exponent": 2}
    tables["contact"] |= {"pair": [{"penalti": 3}]}
    tables |= {"accuracy": 3, "foo": 1}
    with pytest.raises(ff.BadInput) as caught:
        ff.Scene.read(tables)
    wrong = ("accuracy", "foo", "body.1.radius", "body.1.velocty", "body.1.position.2")
    wrong += ("obstacle.1.exponent", "contact.pair.1.penalti")
    assert {line.partition(": ")[0] for line in caught.value.messages} == set(wrong)


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: ff.NeoHookean(yong=1, young=1, nu=0.3, density=1), ("yong", "young")),
        (lambda: ff.NeoHookean(nu=0.3, density=1), ("young", "missing")),
        (lambda: ff.Disc(radius="wide", position=(0, 0)), ("radius", "wide")),
        (
            lambda: ff.Scene(bodies=[ff.Disc(radius=-1, material=RUBBER, position=(0, 0))]),
            ("radius", "-1", "1e-09"),
        ),
        (lambda: drop(accuracy=3), ("accuracy", "3", "0.4")),
        (lambda: drop(accurcy=0.1), ("accurcy", "accuracy")),
        (lambda: drop().set(**{"body.1.yong": 3}), ("body.1.yong", "young")),
        (lambda: ff.Scene.load("disc-norml"), ("disc-norml", "disc-normal")),
        (lambda: ff.NeoHookean(youngs=2e6, nu=0.4, density=1), ("youngs", "young")),
        (lambda: ff.Disc(radius=True, position=(0, 0)), ("radius", "true")),
        (lambda: ff.NeoHookean(law="svk", **MATERIAL), ("law", "svk", "SaintVenantKirchhoff")),
        (lambda: ff.Ogden(**MATERIAL), ("alpha", "missing")),
        (lambda: ff.Ogden(alpha=[2], **MATERIAL), ("mu", "missing")),
        (lambda: ff.MooneyRivlin(share=1.2, **MATERIAL), ("share", "1.2", "0 to 1")),
        (lambda: ff.Material(), ("law", "missing", "svk")),
        (
            lambda: ff.Contact(friction_dynamic=0.2),
            ("Contact: friction_dynamic", "0.2", "static 0"),
        ),
        (lambda: ff.Pair(friction_static=0.1, friction_dynamic=0.2), ("friction_dynamic", "0.2")),
        (lambda: ff.Plane(friction_static=0.1, friction_dynamic=0.2), ("friction_dynamic", "0.2")),
        (lambda: ff.Plane(pivot=(0, 0)), ("Plane: pivot", "without rotation")),
        (
            lambda: ff.Ring(radius=1, inner_radius=1, position=(0, 2)),
            ("inner_radius: 1", "radius 1"),
        ),
        (lambda: ff.Disc(radius=1, position=(0, 2), mass=3), ("mass", "rigid = true")),
        (lambda: ff.Load(where="top"), ("Load: has no stress", "pressure")),
        (lambda: drop().set({"body.1.velocity": [0, 0]}), ("velocity", "nothing would ever move")),
        (lambda: ff.Disc(radius="5 cm", position=(0, 0)), ("radius", "5 cm", "unit")),
        (
            lambda: ff.Scene(
                bodies=[ff.Disc(radius=0.05, position=(0, 1))], obstacles=[ff.Plane()]
            ),
            ("body.1.young", "missing"),
        ),
        (
            lambda: ff.Scene(
                bodies=[ff.Disc(radius=0.05, material=RUBBER, position=(0, 1, 0))],
                obstacles=[ff.Plane()],
            ),
            ("body.1.shape", "disc", "dimension", "3d"),
        ),
        (lambda: ff.Scene(bodies=[3]), ("bodies.1", "3")),
        (lambda: ff.Scene(), ("bodies", "missing")),
        (lambda: ff.Scene(bodies=[{"shap": "disc"}]), ("body.1.shape", "missing", "disc")),
        (lambda: ff.Disc(radius=1, position=(0, 1), material="soft"), ("material", "soft")),
        (lambda: ff.Disc(radius=1, position=(0, 1), support=3), ("support", "3")),
        (lambda: ff.run(drop(), entries=["a"]), ("entries", "a")),
        (lambda: ff.run(drop(), entries={1: 2}), ("entries", "1")),
        (lambda: ff.run(drop(), out=3), ("out", "3")),
        (lambda: ff.sweep(drop(), {"accuracy": [0.1]}, workers=0), ("workers", "0")),
        (lambda: ff.run(3), ("scene", "3")),
        (lambda: ff.sweep(drop(), {}), ("sweep",)),
        (lambda: ff.sweep(drop(), {"body.1.velocity.2": -4}), ("body.1.velocity.2", "-4")),
        (lambda: ff.sweep(drop(), {"body.1.velocity.7": [-4]}), ("body.1.velocity.7",)),
    ],
)
def test_what_is_wrong_is_a_line_with_entry_and_value(tmp_path, monkeypatch, make, words):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ff.BadInput) as caught:
        make()
    assert (
        caught.value.code == 10
        and all(": " in line for line in str(caught.value).splitlines())
        and all(word in str(caught.value) for word in words)
    )
    assert not list(tmp_path.iterdir())


def test_each_exit_code_has_its_exception():
    kinds = {
        1: ff.Failure,
        10: ff.BadInput,
        11: ff.StepFailed,
        12: ff.MaterialFailed,
        13: ff.NotInstalled,
        14: ff.Unreadable,
        124: ff.TooLong,
    }
    for code, kind in kinds.items():
        failure = of_code(code, "why")
        assert type(failure) is kind and failure.code == code and str(failure) == "why"


def test_the_command_prints_the_schema(capsys):
    assert main(["schema"]) == 0
    assert json.loads(capsys.readouterr().out) == schema.schema()


def test_help_lists_the_entries_with_their_units():
    """A notebook shows the entries of the constructor, their meaning, and which are required."""
    parameters = inspect.signature(ff.Disc).parameters
    assert (
        "[m]" in parameters["radius"].annotation
        and parameters["radius"].default is inspect.Parameter.empty
    )
    assert parameters["material"].default is None and "[m/s]" in parameters["velocity"].annotation
    assert "bodies" in inspect.signature(ff.Scene).parameters


def test_an_entry_without_a_name_is_refused_with_the_names():
    with pytest.raises(ff.BadInput, match="Disc: '0.05' has no name .*radius"):
        ff.Disc(0.05, RUBBER)
