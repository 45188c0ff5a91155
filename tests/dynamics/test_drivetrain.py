"""The drivetrain's matrices against the paper's own, and what an absent section leaves out."""

from dataclasses import replace

import numpy as np
import pytest

from fenics_gears.dynamics.average_acceleration import AverageAcceleration, State
from fenics_gears.model.drivetrain import drivetrain


def from_twist(coordinates):
    """The program's coordinates per phi1, phi2, phi3 of the paper: its last one is the twist phi3 - phi2."""
    change = np.eye(len(coordinates))
    change[coordinates.index("shaft_twist"), coordinates.index("rotation_2")] = -1.0
    return change


def test_effective_stiffness_is_the_papers(paper_scene, paper_pair):
    """[17] and [20]: undamped, with phi3 eliminated, the effective stiffness of either gear."""
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


def test_load_history_is_the_papers(paper_scene, paper_pair):
    """[18]: the terms that a step takes over from the state before, pinion rows."""
    scene = replace(paper_scene, damping=None)
    shafts, step = drivetrain(scene, paper_pair), 5e-5
    rng = np.random.default_rng(0)
    state = State(*rng.normal(size=(3, 7)))
    load = AverageAcceleration(shafts, step).load(state, shafts.load)
    history = 4 * state.position / step**2 + 4 * state.velocity / step + state.acceleration
    assert load[:2] == pytest.approx(scene.inertia.mass * history[:2], rel=1e-12)
    inertia = scene.inertia.moment_of_inertia / paper_pair.pinion.base_radius**2
    assert load[2] == pytest.approx(inertia * history[2], rel=1e-12)


def test_rayleigh_damping_is_the_papers(paper_scene, paper_pair):
    """[26]-[28]: alpha k + beta m on the diagonal, -alpha k_s between phi2 and phi3."""
    shafts = drivetrain(paper_scene, paper_pair)
    to_angles = np.diag(shafts.radii) @ from_twist(shafts.coordinates)
    damping = to_angles.T @ shafts.damping @ to_angles
    alpha, beta = 0.4e-3, 0.5e-3
    ks, kb = paper_scene.shafts.torsional_stiffness, paper_scene.bearings.stiffness
    m, j = paper_scene.inertia.mass, paper_scene.inertia.moment_of_inertia
    expected = np.diag(
        [alpha * kb + beta * m] * 2
        + [alpha * ks + beta * j]
        + [alpha * kb + beta * m] * 2
        + [alpha * ks + beta * j] * 2
    )
    expected[5, 6] = expected[6, 5] = -alpha * ks
    assert damping == pytest.approx(expected, rel=1e-12, abs=1e-6)


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


def test_velocity_and_acceleration_follow_the_average_acceleration_rule():
    """[14]: both update formulas hold at the end of a step."""
    rng = np.random.default_rng(1)
    from fenics_gears.dynamics.drivetrain import Drivetrain

    shafts = Drivetrain(("rotation_2",), np.ones(1), np.eye(1), np.ones(1), np.eye(1), None)
    step = 0.01
    before, position = State(*rng.normal(size=(3, 1))), rng.normal(size=1)
    after = AverageAcceleration(shafts, step).advance(before, position)
    assert after.position == pytest.approx(before.position + 0.5 * step * (before.velocity + after.velocity))
    assert after.velocity == pytest.approx(before.velocity + 0.5 * step * (before.acceleration + after.acceleration))
