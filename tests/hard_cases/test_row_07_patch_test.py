"""Row 7: two blocks pressed together by a uniform pressure, with contact nodes of a third spacing. Exact: the
pressure is the same at every contact node, and the blocks approach by F/W (H1 + H2)(1 - nu^2)/E."""

import numpy as np
import pytest
from tests.contact.problems import only_one_moves
from tests.two_blocks import block_mesh, collocation, flank_of, straight_interpolation

from fenics_gears.contact.interpolation import hat_integrals
from fenics_gears.contact.laws import Tolerance
from fenics_gears.contact.step_solver import cold_start, solve_step
from fenics_gears.elasticity.elements import ELEMENTS

POISSONS_RATIO, FORCE, HEIGHTS = 0.3, 1e-3, (1.0, 0.6)


def graded_offsets(cells: int) -> np.ndarray:
    """The places of a block's flank vertices, seen as offsets from -1/2 to 1/2 mm."""
    fraction = np.linspace(0.0, 1.0, cells + 1)
    return fraction + 0.03 * np.sin(2.0 * np.pi * fraction) - 0.5


def pressed(name: str, along, offsets, interpolation):
    """Largest error of the pressure and error of the approach, in parts of the exact ones."""
    order, compliance = ELEMENTS[name].order, np.zeros((len(offsets), len(offsets)))
    for cells, height, sense in zip(along, HEIGHTS, (-1.0, 1.0)):
        places, flank = flank_of(block_mesh(name, cells, max(cells // 2, 2), height), name, POISSONS_RATIO)
        weights = interpolation(offsets, places, order, sense)
        compliance += weights @ flank @ weights.T
    ones = np.ones((len(offsets), 1))
    problem = only_one_moves(compliance, ones, np.zeros(len(offsets)), FORCE)._replace(
        tolerance=Tolerance(1e-12, 1e-12)
    )
    solution = solve_step(problem, cold_start(problem.gap, np.zeros(len(offsets), dtype=int)))
    approach = FORCE * sum(HEIGHTS) * (1.0 - POISSONS_RATIO**2)
    pressure = solution.forces / hat_integrals(offsets)
    return np.abs(pressure / FORCE - 1.0).max(), abs(solution.coordinates[0] / approach - 1.0)


@pytest.mark.parametrize("name", ELEMENTS)
def test_matching_meshes(name, measured):
    """Both flanks and the contact nodes at the same places."""
    pressure, approach = pressed(name, (8, 8), graded_offsets(8), straight_interpolation)
    measured(f"matching meshes, {name}: pressure, approach", f"{pressure:.1g}, {approach:.1g}", "1e-10")
    assert pressure <= 1e-10
    assert approach <= 1e-10


@pytest.mark.parametrize("along", [(8, 11), (13, 6)])
@pytest.mark.parametrize("name", ELEMENTS)
def test_averages_pass_on_any_meshes(name, along, measured):
    """A uniform pressure through the averages is the elements' own consistent load, whatever the places."""
    pressure, approach = pressed(name, along, np.linspace(-0.5, 0.5, 8), straight_interpolation)
    measured(f"averages, {name}, {along[0]} on {along[1]} elements, 7 contact cells: pressure, approach",
             f"{pressure:.1g}, {approach:.1g}", "1e-10")  # fmt: skip
    assert pressure <= 1e-10
    assert approach <= 1e-10


@pytest.mark.parametrize("name", ELEMENTS)
def test_error_of_collocation(name, measured):
    """With values at points the same blocks do not pass; the error is on record."""
    pressure, approach = pressed(name, (8, 11), np.linspace(-0.5, 0.5, 8), collocation)
    measured(
        f"collocation, {name}, 8 on 11 elements, 7 contact cells: pressure, approach",
        f"{pressure:.1g}, {approach:.1g}",
        "recorded",
    )
    assert pressure > 1e-3


def test_uniform_pressure_on_an_involute_is_the_consistent_load(paper_pair, measured):
    """Brute-force quadrature of the element's shape functions."""
    from tests.contact.test_interpolation import interpolation_at

    errors = []
    for order in (1, 2):
        offsets, contact_roll, flank_rolls, interpolation = interpolation_at(paper_pair, 12.0, order)
        radius = paper_pair.pinion.base_radius
        forces = hat_integrals(offsets) @ interpolation.weights
        vertices = 0.5 * radius * flank_rolls[::order] ** 2
        expected = np.zeros_like(forces)
        local, share = np.polynomial.legendre.leggauss(60)
        for element, (start, end) in enumerate(zip(vertices[:-1], vertices[1:])):
            ends = sorted(_arc(radius, contact_roll, offset) for offset in offsets[[0, -1]])
            low, high = max(start, ends[0]), min(end, ends[1])
            if low >= high:
                continue
            arc = low + 0.5 * (local + 1.0) * (high - low)
            at = (arc - start) / (end - start)
            shapes = (1 - at, at) if order == 1 else ((1 - at) * (1 - 2 * at), 4 * at * (1 - at), at * (2 * at - 1))
            along = np.cos(contact_roll - np.sqrt(2.0 * arc / radius)) * 0.5 * share * (high - low)
            expected[order * element : order * element + order + 1] += [along @ shape for shape in shapes]
        errors.append(np.abs(forces - expected).max() / np.abs(expected).max())
    measured("uniform pressure on an involute: nodal forces", max(errors), 1e-10)


def _arc(radius: float, contact_roll: float, offset: float) -> float:
    from fenics_gears.contact.flank_at_height import roll_angle_at_height

    return 0.5 * radius * float(roll_angle_at_height(radius, contact_roll, radius - offset)) ** 2
