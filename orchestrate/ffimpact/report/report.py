"""What a finished run is told in: its key figures, beside the published numbers of the same
scene.
"""

import re
import sys
from dataclasses import dataclass, replace

from ..input import dimension
from ..input.parameters import Value
from ..output import notes
from ..output.results import Record, body_names, suffixes
from ..places import shown
from . import literature

__all__ = ["Quantity", "draw", "marks", "report", "rows", "stiffness", "told"]

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


@dataclass(frozen=True)
class Quantity:
    """A row of the report: a key of summary.json, its name for the reader, the factor from SI
    and the unit shown.
    """

    key: str
    label: str
    unit: str = ""
    factor: float = 1.0
    digits: str = ".4g"

    def text(self, value: float) -> str:
        return f"{self.factor * value:{self.digits}} {self.unit}".rstrip()

    def beside(self, number: dict) -> str:
        """A published number, its error bar where it has one, and where it comes from."""
        error = f" ± {self.factor * number['error']:.1g}" if "error" in number else ""
        source = "; ".join(number[key] for key in ("source", "note") if key in number)
        return f"{self.factor * number['value']:{self.digits}}{error} ({source})"


def rows(per: str) -> list[Quantity]:
    """The key figures; `per` stands behind the units of forces, impulses and energies:
    dimension.per_metre().
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
        Quantity("vibration_energy", "  in vibration", f"J{per}"),
        Quantity("friction_work", "lost to friction", f"J{per}"),
        Quantity("creep_work", "  of it in creep", f"J{per}"),
        Quantity("viscous_work", "lost to viscosity", f"J{per}"),
        Quantity("energy_drift", "energy drift", "of the start or the touch", digits=".1e"),
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
    """The figures of the run into its folder, unless they are there; a picture is no reason to
    lose a run: what hinders it is said.
    """
    if result.reused and (result.folder / "figures/energies.png").exists():
        return
    try:
        from . import drawing  # matplotlib: only where something is drawn

        drawing.draw(result.folder)
    except Exception as error:
        why = (
            f"{error.filename or result.folder}: {error.strerror}"
            if isinstance(error, OSError) and error.strerror
            else repr(error)
        )
        print(f"ffimpact: the figures could not be drawn: {why}", file=sys.stderr)


def stiffness(contact: dict[str, Value]) -> str:
    """The penalty k of a contact t_N = k p^m (10) with its unit."""
    m = contact["exponent"]
    return f"{contact['penalty']:.4g} Pa/m" + f"^{m:g}" * (m != 1)


def _scene(scene: dict[str, Value]) -> list[str]:
    """What was run: bodies, speed, contact."""
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
        *(f"{one['name']}: rigid {one['kind']}" for one in scene["obstacle"]),
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
    given = contact.get("friction_static")
    return f", friction {given:g} static, {contact['friction_dynamic']:g} dynamic" if given else ""


def marks(summary: dict) -> dict[str, str]:
    """The mark of each number that has a note, by its key, in the order of the notes."""
    return {
        key: f" [{k}]"
        for k, key in enumerate(dict.fromkeys(map(notes.number, summary.get("notes", []))), 1)
    }


def told(summary: dict) -> list[str]:
    """A line of each warning, then of each note behind its mark, then where the whole text
    stands.
    """
    mark = marks(summary)
    footnotes = sorted(
        summary.get("notes", []), key=lambda note: list(mark).index(notes.number(note))
    )
    lines = [notes.line(f"  {'warning':<10}", sentence) for sentence in summary["warnings"]]
    lines += [notes.line(f"  {mark[notes.number(note)].strip():<10}", note) for note in footnotes]
    return lines and [*lines, f"  {'in full':<10}warnings and notes of summary.json"]


def _of_bodies(quantity: Quantity, scene: dict[str, Value], summary: dict) -> list[Quantity]:
    """A row of each of several bodies, where the summary has it of each."""
    of = suffixes(summary)
    if f"{quantity.key}{of[0]}" not in summary or of == [""]:
        return [quantity]
    return [
        replace(quantity, key=quantity.key + suffix, label=f"{quantity.label}, {name}")
        for suffix, name in zip(of, body_names(scene))
    ]


def report(result: Record) -> str:
    """The key figures of a run as a table of text, what was skipped, and where the pictures are."""
    summary, scene = result.summary, result.scene
    provenance = summary["provenance"]
    script = provenance["script"]
    # a mesh of the user's is another body
    known = (
        literature.references(script, scene)
        if provenance.get("gmsh") or not provenance.get("mesh")
        else {}
    )
    place = shown(result.folder)
    lines = [
        f"{place}: " + ("finished earlier, same scene and code" if result.reused else "finished"),
        *_scene(scene),
    ]
    quantities = [
        one for row in rows(dimension.per_metre(script)) for one in _of_bodies(row, scene, summary)
    ]
    if scene.get("end_time"):  # not of an impact alone
        quantities = [
            replace(quantity, label=quantity.label.replace("rebound", "final"))
            for quantity in quantities
        ]
    width, mark = max(24, *(len(quantity.label) + 1 for quantity in quantities)), marks(summary)
    for quantity in quantities:
        value = summary.get(quantity.key)
        if value is None or (
            abs(value) < 1e-9 and re.sub("_[0-9]+$", "", quantity.key) in LEFT_OUT_AT_ZERO
        ):
            continue
        beside = [quantity.beside(number) for number in known.get(quantity.key, [])] or [""]
        lines.append(
            f"  {quantity.label:<{width}}{quantity.text(value) + mark.get(quantity.key, ''):<18}{beside[0]}".rstrip()
        )
        lines += [f"  {'':<{width + 18}}{more}" for more in beside[1:]]
    if stated := summary.get("estimated_error"):
        errors = ", ".join(
            f"{name.replace('_', ' ')} {100 * value:.2g} %"
            for name, value in stated.items()
            if value >= 5e-6
        )
        lines.append(
            f"  {'stated errors':<{width}}{errors}{mark.get('estimated_error', '')}; not in them: what another "
            f"{' or '.join(summary['estimated_error_excludes']).replace('_', ' ')} would change"
        )
    lines += told(summary)
    lines += [f"  {'released':<{width}}{sentence}" for sentence in summary.get("released", [])]
    if summary.get("skipped"):
        lines.append(f"  {'skipped':<{width}}{', '.join(summary['skipped'])}")
    pictures = sorted((result.folder / "figures").glob("*.png"))
    if pictures:
        lines.append(
            f"  {'figures':<{width}}"
            + f"{place}/figures/{{{','.join(p.stem for p in pictures)}}}.png"
        )
        if (
            summary.get("contact_intervals")
            and scene.get("fields")
            and "contact" not in {picture.stem for picture in pictures}
        ):
            lines.append(
                f"  {'no contact.png':<{width}}"
                f"no state that was kept is one in contact: fields = {4 * scene['fields']:g} keeps more"
            )
    return "\n".join(lines)
