"""Gears in six-node triangles, plane strain, in contact without friction: plain finite elements by NumPy and SciPy,
which share nothing with the program. Surfaces are found anew as they move, and pressed together by a penalty."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu
from tests.corner_contact_reference.calculix import PENALTY, Placed

from fenics_gears.scene.data import Material

# Points and weight of a triangle's quadrature, and of an edge's.
TRIANGLE = np.array([[1 / 6, 1 / 6], [2 / 3, 1 / 6], [1 / 6, 2 / 3]])
EDGE, EDGE_WEIGHTS = np.polynomial.legendre.leggauss(4)
# Corner, corner and middle of each side of a triangle.
SIDES = np.array([[0, 1, 3], [1, 2, 4], [2, 0, 5]])
# mm: how far apart surfaces are that are looked at.
NEAR = 0.05


def derivatives(points: np.ndarray) -> np.ndarray:
    """Of the six shape functions at points (q, 2): (q, 6, 2)."""
    x, y = points.T
    third = 1.0 - x - y
    zero = np.zeros_like(x)
    along_x = [1 - 4 * third, 4 * x - 1, zero, 4 * (third - x), 4 * y, -4 * y]
    along_y = [1 - 4 * third, zero, 4 * y - 1, -4 * x, 4 * x, 4 * (third - y)]
    return np.stack([np.stack(along_x, axis=1), np.stack(along_y, axis=1)], axis=2)


def on_edge(places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Shape functions (q, 3) of an edge, corner, corner, middle, at places from -1 to 1, and their derivatives."""
    values = np.stack([0.5 * places * (places - 1.0), 0.5 * places * (places + 1.0), 1.0 - places**2], axis=-1)
    return values, np.stack([places - 0.5, places + 0.5, -2.0 * places], axis=-1)


def stiffness(points: np.ndarray, cells: np.ndarray, material: Material) -> csc_matrix:
    """Of all nodes, N/mm per mm of face width."""
    modulus, ratio = material.youngs_modulus, material.poissons_ratio
    shear = modulus / (2.0 * (1.0 + ratio))
    lame = 2.0 * shear * ratio / (1.0 - 2.0 * ratio)
    law = np.array([[lame + 2 * shear, lame, 0.0], [lame, lame + 2 * shear, 0.0], [0.0, 0.0, shear]])
    of_cells = np.zeros((len(cells), 12, 12))
    for shape in derivatives(TRIANGLE):
        jacobian = np.einsum("cni,nj->cij", points[cells], shape)
        gradient = np.einsum("nj,cji->cni", shape, np.linalg.inv(jacobian))
        strain = np.zeros((len(cells), 3, 12))
        strain[:, 0, 0::2] = strain[:, 2, 1::2] = gradient[:, :, 0]
        strain[:, 1, 1::2] = strain[:, 2, 0::2] = gradient[:, :, 1]
        weight = np.linalg.det(jacobian) / 6.0
        of_cells += np.einsum("c,cia,ij,cjb->cab", weight, strain, law, strain, optimize=True)
    freedoms = (2 * cells[:, :, None] + np.arange(2)).reshape(len(cells), 12)
    rows, columns = np.repeat(freedoms, 12, axis=1), np.tile(freedoms, (1, 12))
    return csc_matrix((of_cells.ravel(), (rows.ravel(), columns.ravel())), shape=(2 * len(points),) * 2)


@dataclass(frozen=True)
class Surface:
    """The edges (e, 3) of a gear that may touch, by the numbers of its `nodes` (m,); where these are (m, 2), how they
    yield (2 m, 2 m) with the bore held, and the centre (2,) that the gear turns about."""

    nodes: np.ndarray
    edges: np.ndarray
    points: np.ndarray
    compliance: np.ndarray
    centre: np.ndarray

    def moved(self, angle: float, forces: np.ndarray) -> np.ndarray:
        """Places (m, 2) of the nodes with the bore turned, under forces (m, 2)."""
        # Rotations are so small that forces need not turn with the gear.
        arms = self.points - self.centre
        turned = np.cos(angle) * arms + np.sin(angle) * np.column_stack([-arms[:, 1], arms[:, 0]])
        return self.centre + turned + (self.compliance @ forces.ravel()).reshape(-1, 2)


def surface(body: Placed, material: Material) -> Surface:
    """What is left of a gear when all nodes but those of its touching edges are eliminated."""
    edges = body.mesh.cells[body.mesh.contact[:, :1], SIDES[body.mesh.contact[:, 1]]]
    nodes, inverse = np.unique(edges, return_inverse=True)
    free = np.setdiff1d(np.arange(len(body.points)), body.mesh.hub)
    freedoms = (2 * free[:, None] + np.arange(2)).ravel()
    wanted = np.searchsorted(freedoms, (2 * nodes[:, None] + np.arange(2)).ravel())
    solve = splu(stiffness(body.points, body.mesh.cells, material)[freedoms][:, freedoms]).solve
    compliance = np.empty((len(wanted), len(wanted)))
    for number, place in enumerate(wanted):
        load = np.zeros(len(freedoms))
        load[place] = 1.0
        compliance[number] = solve(load)[wanted]
    return Surface(nodes, inverse.reshape(edges.shape), body.points[nodes], compliance, body.centre)


@dataclass(frozen=True)
class Touching:
    """Places where two surfaces are near: weights of the nodes of both (k, m), normals (k, 2) out of the master,
    lengths (k,), and gaps (k,)."""

    slave: np.ndarray
    master: np.ndarray
    normals: np.ndarray
    lengths: np.ndarray
    gaps: np.ndarray


def touching(slave: Surface, master: Surface, at: tuple[np.ndarray, np.ndarray]) -> Touching:
    """Of quadrature points of the slave, the nearest places on the master's edges as both are `at`."""
    values, slopes = on_edge(EDGE)
    own = at[0][slave.edges]
    points = np.einsum("qn,eni->eqi", values, own)
    lengths = np.linalg.norm(np.einsum("qn,eni->eqi", slopes, own), axis=2) * EDGE_WEIGHTS
    found = []
    for edge, place in np.ndindex(points.shape[:2]):
        point = points[edge, place]
        for number in np.argsort(np.linalg.norm(at[1][master.edges[:, 2]] - point, axis=1))[:3]:
            corners = at[1][master.edges[number]]
            where = 0.0
            for _ in range(8):
                shape, slope = on_edge(np.array(where))
                tangent = slope @ corners
                where += float((point - shape @ corners) @ tangent / (tangent @ tangent))
            if abs(where) <= 1.0 + 1e-9:
                shape, slope = on_edge(np.array(where))
                tangent = slope @ corners
                # Edges go counter-clockwise round a gear: outwards is to their right.
                normal = np.array([tangent[1], -tangent[0]]) / np.linalg.norm(tangent)
                gap = float((point - shape @ corners) @ normal)
                if abs(gap) < NEAR:
                    found.append((edge, place, number, shape, normal, gap))
                    break
    slave_weights, master_weights = (np.zeros((len(found), len(each.nodes))) for each in (slave, master))
    for row, (edge, place, number, shape, _, _) in enumerate(found):
        slave_weights[row, slave.edges[edge]] = values[place]
        master_weights[row, master.edges[number]] = shape
    normals, gaps = np.array([each[4] for each in found]), np.array([each[5] for each in found])
    of_length = np.array([lengths[each[0], each[1]] for each in found])
    return Touching(slave_weights, master_weights, normals, of_length, gaps)


def couples_of(
    surfaces: Sequence[Surface], contacts: Sequence[tuple[int, int]], rotations: np.ndarray, rounds: int = 40
) -> np.ndarray:
    """Couples (n,), N mm per mm, on the bores of gears turned by rotations (n,), rad. Raises RuntimeError."""
    forces = [np.zeros((len(each.nodes), 2)) for each in surfaces]
    last = np.full(len(surfaces), np.inf)
    for _ in range(rounds):
        at = [each.moved(angle, force) for each, angle, force in zip(surfaces, rotations, forces)]
        places = [touching(surfaces[one], surfaces[other], (at[one], at[other])) for one, other in contacts]
        forces = _pressed(surfaces, contacts, places, forces)
        # A bore holds against the forces on the surface.
        arms = [each.points - each.centre for each in surfaces]
        couples = np.array(
            [-np.sum(arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]) for arm, force in zip(arms, forces)]
        )
        if np.abs(couples - last).max() < 1e-7 * np.abs(couples).max():
            return couples
        last = couples
    raise RuntimeError(f"contact has not settled after {rounds} rounds: {couples}")


def _pressed(surfaces, contacts, places, forces) -> list[np.ndarray]:
    """Forces on the nodes with which all gaps at these places are zero or open."""
    columns, gaps = [], []
    for (one, other), own in zip(contacts, places):
        pushes = [np.zeros((len(own.gaps), each.size)) for each in forces]
        pushes[one] += (own.slave[:, :, None] * own.normals[:, None, :]).reshape(len(own.gaps), -1)
        pushes[other] -= (own.master[:, :, None] * own.normals[:, None, :]).reshape(len(own.gaps), -1)
        columns.append(pushes)
        # The gap without the forces that it was found under.
        yielded = [each.compliance @ force.ravel() for each, force in zip(surfaces, forces)]
        gaps.append(own.gaps - sum(push @ motion for push, motion in zip(pushes, yielded)))
    pushes = [np.vstack([each[number] for each in columns]) for number in range(len(surfaces))]
    lengths = np.concatenate([each.lengths for each in places])
    free = np.concatenate(gaps)
    response = sum(push @ each.compliance @ push.T for push, each in zip(pushes, surfaces))
    # Forces of the places are pressure times length, and pressure is the penalty times the overlap.
    whole = response + np.diag(1.0 / (PENALTY * lengths))
    active = free < 0.0
    for _ in range(100):
        pressing = np.zeros(len(free))
        pressing[active] = np.linalg.solve(whole[np.ix_(active, active)], -free[active])
        touched = (active & (pressing > 0.0)) | (~active & (free + response @ pressing < 0.0))
        if np.array_equal(touched, active):
            return [(push.T @ pressing).reshape(-1, 2) for push in pushes]
        active = touched
    raise RuntimeError("no set of touching places was found")
