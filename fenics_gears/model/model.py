"""A scene made ready: all that follows from it before anything expensive is computed."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, partial
from math import ceil, inf, lcm
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.contact.face import Face, one_slice
from fenics_gears.contact.places import Touching, touching
from fenics_gears.dynamics.clock import Clock, SteadyClock, TimeScales, time_scales
from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.dynamics.frequencies import Vibration, vibrations
from fenics_gears.dynamics.guidance import judged_frequency, time_step_warnings
from fenics_gears.dynamics.stepping import EquationsOfMotion
from fenics_gears.effects import check_files, common_period, from_effects
from fenics_gears.errors import SceneError
from fenics_gears.geometry.pair import GearPair, gear_pair
from fenics_gears.geometry.pair_checks import design_warnings
from fenics_gears.scene.data import HUNTING_TOOTH_PERIOD, LAST_CYCLES, Scene
from fenics_gears.scene.schema import MOST_CYCLES, WORDS

from .drivetrain import drivetrain, mesh_stiffness
from .modification import check_bodies, corner, removals, rim_warnings
from .resolution import Resolution, locking_warnings, resolution_warnings, resolve
from .storage import Arrays, counted_bytes, packed_bytes, sizes, stored_arrays, support_points

if TYPE_CHECKING:
    from fenics_gears.elasticity.face.discretisation import FaceDiscretisation


@dataclass(frozen=True)
class Model:
    """A scene ready to be computed: its gear pair, its drivetrain, how finely, and the material removed from either
    flank. `contact_cycles`: mesh cycles, the last, whose contact fields are stored. Of a mesh of a train `own_clock` is
    its clock on a speed ramp, and `of_slowest` how many of its cycles are counted as one."""

    scene: Scene
    pair: GearPair
    drivetrain: Drivetrain
    resolution: Resolution
    removal: tuple
    contact_cycles: int = 0
    own_clock: Clock | None = None
    of_slowest: Fraction | None = None

    @property
    def models(self) -> list[Model]:
        """Of all meshes, as of a train: this one."""
        return [self]

    def changed(self, change: Callable[[Model], Model]) -> Model:
        """The same with the models of all meshes changed, as of a train: this one."""
        return change(self)

    @cached_property
    def clock(self) -> Clock:
        if self.own_clock is not None:
            return self.own_clock
        steady = SteadyClock(1.0 / (self.scene.motion.mesh_frequency * self.resolution.steps_per_mesh_cycle))
        return next(iter(from_effects(self.scene, "clock", self)), steady)

    @property
    def time_step(self) -> float:
        """Length of a step, s; of the longest where they are not all as long."""
        return max(self.clock.duration(0, 1), self.clock.duration(self.steps - 1, self.steps))

    @cached_property
    def loads(self) -> tuple[Callable[[float], np.ndarray], ...]:
        """Forces (k,), N, on the centre coordinates besides the drivetrain's constant load, at a step."""
        return tuple(from_effects(self.scene, "load", self))

    @cached_property
    def friction_coefficient(self) -> float:
        """Coefficient of friction, given or by a formula; 0 without friction."""
        if self.scene.friction is None:
            return 0.0
        return self.scene.friction.coefficient_of(self.scene, self.pair)

    @property
    def equations_of_motion(self) -> EquationsOfMotion:
        return EquationsOfMotion(
            self.drivetrain, self.time_step, self.friction_coefficient, self.time_scales, self.clock, self.loads
        )

    @property
    def steps(self) -> int:
        return self.scene.motion.mesh_cycles * self.resolution.steps_per_mesh_cycle

    @property
    def contact_steps(self) -> int:
        """Steps whose contact fields are stored: the last cycles, both ends included."""
        return self.contact_cycles * self.resolution.steps_per_mesh_cycle + 1 if self.contact_cycles else 0

    @cached_property
    def corner(self):
        return corner(self.scene, self.pair)

    @cached_property
    def touching(self) -> Touching:
        """Which tooth pairs can touch: how far apart loaded teeth are (`reach`), and how many pairs there are at once
        (`slots`)."""
        grid = self.resolution.contact_grid
        steps = self.resolution.steps_per_mesh_cycle
        coast = self.scene.coast_flanks is not None
        shifts = self.face.outermost_shifts
        return touching(self.pair, grid, steps, coast, self.corner, shifts)

    @cached_property
    def face(self) -> Face:
        if not self.scene.three_dimensional:
            return one_slice(self.pair.face_width)
        return _over_face().face_of(self.scene, self.pair)

    def face_opening(self, z: np.ndarray, position: np.ndarray | None = None) -> np.ndarray:
        """Gap (k,), mm, along the line of action by lead modifications and misalignment at places z (k,), mm; see
        `geometry.face`."""
        leads = self.scene.lead_modifications
        return _over_face().face_opening(self.pair, leads, self.scene.misalignment, z, position)

    @property
    def coast_face_opening(self) -> Callable[[np.ndarray, np.ndarray], np.ndarray] | None:
        """The same between the coast flanks, along their own line of action; None where nothing opens them."""
        leaning = self.scene.misalignment
        return None if leaning is None else partial(_over_face().coast_face_opening, self.pair, leaning)

    @property
    def slices_and_layers(self) -> tuple[int | None, int | None]:
        """How many slices of one width the common face has, and layers either body in it; None of a plane scene."""
        if not self.scene.three_dimensional:
            return None, None
        return self.face.evenly, _over_face().layers_of_common_face(self.scene, self.pair)

    def solid_discretisation(self, gear: int) -> FaceDiscretisation | None:
        """How the body of the pinion (0) or the wheel (1) is divided over its face; None of a plane scene."""
        return _over_face().face_discretisation(self, gear) if self.scene.three_dimensional else None

    def transmission_error(self, position: np.ndarray) -> np.ndarray:
        """T_E = phi2 + (z1/z2) phi1 [13], rad of the wheel, at centre coordinates (..., k); positive where the wheel
        lags behind, an internal one too."""
        first, second = (self.drivetrain.value(position, f"rotation_{gear}") for gear in (1, 2))
        return self.pair.wheel.sign * (second + self.pair.rotation_ratio * first)

    @cached_property
    def _stored(self) -> tuple[Arrays, dict[str, int]]:
        slots = self.touching.slots
        nodes = self.resolution.contact_grid.most_nodes
        counts = self.drivetrain.bearings, support_points(self.scene)
        size = sizes(self.steps + 1, self.contact_steps, slots, nodes, self.face.slices, *counts)
        return stored_arrays(self.scene, size), size

    @property
    def stored_bytes(self) -> int:
        return counted_bytes(*self._stored)

    @property
    def least_file_bytes(self) -> int:
        """What the result's file takes at least."""
        return packed_bytes(*self._stored)

    @cached_property
    def vibrations(self) -> list[Vibration]:
        """The drivetrain's elastic modes with one tooth pair in mesh, about; empty without inertia."""
        return vibrations(self.drivetrain, mesh_stiffness(self.scene, self.pair), self.scene.friction is not None)

    @cached_property
    def time_scales(self) -> TimeScales:
        """How mesh frequency and time step compare with the drivetrain's vibrations."""
        scales = time_scales(self.vibrations, self.scene.motion.mesh_frequency, self.time_step)
        if self.scene.tooth_elasticity is not None or self.drivetrain.mass is None:
            return scales
        # Above its drivetrain's vibrations a pair with rigid flanks still moves as its geometry says.
        return replace(scales, impulsive=True, outruns_vibration=False)

    @property
    def warnings(self) -> list[str]:
        """Sentences for the user before the run."""
        sentences = [*self._of_a_part(), *self._without_fields()]
        sentences += [each.unusual for each in self.scene.derived if each.unusual]
        sentences += [*design_warnings(self.pair), *resolution_warnings(self.resolution)]
        sentences += [*locking_warnings(self.resolution, self.scene.gears.materials), *rim_warnings(self)]
        for of_effect in from_effects(self.scene, "warnings", self):
            sentences += of_effect
        if self.scene.three_dimensional:
            sentences += _over_face().face_warnings(self)
        if self.corner is not None:
            sentences += self.corner.warnings(self.pair)
        if self.vibrations:
            steps = self.resolution.steps_per_mesh_cycle
            judged = judged_frequency(self.vibrations, self.scene.mesh_frequencies)
            sentences += time_step_warnings(self.vibrations, judged, steps, self.time_scales, self.time_step)
        return sentences

    def _of_a_part(self) -> list[str]:
        period = common_period(self.scene)
        run = self.scene.motion.mesh_cycles
        if not run < period < inf:
            return []
        whole = lcm(*self.scene.gears.teeth)
        words = f' or "{HUNTING_TOOTH_PERIOD}"' if period == whole and self.of_slowest is None else ""
        if self.of_slowest not in (None, 1):
            words = ", counted in the slowest mesh,"
        needed = ceil(period / (self.of_slowest or 1))
        remedy = f"motion.mesh_cycles = {needed}{words} goes through all"
        if needed > MOST_CYCLES:
            remedy = (
                f"no run goes through all, for motion.mesh_cycles may be {MOST_CYCLES}; to see the largest numbers,"
                " leave [eccentricity] and [flank_errors] of all gears but one out: it repeats after a turn"
            )
        return [
            f"only {run} of the {period} mesh cycles of the common period are run: cycles are not alike, and all"
            f" numbers are of a part of them; {remedy}"
        ]

    def _without_fields(self) -> list[str]:
        motion = self.scene.motion
        if not self.contact_cycles or self.contact_cycles >= motion.recorded_cycles:
            return []
        return [
            f"contact fields (pressures over the contact nodes) are stored of the last {self.contact_cycles} of"
            f" {motion.mesh_cycles} mesh cycles only: those of all would take more than"
            f" {MOST_UNASKED_BYTES / 1e9:g} GB; output.contact_fields says how many to store"
        ]


def _over_face() -> ModuleType:
    """How a face is resolved and what opens it; of scenes over the face alone."""
    from . import face_resolution

    return face_resolution


# Largest result; and the largest where the scene does not say how many contact fields to store.
MOST_STORED_BYTES = 4e9
MOST_UNASKED_BYTES = 1e9


def model_of(scene: Scene) -> Model:
    """The model of a scene: all that follows from it before anything expensive is computed.

    Raises GeometryError for impossible gears, SceneError for a result too large to be held, for layers that turn too
    far, or for files that do not fit the scene.

    >>> from fenics_gears import load_scene
    >>> model_of(load_scene("demos/lundvall2004.toml")).resolution.steps_per_mesh_cycle
    100
    """
    pair = gear_pair(scene.gears)
    check_files(scene, pair)
    check_bodies(scene, pair)  # refused here, before the run asks for them
    shafts = drivetrain(scene, pair)
    removal = removals(scene, pair)
    model = Model(scene, pair, shafts, resolve(scene, pair, shafts, removal), removal)
    from_effects(scene, "fits", model)
    if scene.three_dimensional:
        _over_face().check_layers(model)
    cycles = scene.motion.recorded_cycles if scene.output.contact_fields and scene.resolves_contact else 0
    whole = replace(model, contact_cycles=cycles)
    if cycles and scene.motion.fewer_where_too_large and whole.stored_bytes > MOST_UNASKED_BYTES:
        of_one = (whole.stored_bytes - model.stored_bytes) / cycles
        fitting = int((MOST_UNASKED_BYTES - model.stored_bytes) / of_one)
        whole = replace(model, contact_cycles=max(fitting, min(LAST_CYCLES, scene.motion.mesh_cycles)))
    if whole.stored_bytes > MOST_STORED_BYTES:
        raise SceneError(_too_large(model, whole))
    return whole


# Effects of a plane scene that change nothing of its model but the material removed from the flanks, and under light
# loads the window of contact nodes.
RELIEFS = ("tip_relief", "root_relief", "profile_modifications")


def differ_only(one: Scene, other: Scene, names: Collection[str]) -> bool:
    """Whether two scenes differ in fields of these `names` alone, and in words."""
    apart = {each for each in Scene.__dataclass_fields__ if getattr(one, each) != getattr(other, each)}
    return apart.issubset((*names, *WORDS))


def with_reliefs(model: Model, scene: Scene) -> Model:
    """The model of a plane scene that differs from that of a model in RELIEFS alone. Raises GeometryError for those
    that do not fit the flanks."""
    removal = removals(scene, model.pair)
    resolution = resolve(scene, model.pair, model.drivetrain, removal)
    return replace(model, scene=scene, removal=removal, resolution=resolution)


def _too_large(curves: Model, whole: Model) -> str:
    """Why a result is refused, and what makes it smaller."""
    allowed = f"at most {MOST_STORED_BYTES / 1e9:g} GB are allowed"
    motion = whole.scene.motion
    if curves.stored_bytes > MOST_STORED_BYTES:
        return (
            f"motion.mesh_cycles = {motion.mesh_cycles}: the curves of all steps would hold"
            f" {curves.stored_bytes / 1e9:.3g} GB, {allowed}; run fewer mesh cycles, or fewer"
            " accuracy.steps_per_mesh_cycle"
        )
    return (
        f"motion.recorded_cycles = {motion.recorded_cycles}: the result would hold {whole.stored_bytes / 1e9:.3g} GB,"
        f' {allowed}; store the contact fields of fewer mesh cycles, output.contact_fields = "last 2 cycles", or take'
        " fewer accuracy.steps_per_mesh_cycle"
    )
