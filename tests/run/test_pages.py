"""The generated pages are complete, correct and up to date."""

import re

import pandas as pd
import pytest

import ffimpact
import pages
from benchmarks import figures, page
from ffimpact import scene
from ffimpact.places import PACKAGE, ROOT

PAGES = [
    ROOT / "README.md",
    *sorted(
        path
        for path in (ROOT / "docs").rglob("*.md")
        if path.name == "index.md" or path.parent != ROOT / "docs"
    ),
]
PAGES = [path for path in PAGES if ROOT / "docs/gallery" not in path.parents]
MEASUREMENTS = [
    path for path in sorted((ROOT / "docs/measurements").glob("*.md")) if path.stem != "index"
]


def name_of(path):
    return str(path.relative_to(ROOT))


@pytest.mark.parametrize("path", pages.pages(), ids=name_of)
def test_pages_are_as_the_scripts_have_it(path):
    """The pages equal the output of python docs/pages.py."""
    assert path.read_text() == pages.pages()[path], "python docs/pages.py"


def test_every_equation_of_the_paper_has_its_line():
    """(1) to (15) each have a line of a script; all but (14) also one of a kernel. The
    lines have the mark."""
    rows = [row.split(" | ") for row in pages.equations().splitlines()[2:]]
    assert [row[0] for row in rows] == [f"| ({k})" for k in range(1, 16)] and all(row[1] for row in rows)
    assert [k for k, row in enumerate(rows, 1) if row[2] == "—"] == [14]
    for k, row in enumerate(rows, 1):
        for file, line in re.findall(r"\((edp/\S+?)#L(\d+)\)", row[1] + row[2]):
            mark = (ROOT / file).read_text().splitlines()[int(line) - 1].partition("// ")[2]
            assert f"({k})" in mark


def test_every_warning_is_listed():
    """The page has the first words of every sentence of output/warnings.py."""
    text = (PACKAGE / "output/warnings.py").read_text()
    names = set(re.findall(r'(?:warn|note)\(\s*f?"([a-z -]+):', text))
    assert len(names) > 30
    rows = [row.split(" | ") for row in pages.warnings().splitlines()[2:]]
    listed = {row[0].removeprefix("| ") for row in rows}
    assert names <= listed, names - listed
    assert all(len(row) == 4 and row[3].removesuffix(" |") for row in rows), (
        "every message says what to do"
    )


def test_readme_is_one_page_and_its_scene_is_sound(tmp_path):
    """README has at most 130 lines and, without the table of equations, 950 words. The scene in it
    is accepted."""
    text = (ROOT / "README.md").read_text()
    assert text.count("\n") <= 130 and len(text.replace(pages.equations(), "").split()) <= 950
    path = tmp_path / "drop.toml"
    path.write_text(re.search(r"```\n(title = .*?)```", text, re.DOTALL)[1])
    assert len(scene.load(str(path)).bodies) == 1


def test_every_export_and_every_command_is_in_the_reference():
    """Each name of the package is on one page of the Python interface, each command on the page of
    the command line."""
    text = "".join(path.read_text() for path in (ROOT / "docs/reference/api").glob("*.md"))
    named = re.findall(
        r"^\.\. auto(?:class|function|exception):: ffimpact\.(\w+)$", text, re.MULTILINE
    )
    assert sorted(named) == sorted(ffimpact.__all__)
    commands = re.findall(
        r"^## `ffimpact (\S+)`$",
        (ROOT / "docs/reference/command-line.md").read_text(),
        re.MULTILINE,
    )
    assert {"run", "list", "parameters", "sweep", "compare", "movie"} <= set(commands)


def test_exit_codes_are_those_of_the_failures():
    """Each exception of the interface has its code."""
    text = pages.exit_codes()
    assert all(
        f"| {getattr(ffimpact, name).code} | `{name}` |" in text
        for name in pages.exports()["exceptions"]
    )


@pytest.mark.parametrize("path", MEASUREMENTS, ids=name_of)
def test_a_measurement_has_its_tables_its_figure_and_few_words(path):
    """Its command draws a figure, tables and figure exist, and the handwritten part has at most 250
    words."""
    text = path.read_text()
    before, _, rest = text.partition(page.BEGIN)
    block, _, after = rest.partition(page.END)
    assert re.search(r"`python -m benchmarks ([\w-]+)", block)[1] in figures.DRAWN
    assert len((before + after).split()) <= 250
    linked = set(re.findall(r"\]\((\S+?\.csv)\)", block))
    assert linked == {file.name for file in page.files(path)} and all(
        len(pd.read_csv(path.with_name(name))) for name in linked
    )
    assert path.with_suffix(".svg").stat().st_size < 150_000


def test_a_measurement_writes_its_page(tmp_path):
    """A new page has title, command, verdict, tables and figure. Writing it again changes only the
    block between the marks."""
    path = tmp_path / "one.md"
    rows = pd.DataFrame(
        {"case": ["disc"] * 2, "unknowns": [100, 1000], "step": [0.1, 1.0], "memory": [10.0, 100.0]}
    )
    slopes = pd.DataFrame({"case": ["disc"], "step": [1.0], "memory": [1.0]})
    for verdict in ("first", "second"):
        page.write(
            path,
            "A title",
            ["scaling", "--meshes", "2"],
            verdict,
            {"": rows, "exponents": slopes},
            ["exponents"],
        )
        if verdict == "first":
            path.write_text(path.read_text() + "By hand.\n")
    text = path.read_text()
    assert (
        text.startswith("# A title\n")
        and "scaling --meshes 2` at commit" in text
        and text.endswith("By hand.\n")
    )
    assert "second" in text and "first" not in text and "| disc | 1 | 1 |" in text
    assert (
        pd.read_csv(tmp_path / "one.csv").astype(rows.dtypes).equals(rows)
        and (tmp_path / "one.svg").stat().st_size > 5000
    )


@pytest.mark.parametrize("path", PAGES, ids=name_of)
def test_links_lead_somewhere(path):
    """Every file to which a page links exists. The gallery is made with the site."""
    links = {
        link.partition("#")[0]
        for link in re.findall(r"\]\(([^)\s]+)\)", path.read_text())
        if "://" not in link
    }
    assert not [
        link
        for link in links
        if link and "gallery/" not in link and not (path.parent / link).exists()
    ]


@pytest.mark.parametrize("path", PAGES, ids=name_of)
def test_tables_and_lists_begin_after_a_heading_or_an_empty_line(path):
    """Without an empty line Markdown takes them for text."""
    prose = re.sub(r"(?ms)^```.*?^```$", "```", path.read_text()).splitlines()
    starts = [
        (before, line)
        for before, line in zip(prose, prose[1:])
        if line.startswith(("| ", "- "))
        and not before.startswith((line[:2], "|", "#", "<!--", "  "))
    ]
    assert not [line for before, line in starts if before.strip()]


@pytest.mark.parametrize("path", PAGES, ids=name_of)
def test_files_that_a_page_names_are_there(path):
    """Every script and module in code type exists. Those that an example makes are announced as
    new."""
    text = path.read_text()
    named = set(re.findall(r"`([\w./-]+\.(?:idp|edp|hpp|py))`", text)) - set(
        re.findall(r"`(\S+)`, new\b", text)
    )
    there = [
        str(file)
        for folder in ("edp", "orchestrate", "verification", "benchmarks", "examples", "tests")
        for file in (ROOT / folder).rglob("*.*")
    ]
    assert not [name for name in named if not any(file.endswith(f"/{name}") for file in there)]
