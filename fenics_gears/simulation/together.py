"""Runs of a search or a study whose numbers alone are asked for: those that share contact operators are solved
together."""

import time
from collections.abc import Collection, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from fenics_gears.contact.gaps_of_rows import GapsOfRows
from fenics_gears.contact.mesh_cycle import Cycle, Gaps
from fenics_gears.contact.relief_gaps import Profiles
from fenics_gears.contact.row import RowCycle
from fenics_gears.dynamics.march import Marcher
from fenics_gears.effects import ALONG_THE_FACE, common_period, effects_on
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.model.cost import expected_cost, too_large
from fenics_gears.model.model import RELIEFS, Model, differ_only
from fenics_gears.model.row_model import RowModel
from fenics_gears.model.train import TrainModel
from fenics_gears.model.train_parts import ERRORS_OF_SETS
from fenics_gears.results.contact_variables import mesh_variables
from fenics_gears.results.extrema import repeating_steps
from fenics_gears.results.planetary import OF_SETS, result_of_set
from fenics_gears.results.side_by_side import SideBySide
from fenics_gears.results.together import OFFERED, NumbersOfRun, equations_of, nodes_of, numbers_together, runs_smoothly
from fenics_gears.system.memory import SHARE_KEPT, SHARE_OF_A_BLOCK, give_back
from fenics_gears.system.progress import SilentProgress

from .elastic_route import deviations_of, openings_of, reliefs_apart
from .routes import Preparation
from .simulate import memory_for_operators
from .train import KeptRow, cycle_of_row, of_mesh
from .warm_up import compile_kernels


def can_be_solved_together(model: Model | TrainModel, asked: Collection[str]) -> bool:
    """Whether the numbers `asked` of a run can be had so: of a quasi-static pair of elastic teeth, all alike, under a
    constant load; and those of a planetary set by itself, in the plane and without friction."""
    if not isinstance(model, Model):
        row = model.rows[0]
        by_itself = len(model.rows) == 1 and row.shafts.carrier is not None and set(asked) == OF_SETS
        steady = row.drivetrain.mass is None and not row.friction
        evenly = all(own.scene.wheel_points is None for own in row.models)
        deviations = (each for own in row.models for each in deviations_of(own))
        return (
            by_itself
            and steady
            and evenly
            and not row.over_face
            and all(hasattr(each, "of_runs") for each in deviations)
        )
    scene = model.scene
    drivetrain = model.drivetrain
    teeth_alike = reliefs_apart(model) and common_period(scene) == 1
    steady = drivetrain.mass is None and drivetrain.rolling is None and not model.loads
    own = scene.output.root_stress or scene.accuracy.target is not None or scene.speed_ramp is not None
    gaps = any(effect.gaps for effect in effects_on(scene))
    # Friction that can lock the teeth is looked at step by step.
    locking = model.friction_coefficient * model.pair.wheel.tip_roll_angle >= 1.0
    held = scene.friction is None or repeating_steps(model) > 0
    return OFFERED.issuperset(asked) and teeth_alike and steady and held and not (own or gaps or locking)


def alike(one: Model | TrainModel, other: Model | TrainModel) -> bool:
    """Whether the runs of two models with the same contact operators differ in nothing but load, reliefs and
    what opens the flanks along the face; of sets in load, places of pins, run-out and pitches."""
    if not (isinstance(one, Model) and isinstance(other, Model)):
        return isinstance(one, TrainModel) and isinstance(other, TrainModel) and _sets_alike(one.rows[0], other.rows[0])
    return one.scene is other.scene or differ_only(one.scene, other.scene, ("load", *RELIEFS, *ALONG_THE_FACE))


def solved_together(
    models: Sequence[Model], preparation: Preparation, asked: Collection[str]
) -> list[NumbersOfRun | None]:
    """The numbers `asked` of runs that can be solved together and are `alike`; None of a run that has to be run by
    itself. Raises GearsError as `simulate` does."""
    model = models[0]
    try:
        most = memory_for_operators(expected_cost(model), partial(too_large, model))
        _, cycle = preparation(model, SilentProgress(), user_cache())
        cycle.kept.most = most
        compile_kernels(model.scene.friction is not None)
        involutes = cycle.with_gaps(Gaps())
        at_once = _most_at_once(model, cycle)
        numbers = []
        for first in range(0, len(models) if at_once else 0, max(at_once, 1)):
            some = models[first : first + at_once]
            gaps = Profiles(involutes, [each.removal for each in some], [openings_of(each, involutes) for each in some])
            numbers += numbers_together(some, involutes, gaps, asked)
        return numbers or [None] * len(models)
    finally:
        give_back()


def _sets_alike(one: RowModel, other: RowModel) -> bool:
    carriers = [
        None if each is None else replace(each, pin_errors=(), run_outs=(), pitches=(), torque=0.0)
        for each in (one.shafts.carrier, other.shafts.carrier)
    ]
    same = carriers[0] == carriers[1] and (one.steps, one.recorded) == (other.steps, other.recorded)
    return same and np.array_equal(one.drivetrain.stiffness, other.drivetrain.stiffness) and all(
        mine.resolution.contact_grid == its.resolution.contact_grid
        and differ_only(mine.scene, its.scene, ("load", *ERRORS_OF_SETS))
        for mine, its in zip(one.models, other.models)
    )  # fmt: skip


def sets_solved_together(models: Sequence[TrainModel], kept_row: KeptRow) -> list[NumbersOfRun | None]:
    """As `solved_together`, the numbers OF_SETS of planetary sets."""
    rows = [model.rows[0] for model in models]
    row = rows[0]
    try:
        cycle = cycle_of_row(row, SilentProgress(), kept_row=kept_row)
        # By the cycle that is kept for the runs after these.
        cycle.build(range(cycle.steps))
        compile_kernels(False)
        bare = cycle.with_gaps_of([None] * len(row.meshes), [lambda own: own.gaps] * len(row.meshes))
        # Of few steps in a mesh cycle the same one of another set, or a mesh cycle before, is nearer than the last one.
        bare.traits = replace(bare.traits, repeats=True)
        at_once = _most_at_once(row, bare)
        found: list[NumbersOfRun | None] = []
        for first in range(0, len(rows) if at_once else 0, max(at_once, 1)):
            some = rows[first : first + at_once]
            found += _numbers_of_sets(some, bare, _gaps_of(some, bare))
        return found or [None] * len(models)
    finally:
        give_back()


def _gaps_of(rows: Sequence[RowModel], bare: RowCycle) -> GapsOfRows:
    """What opens the flanks of each run: pins beside their places, gears that run out, errors of pitches."""
    offsets = [np.array(of_mesh) for of_mesh in zip(*([offset for _, offset in row.placed] for row in rows))]
    deviations = [[deviations_of(model) for model in row.models] for row in rows]
    repeats = bare.steps if not any(map(any, deviations)) else rows[0].steps + 1
    return GapsOfRows(bare, offsets, deviations, repeats)


def _numbers_of_sets(rows: Sequence[RowModel], cycle: RowCycle, opened: GapsOfRows) -> list[NumbersOfRun | None]:
    begun = time.perf_counter()
    marcher = Marcher(cycle, *equations_of(rows), opened=opened)
    marches = marcher.together(rows[0].steps)
    if any(march.interrupted for march in marches):
        raise KeyboardInterrupt
    marched = (time.perf_counter() - begun) / len(rows)
    sides: list[SideBySide] = []
    found: list[NumbersOfRun | None] = []
    for run, (row, march) in enumerate(zip(rows, marches)):
        begun = time.perf_counter()
        carrier = row.shafts.carrier
        if run in marcher.failures or not runs_smoothly(march) or carrier is None:
            found.append(None)
            continue
        solved = march.latest
        of_meshes = [of_mesh(solved, cycle, number) for number in range(len(row.meshes))]
        if sides:
            sides = [each.with_forces(steps) for each, steps in zip(sides, of_meshes)]
        else:
            sides = [nodes_of(mesh.cycle, steps) for mesh, steps in zip(cycle.meshes, of_meshes)]
        curves = [mesh_variables(model.scene, nodes) for model, nodes in zip(row.models, sides)]
        numbers = result_of_set(row, carrier, solved.states[:, 0], curves).numbers
        seconds = time.perf_counter() - begun
        spent = {"time_march": marched, "wall_time": marched + seconds}
        counted = {"newton_iterations_total": march.newton_iterations, **spent}
        found.append(NumbersOfRun(numbers | counted, {}, seconds))
    return found


def _most_at_once(model: Model | RowModel, cycle: Cycle) -> int:
    """How many runs on the operators of a cycle may be marched together; none where these cannot all be held."""
    kept = cycle.kept
    position = cycle.position(0)
    if position.bytes * cycle.steps > SHARE_KEPT * kept.most - kept.others:
        return 0
    kinds = 2 if cycle.tangential else 1
    # Forces and displacements, gaps, and sets before and after.
    of_node = 8 * (2 * kinds + 1) + 2
    return max(int(SHARE_OF_A_BLOCK * kept.most / (of_node * position.operator.nodes * (model.steps + 1))), 1)
