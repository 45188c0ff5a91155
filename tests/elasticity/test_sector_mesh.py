"""The sector mesh."""

import signal
from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest
from tests.coarse_sector import COARSE

from fenics_gears import ComputationError, Gear
from fenics_gears.elasticity.condensation import by_radius
from fenics_gears.elasticity.element_nodes import node_roll_angles
from fenics_gears.elasticity.element_sizes import ElementSizes, element_sizes
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.mesh_data import corner_areas, oriented
from fenics_gears.elasticity.sector_boundary import sector_boundary
from fenics_gears.elasticity.sector_mesh import filled, sector_mesh
from fenics_gears.geometry.involute import arc_length, canonical_point
from fenics_gears.geometry.outline import rotation


def standard_gear(teeth, module, shift, bore_share):
    reference = 0.5 * teeth * module + shift * module
    root = reference - 1.25 * module
    return Gear(teeth, module, radians(20.0), shift, reference + module, root, bore_share * root, 0.38 * module)


@pytest.mark.parametrize("name", ELEMENTS)
def test_cuts_are_congruent_node_for_node(name, pinion, coarse_sector):
    """Exact identity: turned by one pitch."""
    mesh, order = coarse_sector(name), ELEMENTS[name].order
    lower, upper = (by_radius(mesh.edge_nodes(cut, order)) for cut in ("lower cut", "upper cut"))
    np.testing.assert_allclose(lower @ rotation(2 * pi / pinion.teeth).T, upper, rtol=0, atol=1e-12 * pinion.tip_radius)


@pytest.mark.parametrize("name", ELEMENTS)
def test_flank_vertices_are_on_the_involute_even_in_arc_length(name, pinion, coarse_sector):
    """Exact identity: the involute, s = rb v^2/2."""
    mesh = coarse_sector(name)
    vertices = by_radius(mesh.points[mesh.edge_points("flank")])
    roll = node_roll_angles(pinion, vertices, 1)
    np.testing.assert_allclose(vertices, canonical_point(pinion.base_radius, roll), atol=1e-12 * pinion.tip_radius)
    # A sector is meshed in modules rounded to 12 decimals; near the base circle a roll angle is more sensitive than a
    # place.
    ends = pinion.base_radius * np.sqrt(1.0 + np.array([pinion.form_roll_angle, pinion.tip_roll_angle]) ** 2)
    np.testing.assert_allclose(np.linalg.norm(vertices[[0, -1]], axis=1), ends, rtol=0.0, atol=1e-12 * pinion.module)
    spacing = np.diff(arc_length(pinion.base_radius, roll))
    np.testing.assert_allclose(spacing, spacing.mean(), rtol=1e-10)


def area_within(corners):
    """Of polygons (..., n, 2)."""
    (x, y), (next_x, next_y) = (np.moveaxis(each, -1, 0) for each in (corners, np.roll(corners, -1, axis=-2)))
    return 0.5 * abs((x * next_y - y * next_x).sum())


@pytest.mark.parametrize("both_flanks", [False, True])
@pytest.mark.parametrize("name", ELEMENTS)
def test_cells_fill_the_outline(name, both_flanks, pinion):
    """Exact identity: shoelace formula, none folded; as many nodes on either cut, and on either flank where the sector
    is symmetric."""
    sizes = replace(COARSE, both_flanks=both_flanks)
    mesh = sector_mesh(pinion, sizes, ELEMENTS[name].quadrilateral)
    assert corner_areas(mesh.points, mesh.cells).min() > 0
    polygon = area_within(sector_boundary(pinion, sizes)[0].points)
    assert area_within(mesh.points[mesh.cells]) == pytest.approx(polygon, rel=1e-11)
    assert len(mesh.edges["upper cut"]) == len(mesh.edges["lower cut"])
    assert not both_flanks or len(mesh.edges["flank"]) == len(mesh.edges["coast"])


@pytest.mark.parametrize("name", ["P2", "Q2"])
@pytest.mark.parametrize(
    ("teeth", "module", "shift", "bore_share"),
    [(12, 1.0, 0.45, 0.1), (17, 10.0, 0.1, 0.97), (40, 1.0, 0.0, 0.5), (200, 10.0, -0.3, 0.1), (200, 1.0, 0.0, 0.97)],
)
def test_full_range_of_gears_can_be_meshed(name, teeth, module, shift, bore_share):
    """12 to 200 teeth, modules 1 to 10, root circle below and above the base circle, thin rims."""
    gear = standard_gear(teeth, module, shift, bore_share)
    element = ELEMENTS[name]
    mesh = sector_mesh(gear, element_sizes(gear, element, 0.08 * module), element.quadrilateral)
    assert corner_areas(mesh.points, mesh.cells).min() > 0
    assert len(mesh.edges["lower cut"]) == len(mesh.edges["upper cut"]) < 200


def test_folded_cell_is_refused():
    """A quadrilateral that crosses itself has no positive Jacobian in either orientation."""
    points = np.array([[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]])
    with pytest.raises(ComputationError, match="Jacobian"):
        oriented(points, np.array([[0, 1, 2, 3]]))


def test_gmsh_leaves_the_interrupt_handler_alone(pinion):
    """Ctrl-C must keep what was done (docs/promises.md)."""

    def handler(number, frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, handler)
    try:
        sector_mesh(pinion, ElementSizes(flank=1.0, fillet=1.0, coast=2.0, body=4.0))
        assert signal.getsignal(signal.SIGINT) is handler
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("recombine", [False, True])
@pytest.mark.parametrize("size", [0.5, 0.8])
def test_outlines_that_differ_by_round_off_have_the_same_mesh(pinion, size, recombine):
    """Exact identity: two routes reach one outline by sums of different order."""
    boundary, field = sector_boundary(
        pinion.of_module_one, ElementSizes(flank=size, fillet=0.4, coast=1.0, body=3.0).in_modules_of(pinion)
    )
    outline = boundary.points[::2] if recombine else boundary.points
    points, cells = filled(outline, field, 2.0 if recombine else 1.0, recombine)
    last_bit = np.random.default_rng(0).integers(-1, 2, outline.shape)
    moved, same_cells = filled(outline * (1.0 + 2.0**-52 * last_bit), field, 2.0 if recombine else 1.0, recombine)
    assert moved[: len(outline)] == pytest.approx(outline, abs=1e-13)
    assert np.array_equal(moved[len(outline) :], points[len(outline) :])
    assert all(np.array_equal(one, other) for one, other in zip(cells, same_cells, strict=True))
