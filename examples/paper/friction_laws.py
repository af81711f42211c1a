"""Figure 3 of the paper: the friction laws (11)-(13), as the paper's script edp/friction-laws.edp
tabulates them.
"""

import argparse
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.axes import Axes

from ffimpact.__main__ import start
from ffimpact.failure import Failure, Unreadable
from ffimpact.freefem import freefem
from ffimpact.input import parameters
from ffimpact.output.folder import result_folder
from ffimpact.places import RESULTS, shown
from ffimpact.report.figures import (
    BELOW,
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    legend,
    save,
    styled,
)

# The values of section 3.1 and figure 3 of the paper.
VALUES = {"friction_static": 0.7, "friction_dynamic": 0.5, "slip_velocity": 0.1}
LABELS = {
    "linear": (r"linear, $\phi^3$ with $v_T/\varepsilon$", BLUE, "-"),
    "sqrt": (r"sqrt, $\phi^1$", GREEN, "-"),
    "tanh": (r"tanh, $\phi^2$", ORANGE, "-"),
    "linear-printed": (r"linear-printed: $v_T/2\varepsilon$" "\nas printed in (13)", PURPLE, "--"),
}


def main(argv: list[str]) -> int:
    """Tabulates the laws into DIR/laws.csv and draws DIR/friction-laws.png."""
    parser = argparse.ArgumentParser(prog="python -m examples.paper.friction_laws", description=__doc__)
    parser.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        default=RESULTS / "friction-laws",
        help="the result folder",
    )
    for name, value in VALUES.items():
        parser.add_argument(
            f"--{name}",
            metavar="VALUE",
            default=value,
            help=f"{parameters.PARAMETERS[name].help} (default: {value:g})",
        )
    options = parser.parse_args(argv)
    checked = parameters.check({name: getattr(options, name) for name in VALUES})
    values = {name: float(value) for name, value in checked.items()}
    folder = result_folder(options.out)
    draw(tabulate(folder, values), values, folder / "friction-laws.png")
    print(f"{shown(folder)}/friction-laws.png")
    return 0


def tabulate(folder: Path, values: dict[str, float]) -> pd.DataFrame:
    """Returns the table that edp/friction-laws.edp writes: panel, law, side, v [m/s], ratio [-],
    slope [s/m]. The script describes the columns. Raises Unreadable if the folder cannot
    be written, else Failure.
    """
    program = freefem.find()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with open(folder / "log.txt", "w"):
            pass
    except OSError as error:
        raise Unreadable(
            f"{folder} cannot be written: {error.strerror}; choose another --out"
        ) from None
    code, message = freefem.run(
        program, "edp/friction-laws.edp", values | {"out": folder}, folder / "log.txt"
    )
    if code != 0:
        raise Failure(
            message or f"FreeFem++ stopped with exit code {code}; see {folder / 'log.txt'}",
            code=code if message else 1,
        )
    return pd.read_csv(folder / "laws.csv")


def draw(laws: pd.DataFrame, values: dict[str, float], path: Path) -> None:
    """Draws the three panels of figure 3 with the velocity in units of `slip_velocity`. At a jump
    of a law both sides are separate.
    """
    laws = laws.assign(size_=laws.v / values["slip_velocity"])
    with styled():
        figure, (a, b, c) = plt.subplots(1, 3, figsize=(10.2, 3.9))
        for axes in (a, b, c):
            axes.axhline(0, color=GREY, linewidth=0.6)
            axes.axvline(0, color=GREY, linewidth=0.6)
            axes.set_xlabel(rf"$v_T/\varepsilon$,  $\varepsilon = {values['slip_velocity']:g}$ m/s")
        a.plot("size_", "ratio", data=laws[laws.panel == "a"], color=BLACK)
        a.set(
            title="a) Coulomb's law (11): the limit $\\varepsilon \\to 0$",
            ylabel=r"$-t_T/(\mu\,t_N)$",
            xlabel="$v_T$",
            xlim=(-3, 3),
            xticks=[0],
            ylim=(-1.2, 1.2),
            yticks=[-1, 0, 1],
        )
        for law, (label, colour, line) in LABELS.items():
            _curve(b, laws[(laws.panel == "b") & (laws.law == law)], colour, line, label, 1.2)
        b.set(
            title="b) regularised (13), $\\mu_e = \\mu_d$",
            ylabel=r"$\phi_\varepsilon(v_T)$",
            xlim=(-4, 4),
            ylim=(-1.2, 1.2),
            yticks=[-1, -0.5, 0, 0.5, 1],
        )
        legend(b, **BELOW, handlelength=1.6, ncols=2)
        both = laws[laws.panel == "c"]
        _curve(c, both, BLUE, "-", "jump at $|v_T| = \\varepsilon$", 1.6)
        ticks = {
            f"{sign}\\mu_{kind}": float(sign + "1") * values[f"friction_{name}"]
            for sign in ("-", "+")
            for kind, name in (("e", "static"), ("d", "dynamic"))
        }
        c.set(
            title="c) static and dynamic coefficient, linear",
            ylabel=r"$-t_T/t_N = \mu_f\,\phi_\varepsilon$",
            xlim=(-4, 4),
            ylim=(-1.2 * values["friction_static"], 1.2 * values["friction_static"]),
        )
        c.set_yticks(
            [0, *ticks.values()],
            ["0", *(f"${name} = {value:+g}$".replace("+", "") for name, value in ticks.items())],
        )
        legend(c, **BELOW, handlelength=1.6, ncols=1)
        save(figure, path)


def _curve(
    axes: Axes, points: pd.DataFrame, colour: str, line: str, label: str, width: float
) -> None:
    """Draws one law. The sticking and the sliding sides are separate lines; a dotted line marks a
    jump between them.
    """
    stick = points[points.side == "stick"]
    negative, positive = (
        points[points.size_ < stick.size_.min()],
        points[points.size_ > stick.size_.max()],
    )
    for part in (negative, stick, positive):
        axes.plot(
            part.size_,
            part.ratio,
            color=colour,
            linestyle=line,
            linewidth=width,
            label=label if part is stick else None,
        )
    for inner, outer in ((stick.iloc[0], negative.iloc[-1]), (stick.iloc[-1], positive.iloc[0])):
        if abs(inner.ratio - outer.ratio) > 0.05:
            axes.plot(
                [outer.size_] * 2,
                [inner.ratio, outer.ratio],
                color=colour,
                linestyle=":",
                linewidth=0.8,
            )


if __name__ == "__main__":
    sys.exit(start(main))
