"""Bodies of internal gears over the face."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse_sector import relative
from tests.elasticity.face.test_face_compliance import even_load, of_few_and_of_all_nodes
from tests.internal import ring

from fenics_gears import Material
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.face.compliance import face_compliance
from fenics_gears.elasticity.face.cost import expected_size
from fenics_gears.elasticity.face.discretisation import FaceDiscretisation

STEEL = Material(206e3, 0.3)
SPRINGS = (2e-3, 1e-3)
FACE = FaceDiscretisation(3.6, 2, 16.0, 0.003)


@pytest.mark.parametrize("springs", [None, SPRINGS])
def test_without_poissons_ratio_a_spur_ring_is_the_plane_one(springs):
    """Exact identity: under an even load nothing varies along the face, and nothing is held along it."""
    gear = ring(foundation=springs)
    body = face_compliance(gear, Material(206e3, 0.0), replace(FACE, twist=0.0), Reach(0))
    plane = body.plane.blocks[0]
    for component in (0, 1):
        wanted = plane[component::2, component::2]
        assert relative(even_load(body, component) - wanted, wanted) < 1e-9


@pytest.mark.nightly
def test_a_wide_spur_ring_tends_to_plane_strain():
    """Theory of elasticity: the ends' part falls as one over the width."""
    apart = []
    for width, layers in ((60.0, 4), (120.0, 8)):
        body = face_compliance(ring(), STEEL, FaceDiscretisation(3.6, layers, width), Reach(0))
        at = slice(2, None, 2)
        wanted = body.plane.blocks[0][::2, ::2][at, at]
        apart.append(relative(even_load(body, 0)[at, at] - wanted, wanted))
    assert apart[1] < 0.015
    assert apart[0] / apart[1] == pytest.approx(2.0, rel=0.1)


def test_a_stiff_foundation_holds_along_the_axis_too():
    """Limit: springs without end are a rigid outer circle, of a helical ring; the difference falls with the
    stiffness."""
    held = face_compliance(ring(), STEEL, FACE, Reach(1)).blocks
    errors = []
    for stiff in (1e3, 1e4):
        blocks = face_compliance(ring(foundation=(stiff, stiff)), STEEL, FACE, Reach(1)).blocks
        errors.append(relative(blocks - held, held))
    assert errors[1] < 1e-6
    assert errors[0] / errors[1] == pytest.approx(10.0, rel=0.1)


def test_a_ring_on_soft_springs_moves_as_a_rigid_one():
    """Statics of a helical ring on its springs, as stiff as they are small: by an axial force on all teeth by F/(k_t
    A)."""
    soft = 1e-9
    gear = ring(foundation=(soft, soft))
    body = face_compliance(gear, STEEL, FACE, Reach(30))
    count = len(body.heights) * len(body.roll_angle)
    axial = np.tile([0.0, 0.0, 1.0], count) / count
    # Of all 61 teeth: the loaded one and 30 on either side.
    moved = sum(axial @ block @ axial * (1.0 if number == 0 else 2.0) for number, block in enumerate(body.blocks))
    area = 2.0 * np.pi * abs(gear.bore_radius) * FACE.face_width
    assert moved == pytest.approx(61.0 / (soft * STEEL.youngs_modulus * area), rel=2e-3)


def test_few_nodes_of_a_cut_near_the_rim_stand_for_all(monkeypatch):
    """Brute force: the same ring with all nodes of the cuts; as expected before, within a fifth."""
    gear = ring(teeth=24, tip=46.0, outer=70.0, cutter=None)
    face = FaceDiscretisation(3.6, 4, 24.0, 0.006)
    _, whole = of_few_and_of_all_nodes(gear, face, monkeypatch)
    size = expected_size(gear, face)
    assert size.condensed == whole.timings["condensed_unknowns"]
    assert size.unknowns == pytest.approx(whole.timings["unknowns"], rel=0.2)
