"""Row 8: Hertz line contact (K. L. Johnson, Contact Mechanics, 1985, 4.2) at the paper's pitch point, a half-width b
spanning 2, 4 and 8 flank elements h. One tooth pair alone, over loads and positions that move the contact across
nodes and elements: the worst error counts."""

from functools import lru_cache

import numpy as np
import pytest
from tests.coarse import teeth_alone
from tests.contact.problems import pressed as under

from fenics_gears import model_of
from fenics_gears.contact.mesh import contact_operators
from fenics_gears.contact.operator import Passage
from fenics_gears.contact.pairing import CompliancePairing
from fenics_gears.contact.tooth_pair import Flanks, drive_place, tooth_pairs
from fenics_gears.contact.window import ContactGrid
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.model.resolution import hertz_half_width, plane_contact_modulus, relative_radius
from fenics_gears.results.mesh_curves import without_oscillation
from fenics_gears.scene.accuracy import NODE_SPACING

NIGHTLY = pytest.mark.nightly
LIMITS = {2: 0.04, 4: 0.01, 8: 0.005}
# Loads in parts of the one whose half-width is `ratio` elements; where the contact point lies, in parts of an element.
LOADS, SHIFTS = np.linspace(1.0, 1.25, 6) ** 2, (0.0, 0.3)


@pytest.fixture(scope="module")
def errors(paper_scene):
    """Errors of peak (nodal, averaged) and half-width (cases, 3), for an element and b/h."""
    scene = teeth_alone(paper_scene)
    pair, material = model_of(scene).pair, scene.gears.material
    nominal = scene.load.wheel_torque / pair.wheel.base_radius
    modulus = plane_contact_modulus(scene)

    def half_width(force, xi):
        return hertz_half_width(force / pair.face_width, relative_radius(pair, xi), modulus)

    @lru_cache
    def of(element, ratio, node_spacing=NODE_SPACING):
        size = half_width(nominal, pair.pitch_point) / ratio
        gears = (
            flank_compliance(gear, material, Discretisation(element, size), Reach(0))
            for gear in (pair.pinion, pair.wheel)
        )
        flanks, found = Flanks(pair, tuple(gears)), []
        for load in LOADS:
            for shift in SHIFTS:
                xi, force = pair.pitch_point + shift * size, load * nominal
                offsets, pressure = pressed(flanks, xi, force, node_spacing * size, 3.0 * half_width(force, xi))
                peak = 2.0 * force / pair.face_width / (np.pi * half_width(force, xi))
                # Second moment of the elliptic pressure: b^2/4; the nodes' own functions have none.
                centre = pressure @ offsets / pressure.sum()
                moment = pressure @ (offsets - centre) ** 2 / pressure.sum()
                found.append((
                    pressure.max() / peak - 1.0,
                    without_oscillation(pressure).max() / peak - 1.0,
                    2.0 * np.sqrt(moment) / half_width(force, xi) - 1.0,
                ))  # fmt: skip
        return np.abs(found)

    return of


def pressed(flanks, xi, force, spacing, length):
    """Offsets (n,), mm, and pressures (n,), MPa, of the contact nodes of one pair under a force."""
    cells = 2 * int(np.ceil(0.5 * length / spacing))
    (nodes,) = tooth_pairs(flanks, ContactGrid(cells * spacing, cells + 1), [drive_place(flanks.pair, 0, xi)])
    passage = Passage((nodes,))
    (operator,) = contact_operators(flanks.pair, [passage], [5], CompliancePairing(flanks).responses([passage]))
    solution = under(operator, force)
    return nodes.offsets, solution.forces / (nodes.lengths * flanks.pair.face_width)


@pytest.mark.parametrize("ratio", LIMITS)
@pytest.mark.parametrize("element", ["P2", pytest.param("Q2", marks=NIGHTLY)])
def test_peak_pressure(element, ratio, errors, measured):
    """The peak of the averaged pressure, at its worst; the nodal values' own for comparison."""
    nodal, averaged, _ = errors(element, ratio).max(axis=0)
    measured(f"{element}, b/h = {ratio}: peak pressure, averaged (nodal)", f"{100 * averaged:.2g} % "
        f"({100 * nodal:.2g} %)",
             f"{100 * LIMITS[ratio]:g} %")  # fmt: skip
    assert averaged <= LIMITS[ratio]


@pytest.mark.parametrize("element", ["P2", pytest.param("Q2", marks=NIGHTLY)])
def test_order_of_the_half_width(element, errors, measured):
    """Known order: at least 1, from the worst errors at b/h = 2, 4, 8."""
    worst = [errors(element, ratio)[:, 2].max() for ratio in LIMITS]
    orders = np.log2(np.array(worst[:-1]) / worst[1:])
    measured(
        f"{element}: half-width, error at b/h = 2, 4, 8",
        ", ".join(f"{100 * error:.2g} %" for error in worst),
        "recorded",
    )
    measured(f"{element}: half-width, order", ", ".join(f"{order:.2g}" for order in orders), "at least 1")
    assert orders.min() >= 1.0


def test_average_keeps_cubics_and_removes_what_alternates():
    """Exact: weights (-1, 4, 10, 4, -1)/16 reproduce cubics and vanish on (-1)^j; ends stay."""
    places = np.arange(12.0)
    cubic = 3.0 + 2.0 * places - 0.7 * places**2 + 0.1 * places**3
    np.testing.assert_allclose(without_oscillation(cubic), cubic, rtol=1e-13)
    np.testing.assert_allclose(without_oscillation(cubic + (-1.0) ** places)[2:-2], cubic[2:-2], rtol=1e-13)
    np.testing.assert_array_equal(without_oscillation(cubic[:4]), cubic[:4])
