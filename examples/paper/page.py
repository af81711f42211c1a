"""The page that compares the statements of the paper with our numbers, as a self-contained HTML
file."""

import base64
from datetime import datetime
from html import escape
from pathlib import Path

import pandas as pd

from ffimpact import __version__, scene
from ffimpact.input import parameters
from ffimpact.output.results import read_frame, read_json, read_scene
from ffimpact.report.figures import GREEN, ORANGE, STYLE
from ffimpact.report.impact import impact_of
from ffimpact.running.run import code_hash
from ffimpact.sweeps import study, sweep
from verification import verify

from .judging import AGREES, DIFFERS, OPEN, PARTLY, Finding

COLOURS = {AGREES: GREEN, DIFFERS: ORANGE, PARTLY: "#b8860b", OPEN: "#777777"}
SHOWN = {"energies": "energies over time", "force": "contact force over time",
         "rolling": "velocity of the centre and the rim, and the share that slides",
         "velocity": "velocities over time", "contact": "contact pressure along the outline and over time",
         # The content of each figure of a run.
         "flight": "shapes on the flight and in the contact", "shapes": "deformed shapes"}
PIXELS, DPI = 85, STYLE["savefig.dpi"]  # pixels per inch of the page and of a figure
BACK = '<a href="#top">Back to the top</a>'
TITLES = {"friction-laws": "The friction laws (11) to (13), by the paper's script (make friction-laws)",
          "pairs": "Force of the disc on the block by the paper's script: closest points (9), pairs (14), (15) (make paper-scripts)",
          "stick-slip": "Share of the load that slides in each third of the contact, over ε, k and ν (make stick-slip)",
          "-and-".join(("disc-normal", "disc-normal-neohookean", "ball-axisymmetric-svk", "ball-axisymmetric")):
          "Accelerations of the centre of mass, energies and velocities of discs and balls (make ball-comparison)"}


def page(findings: list[tuple[str, str, Finding]], more: str = "") -> str:
    """The page as HTML with all figures. `more` follows the statements."""
    counts = ", ".join(f"{sum(finding.verdict == verdict for *_, finding in findings)} {verdict}" for verdict in COLOURS)
    contents = "\n".join(f"<li>{line}</li>" for line in [
        '<a href="#all">All verdicts</a>',
        *(f'<a href="#s{k}">{escape(item)}</a>: {escape(text)}' for k, (item, text, _) in enumerate(findings)),
        *(['<a href="#verification">Verification</a>: exact solutions'] if more else [])])
    rows = "\n".join(f'<tr id="row{k}"><td>{escape(item)}</td><td>{escape(text)}</td><td>{escape(finding.ours)}</td>'
                     f'<td style="color:{COLOURS[finding.verdict]}"><a href="#s{k}">{finding.verdict}</a></td></tr>'
                     for k, (item, text, finding) in enumerate(findings))
    shown = {}
    sections = "\n".join(_section(k, *entry, shown) for k, entry in enumerate(findings))
    return Path(__file__).with_name("page.html").read_text("utf-8").format(
        counts=counts, contents=contents, rows=rows, sections=sections, more=more, now=datetime.now(), version=__version__,
        code=code_hash(), back=BACK)


def _section(k: int, item: str, text: str, finding: Finding, shown: dict[Path, int]) -> str:
    """A statement with its figures, numbered through the page. A figure of an earlier statement, in
    `shown`, is a link."""
    pictures = []
    for path in finding.figures:
        if path in shown:
            pictures.append(f'<p><a href="#figure{shown[path]}">Figure {shown[path]}</a> above: {escape(caption(path))}.</p>')
        else:
            shown[path] = len(shown) + 1
            pictures.append(picture_of(path, shown[path], f"#s{k}", item))
    return (f'<h2 id="s{k}">{escape(item)}: {escape(text)}</h2>\n<p><b style="color:{COLOURS[finding.verdict]}">{finding.verdict}</b>: '
            f'{escape(finding.ours)}</p>\n'
            + "\n".join(pictures) + f'\n{provenance_of(finding.runs)}\n<p><a href="#row{k}">Back to its row in the table</a> · {BACK}</p>')


def picture_of(path: Path, number: int = 0, back: str = "", item: str = "") -> str:
    """A figure with its caption, in its drawn width, so that the text of all figures has one size.

    If given, its number and the statement `item` that it belongs to are shown.
    """
    words, data = escape(caption(path)), path.read_bytes()
    wide = f' width="{round(PIXELS * int.from_bytes(data[16:20], "big") / DPI)}"' if data[12:16] == b"IHDR" else ""
    lead, trail = (f"<b>Figure {number}.</b> ", f' (<a href="{back}">{escape(item)}</a>)') if number else ("", "")
    anchor = f' id="figure{number}"' if number else ""
    return (f'<figure{anchor}><img alt="{words}"{wide} src="data:image/png;base64,{base64.b64encode(data).decode()}">'
            f"<figcaption>{lead}{words}{trail}</figcaption></figure>")


def caption(path: Path) -> str:
    """The content of a figure: title and quantity of a run, or title of a sweep."""
    if path.name == "sweep.png" and path.parent.name in sweep.built_in():
        return f"{sweep.load(path.parent.name).title} (make {path.parent.name})"
    if path.parent.name == "figures" and path.parent.parent.name in scene.built_in():
        return f"{path.parent.parent.name}: {scene.load(path.parent.parent.name).title}: {SHOWN.get(path.stem, path.stem)}"
    return TITLES.get(path.stem, path.stem.replace("-", " ")) + (", all with k = 1e10 Pa/m" if path.parent.name == "same-penalty" else "")


def verification(folder: Path) -> str:
    """The section with the results of `make verify` in `folder`: a table of the cases, then every
    case with its figure and numbers."""
    frame = read_frame(folder / "verify.csv", verify.COLUMNS)
    judged = verify.judged(frame)
    table = _table(verify.overview(frame), verify.FORMATS)
    parts = []
    for case in verify.CASES:
        rows, judged_rows = frame[frame.case == case.name], judged[judged.case == case.name]
        figure = folder / f"{verify.slug(case)}.png"
        parts.append(f"<h3>{escape(case.name)}: {escape(case.title)}</h3>\n<p>{escape(case.note)}</p>\n"
                     f"{picture_of(figure) if figure.exists() else ''}\n<details><summary>all numbers ({len(rows)}, of which "
                     f"{len(judged_rows)} are judged)</summary>{_table(rows, verify.NUMBERS)}</details>")
    return ('<h2 id="verification">Verification</h2>' "\n<p>Against exact solutions, by tolerances fixed beforehand (make verify): "
            f"<b>{'all pass' if judged['pass'].all() else 'NOT all pass'}</b>. A row a case, with the number that is nearest to "
            f"its tolerance; order: observed, of the largest error between the coarsest and the finest size.</p>\n{table}\n"
            + "\n".join(parts) + f"\n<p>{BACK}</p>")


def _table(frame: pd.DataFrame, formats: dict[str, str]) -> str:
    """The columns in `formats` as an HTML table."""
    rows = [[*formats], *zip(*([study.cell(value, form) for value in frame[name]] for name, form in formats.items()))]
    return "<table>" + "\n".join("<tr>" + "".join(f"<{tag}>{escape(text)}</{tag}>" for text in row) + "</tr>"
                                 for tag, row in zip(["th"] + ["td"] * len(frame), rows)) + "</table>"


def entries_of(scene: dict) -> dict:
    """The entries of a scene as used by name: of an impact, or of the top, the contact and the first body."""
    tables = {name: value for name, value in scene.items() if not isinstance(value, list | dict)}
    own = {name: value for table in (scene["contact"], scene["body"][0]) for name, value in table.items() if not isinstance(value, list | dict)}
    return {name: value for name, value in (impact_of(scene) or tables | own).items() if not isinstance(value, list | dict)}


def provenance_of(folders: list[Path]) -> str:
    """The source of the runs, with nu and parameters that differ from their defaults, common to all
    runs and by run."""
    scenes = [entries_of(read_scene(folder)) for folder in folders if (folder / "scene.toml").exists()]
    if not scenes:
        return ""
    standard = {name: parameter.default for name, parameter in parameters.PARAMETERS.items()}
    common = {name: value for name, value in scenes[0].items()
              if all(used.get(name) == value for used in scenes) and (name in ("script", "nu") or standard.get(name) != value)}
    varied = {name: sorted({used[name] for used in scenes if name in used}, key=lambda value: (isinstance(value, str), value))
              for name in scenes[0]
              if any(used.get(name) != scenes[0][name] for used in scenes)}
    records = [read_json(path) for folder in folders
               for path in (folder / "summary.json", folder / "failure.json") if path.exists()]
    made = [record.get("provenance", {}) for record in records]
    warned = study.warned("; ".join(record.get("warnings", [])) for record in records)
    lines = [f"runs          {len(scenes)}", f"warnings      {warned or 'none'}",
             "parameters    " + ", ".join(f"{name} = {value}" for name, value in common.items())]
    lines += [f"varied        {name}: " + (", ".join(map(str, values)) if len(values) <= 8 else
                                          f"{len(values)} values from {values[0]} to {values[-1]}") for name, values in varied.items()]
    for name, words in (("git", "commit"), ("code", "code sha256"), ("freefem", "FreeFem++"), ("gmsh", "gmsh")):
        lines.append(f"{words:<14}" + ", ".join(sorted({str(entry.get(name)) for entry in made})))
    meshes = sorted({str(entry.get("mesh")) for entry in made})
    lines.append("mesh sha256   " + (", ".join(meshes) if len(meshes) <= 4 else f"{len(meshes)} meshes, in each run's summary.json"))
    return f"<details><summary>parameters and provenance</summary><pre>{escape(chr(10).join(lines))}</pre></details>"
