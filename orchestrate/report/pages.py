"""Pages of docs/ that say what the scripts say of themselves: docs/results.md, docs/warnings.md, and the table of equations in README.md
and docs/method.md."""

import argparse
import re
import shutil
from pathlib import Path

from ..freefem.describe import describe_results
from ..places import COMMAND, ROOT, shown

RESULTS = """# Results
The folder of a run, or of a direct `FreeFem++ edp/….edp -out DIR`. Written by `python -m orchestrate pages` from what the scripts say of \
themselves.

| file | what it holds |
|---|---|
| `scene.toml` | every parameter as used; can be run again |
| `history.csv` | a row per accepted step, 17 digits, the whole body also where half or a quarter was computed |
| `contacts.csv` | a row for every interval of contact of a body with an obstacle or another body |
| `modes.csv` | with `--set modes=50`: natural modes of the free bodies, frequency [Hz] and energy of each at the end |
| `summary.json` | the run in numbers; written last, by rename: a folder that has it is finished |
| `failure.json` | the same for a run that failed; there is then no `summary.json` |
| `fields.pvd`, `fields/*.vtu` | displacement, velocity, Cauchy stress (XX YY ZZ XY YZ XZ, Pa), von Mises stress, det F (`jacobian`) of \
every snapshot (`--set fields=50`) |
| `fields/contact.csv`, `fields/contact.pvd` | with `fields`: a row for every point under load, at up to four times as many instants; the \
same as points for ParaView |
| `figures/*.png` | energies, forces, velocities, shapes, pressure along the contact, and what else the scene has |
| `log.txt`, `mesh.msh` (`mesh.mesh` of tetrahedra), `scene.dat` | what FreeFem++ printed; the mesh; bodies and obstacles as the scripts \
of scenes of bodies read them |

Units are those of plane strain, per metre of thickness; of balls and bodies of revolution those of the whole, without the last /m. Of \
several bodies the columns and numbers without a
suffix are totals, and each body has its own with `_1`, `_2` … in the scene's order (disc 1, block 2). In scenes of bodies reference \
places are those of the mesh, in which the bodies
stand beside each other. What is not defined is empty in tables and `null` in the summary.

In ParaView open `fields.pvd`, apply Warp By Vector with `displacement` and colour by `von_mises`; `fields/contact.pvd`, warped likewise \
and drawn as Point Gaussian, lays pressure and
slip over it. The sum of `pressure` × `weight` is the normal load of what touches obstacles; between two bodies each has its own points \
and the force is the mean of both sums.
"""
TABLES = (("history.csv", "history", ("columns", "body_columns")), ("summary.json", "summary", ("summary", "body_summary")),
          ("contacts.csv", "contacts", ("contact_columns",)), ("fields/contact.csv", "points", ()))
SCRIPTS = ("disc-plane", "disc-block", "ball-axisymmetric", "ball-plane")
WARNINGS = """# Warnings
A finished run may still need a word: `warnings` in the summary is a list of sentences, printed at the end, in the report, below each \
figure and as a column in the tables of sweeps and
studies. Each says what, how much, what it means and what to do. Written by `python -m orchestrate pages` from the sentences themselves, \
numbers left out (…).

| warning | says |
|---|---|
"""
EQUATION = re.compile(r"// ((?:\(\d+\)(?:, |–| ))*\(\d+\))(?::| |$)")
MARKS = "<!-- equations -->\n", "<!-- end of equations -->\n"


def main(argv: list[str]) -> int:
    """Writes the pages below the source folder; with --site what MkDocs makes a site of."""
    parser = argparse.ArgumentParser(prog=f"{COMMAND} pages", description=__doc__)
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
        text = re.sub(r"\[([^]]+)\]\((?:\.\./)*(?:edp|orchestrate|verification|LICENSE|CITATION)[^)]*\)", r"`\1`", text)
        (folder / ("index.md" if path.name == "README.md" else path.name)).write_text(text)
    for path in [*ROOT.glob("*.png"), ROOT / "docs/site.css"]:
        shutil.copy(path, folder)


def pages() -> dict[Path, str]:
    """The text of every page by its file."""
    made = {ROOT / "docs/results.md": results(), ROOT / "docs/warnings.md": warnings()}
    for name, prefix in (("README.md", ""), ("docs/method.md", "../")):
        before, _, rest = (ROOT / name).read_text().partition(MARKS[0])
        if rest:
            made[ROOT / name] = before + MARKS[0] + equations(prefix) + MARKS[1] + rest.partition(MARKS[1])[2]
    return made


def results() -> str:
    """Files, columns and numbers of a run."""
    told = [describe_results({}, script) for script in SCRIPTS]
    text, meanings = RESULTS, told[0]["meanings"]
    for file, table, lists in TABLES:
        known = {name: entry for each in meanings.values() for name, entry in each.items()}
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
        for call in re.finditer(r"\bwarn\((.*?)\);\n", path.read_text(), re.DOTALL):
            sentence = _literal(call[1])
            rows.setdefault(sentence.partition(":")[0], []).append(sentence.partition(": ")[2])
    found = "".join(f"| {name} | {cell(' / '.join(dict.fromkeys(words)))} |\n" for name, words in sorted(rows.items()) if words != [""])
    return WARNINGS + found + ("| estimated errors | of an answer above what was asked, of the exact contact time and the peak force above "
                                "twice that (`orchestrate/output/estimate.py`) |\n| touches | instead of these, where the two runs of an "
                                "estimate saw different numbers of intervals of contact |\n")


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
    text = "| equation | line | |\n|---|---|---|\n"
    for marks, places in sorted(found.items(), key=lambda each: int(re.search(r"\d+", each[0])[0])):
        links = ", ".join(f"[{path.parent.name}/{path.name}:{number}]({prefix}{path.relative_to(ROOT)}#L{number})"
                          for path, number, _ in places)
        text += f"| {marks} | {links} | {cell(places[0][2])} |\n"
    return text


def cell(text: str) -> str:
    return text.replace("|", r"\|")
