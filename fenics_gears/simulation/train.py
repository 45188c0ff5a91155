"""A train of gears from its model to its result: row by row, since rigid shafts between them hand on torque and
rotation alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import xarray as xr

from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.row import MeshOfRow, RowCycle, at_phase
from fenics_gears.contact.row_in_plane import IdlerInPlane, RowInPlane
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.marched import March
from fenics_gears.dynamics.row import rotations_of
from fenics_gears.dynamics.steps import Steps
from fenics_gears.elasticity.cache import Cache, user_cache, writing_meanwhile
from fenics_gears.elasticity.compliance import Body
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.errors import ComputationError
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.model import Model
from fenics_gears.model.train import RowModel, TrainModel, train_model_of
from fenics_gears.model.train_cost import row_cost, row_too_large
from fenics_gears.results.recorder import Recorder
from fenics_gears.results.row import RowResult
from fenics_gears.results.train import MeshResult, dataset_of, mesh_result
from fenics_gears.scene.train import MeshOfScene, TrainScene
from fenics_gears.system.memory import allowed_memory
from fenics_gears.system.progress import Progress, SilentProgress

from .bodies import gear_body
from .elastic_route import cycle_of, flanks_of
from .simulate import MARCH, solved
from .warm_up import compile_kernels, compile_loops

Keep = Callable[[MeshOfScene, xr.Dataset], None]


def simulate_train(
    scene: TrainScene | TrainModel,
    progress: Progress | None = None,
    cache: Cache | None = None,
    keep: Keep | None = None,
) -> xr.Dataset:
    """Run a train and return its result: the variables of a pair over steps and `mesh`, the numbers of each mesh, and
    the transmission error of the whole over time. `keep`: is given each stage of two gears and its result as a pair.

    Raises GeometryError and SceneError before any computation, ComputationError where a stage fails, KeyboardInterrupt
    on Ctrl-C.

    >>> from fenics_gears import load_train, simulate_train
    >>> found = simulate_train(load_train("demos/gear_trains/idler.toml"))
    >>> list(found["mesh"].values)
    ['idler: gears 1 and 2', 'idler: gears 2 and 3']
    """
    progress = progress or SilentProgress()
    model = scene if isinstance(scene, TrainModel) else train_model_of(scene)
    found: list[MeshResult] = []
    for row in model.rows:
        try:
            found += _single(row, progress, cache, keep) if row.single else _coupled(row, progress, cache)
        except ContactNotConverged as failure:
            failure.reason = f"{row.meshes[0].name}: {failure.reason}"
            failure.partial = None
            raise
    return dataset_of(model, found)


def _single(row: RowModel, progress: Progress, cache: Cache | None, keep: Keep | None) -> list[MeshResult]:
    """A stage of two gears, as a pair by itself."""
    result = solved(row.models[0], progress=progress, cache=cache)
    if not result.attrs["complete"]:
        raise KeyboardInterrupt
    if keep is not None:
        keep(row.meshes[0], result.dataset)
    return [mesh_result(row.meshes[0].name, result)]


def _coupled(row: RowModel, progress: Progress, cache: Cache | None) -> list[MeshResult]:
    """All meshes of a row together."""
    for_operators = _memory_for_operators(row)
    compile_loops(progress)
    with writing_meanwhile(cache or user_cache()) as kept:
        cycle = row_cycle(row, progress, kept)
    cycle.share(for_operators)
    progress.stage("compile")
    compile_kernels(cycle.tangential, False)
    result = RowResult(row, [Recorder(each, mesh.cycle) for each, mesh in zip(row.models, cycle.meshes)])

    def take(solved_steps: Steps, march: March) -> None:
        result.take(solved_steps, [of_mesh(solved_steps, cycle, number) for number in range(len(row.models))])

    progress.stage(MARCH)
    march = Marcher(cycle, row.equations_of_motion).run(row.models[0].steps, 1, progress.update, take)
    if march.interrupted:
        raise KeyboardInterrupt
    return result.of_meshes(march)


def _memory_for_operators(row: RowModel) -> float:
    """As `simulate.memory_for_operators`, of a row."""
    allowed = allowed_memory()
    if said := row_too_large(row, allowed):
        raise ComputationError(said)
    return allowed - row_cost(row).held


def row_cycle(row: RowModel, progress: Progress, cache: Cache) -> RowCycle:
    """The contact equations of all meshes of a row, on the bodies of all gears."""
    if row.over_face:
        # Runs in the plane load none of it.
        from .row_over_face import row_cycle_over_face

        return row_cycle_over_face(row, progress, cache)
    bodies = list(_bodies(row, progress, cache))
    idlers = []
    for mesh in range(len(row.models) - 1):
        pair = row.models[mesh].pair
        place = mesh, pair.wheel.teeth, row.second_mesh(mesh)
        idlers.append(IdlerInPlane(*place, bodies[mesh + 1].section, pair.face_width))
    meshes = []
    rotations = rotations_of([each.pair for each in row.models])
    for number, (own, (phase, _), rows) in enumerate(zip(row.models, row.begun, rotations)):
        meshes.append(MeshOfRow(_cycle(own, (bodies[number], bodies[number + 1]), phase), rows))
    return RowCycle(meshes, RowInPlane(idlers))


def _bodies(row: RowModel, progress: Progress, cache: Cache) -> Iterator[Body]:
    """The gears of a row, one after the other."""
    last = len(row.models)
    for gear in range(last + 1):
        progress.stage(f"condense gear {gear + 1}")
        if gear == 0:
            yield gear_body(row.models[0], GEARS[0], cache)
        elif gear == last:
            yield gear_body(row.models[-1], GEARS[1], cache)
        else:
            yield _idler(row, gear - 1, cache)


def _idler(row: RowModel, mesh: int, cache: Cache) -> Body:
    own = row.models[mesh]
    material = own.scene.gears.material_of(GEARS[1])
    division = row.discretisation_of_idler(mesh)
    return Body.of(flank_compliance(own.pair.wheel, material, division, row.reach_through(mesh), cache))


def _cycle(model: Model, bodies: tuple[Body, Body], phase: float) -> Cycle:
    """The contact equations of one mesh of a row."""
    mesh = elastic_mesh(flanks_of(model, bodies), model.resolution.contact_grid, model.corner, coast=False)
    return cycle_of(model, at_phase(mesh, phase))


def of_mesh(steps: Steps, cycle: RowCycle, number: int) -> Steps:
    """The steps of a row as one of its meshes has them: its contact nodes, and the rotations of its gears."""
    mesh = cycle.meshes[number]
    positions = [mesh.cycle.position(int(step)) for step in steps.numbers]
    counts = np.array([position.operator.nodes for position in positions], dtype=np.int64)
    ahead = np.array([cycle.nodes_before_mesh(position, number) for position in steps.positions], dtype=np.int64)
    nodes = np.repeat(steps.starts[:-1] + ahead - (np.cumsum(counts) - counts), counts) + np.arange(counts.sum())
    forces = nodes
    if steps.kinds == 2:
        normal = nodes + np.repeat(steps.starts[:-1], counts)
        forces = _by_steps(normal, normal + np.repeat(np.diff(steps.starts), counts), counts)
    return Steps(
        steps.numbers, positions, steps.states @ mesh.rotations.T, steps.forces[forces], steps.displacement[forces],
        steps.status[nodes], steps.iterations, steps.methods,
    )  # fmt: skip


def _by_steps(normal: np.ndarray, tangential: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """Places of a step's normal forces, then of its tangential ones, then of the next step's."""
    place = np.arange(len(normal)) + np.repeat(np.cumsum(counts) - counts, counts)
    both = np.empty(2 * len(normal), dtype=np.int64)
    both[place] = normal
    both[place + np.repeat(counts, counts)] = tangential
    return both
