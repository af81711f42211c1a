"""Warnings and notes of a run: sentences `name: what is so: what it means: what to do`.

They are made in edp/core/run/warnings.idp and estimate.py. A warning is something that may make an
answer wrong. A note is the footnote of a number: what is always so of that number in such a scene,
or what stands behind a warning that says that the answers are no good. The summary has the
sentences, the screen a line of each.
"""

from collections.abc import Iterable

from ..failure import shortened

__all__ = ["BEHIND", "WIDEST", "line", "name", "number", "settled"]

WIDEST = 100  # columns of a printed line
# Warnings about the accuracy of an answer. An answer has none where the law has no answer, or a
# body passes through itself.
CAUSES = ("contact points", "steps")  # of errors that are estimated
OF_ACCURACY = ("penalty", "locking", "corner", "touches", "estimated errors", *CAUSES)
# What a warning of this name makes notes of. Estimated errors that are too large have the effect of
# their causes in them. Where the mesh decides how often bodies touch, the penalty does, too.
BEHIND = {
    "overlap": OF_ACCURACY,
    "ellipticity": OF_ACCURACY,
    "breakdown": ("ellipticity", *OF_ACCURACY),
    "touches": ("penalty", *CAUSES),
    "estimated errors": CAUSES,
}
# the key of the number that a note is about, where the name of the note is not that of the number
NUMBERS = {
    "penalty": "max_penetration",
    "locking": "peak_force",
    "corner": "min_stretch",
    "contact points": "peak_force",
    "steps": "contact_time",
    "touches": "contact_intervals",
    "estimated errors": "estimated_error",
    "mesh of the file": "estimated_error",
    "ellipticity": "ellipticity_lost_time",
    "touches again": "contact_intervals",
}


def name(sentence: str) -> str:
    """By which a sentence is known (docs/reference/warnings.md)."""
    return sentence.partition(":")[0]


def number(note: str) -> str:
    """The key of summary.json that a note is about."""
    return NUMBERS.get(name(note), name(note).replace(" ", "_"))


def line(kind: str, sentence: str) -> str:
    """A sentence as printed: up to its second colon, no wider than the screen."""
    return shortened(kind + ": ".join(sentence.split(": ")[:2]), WIDEST)


def settled(warnings: Iterable[str], notes: Iterable[str]) -> dict[str, list[str]]:
    """Both lists, with warnings that stand behind others (BEHIND) among the notes."""
    warnings = list(warnings)
    behind = {each for one in warnings for each in BEHIND.get(name(one), ())}
    return {
        "warnings": [one for one in warnings if name(one) not in behind],
        "notes": [*notes, *(one for one in warnings if name(one) in behind)],
    }
