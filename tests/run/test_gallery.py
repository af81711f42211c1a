"""The pages of the gallery run. Their numbers agree with published and exact ones, or a note has
the reason."""


import numpy as np
import pandas as pd
import pytest

from examples import gallery

CHEAP = {"12_hertz"}
MARKED = [
    pytest.param(page, id=page.stem, marks=[] if page.stem in CHEAP else pytest.mark.robustness)
    for page in gallery.pages()
]


@pytest.mark.parametrize("page", MARKED)
def test_a_page_runs_and_its_numbers_are_consistent(page, tmp_path, monkeypatch):
    """In an empty working folder each number agrees within error and uncertainty, or has a note
    with the reason and misses by no more than this note says."""
    monkeypatch.chdir(tmp_path)
    assert not gallery.complaints(gallery.numbers(page))


def table(**row) -> pd.DataFrame:
    """A table of one number that agrees, with other entries as in `row`."""
    agrees = dict(
        quantity="impulse",
        unit="N s",
        computed=1.0,
        error=0.1,
        reference=1.15,
        uncertainty=0.1,
        source="exact",
        note="",
    )
    return pd.DataFrame([agrees | row])


@pytest.mark.parametrize(
    "row",
    [
        {},
        {"reference": np.nan, "error": np.nan, "uncertainty": np.nan},
        {"reference": 2.0, "note": "misses by 50 %: the reference is rigid"},
        {"reference": 2.0, "note": "misses by 1.01: the reference is rigid"},
        {"note": "fitted: the penalty"},
    ],
)
def test_what_agrees_or_says_why_not_is_accepted(row):
    """A number without a reference is accepted, too."""
    assert not gallery.complaints(table(**row))


@pytest.mark.parametrize(
    "row",
    [
        {"reference": 1.21},
        {"computed": 0.9},
        {"error": np.nan},
        {"uncertainty": np.nan},
        {"unit": ""},
        {"computed": np.nan},
        {"computed": np.inf},
        {"reference": 2.0, "note": "misses: the reference is rigid"},
        {"reference": 2.0, "note": "misses by 49 %: the reference is rigid"},
        {"reference": 2.0, "note": "misses by 0.99: the reference is rigid"},
        {"reference": 2.0, "note": "misses by 50 %: "},
        {"reference": 2.0, "note": "fitted: the penalty"},
        {"extra": 1},
    ],
)
def test_what_disagrees_without_a_reason_is_found(row):
    """A number beyond both error bars, one without error bars and an invalid number are reported."""
    assert len(gallery.complaints(table(**row))) == 1
