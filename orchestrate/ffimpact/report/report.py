"""The printed report of a finished run: its key figures beside the published numbers of the same
scene.
"""

import re
import shlex
import sys
from dataclasses import dataclass, replace

from ..input import dimension
from ..input.parameters import Value
from ..output import notes
from ..output.errors import errors
from ..output.results import Record, body_names, suffixes
from ..places import shown
from . import literature

__all__ = ["MAIN", "MOST", "Quantity", "draw", "marks", "report", "rows", "stiffness", "notices"]

LEFT_OUT_AT_ZERO = (
    "external_work",
    "friction_work",
    "creep_work",
    "rotation_energy",
    "impulse_ratio",
    "rebound_vx",
    "rebound_vz",
    "rebound_spin_x",
    "rebound_spin_y",
    "rebound_spin",
    "sliding_time",
    "sticking_time",
    "reverse_slip_time",
    "unsolved_jumps",
)
# The numbers that are printed for every run, in order of importance; at most MOST of them.
MAIN = (
    "contact_time",
    "peak_force",
    "impulse",
    "restitution",
    "rebound_vx",
    "rebound_vy",
    "rebound_vz",
    "rebound_spin",
    "vibration_energy",
    "friction_work",
    "contact_intervals",
    "energy_drift",
)
MOST = 10


@dataclass(frozen=True)
class Quantity:
    """A row of the report: a key of summary.json, its label, the displayed unit, the factor from SI
    units to that unit, and the number format.
    """

    key: str
    label: str
    unit: str = ""
    factor: float = 1.0
    digits: str = ".4g"

    def text(self, value: float, error: float | None = None) -> str:
        """Returns the value with its error estimate (both passed in SI units) and its unit."""
        bar = "" if error is None else f" ± {self.factor * error:.2g}"
        return f"{self.factor * value:{self.digits}}{bar} {self.unit}".rstrip()

    def beside(self, number: dict) -> str:
        """Returns a published number with its error bar, if it has one, and its source."""
        error = f" ± {self.factor * number['error']:.1g}" if "error" in number else ""
        source = "; ".join(number[key] for key in ("source", "note") if key in number)
        return f"{self.factor * number['value']:{self.digits}}{error} ({source})"


def rows(per: str) -> list[Quantity]:
    """Returns all key figures. `per` is the suffix for the units of forces, impulses and energies,
    see dimension.per_metre().
    """
    return [
        Quantity("contact_time", "contact time", "ms", 1e3),
        Quantity("thresholded_contact_time", "  above 1 % of the peak", "ms", 1e3),
        Quantity("contact_intervals", "contact intervals", digits=".0f"),
        Quantity("peak_force", "peak force", f"kN{per}", 1e-3),
        Quantity("impulse", "impulse", f"N s{per}", digits=".5g"),
        Quantity("rebound_vx", "rebound velocity, x", "m/s"),
        Quantity("rebound_vy", "rebound velocity, y", "m/s"),
        Quantity("rebound_vz", "rebound velocity, z", "m/s"),
        Quantity("rebound_spin_x", "rebound spin about x", "rad/s"),
        Quantity("rebound_spin_y", "rebound spin about y", "rad/s"),
        Quantity("rebound_spin", "rebound spin", "rad/s"),
        Quantity("restitution", "restitution"),
        Quantity("restitution_tangential", "  tangential"),
        Quantity("impulse_ratio", "  impulse ratio"),
        Quantity("angle_in", "angle of incidence", "degrees"),
        Quantity("angle_out", "  of reflection", "degrees"),
        Quantity("sliding_time", "load slides for", "ms", 1e3),
        Quantity("reverse_slip_time", "  of it backwards", "ms", 1e3),
        Quantity("sticking_time", "load sticks for", "ms", 1e3),
        Quantity("energy_initial", "energy at the start", f"J{per}"),
        Quantity("external_work", "external work", f"J{per}"),
        Quantity("translation_energy", "left in translation", f"J{per}"),
        Quantity("rotation_energy", "  in rotation", f"J{per}"),
        Quantity("vibration_energy", "  left in vibration", f"J{per}"),
        Quantity("friction_work", "lost to friction", f"J{per}"),
        Quantity("creep_work", "  of it in creep", f"J{per}"),
        Quantity("viscous_work", "lost to viscosity", f"J{per}"),
        Quantity(
            "energy_drift", "energy drift", "of the energy at the start or at contact", digits=".1e"
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
        ),
        Quantity("resumed_at", "resumed at", "ms", 1e3),
        Quantity("steps", "steps", digits=".0f"),
        Quantity("dofs", "degrees of freedom", digits=".0f"),
        Quantity("total_seconds", "wall time", "s", digits=".2f"),
        Quantity("wall_seconds", "  of it this run", "s", digits=".2f"),
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
        print(f"ffimpact: the figures could not be drawn: {why}", file=sys.stderr)


def stiffness(contact: dict[str, Value]) -> str:
    """Returns the penalty k of a contact t_N = k p^m (10) with its unit."""
    m = contact["exponent"]
    return f"{contact['penalty']:.4g} Pa/m" + f"^{m:g}" * (m != 1)


def _scene(scene: dict[str, Value]) -> list[str]:
    """Returns lines that describe the scene: bodies, speed and contact."""
    contact = scene.get("contact", scene)
    pull = f"gravity {scene['gravity']:g} m/s2, " if scene.get("gravity") else ""
    words = f"{pull}penalty {stiffness(contact)}{_friction(contact)}"
    own = [
        f"{' and '.join(pair['bodies'])}: penalty {stiffness(contact | pair)}{_friction(contact | pair) or ', no friction'}"
        for pair in contact.get("pair", [])
    ]
    if "body" not in scene:
        return [
            f"radius {scene['radius']:g} m, {_material(scene)}, {scene['speed']:g} m/s, angle {scene.get('angle', 90):g} degrees",
            words,
        ]
    return [
        *(f"{body['name']}: {body['shape']}, {_material(body)}" for body in scene["body"]),
        *(f"{obstacle['name']}: rigid {obstacle['kind']}" for obstacle in scene["obstacle"]),
        words,
        *own,
    ]


def _material(body: dict[str, Value]) -> str:
    if body.get("rigid"):
        return "rigid, " + (
            f"mass = {body['mass']:g} kg"
            if "mass" in body
            else f"density = {body['density']:g} kg/m3"
        )
    return f"{body['law']}, young = {body['young']:g} Pa, nu = {body['nu']:g}, density = {body['density']:g} kg/m3"


def _friction(contact: dict[str, Value]) -> str:
    friction = contact.get("friction_static")
    return (
        f", friction {friction:g} static, {contact['friction_dynamic']:g} dynamic"
        if friction
        else ""
    )


def marks(summary: dict) -> dict[str, str]:
    """Returns the footnote mark of each number that has a note, by key, in the order of the
    notes.
    """
    return {
        key: f" [{k}]"
        for k, key in enumerate(dict.fromkeys(map(notes.number, summary.get("notes", []))), 1)
    }


def notices(summary: dict, verbose: bool = False) -> list[str]:
    """Returns a line for each warning, then a line for each note of a main number, with its mark.
    If `verbose` it returns all notes, in full sentences.
    """
    mark = {key: text for key, text in marks(summary).items() if verbose or _bare(key) in MAIN}
    footnotes = sorted(
        (note for note in summary.get("notes", []) if notes.number(note) in mark),
        key=lambda note: list(mark).index(notes.number(note)),
    )
    sentences = [("warning", sentence) for sentence in summary["warnings"]]
    sentences += [(mark[notes.number(note)].strip(), note) for note in footnotes]
    if verbose:
        return [f"  {kind:<10}{sentence}" for kind, sentence in sentences]
    return [notes.line(f"  {kind:<10}", sentence) for kind, sentence in sentences]


def _of_bodies(quantity: Quantity, scene: dict[str, Value], summary: dict) -> list[Quantity]:
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
    lines = [
        f"{folder}: " + ("finished earlier, same scene and code" if result.reused else "finished"),
        *_scene(scene),
        *_numbers(result, verbose),
        *notices(summary, verbose),
    ]
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


def _numbers(result: Record, verbose: bool) -> list[str]:
    """Returns a line for each number: label, value with error estimate, mark of its note, and
    published numbers of the same scene.
    """
    summary, scene = result.summary, result.scene
    script = summary["provenance"]["script"]
    mark, bars, published = marks(summary), errors(result), _published(summary, scene)
    quantities = [
        quantity
        for row in rows(dimension.per_metre(script))
        for quantity in _of_bodies(row, scene, summary)
        if _is_told(quantity, summary)
    ]
    if not verbose:
        quantities = sorted(
            (quantity for quantity in quantities if _bare(quantity.key) in MAIN),
            key=lambda quantity: MAIN.index(_bare(quantity.key)),
        )[:MOST]
        quantities = [replace(quantity, label=quantity.label.strip()) for quantity in quantities]
    if scene.get("end_time"):  # the run may continue after the impact
        quantities = [
            replace(quantity, label=quantity.label.replace("rebound", "final"))
            for quantity in quantities
        ]
    width, lines = max(24, *(len(quantity.label) + 1 for quantity in quantities)), []
    for quantity in quantities:
        text = quantity.text(summary[quantity.key], bars.get(quantity.key))
        beside = [quantity.beside(number) for number in published.get(quantity.key, [])] or [""]
        marked = text + mark.get(quantity.key, "")
        lines.append(f"  {quantity.label:<{width}}{marked:<26}{beside[0]}".rstrip())
        lines += [f"  {'':<{width + 26}}{more}" for more in beside[1:]]
    return lines


def _published(summary: dict, scene: dict[str, Value]) -> dict[str, list[dict]]:
    """Returns the published numbers of the same scene by key. A scene with a mesh of the user has
    none, because it is another body.
    """
    provenance = summary["provenance"]
    if provenance.get("mesh") and not provenance.get("gmsh"):
        return {}
    return literature.references(provenance["script"], scene)


def _is_told(quantity: Quantity, summary: dict) -> bool:
    """Returns whether the run has the number and whether the number is informative."""
    value = summary.get(quantity.key)
    return value is not None and (abs(value) >= 1e-9 or _bare(quantity.key) not in LEFT_OUT_AT_ZERO)


def _bare(key: str) -> str:
    """Returns the name of a number without the suffix of its body."""
    return re.sub("_[0-9]+$", "", key)
