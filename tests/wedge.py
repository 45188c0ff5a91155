"""A wedge with a line load on its face, normal to its edge, in tensor products of second-order elements: nothing of the
program but its call of MUMPS. Coordinates: along the edge, along the end face (material below 0), and along the axis,
sheared by the wedge's angle; symmetric about the line of the load."""

from contextlib import closing

import numpy as np
from scipy import sparse

from fenics_gears.elasticity.mumps import Factor


def graded(least: float, largest: float, growth: float) -> np.ndarray:
    """Boundaries of elements from 0 to `largest`, the first of them `least` long, each so many times as long as the
    one before."""
    ends = [0.0]
    while ends[-1] + 1.3 * least < largest:
        ends.append(ends[-1] + least)
        least *= growth
    return np.array([*ends, largest])


def with_middles(ends: np.ndarray) -> np.ndarray:
    return np.insert(ends, np.arange(1, len(ends)), 0.5 * (ends[1:] + ends[:-1]))


def _along(ends: np.ndarray) -> dict[tuple[int, int], sparse.csr_matrix]:
    """Integrals of products of the functions of a line, by how often either is differentiated."""
    places, weights = np.polynomial.legendre.leggauss(3)
    shapes = {
        0: np.array([0.5 * places * (places - 1.0), 1.0 - places**2, 0.5 * places * (places + 1.0)]),
        1: np.array([places - 0.5, -2.0 * places, places + 0.5]),
    }
    found = {}
    for kinds in ((0, 0), (0, 1), (1, 0), (1, 1)):
        matrix = np.zeros(2 * (2 * len(ends) - 1,))
        for first, length in zip(2 * np.arange(len(ends) - 1), np.diff(ends)):
            own = slice(first, first + 3)
            scale = (0.5 * length) ** (1 - sum(kinds))
            matrix[own, own] += scale * (shapes[kinds[0]] * weights) @ shapes[kinds[1]].T
        found[kinds] = sparse.csr_matrix(matrix)
    return found


def _stiffness(axes: list[np.ndarray], slope: float, poissons_ratio: float) -> sparse.csr_matrix:
    """Young's modulus 1; dofs by component."""
    lines = [_along(ends) for ends in axes]
    # Of each gradient: how often a function is differentiated along each coordinate, and by which factor.
    gradients = ({(1, 0, 0): 1.0}, {(0, 1, 0): 1.0}, {(0, 0, 1): 1.0, (0, 1, 0): -slope})

    def form(one: int, other: int) -> sparse.csr_matrix:
        total = 0.0
        for left, factor in gradients[one].items():
            for right, second in gradients[other].items():
                each = [line[kinds] for line, kinds in zip(lines, zip(left, right))]
                total = total + factor * second * sparse.kron(each[2], sparse.kron(each[1], each[0]), "csr")
        return total

    shear = 0.5 / (1.0 + poissons_ratio)
    bulk = poissons_ratio / ((1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio))
    forms = [[form(one, other) for other in range(3)] for one in range(3)]
    shearing = shear * sum(forms[axis][axis] for axis in range(3))
    return sparse.bmat(
        [
            [bulk * forms[i][j] + shear * forms[j][i] + (shearing if i == j else 0.0 * forms[i][j]) for j in range(3)]
            for i in range(3)
        ],
        format="csr",
    )


def line_displacement(
    slope: float, poissons_ratio: float, least: float, largest: float, growth: float
) -> tuple[np.ndarray, np.ndarray]:
    """Distances from the edge along the line of the load (k,), and its displacement there (k,) along the face's normal
    under a unit line load, Young's modulus 1. `slope`: tangent of what the wedge's angle is more than a right one."""
    across, axis = graded(least, largest, growth), graded(least, largest, growth)
    stiffness = _stiffness([across, -across[::-1], axis], slope, poissons_ratio)
    counts = [2 * len(across) - 1, 2 * len(across) - 1, 2 * len(axis) - 1]
    nodes = int(np.prod(counts))
    at = np.arange(nodes).reshape(counts[::-1])
    cosine = 1.0 / np.hypot(1.0, slope)
    # Displacements along the edge, the normal and the line.
    same = sparse.identity(nodes)
    turned = sparse.bmat([
        [same, None, None], [None, cosine * same, cosine * slope * same], [None, -cosine * slope * same, cosine * same],
    ], format="csr")  # fmt: skip
    bottom = at[:, 0].ravel()
    held = [at[:, :, 0].ravel(), bottom, bottom + nodes, bottom + 2 * nodes, at[-1].ravel() + 2 * nodes]
    free = np.setdiff1d(np.arange(3 * nodes), np.concatenate(held))
    line = at[:, -1, 0] + nodes
    load = np.zeros(3 * nodes)
    # Half of the load is on the other half of the body.
    load[line] = -0.5 / cosine * np.asarray(_along(axis)[0, 0].sum(axis=1)).ravel()
    reduced = (turned.T @ stiffness @ turned).tocsr()[free][:, free]
    found = np.zeros(3 * nodes)
    with closing(Factor(reduced.tocsr(), "the wedge")) as factor:
        found[free] = factor.solve(load[free][:, None]).ravel()
    return with_middles(axis) / cosine, -found[line]


def softening(angle: float, poissons_ratio: float, least=0.02, largest=40.0, growth=2.0) -> float:
    """kappa (`elasticity.face.free_end`) of a wedge whose angle is `angle` degrees more than a right one."""
    places, moved = line_displacement(np.tan(np.radians(angle)), poissons_ratio, least, largest, growth)
    # Between the smallest elements and the size of the body: the ends of the third element.
    low, high = 6, 8
    slope = (moved[low] - moved[high]) / np.log(places[high] / places[low])
    return float(slope * np.pi / (2.0 * (1.0 - poissons_ratio**2)))
