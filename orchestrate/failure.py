"""Expected failures: one line for the user and an exit code (the table in the run contract)."""

from pathlib import Path

MOST = 200   # characters of a value that a message repeats


class Failure(Exception):
    """A failure that the user can act on. `code` is the exit code: 11 step, 12 material, 1 anything else.

    `folder` is where the files of a failed run were kept.
    """

    code = 1
    folder: Path | None = None

    def __init__(self, message: str, code: int | None = None):
        super().__init__(" ".join(message.splitlines()))   # one line, whatever the user's text had in it
        self.code = self.code if code is None else code


def brief(value) -> str:
    """A value as a message repeats it, however long it is."""
    text = str(value)
    return text if len(text) <= MOST else f"{text[:MOST]} ..."


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
