"""Cheaper models of the mesh with the same drivetrain (`[accuracy] model`): a stiffness table, and stiffness by ISO
6336-1."""

from dataclasses import replace
from time import perf_counter

import numpy as np

from fenics_gears.contact.kinematics import CENTRE_COORDINATES
from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.spring_mesh import PairSprings, Springs, spring_mesh
from fenics_gears.contact.stiffness_table import LOADS, stiffness_table
from fenics_gears.contact.tooth_pair import COAST, DRIVE, coast_place, drive_place, facing_points_at
from fenics_gears.dynamics.drivetrain import ROTATIONS
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Bodies
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.iso_6336 import mesh_factor
from fenics_gears.model.drivetrain import mesh_stiffness
from fenics_gears.model.model import Model
from fenics_gears.system.job import Job
from fenics_gears.system.progress import Progress

from .bodies import gear_bodies
from .elastic_route import cycle_of, flanks_of

# Most phases of a table, which is linear between them.
MOST_PHASES = 200
# Without a load in the scene a table's loads are parts of the force that bends a pair by this part of the module.
DEFLECTION_WITHOUT_LOAD = 1e-3


def table_route(model: Model, progress: Progress, cache: Cache | None, job: Job | None = None) -> tuple[Bodies, Cycle]:
    bodies = gear_bodies(model, progress, cache)
    progress.stage("tabulate the mesh stiffness")
    return table_cycle(model, bodies)


def iso_route(model: Model, progress: Progress, cache: Cache | None, job: Job | None = None) -> tuple[tuple, Cycle]:
    return (), iso_cycle(model)


def table_cycle(model: Model, bodies: Bodies) -> tuple[Bodies, Cycle]:
    """The mesh cycle of a stiffness table of the full contact; the bodies' `time_condense` has what the table took."""
    begun = perf_counter()
    resolution = model.resolution
    full = Cycle(
        elastic_mesh(flanks_of(model, bodies), resolution.contact_grid, model.corner),
        min(resolution.steps_per_mesh_cycle, MOST_PHASES),
        [CENTRE_COORDINATES.index(ROTATIONS[1])],
        tangential=False,
    )
    force = model.pair.force_of(model.scene.load.wheel_torque)
    force = force or DEFLECTION_WITHOUT_LOAD * model.scene.gears.module * mesh_stiffness(model.scene, model.pair)
    table = stiffness_table(full, 0, force, LOADS)
    first, second = bodies
    spent = first.timings["time_condense"] + perf_counter() - begun
    first = replace(first, timings={**first.timings, "time_condense": spent})
    return (first, second), _cycle(model, table.springs, len(LOADS) - 1)


def iso_cycle(model: Model) -> Cycle:
    """The mesh cycle of pairs as stiff as ISO 6336-1 has them, on the theoretical path of contact, with gaps by
    material removed from the flanks. Of n pairs in mesh each has c' (0.75 n + 0.25)/n, so that the mean over the path
    is c_gamma_alpha."""
    single = mesh_stiffness(model.scene, model.pair)
    flanks = (DRIVE, COAST) if model.scene.coast_flanks is not None else (DRIVE,)

    def springs(phase: float) -> list[PairSprings]:
        of_pairs = []
        for flank in flanks:
            gaps = _gaps_on_path(model, flank, phase)
            each = single * mesh_factor(len(gaps)) / max(len(gaps), 1)
            of_pairs += [
                PairSprings(index, flank, np.zeros(1), np.array([gap]), np.array([each])) for index, gap in gaps.items()
            ]
        return of_pairs

    return _cycle(model, springs, 1)


def _cycle(model: Model, springs: Springs, levels: int) -> Cycle:
    return cycle_of(model, spring_mesh(model.pair, springs, levels, model.scene.coast_flanks is not None))


def _on_flank(gear: Gear, roll: float) -> bool:
    """Whether a roll angle (rad) is at the tip or below it: of an internal gear tips have the least."""
    tip = gear.tip_roll_angle
    return 0.0 < roll and gear.sign * (roll - tip) <= 1e-12 * tip


def _gaps_on_path(model: Model, flank: int, phase: float) -> dict[int, float]:
    """Gap (mm) of every pair whose flanks meet on the line of action at a phase, by its index."""
    pair = model.pair
    gaps = {}
    removal = model.removal if flank == DRIVE else (None, None)
    reach = int(np.ceil(pair.contact_ratio)) + 2
    for index in range(-reach, reach + 1):
        xi = pair.path_start + (phase + index) * pair.base_pitch
        place = (drive_place if flank == DRIVE else coast_place)(pair, index, xi)
        if all(_on_flank(side.gear, roll) for side, roll in zip(pair.sides, place.contact_rolls)):
            gaps[index] = float(facing_points_at(pair, removal, place, np.zeros(1))[2][0])
    return gaps
