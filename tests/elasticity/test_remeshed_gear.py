"""A gear meshed anew with prescribed flank nodes."""

from functools import lru_cache

import numpy as np
import pytest
from tests.coarse_sector import COARSE, PINION, STEEL, relative

from fenics_gears.elasticity.condensation import condense
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.remeshed_gear import LoadedTooth, RemeshedGear
from fenics_gears.elasticity.ring import centre_motion
from fenics_gears.elasticity.sector_boundary import flank_through
from fenics_gears.elasticity.sector_mesh import sector_mesh
from fenics_gears.geometry.involute import arc_length
from fenics_gears.geometry.outline import rotation
from meshes.root_crack import joined_sectors

ANGLE = 0.37
# Roll angles on two neighbouring teeth and on the third after them.
ROLLS = (np.array([0.45, 0.47, 0.5]), np.array([0.31, 0.28, 0.22, 0.2]), np.array([0.55, 0.6]))
PLACES = (0, 1, 3)


def loaded_teeth():
    return tuple(LoadedTooth(ANGLE + place * PINION.angular_pitch, rolls) for place, rolls in zip(PLACES, ROLLS))


@lru_cache
def whole_mesh(quadrilaterals: bool) -> BodyMesh:
    sectors = [sector_mesh(PINION, COARSE, quadrilaterals)] * PINION.teeth
    for tooth, rolls in zip(PLACES, ROLLS):
        sectors[tooth] = sector_mesh(PINION, COARSE, quadrilaterals, flank_through(PINION, COARSE.flank, rolls))
    gear = joined_sectors(sectors)
    return BodyMesh(gear.points @ rotation(ANGLE).T, gear.cells, gear.edges)


@pytest.mark.parametrize("name", ELEMENTS)
def test_joined_sectors_equal_the_remeshed_whole_gear(name):
    """Exact identity (hard case 6): the whole gear meshed and condensed with the same nodes."""
    element = ELEMENTS[name]
    body = RemeshedGear(PINION, STEEL, element, COARSE)
    stiffness = body.stiffness(loaded_teeth())
    mesh = whole_mesh(element.quadrilateral)
    wanted = np.vstack([body.contact_points(tooth.rolls) @ rotation(tooth.angle).T for tooth in loaded_teeth()])
    hub = mesh.edge_nodes("hub", element.order)
    whole = condense(mesh, element, STEEL.poissons_ratio, {"contact": wanted, "hub": hub})
    contact = 2 * len(wanted)
    tie = np.zeros((len(whole.stiffness), contact + 3))
    tie[:contact, :contact] = np.eye(contact)
    tie[contact:, contact:] = centre_motion(hub)
    expected = STEEL.youngs_modulus * tie.T @ whole.stiffness @ tie
    assert relative(stiffness - expected, expected) < 1e-9
    # Compliance weighs what the stiffness hides: the motion of a tooth as a whole.
    compliance = np.linalg.inv(expected[:contact, :contact])
    assert relative(np.linalg.inv(stiffness[:contact, :contact]) - compliance, compliance) < 1e-9


@pytest.mark.parametrize("size", [0.05, 0.3, 2.0])
def test_flank_through_prescribed_vertices(size):
    """By construction: every vertex, neighbours stay, no element larger than asked, an even number."""
    for prescribed in ROLLS:
        rolls = flank_through(PINION, size, prescribed)
        places = np.abs(rolls[:, None] - prescribed).argmin(axis=0)
        assert rolls[places] == pytest.approx(prescribed, abs=1e-15)
        assert np.ptp(places) == len(prescribed) - 1
        lengths = np.diff(arc_length(PINION.base_radius, rolls))
        outside = np.delete(lengths, np.arange(places.min(), places.max()))
        assert np.all(lengths > 0.0) and outside.max() <= size * (1 + 1e-9)
        assert len(lengths) % 2 == 0
        assert [rolls[0], rolls[-1]] == pytest.approx([PINION.form_roll_angle, PINION.tip_roll_angle], abs=1e-15)
