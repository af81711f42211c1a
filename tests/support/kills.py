"""Helpers that the modules test_kills.py share."""

from pathlib import Path


def at_work(out: Path) -> list[int]:
    """The numbers of the running processes with this folder in their command line."""
    pids = []
    for place in Path("/proc").glob("[0-9]*"):
        try:
            words, state = (place / "cmdline").read_bytes(), (place / "stat").read_text().rpartition(")")[2].split()[0]
        except OSError:
            continue
        if str(out).encode() in words and state != "Z":
            pids.append(int(place.name))
    return pids


def place(route: str, shelf: Path) -> Path:
    (shelf / route).mkdir(exist_ok=True)
    return shelf / route
