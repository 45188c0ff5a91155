"""Bodies of internal gears: a ring without teeth against exact solutions, one with teeth against the whole ring."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from tests.coarse_sector import relative
from tests.internal import ring
from tests.whole_gear import whole_gear_compliance, whole_gear_mesh

from fenics_gears import Material
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.condensation import condense, held_nodes
from fenics_gears.elasticity.element_sizes import Discretisation, ElementSizes
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.elasticity.mesh_data import BodyMesh, oriented
from fenics_gears.elasticity.recovery import gear_recovery
from fenics_gears.elasticity.ring import condensed_sector, ring_compliance
from fenics_gears.elasticity.sector_mesh import sector_mesh
from fenics_gears.geometry.outline import rotation

STEEL = Material(206e3, 0.3)
COARSE = Discretisation("P2", 0.5, 2.5)


def annulus(inner: float, outer: float, foundation=None, radial: int = 5, around: int = 180) -> BodyMesh:
    """A whole ring without teeth."""
    angles = 2.0 * pi / around * np.arange(around)
    radii = np.linspace(inner, outer, radial + 1)
    points = (radii[:, None, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)).reshape(-1, 2)
    number = np.arange(len(points)).reshape(radial + 1, around)
    ahead = np.roll(number, -1, axis=1)
    low, right, left, high = (each.ravel() for each in (number[:-1], ahead[:-1], number[1:], ahead[1:]))
    cells = np.vstack([np.column_stack([low, right, high]), np.column_stack([low, high, left])])
    edges = {name: np.column_stack([number[row], ahead[row]]) for name, row in (("inner", 0), ("hub", -1))}
    return BodyMesh(points, oriented(points, cells), edges, foundation=foundation)


def inner_motion(mesh: BodyMesh, order: int) -> float:
    """Radial motion of the inner circle, in its own harmonic, under a pressure cos(n phi) there, E = 1 MPa."""
    inner = mesh.edge_nodes("inner", 2)
    body = condense(mesh, ELEMENTS["P2"], 0.3, {"inner": inner, **held_nodes(mesh, 2)})
    corners = len(inner) // 2
    length = np.linalg.norm(np.diff(mesh.points[mesh.edges["inner"][0]], axis=0))
    # Simpson's rule along the edges: of their ends, then of their middles.
    weights = length * np.repeat([1.0 / 3.0, 2.0 / 3.0], corners)
    outwards = inner / np.linalg.norm(inner, axis=1)[:, None]
    wave = np.cos(order * np.arctan2(inner[:, 1], inner[:, 0]))
    load = (outwards * (wave * weights)[:, None]).ravel()
    moved = np.linalg.solve(body.between("inner", "inner"), load)
    return float(load @ moved / (weights @ wave**2))


def michell(order: int, inner: float, outer: float, springs, poissons_ratio: float = 0.3) -> float:
    """Radial motion of the inner circle under a pressure cos(n phi) on it, outer circle on springs (radial,
    tangential): J. H. Michell's series in plane strain, E = 1; for n = 0 Lame's ring."""
    shear = 0.5 / (1.0 + poissons_ratio)
    kappa = 3.0 - 4.0 * poissons_ratio
    n = order
    radial, tangential = springs
    if n == 0:
        # u = a r + b/r; sigma_r = 2 G ((a/(1 - 2 nu)) - b/r^2).
        stress = np.array([[1.0 / (1.0 - 2.0 * poissons_ratio), -1.0 / r**2] for r in (inner, outer)]) * 2.0 * shear
        rows = np.array([stress[0], stress[1] + radial * np.array([outer, 1.0 / outer])])
        a, b = np.linalg.solve(rows, [-1.0, 0.0])
        return a * inner + b / inner
    # Stress functions r^m cos(n phi): stresses, and displacements of Barber, Elasticity, table 9.1.
    moves = {
        n: (-n, n), -n: (n, n), n + 2: (kappa - 1.0 - n, kappa + 1.0 + n), 2 - n: (kappa - 1.0 + n, n - kappa - 1.0),
    }  # fmt: skip
    rows = np.zeros((4, 4))
    motion = np.zeros(4)
    for column, (m, (along, around)) in enumerate(moves.items()):
        for place, r in enumerate((inner, outer)):
            direct = (m - n**2) * r ** (m - 2.0)
            shearing = n * (m - 1.0) * r ** (m - 2.0)
            moved = np.array([along, around]) * r ** (m - 1.0) / (2.0 * shear)
            held = np.array([radial, tangential]) * moved if place else 0.0 * moved
            rows[2 * place : 2 * place + 2, column] = np.array([direct, shearing]) + held
            if not place:
                motion[column] = moved[0]
    return float(motion @ np.linalg.solve(rows, [-1.0, 0.0, 0.0, 0.0]))


@pytest.mark.parametrize("springs", [(3e-4, 1e-4), (1e-6, 2e-6), None])
@pytest.mark.parametrize("order", [0, 2, 3, 6])
def test_a_ring_without_teeth_moves_as_the_exact_solution(order, springs):
    """Lame (n = 0) and Michell (n = 2, 3, 6): radial motion under a pressure cos(n phi), on an elastic foundation and
    held, within 0.2 %, what straight edges of 2 degrees cut off."""
    expected = michell(order, 120.0, 140.0, springs or (1e9, 1e9))
    assert inner_motion(annulus(120.0, 140.0, springs), order) == pytest.approx(expected, rel=2e-3)


def test_a_ring_of_sectors_is_the_whole_internal_gear():
    """Brute force: all 24 teeth meshed and condensed at once."""
    gear = ring(None, teeth=24, tip=46.0, outer=60.0)
    mesh = sector_mesh(gear, ElementSizes(flank=1.0, fillet=0.6, coast=1.5, body=3.0))
    own = ring_compliance(condensed_sector(mesh, ELEMENTS["P2"], 0.3), -24, 2) / STEEL.youngs_modulus
    whole = whole_gear_mesh(BodyMesh(mesh.points, mesh.cells, clockwise(mesh.edges)), 24)
    for offset in (1, 2):
        # Sectors of an internal gear are counted clockwise, those of the whole mesh counter-clockwise.
        brute = whole_gear_compliance(
            whole, replace(gear, teeth=24, bore_radius=-60.0), STEEL, loaded_tooth=24 - offset, tooth_offsets=offset
        )
        assert relative(brute.blocks[0] - own[0], own[0]) < 1e-9
        assert relative(brute.blocks[offset].T - own[offset], own[offset]) < 1e-9


def clockwise(edges):
    return {**edges, "lower cut": edges["upper cut"], "upper cut": edges["lower cut"]}


def test_a_stiff_foundation_holds_and_a_soft_one_gives():
    """Limits: springs without end are a rigid outer circle, and the difference falls with the stiffness; on soft ones
    the rim gives way."""
    held = flank_compliance(ring(), STEEL, COARSE, Reach(1)).blocks
    errors = []
    for stiff in (1e6, 1e7):
        springs = (stiff / STEEL.youngs_modulus,) * 2
        on_springs = flank_compliance(ring(foundation=springs), STEEL, COARSE, Reach(1)).blocks
        errors.append(relative(on_springs - held, held))
    assert errors[1] < 1e-3 and errors[0] / errors[1] == pytest.approx(10.0, rel=0.1)
    soft = flank_compliance(ring(foundation=(1e-3, 1e-3)), STEEL, COARSE, Reach(1)).blocks
    assert np.trace(soft[0]) > 1.5 * np.trace(held[0])
    both = flank_compliance(ring(foundation=(1e-3, 1e-3)), STEEL, COARSE, Reach(1, (-1, 1))).blocks
    assert relative(both[0] - soft[0], soft[0]) < 0.02


def test_similar_internal_gears_share_one_compliance():
    """Similarity: twice the module, and springs half as stiff per area, give the same displacement per line force."""
    one = ring(foundation=(2e-3, 1e-3))
    lengths = ("module", "tip_radius", "root_radius", "bore_radius", "rack_tip_radius")
    twice = replace(one, foundation=(1e-3, 5e-4), **{name: 2.0 * getattr(one, name) for name in lengths})
    first = flank_compliance(one, STEEL, COARSE, Reach(0)).blocks
    second = flank_compliance(twice, STEEL, Discretisation("P2", 1.0, 5.0), Reach(0)).blocks
    assert relative(second - first, first) < 1e-9


@pytest.mark.parametrize("springs", [None, (2e-3, 1e-3)])
def test_recovered_displacement_is_that_of_the_compliance(springs):
    """Two routes: the recovered flank moves as the compliance says; the rim's outer circle is held, or is not."""
    gear = ring(foundation=springs)
    body = flank_compliance(gear, STEEL, COARSE, Reach(1))
    rng = np.random.default_rng(1)
    force = rng.normal(size=(len(body.roll_angle), 2))
    with gear_recovery(gear, STEEL, COARSE) as recovery:
        sectors = recovery.recovered({0: force}, [0, 1])
        flank = recovery.sector.flank_nodes("flank")
        for sector in (0, 1):
            moved = sectors.displacement[sector, 0][flank].ravel()
            assert relative(moved - body.blocks[sector] @ force.ravel(), moved) < 1e-7
        hub = np.abs(sectors.displacement[0, 0][recovery.sector.hub]).max()
        assert (hub == 0.0) == (springs is None)
    assert rotation(gear.angular_pitch)[1, 0] < 0.0
