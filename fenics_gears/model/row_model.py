"""Meshes of a train that move together, ready to be computed: the models of their pairs and the drivetrain of all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from math import lcm, pi
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.dynamics.clock import TimeScales, time_scales
from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.dynamics.frequencies import Vibration, vibrations
from fenics_gears.dynamics.guidance import time_step_warnings
from fenics_gears.dynamics.set_in_time import set_drivetrain
from fenics_gears.dynamics.speed_ramp import RampClock, centrifugal_forces, inertia_forces
from fenics_gears.dynamics.stepping import EquationsOfMotion, VaryingLoad
from fenics_gears.dynamics.train import train_drivetrain
from fenics_gears.dynamics.train_shafts import with_bent_shafts
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.elasticity.whole_body.ring_on_points import Points
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.train_mesh import MeshOfScene, OfMeshes
from fenics_gears.scene.train_shafts import TrainShafts

from .drivetrain import mesh_stiffness
from .face_resolution import face_discretisation
from .model import Model
from .shared_gears import reach_of_alike
from .train_parts import bent_of, offsets_of, parts_of, set_in_time

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

    def changed(self, change: Callable[[Model], Model]) -> RowModel:
        """The same with the models of all meshes changed."""
        return replace(self, models=tuple(map(change, self.models)))

    @property
    def single(self) -> bool:
        """Whether it is a pair by itself."""
        return len(self.models) == 1 and not self.shafts.moving

    @cached_property
    def drivetrain(self) -> Drivetrain:
        parts = parts_of(self.meshes, self.shafts)
        carrier = self.shafts.carrier
        if carrier is not None and carrier.in_time:
            slowest = self.slowest
            step = 1.0 / (slowest.scene.motion.mesh_frequency * slowest.resolution.steps_per_mesh_cycle)
            own = set_in_time(carrier, self.shafts.load, abs(parts.pairs[0].centre_distance), step)
            return set_drivetrain(parts, own, self.shafts.damping, self.mesh_stiffness)
        if self.bent is None:
            return train_drivetrain(parts, self.shafts.damping, self.mesh_stiffness)
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
        """Those of the first mesh, with the drivetrain of all and the largest coefficient of friction."""
        loads: tuple[VaryingLoad, ...] = ()
        ramp = self.ramp
        if ramp is not None:
            turned = self.input_speed / ramp.start
            loads = (inertia_forces(ramp, turned * self.drivetrain.nominal_momentum),)
            if self.drivetrain.frame is not None:
                loads = (*loads, centrifugal_forces(ramp, self.drivetrain.frame.load))
        own = self.models[0].equations_of_motion
        own = replace(own, drivetrain=self.drivetrain, time_scales=self.time_scales, loads=loads)
        return replace(own, friction=self.friction)

    @property
    def friction(self) -> float:
        """The largest coefficient of friction; 0 without friction."""
        return max(model.friction_coefficient for model in self.models)

    @property
    def frictions(self) -> list[float]:
        """The coefficient of each mesh by the largest one, 0 of one without; 1 where no mesh has friction."""
        return [model.friction_coefficient / self.friction if self.friction else 1.0 for model in self.models]

    @property
    def slowest(self) -> Model:
        """The model of the slowest mesh."""
        return max(self.models, key=lambda model: model.resolution.steps_per_mesh_cycle)

    @property
    def input_speed(self) -> float:
        """Speed of the first shaft at the start, rad/s; of the sun as a carrier sees it."""
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
        return RampClock(start, start * self._speeds[1], ramp.hold_cycles * steps, self.steps, steps)

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
        frictional = [model.scene.friction is not None for model in self.models]
        across = np.repeat(frictional, len(self.drivetrain.mesh.across) // len(frictional))
        return vibrations(self.drivetrain, self.mesh_stiffness, across)

    @property
    def time_scales(self) -> TimeScales:
        """How mesh frequencies and time step compare with the vibrations."""
        frequencies = [model.scene.motion.mesh_frequency * part for model in self.models for part in self._speeds]
        return time_scales(self.vibrations, frequencies, self.models[0].time_step)

    @property
    def _speeds(self) -> tuple[float, float]:
        """The speeds at the start and at the end, as parts of that at the start."""
        if self.shafts.ramp is None:
            return 1.0, 1.0
        carrier = self.shafts.carrier
        at_start = None if carrier is None else carrier.speed
        return 1.0, self.shafts.ramp.end_speed / (at_start or self.input_speed)

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

    def points_of(self, gear: int) -> Points | None:
        """What a gear of several meshes stands on, None unless on points: their angles from the centreline of its tooth
        0 as the frame of its first mesh has them, and their stiffness per face width."""
        mesh, side = self.graph.sides[gear][0]
        points = self.models[mesh].scene.wheel_points
        if points is None or GEARS[side] != "wheel":
            return None
        sense = self.graph.sense(mesh)
        # Of an internal gear the radii are negative: its teeth are on the other side of the centre.
        tooth = self.layout.tooth_angle(gear) + pi
        width = self.models[mesh].pair.face_width
        angles = tuple(sense * (angle - tooth) for angle in points.places)
        return angles, (points.radial_stiffness / width, points.tangential_stiffness / width)

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
