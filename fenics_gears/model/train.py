"""The model of a train: the models of the pairs of its meshes, and which of them move together.

Between stages rigid shafts hand on torque and rotation alone: each stage is computed by itself. The meshes of a row
with idlers are computed together, and so are all meshes of a train that has masses, bearings or shafts that twist.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.dynamics.clock import FOLLOWING, SteadyClock, TimeScales
from fenics_gears.dynamics.stepping import EquationsOfMotion
from fenics_gears.dynamics.train import TrainDrivetrain, coordinates_of_mesh, drivetrain_of_mesh, train_drivetrain
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.geometry.gear_train import SecondMesh, begun_at
from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.data import Motion
from fenics_gears.scene.train import MeshOfScene, TrainScene, rows_of
from fenics_gears.scene.train_pair_shafts import in_words_of_train
from fenics_gears.scene.train_shafts import TrainShafts

from .drivetrain import mesh_stiffness
from .face_resolution import face_discretisation
from .model import Model, model_of
from .train_parts import bent_of, check_alike, check_supports, model_of_mesh, parts_of, whole_steps

if TYPE_CHECKING:
    from fenics_gears.dynamics.frequencies import Vibration
    from fenics_gears.dynamics.train_shafts import BentShafts


@dataclass(frozen=True)
class RowModel:
    """Meshes of a train that move together, or a single one: its `meshes` and the models of their pairs, and the
    `shafts` that they are on. `recorded`: steps, the last ones, that numbers are taken from; 0 for all."""

    meshes: tuple[MeshOfScene, ...]
    models: tuple[Model, ...]
    shafts: TrainShafts = TrainShafts()
    recorded: int = 0

    @property
    def single(self) -> bool:
        """Whether it is a pair by itself."""
        return len(self.models) == 1 and not self.shafts.moving

    @cached_property
    def drivetrain(self) -> TrainDrivetrain:
        parts = parts_of(self.meshes, self.shafts)
        if self.bent is None:
            return train_drivetrain(parts, self.shafts.damping, self.mesh_stiffness)
        from fenics_gears.dynamics.train_shafts import with_bent_shafts

        names = [model.drivetrain.coordinates for model in self.models]
        return with_bent_shafts(train_drivetrain(parts), self.bent, names, self.shafts.damping, self.mesh_stiffness)

    @cached_property
    def bent(self) -> BentShafts | None:
        """The shafts that bend; None where none does."""
        return bent_of(self.meshes, self.shafts)

    @property
    def mesh_stiffness(self) -> np.ndarray:
        """Of one tooth pair of each mesh (f,), N/mm, about; on shafts that bend of either half of its face (2 f,)."""
        found = np.array([mesh_stiffness(mesh.scene, mesh.pair) for mesh in self.meshes])
        return found if self.bent is None else np.repeat(0.5 * found, 2)

    @property
    def equations_of_motion(self) -> EquationsOfMotion:
        first = self.models[0]
        clock = SteadyClock(first.time_step)
        return EquationsOfMotion(self.drivetrain, first.time_step, first.friction_coefficient, self.time_scales, clock)

    @property
    def steps(self) -> int:
        """Steps of the run: whole cycles of the slowest mesh."""
        slowest = max(self.models, key=lambda model: model.resolution.steps_per_mesh_cycle)
        return slowest.steps

    @cached_property
    def vibrations(self) -> list[Vibration]:
        """The elastic modes with one tooth pair in each mesh, about; empty without inertia."""
        if self.drivetrain.mass is None:
            return []
        from fenics_gears.dynamics.frequencies import vibrations

        return vibrations(self.drivetrain, self.mesh_stiffness, self.models[0].scene.friction is not None)

    @property
    def time_scales(self) -> TimeScales:
        """How mesh frequencies and time step compare with the vibrations."""
        if not self.vibrations:
            return FOLLOWING
        elastic = [each.frequency for each in self.vibrations]
        frequencies = [model.scene.motion.mesh_frequency for model in self.models]
        return TimeScales(
            samples_vibration=2.0 * self.models[0].time_step * elastic[0] <= 1.0,
            follows_statics=max(frequencies) < elastic[0],
            outruns_vibration=min(frequencies) > elastic[-1],
        )

    @property
    def warnings(self) -> list[str]:
        """Sentences on the motion of all meshes together."""
        if not self.vibrations:
            return []
        from fenics_gears.dynamics.guidance import time_step_warnings

        fastest = max(self.models, key=lambda model: model.scene.motion.mesh_frequency)
        steps = fastest.resolution.steps_per_mesh_cycle
        frequency = fastest.scene.motion.mesh_frequency
        return time_step_warnings(self.vibrations, frequency, steps, self.time_scales, fastest.time_step)

    @property
    def warnings_of_meshes(self) -> list[str]:
        """Sentences on each mesh, with its name."""
        of_meshes = zip(self.meshes, self.models)
        return [
            f"{mesh.name}: {in_words_of_train(mesh.bent, said)}" for mesh, own in of_meshes for said in own.warnings
        ]

    @property
    def over_face(self) -> bool:
        """Whether flanks are resolved over the face: of all meshes or of none."""
        return self.models[0].scene.three_dimensional

    @property
    def begun(self) -> list[tuple[float, int]]:
        """See `gear_train.begun_at`."""
        return begun_at([mesh.idler for mesh in self.meshes])

    def second_mesh(self, mesh: int) -> SecondMesh:
        """Where the mesh behind an idler is as the one before it begins, its pairs counted as in the run."""
        second = self.meshes[mesh + 1].idler
        assert second is not None
        return replace(second, teeth=second.teeth + self.begun[mesh + 1][1])

    def reach_through(self, mesh: int) -> Reach:
        """Between which teeth of the idler behind a mesh compliance is needed: on its flanks of either mesh, and from
        one to the other."""
        first, second = self.models[mesh : mesh + 2]
        idler = self.meshes[mesh + 1].idler
        assert idler is not None
        one, other = (_indices(model) for model in (first, second))
        # One index further at either end: pairs a step before, and those of a mesh that is ahead by part of a cycle.
        least = -(one[1] + 1) - idler.teeth + other[0] - 1
        most = -(one[0] - 1) - idler.teeth + other[1] + 1
        teeth = first.pair.wheel.teeth
        most = min(most, least + teeth - 1)
        round_about = teeth * round(0.5 * (least + most) / teeth)
        same = max(model.touching.reach.same for model in (first, second))
        return Reach(same, (least - round_about, most - round_about))

    @property
    def members(self) -> list[list[int]]:
        """Numbers of its meshes, those together that idlers couple."""
        return rows_of(self.meshes)

    @property
    def idlers(self) -> list[int]:
        """Numbers of the meshes whose wheel is an idler."""
        return [number - 1 for number, mesh in enumerate(self.meshes) if number and mesh.idler is not None]

    def key_of_idler(self, mesh: int) -> tuple[Gear, Material, Discretisation, Reach]:
        """What the section of the idler behind a mesh depends on, gear and material first."""
        own = self.models[mesh]
        material = own.scene.gears.material_of(GEARS[1])
        return own.pair.wheel, material, self.discretisation_of_idler(mesh), self.reach_through(mesh)

    def keys_of_idler(self, mesh: int) -> tuple:
        """What the body of the idler behind a mesh depends on, gear and material first."""
        over_face = self.models[mesh].scene.three_dimensional
        solid = self.solid_discretisation_of_idler(mesh) if over_face else None
        return *self.key_of_idler(mesh), solid

    def discretisation_of_idler(self, mesh: int) -> Discretisation:
        """How the idler behind a mesh is divided: finer where the tip of either mate may press."""
        parts = self.models[mesh].resolution.discretisation(1), self.models[mesh + 1].resolution.discretisation(0)
        tips = [part.mate_tip for part in parts if part.mate_tip is not None]
        both = (min(each[0] for each in tips), max(each[1] for each in tips)) if tips else None
        return replace(parts[0], mate_tip=both)

    def solid_discretisation_of_idler(self, mesh: int) -> FaceDiscretisation:
        """How the body of the idler behind a mesh is divided: in the layers of the mesh that has more."""
        first = face_discretisation(self.models[mesh], 1)
        second = face_discretisation(self.models[mesh + 1], 0)
        return replace(first, layers=max(first.layers, second.layers))


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
    def bare(self) -> TrainModel:
        """The same without what its models have computed of themselves."""
        rows = (replace(row, models=tuple(each.bare for each in row.models)) for row in self.rows)
        return replace(self, rows=tuple(rows))

    @property
    def warnings(self) -> list[str]:
        """Sentences for the user before the run, each of one mesh with its name."""
        said = [each for row in self.rows for each in row.warnings_of_meshes]
        return [*said, *(each for row in self.rows if not row.single for each in row.warnings)]


def _indices(model: Model) -> tuple[int, int]:
    """Least and largest index of a pair that touches in a mesh."""
    steps = model.touching.steps
    return model.touching.drive[0] // steps, model.touching.drive[1] // steps


def train_model_of(scene: TrainScene) -> TrainModel:
    """The model of a train. Raises SceneError for what trains do not have yet, and as `model_of` of each mesh."""
    rows = []
    for numbers in rows_of(scene.meshes, scene.shafts.moving):
        meshes = tuple(scene.meshes[number] for number in numbers)
        if len(meshes) == 1 and not scene.shafts.moving:
            rows.append(RowModel(meshes, (model_of(meshes[0].scene),)))
        else:
            rows.append(together(meshes, scene.shafts, scene.recorded_cycles))
    return TrainModel(scene, tuple(rows))


def together(meshes: Sequence[MeshOfScene], shafts: TrainShafts, recorded_cycles: int = 1) -> RowModel:
    """Meshes that move together, their cycles divided into steps of one length in time; `recorded_cycles` as of
    TrainScene."""
    check_supports(meshes)
    models = [model_of_mesh(mesh, mesh.scene) for mesh in meshes]
    steps = whole_steps(meshes, [model.resolution.steps_per_mesh_cycle for model in models])
    cycles = meshes[0].scene.motion.mesh_cycles
    parts = parts_of(meshes, shafts)
    bent = bent_of(meshes, shafts)
    sizes = _flank_sizes(meshes, models)
    found = []
    for number, (mesh, own, size) in enumerate(zip(meshes, steps, sizes)):
        accuracy = replace(mesh.scene.accuracy, steps_per_mesh_cycle=own, flank_element_size=size)
        passed = ceil(cycles * max(steps) / own)
        recorded = min(ceil(recorded_cycles * max(steps) / own), passed)
        motion = Motion(mesh.scene.motion.mesh_frequency, passed, recorded, True, mesh.scene.motion.speed_given)
        # Masses are of the whole train.
        model = model_of_mesh(mesh, replace(mesh.scene, accuracy=accuracy, motion=motion, inertia=None))
        names = coordinates_of_mesh(parts, number) + (() if bent is None else bent.names_in(number))
        supports = [parts.support(gear) for gear in parts.gears[number]]
        drivetrain = drivetrain_of_mesh(mesh.pair, mesh.scene.load.wheel_torque, names, supports)
        found.append(replace(model, drivetrain=drivetrain))
    check_alike(meshes, found)
    recorded = recorded_cycles * max(steps) if shafts.moving else 0
    return RowModel(tuple(meshes), tuple(found), shafts, recorded)


def _flank_sizes(meshes: Sequence[MeshOfScene], models: Sequence[Model]) -> list[float]:
    """Sizes (mm) of flank elements: an idler has one mesh of elements, and so has its row."""
    sizes = [model.resolution.flank_element_size for model in models]
    found = []
    for row in rows_of(meshes):
        found += [min(sizes[number] for number in row)] * len(row)
    return found
