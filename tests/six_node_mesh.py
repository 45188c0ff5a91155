"""Six-node triangles between a gear's outline and its bore, by gmsh; not the program's."""

import numpy as np

from fenics_gears.elasticity.gmsh_session import gmsh_model


def unit(angles) -> np.ndarray:
    return np.stack([np.cos(angles), np.sin(angles)], axis=-1)


def with_middles(ends: np.ndarray) -> np.ndarray:
    """Ends of edges (k + 1,) and their middles in turn (2 k + 1,)."""
    return np.insert(ends, np.arange(1, len(ends)), 0.5 * (ends[1:] + ends[:-1]))


def along(curve: np.ndarray) -> np.ndarray:
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))])


def points_at(curve: np.ndarray, at: np.ndarray) -> np.ndarray:
    return np.stack([np.interp(at, along(curve), curve[:, i]) for i in range(2)], axis=-1)


def six_node_mesh(outline: np.ndarray, bore: np.ndarray, size):
    """Points (n, 2), cells (m, 6), corners, then middles of sides 01, 12, 20, and nodes along both curves. outline,
    bore: closed, clockwise, ends and middles in turn; `size(points)`: mm, wanted at (k, 2)."""
    corners, triangles = _triangles(outline[::2], bore[::2], size)
    sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    ends, place = np.unique(sides, axis=0, return_inverse=True)
    points = np.vstack([corners, corners[ends].mean(axis=1)])
    cells = np.hstack([triangles, len(corners) + place.reshape(-1, 3)])
    middle_of = {(int(a), int(b)): len(corners) + i for i, (a, b) in enumerate(ends)}
    return (
        points,
        cells,
        [_put_on(points, middle_of, curve, first) for curve, first in ((outline, 0), (bore, len(outline) // 2))],
    )


def _put_on(points, middle_of, curve, first) -> np.ndarray:
    number = len(curve) // 2
    nodes = np.empty(len(curve), dtype=int)
    for i in range(number):
        a, b = first + i, first + (i + 1) % number
        nodes[2 * i : 2 * i + 2] = a, middle_of[min(a, b), max(a, b)]
    points[nodes[1::2]] = curve[1::2]
    return nodes


def _triangles(outline: np.ndarray, bore: np.ndarray, size) -> tuple[np.ndarray, np.ndarray]:
    """Corner nodes, those of outline and bore first, and triangles between the two polygons."""
    with gmsh_model("section") as gmsh:
        loops, tags = [], []
        for curve in (outline, bore):
            own = [gmsh.model.geo.addPoint(x, y, 0.0) for x, y in curve]
            loops.append([gmsh.model.geo.addLine(a, b) for a, b in zip(own, own[1:] + own[:1])])
            tags += own
        gmsh.model.geo.addPlaneSurface([gmsh.model.geo.addCurveLoop(loop) for loop in loops])
        gmsh.model.geo.synchronize()
        for loop in loops:
            for line in loop:
                gmsh.model.mesh.setTransfiniteCurve(line, 2)
        gmsh.model.mesh.setSizeCallback(lambda dim, tag, x, y, z, lc: float(size(np.array([[x, y]]))[0]))
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.removeSizeCallback()
        numbers, coordinates, _ = gmsh.model.mesh.getNodes()
        _, _, cells = gmsh.model.mesh.getElements(2)
        ends = [int(gmsh.model.mesh.getNodes(0, tag)[0][0]) for tag in tags]
    order = {tag: i for i, tag in enumerate(ends)}
    for tag in numbers:
        order.setdefault(int(tag), len(order))
    corners = np.empty((len(order), 2))
    corners[[order[int(tag)] for tag in numbers]] = np.reshape(coordinates, (-1, 3))[:, :2]
    triangles = np.array([order[int(tag)] for tag in cells[0]]).reshape(-1, 3)
    a, b, c = (corners[triangles[:, i]] for i in range(3))
    clockwise = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0] < 0.0
    triangles[clockwise] = triangles[clockwise][:, [0, 2, 1]]
    return corners, triangles
