"""Read the mesh of a gear body that the user made with gmsh."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fenics_gears.elasticity.gmsh_session import gmsh_model
from fenics_gears.elasticity.mesh_data import BodyMesh, oriented
from fenics_gears.errors import SceneError

LINE = 1
CORNERS_BY_TYPE = {2: 3, 3: 4}  # gmsh's numbers of straight-sided triangles and quadrilaterals


def read_body_mesh(path) -> BodyMesh:
    """Body from a gmsh file, mm, in the canonical frame of tooth 0, of first-order triangles or quadrilaterals (not both).

    Its physical curves "hub" and "flank 0", "flank 1", ... become the named edges.
    Raises SceneError for a file that cannot be read, has other cells or names no hub.
    """
    if not Path(path).is_file():
        raise SceneError(f"body mesh {path}: there is no such file")
    with gmsh_model("body mesh") as gmsh:
        try:
            gmsh.merge(str(path))
        except Exception as error:  # gmsh raises nothing more precise
            raise SceneError(f"body mesh {path}: gmsh cannot read it ({error})") from error
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        index = np.full(int(np.max(tags, initial=0)) + 1, -1)
        cell_types = gmsh.model.mesh.getElementTypes(2)
        if len(cell_types) != 1 or cell_types[0] not in CORNERS_BY_TYPE:
            raise SceneError(f"body mesh {path}: cells must all be 3-node triangles or all 4-node quadrilaterals")
        corners = CORNERS_BY_TYPE[cell_types[0]]
        cells = np.asarray(gmsh.model.mesh.getElementsByType(cell_types[0])[1], dtype=int).reshape(-1, corners)
        edges = {name: lines for name, lines in _named_lines(gmsh).items() if len(lines)}
    used = np.unique(cells)
    index[used] = np.arange(len(used))
    position = np.empty((len(index), 2))
    position[np.asarray(tags, dtype=int)] = np.asarray(coordinates).reshape(-1, 3)[:, :2]
    if "hub" not in edges:
        raise SceneError(f"body mesh {path}: no physical curve 'hub'; there are: {', '.join(sorted(edges)) or 'none'}")
    points = position[used]
    return BodyMesh(points, oriented(points, index[cells]), {name: index[lines] for name, lines in edges.items()})


def _named_lines(gmsh) -> dict[str, np.ndarray]:
    """Node tags (k, 2) of the lines of each physical curve."""
    named = {}
    for dimension, group in gmsh.model.getPhysicalGroups(1):
        entities = gmsh.model.getEntitiesForPhysicalGroup(dimension, group)
        lines = [np.asarray(gmsh.model.mesh.getElementsByType(LINE, entity)[1], dtype=int) for entity in entities]
        named[gmsh.model.getPhysicalName(dimension, group)] = np.concatenate(lines).reshape(-1, 2)
    return named
