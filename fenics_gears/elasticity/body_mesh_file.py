"""Reading the mesh of a gear body from a gmsh file."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from fenics_gears.errors import ComputationError, SceneError

from .mesh_content import mesh_content
from .mesh_data import BodyMesh, corner_areas, oriented

CORNERS_BY_TYPE = {2: 3, 3: 4}  # gmsh's numbers of straight-sided triangles and quadrilaterals
# How far the points of a plane mesh may lie off one plane, in parts of the body's size.
PLANE = 1e-6


def read_body_mesh(path) -> BodyMesh:
    """Body from a gmsh file, mm, of first-order triangles or quadrilaterals (not both); its physical curves become the
    named edges. Raises SceneError for a file that cannot be read, is not plane, has other cells or inverted ones."""
    if not Path(path).is_file():
        raise SceneError(f"body mesh {path}: there is no such file")
    content = mesh_content(path)
    if content.solids:
        raise SceneError(f"body mesh {path}: has cells in space; a gear body is meshed in its plane")
    if len(content.kinds) != 1 or content.kinds[0] not in CORNERS_BY_TYPE:
        raise SceneError(
            f"body mesh {path}: has {_kinds(content.kind_names)}; its cells must all be 3-node triangles or "
            "all 4-node quadrilaterals (in gmsh Mesh.ElementOrder = 1)"
        )
    cells = content.cells.astype(int).reshape(-1, CORNERS_BY_TYPE[content.kinds[0]])
    used = np.unique(cells)
    tags = content.tags.astype(int)
    order = np.argsort(tags, kind="stable")
    points = content.points[order][np.minimum(np.searchsorted(tags[order], used), len(tags) - 1)]
    if not np.isin(used, tags).all() or not np.isfinite(points).all():
        raise SceneError(f"body mesh {path}: is damaged: it has cells of nodes that are missing. Write it again")
    _check_plane(points, path)
    points = np.ascontiguousarray(points[:, :2])
    named = {str(name): content.lines[content.curves == name] for name in dict.fromkeys(content.curves)}
    edges = {name: np.searchsorted(used, lines) for name, lines in named.items() if np.isin(lines, used).all()}
    return BodyMesh(points, _facing_one_way(points, np.searchsorted(used, cells), path), edges)


def _kinds(names: Sequence[str]) -> str:
    return "cells of the kinds " + ", ".join(names) if len(names) else "no plane cells"


def _check_plane(points: np.ndarray, path) -> None:
    size = np.ptp(points, axis=0)
    if size[2] > PLANE * size.max():
        raise SceneError(
            f"body mesh {path}: is not plane: its points lie between z = {points[:, 2].min():.6g} and"
            f" {points[:, 2].max():.6g}"
        )


def _facing_one_way(points: np.ndarray, cells: np.ndarray, path) -> np.ndarray:
    """Cells turned counter-clockwise; SceneError where not all faced the same way, as the mesh then folds over
    itself."""
    clockwise = corner_areas(points, cells).sum(axis=1) < 0.0
    if 0 < clockwise.sum() < len(cells):
        fewer = np.flatnonzero(clockwise == (clockwise.sum() < 0.5 * len(cells)))
        where = points[cells[fewer[0]]].mean(axis=0)
        raise SceneError(
            f"body mesh {path}: {len(fewer)} of {len(cells)} cells are inverted, the first near x = {where[0]:.4g}, y ="
            f" {where[1]:.4g}: the mesh folds over itself there"
        )
    try:
        return oriented(points, cells)
    except ComputationError as error:
        raise SceneError(f"body mesh {path}: {error}") from error
