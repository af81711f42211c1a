"""The printed report of a finished run: its key figures beside the published numbers of the same
scene.
"""

import logging
import shlex
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import zip_longest

from ..input import dimension
from ..input.parameters import Table
from ..output import notes
from ..output.errors import errors, zero_by_symmetry
from ..output.materials import layer_lines, material
from ..output.results import Record, body_names, suffixes
from ..places import shown
from . import literature

__all__ = [
    "MAIN_ROWS",
    "Quantity",
    "draw",
    "report",
    "rows",
    "rows_of",
    "stiffness",
    "warning_lines",
]

log = logging.getLogger("ffimpact")

MAIN_ROWS = 12  # largest number of rows of a report that is not verbose
EXACT_ZERO = 1e-9  # largest size of a number that is zero to round-off

# A number of the summary, or several that share a row.
Numbers = float | list[float]
# Whether the report of a run has the row of this key.
Condition = Callable[[Record, str], bool]


def _always(result: Record, key: str) -> bool:
    return True


def _never(result: Record, key: str) -> bool:
    return False


def _nonzero(result: Record, key: str) -> bool:
    return bool(abs(result.summary[key]) >= EXACT_ZERO)


def _moves(result: Record, key: str) -> bool:
    return key not in zero_by_symmetry(result.summary)


def _to_rest(result: Record, key: str) -> bool:
    return result.scene.get("until") == "rest"


def _single(result: Record, key: str) -> bool:
    return not _to_rest(result, key)


@dataclass(frozen=True)
class Quantity:
    """A row of the report: a key of summary.json, its label, the displayed unit, the factor from SI
    units to that unit, and the number format.

    A run that has the number has the row if `when` holds, and the report that is not verbose has it
    if `main` holds, too.
    """

    key: str
    label: str
    unit: str = ""
    factor: float = 1.0
    digits: str = ".4g"
    main: Condition = _never
    when: Condition = _always

    def text(self, value: Numbers, error: Numbers | None = None) -> str:
        """Returns the value, or several values in one row, with error estimates (all in SI units)
        and the unit.
        """
        values = value if isinstance(value, list) else [value]
        errors = error if isinstance(error, list) else [error]
        texts = (
            f"{self.factor * number:{self.digits}}"
            + ("" if bar is None else f" ± {self.factor * bar:.2g}")
            for number, bar in zip_longest(values, errors)
        )
        return f"{', '.join(texts)} {self.unit}".rstrip()

    def beside(self, number: Table) -> str:
        """Returns a published number with its error bar, if it has one, and its source."""
        error = f" ± {self.factor * number['error']:.1g}" if "error" in number else ""
        source = "; ".join(number[key] for key in ("source", "note") if key in number)
        return f"{self.factor * number['value']:{self.digits}}{error} ({source})"


def rows(per: str) -> list[Quantity]:
    """Returns all rows in the order of the report. `per` is the suffix for the units of forces,
    impulses and energies, see dimension.per_metre().
    """
    return [
        Quantity("contact_time", "contact time", "ms", 1e3, main=_single),
        Quantity("thresholded_contact_time", "  above 1 % of the peak", "ms", 1e3),
        Quantity("bounces", "bounces", digits=".0f", main=_to_rest),
        Quantity("first_restitutions", "first restitutions", digits=".3g", main=_to_rest),
        Quantity("rest_time", "at rest from", "s", main=_to_rest),
        Quantity("peak_force", "peak force", f"kN{per}", 1e-3, main=_always),
        Quantity("impulse", "impulse", f"N s{per}", digits=".5g", main=_always),
        Quantity("restitution", "restitution", main=_always),
        Quantity("restitution_tangential", "  tangential"),
        Quantity("impulse_ratio", "  impulse ratio", when=_nonzero),
        Quantity("angle_in", "angle of incidence", "degrees"),
        Quantity("angle_out", "  of reflection", "degrees"),
        *_velocities("rebound", "rebound"),
        *_velocities("final", "final"),
        Quantity("vibration_energy", "left in vibration", f"J{per}", main=_always),
        Quantity("translation_energy", "  in translation", f"J{per}"),
        Quantity("rotation_energy", "  in rotation", f"J{per}", when=_nonzero),
        Quantity("friction_work", "lost to friction", f"J{per}", main=_always, when=_nonzero),
        Quantity("creep_work", "  of it in creep", f"J{per}", when=_nonzero),
        Quantity("viscous_work", "lost to viscosity", f"J{per}"),
        Quantity("plastic_work", "lost to plastic strain", f"J{per}", main=_always, when=_nonzero),
        Quantity("max_plastic_strain", "  largest", main=_always),
        Quantity("penalty_damping_work", "lost to penalty damping", f"J{per}", main=_always),
        Quantity("energy_initial", "energy at the start", f"J{per}"),
        Quantity("external_work", "external work", f"J{per}", when=_nonzero),
        Quantity("contact_intervals", "contact intervals", digits=".0f", main=_single),
        Quantity("sliding_time", "load slides for", "ms", 1e3, when=_nonzero),
        Quantity("sticking_time", "load sticks for", "ms", 1e3, when=_nonzero),
        Quantity(
            "energy_drift",
            "energy drift",
            "of the energy supplied",
            digits=".1e",
            main=_always,
        ),
        Quantity("max_penetration", "largest penetration", "mm", 1e3, ".3g"),
        Quantity("min_jacobian", "smallest det F", digits=".3f"),
        Quantity("min_stretch", "smallest stretch", digits=".3f"),
        Quantity("min_ellipticity", "smallest ellipticity", "mu"),
        Quantity("ellipticity_lost_time", "ellipticity lost from", "ms", 1e3),
        Quantity("ellipticity_lost_x", "  there X =", "mm", 1e3),
        Quantity("ellipticity_lost_y", "  there Y =", "mm", 1e3),
        Quantity("breakdown_time", "det F <= 0 from", "ms", 1e3),
        Quantity("breakdown_x", "  there X =", "mm", 1e3),
        Quantity("breakdown_y", "  there Y =", "mm", 1e3),
        Quantity(
            "unsolved_jumps",
            "unsolved jumps",
            "steps of points in a jump of the friction law",
            digits=".0f",
            when=_nonzero,
        ),
        Quantity("resumed_at", "resumed at", "ms", 1e3),
        Quantity("steps", "steps", digits=".0f"),
        Quantity("dofs", "degrees of freedom", digits=".0f"),
        Quantity("total_seconds", "wall time", "s", digits=".2f"),
        Quantity("wall_seconds", "  of it this run", "s", digits=".2f"),
    ]


def _velocities(kind: str, word: str) -> list[Quantity]:
    """Returns the rows of velocities and spins at the end of contact (`kind` rebound) or of the run
    (final).
    """
    return [
        *(
            Quantity(
                f"{kind}_v{axis}",
                f"{word} velocity, {axis}",
                "m/s",
                main=_single,
                when=_moves,
            )
            for axis in "xyz"
        ),
        *(
            Quantity(f"{kind}_spin_{axis}", f"{word} spin about {axis}", "rad/s", when=_moves)
            for axis in "xy"
        ),
        Quantity(f"{kind}_spin", f"{word} spin", "rad/s", main=_single, when=_moves),
    ]


def draw(result: Record) -> None:
    """Draws the figures of the run into its folder, unless they exist. An error is only printed,
    because a run must not be lost if a figure fails.
    """
    if result.reused and (result.folder / "figures/energies.png").exists():
        return
    try:
        from . import drawing  # loads matplotlib, which is needed only here

        drawing.draw(result.folder)
    except Exception as error:
        why = (
            f"{error.filename or result.folder}: {error.strerror}"
            if isinstance(error, OSError) and error.strerror
            else repr(error)
        )
        log.warning("the figures could not be drawn: %s", why)


def stiffness(contact: Table) -> str:
    """Returns the penalty k of a contact t_N = k p^m (10) with its unit."""
    k, m = contact["penalty"], contact["exponent"]
    return f"{k:.4g} Pa/m^{m:g}" if m != 1 else f"{k:.4g} Pa/m"


def _partners(pair: Table) -> str:
    """Returns the names of the two partners of a contact pair."""
    first, second = pair["bodies"]
    return f"{first} with itself" if first == second else f"{first} and {second}"


def _scene(scene: Table, summary: Table) -> list[str]:
    """Returns lines that describe the scene: bodies, speed and contact."""
    contact = scene["contact"]
    pull = f"gravity {scene['gravity']:g} m/s2, " if scene.get("gravity") else ""
    words = f"{pull}penalty {stiffness(contact)}{_friction(contact)}"
    own = [
        f"{_partners(pair)}: penalty {stiffness(contact | pair)}{_friction(contact | pair) or ', no friction'}"
        for pair in contact.get("pair", [])
    ]
    bodies = []
    for k, body in enumerate(scene["body"], 1):
        size = _size(summary, k, len(scene["body"]))
        bodies.append(f"{body['name']}: {', '.join([body['shape'], *size, material(body)])}")
        bodies += [f"  {line}" for line in layer_lines(body)]
    return [
        *bodies,
        *(f"{obstacle['name']}: rigid {obstacle['kind']}" for obstacle in scene["obstacle"]),
        words,
        *own,
    ]


def _size(summary: Table, k: int, bodies: int) -> list[str]:
    """Returns the extents and the mass of body k."""
    end = f"_{k}" if bodies > 1 else ""
    extents = [summary.get(f"extent_{axis}{end}") for axis in "xyz"]
    sides = " x ".join(f"{extent:.4g}" for extent in extents if extent is not None)
    unit = f"kg{dimension.per_metre(summary['provenance']['script'])}"
    return [f"{sides} m", f"{summary[f'mass{end}']:.4g} {unit}"] if sides else []


def _gases(summary: Table) -> list[str]:
    """Returns a line for each gas: its state at the start."""
    unit = "m2" if dimension.per_metre(summary["provenance"]["script"]) else "m3"
    return [
        f"gas of load {k}: {summary[name]:.4g} Pa in {summary[f'gas_volume_start_{k}']:.4g} {unit} "
        f"at the start, radius of its body {summary[f'gas_radius_start_{k}']:.4g} m"
        for name in summary
        if name.startswith("gas_pressure_start_")
        for k in [name.rsplit("_", 1)[1]]
    ]


def _friction(contact: Table) -> str:
    friction = contact.get("friction_static")
    if "friction" in contact:
        return f", friction {contact['friction']}"
    return (
        f", friction {friction:g} static, {contact['friction_dynamic']:g} dynamic"
        if friction
        else ""
    )


def warning_lines(summary: Table, verbose: bool = False) -> list[str]:
    """Returns a line for each warning, if `verbose` in full sentences."""
    return [_sentence("warning", sentence, verbose) for sentence in summary["warnings"]]


def _sentence(kind: str, sentence: str, verbose: bool) -> str:
    start = f"  {kind:<10}"
    return start + sentence if verbose else notes.line(start, sentence)


def _of_bodies(quantity: Quantity, scene: Table, summary: Table) -> list[Quantity]:
    """Returns a row for each of several bodies if the summary has the number for each body."""
    body_suffixes = suffixes(summary)
    if f"{quantity.key}{body_suffixes[0]}" not in summary or body_suffixes == [""]:
        return [quantity]
    return [
        replace(quantity, key=quantity.key + suffix, label=f"{quantity.label}, {name}")
        for suffix, name in zip(body_suffixes, body_names(scene))
    ]


def report(result: Record, verbose: bool = False) -> str:
    """Returns the printed report of a finished run: the scene, the main numbers with their error
    estimates, a line for each warning, and where to find more. If `verbose` it contains all numbers
    and full sentences.
    """
    summary, scene, folder = result.summary, result.scene, shown(result.folder)
    printed = rows_of(result, verbose)[: None if verbose else MAIN_ROWS]
    footnotes = notes.footnotes(summary.get("notes", []), [row.key for row in printed], verbose)
    marks = {key: f"[{k}]" for k, key in enumerate(footnotes, 1)}
    lines = [
        f"{folder}: " + ("finished earlier, same scene and code" if result.reused else "finished"),
        *_scene(scene, summary),
        *_gases(summary),
        *_numbers(result, printed, marks),
        *warning_lines(summary, verbose),
        *(_sentence(marks[key], note, verbose) for key in footnotes for note in footnotes[key]),
    ]
    if not summary["provenance"].get("estimate"):
        lines.append("  ±         not estimated: no coarser runs were made")
    lines += [f"  released  {sentence}" for sentence in summary.get("released", [])]
    if summary.get("skipped"):
        lines.append(f"  skipped   {', '.join(summary['skipped'])}")
    pictures = sorted((result.folder / "figures").glob("*.png"))
    if pictures:
        names = ",".join(picture.stem for picture in pictures)
        lines.append(f"  figures   {folder}/figures/{{{names}}}.png")
        if summary.get("contact_intervals") and scene.get("fields") and "contact" not in names:
            more = 4 * scene["fields"]
            lines.append(
                "  no contact.png: no state that was kept is one in contact: "
                f"fields = {more:g} keeps more"
            )
    if scene.get("fields"):
        lines.append(f"  player    ffimpact view {shlex.quote(str(folder))}")
    if not verbose:
        lines.append(f"  more      {folder}/summary.json, ffimpact run --verbose")
    return "\n".join(lines)


def rows_of(result: Record, verbose: bool = False) -> list[Quantity]:
    """Returns the rows of a run in their order: the main ones, or all if `verbose`."""
    summary, scene = result.summary, result.scene
    printed = [
        quantity
        for row in rows(dimension.per_metre(summary["provenance"]["script"]))
        if verbose or row.main(result, row.key)
        for quantity in _of_bodies(row, scene, summary)
        if summary.get(quantity.key) not in (None, []) and quantity.when(result, quantity.key)
    ]
    # Without a contact that is over, the velocities of the rebound are those at the end of the run.
    if scene.get("end_time") and not any(row.key.startswith("final_") for row in printed):
        printed = [replace(row, label=row.label.replace("rebound", "final")) for row in printed]
    return printed if verbose else [replace(row, label=row.label.strip()) for row in printed]


def _numbers(result: Record, printed: list[Quantity], marks: dict[str, str]) -> list[str]:
    """Returns a line for each row: label, value with error estimate, mark of its note, and
    published numbers of the same scene.
    """
    summary, scene = result.summary, result.scene
    bars, published = errors(result), literature.references(scene)
    width, lines = max(24, *(len(quantity.label) + 1 for quantity in printed)), []
    for quantity in printed:
        text = quantity.text(summary[quantity.key], bars.get(quantity.key))
        beside = [quantity.beside(number) for number in published.get(quantity.key, [])] or [""]
        marked = f"{text} {marks.get(quantity.key, '')}".rstrip()
        lines.append(f"  {quantity.label:<{width}}{marked:<26}{beside[0]}".rstrip())
        lines += [f"  {'':<{width + 26}}{more}" for more in beside[1:]]
    return lines
