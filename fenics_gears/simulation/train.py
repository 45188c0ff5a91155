"""A train of gears from its model to its result."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import xarray as xr

from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.train import Idler, MeshOfTrain, TrainCycle, at_phase, begun_at
from fenics_gears.dynamics.march import March, Marcher
from fenics_gears.dynamics.steps import Steps
from fenics_gears.dynamics.train import rotations_of
from fenics_gears.elasticity.cache import Cache, user_cache, writing_meanwhile
from fenics_gears.elasticity.compliance import Body
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.model import Model
from fenics_gears.model.train import TrainModel, train_model_of
from fenics_gears.results.recorder import Recorder
from fenics_gears.results.train import TrainResult
from fenics_gears.scene.train import TrainScene
from fenics_gears.system.memory import allowed_memory
from fenics_gears.system.progress import Progress, SilentProgress

from .bodies import gear_body
from .elastic_route import flanks_of, gaps_of
from .simulate import MARCH
from .warm_up import compile_kernels, compile_loops

# Of the memory that is allowed, for contact operators.
SHARE_OF_OPERATORS = 0.5


def simulate_train(
    scene: TrainScene | TrainModel, progress: Progress | None = None, cache: Cache | None = None
) -> xr.Dataset:
    """Run a train and return its result: the variables of a pair with the dimension `mesh` behind their first one.

    Raises GeometryError and SceneError before any computation, ComputationError where a stage fails.
    """
    progress = progress or SilentProgress()
    compile_loops(progress)
    model = scene if isinstance(scene, TrainModel) else train_model_of(scene)
    with writing_meanwhile(cache or user_cache()) as kept:
        cycle, bodies = train_cycle(model, progress, kept)
    cycle.share(SHARE_OF_OPERATORS * allowed_memory())
    progress.stage("compile")
    compile_kernels(cycle.tangential, False)
    recorders = [Recorder(each, mesh.cycle) for each, mesh in zip(model.models, cycle.meshes)]
    result = TrainResult(model, recorders)

    def take(solved: Steps, march: March) -> None:
        result.take(solved)
        for number, recorder in enumerate(recorders):
            own = of_mesh(solved, cycle, number)
            left = recorder.model.steps + 1 - recorder.steps
            if left > 0:
                recorder.take(own if len(own) <= left else own.between(0, left))

    progress.stage(MARCH)
    marcher = Marcher(cycle, model.equations_of_motion)
    try:
        march = marcher.run(model.steps, 1, progress.update, take)
    except ContactNotConverged as failure:
        failure.partial = result.dataset(failure.partial, bodies, "failed")
        raise
    return result.dataset(march, bodies, "interrupted" if march.interrupted else "")


def train_cycle(model: TrainModel, progress: Progress, cache: Cache) -> tuple[TrainCycle, list[Body]]:
    """The contact equations of all meshes, on the bodies of all gears."""
    bodies = list(_bodies(model, progress, cache))
    begun = begun_at([mesh.idler for mesh in model.scene.meshes])
    idlers = []
    for mesh in model.idlers:
        second = model.scene.meshes[mesh + 1].idler
        second = replace(second, teeth=second.teeth + begun[mesh + 1][1])
        pair = model.models[mesh].pair
        idlers.append(Idler(mesh, pair.wheel.teeth, bodies[2 * mesh + 1].section, second, pair.face_width))
    meshes = []
    rotations = rotations_of([each.pair for each in model.models])
    for number, (own, (phase, _), rows) in enumerate(zip(model.models, begun, rotations)):
        pair_bodies = bodies[2 * number], bodies[2 * number + 1]
        meshes.append(MeshOfTrain(_cycle(own, pair_bodies, phase), rows))
    unique = [body for place, body in enumerate(bodies) if place % 2 or place // 2 - 1 not in model.idlers]
    return TrainCycle(meshes, idlers), unique


def _bodies(model: TrainModel, progress: Progress, cache: Cache) -> Iterator[Body]:
    """Pinion and wheel of each mesh; an idler is the same body in both of its meshes."""
    last: Body | None = None
    for number, own in enumerate(model.models):
        for gear, name in enumerate(GEARS):
            mesh = number - 1 + gear
            if gear == 0 and mesh in model.idlers:
                assert last is not None
                yield last
                continue
            progress.stage(f"condense gear {gear + 1} of {model.scene.meshes[number].name}")
            last = _idler(model, number, cache) if gear == 1 and mesh in model.idlers else gear_body(own, name, cache)
            yield last


def _idler(model: TrainModel, mesh: int, cache: Cache) -> Body:
    own = model.models[mesh]
    material = own.scene.gears.material_of(GEARS[1])
    division = model.discretisation_of_idler(mesh)
    return Body.of(flank_compliance(own.pair.wheel, material, division, model.reach_through(mesh), cache))


def _cycle(model: Model, bodies: tuple[Body, Body], phase: float) -> Cycle:
    """The contact equations of one mesh of a train."""
    mesh = elastic_mesh(flanks_of(model, bodies), model.resolution.contact_grid, model.corner, coast=False)
    friction = model.scene.friction is not None
    steps = model.resolution.steps_per_mesh_cycle
    cycle = Cycle(at_phase(mesh, phase), steps, model.drivetrain.indices, friction)
    return cycle.with_gaps(gaps_of(model, cycle))


def of_mesh(steps: Steps, cycle: TrainCycle, number: int) -> Steps:
    """The steps of a train as one of its meshes has them: its contact nodes, and the rotations of its gears."""
    mesh = cycle.meshes[number]
    positions = [mesh.cycle.position(int(step)) for step in steps.numbers]
    counts = np.array([position.operator.nodes for position in positions], dtype=np.int64)
    ahead = np.array([cycle.nodes_before_mesh(position, number) for position in steps.positions], dtype=np.int64)
    nodes = np.repeat(steps.starts[:-1] + ahead - (np.cumsum(counts) - counts), counts) + np.arange(counts.sum())
    forces = nodes
    if steps.kinds == 2:
        whole = np.diff(steps.starts)
        first = np.repeat(steps.starts[:-1], counts)
        normal = nodes + first
        forces = _by_steps(normal, normal + np.repeat(whole, counts), counts)
    return Steps(
        steps.numbers, positions, steps.states @ mesh.rotations.T, steps.forces[forces], steps.displacement[forces],
        steps.status[nodes], steps.iterations, steps.methods,
    )  # fmt: skip


def _by_steps(normal: np.ndarray, tangential: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """Places of a step's normal forces, then of its tangential ones, then of the next step's."""
    starts = np.cumsum(counts) - counts
    place = np.arange(len(normal)) + np.repeat(starts, counts)
    found = np.empty(2 * len(normal), dtype=np.int64)
    found[place] = normal
    found[place + np.repeat(counts, counts)] = tangential
    return found
