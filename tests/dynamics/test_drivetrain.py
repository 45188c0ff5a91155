"""The drivetrain's matrices."""

from dataclasses import replace

import numpy as np
import pytest

from fenics_gears.dynamics.average_acceleration import AverageAcceleration
from fenics_gears.model.drivetrain import drivetrain


def from_twist(coordinates):
    """Coordinates per phi1, phi2, phi3 of the paper: the last one is the twist phi3 - phi2."""
    change = np.eye(len(coordinates))
    change[coordinates.index("shaft_twist"), coordinates.index("rotation_2")] = -1.0
    return change


def test_effective_stiffness_is_the_papers(paper_scene, paper_pair):
    """[17] and [20]: undamped, with phi3 eliminated."""
    scene = replace(paper_scene, damping=None)
    shafts, step = drivetrain(scene, paper_pair), 5e-5
    scheme = AverageAcceleration(shafts, step)
    to_angles = np.diag(shafts.radii) @ from_twist(shafts.coordinates)
    effective = to_angles.T @ scheme.stiffness @ to_angles
    condensed = effective[:6, :6] - np.outer(effective[:6, 6], effective[6, :6]) / effective[6, 6]
    m, j = scene.inertia.mass, scene.inertia.moment_of_inertia
    kb, ks = scene.bearings.stiffness, scene.shafts.torsional_stiffness
    translation = 4 * m / step**2 + kb
    expected = [
        translation,
        translation,
        4 * j / step**2 + ks,
        translation,
        translation,
        4 * j / step**2 + 4 * j * ks / (4 * j + step**2 * ks),
    ]
    assert np.diag(condensed) == pytest.approx(expected, rel=1e-12)
    assert np.abs(condensed - np.diag(np.diag(condensed))).max() <= 1e-9 * min(expected)


def test_absent_sections_have_no_coordinates_and_no_matrices(paper_scene, paper_pair):
    """An effect that the scene does not name is not constructed."""
    bare = replace(paper_scene, shafts=None, bearings=None, inertia=None, damping=None)
    shafts = drivetrain(bare, paper_pair)
    assert shafts.coordinates == ("rotation_2",)
    assert shafts.mass is None and shafts.damping is None
    assert shafts.load == pytest.approx([437e3 / paper_pair.wheel.base_radius])
    assert shafts.free_motion == pytest.approx([1.0])
    with_bearings = drivetrain(replace(bare, bearings=paper_scene.bearings), paper_pair)
    assert with_bearings.coordinates == ("centre_x1", "centre_y1", "centre_x2", "centre_y2", "rotation_2")
    with_shafts = drivetrain(replace(bare, shafts=paper_scene.shafts), paper_pair)
    assert with_shafts.coordinates == ("rotation_1", "rotation_2", "shaft_twist")
    in_angles = from_twist(with_shafts.coordinates).T @ (with_shafts.load * with_shafts.radii)
    assert in_angles == pytest.approx([0.0, 0.0, 437e3], abs=1e-9)
