"""The pages that are written from what the scripts say of themselves: whole, true and up to date."""

import re

import pytest

import pages
from ffimpact import scene
from ffimpact.freefem.describe import describe_results
from ffimpact.places import ROOT


@pytest.mark.parametrize("path", pages.pages(), ids=lambda path: path.name)
def test_pages_are_as_the_scripts_have_it(path):
    """What python docs/pages.py would write is what is there."""
    assert path.read_text() == pages.pages()[path], "python docs/pages.py"


@pytest.mark.parametrize("script", pages.SCRIPTS)
def test_every_column_and_number_has_a_meaning(script):
    """Each has a unit and words; nothing has that is not written."""
    told = describe_results({} if "ball-axi" in script else {"angle": 60, "friction_static": 0.3}, script)
    named = {name for key in ("columns", "summary", "contact_columns", "body_columns", "body_summary") for name in told[key]}
    meanings = [name for table in told["meanings"].values() for name in table]
    assert named <= set(meanings), named - set(meanings)
    assert all(words and not words.startswith(" ") for table in told["meanings"].values() for _, words in table.values())


def test_every_equation_of_the_paper_has_its_line():
    """(1) to (15) each stand at a line of code that the table names."""
    table = pages.equations()
    assert {int(number) for row in table.splitlines()[2:] for number in re.findall(r"\((\d+)\)", row.split("|")[1])} == set(range(1, 16))
    for file, line, numbers in re.findall(r"\((edp/core/\S+?)#L(\d+)\).*", table) and [(m[2], int(m[3]), m[1]) for m in re.finditer(r"\| ([(),\d ]+) \| \[[^]]*\]\((\S+?)#L(\d+)\)", table)]:
        assert f"// {numbers}" in (ROOT / file).read_text().splitlines()[line - 1]


def test_every_warning_is_listed():
    """The page has the first words of every sentence that warnings.idp can say."""
    said = set(re.findall(r'warn\((?:string\()?"([a-z -]+):', "".join(path.read_text() for path in (ROOT / "edp/core").rglob("*.idp"))))
    listed = set(re.findall(r"^\| (.+?) \|", pages.warnings(), re.MULTILINE))
    assert said <= listed, said - listed


def test_readme_is_one_page_and_its_scene_is_sound(tmp_path):
    """At most 130 lines and, beside the table of equations, 950 words; the scene that it shows is accepted as it stands."""
    text = (ROOT / "README.md").read_text()
    assert text.count("\n") <= 130 and len(text.replace(pages.equations(), "").split()) <= 950
    path = tmp_path / "drop.toml"
    path.write_text(re.search(r"```\n(title = .*?)```", text, re.DOTALL)[1])
    assert len(scene.load(str(path)).bodies) == 1


@pytest.mark.parametrize("path", [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))], ids=lambda path: path.name)
def test_links_lead_somewhere(path):
    """Every file that a page links to is there."""
    links = {link.partition("#")[0] for link in re.findall(r"\]\(([^)\s]+)\)", path.read_text()) if "://" not in link}
    assert not [link for link in links if link and not (path.parent / link).exists()]


@pytest.mark.parametrize("path", [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))], ids=lambda path: path.name)
def test_tables_and_lists_begin_after_a_heading_or_an_empty_line(path):
    """Without one MkDocs takes them for text."""
    prose = re.sub(r"(?ms)^```.*?^```$", "```", path.read_text()).splitlines()
    starts = [(before, line) for before, line in zip(prose, prose[1:]) if line.startswith(("| ", "- ")) and not before.startswith((line[:2], "|", "#", "<!--", "  "))]
    assert not [line for before, line in starts if before.strip()]


@pytest.mark.parametrize("path", [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))], ids=lambda path: path.name)
def test_files_that_a_page_names_are_there(path):
    """Every script and module in code type; those that a worked example makes are announced as new."""
    text = path.read_text()
    named = set(re.findall(r"`([\w./-]+\.(?:idp|edp|hpp|py))`", text)) - set(re.findall(r"`(\S+)`, new\b", text))
    there = [str(file) for folder in ("edp", "orchestrate", "verification", "benchmarks", "examples", "tests") for file in (ROOT / folder).rglob("*.*")]
    assert not [name for name in named if not any(file.endswith(f"/{name}") for file in there)]
