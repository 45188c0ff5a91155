"""Displacement and stress of a gear from forces on its flanks."""

from functools import lru_cache

import numpy as np
import pytest
from scipy.interpolate import LinearNDInterpolator
from tests.coarse_sector import PINION, STEEL
from tests.elasticity.flank_pressure import pressed
from tests.whole_gear import whole_gear_mesh

from fenics_gears.elasticity.dolfinx_adapter import node_coordinates
from fenics_gears.elasticity.element_nodes import dofs_of
from fenics_gears.elasticity.element_sizes import Discretisation, ElementSizes
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.recovery import GearRecovery, gear_recovery
from fenics_gears.elasticity.sector import plane_sector
from fenics_gears.elasticity.sector_mesh import sector_mesh
from fenics_gears.elasticity.stiffness import assembled, displacement_space, nodes_at, stiffness_matrix
from fenics_gears.geometry.involute import arc_length, canonical_normal, canonical_point, roll_angle_at_arc_length
from fenics_gears.geometry.outline import rotation

# The identities hold on any mesh.
COARSE = {name: Discretisation(name, 0.9, 3.0) for name in ELEMENTS}
RANDOM = np.random.default_rng(7)


def forces_on(recovery) -> dict[int, np.ndarray]:
    """On both flanks."""
    count = 4 * len(recovery.sector.flank_nodes("flank"))
    return {0: RANDOM.normal(size=count), 1: RANDOM.normal(size=count)}


@pytest.fixture(scope="module", params=ELEMENTS)
def loaded(request):
    with gear_recovery(PINION, STEEL, COARSE[request.param], coast_flank=True) as recovery:
        forces = forces_on(recovery)
        yield recovery, forces, recovery.recovered(forces), ELEMENTS[request.param]


def test_every_node_of_the_gear_is_in_equilibrium(loaded):
    """Exact identity: K u = f with the stiffness of the whole gear meshed as one body; the hub holds forces and
    torque."""
    recovery, forces, body, element = loaded
    mesh, points, hub = recovery.sector.mesh, recovery.sector.section.points, recovery.sector.hub
    space = displacement_space(whole_gear_mesh(mesh, PINION.teeth), element)
    stiffness = assembled(stiffness_matrix(space, element, STEEL.poissons_ratio))
    moved, force, held = np.zeros(stiffness.shape[0]), np.zeros(stiffness.shape[0]), []
    for tooth in range(PINION.teeth):
        turn = rotation(tooth * PINION.angular_pitch)
        dofs = dofs_of(nodes_at(space, points @ turn.T))
        moved[dofs] = STEEL.youngs_modulus * (body.displacement[tooth, 0] @ turn.T).ravel()
        if tooth in forces:
            force[dofs] += (recovery.loads(forces[tooth]).reshape(-1, 2) @ turn.T).ravel()
        held.append(dofs_of(nodes_at(space, points[hub] @ turn.T)))
    residual = stiffness @ moved - force
    on_hub = residual.copy()
    residual[np.concatenate(held)] = 0.0
    assert np.abs(residual).max() < 1e-9 * np.abs(force).max()
    x, y = node_coordinates(space).T

    def resultant(values):
        along, across = values.reshape(-1, 2).T
        return np.array([along.sum(), across.sum(), (x * across - y * along).sum()])

    total = resultant(force)
    assert np.abs(resultant(on_hub - residual) + total).max() < 1e-9 * np.abs(total).max()


def test_stress_of_a_linear_displacement_is_exact(loaded):
    """Patch test: a linear displacement has one stress."""
    recovery, *_ = loaded
    strain, turn = np.array([[1.2e-3, 0.4e-3], [0.4e-3, -0.7e-3]]), 0.5e-3
    gradient = strain + turn * np.array([[0.0, -1.0], [1.0, 0.0]])
    nu = STEEL.poissons_ratio
    factor = 1.0 / ((1.0 + nu) * (1.0 - 2.0 * nu))
    xx = factor * ((1.0 - nu) * strain[0, 0] + nu * strain[1, 1])
    yy = factor * ((1.0 - nu) * strain[1, 1] + nu * strain[0, 0])
    xy = strain[0, 1] / (1.0 + nu)
    expected = np.array([[xx, xy, 0.0], [xy, yy, 0.0], [0.0, 0.0, nu * (xx + yy)]])
    points = recovery.sector.section.points
    found = recovery.stress.at_nodes((points @ gradient.T)[None])[0]
    np.testing.assert_allclose(found, np.broadcast_to(expected, found.shape), atol=1e-12)


def test_neighbouring_sectors_have_the_same_stress_on_their_common_cut(loaded):
    """Exact identity: averages on a cut count the elements on both of its sides."""
    recovery, _, body, _ = loaded
    (lower, upper), turn = recovery.sector.cuts, rotation(PINION.angular_pitch, 3)
    for tooth in range(PINION.teeth):
        ahead = turn @ body.stress[(tooth + 1) % PINION.teeth, 0, lower] @ turn.T
        assert np.abs(body.stress[tooth, 0, upper] - ahead).max() < 1e-9 * np.abs(body.stress).max()


def fine_recovery(name: str, size: float, depth: float) -> GearRecovery:
    """The pinion with flank elements of a size (mm) down to `depth` times it below the flank."""
    sizes = ElementSizes(flank=size, fillet=0.4, coast=0.6, body=1.5, depth=depth).in_modules_of(PINION)
    mesh = sector_mesh(PINION.of_module_one, sizes, ELEMENTS[name].quadrilateral)
    return GearRecovery(PINION, STEEL, plane_sector(mesh, ELEMENTS[name], STEEL.poissons_ratio))


MIDDLE = arc_length(PINION.base_radius, 0.5 * (PINION.form_roll_angle + PINION.tip_roll_angle))
PRESSURE = 1000.0


@lru_cache
def hertz(half_width: float, elements: int) -> tuple[float, float]:
    """Largest shear stress over p0 below a Hertz pressure, and its depth over the half-width (mm)."""

    def pressure(arc):
        return PRESSURE * np.sqrt(np.maximum(1.0 - ((arc - MIDDLE) / half_width) ** 2, 0.0))

    with fine_recovery("P2", half_width / elements, 1.2 * elements) as recovery:
        stress, points = recovery.recovered({0: pressed(recovery, pressure)}).stress[0, 0], recovery.points
    shear = np.sqrt((0.5 * (stress[:, 0, 0] - stress[:, 1, 1])) ** 2 + stress[:, 0, 1] ** 2)
    roll = roll_angle_at_arc_length(PINION.base_radius, MIDDLE)
    centre, inwards = canonical_point(PINION.base_radius, roll), -canonical_normal(roll)
    near = np.linalg.norm(points - centre, axis=1) < 4.0 * half_width
    depths = np.linspace(0.3, 1.6, 261)
    line = LinearNDInterpolator(points[near], shear[near])(centre + half_width * depths[:, None] * inwards)
    return float(np.nanmax(line)) / PRESSURE, float(depths[np.nanargmax(line)])


def test_shear_is_largest_below_the_surface_as_hertz_says():
    """0.300 p0 at 0.786 b (Johnson, Contact Mechanics, 1985, 4.2a). Bending adds in proportion to b at one p0: two
    widths take it out. Second order: (h/b)^2 = 1/25; the flat maximum's depth is as good as the distance of nodes,
    b/5."""
    (wide, _), (narrow, depth) = hertz(0.2, 5), hertz(0.1, 5)
    assert abs(2.0 * narrow - wide - 0.300) < 0.300 / 25
    assert abs(depth - 0.786) < 0.2
    assert 0.0 < narrow - 0.300 < wide - 0.300
