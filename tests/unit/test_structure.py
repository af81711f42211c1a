"""The folders of the Python package: permitted imports, and the length of functions and lines."""

import ast
import tomllib
from functools import cache

from ffimpact.places import ROOT

PACKAGE = ROOT / "orchestrate/ffimpact"
# A folder imports the folders before it and the modules in its own line. A module that is in no
# line imports no others.
ORDER = (("failure", "places", "progress", "flight"), ("freefem",), ("geometry",), ("mesh",), ("input",), ("output",), ("scenes",), ("scene",), ("running",),
         ("report",), ("sweeps",), ("repeats",), ("schema", "plot", "view", "spectrum", "recording"), ("result",), ("fitting",), ("api",), ("__init__", "__main__"))
MODULES = {path.relative_to(PACKAGE).with_suffix("").parts: path for path in sorted(PACKAGE.rglob("*.py"))}


@cache
def parsed(module: tuple[str, ...]) -> tuple[ast.AST, ...]:
    """The nodes of a module, without what is for types only."""
    tree = ast.parse(MODULES[module].read_text())
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and getattr(node.test, "id", "") == "TYPE_CHECKING":
            node.body = [ast.Pass()]
    return tuple(ast.walk(tree))


@cache
def imported(module: tuple[str, ...]) -> set[tuple[str, ...]]:
    """The modules of the package that a module imports anywhere, without imports for types only."""
    imports = set()
    for node in parsed(module):
        if isinstance(node, ast.ImportFrom) and node.level:
            place = module[:len(module) - node.level] + tuple((node.module or "").split(".") if node.module else ())
            imports |= {place + (name.name,) for name in node.names if place + (name.name,) in MODULES} or ({place} & set(MODULES)) or {place + ("__init__",)}
    return imports


def test_no_import_circle():
    """No module imports itself through others, at the top or inside functions."""
    open_ones = {module: imported(module) for module in MODULES}
    while free := [module for module, needs in open_ones.items() if not needs & set(open_ones)]:
        for module in free:
            del open_ones[module]
    assert not open_ones


def test_a_room_imports_those_before_it():
    """Each folder can be read without the later ones. All may import the version in __init__."""
    height = {name: k for k, line in enumerate(ORDER) for name in line}
    assert not [f"{'/'.join(module)} imports {'/'.join(other)}" for module in MODULES for other in imported(module)
                if height[other[0]] > height[module[0]] and other != ("__init__",)]


# Messages and generated tables of the package may be longer than lines of scripts and kernels.
LINE, LINE_OF_SCRIPTS = 140, 100


def test_lines_fit_a_screen():
    """No line of the Python package has more than 140 characters, and none of the scripts and kernels
    more than 100."""
    scripts = [path for path in (ROOT / "edp").rglob("*") if path.suffix in (".edp", ".idp", ".hpp", ".cpp")]
    files = [(path, LINE) for path in MODULES.values()] + [(path, LINE_OF_SCRIPTS) for path in scripts]
    assert not [f"{path.relative_to(ROOT)}:{k}" for path, limit in files for k, line in enumerate(path.read_text().splitlines(), 1) if len(line) > limit]


def test_headers_are_short():
    """The comment at the head of a script or kernel has at most eight lines."""
    for path in (ROOT / "edp").rglob("*"):
        if path.suffix in (".edp", ".idp", ".hpp", ".cpp"):
            lines = path.read_text().splitlines()
            header = next(k for k, line in enumerate(lines) if not line.startswith("//"))
            assert header <= 8, f"{path.relative_to(ROOT)}: {header}"


def test_a_module_says_what_it_gives():
    """The public names of a module are in __all__. No other module imports a private one."""
    for module in MODULES:
        assert not [name.name for node in parsed(module) if isinstance(node, ast.ImportFrom) and node.level for name in node.names if name.name.startswith("_") and name.name != "__version__"], module
        if module[-1] != "__init__":
            top = parsed(module)[0].body
            exports = next(ast.literal_eval(node.value) for node in top if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "__all__")
            assert not {name for node in top if (name := getattr(node, "name", "_")) and not name.startswith("_")} - set(exports), module


IGNORED = 12


def test_mypy_checks_every_module():
    """mypy is strict and leaves out no module. Few lines need `type: ignore`, each because of a library."""
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["mypy"]
    ignored = [line for path in MODULES.values() for line in path.read_text().splitlines() if "# type: ignore" in line]
    assert settings["strict"] and "overrides" not in settings and len(ignored) <= IGNORED


VAGUE = {"one", "each", "given", "found", "known", "of", "most", "left", "way"}


def test_names_say_what_they_hold():
    """No variable, argument or function has a name that would suit any quantity."""
    vague = []
    for module in MODULES:
        for node in parsed(module):
            name = (node.id if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
                    else node.arg if isinstance(node, ast.arg)
                    else node.name if isinstance(node, (ast.FunctionDef, ast.ClassDef)) else "")
            if name in VAGUE:
                vague.append(f"{'/'.join(module)}:{node.lineno} {name}")
    assert not vague
