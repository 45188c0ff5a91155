"""The model of a train: the models of the pairs of its meshes, and which of them move together.

Between stages rigid shafts hand on torque and rotation alone: each stage is computed by itself. Meshes that have a gear
in common are computed together, and so are all meshes of a train that has several paths, masses, bearings or shafts
that twist.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import ceil, lcm, pi
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.dynamics.clock import FOLLOWING, SteadyClock, TimeScales, time_scales
from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.dynamics.frequencies import Vibration, vibrations
from fenics_gears.dynamics.guidance import time_step_warnings
from fenics_gears.dynamics.set_in_time import set_drivetrain
from fenics_gears.dynamics.speed_ramp import RampClock, inertia_forces
from fenics_gears.dynamics.stepping import EquationsOfMotion
from fenics_gears.dynamics.train import coordinates_of_mesh, drivetrain_of_mesh, train_drivetrain
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.data import Load, Motion, Scene
from fenics_gears.scene.train import TrainScene
from fenics_gears.scene.train_mesh import MeshOfScene, OfMeshes, rows_of
from fenics_gears.scene.train_shafts import TrainShafts

from .drivetrain import mesh_stiffness
from .face_resolution import face_discretisation
from .model import Model, model_of
from .planetary_windows import coarser, largest_torque, narrowed, with_own_nodes
from .shared_gears import reach_of_alike
from .train_parts import (
    bent_of,
    check_alike,
    check_supports,
    model_of_mesh,
    offsets_of,
    parts_of,
    set_in_time,
    whole_steps,
    whole_torques,
)

if TYPE_CHECKING:
    from fenics_gears.dynamics.train_shafts import BentShafts


REVERSED = (
    "{}: as the carrier sees it, the {} drives; the set is run with the sun driving: without friction its forces are"
    " the same, in the reverse order of time"
)


@dataclass(frozen=True)
class RowModel(OfMeshes):
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
    def drivetrain(self) -> Drivetrain:
        parts = parts_of(self.meshes, self.shafts)
        carrier = self.shafts.carrier
        if carrier is not None and carrier.in_time:
            own = set_in_time(carrier, self.shafts.load, abs(parts.pairs[0].centre_distance))
            return set_drivetrain(parts, own, self.shafts.damping, self.mesh_stiffness)
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
        common = self.drivetrain, first.time_step, first.friction_coefficient, self.time_scales
        ramp = self.ramp
        if ramp is None or self.drivetrain.mass is None:
            return EquationsOfMotion(*common, SteadyClock(first.time_step))
        turned = self.input_speed / ramp.start
        load = inertia_forces(ramp, turned * self.drivetrain.nominal_momentum)
        return EquationsOfMotion(*common, ramp, (load,))

    @property
    def slowest(self) -> Model:
        """The model of the slowest mesh."""
        return max(self.models, key=lambda model: model.resolution.steps_per_mesh_cycle)

    @property
    def input_speed(self) -> float:
        """Speed of the first shaft at the start, rad/s."""
        first = self.models[self.graph.out_of(0)[0]]
        return 2.0 * pi * first.scene.motion.mesh_frequency / first.pair.pinion.teeth

    @property
    def ramp(self) -> RampClock | None:
        """The times of steps of a speed ramp, by the cycles of the slowest mesh; None without one."""
        ramp = self.shafts.ramp
        if ramp is None:
            return None
        start = self.slowest.scene.motion.mesh_frequency
        steps = self.slowest.resolution.steps_per_mesh_cycle
        end = start * ramp.end_speed / self.input_speed
        return RampClock(start, end, ramp.hold_cycles * steps, self.steps, steps)

    @property
    def steps(self) -> int:
        """Steps of the run: whole cycles of the slowest mesh."""
        return self.slowest.steps

    @property
    def passes_once(self) -> bool:
        """Whether the run passes each position of all meshes together once."""
        return self.steps <= lcm(*(model.resolution.steps_per_mesh_cycle for model in self.models))

    @cached_property
    def vibrations(self) -> list[Vibration]:
        """The elastic modes with one tooth pair in each mesh, about; empty without inertia."""
        if self.drivetrain.mass is None:
            return []
        return vibrations(self.drivetrain, self.mesh_stiffness, self.models[0].scene.friction is not None)

    @property
    def time_scales(self) -> TimeScales:
        """How mesh frequencies and time step compare with the vibrations."""
        if not self.vibrations:
            return FOLLOWING
        elastic = np.array([each.frequency for each in self.vibrations])
        frequencies = [model.scene.motion.mesh_frequency * part for model in self.models for part in self._speeds]
        return time_scales(elastic, frequencies, self.models[0].time_step)

    @property
    def _speeds(self) -> tuple[float, float]:
        """The speeds at the start and at the end, as parts of that at the start."""
        return 1.0, 1.0 if self.shafts.ramp is None else self.shafts.ramp.end_speed / self.input_speed

    @property
    def warnings(self) -> list[str]:
        """Sentences on the motion of all meshes together."""
        carrier = self.shafts.carrier
        if carrier is not None and not carrier.set.sun_drives:
            return [REVERSED.format(carrier.stage, carrier.set.second)]
        if not self.vibrations:
            return []
        fastest = max(self.models, key=lambda model: model.scene.motion.mesh_frequency)
        steps = fastest.resolution.steps_per_mesh_cycle
        frequency = fastest.scene.motion.mesh_frequency * max(self._speeds)
        return time_step_warnings(self.vibrations, frequency, steps, self.time_scales, fastest.time_step)

    @property
    def warnings_of_meshes(self) -> list[str]:
        """Sentences on each mesh, with its name."""
        found = []
        for mesh, own in zip(self.meshes, self.models):
            # Meshes that are like others have the same.
            known = () if mesh.like is None else self.models[mesh.like].warnings
            found += [f"{mesh.name}: {mesh.words(said)}" for said in own.warnings if said not in known]
        return found

    @property
    def over_face(self) -> bool:
        """Whether flanks are resolved over the face: of all meshes or of none."""
        return self.models[0].scene.three_dimensional

    @property
    def members(self) -> list[list[int]]:
        """Numbers of its meshes, those together that have a gear in common."""
        return self.graph.members

    @property
    def placed(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """Of each mesh, how its own coordinates (l, k) follow from those of all, and where they are (l,) as nothing
        moves."""
        offsets = offsets_of(self.meshes, self.shafts, [model.drivetrain.coordinates for model in self.models])
        return list(zip(self.drivetrain.of_meshes, offsets))

    @property
    def phases(self) -> list[tuple[float, int]]:
        """Of each mesh the mesh cycles by which it is past a start of contact as the run begins, and the whole steps
        by which it is ahead of that: meshes that are like others pass the very same places."""
        known = self.layout.phases
        found = []
        for mesh, model, phase in zip(self.meshes, self.models, known):
            if mesh.like is None:
                found.append((phase, 0))
                continue
            steps = model.resolution.steps_per_mesh_cycle
            begins = known[mesh.like]
            over, under = mesh.ahead
            whole = round(phase - begins - over / under)
            found.append((begins, over * steps // under + steps * whole))
        return found

    def gear(self, gear: int) -> Gear:
        """A gear by its number."""
        return self.layout.gear(gear)

    def key_of_shared(self, gear: int) -> tuple[Gear, Material, Discretisation, Reach]:
        """What the section of a gear of several meshes depends on, gear and material first."""
        mesh, side = self.graph.sides[gear][0]
        material = self.models[mesh].scene.gears.material_of(GEARS[side])
        likes = [mesh.like for mesh in self.meshes]
        reach = reach_of_alike(self.models, self.layout, gear, likes)
        return self.gear(gear), material, self._discretisation_of(gear), reach

    def keys_of_shared(self, gear: int) -> tuple:
        """What the body of a gear of several meshes depends on, gear and material first."""
        return *self.key_of_shared(gear), self.solid_discretisation_of(gear) if self.over_face else None

    def _discretisation_of(self, gear: int) -> Discretisation:
        """How a gear of several meshes is divided: finer where the tip of any mate may press."""
        parts = [self.models[mesh].resolution.discretisation(side) for mesh, side in self.graph.sides[gear]]
        tips = [part.mate_tip for part in parts if part.mate_tip is not None]
        both = (min(each[0] for each in tips), max(each[1] for each in tips)) if tips else None
        return replace(parts[0], mate_tip=both)

    def solid_discretisation_of(self, gear: int) -> FaceDiscretisation:
        """How the body of a gear of several meshes is divided: in the layers of the mesh that has most."""
        parts = [face_discretisation(self.models[mesh], side) for mesh, side in self.graph.sides[gear]]
        return replace(parts[0], layers=max(part.layers for part in parts))


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


def train_model_of(scene: TrainScene) -> TrainModel:
    """The model of a train. Raises SceneError for what trains do not have yet, and as `model_of` of each mesh."""
    return TrainModel(scene, tuple(_row_of(part, numbers) for part in scene.parts for numbers in part.rows))


def _row_of(scene: TrainScene, numbers: Sequence[int]) -> RowModel:
    """The row of these meshes of a train."""
    meshes = tuple(scene.meshes[number] for number in numbers)
    if len(meshes) == 1 and not scene.shafts.moving:
        return RowModel(meshes, (replace(model_of(meshes[0].scene), of_slowest=Fraction(1)),))
    return together(meshes, scene.shafts, scene.recorded_cycles)


def together(meshes: Sequence[MeshOfScene], shafts: TrainShafts, recorded_cycles: int = 1) -> RowModel:
    """Meshes that move together, their cycles divided into steps of one length in time; `recorded_cycles` as of
    TrainScene."""
    check_supports(meshes)
    known: list[tuple[Scene, Model]] = []
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
    return row if ramp is None else replace(row, models=tuple(replace(each, own_clock=ramp) for each in found))


def _flank_sizes(meshes: Sequence[MeshOfScene], models: Sequence[Model]) -> list[float]:
    """Sizes (mm) of flank elements: an idler has one mesh of elements, and so has its row."""
    sizes = [model.resolution.flank_element_size for model in models]
    found = []
    for row in rows_of(meshes):
        found += [min(sizes[number] for number in row)] * len(row)
    return found
