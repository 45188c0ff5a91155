"""Meshes that move together from their model to their result: those of a row with idlers, or all of a train whose
shafts have several paths, masses, bearings or twist."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from fenics_gears.contact.cycle_alike import CycleAlike
from fenics_gears.contact.joined_meshes import JoinedMeshes
from fenics_gears.contact.laws import OPEN, SLIP_FORWARD
from fenics_gears.contact.mesh import Mesh, step_by_step
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.row import JoinedPosition, MeshOfRow, RowCycle, at_phase
from fenics_gears.contact.row_in_plane import GearInPlane, RowInPlane
from fenics_gears.contact.row_on_points import WheelOnPoints
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.marched import March
from fenics_gears.dynamics.steps import Steps
from fenics_gears.elasticity.cache import Cache, user_cache, writing_meanwhile
from fenics_gears.elasticity.compliance import Body
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.model import Model
from fenics_gears.model.row_model import RowModel
from fenics_gears.model.shared_gears import couplings
from fenics_gears.model.train_cost import row_cost, row_too_large
from fenics_gears.results.recorder import Recorder
from fenics_gears.results.row import RowResult
from fenics_gears.results.train import MeshResult
from fenics_gears.system.progress import Progress

from .bodies import body_key, gear_bodies, gear_body
from .elastic_route import cycle_of, gaps_of, mesh_of
from .row_over_face import SharedBody, joined
from .row_over_face import shared_body as body_over_face
from .simulate import MARCH, memory_for_operators
from .warm_up import compile_kernels, compile_loops

KeptRow = Callable[[RowModel, Callable[[], RowCycle]], RowCycle]


def solved_row(
    row: RowModel, progress: Progress, cache: Cache | None = None, kept_row: KeptRow | None = None
) -> list[MeshResult]:
    """All meshes of a row together. `kept_row`: keeps its contact equations, or makes them. Errors are those of
    `runs.train.simulate_train`."""
    cycle = cycle_of_row(row, progress, cache, kept_row)
    progress.stage("compile")
    compile_kernels(cycle.tangential, False)
    result = RowResult(row, [Recorder(each, mesh.cycle) for each, mesh in zip(row.models, cycle.meshes)])

    def take(solved_steps: Steps, march: March) -> None:
        result.take(solved_steps, [of_mesh(solved_steps, cycle, number) for number in range(len(row.models))])

    progress.stage(MARCH)
    march = Marcher(cycle, row.equations_of_motion).run(row.steps, 1, progress.update, take)
    if march.interrupted:
        raise KeyboardInterrupt
    return result.of_meshes(march)


def cycle_of_row(
    row: RowModel, progress: Progress, cache: Cache | None = None, kept_row: KeptRow | None = None
) -> RowCycle:
    """The contact equations of a row with its gaps, kept or made, in the memory that is left."""
    for_operators = memory_for_operators(row_cost(row), partial(row_too_large, row))
    compile_loops(progress)
    with writing_meanwhile(cache or user_cache()) as kept:
        once = kept_row is None and row.passes_once
        make = partial(_cycle_with_room, row, (for_operators, once), progress, kept)
        return make() if kept_row is None else kept_row(row, make)


def _cycle_with_room(row: RowModel, room: tuple[float, bool], progress: Progress, cache: Cache) -> RowCycle:
    """`room`: as of `RowCycle.share`."""
    cycle = row_cycle(row, progress, cache)
    cycle.share(*room)
    return cycle


def row_cycle(row: RowModel, progress: Progress, cache: Cache) -> RowCycle:
    """The contact equations of all meshes of a train that move together, on the bodies of all gears."""
    bodies = list(_bodies(row, progress, cache))
    meshes: list[MeshOfRow] = []
    made: list[Mesh] = []
    for number, of_mesh in enumerate(row.placed):
        like = _like(row, number, bodies)
        made.append(_mesh_of(row, number, bodies) if like is None else made[like])
        cycle = _cycle(row, number, made[number], None if like is None else meshes[like].cycle)
        mesh = _mesh(row.models[number], cycle, of_mesh, row.drivetrain.modes)
        meshes.append(replace(mesh, friction=row.frictions[number]))
    if row.over_face:
        return RowCycle(meshes, joined(row, bodies, [mesh.cycle for mesh in meshes]))
    coupled = [
        GearInPlane(
            row.gear(gear).tooth_count, shared, bodies[gear].section, row.models[shared.meshes[0]].pair.face_width
        )
        for gear in row.graph.shared
        for shared in couplings(row.layout, gear)
    ]
    on_points = next((gear for gear in row.graph.shared if row.points_of(gear) is not None), None)
    points = None if on_points is None else WheelOnPoints([mesh for mesh, _ in row.graph.sides[on_points]])
    return RowCycle(meshes, RowInPlane(coupled) if coupled else JoinedMeshes(), points)


def _mesh(model: Model, cycle: Cycle, placed: tuple[np.ndarray, np.ndarray], modes: int) -> MeshOfRow:
    """A mesh with the gaps of its model."""
    coordinates, offset = placed
    return MeshOfRow(cycle, coordinates, None, modes).with_gaps_of(offset, partial(gaps_of, model))


def _bodies(row: RowModel, progress: Progress, cache: Cache) -> Iterator[Body | SharedBody]:
    """The gears of a row, one after the other; those that are alike, as planets are, are one body."""
    known: list[tuple[tuple, Body | SharedBody]] = []
    for gear, sides in enumerate(row.graph.sides):
        mesh, side = sides[0]
        model = row.models[mesh]
        key = row.keys_of_shared(gear) if len(sides) > 1 else body_key(model, GEARS[side])
        if all(other != key for other, _ in known):
            progress.stage(f"condense gear {gear + 1}")
            if len(sides) > 1:
                known.append((key, shared_body(row, gear, cache)))
            elif {*row.graph.gears[mesh]}.isdisjoint(row.graph.shared):
                known += zip([body_key(model, name) for name in GEARS], gear_bodies(model, progress, cache))
            else:
                known.append((key, gear_body(model, GEARS[side], cache)))
        yield next(body for other, body in known if other == key)


def shared_body(row: RowModel, gear: int, cache: Cache) -> Body | SharedBody:
    """A gear of several meshes, from the cache or condensed."""
    if row.over_face:
        return body_over_face(row, gear, cache)
    key = row.key_of_shared(gear)
    points = row.points_of(gear)
    if points is None:
        return Body.of(flank_compliance(*key, cache))
    from fenics_gears.elasticity.whole_body.ring_on_points import ring_on_points

    gear_data, material, division, reach = key
    return Body.of(ring_on_points(gear_data, material, division, points, reach.same, cache))


def _like(row: RowModel, number: int, bodies: Sequence[Body | SharedBody]) -> int | None:
    """Number of the mesh whose operators a mesh of a row has too, whole steps later: that which it is like, on the same
    bodies."""
    like = row.meshes[number].like
    if like is None:
        return None
    own, other = ([bodies[gear] for gear in row.graph.gears[each]] for each in (number, like))
    return like if all(one is two for one, two in zip(own, other)) else None


def _mesh_of(row: RowModel, number: int, bodies: Sequence[Body | SharedBody]) -> Mesh:
    """Two gears of a row in contact, at the phase of a pair."""
    pinion, wheel = (
        body if isinstance(body := bodies[gear], Body) else body.in_mesh(row, gear, number)
        for gear in row.graph.gears[number]
    )
    return mesh_of(row.models[number], (pinion, wheel))


def _cycle(row: RowModel, number: int, made: Mesh, like: Cycle | None) -> Cycle:
    """The contact equations of one mesh of a row; `like`: the cycle of the mesh that it is like."""
    model = row.models[number]
    phase, ahead = row.phases[number]
    mesh = at_phase(made, phase, ahead, model.resolution.steps_per_mesh_cycle)
    gear = row.graph.gears[number][1]
    if gear in row.graph.shared and row.points_of(gear) is not None:
        # Its teeth differ by the points beside them: each mesh counts them from its own tooth 0.
        first, _ = row.graph.sides[gear][0]
        pinion, wheel = mesh.bodies
        mesh = replace(mesh, bodies=(pinion, wheel.counted_from(row.layout.shared(gear, first, number).tooth)))
    return cycle_of(model, mesh) if like is None else CycleAlike(mesh, like, ahead)


def of_mesh(steps: Steps, cycle: RowCycle, number: int) -> Steps:
    """The steps of a row as one of its meshes has them: its contact nodes, and the rotations of its gears."""
    mesh = cycle.meshes[number]
    own = [position.of_meshes[number] for position in steps.positions if isinstance(position, JoinedPosition)]
    positions = [position for position, _ in own]
    counts = np.array([position.operator.nodes for position in positions], dtype=np.int64)
    ahead = np.array([first for _, first in own], dtype=np.int64)
    nodes = np.repeat(steps.starts[:-1] + ahead - (np.cumsum(counts) - counts), counts) + np.arange(counts.sum())
    forces = nodes
    if steps.kinds == 2:
        # Of a mesh without friction what its tangential forces would be is left out.
        normal = nodes + np.repeat(steps.starts[:-1], counts)
        both = np.concatenate([normal, normal + np.repeat(np.diff(steps.starts), counts)])
        forces = step_by_step(both, np.cumsum(counts) - counts, counts) if mesh.friction else normal
    states = steps.states @ mesh.coordinates.T
    own_forces = steps.forces[forces]
    displacement = steps.displacement[forces]
    kinds = steps.kinds if mesh.friction else 1
    if mesh.friction not in (0.0, 1.0):
        units = step_by_step(np.repeat([1.0, mesh.friction], counts.sum()), np.cumsum(counts) - counts, counts)
        own_forces *= units
        displacement /= units
    if mesh.offset is not None and mesh.offset.any():
        # Of its own gears the second one on a shaft stands ahead, and its flanks have the gaps of its pair.
        states[:, 0] += mesh.offset
        ends = np.cumsum(counts)
        for position, end, count in zip(positions, ends, counts):
            start = kinds * (end - count)
            displacement[start : start + count] += position.operator.jacobian[:count] @ mesh.offset
    status = steps.status[nodes]
    if not mesh.friction:
        status[status != OPEN] = SLIP_FORWARD
    return Steps(
        steps.numbers, positions, states, own_forces, displacement, status, steps.iterations, steps.methods
    )  # fmt: skip
