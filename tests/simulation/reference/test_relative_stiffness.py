"""The paper's elimination [22], [C.1] against the mixed form."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from tests.simulation.reference.relative_stiffness import RelativeStiffness

from fenics_gears.dynamics.time_integration import Scheme
from fenics_gears.model.drivetrain import drivetrain
from fenics_gears.scene.data import Motion

NODES = 6
RADII = (33.8, 50.7)
SIDES = [
    SimpleNamespace(number=number, sense=sense, gear=SimpleNamespace(base_radius=radius))
    for number, (sense, radius) in enumerate(zip((1, -1), RADII))
]
CASES = ("all", "no bearings", "no shafts", "bare", "static", "static bare")


def scene_of(scene, case):
    changes = {
        "no bearings": {"bearings": None},
        "no shafts": {"shafts": None},
        "bare": {"shafts": None, "bearings": None},
        "static": {"inertia": None, "damping": None},
        "static bare": {"shafts": None, "bearings": None, "inertia": None, "damping": None},
    }
    return replace(scene, **changes.get(case, {}))


def elastic_gears(seed):
    """Stiffness of two gears over normals, tangents and centre that costs rigid motions nothing; compliances and
    motions."""
    generator, gears = np.random.default_rng(seed), []
    for radius in RADII:
        factor = generator.normal(size=(2 * NODES, 2 * NODES))
        compliance = 1e-6 * (factor @ factor.T / NODES + np.eye(2 * NODES))
        motion = np.zeros((2 * NODES, 3))
        motion[:NODES, 0] = motion[NODES:, 1] = 1.0
        motion[:NODES, 2] = radius + generator.uniform(-0.7, 0.7, NODES)
        motion[NODES:, 2] = generator.uniform(5.0, 20.0, NODES)
        stiffness = np.linalg.inv(compliance)
        coupling = -stiffness @ motion
        gears.append(
            (np.block([[stiffness, coupling], [coupling.T, motion.T @ stiffness @ motion]]), compliance, motion)
        )
    return gears


def mixed_form(gears, coordinates, tangential):
    kept = 2 * NODES if tangential else NODES
    rigid = np.zeros((2 * NODES, 7))
    rigid[:, :3] = gears[0][2] / [1.0, 1.0, RADII[0]]
    rigid[:, 3:6] = gears[1][2] / [-1.0, -1.0, RADII[1]]
    return (gears[0][1] + gears[1][1])[:kept, :kept], rigid[:kept, coordinates]


@pytest.mark.parametrize("tangential", [True, False])
@pytest.mark.parametrize("case", CASES)
def test_elimination_equals_the_mixed_form(case, tangential, paper_scene, paper_pair):
    """Exact identity: K q + G^T p = F and u = G q - C p satisfy K u + p + f = 0 [C.1]. Where K is singular forces
    are in equilibrium, the free rotation at will."""
    shafts = drivetrain(scene_of(paper_scene, case), paper_pair)
    effective, generator = Scheme(shafts, 5e-5).stiffness, np.random.default_rng(7)
    gears = elastic_gears(3)
    compliance, rigid = mixed_form(gears, shafts.indices, tangential)
    force = shafts.load + generator.normal(size=len(shafts.load))
    forces = generator.uniform(100.0, 900.0, len(compliance))
    if "static" in case:
        forces, coordinates = balanced(effective, rigid, force, forces)
    else:
        coordinates = np.linalg.solve(effective, force - rigid.T @ forces)
    displacement = rigid @ coordinates - compliance @ forces
    reduced = RelativeStiffness([gear[0] for gear in gears], effective, shafts.indices, SIDES, tangential)
    residual = reduced.stiffness @ displacement + forces + reduced.load(force)
    scale = np.abs(reduced.stiffness).max() * np.abs(displacement).max()
    assert np.abs(residual).max() < 1e-11 * scale
    assert reduced.coordinates(force, displacement) == pytest.approx(
        coordinates, rel=1e-8, abs=1e-9 * np.abs(coordinates).max()
    )


def balanced(effective, rigid, force, forces):
    """Forces changed so that the free motion of a singular K does no work, and one of the solutions q."""
    values, vectors = np.linalg.eigh(effective)
    free = vectors[:, np.abs(values) < 1e-9 * max(values.max(), 1.0)]
    assert free.shape[1] == 1
    along = rigid @ free[:, 0]
    forces = forces + along * (free[:, 0] @ force - along @ forces) / (along @ along)
    coordinates = np.linalg.pinv(effective) @ (force - rigid.T @ forces) + 0.3 * free[:, 0]
    return forces, coordinates


@pytest.mark.nightly
def test_long_steps_lose_no_more_digits(paper_cases, both_routes):
    """Equilibrium: with the wheel's inertia vanishing its couple is the load's."""
    scene = replace(paper_cases["200 Hz"], motion=Motion(1e-6, 2, 1))
    reference = both_routes(scene)[1]
    couple = -reference.reaction_couple.sel(gear="wheel").values
    assert couple == pytest.approx(np.full_like(couple, scene.load.wheel_torque), rel=1e-9)
