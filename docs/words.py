"""Counts words and pictures of the handwritten pages, and private terms (first column of the table
of terms) that are left.

    python docs/words.py            # totals
    python docs/words.py --where    # also each position

The pages are those of docs/tutorial, how-to, explanation and README.md. Terms are also counted in the
messages of orchestrate/, in the docstrings and comments of all Python files, and in the comments of edp/. Code blocks and `code` are not searched for terms. Words are counted as `wc -w` does.
Terms that are also ordinary words (row, way, part, side ...) are counted separately and have to be
checked by eye.
"""

import ast
import io
import re
import sys
import tokenize
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TERMS = {term: re.compile(pattern, re.IGNORECASE) for term, pattern in (
    ("slot", r"\bslots?\b"), ("meeting, to meet", r"\bmeetings?\b|\bmeets?\b|\bmet\b"), ("partner", r"\bpartners?\b"), ("foot", r"\bfoot(arm)?\b|\bfeet\b"),
    ("cell", r"\bcells?\b"), ("window", r"\bwindows?\b"), ("spring", r"\bsprings?\b"), ("work excess", r"\bwork excess\b"),
    ("defect", r"\bdefects?\b"), ("learnt", r"\blearnt\b"), ("togo", r"\btogo\b"), ("hub", r"\bhubs?\b"), ("copies, folded", r"\bfolded\b|\bmay fold\b|\bfolding\b"),
    ("reach", r"\breach of\b|\breaches of\b"), ("jolt", r"\bjolts?\b"), ("hoop", r"\bhoops?\b"), ("touch", r"\btouch(es|ed|ing)?\b"), ("stated error", r"\bstated\b"),
    ("promise", r"\bpromise[sd]?\b"), ("told, said, named", r"\btold\b|\btells?\b|\bsaid\b|\bnamed\b"), ("released, open", r"\breleased\b|\bleft open\b|\bopen again\b"),
    ("asked for", r"\basked\b"), ("asker", r"\basker\b"), ("room", r"\brooms?\b"), ("bowl", r"\bbowls?\b"), ("march", r"\bmarch(es|ed)?\b"),
    ("worth", r"\bworth\b"), ("endless", r"\bendless\b"), ("tip", r"\btips?\b"))}
ORDINARY = {term: re.compile(pattern, re.IGNORECASE) for term, pattern in (
    ("row", r"\brows?\b"), ("place", r"\bplaces?\b"), ("target", r"\btargets?\b"), ("side, turns", r"\bsides?\b|\bturns\b"), ("part", r"\bparts?\b"), ("piece", r"\bpieces?\b"),
    ("copies", r"\bcopies\b"), ("way", r"\bways?\b"), ("bar", r"(?<!error )\bbars?\b"), ("hold", r"\bholds?\b"), ("rule", r"\brules?\b"), ("course", r"\bcourse\b"),
    ("far", r"\bfar\b"), ("says", r"\bsays?\b"))}
PAGES = ("tutorial", "how-to", "explanation")
# These pages consist of tables of measurements.
MEASURED = {"comparison.md"}


def prose(text: str) -> str:
    """The text of a page without code, HTML comments and targets of links. The number of lines
    stays the same."""
    text = re.sub(r"(?s)```.*?```|<!--.*?-->", lambda match: "\n" * match[0].count("\n"), text)
    return re.sub(r"\]\([^)]*\)", "]", re.sub(r"`[^`\n]*`|\$[^$\n]+\$", "", text))


def messages(path: Path) -> list[tuple[int, str]]:
    """The messages of a module with their lines: strings of three words or more that are not
    docstrings."""
    tree = ast.parse(path.read_text())
    documented = {id(node.body[0].value) for node in ast.walk(tree) if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and node.body
                  and isinstance(node.body[0], ast.Expr)}
    return [(node.lineno, node.value) for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)
            and id(node) not in documented and len(node.value.split()) > 2]


def comments(path: Path) -> list[tuple[int, str]]:
    """The docstrings and comments of a Python file, or the comments of a FreeFEM or C++ file, with
    their lines. `Code` in them is left out."""
    text = path.read_text()
    if path.suffix == ".py":
        texts = [(token.start[0], token.string) for token in tokenize.generate_tokens(io.StringIO(text).readline) if token.type == tokenize.COMMENT]
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and (words := ast.get_docstring(node)):
                texts.append((node.body[0].lineno, words))
    else:
        texts = [(k, line.partition("//")[2]) for k, line in enumerate(text.splitlines(), 1)]
    return [(k, re.sub(r"`[^`]*`|\b\w*[a-z][A-Z]\w*", "", words)) for k, words in texts]


def pages() -> list[Path]:
    """The handwritten pages."""
    return [ROOT / "README.md", *(path for name in PAGES for path in sorted((ROOT / "docs" / name).glob("*.md"))
                                    if path.name not in MEASURED)]


def lines(path: Path) -> list[tuple[str, str]]:
    """The lines of a page with their positions, without code."""
    return [(f"{path.relative_to(ROOT)}:{k}", line) for k, line in enumerate(prose(path.read_text()).splitlines(), 1)]


def count(texts: list[tuple[str, str]], terms: dict[str, re.Pattern], where: bool = False) -> Counter:
    """The number of occurrences of each term in `texts`, a list of position and text."""
    total = Counter()
    for place, text in texts:
        for term, pattern in terms.items():
            for match in pattern.finditer(text):
                total[term] += 1
                if where:
                    print(f"    {place}: {match[0]}: {text.strip()[:110]}")
    return total


def main(where: bool) -> int:
    total, pictures, written = 0, 0, []
    for path in pages():
        text = path.read_text()
        drawn, number = len(re.findall(r"!\[", text)), len(text.split())
        total, pictures = total + number, pictures + drawn
        written += lines(path)
        print(f"{number:6} words {drawn:3} pictures  {path.relative_to(ROOT)}")
    print(f"{total:6} words {pictures:3} pictures  on {len(pages())} pages")
    own = count(written, TERMS, where)
    print(f"private terms on these pages: {own.total()}  {dict(own)}")
    print(f"ordinary words to look at: {dict(count(written, ORDINARY))}")
    printed = [(f"{path.relative_to(ROOT)}:{k}", text) for path in sorted((ROOT / "orchestrate").rglob("*.py")) for k, text in messages(path)]
    theirs = count(printed, TERMS, where)
    print(f"private terms in texts of orchestrate/: {theirs.total()}  {dict(theirs)}")
    for folder, suffixes in (("orchestrate", (".py",)), ("benchmarks", (".py",)), ("verification", (".py",)), ("tests", (".py",)), ("edp", (".edp", ".idp", ".hpp", ".cpp"))):
        texts = [(f"{path.relative_to(ROOT)}:{k}", text) for path in sorted((ROOT / folder).rglob("*")) if path.suffix in suffixes
                 for k, text in comments(path)]
        inside = count(texts, TERMS, where)
        print(f"private terms in comments of {folder}/: {inside.total()}  {dict(inside)}")
    return int(own.total() > 0)


if __name__ == "__main__":
    sys.exit(main("--where" in sys.argv))
