"""The model of a train: the models of the pairs of its meshes, and which of them move together.

Between stages rigid shafts hand on torque and rotation alone: each stage is computed by itself. Meshes that have a gear
in common are computed together, and so are all meshes of a train that has several paths, masses, bearings or shafts
that twist.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import ceil

from fenics_gears.dynamics.mesh_in_train import drivetrain_of_mesh
from fenics_gears.dynamics.train import coordinates_of_mesh
from fenics_gears.scene.data import Load, Motion
from fenics_gears.scene.train import TrainScene
from fenics_gears.scene.train_mesh import MeshOfScene, rows_of
from fenics_gears.scene.train_shafts import TrainShafts

from .model import Model, model_of
from .planetary_windows import coarser, largest_torque, narrowed, with_own_nodes
from .row_model import RowModel
from .train_parts import (
    Known,
    bent_of,
    check_alike,
    check_supports,
    model_of_mesh,
    parts_of,
    whole_steps,
    whole_torques,
)

# Thousands of sets that differ in their errors have the same few models but for these.
_KNOWN_OF_SETS: Known = deque(maxlen=32)


@dataclass(frozen=True)
class TrainModel:
    """A train ready to be computed, row by row."""

    scene: TrainScene
    rows: tuple[RowModel, ...]

    @property
    def models(self) -> list[Model]:
        """Of all meshes in the order of the train."""
        return [model for row in self.rows for model in row.models]

    @property
    def parts(self) -> list[TrainModel]:
        """The parts of its scene, in series."""
        rows = iter(self.rows)
        return [TrainModel(part, tuple(next(rows) for _ in part.rows)) for part in self.scene.parts]

    def changed(self, change: Callable[[Model], Model]) -> TrainModel:
        """The same with the models of all meshes changed."""
        return replace(self, rows=tuple(row.changed(change) for row in self.rows))

    @property
    def warnings(self) -> list[str]:
        """Sentences for the user before the run, each of one mesh with its name."""
        said = [each for row in self.rows for each in row.warnings_of_meshes]
        return [*said, *(each for row in self.rows if not row.single for each in row.warnings)]


def train_model_of(scene: TrainScene) -> TrainModel:
    """The model of a train. Raises SceneError for what trains do not have yet, and as `model_of` of each mesh."""
    return TrainModel(scene, tuple(row_of(*each) for each in scene.rows_of_parts))


def row_of(scene: TrainScene, numbers: Sequence[int]) -> RowModel:
    """The row of these meshes of a train. Raises as `train_model_of`."""
    meshes = tuple(scene.meshes[number] for number in numbers)
    if len(meshes) == 1 and not scene.shafts.moving:
        return RowModel(meshes, (replace(model_of(meshes[0].scene), of_slowest=Fraction(1)),))
    return together(meshes, scene.shafts, scene.recorded_cycles)


def together(meshes: Sequence[MeshOfScene], shafts: TrainShafts, recorded_cycles: int = 1) -> RowModel:
    """Meshes that move together, their cycles divided into steps of one length in time; `recorded_cycles` as of
    TrainScene."""
    check_supports(meshes)
    known = _KNOWN_OF_SETS if shafts.carrier is not None else deque()
    models = [model_of_mesh(mesh, mesh.scene, known) for mesh in meshes]
    if shafts.carrier is not None:
        models = [coarser(mesh, model) for mesh, model in zip(meshes, models)]
    steps = whole_steps(meshes, [model.resolution.steps_per_mesh_cycle for model in models])
    cycles = meshes[0].scene.motion.mesh_cycles
    parts = parts_of(meshes, shafts)
    bent = bent_of(meshes, shafts)
    sizes = _flank_sizes(meshes, models)
    wholes = whole_torques(parts)
    found = []
    for number, (mesh, own, size) in enumerate(zip(meshes, steps, sizes)):
        accuracy = replace(mesh.scene.accuracy, steps_per_mesh_cycle=own, flank_element_size=size)
        if parts.graph.in_loop(number):
            # It may have to carry what all paths do together.
            torque = wholes[number]
            if shafts.carrier is not None:
                torque = largest_torque(mesh.scene.load.wheel_torque, torque)
            alone = replace(mesh.scene, accuracy=accuracy, load=Load(torque), inertia=None)
            wide = model_of_mesh(mesh, alone, known).resolution.contact_grid.length
            if shafts.carrier is not None:
                accuracy = with_own_nodes(accuracy, models[number], wide)
            accuracy = replace(accuracy, contact_length=wide)
        passed = ceil(cycles * max(steps) / own)
        recorded = min(ceil(recorded_cycles * max(steps) / own), passed)
        motion = Motion(mesh.scene.motion.mesh_frequency, passed, recorded, True, mesh.scene.motion.speed_given)
        # Masses are of the whole train.
        whole = replace(mesh.scene, accuracy=accuracy, motion=motion, inertia=None)
        model = model_of_mesh(mesh, whole, known)
        names = coordinates_of_mesh(parts, number) + (() if bent is None else bent.names_in(number))
        supports = [parts.support(gear) for gear in parts.gears[number]]
        seats = () if bent is None else bent.seats_in(number)
        drivetrain = drivetrain_of_mesh(mesh.pair, mesh.scene.load.wheel_torque, names, supports, seats)
        if shafts.carrier is not None:
            model = narrowed(model)
        found.append(replace(model, drivetrain=drivetrain, of_slowest=Fraction(max(steps), own)))
    check_alike(meshes, found)
    recorded = recorded_cycles * max(steps) if shafts.moving else 0
    row = RowModel(tuple(meshes), tuple(found), shafts, recorded)
    ramp = row.ramp
    return row if ramp is None else row.changed(lambda own: replace(own, own_clock=ramp))


def _flank_sizes(meshes: Sequence[MeshOfScene], models: Sequence[Model]) -> list[float]:
    """Sizes (mm) of flank elements: an idler has one mesh of elements, and so has its row."""
    sizes = [model.resolution.flank_element_size for model in models]
    found = []
    for row in rows_of(meshes):
        found += [min(sizes[number] for number in row)] * len(row)
    return found
