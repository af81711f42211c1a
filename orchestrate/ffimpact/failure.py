"""Expected failures. Each has a message of one line for the user and an exit code, see the table in
the run contract.
"""

import difflib
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Self, TypeVar, overload

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
    "printable",
    "shortened",
    "signals",
    "suggestion",
    "unknown",
]

A = TypeVar("A")
B = TypeVar("B")
C = TypeVar("C")
D = TypeVar("D")

# Numbers of the signals that ask the program to end. Python drops an exception of a signal handler
# in some places, such as callbacks of imports; whoever waits for a process looks here, too.
signals: list[int] = []

MORE = " ..."  # appended to a text that is cut
MOST = 200  # largest number of characters of a value that a message repeats
# A second word is suggested if its similarity to the user's word, in [0, 1], is less than this
# below that of the first word.
ALIKE = 0.15
SWITCHES = {"true": "on", "false": "off"}  # the accepted word for a word that users write instead


class Failure(Exception):
    """A failure that the user can act on. `code` is the exit code: 11 for a step, 12 for a
    material, 1 for anything else; further subclasses have their own.

    `folder` is the folder in which the files of a failed run were kept.
    """

    code = 1
    folder: Path | None = None

    def __init__(self, *messages: str, code: int | None = None):
        # Each message becomes one line, even if it repeats a text of several lines.
        self.messages = tuple(" ".join(message.splitlines()) for message in messages)
        super().__init__("\n".join(self.messages))
        self.code = self.code if code is None else code

    def within(self, origin: str) -> Self:
        """Returns the same failure with `origin`, a file or a table, in front of each message."""
        return type(self)(*(f"{origin}: {message}" for message in self.messages), code=self.code)


def brief(value: object) -> str:
    """Returns a value as the text that a message repeats, cut if it is long. True and false are
    written as in TOML.
    """
    try:
        text = str(value).lower() if isinstance(value, bool) else str(value)
    except ValueError:
        text = "an integer with more digits than Python writes"
    return shortened(printable(text), MOST + len(MORE))


def printable(text: str) -> str:
    """Returns a text with escapes for bytes that are no UTF-8, which a command line may contain."""
    return text.encode(errors="backslashreplace").decode()


def shortened(text: str, limit: int) -> str:
    """Returns a text, cut to at most `limit` characters."""
    return text if len(text) <= limit else text[: limit - len(MORE)] + MORE


def suggestion(word: object, accepted: Iterable[str]) -> str:
    """Returns the part of a message that suggests one or two accepted words similar to the user's
    word. It is empty if no word is similar.
    """
    lowered, words = brief(word).lower(), list(dict.fromkeys(accepted))
    near = [
        candidate for candidate in (SWITCHES.get(lowered),) if candidate in words
    ] or difflib.get_close_matches(lowered, words, n=2)
    likeness = [difflib.SequenceMatcher(None, candidate, lowered).ratio() for candidate in near]
    near = [candidate for candidate, like in zip(near, likeness) if like > likeness[0] - ALIKE]
    return f"; did you mean {' or '.join(near)}?" if near else ""


def unknown(word: object, accepted: Iterable[str], between: str = "|") -> str:
    """Returns a message that `word` is unknown, with suggestions and all accepted words."""
    words = list(accepted)
    return (
        f"'{brief(word)}' is not known{suggestion(word, words)} (accepted: {between.join(words)})"
    )


class StepFailed(Failure):
    """A time step does not converge, however small it is."""

    code = 11


class MaterialFailed(Failure):
    """A constitutive law breaks down: an element is turned inside out."""

    code = 12


class TooLong(Failure):
    """A run exceeded its time limit: it was interrupted and did not fail. The exit code is that of
    timeout(1).
    """

    code = 124


class BadInput(Failure):
    """A parameter, scene file or mesh cannot be used."""

    code = 10


class NotInstalled(Failure):
    """FreeFem++ or a library is missing, is too old or lacks a plugin."""

    code = 13


class Unreadable(Failure):
    """A result folder cannot be read or was not written by this program."""

    code = 14


class Busy(Unreadable):
    """Another run is writing the result folder."""


def of_code(code: int, message: str) -> Failure:
    """Returns the failure that has this exit code."""
    kinds = {
        kind.code: kind
        for kind in (StepFailed, MaterialFailed, TooLong, BadInput, NotInstalled, Unreadable)
    }
    return kinds[code](message) if code in kinds else Failure(message, code=code)


@overload
def gathered(
    acts: tuple[Callable[[], A], Callable[[], B], Callable[[], C], Callable[[], D]],
) -> tuple[A, B, C, D]: ...
@overload
def gathered(acts: list[Callable[[], A]]) -> list[A]: ...
def gathered(acts: Any) -> Any:
    """Calls all `acts` and returns their results. Raises one BadInput with the messages of all that
    failed.
    """
    results = []
    messages: list[str] = []
    for act in acts:
        try:
            results.append(act())
        except BadInput as error:
            messages += error.messages
    if messages:
        raise BadInput(*messages)
    return results
