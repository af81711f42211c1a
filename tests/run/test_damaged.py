"""Damaged results: every command that reads them prints one line with the file and ends with exit
code 14.

There is never a traceback nor an incomplete table without a message.
"""

import json
import os
import shutil

import numpy as np
import pytest
from matplotlib.figure import Figure

import ffimpact as ff
from ffimpact import __main__ as program, scene
from ffimpact.report import report
from ffimpact.running import run

SET = ("--set", "accuracy=0.4", "fields=3", "modes=4")
FILES = ("scene.toml", "history.csv", "contacts.csv", "modes.csv", "fields/contact.csv", "fields.pvd", "fields/0001.vtu", "summary.json")


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A small run that writes all of these files."""
    folder = tmp_path_factory.mktemp("whole") / "run"
    result = run.run(scene.load("disc-oblique"), {"accuracy": 0.4, "fields": 3, "modes": 4}, folder)
    report.draw(result)
    assert all((folder / name).exists() for name in FILES)
    return folder


def damages(content: bytes, seed: int) -> dict[str, bytes]:
    """Damaged versions of a file."""
    rng, lines = np.random.default_rng(seed), content.splitlines(keepends=True)
    cut = [content[:n] for n in (0, 1, len(content) // 3, len(content) - 1, *rng.integers(1, len(content), 4))]
    names = lines[0].split(b",")
    rows = {"two lines": b"".join(lines[:2]), "head": lines[0], "no head": b"".join(lines[1:]), "half the rows": b"".join(lines[:len(lines) // 2]),
            "last row cut": b"".join(lines[:-1]) + lines[-1][:len(lines[-1]) // 2] + b"\n", "a line longer": b"".join([*lines[:-1], lines[-1].strip() + b",1\n"]),
            "an empty line": b"".join([*lines[:2], b"\n", *lines[2:]]), "no column": b"\n".join(line.partition(b",")[2] for line in content.split(b"\n"))}
    words = {"text": b"hello\n", "html": b"<html></html>\n", "nul": b"\0" * 500, "latin": b"\xff\xfe" + content, "nan": content.replace(b"0", b"nan"),
             "letters": content.replace(b"1", b"x"), "other names": content.replace(names[0], b"q", 1), "twice": content + content, "empty JSON": b"{}", "a list": b"[]",
             "a table": b"[a]\n", "deep": b"[" * 100_000, "deep TOML": b"a = " + b"[" * 100_000, "equals": b"".join(line.partition(b"=")[0] + b"= \"x\"\n" for line in lines)}
    variants = {f"cut {k}": variant for k, variant in enumerate(cut)} | rows | words
    return {name: variant for name, variant in variants.items() if variant != content}


def refused(capsys, name: str, *arguments: str) -> str:
    """The line of a command that refuses a result."""
    capsys.readouterr()
    code, message = program.main(list(arguments)), capsys.readouterr().err
    assert code == 14 and message.count("\n") == 1 and message.startswith("ffimpact: ") and name in message and len(message) < 600, message
    return message


@pytest.mark.few(2)
@pytest.mark.parametrize("name", FILES)
def test_a_damaged_result_is_one_line(whole, tmp_path, capsys, name):
    """`figures` and `run` refuse every damaged version of every file that is read again. The line
    has the file and advice."""
    folder = tmp_path / "run"
    shutil.copytree(whole, folder)
    content = (folder / name).read_bytes()
    for what, damaged in damages(content, 8).items():
        if name == "summary.json" and what not in ("html", "nul", "text", "empty JSON", "a list", "deep", "cut 0", "cut 2", "head", "latin"):
            continue
        (folder / name).write_bytes(damaged)
        assert "--force" in refused(capsys, name, "figures", str(folder)), what
    refused(capsys, name, "run", "disc-oblique", *SET, "--out", str(folder))
    (folder / name).write_bytes(content)
    assert program.main(["run", "disc-oblique", *SET, "--out", str(folder)]) == 0 and "finished earlier" in capsys.readouterr().out


def test_what_is_no_result_is_one_line(whole, tmp_path, capsys):
    """A folder without a run, or a pipe or folder in place of a file, gives one line at once,
    without advice to delete foreign files."""
    assert "--force" not in refused(capsys, "summary.json", "figures", str(tmp_path)) and "delete" not in refused(capsys, "nowhere", "figures", "nowhere")
    shutil.copytree(whole, tmp_path / "run")
    for k, name in enumerate(FILES):
        (tmp_path / "run" / name).unlink()
        (tmp_path / "run" / name).mkdir() if k % 2 else os.mkfifo(tmp_path / "run" / name)
        assert "no file" in refused(capsys, name, "figures", str(tmp_path / "run"))
        shutil.rmtree(tmp_path / "run")
        shutil.copytree(whole, tmp_path / "run")


WRONG = {"cut": None, "empty": "", "no JSON": "ok", "a list": "[]", "null": "null"}
ENTRIES = {"a text": {"impulse": "large"}, "a table": {"contact_time": {}}, "no list": {"skipped": 3}, "no texts": {"notes": [1]}, "other number": {"impulse": 1.0},
           "estimates": {"estimated_error": "small"}, "files": {"provenance": {"files": [1]}}, "true": {"steps": True}, "missing": {"peak_force": ...}, "all": {"provenance": ...}}


@pytest.mark.few(3)
@pytest.mark.parametrize("what", [*WRONG, *ENTRIES])
def test_a_damaged_summary_is_one_line_on_all_routes(whole, tmp_path, capsys, what):
    """Truncated, no JSON, entries of a wrong kind, changed or missing: run, figures, view, movie,
    compare and sweep refuse the result in one line, as load() and compare() of Python do. Without
    provenance a changed number is not seen, but its kind is."""
    folder = tmp_path / "disc-oblique"
    shutil.copytree(whole, folder)
    content = (folder / "summary.json").read_text()
    if what in WRONG:
        text = content[:len(content) // 2] if WRONG[what] is None else WRONG[what]
    else:
        changed = {name: value for name, value in (json.loads(content) | ENTRIES[what]).items() if value is not ...}
        text = json.dumps(changed)
    (folder / "summary.json").write_text(text)
    if what == "all":
        with pytest.raises(ff.Unreadable, match="provenance"):
            repr(ff.load(folder))
        return
    for words in (("figures", folder), ("view", folder), ("run", "disc-oblique", *SET, "--out", folder), ("movie", "disc-oblique", *SET, "--out", folder)):
        refused(capsys, "summary.json", *map(str, words))
    assert program.main(["compare", "disc-oblique", "disc-normal", "--set", "accuracy=0.4", "fields=3", "modes=4", "--out", str(tmp_path)]) == 14
    for act in (ff.load, ff.Result, lambda path: ff.compare(path, whole)):
        with pytest.raises(ff.Unreadable, match="summary.json"):
            act(folder)


@pytest.mark.robustness
@pytest.mark.parametrize("name", FILES[:-1])
def test_a_damaged_result_of_a_direct_run(whole, tmp_path, capsys, monkeypatch, name):
    """Without Python the original files are unknown. Detectable damage is refused in one line, and
    there is no other output. Damage that leaves scene.toml valid may show in history.csv only."""
    monkeypatch.setattr(Figure, "savefig", lambda *_, **__: None)
    folder = tmp_path / "run"
    shutil.copytree(whole, folder)
    (folder / "summary.json").write_text(json.dumps(json.loads((folder / "summary.json").read_text()) | {"provenance": {}}))
    content, taken = (folder / name).read_bytes(), []
    for what, damaged in damages(content, 9).items():
        (folder / name).write_bytes(damaged)
        capsys.readouterr()
        code, message = program.main(["figures", str(folder)]), capsys.readouterr().err
        named = name in message or (name == "scene.toml" and "history.csv" in message)
        assert code in (0, 14) and (code == 0 or message.count("\n") == 1 and named), (what, message)
        taken += [what] * (code == 0)
    assert name != "history.csv" or not taken


@pytest.mark.parametrize("name, of", [("scene.toml", "scene"), ("history.csv", "history"), ("contacts.csv", "contacts")])
def test_files_damaged_after_loading_are_one_line_in_python(whole, tmp_path, name, of):
    """A file that is gone or damaged after load() is Unreadable with its name. Without contacts.csv
    the table of contacts is empty."""
    ways = {"binary": lambda path: path.write_bytes(bytes(range(256))), "folder": lambda path: path.mkdir(), "gone": lambda path: None}
    for way, damage in ways.items():
        result = ff.load(shutil.copytree(whole, tmp_path / way))
        (tmp_path / way / name).unlink()
        damage(tmp_path / way / name)
        if (of, way) == ("contacts", "gone"):
            assert result.contacts.empty
            continue
        with pytest.raises(ff.Unreadable, match=name) as error:
            getattr(result, of)
        assert "\n" not in str(error.value)
