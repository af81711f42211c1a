"""Configuration of the documentation site, built by `make docs`.

Pages are MyST Markdown. The gallery comes from examples/NN_*.py.
"""

import inspect
import os
import re
import sys
from importlib.util import find_spec
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
sys.path[:0] = [str(ROOT / "orchestrate"), str(HERE), str(ROOT)]
os.environ.setdefault("MPLBACKEND", "Agg")

from docutils import nodes  # noqa: E402
from sphinx.util.math import get_node_equation_number  # noqa: E402

import ffimpact  # noqa: E402
import pages  # noqa: E402
from ffimpact.input.entries import Entries  # noqa: E402

project, author, copyright = "ffimpact", "the ffimpact authors", "the ffimpact authors"
version = release = ffimpact.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx_design",
    "sphinx_copybutton",
    "sphinx_gallery.gen_gallery",
    *([] if find_spec("latex2mathml") else ["sphinx.ext.mathjax"]),
]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
# Two warnings are expected: a folder without pages, and settings that are functions.
suppress_warnings = ["toc.empty_glob", "config.cache"]

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath", "fieldlist"]
myst_heading_anchors = 3
autodoc_typehints_format = "short"
autodoc_member_order = "bysource"
autodoc_preserve_defaults = True
add_module_names = False
toc_object_entries = False
default_role = "code"
autosummary_generate = False

html_math_renderer = "mathml" if find_spec("latex2mathml") else "mathjax"
html_theme = "pydata_sphinx_theme"
html_title = "ffimpact"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_copy_source = False
alone = [
    page.parent.name for page in HERE.glob("*/index.md") if len(list(page.parent.glob("*.md"))) == 1
]
html_sidebars = {page: [] for page in ("index", *(f"{folder}/index" for folder in alone))}
html_theme_options = {
    "navigation_with_keys": False,
    "show_prev_next": False,
    "header_links_before_dropdown": 6,
    "navbar_align": "left",
    "navbar_persistent": [],
    "navbar_end": ["search-button-field", "theme-switcher"],
    "secondary_sidebar_items": {"**": ["page-toc"], "index": []},
    "footer_start": ["copyright"],
    "footer_end": [],
    "pygments_light_style": "tango",
    "back_to_top_button": True,
}

sphinx_gallery_conf = {
    "examples_dirs": [str(ROOT / "examples")],
    "gallery_dirs": ["gallery"],
    "filename_pattern": r"[/\\][0-9][0-9]_[^/\\]*\.py$",
    "ignore_pattern": r"(^|[/\\])(?![0-9][0-9]_)[^/\\]*\.py$",
    "within_subsection_order": "FileNameSortKey",
    "abort_on_example_error": True,
    "parallel": 2 if find_spec("joblib") else False,
    "backreferences_dir": None,
    "capture_repr": ("_repr_html_", "__repr__"),
    "download_all_examples": False,
    "show_signature": False,
    "show_memory": False,
    "min_reported_time": 1e9,
    "remove_config_comments": True,
    "matplotlib_animations": True,
    "nested_sections": False,
}


# ---- links to files of the program, which have no page, become code

FILES = re.compile(
    r"\[([^]\n]+)\]\((?:\.\./)*"
    r"(?:edp|orchestrate|verification|benchmarks|examples|tests|[A-Z_]+(?:\.\w+)?)[^)\s]*\)"
)


def plain_links(app, name: str, source: list[str]) -> None:
    """Replaces links to files of the program by code."""
    source[0] = FILES.sub(lambda link: f"`{link[1].strip('`')}`", source[0])


# ---- formulas as MathML, which browsers draw without scripts and network access


def formula(self, node) -> None:
    """Writes an inline formula."""
    from latex2mathml.converter import convert

    self.body.append(convert(node.astext()))
    raise nodes.SkipNode


def displayed_formula(self, node) -> None:
    """Writes a displayed formula with its number."""
    from latex2mathml.converter import convert

    number = get_node_equation_number(self, node) if node["number"] else ""
    mark = f'<span class="eqno">({number})</span>' if number else ""
    name = f' id="{node["ids"][0]}"' if node.get("ids") else ""
    formula = convert(node.astext(), display="block")
    self.body.append(f'<div class="math"{name}>{mark}{formula}</div>')
    raise nodes.SkipNode


# ---- classes of the Python interface


def signature(app, what: str, name: str, item: object, options, arguments: str, returns: str):
    """The signature of a class or function.

    For a table of a scene it lists the required entries only; the page has a table of all entries
    below.
    """
    if inspect.isclass(item) and issubclass(item, Entries):
        needed = [entry for entry, field in item.model_fields.items() if field.is_required()]
        return f"(*, {', '.join([*needed, '...'])})", None
    if inspect.isclass(item) and issubclass(item, Exception):
        return "", None
    return arguments, returns


def docstring(app, what: str, name: str, item: object, options, lines: list[str]) -> None:
    """Converts a docstring, which is plain text, to reStructuredText.

    The docstring of a table of a scene is followed by a table of its entries, that of an error by
    its exit code.
    """
    lines[:] = [literal(line) for line in lines]
    if inspect.isclass(item) and issubclass(item, Entries):
        lines += ["", *entries(item)]
    elif inspect.isclass(item) and issubclass(item, ffimpact.Failure):
        lines += ["", f"Exit code: {item.code}." if item is not ffimpact.Failure else ""]


def literal(line: str) -> str:
    """A line of plain text as reStructuredText. Markup characters outside of code are escaped."""
    parts = re.split(r"(`+[^`]*`+)", line)
    if line == "-":
        return r"\-"
    return "".join(
        part if k % 2 else re.sub(r"([*|]|(?<=\w)_(?=\W|$))", r"\\\1", part)
        for k, part in enumerate(parts)
    )


def entries(model: type[Entries]) -> list[str]:
    """A table of the entries of a model that differ from those of its base class, and a link to the
    base class."""
    base = model.__mro__[1]
    common = base.model_fields if base in pages.BASES.values() else {}
    lines = [".. list-table::", "   :header-rows: 1", "   :widths: 22 10 24 44", ""]
    rows = [("entry", "unit", "accepted", "meaning")]
    for name in model.names(None):
        field = model.model_fields[name]
        texts = pages.entry_of(name, field)
        if texts and (name not in common or field.is_required() != common[name].is_required()):
            rows.append(
                (
                    f"``{name}``{', needed' if field.is_required() else ''}",
                    *(literal(text) for text in texts),
                )
            )
    for row in rows:
        lines += [f"   {'* -' if k == 0 else '  -'} {cell}".rstrip() for k, cell in enumerate(row)]
    if model is ffimpact.Scene:
        names = [
            name
            for name in model.model_fields
            if not pages.entry_of(name, model.model_fields[name]) and name != "folder"
        ]
        lines = (
            [
                f"Entries: {', '.join(f'``{name}``' for name in names)}, and those in the table.",
                "",
                *lines,
            ]
            if names
            else lines
        )
    table = lines if len(rows) > 1 else []
    return table + (
        [
            "",
            f"Further entries: those of `~ffimpact.{base.__name__}`.".replace("`~", ":py:class:`~"),
        ]
        if common
        else []
    )


def setup(app) -> None:
    app.add_html_math_renderer("mathml", (formula, None), (displayed_formula, None))
    app.connect("source-read", plain_links)
    app.connect("autodoc-process-signature", signature)
    app.connect("autodoc-process-docstring", docstring)
