"""Named physical groups of gmsh models, as the numbers of the elements in each."""

import numpy as np

from .mesh import Gmsh

__all__ = ["of_cells", "of_model", "rows_among"]

SAME = 9  # decimals to which nodes at one place agree, relative to the size of the model


def rows_among(rows: np.ndarray, among: np.ndarray) -> np.ndarray:
    """The numbers of those rows of `among` (m, c) that are in `rows` (n, c), in any order within a
    row.
    """
    both = np.sort(np.vstack([among, rows]), axis=1)
    _, first, which = np.unique(both, axis=0, return_index=True, return_inverse=True)
    at = first[which.ravel()[len(among) :]]
    return np.unique(at[at < len(among)])


def of_model(model: Gmsh, dimension: int, elements: np.ndarray) -> dict[str, np.ndarray]:
    """The numbers of the elements of each physical group by its name, or by its number if it has no
    name.

    `elements` (n, corners) are gmsh's numbers of their nodes. Nodes at one place count as one.
    """
    entities: dict[str, list[int]] = {}
    for _, number in model.getPhysicalGroups(dimension):
        name = model.getPhysicalName(dimension, number).strip() or str(number)
        own = model.getEntitiesForPhysicalGroup(dimension, number).tolist()
        entities.setdefault(name, []).extend(own)
    return _of_entities(model, dimension, elements, entities)


def of_cells(model: Gmsh, dimension: int, cells: np.ndarray) -> dict[str, np.ndarray]:
    """The same of cells; without physical groups the cells of each volume or surface by its number,
    which is that of regions in Medit's format.
    """
    groups = of_model(model, dimension, cells)
    tags = [tag for _, tag in model.getEntities(dimension)]
    return groups or _of_entities(model, dimension, cells, {str(tag): [tag] for tag in tags})


def _of_entities(
    model: Gmsh, dimension: int, elements: np.ndarray, entities: dict[str, list[int]]
) -> dict[str, np.ndarray]:
    """The numbers of the elements in entities of the model, by the names of lists of entities."""
    tags, coordinates, _ = model.mesh.getNodes()
    points = coordinates.reshape(-1, 3)
    scaled = np.round(points / np.ptp(points, axis=0).max(), SAME)
    place = np.full(int(max(tags.max(), elements.max())) + 1, -1)
    place[tags] = np.unique(scaled, axis=0, return_inverse=True)[1].ravel()
    groups = {}
    for name, own in entities.items():
        rows = _rows(model, dimension, own, elements.shape[1])
        rows = rows[(rows < len(place)).all(axis=1)]
        groups[name] = rows_among(place[rows], place[elements])
    return groups


def _rows(model: Gmsh, dimension: int, entities: list[int], corners: int) -> np.ndarray:
    """gmsh's numbers of the corners (n, corners) of the elements in entities."""
    rows = [np.empty((0, corners), dtype=int)]
    for entity in entities:
        for kind, _, nodes in zip(*model.mesh.getElements(dimension, entity)):
            *_, count, _, own = model.mesh.getElementProperties(kind)
            if own == corners:
                rows.append(np.reshape(nodes, (-1, count))[:, :corners].astype(int))
    return np.vstack(rows)
