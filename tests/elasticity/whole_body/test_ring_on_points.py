"""A ring on points against the whole ring in finite elements, against what it carries, and in its limits."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from tests.coarse_sector import relative
from tests.internal import ring
from tests.whole_gear import whole_gear_mesh

from fenics_gears import Material
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.condensation import by_radius, condense, without
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.elasticity.sector_mesh import sector_mesh
from fenics_gears.elasticity.whole_body.ring_on_points import ring_on_points
from fenics_gears.geometry.outline import rotation

STEEL = Material(206e3, 0.3)
COARSE = Discretisation("P2", 1.0, 4.0)
TEETH = 24
RING = ring(None, teeth=TEETH, tip=2.0 * TEETH - 2.0, outer=2.0 * TEETH + 12.0)
PITCH = 2.0 * pi / TEETH


def on_points(angles, springs=(4000.0, 1500.0), offsets=TEETH - 1, gear=RING):
    return ring_on_points(gear, STEEL, COARSE, (tuple(angles), springs), offsets).by_teeth(offsets)


@pytest.mark.parametrize("angles", [(0.0, 5.0 * PITCH, -8.0 * PITCH), (0.3 * PITCH, 6.8 * PITCH)])
def test_it_is_the_whole_ring_in_finite_elements(angles):
    """Brute force: all sectors in one mesh, assembled and condensed by DOLFINx and PETSc at once, springs added to the
    mean motions of its outer circle, and the system solved densely."""
    body = on_points(angles)
    sector = sector_mesh(RING, COARSE.sizes(RING))
    edges = {**sector.edges, "lower cut": sector.edges["upper cut"], "upper cut": sector.edges["lower cut"]}
    mesh = replace(whole_gear_mesh(replace(sector, edges=edges), TEETH), foundation=(0.0, 0.0))
    cuts = np.vstack([sector.edge_nodes(f"{name} cut", 2) for name in ("lower", "upper")])
    pad = without(sector.edge_nodes("hub", 2), cuts)
    loaded = by_radius(mesh.edge_nodes("flank 0", 2))
    other = by_radius(mesh.edge_nodes(f"flank {TEETH - 3}", 2))
    pads = {f"pad {number}": pad @ rotation(-number * PITCH).T for number in range(TEETH)}
    whole = condense(mesh, ELEMENTS["P2"], 0.3, {"loaded": loaded, "other": other, **pads})
    stiffness = whole.stiffness * STEEL.youngs_modulus
    for angle in angles:
        place = -angle / PITCH
        for number, share in ((int(np.floor(place)), 1.0 - place % 1.0), (int(np.floor(place)) + 1, place % 1.0)):
            dofs = whole.dofs(f"pad {number % TEETH}")
            outwards = pads[f"pad {number % TEETH}"] / np.linalg.norm(pad, axis=1)[:, None]
            for direction, spring in ((outwards, 4000.0), (outwards @ rotation(0.5 * pi).T, 1500.0)):
                mean = direction.ravel() / len(pad)
                stiffness[np.ix_(dofs, dofs)] += share * spring * np.outer(mean, mean)
    loads = np.eye(len(stiffness))[:, whole.dofs("loaded")]
    moved = np.linalg.solve(stiffness, loads)
    own = body.between(0, 0)
    assert relative(moved[whole.dofs("loaded")] - own, own) < 1e-8
    turn = np.kron(np.eye(len(other)), rotation(-3.0 * PITCH))
    assert relative(turn.T @ moved[whole.dofs("other")] - body.between(3, 0), own) < 1e-8


def test_points_carry_all_of_the_torque_of_every_tooth():
    """Equilibrium: the moments of the tangential forces and of those on a flank about the axis sum to zero."""
    body = on_points((0.1, 1.7, 2.9, 4.0))
    sector = sector_mesh(RING, COARSE.sizes(RING))
    flank = by_radius(sector.edge_nodes("flank", 2))
    moment = np.column_stack([-flank[:, 1], flank[:, 0]]).ravel()
    pad = sector.edge_nodes("hub", 2)
    cuts = np.vstack([sector.edge_nodes(f"{name} cut", 2) for name in ("lower", "upper")])
    lever = np.linalg.norm(without(pad, cuts), axis=1).mean()
    for tooth in range(TEETH):
        tangential = body.openings[tooth][1::2].sum(axis=0)
        assert np.abs(lever * tangential + moment).max() < 1e-10 * np.abs(moment).max()


def test_points_all_around_are_a_foundation_and_turn_with_the_ring():
    """Limit: as many points as teeth are an elastic foundation of the same stiffness per length, within what their pads
    make of it. Symmetry: points a tooth further on are the same ring, whose teeth are counted from the next one."""
    body = on_points(PITCH * np.arange(TEETH), (500.0, 200.0))
    own = body.between(0, 0)
    assert relative(body.between(7, 6) - body.between(1, 0), own) < 1e-9
    per_area = TEETH / (2.0 * pi * abs(RING.bore_radius) * STEEL.youngs_modulus)
    even = flank_compliance(replace(RING, foundation=(500.0 * per_area, 200.0 * per_area)), STEEL, COARSE, Reach(2))
    for offset in range(3):
        assert relative(body.between(offset, 0) - even.between(offset, 0), own) < 0.01
    one, turned = on_points((0.2, 2.0, 4.0)), on_points((0.2 - PITCH, 2.0 - PITCH, 4.0 - PITCH))
    assert relative(turned.between(6, 4) - one.between(5, 3), own) < 1e-9
    assert relative(one.between(5, 5) - one.between(3, 3), own) > 1e-3


@pytest.mark.parametrize("spring", [1e-2, 4e3, 1e12])
def test_it_is_the_same_from_another_even_ring(spring, monkeypatch):
    """Identity of Woodbury: for springs of any stiffness, from even ones a third as stiff at most."""
    own = on_points((0.1, 2.1), (spring, spring), 3).between(3, 1)
    monkeypatch.setattr("fenics_gears.elasticity.whole_body.ring_on_points.MOST_EVEN", 0.3)
    assert relative(on_points((0.1, 2.1), (spring, spring), 3).between(3, 1) - own, own) < 1e-10
