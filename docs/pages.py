"""What pages say that the scripts say of themselves, between marks: the tables of docs/results.md and docs/warnings.md, and that of
equations in README.md and docs/method.md; the whole of docs/parameters.md."""

import argparse
import re
import shutil
import sys
from collections.abc import Collection, Mapping
from pathlib import Path

from ffimpact import schema
from ffimpact.__main__ import start
from ffimpact.freefem.describe import describe_results
from ffimpact.input import models, parameters
from ffimpact.input.parameter import Parameter, Rule
from ffimpact.places import ROOT, shown

TABLES = (("history.csv", "history", ("columns", "body_columns")), ("summary.json", "summary", ("summary", "body_summary")),
          ("contacts.csv", "contacts", ("contact_columns",)), ("fields/contact.csv", "points", ()))
SCRIPTS = ("disc-plane", "disc-block", "ball-axisymmetric", "ball-plane")
EQUATION = re.compile(r"// ((?:\(\d+\)(?:, |–| ))*\(\d+\))(?::| |$)")


KINDS = {"warn": "warning", "note": "note"}
# of what no call above has the words
OF_ESTIMATES = "".join(f"| {name} | {kind} | {words} |\n" for name, kind, words in (
    ("chatter", "warning", "the body left and was back within a wave's transit … times in a row (`chatter=continue`)"),
    ("estimated errors", "warning / note", "a warning where a promised answer is off by more than 1.5 times what was "
     "asked, a note below that, of a contact time that scatters whatever the mesh, and of the exact contact time and "
     "the peak force from twice that on (`orchestrate/ffimpact/output/estimate.py`)"),
    ("touches", "warning / note", "instead of these, where the two runs of an estimate saw different numbers of "
     "intervals of contact"),
    ("mesh of the file", "note", "estimated errors are those of the step alone: the mesh of a file is not varied"),
    ("no finer run", "warning", "the error is above what was asked, and the run that was to make it smaller failed"),
    ("the error is not estimated", "warning", "the second run failed, or took the same steps")))


def main(argv: list[str]) -> int:
    """Writes the pages below the source folder; with --site what MkDocs makes a site of."""
    parser = argparse.ArgumentParser(prog="python docs/pages.py", description=__doc__)
    parser.add_argument("--site", metavar="DIR", type=Path, help="also put README and docs/ there, for MkDocs (make docs)")
    options = parser.parse_args(argv)
    for path, text in pages().items():
        path.write_text(text)
        print(shown(path))
    if options.site:
        site(options.site)
    return 0


def site(folder: Path) -> None:
    """README as index.md, the pages of docs/ and the pictures; links to files of the program are words there."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for path in [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").glob("*.md"))]:
        text = path.read_text().replace("](docs/",
                                        "](").replace("](../README.md", "](index.md").replace("](../CONTRIBUTING.md", "](CONTRIBUTING.md")
        text = re.sub(r"\[([^]]+)\]\((?:\.\./)*(?:edp|orchestrate|verification|benchmarks|examples|LICENSE|CITATION)[^)]*\)", r"`\1`", text)
        (folder / ("index.md" if path.name == "README.md" else path.name)).write_text(text)
    for path in [*ROOT.glob("*.png"), ROOT / "docs/site.css", *(ROOT / "docs").glob("*.svg")]:
        shutil.copy(path, folder)


def pages() -> dict[Path, str]:
    """The text of every page by its file: what stands between the marks of a part is made anew."""
    parts = {"docs/results.md": ("columns", results()), "docs/warnings.md": ("warnings", warnings()),
             "README.md": ("equations", equations()), "docs/method.md": ("equations", equations("../"))}
    made = {schema.FILE: schema.text(), ROOT / "docs/parameters.md": entries()}
    for name, (part, text) in parts.items():
        begin, end = f"<!-- {part} -->\n", f"<!-- end of {part} -->\n"
        before, _, rest = (ROOT / name).read_text().partition(begin)
        made[ROOT / name] = before + begin + text + end + rest.partition(end)[2]
    return made


def entries() -> str:
    """All entries of a scene: table by table, with unit, what is accepted and meaning."""
    text = "# Entries of a scene\nWritten by `python docs/pages.py` from `orchestrate/ffimpact/input/table.py` and `models.py`. All in SI units.\n"
    text += "\n## Parameters of a run\nAt the top of a scene file, by `--set name=value`, as flags of the scripts, and in Python.\n"
    text += "\n| name | unit | default | accepted | meaning |\n|---|---|---|---|---|\n"
    for one in parameters.PARAMETERS.values():
        default = one.default if isinstance(one.default, str) else f"{one.default:g}"
        text += f"| `{one.name}` | {one.unit} | {default} | {cell(one.accepted)} | {cell(one.help)} |\n"
    text += "\n## Materials\nIn Python `material = NeoHookean(...)` and so on; in a file the same entries in a body's table, or at the top for all bodies.\n\n"
    text += "".join(f"- `{name}`, `{one.__name__}`: {first_line(one)}\n" for name, one in models.LAWS.items())
    text += table_of("Bodies", "`[[body]]`, `Body` in Python: what bodies of all shapes have.", models.Body)
    text += kinds("shape", models.BODIES, models.Body)
    text += table_of("Supports", "`[[body.support]]`, `Support`.", models.Support)
    text += table_of("Loads", "`[[body.load]]`, `Load`: one of traction, pressure and gas.", models.Load)
    text += table_of("Gas", "`gas = {...}` of a load, `Gas`.", models.Gas)
    text += table_of("Rigid obstacles", "`[[obstacle]]`, `Obstacle`: what obstacles of all kinds have.", models.Obstacle)
    text += kinds("kind", models.OBSTACLES, models.Obstacle)
    text += table_of("Contact", "`[contact]`, `Contact`: of the whole scene.", models.Contact)
    return text + table_of("Pairs", "`[[contact.pair]]`, `Pair`: what differs between two partners.", models.Pair)


def first_line(model: type) -> str:
    """What a class is, by its docstring."""
    return (model.__doc__ or "").strip().split("\n")[0]


def table_of(heading: str, words: str, model: type[models.Entries]) -> str:
    """The entries of a model under a heading."""
    return f"\n## {heading}\n{words}\n\n| name | unit | accepted | meaning |\n|---|---|---|---|\n" + rows(model)


def rows(model: type[models.Entries], but: Collection[str] = (), first: str = "") -> str:
    """A row an entry."""
    text = ""
    for name, field in model.model_fields.items():
        rule = next((one for one in field.metadata if isinstance(one, Rule)), None)
        if rule and name not in but:
            unit, meaning = (rule.unit, rule.help) if isinstance(rule, Parameter) else ("", rule.meaning)
            needed = ", needed" if field.is_required() else ""
            text += f"|{first} `{name}`{needed} | {unit} | {cell(rule.accepted)} | {cell(meaning)} |\n"
    return text


def kinds(word: str, table: Mapping[str, type], common: type[models.Entries]) -> str:
    """What each shape of a body or kind of an obstacle has beside what all have."""
    text = f"\n| {word}, entry | unit | accepted | meaning |\n|---|---|---|---|\n"
    for name, model in table.items():
        dimensions = ", ".join(one.name for one in model.dimensions)
        text += f"| **`{name}`** | | {dimensions} | {cell(first_line(model))} |\n{rows(model, common.model_fields)}"
    return text


def results() -> str:
    """Files, columns and numbers of a run."""
    told = [describe_results({}, script) for script in SCRIPTS]
    text, meanings = "", told[0]["meanings"]
    for file, table, lists in TABLES:
        known = {name: entry for each in reversed(meanings.values()) for name, entry in each.items()} | meanings[table]
        names = {name: None for each in told for key in lists for name in each[key]} or meanings[table]
        names |= {name: None for name in meanings[table]}
        of_body = {name for each in told for key in lists if key.startswith("body") for name in each[key]}
        text += f"\n## `{file}`\n| name | unit | meaning |\n|---|---|---|\n"
        text += "".join(f"| `{name}`{' `_1` …' if name in of_body else ''} | {known[name][0]} | {cell(known[name][1])} |\n"
                        for name in names)
    return text


def warnings() -> str:
    """Every sentence of warnings.idp and estimate.py by its first words."""
    rows = {}
    for path in sorted((ROOT / "edp/core").rglob("*.idp")):
        for call in re.finditer(r"\b(warn|note)\((.*?)\);\n", path.read_text(), re.DOTALL):
            sentence = _literal(call[2])
            rows.setdefault(sentence.partition(":")[0], []).append((call[1], sentence.partition(": ")[2]))
    found = "".join(f"| {name} | {' / '.join(dict.fromkeys(KINDS[kind] for kind, _ in told))} | "
                    f"{cell(' / '.join(dict.fromkeys(words for _, words in told)))} |\n"
                    for name, told in sorted(rows.items()) if told[0][1])
    return "| name | kind | says |\n|---|---|---|\n" + found + OF_ESTIMATES


def _literal(expression: str) -> str:
    """The string literals of an expression of FreeFEM's, what stands between them as an ellipsis."""
    parts = re.split(r'"((?:[^"\\]|\\.)*)"', expression.replace("string(", "("))
    text = "".join(part if k % 2 else ("…" if part.strip(" +()\n") else "") for k, part in enumerate(parts))
    return re.sub(r"(…\s*)+", "… ", text).replace("… )", "…)").replace("… :", "…:").replace("… ,", "…,").strip()


def equations(prefix: str = "") -> str:
    """A table: number of the equation in the paper, the line of its file where it stands."""
    found = {}
    for path in sorted((ROOT / "edp/core").rglob("*.idp")):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if match := EQUATION.search(line):
                if line[:match.start()].strip():                     # code, not prose
                    found.setdefault(match[1], []).append((path, number, line[match.end():].strip()))
    text = "| equation | line | what stands there |\n|---|---|---|\n"
    for marks, places in sorted(found.items(), key=lambda each: int(re.search(r"\d+", each[0])[0])):
        links = ", ".join(f"[{path.parent.name}/{path.name}:{number}]({prefix}{path.relative_to(ROOT)}#L{number})"
                          for path, number, _ in places)
        text += f"| {marks} | {links} | {cell('; '.join(words for _, _, words in places))} |\n"
    return text


def cell(text: str) -> str:
    return text.replace("|", r"\|")


if __name__ == "__main__":
    sys.exit(start(main))
