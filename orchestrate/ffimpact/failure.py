"""Expected failures: one line for the user and an exit code (the table in the run contract)."""

import difflib
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Self, TypeVar

__all__ = [
    "BadInput",
    "Busy",
    "Failure",
    "MaterialFailed",
    "NotInstalled",
    "StepFailed",
    "TooLong",
    "Unreadable",
    "brief",
    "gathered",
    "of_code",
    "shortened",
    "suggestion",
    "unknown",
]

T = TypeVar("T")

MORE = " ..."  # behind a text that is cut
MOST = 200  # characters of a value that a message repeats
# a second word is suggested where its likeness to the user's is this near to that of the first
ALIKE = 0.15
SWITCHES = {"true": "on", "false": "off"}  # what a user may write for a word


class Failure(Exception):
    """A failure that the user can act on. `code` is the exit code: 11 step, 12 material, 1
    anything else.

    `folder` is where the files of a failed run were kept.
    """

    code = 1
    folder: Path | None = None

    def __init__(self, *messages: str, code: int | None = None):
        self.messages = tuple(
            " ".join(one.splitlines()) for one in messages
        )  # a line each, whatever the user's text had in it
        super().__init__("\n".join(self.messages))
        self.code = self.code if code is None else code

    def within(self, place: str) -> Self:
        """The same of an entry in `place`, a file or a table."""
        return type(self)(*(f"{place}: {one}" for one in self.messages), code=self.code)


def brief(value) -> str:
    """A value as a message repeats it, however long it is; true and false as TOML has them."""
    text = str(value).lower() if isinstance(value, bool) else str(value)
    return shortened(text, MOST + len(MORE))


def shortened(text: str, most: int) -> str:
    """A text of up to so many characters."""
    return text if len(text) <= most else text[: most - len(MORE)] + MORE


def suggestion(word, accepted: Iterable[str]) -> str:
    """What a message adds where one or two of the accepted words are near to the user's; empty
    where none is.
    """
    given, words = brief(word).lower(), list(dict.fromkeys(accepted))
    near = [one for one in (SWITCHES.get(given),) if one in words] or difflib.get_close_matches(
        given, words, n=2
    )
    likeness = [difflib.SequenceMatcher(None, one, given).ratio() for one in near]
    near = [one for one, like in zip(near, likeness) if like > likeness[0] - ALIKE]
    return f"; did you mean {' or '.join(near)}?" if near else ""


def unknown(word, accepted: Iterable[str], between: str = "|") -> str:
    """What a message says of a word that is none of the accepted ones."""
    words = list(accepted)
    return (
        f"'{brief(word)}' is not known{suggestion(word, words)} (accepted: {between.join(words)})"
    )


class StepFailed(Failure):
    """A time step that does not converge however small it is."""

    code = 11


class MaterialFailed(Failure):
    """A law that breaks down: an element is turned inside out."""

    code = 12


class TooLong(Failure):
    """A run that its time limit ended: interrupted, not failed. The code is that of timeout(1)."""

    code = 124


class BadInput(Failure):
    """A parameter, scene file or mesh that cannot be used."""

    code = 10


class NotInstalled(Failure):
    """FreeFem++ (or a library) missing, too old or without a plugin it needs."""

    code = 13


class Unreadable(Failure):
    """A result folder that cannot be read or is not ours."""

    code = 14


class Busy(Unreadable):
    """A result folder that another run is writing just now."""


def of_code(code: int, message: str) -> Failure:
    """The failure of an exit code."""
    kinds = {
        one.code: one
        for one in (StepFailed, MaterialFailed, TooLong, BadInput, NotInstalled, Unreadable)
    }
    return kinds[code](message) if code in kinds else Failure(message, code=code)


def gathered(acts: Iterable[Callable[[], T]]) -> list[T]:
    """What each of some acts returns; one BadInput with all that they find wrong."""
    found, messages = [], []
    for act in acts:
        try:
            found.append(act())
        except BadInput as error:
            messages += error.messages
    if messages:
        raise BadInput(*messages)
    return found
