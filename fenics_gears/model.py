"""A scene made ready: everything that follows from it without computing to speak of."""

from __future__ import annotations

from dataclasses import dataclass

from fenics_gears.dynamics.drivetrain import Drivetrain, drivetrain
from fenics_gears.geometry.modification import tip_reliefs
from fenics_gears.geometry.pair import GearPair, gear_pair
from fenics_gears.resolution import Resolution, resolve
from fenics_gears.scene.data import Scene


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
        """Length of a step, s."""
        return 1.0 / (self.scene.motion.mesh_frequency * self.resolution.steps_per_mesh_cycle)

    @property
    def steps(self) -> int:
        """Steps of the whole run."""
        return self.scene.motion.mesh_cycles * self.resolution.steps_per_mesh_cycle

    @property
    def stored_steps(self) -> int:
        """Steps that are kept: the recorded cycles, both ends included."""
        return self.scene.motion.recorded_cycles * self.resolution.steps_per_mesh_cycle + 1


def model(scene: Scene) -> Model:
    """Everything about a scene that needs no computing to speak of. Raises GeometryError for impossible gears."""
    pair = gear_pair(scene.gears)
    shafts = drivetrain(scene, pair)
    removal = (None, None) if scene.tip_relief is None else tip_reliefs(pair, scene.tip_relief)
    return Model(scene, pair, shafts, resolve(scene, pair, shafts), removal)
