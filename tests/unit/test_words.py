"""Handwritten pages: plain terms, few words, and a figure on each; docs/words.py counts."""

import re

import pytest

import words
from ffimpact.places import ROOT

PAGES = words.pages()


def test_all_pages_together_have_few_words():
    """The limit is 27,000 words."""
    assert sum(len(path.read_text().split()) for path in PAGES) <= 27_000


@pytest.mark.parametrize("path", PAGES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_a_page_has_a_picture_and_no_private_term(path):
    """Terms are those of textbooks, or defined in the glossary."""
    text = path.read_text()
    assert "![" in text
    counts = words.count(words.lines(path), words.TERMS)
    assert not counts, counts


def test_every_figure_is_small_and_shown():
    """Each is smaller than 100 kB and shown on a page."""
    shown = set(re.findall(r"\]\((?:\.\./)?figures/([\w-]+\.(?:svg|png))", "".join(path.read_text() for path in PAGES)))
    there = {path.name: path.stat().st_size for path in (ROOT / "docs/figures").iterdir() if path.suffix in (".svg", ".png")}
    assert set(there) == shown and max(there.values()) < 100_000
