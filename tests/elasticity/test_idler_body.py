"""The body of an idler, loaded on one flank of a tooth by the first mate and on the other flank of a far tooth by the
second."""

import numpy as np
import pytest
from tests.trains import row
from tests.whole_gear import whole_gear_mesh

from fenics_gears import Material
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.condensation import by_radius, condense
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.elasticity.elements import element_named
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.elasticity.sector_mesh import sector_mesh
from fenics_gears.geometry.outline import centreline_angle, rotation

STEEL = Material(206e3, 0.3)
COARSE = Discretisation("P2", 0.8, 2.0)


@pytest.mark.parametrize("apart", [-4, 3, 6])
def test_flanks_of_an_idler_feel_each_other_as_in_the_whole_gear(apart):
    """The whole gear as one mesh, its bore held: no sectors, no harmonics, no mirror."""
    gear = row([20, 17, 25], [0, 20], 100).meshes[0].pair.wheel
    sector = sector_mesh(gear, COARSE.sizes(gear, both_flanks=True))
    turn = rotation(apart * gear.angular_pitch)
    points = {
        "drive": by_radius(sector.edge_nodes("flank", 2)) @ turn.T,
        "coast": by_radius(sector.edge_nodes("coast", 2)),
    }
    whole = whole_gear_mesh(sector, gear.teeth)
    held = condense(whole, element_named("P2"), 0.3, {**points, "hub": whole.edge_nodes("hub", 2)})
    flanks = np.concatenate([held.dofs("drive"), held.dofs("coast")])
    compliance = np.linalg.inv(held.stiffness[np.ix_(flanks, flanks)]) / STEEL.youngs_modulus
    nodes = len(points["drive"])
    axis = np.array([np.cos(centreline_angle(gear)), np.sin(centreline_angle(gear))])
    mirror = 2.0 * np.outer(axis, axis) - np.eye(2)
    into_tooth, into_mirror = (np.kron(np.eye(nodes), frame) for frame in (turn, mirror))
    expected = into_tooth.T @ compliance[: 2 * nodes, 2 * nodes :] @ into_mirror
    found = flank_compliance(gear, STEEL, COARSE, Reach(0, (apart - 1, apart + 1))).between(apart, 0, (0, 1))
    assert found == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())
