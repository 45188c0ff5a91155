"""The model of a train: the models of the pairs of its meshes, and which of them share gears.

Between stages shafts are rigid and hand on torque and rotation alone: each stage is computed by itself. The meshes of
a row with idlers are computed together.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from fenics_gears.dynamics.row import RowDrivetrain, drivetrain_of_mesh, row_drivetrain
from fenics_gears.dynamics.stepping import EquationsOfMotion
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.inputs.problem import NOTHING_DONE
from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.data import Scene
from fenics_gears.scene.train import MeshOfScene, TrainScene, rows_of

from .model import Model, model_of


@dataclass(frozen=True)
class RowModel:
    """Meshes of a train that idlers couple, or a single one: its `meshes` and the models of their pairs."""

    meshes: tuple[MeshOfScene, ...]
    models: tuple[Model, ...]

    @property
    def single(self) -> bool:
        """Whether it has no idler."""
        return len(self.models) == 1

    @property
    def drivetrain(self) -> RowDrivetrain:
        return row_drivetrain([each.pair for each in self.models], self.models[-1].scene.load.wheel_torque)

    @property
    def equations_of_motion(self) -> EquationsOfMotion:
        first = self.models[0]
        return EquationsOfMotion(
            self.drivetrain, first.time_step, first.friction_coefficient, first.time_scales, first.clock
        )

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
        round_about = teeth * round(0.5 * (least + most) / teeth)
        same = max(model.touching.reach.same for model in (first, second))
        return Reach(same, (least - round_about, most - round_about))

    def key_of_idler(self, mesh: int) -> tuple[Gear, Material, Discretisation, Reach]:
        """What the body of the idler behind a mesh depends on, gear and material first."""
        own = self.models[mesh]
        material = own.scene.gears.material_of(GEARS[1])
        return own.pair.wheel, material, self.discretisation_of_idler(mesh), self.reach_through(mesh)

    @property
    def keys_of_idlers(self) -> list[tuple]:
        """Of all its idlers."""
        return [self.key_of_idler(mesh) for mesh in range(len(self.models) - 1)]

    def discretisation_of_idler(self, mesh: int) -> Discretisation:
        """How the idler behind a mesh is divided: finer where the tip of either mate may press."""
        parts = self.models[mesh].resolution.discretisation(1), self.models[mesh + 1].resolution.discretisation(0)
        tips = [part.mate_tip for part in parts if part.mate_tip is not None]
        both = (min(each[0] for each in tips), max(each[1] for each in tips)) if tips else None
        return replace(parts[0], mate_tip=both)


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
    rows = []
    for numbers in rows_of(scene.meshes):
        meshes = tuple(scene.meshes[number] for number in numbers)
        rows.append(RowModel(meshes, _models([mesh.scene for mesh in meshes])))
    return TrainModel(scene, tuple(rows))


def _models(scenes: list[Scene]) -> tuple[Model, ...]:
    """Of a single mesh as of a pair; of those of a row with one division of flanks and cycles."""
    models = [model_of(each) for each in scenes]
    if len(models) == 1:
        return tuple(models)
    # An idler has one mesh of elements, and all meshes the same steps.
    finest = min(model.resolution.flank_element_size for model in models)
    steps = max(model.resolution.steps_per_mesh_cycle for model in models)
    models = [
        model_of(replace(each, accuracy=replace(each.accuracy, flank_element_size=finest, steps_per_mesh_cycle=steps)))
        for each in scenes
    ]
    _check(models)
    return tuple(
        replace(model, drivetrain=drivetrain_of_mesh(model.pair, model.scene.load.wheel_torque)) for model in models
    )


def _check(models: list[Model]) -> None:
    """Raise SceneError for what a row with idlers does not have yet."""
    for model in models:
        if model.pair.effective_face_widths != (model.pair.face_width,) * 2:
            raise SceneError(
                "gears of a row that are not equally wide are not yet computed. Allowed: one face_width for the row."
                f" {NOTHING_DONE}"
            )
    coefficients = {model.friction_coefficient for model in models}
    if len(coefficients) > 1:
        raise SceneError(
            "friction: its formula gives each mesh of the row another coefficient"
            f" ({', '.join(f'{each:.4g}' for each in sorted(coefficients))}), which is not yet computed. Allowed: one"
            f" friction.coefficient. {NOTHING_DONE}"
        )
