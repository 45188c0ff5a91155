"""What layers leave out near a load, and averages along oblique lines of contact."""

from dataclasses import replace

import numpy as np
import pytest
from tests.helical import helical_scene

from fenics_gears import model_of
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.face.compliance import face_compliance
from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.elasticity.face.near_field import thin_layers
from fenics_gears.elasticity.slice_averages import oblique_averages
from fenics_gears.elasticity.slice_compliance import SliceCompliance, along_normals
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material

WIDTH, TWIST = 9.0, 0.04
STEEL = Material(youngs_modulus=206e3, poissons_ratio=0.3)
# Slices that do not end where layers do, and their middles.
SLICES = 7
WIDTHS = np.full(SLICES, WIDTH / SLICES)
MIDDLES = WIDTH * ((np.arange(SLICES) + 0.5) / SLICES - 0.5)


def _along_normals(gear: Gear, layers: int, near: bool, flanks: int = 1) -> np.ndarray:
    """Compliance (S n, S n) of the last flank of a tooth's own slices, along the normals of its nodes."""
    division = FaceDiscretisation(0.4 * gear.module, layers, WIDTH, TWIST)
    body = face_compliance(gear, STEEL, division, Reach(0, (0, 0) if flanks == 2 else None))
    rise = (TWIST, -TWIST)[flanks - 1]

    def seen(heights):
        return oblique_averages(heights, MIDDLES, WIDTHS, body.roll_angle, rise)

    normals, missing = body.near.normals[flanks - 1], body.near.compliance[flanks - 1]
    more = [along_normals(seen(body.near.heights), missing, normals, (flanks - 1) * SLICES)] if near else []
    found = SliceCompliance(body.blocks, flanks * [seen(body.heights)], SLICES, more)
    last = len(found.values[0]) - SLICES + np.arange(SLICES)
    sections = np.array(np.meshgrid(last, last)).reshape(2, -1)
    found.find(np.zeros(SLICES**2, dtype=int), *sections)
    own = found.values[0, -SLICES:, -SLICES:].reshape(SLICES, SLICES, len(normals), len(normals), 3, 3)
    return np.einsum("stabnm,an,bm->satb", own, normals, normals).reshape(2 * (SLICES * len(normals),))


@pytest.mark.parametrize("flanks", [1, pytest.param(2, marks=pytest.mark.nightly)])
def test_thick_layers_and_what_they_leave_out_are_thin_layers(flanks):
    """Another route: a body of the thin layers all through. Thick ones alone are four parts in a hundred off."""
    gear = model_of(helical_scene(helix=8.0)).pair.pinion
    layers = 4
    thin = _along_normals(gear, layers * thin_layers(WIDTH / layers / gear.module), near=False, flanks=flanks)
    thick, whole = (_along_normals(gear, layers, near, flanks) for near in (False, True))
    scale = np.abs(thin).max()
    assert np.abs(thick - thin).max() > 0.03 * scale
    assert np.abs(whole - thin).max() < 0.001 * scale


def test_layers_leave_nothing_out_of_an_even_load():
    """Exact: without Poisson's ratio an even load moves a spur tooth alike all along the face, as any layers tell. Of
    the displacement in the plane, which `D` is added to."""
    gear = model_of(helical_scene(helix=0.0, accuracy="")).pair.pinion
    layers, thickness = 8, 1.7 * gear.module
    division = FaceDiscretisation(0.8 * gear.module, layers, layers * thickness)
    body = face_compliance(gear, replace(STEEL, poissons_ratio=0.0), division, Reach(0))
    ends = body.near.heights[::2]
    # Simpson's rule in each thin layer.
    even = np.convolve(np.repeat(np.diff(ends), 2) / 3.0, [0.5, 0.5])
    even[1::2] *= 2.0
    missing = body.near.compliance[0] @ np.repeat(even, len(body.roll_angle))
    assert np.abs(missing).max() < 0.003 * np.abs(body.plane.blocks[0]).max()


def test_oblique_averages_are_exact_for_what_layers_and_flanks_tell():
    """Exact: 1 and z; and the arc length of the profile where the line goes, by the rule of middles."""
    rolls = np.sqrt(np.linspace(0.1, 0.5, 9))
    heights = np.linspace(-0.5, 0.5, 9) * WIDTH
    rise = 0.01
    seen = oblique_averages(heights, MIDDLES, WIDTHS, rolls, rise)
    z, roll = (each.ravel() for each in np.meshgrid(heights, rolls, indexing="ij"))
    middle = np.repeat(MIDDLES, len(rolls))
    np.testing.assert_allclose(seen @ np.ones(len(z)), 1.0, rtol=1e-12)
    np.testing.assert_allclose(seen @ z, middle, atol=1e-12 * WIDTH)
    inner = np.tile(np.arange(len(rolls)), SLICES)
    inner = (inner > 0) & (inner < len(rolls) - 1)
    places = (np.arange(8) + 0.5) / 8 - 0.5
    expected = np.mean([(roll[: len(middle)] + rise * place * WIDTHS[0]) ** 2 for place in places], axis=0)
    np.testing.assert_allclose((seen @ roll**2)[inner], expected[inner], rtol=1e-12)
