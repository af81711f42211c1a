"""The figures of the pages in docs/measurements/, each drawn from the CSV files beside its page."""

from collections.abc import Callable, Mapping
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axis import Axis
from matplotlib.ticker import LogLocator, NullFormatter, NullLocator

from ffimpact.report.figures import (
    BLACK,
    BLUE,
    DASHED,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    STYLE,
    save,
)

# The tables of a page by the suffix of their file names; "" is the main table.
Tables = Mapping[str, pd.DataFrame]
# These settings make the SVG file depend on the numbers only, and store letters as text.
FIXED = {"svg.hashsalt": "ffimpact", "svg.fonttype": "none"}
COLOURS = (BLUE, ORANGE, GREEN, PURPLE, BLACK, GREY)
# Smaller errors are drawn at this value, over the requested accuracy or in %.
SMALLEST = 5e-3


def promise(tables: Tables, path: Path) -> None:
    """Draws errors over their estimates, a dot for each scene, and the coverage of the estimates by
    result."""
    rows, stated = tables[""], tables["stated"]
    figure, (errors, shares) = plt.subplots(1, 2, figsize=(9, 3.8), width_ratios=(1.2, 1))
    kinds = rows["family"] if "family" in rows else rows.scene.str.partition(":")[0]
    ends = np.array([SMALLEST / 2, 2 * np.nanmax([rows.error.max(), rows.estimated.max()])])
    for kind, colour in zip(kinds.unique(), [*COLOURS, *COLOURS]):
        group = rows[kinds == kind]
        errors.plot(
            group.estimated.clip(SMALLEST),
            group.error.clip(SMALLEST),
            "o",
            color=colour,
            markersize=3,
            alpha=0.7,
            label=kind,
        )
    errors.plot(ends, ends, color=BLACK, linewidth=0.8)
    errors.axhline(1, color=BLACK, linewidth=0.8, linestyle=DASHED)
    errors.text(ends[0], 1, " requested accuracy", va="bottom", fontsize=7)
    errors.set(
        xscale="log",
        yscale="log",
        xlabel="error estimate / requested accuracy",
        ylabel="error / requested accuracy",
        xlim=ends,
    )
    if kinds.nunique() > 1:
        errors.legend(loc="lower right")
    shown = stated[stated.cases > 0].iloc[::-1]
    shares.barh(shown.answer, 100 * shown.within, color=BLUE, height=0.6)
    shares.axvline(95, color=BLACK, linewidth=0.8, linestyle=DASHED)
    for place, row in enumerate(shown.itertuples()):
        shares.text(51, place, f"{row.cases} cases", va="center", color="white", fontsize=7)
    shares.set(xlim=(50, 100), xlabel="error within the estimate [% of the cases]")
    save(figure, path)


def scaling(tables: Tables, path: Path) -> None:
    """Draws the time of a step and the memory over the number of unknowns, with both exponents."""
    figure, panels = plt.subplots(1, 2, figsize=(9, 3.6))
    exponents = tables["exponents"].set_index("case")
    for (case, rows), colour in zip(tables[""].groupby("case", sort=False), COLOURS):
        for panel, name in zip(panels, ("step", "memory")):
            panel.loglog(
                rows.unknowns,
                rows[name],
                "o-",
                color=colour,
                markersize=4,
                label=f"{case}: exponent {exponents[name][case]:.2g}",
            )
    for panel, name in zip(panels, ("processor time of a step [s]", "memory [MB]")):
        panel.set(xlabel="unknowns", ylabel=name)
        panel.legend()
        panel.grid(alpha=0.3)
    save(figure, path)


def bench(tables: Tables, path: Path) -> None:
    """Draws processor time over error: of the time integration (upper row) and of the whole
    process.

    A column is a case. The error is the largest error of a setting and of all finer ones of its
    program.
    """
    rows = tables[""]
    cases = list(rows.case.unique())
    figure, grid = plt.subplots(
        2, len(cases), figsize=(9.5, 5.2), sharex="col", sharey="row", squeeze=False
    )
    colours = dict(zip(rows.program.unique(), COLOURS))
    for column, case in zip(grid.T, cases):
        for panel, name in zip(column, ("march", "process")):
            for program, group in rows[(rows.case == case) & rows.error.notna()].groupby(
                "program", sort=False
            ):
                # Settings go from coarse to fine.
                kept = np.maximum.accumulate(group.error.to_numpy()[::-1])[::-1]
                panel.loglog(
                    kept.clip(SMALLEST),
                    group[name],
                    "o-",
                    color=colours[program],
                    markersize=3,
                    linewidth=1,
                    label=program,
                )
            plain(panel.yaxis)
            plain(panel.xaxis, (1,))
            panel.grid(alpha=0.3)
        column[0].set_title(case)
        column[1].set_xlabel("error [%]")
    for panel, words in zip(grid[:, 0], ("time integration [s]", "whole process [s]")):
        panel.set_ylabel(words)
    shown = {
        label: line
        for panel in grid.flat
        for line, label in zip(*panel.get_legend_handles_labels())
    }
    figure.legend(shown.values(), shown, loc="outside lower center", ncols=3)
    save(figure, path)


def disc_block(tables: Tables, path: Path) -> None:
    """Draws velocities, vibration energy and contact time with error bars, ours and those of
    NGSolve."""
    rows, other = tables[""], tables["ngsolve"]
    cases = rows[["law", "nu"]].drop_duplicates().reset_index(drop=True)
    places = {(row.law, row.nu): k for k, row in cases.iterrows()}
    figure, grid = plt.subplots(2, 2, figsize=(8, 5.4))
    panels = grid.ravel()
    answers = {
        "v disc m/s": "velocity of the disc [m/s]",
        "v block m/s": "velocity of the block [m/s]",
        "block vibrates %": "vibration of the block [% of energy]",
        "contact >1% ms": "contact above 1 % of the peak [ms]",
    }
    sets = [
        (f"k = {penalty:.0e} Pa/m", group, shift, colour, "o")
        for (penalty, group), shift, colour in zip(
            rows.groupby("penalty"), (-0.12, 0.12), (BLUE, ORANGE)
        )
    ]
    for panel, (name, words) in zip(panels, answers.items()):
        for label, table, shift, colour, mark in [
            *sets,
            ("NGSolve, k = 1e+09 Pa/m", other, 0, GREEN, "D"),
        ]:
            x = [places[law, nu] + shift for law, nu in zip(table.law, table.nu)]
            panel.errorbar(
                x,
                table[name],
                table[f"{name} bar"],
                fmt=mark,
                color=colour,
                markersize=3.5,
                capsize=2,
                linewidth=1,
                label=label,
            )
        panel.set_xticks(
            range(len(cases)),
            [f"{'SVK' if row.law == 'svk' else 'nH'}\n{row.nu:g}" for row in cases.itertuples()],
        )
        panel.set(title=words, xlim=(-0.5, len(cases) - 0.5))
        panel.grid(axis="y", alpha=0.3)
    for panel in panels[-2:]:
        panel.set_xlabel("law, ν")
    shown = panels[0].get_legend_handles_labels()
    figure.legend(*shown, loc="outside lower center", ncols=3)
    save(figure, path)


def plain(axis: Axis, marks: tuple[int, ...] = (1, 2, 5)) -> None:
    """Labels a logarithmic axis without powers, at the multiples `marks` of powers of ten."""
    axis.set_major_locator(LogLocator(subs=marks))
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter(NullFormatter())
    axis.set_minor_locator(NullLocator())


def rubber(tables: Tables, path: Path) -> None:
    """Draws contact time, impulse, rebound and processor time over 0.5 - nu."""
    from . import rubber as study

    study.draw(tables[""], path)


def oblique_angles(tables: Tables, path: Path) -> None:
    """Draws psi_2 over psi_1 and both restitutions over the angle, beside rigid and elastic theory."""
    from . import oblique_angles as study

    study.draw(tables[""], path)


def layers(tables: Tables, path: Path) -> None:
    """Draws the force over time of a layered ball, of both programs and without its core."""
    from . import layers as study

    study.draw(tables["forces"], path)


def viscoelastic(tables: Tables, path: Path) -> None:
    """Draws 1 - e of the ball over speed, and the restitution of the disc over loss and relaxation
    time."""
    from . import viscoelastic as study

    study.draw(tables[""], tables["disc"], path)


def users(tables: Tables, path: Path) -> None:
    """Draws the processor time of the users' scenes, and steps, time and error of a soft disc over
    the stiffness of the block that it falls on. A dashed line is the disc on a rigid plane.
    """
    rows, ratios = tables.get("", pd.DataFrame()), tables.get("ratio", pd.DataFrame())
    figure, panels = plt.subplot_mosaic(
        [["scenes", "steps"], ["scenes", "seconds"], ["scenes", "error %"]],
        figsize=(9, 5.6),
        width_ratios=(1.1, 1),
    )
    scenes = panels.pop("scenes")
    for setting, colour, mark in (("automatic", BLUE, "o"), ("by hand", ORANGE, "D")):
        if len(rows):
            own = rows[rows.setting == setting].set_index("scene").reindex(rows.scene.unique()[::-1])
            scenes.semilogx(own.seconds, own.index, mark, color=colour, markersize=5, label=setting)
        if len(ratios):
            own = ratios[ratios.setting == setting]
            block, rigid = own[np.isfinite(own.ratio)], own[np.isinf(own.ratio)]
            for name, panel in panels.items():
                panel.loglog(
                    block.ratio,
                    block[name].clip(SMALLEST),
                    f"{mark}-",
                    color=colour,
                    markersize=3.5,
                    label=setting,
                )
                for value in rigid[name].dropna():
                    panel.axhline(
                        max(value, SMALLEST), color=colour, linewidth=0.9, linestyle=DASHED
                    )
    scenes.set(xlabel="processor time of the run [s]")
    scenes.grid(alpha=0.3)
    if len(rows):
        plain(scenes.xaxis, (1,))
    else:
        scenes.set_axis_off()
    names = {"steps": "steps", "seconds": "time [s]", "error %": "error of the impulse [%]"}
    for name, panel in panels.items():
        panel.set(ylabel=names[name])
        panel.grid(alpha=0.3)
    for name in ("steps", "seconds") if len(ratios) else ():
        plain(panels[name].yaxis, (1, 2, 5))
    panels["error %"].set_xlabel("Young's modulus of the block / of the disc")
    marks, labels = (scenes if len(rows) else panels["steps"]).get_legend_handles_labels()
    if len(ratios):
        marks.append(plt.Line2D([], [], color=BLACK, linewidth=0.9, linestyle=DASHED))
        labels.append("on a rigid plane")
    figure.legend(marks, labels, loc="outside lower center", ncols=3)
    save(figure, path)


# The drawing function by the name of the measurement.
DRAWN: dict[str, Callable[[Tables, Path], None]] = {
    "promise": promise,
    "scaling": scaling,
    "equal-errors": bench,
    "disc-block-errors": disc_block,
    "rubber": rubber,
    "oblique-angles": oblique_angles,
    "viscoelastic": viscoelastic,
    "layers": layers,
    "users": users,
}


def draw(measurement: str, tables: Tables, path: Path) -> None:
    """Draws the figure of a page as an SVG file without a date."""
    with plt.rc_context(STYLE | FIXED):
        DRAWN[measurement](tables, path)
    lines = path.read_text().splitlines()
    path.write_text("".join(f"{line.rstrip()}\n" for line in lines if "<dc:date>" not in line))
