"""What gmsh finds in a mesh file, read by a process of its own: one wrong digit can end the process that reads it.

`python -m fenics_gears.elasticity.mesh_content FILE` is that process: it writes the arrays to the standard output.
"""

import json
import os
import resource
import signal
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fenics_gears.errors import SceneError

from .gmsh_session import gmsh_model

LINE = 1  # gmsh's number of a straight line
# What reading may take, in bytes and seconds, for gmsh itself and for each byte of the file: many times what it takes.
MEMORY = 8e9
MEMORY_PER_BYTE = 100.0
SECONDS = 60.0
SECONDS_PER_BYTE = 1e-6
DAMAGED = "the file is damaged; write it again"


@dataclass(frozen=True)
class MeshContent:
    """Nodes, plane cells and lines of a file.

    tags, points: gmsh's numbers of the nodes, and their places (n, 3). kinds, kind_names: gmsh's numbers and names of
    the kinds of plane cells. cells: node tags of all cells of the first kind, one after the other. solids: whether
    there are cells in space. lines, curves: node tags (k, 2) of all lines of physical curves, and the name of each
    line's curve.
    """

    tags: np.ndarray
    points: np.ndarray
    kinds: np.ndarray
    kind_names: np.ndarray
    cells: np.ndarray
    solids: np.ndarray
    lines: np.ndarray
    curves: np.ndarray


def mesh_content(path: Path) -> MeshContent:
    """The content of a gmsh file. Raises SceneError where gmsh cannot read it."""
    size = os.path.getsize(path)
    path = Path(os.path.abspath(path))
    program = Path(__file__).parents[2]
    others = os.environ.get("PYTHONPATH")
    environment = {**os.environ, "PYTHONPATH": f"{program}{os.pathsep}{others}" if others else str(program)}
    memory = int(MEMORY + MEMORY_PER_BYTE * size)
    seconds = SECONDS + SECONDS_PER_BYTE * size
    call = [sys.executable, "-P", "-m", "fenics_gears.elasticity.mesh_content", path.name, str(memory)]
    try:
        # gmsh takes names in UTF-8 only: the folder's may be another.
        done = subprocess.run(call, cwd=path.parent, env=environment, capture_output=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        raise SceneError(f"body mesh {path}: gmsh has not read it after {seconds:.0f} s: {DAMAGED}") from None
    if done.returncode:
        raise SceneError(f"body mesh {path}: gmsh cannot read it ({_reason(done)})")
    return _unpacked(done.stdout)


def _reason(done: subprocess.CompletedProcess) -> str:
    if done.returncode < 0:
        return f"it ends gmsh by {signal.Signals(-done.returncode).name}: {DAMAGED}"
    said = done.stderr.decode(errors="replace").strip().splitlines()
    return said[-1] if said else DAMAGED


def _read(name: str) -> MeshContent:
    with gmsh_model("body mesh") as gmsh:
        gmsh.merge(name)
        mesh = gmsh.model.mesh
        tags, points, _ = mesh.getNodes()
        kinds = mesh.getElementTypes(2)
        cells = mesh.getElementsByType(kinds[0])[1] if len(kinds) else []
        lines = [np.empty((0, 2), dtype=int)]
        curves = []
        for dimension, group in gmsh.model.getPhysicalGroups(1):
            for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, group):
                own = np.asarray(mesh.getElementsByType(LINE, entity)[1], dtype=int).reshape(-1, 2)
                lines.append(own)
                curves += [gmsh.model.getPhysicalName(dimension, group)] * len(own)
        names = [mesh.getElementProperties(kind)[0] for kind in kinds]
        solids = len(mesh.getElementTypes(3)) > 0
    texts = [np.array(each, dtype=str) for each in (names, curves)]
    arrays = (tags, np.reshape(points, (-1, 3)), kinds, texts[0], cells, solids, np.concatenate(lines), texts[1])
    return MeshContent(*map(np.asarray, arrays))


def _packed(content: MeshContent) -> bytes:
    """A line that says of what type and shape each array is, and all their bytes."""
    arrays = list(vars(content).values())
    kinds = json.dumps([(each.dtype.str, each.shape) for each in arrays])
    return b"".join([kinds.encode(), b"\n", *(each.tobytes() for each in arrays)])


def _unpacked(packed: bytes) -> MeshContent:
    kinds, _, content = packed.partition(b"\n")
    arrays = []
    place = 0
    for kind, shape in json.loads(kinds):
        arrays.append(np.ndarray(shape, kind, content, place))
        place += arrays[-1].nbytes
    return MeshContent(*arrays)


if __name__ == "__main__":
    for what, limit in ((resource.RLIMIT_AS, int(sys.argv[2])), (resource.RLIMIT_CORE, 0)):
        # Who started this may allow less, which can only be lowered.
        _, most = resource.getrlimit(what)
        resource.setrlimit(what, (limit if most == resource.RLIM_INFINITY else min(limit, most), most))
    try:
        content = _read(sys.argv[1])
    except Exception as error:  # gmsh raises nothing more precise
        sys.exit(str(error) or type(error).__name__)
    sys.stdout.buffer.write(_packed(content))
