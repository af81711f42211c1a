"""Generates the parts of pages that follow from the program.

A part NAME is between the marks `<!-- NAME -->` and `<!-- end of NAME -->` of any page: parameters,
columns, warnings, exit codes, commands, equations, and the Python interface.
"""

import argparse
import ast
import contextlib
import importlib
import inspect
import io
import os
import re
import sys
from collections.abc import Callable, Collection, Iterator, Mapping
from pathlib import Path

import pandas as pd
from pydantic.fields import FieldInfo

import ffimpact
from ffimpact import __main__ as command_line, failure, schema
from ffimpact.input import (
    bodies,
    conditions,
    contact,
    layers,
    materials,
    obstacles,
    parameters,
    shapes,
)
from ffimpact.input.entries import Entries
from ffimpact.input.parameter import Parameter, Rule
from ffimpact.output.columns import FILES, NEEDS
from ffimpact.places import PACKAGE, ROOT, shown
from ffimpact.scenes import needs

EQUATION = re.compile(r"// ((?:\(\d+\)(?:, |–| ))*\(\d+\))(?::| |$)")


KINDS = {"warn": "warning", "note": "note"}
# Verbs with which advice begins.
VERBS = (
    "take|compare|round|give|make|end|use|set|run|choose|lower|increase|reduce|raise|check|try|see"
)
# Advice for warnings whose sentence has none.
ADVICE = {
    "angular momentum": "take integrator=energy-momentum, or a smaller dt",
    "energy": "take integrator=energy-momentum, or a smaller dt",
    "momentum": "take integrator=energy-momentum, or a smaller dt",
    "no contact": "take a larger end_time, or correct position and velocity",
    "rebound": "take the impulse, or a smaller gravity",
    "thresholded contact time": "take the error bar as it is, or contact_time",
}
# Warnings that no call of warn or note contains as one sentence.
OF_ESTIMATES = "".join(
    f"| {name} | {kind} | {words} | {advice} |\n"
    for name, kind, words, advice in (
        (
            "chatter",
            "warning",
            "the body left and was back within a wave's transit … times in a row "
            "(`chatter=continue`)",
            "take a smaller dt or penalty, or a viscosity",
        ),
        (
            "estimated errors",
            "warning / note",
            "a warning if the estimate of a requested number is above twice the accuracy; a "
            "note if it is above the accuracy, or above twice the accuracy for contact_time and "
            "peak_force",
            "take a smaller accuracy, or the error bar as it is",
        ),
        (
            "touches",
            "warning",
            "a level of the estimate has another number of contact intervals: error estimates may "
            "be too small",
            "take a smaller accuracy, or the impulse, which does not depend on single touches",
        ),
        (
            "mesh of the file",
            "note",
            "error estimates are those of the step alone: the mesh of a file is not varied",
            "compare with a finer file",
        ),
        (
            "no finer run",
            "warning",
            "the error estimate is above the accuracy, and the finer run failed",
            "see `log.txt`; take the error bar as it is",
        ),
        (
            "the error is not estimated",
            "warning",
            "the coarser run failed, or took the same steps",
            "take another accuracy and compare",
        ),
    )
)


def main(argv: list[str]) -> int:
    """Writes the pages of the source folder."""
    argparse.ArgumentParser(prog="python docs/pages.py", description=__doc__).parse_args(argv)
    for path, text in pages().items():
        path.write_text(text)
        print(shown(path))
    return 0


def pages() -> dict[Path, str]:
    """The text of every page with generated parts, by file. The parts are generated again."""
    made = {schema.FILE: schema.text()}
    for path in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]:
        text = path.read_text()
        for name in re.findall(r"(?m)^<!-- end of (.*?) -->$", text):
            if name in PARTS:
                begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
                before, _, rest = text.partition(begin)
                text = before + begin + PARTS[name](path.parent) + end + rest.partition(end)[2]
                made[path] = text
    return made


def entries() -> str:
    """Tables of all entries of a scene with unit, accepted values and meaning."""
    text = (
        "\n## Parameters of a run\nAt the top of a scene file, or in `[contact]` and `[[body]]` as "
    )
    text += "below; by `--set name=value`, and in Python.\n"
    text += "\n| name | unit | default | accepted | meaning |\n|---|---|---|---|---|\n"
    for parameter in parameters.PARAMETERS.values():
        if parameter.name in ("speed", "spin"):  # of bodies alone
            continue
        default = (
            parameter.default if isinstance(parameter.default, str) else f"{parameter.default:g}"
        )
        accepted = cell(words(parameter.accepted))
        text += f"| `{parameter.name}` | {parameter.unit} | {default} | {accepted} | {cell(parameter.help)} |\n"
    text += "\n## What needs what\nOther values are refused, except `auto`, which becomes one of these.\n\n"
    text += "| what | entry | accepted |\n|---|---|---|\n"
    for need in needs.NEEDS:
        what = need.what.rpartition(" ")[0]
        for name, values in need.accepted.items():
            text += f"| {what} | `{name}` | {cell(words('|'.join(map(str, values))))} |\n"
    text += "\n## Materials\nIn Python `material = NeoHookean(...)` and so on; in a file the same "
    text += "entries in a body's table, or at the top for all bodies.\n\n"
    text += "".join(
        f"- `{name}`, `{law.__name__}`: {first_line(law)}\n" for name, law in materials.LAWS.items()
    )
    text += table_of(
        "Bodies", "`[[body]]`, `Body` in Python: what bodies of all shapes have.", bodies.Body
    )
    text += kinds("shape", shapes.BODIES, bodies.Body)
    text += table_of(
        "Layers", "`[[body.layer]]`, `Layer`: parts with a material of their own.", layers.Layer
    )
    text += table_of("Supports", "`[[body.support]]`, `Support`.", conditions.Support)
    text += table_of(
        "Loads", "`[[body.load]]`, `Load`: one of traction, pressure and gas.", conditions.Load
    )
    text += table_of("Gas", "`gas = {...}` of a load, `Gas`.", conditions.Gas)
    text += table_of(
        "Rigid obstacles",
        "`[[obstacle]]`, `Obstacle`: what obstacles of all kinds have.",
        obstacles.Obstacle,
    )
    text += kinds("kind", obstacles.OBSTACLES, obstacles.Obstacle)
    text += table_of("Contact", "`[contact]`, `Contact`: of the whole scene.", contact.Contact)
    return (
        text
        + table_of(
            "Pairs", "`[[contact.pair]]`, `Pair`: what differs between two partners.", contact.Pair
        )
        + "\n"
    )


def first_line(model: type) -> str:
    """The first line of the docstring of a class."""
    return (model.__doc__ or "").strip().split("\n")[0]


def table_of(heading: str, words: str, model: type[Entries]) -> str:
    """A heading with a table of the entries of a model."""
    return (
        f"\n## {heading}\n{words}\n\n| name | unit | accepted | meaning |\n|---|---|---|---|\n"
        + rows(model)
    )


def rows(model: type[Entries], but: Collection[str] = (), first: str = "") -> str:
    """The rows of a table of the entries of a model, without the entries in `but`."""
    text = ""
    for name in model.names(None):
        field = model.model_fields[name]
        if (texts := entry_of(name, field)) and name not in but:
            needed = ", needed" if field.is_required() else ""
            text += f"|{first} `{name}`{needed} | {' | '.join(map(cell, texts))} |\n"
    return text


def entry_of(name: str, field: FieldInfo) -> tuple[str, str, str] | None:
    """Unit, accepted values and meaning of an entry. Returns None for an entry that contains
    tables."""
    rule = next((entry for entry in field.metadata if isinstance(entry, Rule)), None)
    if not rule:
        return None
    unit, meaning = (rule.unit, rule.help) if isinstance(rule, Parameter) else ("", rule.meaning)
    return unit, words(rule.accepted), meaning


def kinds(word: str, table: Mapping[str, type], common: type[Entries]) -> str:
    """A table of the entries that each shape of a body or kind of an obstacle has in addition to
    the common entries."""
    text = f"\n| {word}, entry | unit | accepted | meaning |\n|---|---|---|---|\n"
    for name, model in table.items():
        dimensions = ", ".join(dimension.name for dimension in model.dimensions)
        text += f"| **`{name}`** | | {dimensions} | {cell(first_line(model))} |\n"
        text += rows(model, common.model_fields)
    return text


def results() -> str:
    """Tables of the files, columns and numbers of a run."""
    text = ""
    for file, tables in FILES.items():
        rows = {row.name: row for table in tables for row in table}
        alone, numbered = (
            {row.name for table in tables for row in table if getattr(row, kind)}
            for kind in ("whole", "part")
        )
        text += f"\n## `{file}`\n| name | unit | meaning |\n|---|---|---|\n"
        for name, row in rows.items():
            titles = [f"`{name}`"] * (name in alone) + [f"`{name}_1` …"] * (name in numbered)
            needs = f" ({NEEDS[row.needs]})" if row.needs else ""
            text += f"| {' '.join(titles)} | {row.unit} | {cell(row.meaning)}{needs} |\n"
    return text


def warnings() -> str:
    """A table of the warnings and notes of output/warnings.py and output/estimate.py by name, with fact and
    advice."""
    rows: dict[str, list[tuple[str, str]]] = {}
    for call in ast.walk(ast.parse((PACKAGE / "output/warnings.py").read_text("utf-8"))):
        if isinstance(call, ast.Call) and getattr(call.func, "id", "") in KINDS:
            sentence = _literal(call.args[0])
            rows.setdefault(sentence.partition(":")[0], []).append(
                (call.func.id, sentence.partition(": ")[2])
            )
    table = ""
    for name, messages in sorted(rows.items()):
        if messages[0][1]:
            parts = [split(words) for _, words in messages]
            kind = " / ".join(dict.fromkeys(KINDS[key] for key, _ in messages))
            facts, advice = (
                " / ".join(dict.fromkeys(part[k] for part in parts if part[k])) for k in (0, 1)
            )
            advice = advice or ADVICE.get(name, "")
            table += f"| {name} | {kind} | {cell(facts)} | {cell(advice)} |\n"
    return "| name | kind | what it says | what to do |\n|---|---|---|---|\n" + table + OF_ESTIMATES


def split(words: str) -> tuple[str, str]:
    """The fact and the advice of a sentence. The advice follows a colon or a full stop."""
    parts = re.split(
        rf"(?:: |\. (?=[A-Z]))(?=(?:… )?(?:{VERBS})\b)",
        words,
        flags=re.IGNORECASE,
    )
    return (": ".join(parts[:-1]), parts[-1]) if len(parts) > 1 else (words, "")


def _literal(expression: ast.expr) -> str:
    """The text of a string expression: alternatives joined by "or", and ellipses for other values."""
    match expression:
        case ast.Constant(value=value):
            return str(value)
        case ast.FormattedValue(value=value):
            return _literal(value)
        case ast.IfExp(body=body, orelse=other):
            return f"{_literal(body)} or {_literal(other)}"
        case ast.Call(func=ast.Attribute(attr="finer"), args=[sizes, *_]):
            return _literal(sizes)
        case ast.JoinedStr(values=parts):
            text = "".join(map(_literal, parts))
            return (
                re.sub(r"(…\s*)+", "… ", text)
                .replace("… )", "…)")
                .replace("… :", "…:")
                .replace("… ,", "…,")
                .replace("… .", "….")
                .strip()
            )
        case _:
            return "…"


def equations(prefix: str = "") -> str:
    """A table of the equations of the paper: for each its lines in the paper's scripts, in kernels
    and in the program's scripts, and what the first say of it."""
    homes = {
        "paper": [*(ROOT / "edp").glob("*.edp"), *(ROOT / "edp/paper").glob("*.idp")],
        "kernels": (ROOT / "edp/kernels").glob("*.[ch]pp"),
        "program": (ROOT / "edp/program").rglob("*.idp"),
    }
    text = (
        "| equation | the paper's scripts | kernels | the program's scripts | what stands there |\n"
    )
    text += "|---|---|---|---|---|\n"
    places = {home: marked(sorted(paths)) for home, paths in homes.items()}
    for equation in range(1, 16):
        cells = []
        for home in homes:
            links = [
                f"[{path.relative_to(ROOT / 'edp').as_posix().removeprefix('program/')}:{number}]"
                f"({prefix}{path.relative_to(ROOT)}#L{number})"
                for path, number, _ in places[home].get(equation, [])
            ]
            cells.append(", ".join(links) or "—")
        words = dict.fromkeys(words for _, _, words in places["paper"].get(equation, []) if words)
        text += f"| ({equation}) | {' | '.join(cells)} | {cell('; '.join(words))} |\n"
    return text


def marked(paths: list[Path]) -> dict[int, list[tuple[Path, int, str]]]:
    """The lines of code, by equation, whose comment begins with the number of an equation: file,
    line and the rest of the comment."""
    lines: dict[int, list[tuple[Path, int, str]]] = {}
    for path in paths:
        for number, line in enumerate(path.read_text().splitlines(), 1):
            match = EQUATION.search(line)
            if match and line[: match.start()].strip():
                for equation in re.findall(r"\d+", match[1]):
                    words = line[match.end() :].strip()
                    lines.setdefault(int(equation), []).append((path, number, words))
    return lines


def exit_codes() -> str:
    """A table of the exit codes, their meanings and the Python exceptions."""
    kinds = [
        kind
        for _, kind in inspect.getmembers(failure, inspect.isclass)
        if issubclass(kind, failure.Failure)
    ]
    rows = [
        (kind.code, f"`{kind.__name__}`", first_line(kind))
        for kind in kinds
        if kind is not failure.Failure
    ]
    rows += [
        (0, "", "Finished."),
        (1, f"`{failure.Failure.__name__}`", "A failure of another kind."),
        (130, "`KeyboardInterrupt`", "Interrupted by Ctrl-C."),
        (143, "", "Ended by a signal: 128 and the signal's number, 15 of SIGTERM."),
    ]
    text = "| exit code | exception | meaning |\n|---:|---|---|\n"
    return text + "".join(
        f"| {code} | {name} | {cell(words)} |\n" for code, name, words in sorted(rows)
    )


def commands() -> str:
    """Tables of all commands with their arguments and options, as --help lists them."""
    text = ""
    for name, parser in parsers():
        heading = f"ffimpact {name}".strip()
        text += f"\n## `{heading}`\n\n{sentences(parser.description)}\n"
        rows = [
            action
            for action in parser._actions
            if not isinstance(action, argparse._HelpAction | argparse._SubParsersAction)
        ]
        if rows:
            text += "\n| argument | meaning |\n|---|---|\n"
            text += "".join(
                f"| {spelled(action)} | {cell(plain(parser, action))} |\n" for action in rows
            )
    return text


def parsers() -> Iterator[tuple[str, argparse.ArgumentParser]]:
    """The name and the parser of the program and of every command, with its help as description."""
    whole = command_line._parser()
    yield "", whole
    listed = next(
        action for action in whole._actions if isinstance(action, argparse._SubParsersAction)
    )
    helps = {action.dest: action.help for action in listed._choices_actions}
    for name, parser in listed.choices.items():
        if name in command_line.OWN_MAIN:
            parser = caught(command_line.OWN_MAIN[name])
        parser.description = parser.description or helps[name]
        yield name, parser


def caught(module: str) -> argparse.ArgumentParser:
    """The parser that the main() of a module builds."""
    captured, print_help = [], argparse.ArgumentParser.print_help
    argparse.ArgumentParser.print_help = lambda self, file=None: captured.append(self)
    try:
        with contextlib.suppress(SystemExit), contextlib.redirect_stdout(io.StringIO()):
            importlib.import_module(module).main(["--help"])
    finally:
        argparse.ArgumentParser.print_help = print_help
    return captured[0]


def sentences(description: str) -> str:
    """A description as text. A block of indented lines is an example."""
    text = []
    for block in re.split(r"\n\s*\n", description.strip("\n")):
        if all(line.startswith("    ") for line in block.splitlines()):
            text.append(f"```toml\n{inspect.cleandoc(chr(10) + block)}\n```")
        else:
            words = " ".join(block.split())
            text.append(words[:1].upper() + words[1:] + "." * (words[-1:] not in ".:"))
    return "\n\n".join(text)


def spelled(action: argparse.Action) -> str:
    """The syntax of an argument."""
    value = (
        action.metavar
        if isinstance(action.metavar, str)
        else "|".join(action.choices)
        if action.choices
        else action.dest.upper()
    )
    if action.nargs in ("+", "*"):
        value += " …"
    if not action.option_strings:
        return f"`{cell(value)}`"
    return f"`{', '.join(action.option_strings)}{'' if action.nargs == 0 else f' {cell(value)}'}`"


def plain(parser: argparse.ArgumentParser, action: argparse.Action) -> str:
    """The help text of an argument with its default."""
    return " ".join(parser._get_formatter()._expand_help(action).split()) if action.help else ""


# ---- the Python interface


def exports() -> dict[str, list[str]]:
    """The names that the package exports, by page."""
    names = {
        "functions": [],
        "results": [],
        "scenes": [],
        "materials": [],
        "bodies": [],
        "obstacles": [],
        "exceptions": [],
    }
    for name in ffimpact.__all__:
        item = getattr(ffimpact, name)
        if not inspect.isclass(item):
            names["functions"].append(name)
        elif issubclass(item, Exception):
            names["exceptions"].append(name)
        elif issubclass(item, Entries):
            kind = next((part for part, base in BASES.items() if issubclass(item, base)), "scenes")
            names[kind].append(name)
        else:
            names["results"].append(name)
    for part, base in BASES.items():
        names[part].sort(key=lambda name: (getattr(ffimpact, name) is not base, name))
    return names


BASES = {"materials": materials.Material, "bodies": bodies.Body, "obstacles": obstacles.Obstacle}
MORE = {
    "results": ("plot.Plots", "output.states.Fields", "output.states.State")
}  # classes of results that are not exported
# The documented members; "" means all members.
SHOWN_OF = {
    "Scene": "set, save, load",
    "Plan": "",
    "Result": "",
    "Study": "",
    "plot.Plots": "",
    "output.states.Fields": "",
    "output.states.State": "",
}


def interface(part: str) -> str:
    """A part of the Python interface: a table of its names, and every name with its signature."""
    names = [*exports()[part], *MORE.get(part, ())]
    text = (
        "```{eval-rst}\n.. autosummary::\n   :nosignatures:\n\n"
        + "".join(f"   ffimpact.{name}\n" for name in names)
        + "```\n"
    )
    for name in names:
        kind = (
            "function" if part == "functions" else "exception" if part == "exceptions" else "class"
        )
        members = (
            f"   :members:{' ' * bool(SHOWN_OF[name])}{SHOWN_OF[name]}\n"
            if name in SHOWN_OF
            else ""
        )
        text += f"\n## {name.rpartition('.')[2]}\n```{{eval-rst}}\n"
        text += f".. auto{kind}:: ffimpact.{name}\n{members}```\n"
    return text


def run_times() -> str:
    """A table of the processor seconds of the programs for each case and error, from the
    measurement."""
    table = pd.read_csv(ROOT / "docs/measurements/bench-levels.csv")
    programs = list(table.program.unique())
    text = f"| case, error | {' | '.join(programs)} |\n|---|{'---:|' * len(programs)}\n"
    for (case, level), rows in table.groupby(["case", "level %"], sort=False):
        times = {row.program: f"{row.march:.2f} / {row.process:.2f}" for row in rows.itertuples()}
        text += f"| {case}, {level:g} % | {' | '.join(times.get(program, '—') for program in programs)} |\n"
    return text


def cell(text: str) -> str:
    return text.replace("|", r"\|")


def words(accepted: str) -> str:
    """The accepted values with spaces around the separators, so that a line can break there."""
    return re.sub(r"(?<=\S)\|(?=\S)", " | ", accepted)


# The functions that generate each part, for a page in a folder.
PARTS: dict[str, Callable[[Path], str]] = {
    "parameters": lambda _: entries(),
    "columns": lambda _: results(),
    "warnings": lambda _: warnings(),
    "exit codes": lambda _: exit_codes(),
    "commands": lambda _: commands(),
    "run times": lambda _: run_times(),
    "equations": lambda folder: equations(
        os.path.relpath(ROOT, folder) + "/" if folder != ROOT else ""
    ),
    **{f"interface: {part}": lambda _, part=part: interface(part) for part in exports()},
}


if __name__ == "__main__":
    sys.exit(command_line.start(main))
