"""Command line of the program: `ffimpact COMMAND` or `python -m ffimpact COMMAND`. The option
--help lists the commands.
"""

import argparse
import contextlib
import errno
import gc
import importlib
import io
import locale
import logging
import os
import re
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Never

from . import __version__
from .failure import BadInput, Failure, Unreadable, brief, signals, unknown
from .places import shown

__all__ = ["execute", "guarded", "leave", "main", "start"]

Command = Callable[[list[str]], int | None]
# Each of these commands has a module of its own with a function main(argv).
OWN_MAIN = {
    "sweep": "ffimpact.sweeps.sweep",
    "compare": "ffimpact.report.compare",
    "movie": "ffimpact.report.movie",
    "dma": "ffimpact.spectrum",
    "bounces": "ffimpact.recording",
    "fit": "ffimpact.fitting.command",
}
HELP = {
    "sweep": "run a scene for every combination of some entries: a table and a figure",
    "compare": "several runs in one figure, with a table",
    "movie": "a film of a scene",
    "dma": "Maxwell branches from a measured spectrum: the entries of a material",
    "bounces": "restitution from the sound of a bouncing ball",
    "fit": "a material from measured bounces, forces and tracks, with intervals",
}
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
# Matches each accepted value that argparse lists in its message.
CHOICES = re.compile(r"[^', ]+")


def main(argv: list[str]) -> int:
    """Runs a command and returns its exit code. The run contract has a table of the exit codes."""
    return guarded(execute, argv)


def guarded(run: Command, argv: list[str]) -> int:
    """Calls `run` and returns its exit code. Each failure is reported on stderr, one line a
    message.
    """
    _log_to_stderr()
    # A wrong command line is reported like any bad input: one line and exit code 10.
    argparse.ArgumentParser.error = _bad_usage  # type: ignore[method-assign, assignment]
    try:
        return run(argv) or 0
    except Failure as failure:
        for message in failure.messages:
            print(f"ffimpact: {message}", file=sys.stderr)
        if failure.folder:
            print(f"files of the failed run: {shown(failure.folder)}")
        return failure.code
    except BrokenPipeError:  # the program that reads our output has ended
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as error:  # for example a full disk or a deleted folder
        advice = (
            "make room, or choose another --out" if error.errno in FULL else "choose another --out"
        )
        where = error.filename or "the result folder"
        print(f"ffimpact: {where}: {error.strerror or error}; {advice}", file=sys.stderr)
        return Unreadable.code
    except KeyboardInterrupt:
        print("ffimpact: interrupted", file=sys.stderr)
        return 130


class _Lines(logging.Handler):
    """Prints what the package logs on stderr, a line each."""

    def emit(self, record: logging.LogRecord) -> None:
        print(f"ffimpact: {record.getMessage()}", file=sys.stderr)


def _log_to_stderr() -> None:
    log = logging.getLogger("ffimpact")
    log.setLevel(logging.INFO)
    if not log.handlers:
        log.addHandler(_Lines())


def execute(argv: list[str]) -> int | None:
    """Executes the words of a command line. Raises Failure."""
    if argv[:1] and argv[0] in OWN_MAIN:
        command: Command = importlib.import_module(OWN_MAIN[argv[0]]).main
        return command(argv[1:])
    options = _parser().parse_args(argv)
    options.command(options)
    return 0


def _bad_usage(parser: argparse.ArgumentParser, message: str) -> Never:
    if choice := re.fullmatch(
        r"argument (\S+): invalid choice: (['\"])(.*)\2 \(choose from (.*)\)", message
    ):
        message = f"{choice[1]}: {unknown(choice[3], CHOICES.findall(choice[4]), ', ')}"
        raise BadInput(f"{message} (see {parser.prog} --help)")
    if message.startswith("unrecognized arguments: --mesh"):
        raise BadInput(
            "--mesh: is no option any more (accepted: in a table [[body]], shape = 'mesh' with file)"
        )
    raise BadInput(f"{brief(message)} (see {parser.prog} --help)")


def _parser() -> argparse.ArgumentParser:
    from .input.parameters import add_set

    parser = argparse.ArgumentParser(
        prog="ffimpact",
        description="Impact of nonlinear deformable bodies.",
        epilog="Each command has its own --help.",
    )
    parser.add_argument("--version", action="version", version=f"ffimpact {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    command = commands.add_parser("run", help="run a scene, or reuse its finished result")
    command.add_argument(
        "scene", metavar="SCENE", help="a built-in scene (see list) or the path of a TOML file"
    )
    add_set(
        command,
        "set an entry: accuracy=0.01, body.2.young=1e6; an entry of the only body or of [contact] "
        "needs no table: speed=4, penalty=1e9",
    )
    command.add_argument(
        "--out", metavar="DIR", type=Path, help="the result folder (default: results/SCENE)"
    )
    command.add_argument(
        "--checkpoint-every",
        metavar="STEPS",
        help="make a checkpoint every so many steps; a run that is killed goes on from the last when called again",
    )
    command.add_argument(
        "--force",
        action="store_true",
        help="run again, from the start, even if the result is there",
    )
    command.add_argument(
        "--no-estimate",
        action="store_true",
        help="make no coarser runs, which estimate the errors",
    )
    command.add_argument("--no-figures", action="store_true", help="draw no figures")
    command.add_argument(
        "--plan",
        action="store_true",
        help="make no run, but foretell its mesh, steps, processor time and memory",
    )
    command.add_argument(
        "--quiet", action="store_true", help="print warnings and errors only, on stderr"
    )
    command.add_argument(
        "--verbose", action="store_true", help="print all numbers, and warnings in full"
    )
    command.set_defaults(command=_run)

    command = commands.add_parser("view", help="an animation of a finished run as an HTML page")
    command.add_argument("folder", metavar="DIR", type=Path, help="the result folder")
    command.add_argument(
        "--html", metavar="FILE", type=Path, help="the page to write (default: DIR/view.html)"
    )
    command.add_argument(
        "--field",
        default="von_mises",
        help="shown at first: von_mises (default), pressure, speed, energy_density, plastic_strain",
    )
    command.add_argument(
        "--section", action="store_true", help="show a body of revolution as its section"
    )
    command.set_defaults(command=_view)

    command = commands.add_parser(
        "evaluate", help="evaluate the record of a run of an .edp script: summary, contacts, fields"
    )
    command.add_argument("folder", metavar="DIR", type=Path, help="the folder of the run")
    command.set_defaults(command=_evaluate)

    command = commands.add_parser("list", help="list the built-in scenes, with their scripts")
    command.set_defaults(command=_list)
    command = commands.add_parser(
        "parameters", help="list the parameters: default, unit, what is accepted"
    )
    command.set_defaults(command=_parameters)
    command = commands.add_parser(
        "schema",
        help="print the JSON schema of scene files, with which editors complete and check them",
    )
    command.set_defaults(command=_schema)
    command = commands.add_parser("figures", help="draw the figures of a result folder again")
    command.add_argument("folder", metavar="DIR", type=Path, help="the result folder")
    command.set_defaults(command=_figures)
    for name in OWN_MAIN:  # only for --help and messages: execute() calls these
        commands.add_parser(name, help=HELP[name])
    return parser


def _plan(options: argparse.Namespace) -> None:
    from . import scene
    from .input import parameters
    from .running import run

    for name in ("out", "checkpoint_every", "force", "no_figures", "quiet", "verbose"):
        if getattr(options, name):
            raise BadInput(
                f"--plan: makes no run, so --{name.replace('_', '-')} has no meaning "
                "(accepted: --set, --no-estimate)"
            )
    loaded, overrides = scene.load(options.scene), parameters.overrides(options.set)
    overrides = run.states(loaded) | overrides
    print(run.plan(loaded, overrides, estimate=not options.no_estimate))


def _run(options: argparse.Namespace) -> None:
    if options.plan:
        return _plan(options)
    from . import progress, scene
    from .input import parameters
    from .report import report
    from .running import run

    if options.quiet:
        logging.getLogger("ffimpact").setLevel(logging.WARNING)
    with (
        progress.muted(options.quiet),
        contextlib.redirect_stdout(None if options.quiet else sys.stdout),
    ):
        loaded, overrides = scene.load(options.scene), parameters.overrides(options.set)
        overrides = run.states(loaded) | overrides
        if options.checkpoint_every:
            overrides["checkpoint_every"] = options.checkpoint_every
        result = run.run(
            loaded,
            overrides,
            options.out,
            force=options.force,
            progress=False if options.quiet else None,
            estimate=not options.no_estimate,
        )
        if not options.no_figures:
            report.draw(result)
        print(report.report(result, options.verbose))
    for sentence in result.summary["warnings"] if options.quiet else ():
        print(f"ffimpact: warning: {sentence}", file=sys.stderr)


def _view(options: argparse.Namespace) -> None:
    from .result import load

    path = options.html or options.folder / "view.html"
    print(shown(load(options.folder).view(path, options.field, not options.section)))


def _evaluate(options: argparse.Namespace) -> None:
    from .output import evaluate, paper_script, results

    record = options.folder / evaluate.RECORD
    if not record.exists() and not (options.folder / paper_script.ANSWERS).exists():
        raise Unreadable(
            f"{record} cannot be read: there is no such file (accepted: the folder of a run of an .edp script)"
        )
    evaluate.evaluate(options.folder)
    for sentence in results.read_summary(options.folder)["warnings"]:
        print(f"ffimpact: warning: {sentence}", file=sys.stderr)
    print(shown(options.folder / "summary.json"))


def _list(options: argparse.Namespace) -> None:
    from . import scene

    names = scene.built_in()
    for name in names:
        loaded = scene.load(name)
        print(f"{name:<{2 + max(map(len, names))}}{loaded.kind.script:<19}{loaded.title}")


def _parameters(options: argparse.Namespace) -> None:
    from .input import parameters

    for name, p in parameters.PARAMETERS.items():
        default = p.default if isinstance(p.default, str) else f"{p.default:g}"
        print(f"{name:<21}{default:<17}{p.unit:<9}{p.help}; accepted: {p.accepted}")


def _schema(options: argparse.Namespace) -> None:
    from .schema import text

    print(text(), end="")


def _figures(options: argparse.Namespace) -> None:
    from .output import evaluate, results
    from .report import drawing, solid

    evaluate.evaluate(options.folder)
    results.read_summary(options.folder)  # raises Unreadable without a finished run
    drawn = drawing.draw(options.folder)
    for path in drawn:
        print(path)
    if (
        "z" in results.read_history(options.folder)
        and options.folder / "figures/solid.png" not in drawn
        and (reason := solid.missing())
    ):
        print(f"ffimpact: without figures/solid.png: {reason}", file=sys.stderr)


def leave(number: int, _: object) -> None:
    """Signal handler: ends the program with exit code 128 + `number`. Every `finally` is executed
    as after Ctrl-C: FreeFem++ is ended and unfinished files are removed.
    """
    signals.append(number)
    sys.exit(128 + number)


def start(run: Command | None = None) -> int:
    """Runs a command as the program `ffimpact` or `python -m ffimpact` and returns its exit
    code.
    """
    # All files are UTF-8, whatever the locale is.
    if locale.getencoding().lower() not in ("utf-8", "utf8") and not sys.flags.utf8_mode:
        os.execv(sys.executable, [sys.executable, "-X", "utf8", *sys.orig_argv[1:]])
    # Collecting garbage every few hundred objects takes longer than keeping the garbage.
    gc.set_threshold(100_000)
    os.environ.setdefault("MPLBACKEND", "Agg")  # matplotlib writes figures to files only
    # The limit holds for numpy too: starting its threads takes as long as loading numpy.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) is signal.SIG_DFL:  # ignored under nohup
            signal.signal(number, leave)
    for name in ("stdout", "stderr"):  # the calling process may have closed them
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w"))
    # Paths are bytes, which need not be valid text.
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="surrogateescape")
    code = guarded(run or execute, sys.argv[1:])
    gc.freeze()  # avoids a garbage collection when Python exits
    return code


if __name__ == "__main__":
    sys.exit(start())
