"""Finds the natural modes of the free bodies of a run, and the energy that each has at its end:
modes.csv, from what FreeFEM has recorded in modes.bin.
"""

from pathlib import Path

import numpy as np

from .fields import read_arrays

__all__ = ["RECORDED", "write_modes"]

RECORDED = "modes.bin"  # written by edp/program/run/modes.idp
TITLES = "mode,frequency,energy,strain_energy,kinetic_energy"


def write_modes(folder: Path) -> None:
    """Writes modes.csv of the run in `folder` and removes the record; does nothing without one.

    Modes satisfy K phi = omega^2 M phi, phi^T M phi = 1, with the stiffness K of the unstressed
    bodies; rigid motions are no modes. With a = phi^T M w and b = phi^T M w', w the displacement
    in axes that turn with each body, the energy of a mode is (b^2 + omega^2 a^2) / 2 [J/m],
    exact for small strains.
    """
    path = folder / RECORDED
    if not path.exists():
        return
    from scipy.linalg import eigh
    from scipy.sparse import coo_array
    from scipy.sparse.linalg import eigsh

    arrays, _ = read_arrays(path)
    count, rigid, shift = arrays["options"]
    free = arrays["free"] > 0
    stiffness, mass = (
        coo_array(
            (arrays[name], (arrays[f"{name}Row"].astype(int), arrays[f"{name}Column"].astype(int))),
            shape=(len(free), len(free)),
        ).tocsc()[free][:, free]
        for name in ("stiffness", "mass")
    )
    size, total = stiffness.shape[0], int(count + rigid)
    # The recorded stiffness is K + shift M.
    if 2 * total < size:
        values, shapes = eigsh(stiffness, total, mass, sigma=0, tol=1e-12)
    else:
        values, shapes = eigh(stiffness.toarray(), mass.toarray())
    order = np.argsort(values)
    values, shapes = values[order] - shift, shapes[:, order]
    elastic = np.flatnonzero(values > 1e-3 * shift)[: int(count)]
    w, rate = (mass @ arrays[name][free] for name in ("displacement", "velocity"))
    rows = [TITLES]
    for number, k in enumerate(elastic, 1):
        a, b = shapes[:, k] @ w, shapes[:, k] @ rate
        strain, kinetic = values[k] * a**2 / 2, b**2 / 2
        numbers = (np.sqrt(values[k]) / (2 * np.pi), strain + kinetic, strain, kinetic)
        rows.append(",".join([str(number), *(f"{number:.12g}" for number in numbers)]))
    (folder / "modes.csv").write_text("\n".join(rows) + "\n")
    path.unlink()
