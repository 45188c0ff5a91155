"""A scene made ready: everything that follows from it without computing to speak of."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.dynamics.clock import Clock, SteadyClock
from fenics_gears.dynamics.drivetrain import Drivetrain, drivetrain
from fenics_gears.dynamics.pace import FOLLOWING, Pace, pace
from fenics_gears.effects import check_files, effects_on
from fenics_gears.errors import SceneError
from fenics_gears.geometry.modification import corner, removals
from fenics_gears.geometry.pair import GearPair, gear_pair
from fenics_gears.geometry.pair_checks import design_warnings
from fenics_gears.geometry.rough_stiffness import mesh_stiffness
from fenics_gears.resolution import Resolution, locking_warnings, resolution_warnings, resolve
from fenics_gears.scene.data import LAST_CYCLES, Scene

if TYPE_CHECKING:
    from fenics_gears.dynamics.frequencies import Vibration


@dataclass(frozen=True)
class Model:
    """A scene ready to be computed: its gear pair, its drivetrain, how finely, and the material removed from either flank."""

    scene: Scene
    pair: GearPair
    drivetrain: Drivetrain
    resolution: Resolution
    removal: tuple

    @property
    def time_step(self) -> float:
        """Length of a step, s; of the longest where they are not all as long."""
        if any(effect.clock is not None for effect in effects_on(self.scene)):
            return max(self.clock.duration(0, 1), self.clock.duration(self.steps - 1, self.steps))
        return 1.0 / (self.scene.motion.mesh_frequency * self.resolution.steps_per_mesh_cycle)

    @property
    def clock(self) -> Clock:
        """When a step is."""
        clocks = [effect.clock(getattr(self.scene, effect.section), self) for effect in effects_on(self.scene) if effect.clock is not None]
        return clocks[0] if clocks else SteadyClock(self.time_step)

    @property
    def loads(self) -> tuple[Callable[[float], np.ndarray], ...]:
        """What acts on the centre coordinates besides the drivetrain's constant load: forces (k,), N, at a step."""
        return tuple(effect.load(getattr(self.scene, effect.section), self) for effect in effects_on(self.scene) if effect.load is not None)

    @property
    def steps(self) -> int:
        """Steps of the whole run."""
        return self.scene.motion.mesh_cycles * self.resolution.steps_per_mesh_cycle

    @property
    def stored_steps(self) -> int:
        """Steps that are kept: the recorded cycles, both ends included."""
        return self.scene.motion.recorded_cycles * self.resolution.steps_per_mesh_cycle + 1

    @property
    def corner(self):
        """How tips touch off the line of action (`contact.corner`); None where the scene does not ask for it."""
        return corner(self.scene, self.pair)

    @property
    def stored_bytes(self) -> float:
        """Size of the result in memory: four arrays over stored steps, the tooth pairs counted through them, and contact nodes; root stress."""
        pairs = self.scene.motion.recorded_cycles + self.pair.contact_ratio + 2.0
        root_stress = ROOT_STRESS_VALUES if self.scene.output.root_stress else 0
        return 8.0 * self.stored_steps * pairs * (4.0 * self.resolution.contact_grid.nodes + root_stress)

    @property
    def vibrations(self) -> list[Vibration]:
        """The drivetrain's elastic modes with one tooth pair in mesh, about; empty without inertia."""
        if self.drivetrain.mass is None:
            return []
        from fenics_gears.dynamics.frequencies import vibrations

        return vibrations(self.drivetrain, mesh_stiffness(self.scene), self.scene.friction is not None)

    @property
    def pace(self) -> Pace:
        """How mesh frequency and time step compare with the drivetrain's vibrations."""
        elastic = np.array([vibration.frequency for vibration in self.vibrations])
        found = pace(elastic, self.scene.motion.mesh_frequency, self.time_step) if len(elastic) else FOLLOWING
        if self.scene.tooth_elasticity is not None or self.drivetrain.mass is None:
            return found
        # Above its drivetrain's vibrations a pair with rigid flanks still moves as its geometry says.
        return replace(found, impulsive=True, outruns_vibration=False)

    @property
    def warnings(self) -> list[str]:
        """What a user should know before the run: thin tips, contact or vibrations not resolved, inertia that does not matter."""
        found = [*self._unrecorded(), *design_warnings(self.pair), *resolution_warnings(self.resolution)]
        found += locking_warnings(self.resolution, self.scene.gears.materials)
        for effect in effects_on(self.scene):
            if effect.warnings is not None:
                found += effect.warnings(getattr(self.scene, effect.section), self)
        if self.corner is not None:
            from fenics_gears.contact.corner import edge_warnings

            found += edge_warnings(self.pair, self.corner)
        if self.vibrations:
            from fenics_gears.dynamics.guidance import judged_frequency, time_step_warnings

            steps = self.resolution.steps_per_mesh_cycle
            judged = judged_frequency(self.vibrations, self.scene.mesh_frequencies)
            found += time_step_warnings(self.vibrations, judged, steps, self.pace, self.time_step)
        return found

    def _unrecorded(self) -> list[str]:
        """A sentence where cycles are not stored that differ from those that are, and nobody has asked for so few."""
        motion = self.scene.motion
        if not motion.fewer_where_too_large or motion.recorded_cycles == motion.mesh_cycles:
            return []
        return [
            f"only the last {motion.recorded_cycles} of {motion.mesh_cycles} mesh cycles, which are not alike, are stored, and the transmission error is "
            f"theirs: a result of all would hold more than {MOST_UNASKED_BYTES / 1e9:g} GB; motion.recorded_cycles says how many to store"
        ]


# Of a result; less where a scene does not say how much is to be stored.
MOST_STORED_BYTES, MOST_UNASKED_BYTES = 4e9, 1e9
# Of one tooth pair at one time: both gears, both fillets, 25 points.
ROOT_STRESS_VALUES = 100


def model(scene: Scene) -> Model:
    """Everything about a scene that needs no computing to speak of.

    Raises GeometryError for impossible gears, SceneError for a result too large to be held, or for files that do not fit the scene.
    """
    pair = gear_pair(scene.gears)
    check_files(scene, pair)
    shafts = drivetrain(scene, pair)
    built = Model(scene, pair, shafts, resolve(scene, pair, shafts), removals(scene, pair))
    if scene.motion.fewer_where_too_large and built.stored_bytes > MOST_UNASKED_BYTES:
        last = replace(scene.motion, recorded_cycles=min(LAST_CYCLES, scene.motion.mesh_cycles))
        built = replace(built, scene=replace(scene, motion=last))
    if built.stored_bytes > MOST_STORED_BYTES:
        raise SceneError(
            f"motion.recorded_cycles = {scene.motion.recorded_cycles}: the result would hold {built.stored_bytes / 1e9:.3g} GB, at most "
            f"{MOST_STORED_BYTES / 1e9:g} GB are allowed; record fewer mesh cycles, or fewer accuracy.steps_per_mesh_cycle"
        )
    return built
