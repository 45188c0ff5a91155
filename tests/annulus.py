"""A thick ring, condensed onto its two circles, and Lame's exact solution."""

from math import pi

import numpy as np
from tests.structured import cells_of

from fenics_gears.elasticity.condensation import condense
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.mesh_data import BodyMesh

BORE, OUTER = 15.0, 30.0
# (h/r)^2 and (h/r)^4 on 12 x 96 cells, h/r = 0.065: forces converge with twice the element's order.
TOLERANCE = {"P1": 0.065**2, "Q1": 0.065**2, "Q1 incompatible": 0.065**2, "P2": 0.065**4, "Q2": 0.065**4}


def annulus(corners: int, across: int = 12, around: int = 96) -> BodyMesh:
    radius, angle = np.meshgrid(
        np.geomspace(BORE, OUTER, across + 1), 2 * pi * np.arange(around) / around, indexing="ij"
    )
    points = np.stack([(radius * np.cos(angle)).ravel(), (radius * np.sin(angle)).ravel()], axis=-1)
    index = np.arange(len(points)).reshape(across + 1, around)
    index = np.hstack([index, index[:, :1]])
    rings = {name: np.stack([row[:-1], row[1:]], axis=-1) for name, row in (("hub", index[0]), ("rim", index[-1]))}
    return BodyMesh(points, cells_of(index, corners), rings)


def condensed_annulus(name: str, poissons_ratio: float):
    element, mesh = ELEMENTS[name], annulus(ELEMENTS[name].corners)
    points = {part: mesh.edge_nodes(part, element.order) for part in ("rim", "hub")}
    return condense(mesh, element, poissons_ratio, points)


def forces(body, field):
    """(n, 2) on the rim's nodes when both boundaries follow a displacement field of points (n, 2)."""
    displacement = np.concatenate([field(body.points[part]).ravel() for part in ("rim", "hub")])
    return (body.stiffness @ displacement)[body.dofs("rim")].reshape(-1, 2)


def error_under_pressure(name: str, poissons_ratio: float) -> float:
    """Relative error of the rim's forces when the rim grows by u_r = A r + B/r. sigma_r = 2 (lambda + G) A - 2 G
    B/r^2; work in a unit of growth u = x: 2 pi r^2 sigma_r, less 4 (lambda + G) A times what the mesh's polygon cuts
    off."""
    shear_modulus = 1.0 / (2.0 * (1.0 + poissons_ratio))
    first_lame = poissons_ratio / ((1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio))
    a, b = 1e-3, -1e-3 * BORE**2  # nothing moves at the bore

    def field(points):
        return points * (a + b / (points**2).sum(axis=1))[:, None]

    body = condensed_annulus(name, poissons_ratio)
    rim = body.points["rim"]
    stress = 2.0 * (first_lame + shear_modulus) * a - 2.0 * shear_modulus * b / OUTER**2
    circle = 2.0 * pi * OUTER**2 * stress
    sides = len(rim) // ELEMENTS[name].order
    cut_off = OUTER**2 * (pi - 0.5 * sides * np.sin(2.0 * pi / sides))
    exact = circle - 4.0 * (first_lame + shear_modulus) * a * cut_off
    return abs((forces(body, field) * rim).sum() / exact - 1.0)
