"""Warnings and notes of a run: sentences `name: fact: meaning: advice`.

They are made in output/warnings.py and output/estimate.py. A warning reports that a result may be
wrong. A note is a remark about a number: a property of this number in every such scene, or a
warning whose cause or effect another warning reports already. The summary holds the sentences, the
screen shows one line for each.
"""

from collections.abc import Iterable, Sequence

from ..failure import shortened

__all__ = ["BEHIND", "WIDEST", "footnotes", "line", "name", "number", "settled"]

WIDEST = 100  # columns of a printed line
CAUSES = ("contact points", "steps")  # warnings about causes of estimated errors
# Warnings about the accuracy of a result. They become notes if the law has no solution or a body
# passes through itself.
OF_ACCURACY = ("penalty", "locking", "corner", *CAUSES)
# By the name of a warning: the warnings that become notes beside it. Estimated errors include the
# effect of their causes. If the mesh decides how often bodies come into contact, so does the
# penalty.
BEHIND = {
    "overlap": OF_ACCURACY,
    "ellipticity": OF_ACCURACY,
    "breakdown": ("ellipticity", *OF_ACCURACY),
    "touches": ("penalty", *CAUSES),
    "estimated errors": CAUSES,
}
# The key of the number that a note is about, if it differs from the name of the note.
NUMBERS = {
    "penalty damping": "penalty_damping_work",
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
    """Returns the name of a sentence (docs/reference/warnings.md)."""
    return sentence.partition(":")[0]


def number(note: str) -> str:
    """Returns the key of summary.json that a note is about."""
    return NUMBERS.get(name(note), name(note).replace(" ", "_"))


def footnotes(
    sentences: Iterable[str], keys: Sequence[str], verbose: bool = False
) -> dict[str, list[str]]:
    """Returns the notes about each number that has some, by key. The printed numbers `keys` come
    first, in their order; if `verbose` all others follow.
    """
    of_number: dict[str, list[str]] = {}
    for sentence in sentences:
        of_number.setdefault(number(sentence), []).append(sentence)
    order = [key for key in keys if key in of_number]
    if verbose:
        order += [key for key in of_number if key not in order]
    return {key: of_number[key] for key in order}


def line(kind: str, sentence: str) -> str:
    """Returns a sentence as printed: up to its second colon, no wider than the screen."""
    return shortened(kind + ": ".join(sentence.split(": ")[:2]), WIDEST)


def settled(warnings: Iterable[str], notes: Iterable[str]) -> dict[str, list[str]]:
    """Returns both lists. Warnings that another warning makes notes of (BEHIND) are among the
    notes.
    """
    warnings = list(warnings)
    behind = {note for warning in warnings for note in BEHIND.get(name(warning), ())}
    return {
        "warnings": [warning for warning in warnings if name(warning) not in behind],
        "notes": [*notes, *(warning for warning in warnings if name(warning) in behind)],
    }
