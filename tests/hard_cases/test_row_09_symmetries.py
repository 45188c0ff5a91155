"""Row 9: where a run starts, and which gear is called the pinion, must not matter."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import coarse_scene, frictionless, quasi_static, teeth_alone
from tests.coarse_sector import relative
from tests.contact.problems import pressed

from fenics_gears import model_of, simulate
from fenics_gears.contact.mesh import contact_operators
from fenics_gears.contact.operator import Passage
from fenics_gears.contact.pairing import CompliancePairing
from fenics_gears.contact.places import pair_places
from fenics_gears.contact.tooth_pair import COAST, DRIVE, Flanks, tooth_pairs
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.simulation.routes import prepared
from fenics_gears.system.progress import SilentProgress

PHASES = np.linspace(0.013, 0.987, 25)


@pytest.fixture(scope="module")
def scene(paper_scene):
    return coarse_scene(paper_scene)


def elastic(pair, scene, element="P1", coast_flank=False):
    """Flank compliances of both gears by finite elements."""
    return tuple(
        flank_compliance(
            gear, scene.gears.material, Discretisation(element, scene.accuracy.flank_element_size),
            Reach(5, (-5, 5) if coast_flank else None),
        )
        for gear in (pair.pinion, pair.wheel)
    )  # fmt: skip


def approach(flanks, pairing, grid, phase, force, flank=DRIVE):
    """Rotation of the wheel (mm on its base circle) under a force, the pinion held; and the forces of contact."""
    places = pair_places(flanks.pair, grid, phase % 1.0, coast_flanks=flank == COAST)
    pairs = tuple(tooth_pairs(flanks, grid, [place for place in places if place.flank == flank]))
    passage = Passage(pairs)
    (operator,) = contact_operators(flanks.pair, [passage], [5], pairing.responses([passage]))
    solution = pressed(operator, force)
    return solution.coordinates[0], solution.forces


@pytest.mark.parametrize("start", [39, *(pytest.param(each, marks=pytest.mark.nightly) for each in (1, 7, 23))])
@pytest.mark.parametrize("make", [frictionless, lambda scene: scene], ids=["frictionless", "friction"])
def test_any_start_angle(make, start, scene, measured):
    """Quasi-static gears forget where they began after two mesh cycles."""
    scene = make(quasi_static(replace(scene, motion=replace(scene.motion, mesh_cycles=3, recorded_cycles=1))))

    def begun_later(model, progress, cache):
        gears, cycle = prepared(model, SilentProgress(), cache)
        plain, between, number = cycle.position, cycle.between, cycle.pair_number
        cycle.position = lambda step: plain(step + start)
        cycle.between = lambda step, before: between(step + start, before + start)
        cycle.pair_number = lambda step, index: number(step + start, index)
        return gears, cycle

    usual = simulate(scene).transmission_error.values[:-1]
    later = simulate(scene, preparation=begun_later).transmission_error.values[:-1]
    change = relative(np.roll(later, start) - usual, usual)
    friction = scene.friction.coefficient if scene.friction else 0.0
    measured(f"start {start}/{len(usual)} of a mesh cycle later, mu = {friction:g}: difference", change, 1e-10)


@pytest.mark.parametrize("relieved", [False, True])
@pytest.mark.parametrize("element", ["P1", "P2"])
def test_gears_swapped(element, relieved, scene, measured):
    """Exact identity: turned by half a turn the pair is the wheel driving the pinion backwards; xi becomes L - xi."""
    model = model_of(teeth_alone(frictionless(scene)))
    pair, grid, force = model.pair, model.resolution.contact_grid, model.drivetrain.load[-1]
    swapped = replace(pair, pinion=pair.wheel, wheel=pair.pinion)
    reliefs = (lambda roll: 0.02 * np.maximum(roll - 0.5, 0.0), lambda roll: 0.03 * np.maximum(roll - 0.4, 0.0))
    removal = reliefs if relieved else (None, None)
    gears = elastic(pair, scene, element)
    here, there = Flanks(pair, gears, removal), Flanks(swapped, gears[::-1], removal[::-1])
    pairings, changes = (CompliancePairing(here), CompliancePairing(there)), []
    for phase in PHASES:
        usual, forces = approach(here, pairings[0], grid, phase, force)
        other, swapped_forces = approach(there, pairings[1], grid, pair.contact_ratio - phase, force)
        changes.append(max(abs(other / usual - 1.0), relative(np.sort(swapped_forces) - np.sort(forces), forces)))
    name = element + (", tip relief" if relieved else "")
    measured(f"gears swapped, {name}: difference of transmission error and forces", max(changes), 1e-10)
