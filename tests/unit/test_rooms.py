"""The rooms of the program, the folders of edp/core: what leaves one is a promise to the others."""

import re
from pathlib import Path

from ffimpact.places import ROOT

CORE = ROOT / "edp/core"
MOST = 430
TYPE = r"(?:real|int|bool|string|matrix|func|macro|varf|fespace|mesh3?|Qh|Linear|Quadratic|Piecewise|QF2)\b"
DECLARED = re.compile(rf"(?:^|[;{{}}(,]|\b(?:IFMACRO\([^)]*\)))\s*({TYPE}(?:\s*\[[^\]]*\])*)\s*&?\s*([^;{{}}]*)", re.MULTILINE)


def statements(path: Path) -> str:
    """The code without comments and texts; the ends of macros' lines are kept."""
    return re.sub(r"//.*", ";", re.sub(r'"(?:\\.|[^"\\])*"', '""', path.read_text()))


def outermost(text: str) -> str:
    """What stands in no braces and no parentheses."""
    depth, kept = 0, []
    for character in text:
        depth += (character in "{(") - (character in "})")
        kept.append(character if depth == 0 or character == "\n" else " ")
    return "".join(kept)


def names(text: str) -> set[str]:
    """All that the declarations in it declare: each name of a list, without values and sizes."""
    found = set(re.findall(rf"{TYPE}(?:\s*\[[^\]]*\])*\s*&?\s*([A-Za-z]\w*)", text))   # also parameters
    for kind, rest in DECLARED.findall(text):
        if kind.startswith(("func", "macro", "varf", "fespace")):
            rest = re.sub(rf"^{TYPE}(?:\s*\[[^\]]*\])*\s*", "", rest)
            found.update(re.findall(r"^\s*(\w+)", rest))
            continue
        while re.search(r"\([^()]*\)|\[[^\[\]]*\]", rest.lstrip()[1:]):
            rest = rest[:1] + re.sub(r"\([^()]*\)|\[[^\[\]]*\]", "", rest[1:])
        found.update(re.findall(r"(?:^|,)\s*\[?\s*&?(\w+)", re.sub(r"=[^,]*", "", rest)))
    return {name for name in found if not re.fullmatch(TYPE, name)}


def leaving() -> dict[str, set[str]]:
    """room -> its names that other rooms or the scripts use; a file that has a name of its own for something uses its own."""
    texts = {path: statements(path) for path in [*CORE.rglob("*.idp"), *CORE.parent.glob("*.edp"), *CORE.parent.glob("*.idp")]}
    words = {path: set(re.findall(r"[A-Za-z]\w*", text)) - names(text) for path, text in texts.items()}
    rooms = {path.parent for path in texts if path.is_relative_to(CORE)}
    own = {room: set().union(*(names(outermost(text)) for path, text in texts.items() if path.parent == room)) for room in rooms}
    used = {room: set().union(*(words[path] for path in texts if path.parent != room)) for room in rooms}
    return {room.name: own[room] & used[room] for room in rooms}


def test_names_that_leave_their_room_do_not_become_more():
    """A name that other folders of edp/core use stands for all of them: their number is counted, and can only fall."""
    found = leaving()
    count = len(set().union(*found.values()))   # some have two rooms that give them, of which a script takes one
    print(count, {room: len(found[room]) for room in sorted(found)})
    assert count <= MOST, {room: sorted(found[room]) for room in sorted(found)}
    assert {"ndof", "gradient", "part", "mass"} <= found["discrete"] and {"u", "solveStep"} <= found["step"]   # it sees lists, macros, functions
