"""Writes the mesh of a gear body, as scenes read it."""

from pathlib import Path

import numpy as np

from fenics_gears.elasticity.gmsh_session import gmsh_model
from fenics_gears.elasticity.mesh_content import LINE
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.errors import SceneError

# gmsh's numbers of straight-sided triangles and quadrilaterals.
TYPE_BY_CORNERS = {3: 2, 4: 3}


def write_body_mesh(mesh: BodyMesh, path) -> None:
    """Write a body, mm, as a gmsh file of format 4.1; named edges become physical curves, the body the physical surface
    "gear". Raises SceneError where the file cannot be written."""
    try:
        Path(path).touch()
    except OSError as error:
        raise SceneError(f"body mesh {path}: cannot be written: {error.strerror}") from None
    corners = mesh.cells.shape[1]
    with gmsh_model("body mesh") as gmsh:
        surface = gmsh.model.addDiscreteEntity(2)
        coordinates = np.column_stack([mesh.points, np.zeros(len(mesh.points))])
        gmsh.model.mesh.addNodes(2, surface, np.arange(1, len(mesh.points) + 1), coordinates.ravel())
        gmsh.model.mesh.addElementsByType(surface, TYPE_BY_CORNERS[corners], [], (mesh.cells + 1).ravel())
        gmsh.model.setPhysicalName(2, gmsh.model.addPhysicalGroup(2, [surface]), "gear")
        for name, lines in mesh.edges.items():
            curve = gmsh.model.addDiscreteEntity(1)
            gmsh.model.mesh.addElementsByType(curve, LINE, [], (np.asarray(lines) + 1).ravel())
            gmsh.model.setPhysicalName(1, gmsh.model.addPhysicalGroup(1, [curve]), name)
        gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
        gmsh.option.setNumber("Mesh.Binary", 0)
        gmsh.write(str(path))
