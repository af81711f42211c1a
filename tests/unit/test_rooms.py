"""The folders of edp/program: the names that other folders use."""

import re
from pathlib import Path

from ffimpact.places import ROOT

CORE = ROOT / "edp/program"
MOST = 274
TYPE = r"(?:real|int|bool|string|matrix|func|macro|varf|fespace|mesh3?|Qh|Linear|Quadratic|Piecewise|QF2)\b"
DECLARED = re.compile(rf"(?:^|[;{{}}(,]|\b(?:IFMACRO\([^)]*\)))\s*({TYPE}(?:\s*\[[^\]]*\])*)\s*&?\s*([^;{{}}]*)", re.MULTILINE)


def statements(path: Path) -> str:
    """The code without comments and texts. The line ends of macros are kept."""
    return re.sub(r"//.*", ";", re.sub(r'"(?:\\.|[^"\\])*"', '""', path.read_text()))


def outermost(text: str) -> str:
    """The text outside of braces and parentheses."""
    depth, kept = 0, []
    for character in text:
        depth += (character in "{(") - (character in "})")
        kept.append(character if depth == 0 or character == "\n" else " ")
    return "".join(kept)


def names(text: str) -> set[str]:
    """All names that the declarations in `text` declare, without values and sizes."""
    # Also parameters.
    identifiers = set(re.findall(rf"{TYPE}(?:\s*\[[^\]]*\])*\s*&?\s*([A-Za-z]\w*)", text))
    for kind, rest in DECLARED.findall(text):
        if kind.startswith(("func", "macro", "varf", "fespace")):
            rest = re.sub(rf"^{TYPE}(?:\s*\[[^\]]*\])*\s*", "", rest)
            identifiers.update(re.findall(r"^\s*(\w+)", rest))
            continue
        while re.search(r"\([^()]*\)|\[[^\[\]]*\]", rest.lstrip()[1:]):
            rest = rest[:1] + re.sub(r"\([^()]*\)|\[[^\[\]]*\]", "", rest[1:])
        identifiers.update(re.findall(r"(?:^|,)\s*\[?\s*&?(\w+)", re.sub(r"=[^,]*", "", rest)))
    return {name for name in identifiers if not re.fullmatch(TYPE, name)}


def leaving() -> dict[str, set[str]]:
    """The names of each folder that other folders or the scripts use. A file that declares a name
    itself uses its own."""
    texts = {path: statements(path) for path in CORE.rglob("*.?dp")}
    words = {path: set(re.findall(r"[A-Za-z]\w*", text)) - names(text) for path, text in texts.items()}
    rooms = {path.parent for path in texts} - {CORE}
    own = {room: set().union(*(names(outermost(text)) for path, text in texts.items() if path.parent == room)) for room in rooms}
    used = {room: set().union(*(words[path] for path in texts if path.parent != room)) for room in rooms}
    return {room.name: own[room] & used[room] for room in rooms}


def test_names_that_leave_their_room_do_not_become_more():
    """The number of names that other folders of edp/program use can only fall."""
    names_of_rooms = leaving()
    # Two folders provide some of the names, of which a script uses one.
    count = len(set().union(*names_of_rooms.values()))
    print(count, {room: len(names_of_rooms[room]) for room in sorted(names_of_rooms)})
    assert count <= MOST, {room: sorted(names_of_rooms[room]) for room in sorted(names_of_rooms)}
    # The search detects lists, macros and functions.
    assert {"ndof", "shapeSlopes", "tensorComponent", "mass"} <= names_of_rooms["discrete"] and {"u", "solveStep"} <= names_of_rooms["step"]
