"""Stiffness of a section swept along a gear's face: wedges, products of the section's triangles and of layers, second
order in both.

A section's point X (a complex number X + iY) is at ``x = w(z) X`` at height z, where ``w`` interpolates ``exp(i twist
z_k)`` between the three heights z_k of a layer's nodes: the element is isoparametric, so that rigid motions and uniform
strains are exact. The displacement is ``sum_k N_k(z) u_k(X)``. Its gradient has the columns ``grad_X(u) W^-1`` and
``sum_k N_k'(z) u_k - grad_X(u) V X``, where W and V multiply by ``w`` and ``w'/w``: at a height, forms over the plane
section, whose products with N and N' give the layer. Layers of one thickness are alike but for a rotation.
"""

from __future__ import annotations

import numpy as np
import ufl
from scipy import sparse

from fenics_gears.elasticity import dolfinx_adapter as adapter
from fenics_gears.geometry.outline import rotation

from ..element_nodes import ElementNodes, dofs_of, element_nodes, numbers_at
from ..elements import ELEMENTS
from ..mesh_data import BodyMesh
from ..stiffness import assembled, nodes_at, stress_of_strain
from .layers import POINTS, WEIGHTS, Sweep, SweptWeb, shapes

ELEMENT = ELEMENTS["P2"]
# Of the section's coordinates times a gradient, squared.
QUADRATURE_DEGREE = 4


class SectionForms:
    """Bilinear forms of a section's displacements (n nodes of `nodes`, three components), Young's modulus 1 MPa.

    springs: (3n, 3n), of the foundation, per height; None where the hub is held. outside_web: forms of rim and hub
    alone, and its nodes' numbers (k,) in the whole section; None without a web.
    """

    def __init__(self, mesh: BodyMesh, poissons_ratio: float, web: SweptWeb | None = None):
        self.nodes: ElementNodes = element_nodes(mesh, ELEMENT)
        space = adapter.vector_space(adapter.create_mesh(mesh.points, mesh.cells), ELEMENT.order, components=3)
        self._order = dofs_of(nodes_at(space, self.nodes.points), 3)
        self._numbers = adapter.constant(space.mesh, (poissons_ratio, 1.0, 0.0, 0.0, 0.0))
        self._forms = _forms(space, *(self._numbers[i] for i in range(5)))

        self.springs: sparse.csr_matrix | None = None
        if mesh.foundation is not None:
            from ..foundation import section_springs

            self.springs = section_springs(mesh, self.nodes.points)
        self.outside_web: tuple[SectionForms, np.ndarray] | None = None
        if web is not None:
            # Imported here: gears without web have none of it.
            from .web import outside_web

            outside = SectionForms(outside_web(mesh, web), poissons_ratio)
            self.outside_web = outside, numbers_at(self.nodes.points, outside.nodes.points)

    def material(self, sweep: Sweep) -> np.ndarray:
        """Which nodes of the section (h, n) the body has at each height."""
        present = np.zeros((len(sweep.heights), len(self.nodes.points)), dtype=bool)
        for layer, within in enumerate(sweep.in_web):
            present[2 * layer : 2 * layer + 3] |= self.in_layer(within)
        return present

    def in_layer(self, within_web: bool) -> np.ndarray:
        """Which nodes of the section (n,) a layer has, within the web or outside it."""
        nodes = len(self.nodes.points)
        if within_web or self.outside_web is None:
            return np.ones(nodes, dtype=bool)
        return np.isin(np.arange(nodes), self.outside_web[1])

    def at(self, turn: complex, sweep: complex) -> tuple[sparse.csr_matrix, ...]:
        """Forms (3n, 3n) where w = `turn` and w'/w = `sweep`: of u and v, of u and dv/dz (rows: v), of du/dz and
        dv/dz."""
        inverse = 1.0 / turn
        self._numbers.value[1:] = inverse.real, inverse.imag, sweep.real, sweep.imag
        return tuple(self._assembled(form) for form in self._forms)

    def _assembled(self, form) -> sparse.csr_matrix:
        matrix = assembled(adapter.assemble_matrix(form))[self._order][:, self._order]
        matrix.sort_indices()
        return matrix


def _forms(space, poisson, a, b, c, d):
    """See `SectionForms.at`; 1/w = a + ib, w'/w = c + id."""
    trial, test = ufl.TrialFunction(space), ufl.TestFunction(space)
    inverse, sweep = ufl.as_matrix([[a, -b], [b, a]]), ufl.as_matrix([[c, -d], [d, c]])

    def along_section(u):
        plane = ufl.dot(ufl.grad(u), inverse)
        axial = -ufl.dot(ufl.grad(u), ufl.dot(sweep, ufl.SpatialCoordinate(space.mesh)))
        return ufl.sym(ufl.as_matrix([[plane[i, 0], plane[i, 1], axial[i]] for i in range(3)]))

    def along_height(u):
        return ufl.sym(ufl.as_matrix([[0.0 * u[i], 0.0 * u[i], u[i]] for i in range(3)]))

    section = ufl.dx(metadata={"quadrature_degree": QUADRATURE_DEGREE})
    pairs = ((along_section, along_section), (along_section, along_height), (along_height, along_height))
    return [
        adapter.compile_form(ufl.inner(stress_of_strain(of_trial(trial), poisson), of_test(test)) * section)
        for of_trial, of_test in pairs
    ]


Blocks = dict[tuple[int, int], sparse.csr_matrix]


def swept_stiffness(section: SectionForms, sweep: Sweep, motions: sparse.csr_matrix | None = None) -> sparse.csr_matrix:
    """Stiffness (3 n h, 3 n h), N/mm, of the swept body: dofs by height, then the section's node, then x, y, z in the
    section's frame. With `motions` (3n, r) of the section at each height (r h, r h), of these alone."""
    blocks = {kind: layer_of_kind(section, sweep.twist, kind) for kind in set(sweep.kinds)}
    if motions is not None:
        # Of one layer, not of the body: products of sparse matrices take as long as the factor.
        blocks = {kind: of_motions(each, motions) for kind, each in blocks.items()}
    heights = len(sweep.heights)
    size = 3 * len(section.nodes.points) if motions is None else motions.shape[1]
    # A block in every row and column, so that the matrix has all.
    rows = [[sparse.csr_matrix((size, size)) if 0 in (i, j) else None for j in range(heights)] for i in range(heights)]
    for layer, kind in enumerate(sweep.kinds):
        for (low, high), block in blocks[kind].items():
            row = rows[2 * layer + low]
            column = 2 * layer + high
            row[column] = block if row[column] is None else row[column] + block
    return sparse.bmat(rows, format="csr")


def of_motions(blocks: dict, motions: sparse.csr_matrix | np.ndarray) -> dict:
    """Blocks of a layer's stiffness (3n, 3n) on motions (3n, r) of its sections; dense where these are."""
    return {pair: motions.T @ (block @ motions) for pair, block in blocks.items()}


def layer_of_kind(section: SectionForms, twist: float, kind: tuple[float, bool]) -> Blocks:
    """`layer_stiffness` of one of `Sweep.kinds`."""
    thickness, within = kind
    return (layer_stiffness if within else _layer_outside_web)(section, thickness, twist)


def _layer_outside_web(section: SectionForms, thickness: float, twist: float) -> Blocks:
    """As `layer_stiffness`, of rim and hub alone."""
    assert section.outside_web is not None
    outside, numbers = section.outside_web
    own = dofs_of(numbers, 3)
    placed = sparse.csr_matrix(
        (np.ones(len(own)), (own, np.arange(len(own)))), shape=(3 * len(section.nodes.points), len(own))
    )
    blocks = layer_stiffness(outside, thickness, twist)
    return {pair: (placed @ block @ placed.T).tocsr() for pair, block in blocks.items()}


def layer_stiffness(section: SectionForms, thickness: float, twist: float) -> Blocks:
    """Blocks (3n, 3n) between the lower, middle and upper nodes of a layer, each in the section's frame at its own
    height."""
    angles = 0.5 * twist * thickness * np.array([-1.0, 0.0, 1.0])
    entries, factors = [], []
    for place, weight in zip(POINTS, WEIGHTS):
        values, slopes = shapes(place)
        slopes = slopes / (0.5 * thickness)
        turn = complex(values @ np.exp(1j * angles))
        change = complex(slopes @ np.exp(1j * angles))
        own, mixed, axial = section.at(turn, change / turn)
        volume = 0.5 * thickness * weight * abs(turn) ** 2
        # All forms have the section's pattern, so that their entries alone are added up.
        entries += [each.data for each in (own, mixed, mixed.T.tocsr(), axial)]
        pairs = (values, values), (slopes, values), (values, slopes), (slopes, slopes)
        factors += [volume * np.outer(*pair).ravel() for pair in pairs]
    added = (
        sparse.csr_matrix((data, own.indices, own.indptr), shape=own.shape)
        for data in np.transpose(factors) @ np.array(entries)
    )
    blocks = {divmod(number, 3): matrix for number, matrix in enumerate(added)}
    if section.springs is not None:
        for pair, springs in _springs_of_layer(section, thickness, angles).items():
            blocks[pair] = blocks[pair] + springs
    frames = [_turned(section, angle) for angle in angles]
    return {(i, j): (frames[i].T @ block @ frames[j]).tocsr() for (i, j), block in blocks.items()}


def _turned(section: SectionForms, angle: float) -> sparse.csr_matrix:
    """Rotation (3n, 3n) of the displacements of a section's nodes by an angle (rad)."""
    return sparse.kron(sparse.eye(len(section.nodes.points)), rotation(angle, 3), format="csr")


def _springs_of_layer(section: SectionForms, thickness: float, angles: np.ndarray) -> Blocks:
    """What the foundation adds to a layer, in the frame of its middle; `angles` (3,), rad, of its nodes' frames."""
    added: Blocks = {}
    for place, weight in zip(POINTS, WEIGHTS):
        values = shapes(place)[0]
        turn = complex(values @ np.exp(1j * angles))
        frame = _turned(section, float(np.angle(turn)))
        springs = 0.5 * thickness * weight * abs(turn) * (frame @ section.springs @ frame.T)
        for pair in np.ndindex(3, 3):
            added[pair] = added.get(pair, 0.0) + values[pair[0]] * values[pair[1]] * springs
    return added
