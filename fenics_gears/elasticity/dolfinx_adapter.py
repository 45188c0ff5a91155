"""The only module that imports DOLFINx: what the program uses of it, alike on 0.5, 0.9 and 0.11."""

import functools
import inspect
import logging
import re
from contextlib import contextmanager
from importlib import metadata
from pathlib import Path

import numpy as np

from fenics_gears.system.environment import cache_folder
from fenics_gears.system.output import one_at_a_time


def _load_vtk_before_old_dolfinx() -> None:
    """DOLFINx 0.5 exports std::regex symbols that make VTK 9.7 abort when it is loaded after it."""
    try:
        version = metadata.version("fenics-dolfinx")
    except metadata.PackageNotFoundError:
        version = "0.5"
    if tuple(int(part) for part in version.split(".")[:2]) >= (0, 6):
        return
    try:
        import vtkmodules.vtkCommonCore  # noqa: F401
    except ImportError:
        pass


_load_vtk_before_old_dolfinx()

# Before DOLFINx, which would start PETSc itself.
from .petsc import PETSc  # noqa: E402 I001

import basix  # noqa: E402
import dolfinx  # noqa: E402
import dolfinx.fem.petsc  # noqa: E402
import ufl  # noqa: E402
from dolfinx import fem  # noqa: E402
from mpi4py import MPI  # noqa: E402

# gmsh numbers the corners of a quadrilateral around it, DOLFINx row by row.
_CORNER_ORDER = {3: [0, 1, 2], 4: [0, 1, 3, 2]}
_CELL_NAME = {3: "triangle", 4: "quadrilateral"}
_HAS_FUNCTIONSPACE = hasattr(fem, "functionspace")


def create_mesh(points, cells):
    """DOLFINx mesh, on this process alone, of points (n, 2), mm, and straight-sided cells (m, 3) or (m, 4), corners
    counter-clockwise."""
    corners = cells.shape[1]
    domain = ufl.Mesh(_coordinate_element(_CELL_NAME[corners]))
    parameters = inspect.signature(dolfinx.mesh.create_mesh).parameters
    element_name = "domain" if "domain" in parameters else "e"  # 0.5 : 0.7 and later
    ordered = np.ascontiguousarray(cells[:, _CORNER_ORDER[corners]], dtype=np.int64)
    coordinates = np.ascontiguousarray(points, dtype=np.float64)
    return dolfinx.mesh.create_mesh(MPI.COMM_SELF, cells=ordered, x=coordinates, **{element_name: domain})


def _coordinate_element(cell_name):
    if _HAS_FUNCTIONSPACE:
        import basix.ufl

        return basix.ufl.element("Lagrange", cell_name, 1, shape=(2,))
    return ufl.VectorElement("Lagrange", cell_name, 1)


def vector_space(mesh, order: int, components: int = 2):
    """Continuous Lagrange space of displacements in a plane mesh, of two components or, out of its plane, of three."""
    if _HAS_FUNCTIONSPACE:
        return fem.functionspace(mesh, ("Lagrange", order, (components,)))
    return fem.VectorFunctionSpace(mesh, ("Lagrange", order), dim=components)


def cell_space(mesh, order: int, components: int):
    """Discontinuous space of quadrilaterals: values of a cell (order 0) or of its corners (order 1), cell by cell."""
    if _HAS_FUNCTIONSPACE:
        return fem.functionspace(mesh, ("DG", order) if components == 1 else ("DG", order, (components,)))
    family = "DG" if order == 0 else "DQ"
    if components == 1:
        return fem.FunctionSpace(mesh, (family, order))
    return fem.VectorFunctionSpace(mesh, (family, order), dim=components)


def cell_nodes(space) -> np.ndarray:
    """Numbers (m, k) of the space's nodes by cell, in the order of the reference cell."""
    # DOLFINx 0.5 and 0.6 have an adjacency list where later ones have an array.
    entries = np.asarray(getattr(space.dofmap.list, "array", space.dofmap.list))
    topology = space.mesh.topology
    return entries.reshape(topology.index_map(topology.dim).size_local, -1)


def node_coordinates(space) -> np.ndarray:
    """Coordinates of the space's nodes, (nodes, 2); of two components, node i has dofs 2 i and 2 i + 1."""
    return space.tabulate_dof_coordinates()[:, :2]


def lagrange(nodes: np.ndarray, order: int, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Shape functions (p, k) of the nodes (k, 2) of a reference triangle or square, from 0 to 1, at points (p, 2), and
    their derivatives (p, k, 2)."""
    cell = basix.CellType.triangle if len(nodes) in (3, 6) else basix.CellType.quadrilateral
    element = basix.create_element(basix.ElementFamily.P, cell, order, basix.LagrangeVariant.gll_warped)
    number = [np.linalg.norm(element.points - node, axis=1).argmin() for node in nodes]
    values, *slopes = element.tabulate(1, np.asarray(points, dtype=float))[..., number, 0]
    return values, np.stack(slopes, axis=-1)


def constant(mesh, value):
    """Number in a form, or a tuple of numbers; it may change without compiling the form again."""
    return fem.Constant(mesh, PETSc.ScalarType(value))


@contextmanager
def quiet_compiler():
    """Silence the C compiler's log: the build tools under DOLFINx write each command to the root logger."""
    disabled = logging.root.manager.disable
    logging.disable(max(logging.INFO, disabled))
    try:
        yield
    finally:
        logging.disable(disabled)


def with_compiled(build):
    """Call ``build()``, which compiles. Where a compile was killed halfway, remove what it left and call it again. The
    form compiler takes it for under way, waits 10 s and names the source file in its error."""
    try:
        return build()
    except TimeoutError as error:
        named = re.search(r"remove (.+\.c)\)", str(error))
        if named is None:
            raise
        Path(named[1]).unlink(missing_ok=True)
        return with_compiled(build)


def in_turn(compiler):
    """DOLFINx's compiler of forms, elements and coordinate maps, quiet and in one process at a time. While one process
    compiles, others that need the same form would wait 10 s and then fail."""

    @functools.wraps(compiler)
    def compiled(*arguments, **options):
        with one_at_a_time(cache_folder() / "fenics_gears" / "compiling"), quiet_compiler():
            return with_compiled(lambda: compiler(*arguments, **options))

    return compiled


# All that DOLFINx compiles goes through it.
dolfinx.jit.ffcx_jit = in_turn(dolfinx.jit.ffcx_jit)


def compile_form(expression):
    """Compile a UFL form, or take it from DOLFINx's own form cache."""
    return fem.form(expression)


def assemble_matrix(form):
    """Assembled PETSc matrix of a compiled bilinear form, no boundary conditions."""
    matrix = fem.petsc.assemble_matrix(form)
    matrix.assemble()
    return matrix


def block_diagonal(blocks: np.ndarray):
    """PETSc matrix of dense blocks (m, k, k) along its diagonal."""
    count, size = blocks.shape[:2]
    rows = np.arange(0, count * size**2 + 1, size, dtype=PETSc.IntType)
    columns = np.repeat(np.arange(count * size, dtype=PETSc.IntType).reshape(count, 1, size), size, axis=1)
    return PETSc.Mat().createAIJ((count * size,) * 2, csr=(rows, columns.ravel(), blocks.ravel()), comm=MPI.COMM_SELF)


def function(space, values=None):
    """Function of a space, zero or with the given dof values, (dofs,)."""
    result = fem.Function(space)
    if values is not None:
        result.x.array[:] = values
    return result
