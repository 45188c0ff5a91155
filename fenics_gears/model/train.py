"""The model of a train: the model of the pair of each mesh, how its gears are shared, and the shafts of all."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

from fenics_gears.dynamics.stepping import EquationsOfMotion
from fenics_gears.dynamics.train import TrainDrivetrain, drivetrain_of_mesh, train_drivetrain
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.errors import SceneError
from fenics_gears.inputs.problem import NOTHING_DONE
from fenics_gears.scene.data import Scene
from fenics_gears.scene.train import TrainScene

from .model import Model, model_of


@dataclass(frozen=True)
class TrainModel:
    """A train ready to be computed: `models` of its meshes in the order of the train, and its shafts."""

    scene: TrainScene
    models: tuple[Model, ...]
    drivetrain: TrainDrivetrain

    @property
    def steps(self) -> int:
        """Of the whole run: whole cycles of the slowest mesh."""
        slowest = max(self.models, key=lambda model: model.resolution.steps_per_mesh_cycle)
        return slowest.steps

    @property
    def equations_of_motion(self) -> EquationsOfMotion:
        first = self.models[0]
        return EquationsOfMotion(
            self.drivetrain, first.time_step, first.friction_coefficient, first.time_scales, first.clock
        )

    @cached_property
    def idlers(self) -> tuple[int, ...]:
        """Meshes whose wheel is the pinion of the next one."""
        return tuple(number for number, mesh in enumerate(self.scene.meshes[1:]) if mesh.idler is not None)

    def reach_through(self, mesh: int) -> Reach:
        """Between which teeth of an idler compliance is needed, of whose first mesh this is the number: on its flanks
        of either mesh, and from one to the other."""
        first, second = self.models[mesh : mesh + 2]
        idler = self.scene.meshes[mesh + 1].idler
        assert idler is not None
        one, other = (_indices(model) for model in (first, second))
        # One index further at either end: pairs a step before, and those of a mesh that is ahead by part of a cycle.
        least = -(one[1] + 1) - idler.teeth + other[0] - 1
        most = -(one[0] - 1) - idler.teeth + other[1] + 1
        teeth = first.pair.wheel.teeth
        round_about = teeth * round(0.5 * (least + most) / teeth)
        same = max(model.touching.reach.same for model in (first, second))
        return Reach(same, (least - round_about, most - round_about))

    def discretisation_of_idler(self, mesh: int) -> Discretisation:
        """How an idler is divided: finer where the tip of either mate may press."""
        parts = self.models[mesh].resolution.discretisation(1), self.models[mesh + 1].resolution.discretisation(0)
        tips = [part.mate_tip for part in parts if part.mate_tip is not None]
        both = (min(each[0] for each in tips), max(each[1] for each in tips)) if tips else None
        return replace(parts[0], mate_tip=both)

    @property
    def warnings(self) -> list[str]:
        """Sentences for the user before the run, each with the mesh that it is of."""
        return [
            f"{mesh.name}: {said}" for mesh, model in zip(self.scene.meshes, self.models) for said in model.warnings
        ]


def _indices(model: Model) -> tuple[int, int]:
    """Least and largest index of a pair that touches in a mesh."""
    steps = model.touching.steps
    return model.touching.drive[0] // steps, model.touching.drive[1] // steps


def train_model_of(scene: TrainScene) -> TrainModel:
    """The model of a train. Raises SceneError for what trains do not have yet, and as `model_of` of each mesh."""
    models = []
    for row in _rows(scene):
        own = [model_of(each) for each in row]
        finest = min(model.resolution.flank_element_size for model in own)
        if len(own) > 1:
            # An idler has one mesh of elements.
            own = [model_of(_with_elements(each, finest)) for each in row]
            _check_widths(own)
        models += own
    coefficients = {model.friction_coefficient for model in models}
    if len(coefficients) > 1:
        raise SceneError(
            "friction: its formula gives each mesh of the train another coefficient"
            f" ({', '.join(f'{each:.4g}' for each in sorted(coefficients))}), which is not yet computed. Allowed: one"
            f" friction.coefficient. {NOTHING_DONE}"
        )
    pairs = [model.pair for model in models]
    own = [replace(model, drivetrain=drivetrain_of_mesh(model.pair, model.scene.load.wheel_torque)) for model in models]
    return TrainModel(scene, tuple(own), train_drivetrain(pairs, scene.output_torque))


def _rows(scene: TrainScene) -> Iterator[list[Scene]]:
    """Scenes of meshes that share gears, a row at a time."""
    row: list[Scene] = []
    for mesh in scene.meshes:
        if row and mesh.idler is None:
            yield row
            row = []
        row.append(mesh.scene)
    yield row


def _with_elements(scene: Scene, size: float) -> Scene:
    return replace(scene, accuracy=replace(scene.accuracy, flank_element_size=size))


def _check_widths(models: list[Model]) -> None:
    for model in models:
        if model.pair.effective_face_widths != (model.pair.face_width,) * 2:
            raise SceneError(
                "gears of a row that are not equally wide are not yet computed. Allowed: one face_width for the row."
                f" {NOTHING_DONE}"
            )
