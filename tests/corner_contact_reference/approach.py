"""Teeth alone at one position: how far the wheel turns under its couple, without friction."""

from dataclasses import replace

import numpy as np
from tests.contact.problems import pressed

from fenics_gears import GearPair, Scene, model_of
from fenics_gears.contact.corner import CornerContact
from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.places import touching
from fenics_gears.contact.tooth_pair import Flanks
from fenics_gears.contact.window import ContactGrid
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.scene.data import Accuracy

WHEEL_ROTATION = 5  # in CENTRE_COORDINATES


def teeth_alone(scene: Scene, accuracy: Accuracy = Accuracy()) -> Scene:
    return replace(
        scene, accuracy=accuracy, shafts=None, bearings=None, inertia=None, damping=None, friction=None,
        tip_relief=None,
        coast_flanks=None,
    )  # fmt: skip


def elastic_cycle(scene: Scene, corner: CornerContact | None, steps: int, cache: Cache | None = None) -> Cycle:
    """On finite elements, the wheel's rotation the only unknown."""
    model = model_of(scene)
    grid, resolution = model.resolution.contact_grid, model.resolution
    reach = touching(model.pair, grid, steps, corner=corner).reach
    compliances = tuple(
        flank_compliance(
            gear, scene.gears.material, Discretisation(resolution.element, resolution.flank_element_size), reach, cache
        )
        for gear in (model.pair.pinion, model.pair.wheel)
    )
    return rigid_hub_cycle(Flanks(model.pair, compliances), grid, steps, corner)


def rigid_hub_cycle(flanks: Flanks, grid: ContactGrid, steps: int, corner: CornerContact | None) -> Cycle:
    return Cycle(elastic_mesh(flanks, grid, corner), steps, [WHEEL_ROTATION], tangential=False)


def transmission_error(cycle: Cycle, pair: GearPair, couple: float, phase: float) -> tuple[float, float]:
    """Rad, of the wheel, at a phase (mesh cycles), and the pinion's couple over the wheel's."""
    operator = cycle.position(round(phase * cycle.steps)).operator
    solution = pressed(operator, couple / pair.wheel.base_radius)
    arms = [float(np.sum(arm * solution.forces)) for arm in operator.normal_lever_arms]
    return float(solution.coordinates[0]) / pair.wheel.base_radius, arms[0] / arms[1]
