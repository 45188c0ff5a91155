"""A scene made ready: everything that follows from it without computing to speak of."""

from __future__ import annotations

from dataclasses import dataclass

from fenics_gears.dynamics.drivetrain import Drivetrain, drivetrain
from fenics_gears.dynamics.frequencies import natural_frequencies
from fenics_gears.errors import SceneError
from fenics_gears.geometry.modification import tip_reliefs
from fenics_gears.geometry.pair import GearPair, gear_pair
from fenics_gears.geometry.pair_checks import design_warnings
from fenics_gears.resolution import Resolution, mesh_stiffness, resolution_warnings, resolve
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

    @property
    def stored_bytes(self) -> float:
        """Size of the result in memory: four arrays over stored steps, the tooth pairs counted through them, and contact nodes."""
        pairs = self.scene.motion.recorded_cycles + self.pair.contact_ratio + 2.0
        return 8.0 * 4.0 * self.stored_steps * pairs * self.resolution.contact_grid.nodes

    @property
    def follows_statics(self) -> bool:
        """Whether the mesh frequency lies below the lowest natural frequency that the mesh excites."""
        if self.drivetrain.mass is None:
            return True
        frequencies = natural_frequencies(self.drivetrain, mesh_stiffness(self.scene))
        elastic = frequencies[frequencies > 1e-6 * frequencies[-1]]
        return self.scene.motion.mesh_frequency < elastic[0]

    @property
    def warnings(self) -> list[str]:
        """What a user should know before the run: thin tips, contact not resolved."""
        return [*design_warnings(self.pair), *resolution_warnings(self.resolution)]

MOST_STORED_BYTES = 4e9

def model(scene: Scene) -> Model:
    """Everything about a scene that needs no computing to speak of.

    Raises GeometryError for impossible gears, SceneError for a result too large to be held.
    """
    pair = gear_pair(scene.gears)
    shafts = drivetrain(scene, pair)
    removal = (None, None) if scene.tip_relief is None else tip_reliefs(pair, scene.tip_relief)
    built = Model(scene, pair, shafts, resolve(scene, pair, shafts), removal)
    if built.stored_bytes > MOST_STORED_BYTES:
        raise SceneError(
            f"motion.recorded_cycles = {scene.motion.recorded_cycles}: the result would hold {built.stored_bytes / 1e9:.3g} GB, at most "
            f"{MOST_STORED_BYTES / 1e9:g} GB are allowed; record fewer mesh cycles, or fewer accuracy.steps_per_mesh_cycle"
        )
    return built
