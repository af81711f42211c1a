"""An animation of the states of a run: k3d, in a notebook or as one HTML file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .failure import BadInput, NotInstalled, Unreadable, unknown
from .output import vtu

if TYPE_CHECKING:
    from .result import Result

__all__ = ["view"]

SECONDS = 5.0  # that the animation takes


def view(result: Result, path: str | Path | None = None, field: str = "von_mises") -> Any:
    """The deforming bodies over time with a field of the states: a k3d plot, or `path`, the
    HTML file that was written.

    The time of the player is that of the run, slowed down so that all of it takes some seconds.
    """
    try:
        import k3d
    except ImportError:
        raise NotInstalled("view: needs k3d; install it: pip install k3d") from None
    if path is not None and Path(path).suffix.lower() not in (".html", ".htm"):
        raise BadInput(f"view: '{path}' is no HTML file (accepted: a name that ends in .html)")
    series = vtu.series(result.folder / "fields.pvd")
    if not series:
        raise Unreadable(f"{result.folder}: has no states (accepted: a run with fields = 60, say)")
    states = [vtu.read(file) for _, file in series]
    if field not in states[0].fields:
        raise BadInput(f"field: {unknown(field, states[0].fields, ', ')}")
    times = np.array([time for time, _ in series])
    slow = SECONDS / (np.ptp(times) or 1.0)
    vertices = {f"{slow * t}": _places(one).astype(np.float32) for t, one in zip(times, states)}
    values = {
        f"{slow * t}": _scalar(one.fields[field]).astype(np.float32)
        for t, one in zip(times, states)
    }
    top = max(float(value.max()) for value in values.values())
    low = min(float(value.min()) for value in values.values())
    plot = k3d.plot(
        camera_auto_fit=False, grid_visible=False, name=f"{result.folder.name}: {field}"
    )
    plot += k3d.mesh(
        vertices,
        states[0].triangles.astype(np.uint32),
        attribute=values,
        color_range=[low, top],
        color_map=k3d.colormaps.matplotlib_color_maps.Viridis,
        side="double",
        flat_shading=False,
    )
    every = np.vstack([_places(one) for one in states])
    centre, size = (every.min(axis=0) + every.max(axis=0)) / 2, np.ptp(every, axis=0).max()
    plot.camera = [*(centre + [0, 0, 1.6 * size]), *centre, 0, 1, 0]
    plot.fps = 25
    if path is None:
        return plot
    path = Path(path)
    path.write_text(plot.get_snapshot(), "utf-8")
    return path


def _places(state: vtu.Snapshot) -> np.ndarray:
    """Deformed places (n, 3) [m]."""
    return (
        state.points + state.fields["displacement"]
        if state.points.shape[1] == 3
        else np.pad(state.points + state.fields["displacement"][:, :2], [(0, 0), (0, 1)])
    )


def _scalar(field: np.ndarray) -> np.ndarray:
    return np.linalg.norm(field, axis=1) if field.ndim > 1 else field
