"""Two elastic blocks, meshed differently where they touch."""

import numpy as np
from tests.structured import cells_of

from fenics_gears.contact.interpolation import GearContacts, flank_interpolations
from fenics_gears.elasticity.condensation import condense
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.mesh_data import BodyMesh

# The involute of a circle of this radius (mm), a little off the circle: its radius of curvature is 1e6 mm, so that it
# is straight to
# 1e-13 over a millimetre, and its arc length 500 mm, so that round-off of places is no larger.
STRAIGHT = 1e9
CONTACT_ROLL = 1e-3


def block_mesh(name: str, along: int, across: int, height: float) -> BodyMesh:
    """1 mm wide, distorted inside: "flank" at y = 0, "back" at y = -height."""
    fraction = np.linspace(0.0, 1.0, along + 1)
    x, y = np.meshgrid(
        fraction + 0.03 * np.sin(2.0 * np.pi * fraction), np.linspace(-1.0, 0.0, across + 1), indexing="ij"
    )
    bump = 0.2 / max(along, across) * np.sin(2.0 * np.pi * x) * np.sin(np.pi * y)
    points = np.stack([(x + bump).ravel(), height * (y - bump).ravel()], axis=-1)
    index = np.arange(len(points)).reshape(along + 1, across + 1)
    edges = {part: np.stack([index[:-1, row], index[1:, row]], axis=-1) for part, row in (("flank", -1), ("back", 0))}
    return BodyMesh(points, cells_of(index, ELEMENTS[name].corners), edges)


def flank_of(mesh: BodyMesh, name: str, poissons_ratio: float) -> tuple[np.ndarray, np.ndarray]:
    """Places (n,), mm, of the flank's nodes and their compliance (n, n), mm per N/mm, E = 1 MPa; the back on
    rollers."""
    element = ELEMENTS[name]
    points = {part: mesh.edge_nodes(part, element.order) for part in ("flank", "back")}
    points = {part: each[np.argsort(each[:, 0])] for part, each in points.items()}
    body = condense(mesh, element, poissons_ratio, points)
    gliding = body.dofs("back")[0::2][1:]
    free = np.concatenate([body.dofs("flank"), gliding])
    compliance = np.linalg.inv(body.stiffness[np.ix_(free, free)])
    normal = np.arange(1, 2 * len(points["flank"]), 2)
    return points["flank"][:, 0], compliance[np.ix_(normal, normal)]


def straight_interpolation(offsets, places, order: int, sense: float):
    """The contact layer's averages on a straight flank; contact nodes from -1/2 to 1/2 mm."""
    middle = 0.5 * STRAIGHT * CONTACT_ROLL**2
    rolls = np.sqrt(2.0 * (middle + places - 0.5) / STRAIGHT)
    contact_rolls = np.sqrt(2.0 * (middle + sense * offsets) / STRAIGHT)
    ends, contact = np.array([0, len(offsets)]), np.array([CONTACT_ROLL])
    nodes = GearContacts(offsets, ends, contact_rolls, contact, [rolls], STRAIGHT, round(-sense), order)
    return flank_interpolations(nodes)[0].weights


def collocation(offsets, places, order: int, sense: float):
    """Values at the contact nodes: rows of the element's shape functions."""
    weights, vertices = np.zeros((len(offsets), len(places))), places[::order]
    at = np.clip(0.5 + sense * offsets, 0.0, 1.0)
    element = np.clip(np.searchsorted(vertices, at, side="right") - 1, 0, len(vertices) - 2)
    local = (at - vertices[element]) / np.diff(vertices)[element]
    shapes = {
        1: (1 - local, local),
        2: ((1 - local) * (1 - 2 * local), 4 * local * (1 - local), local * (2 * local - 1)),
    }
    for ahead, shape in enumerate(shapes[order]):
        weights[np.arange(len(offsets)), order * element + ahead] += shape
    return weights
