"""The gear body in a mesh file of a scene, read and checked once."""

from functools import lru_cache
from pathlib import Path

from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear import Gear
from fenics_gears.system import user_file

from ..body_mesh_file import read_body_mesh
from ..elements import element_named
from .outline import WholeBody, whole_body


@lru_cache(maxsize=8)
def given_body(path: str, digest: str, gear: Gear, element: str, field: str) -> WholeBody:
    """The body of a gear in a file; `digest`: of the file's content, empty where it cannot be read; `field`: what
    messages call it. Raises SceneError where the file is not there, is no mesh, not of this gear, or of other cells
    than the element has."""
    if not digest:
        raise SceneError(f"{field}: {_why_not_read(Path(path))} Nothing was computed or written.")
    try:
        mesh = read_body_mesh(path)
        _check_cells(mesh.cells.shape[1], element)
        return whole_body(mesh, gear)
    except SceneError as error:
        raise SceneError(f"{field}: {_without_path(str(error), path)}\nNothing was computed or written.") from None


def _why_not_read(path: Path) -> str:
    try:
        user_file.check_file(path, user_file.LARGEST_MESH)
    except user_file.Missing:
        pass
    except user_file.Unreadable as problem:
        return f"{problem}."
    near = sorted(each.name for each in path.parent.glob("*.msh")) if path.parent.is_dir() else []
    listed = f" Meshes in its folder: {', '.join(near)}." if near else ""
    return f"there is no such file, or it cannot be read.{listed}"


def _check_cells(corners: int, element: str) -> None:
    chosen = element_named(element)
    if corners != chosen.corners:
        triangles = ("triangles", '"P1" or "P2"')
        quadrilaterals = ("quadrilaterals", '"Q1", "Q1 incompatible" or "Q2"')
        kind, fitting = triangles if corners == 3 else quadrilaterals
        raise SceneError(f"the mesh has {kind}, accuracy.element is {chosen.name}. Take {fitting}, for both gears")


def _without_path(words: str, path: str) -> str:
    return words.replace(f"body mesh {path}: ", "")
