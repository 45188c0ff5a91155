"""What meshes of a train that move together are made of: gears, shafts, supports, and steps of one length in time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import ceil, gcd, inf, lcm
from typing import TYPE_CHECKING

from fenics_gears.dynamics.train import TrainParts, idler_turn
from fenics_gears.errors import SceneError
from fenics_gears.inputs.problem import NOTHING_DONE
from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.data import Scene
from fenics_gears.scene.train import MeshOfScene, rows_of
from fenics_gears.scene.train_pair_shafts import in_words_of_train
from fenics_gears.scene.train_shafts import TrainShafts

from .drivetrain import lumped_gears
from .model import Model, model_of

if TYPE_CHECKING:
    from fenics_gears.dynamics.train_shafts import BentShafts
    from fenics_gears.geometry.gear_data import LumpedGear

# Steps of the mesh cycles of all meshes together: each has its contact operators.
MOST_POSITIONS = 20000


def parts_of(meshes: Sequence[MeshOfScene], shafts: TrainShafts) -> TrainParts:
    """What the equations of motion of some meshes are put together of."""
    pairs = [mesh.pair for mesh in meshes]
    idlers = [number > 0 and mesh.idler is not None for number, mesh in enumerate(meshes)]
    turned = [
        idler_turn(pairs[number - 1], pairs[number], mesh.idler.to_first, mesh.idler.to_second)
        if idlers[number] and mesh.idler is not None
        else None
        for number, mesh in enumerate(meshes)
    ]
    masses: list[LumpedGear] = []
    supports: list[tuple[float, float] | None] = []
    for idler, mesh in zip(idlers, meshes):
        inert = mesh.scene.inertia is not None
        lumped = lumped_gears(mesh.scene, mesh.pair) if inert else {}
        for gear in GEARS[1 if idler else 0 :]:
            masses += [lumped[gear]] if inert else []
            supports.append(_support(mesh.scene, gear))
    torque = meshes[-1].scene.load.wheel_torque
    torsion = [inf if each is None else each for each in shafts.torsion or (None,) * (len(pairs) + 1)]
    for number, stiffness in torsions(meshes, shafts).items():
        torsion[number] = stiffness
    return TrainParts(pairs, idlers, torque, torsion, masses, supports, turned, shafts.load)


def torsions(meshes: Sequence[MeshOfScene], shafts: TrainShafts) -> Mapping[int, float]:
    """Torsional stiffness (N mm/rad) of the shafts that bend, by their numbers."""
    if not shafts.bent:
        return {}
    # Trains on rigid shafts load neither beams nor bearings.
    from .train_shafts import torsions_of

    return torsions_of(meshes, shafts)


def _support(scene: Scene, gear: str) -> tuple[float, float] | None:
    """Stiffness (N/mm) of a gear's support along and off the line of action; None where its centre is fixed."""
    if scene.bearings is None:
        return None
    along = scene.bearings.of(gear, "x")
    off = scene.bearings.of(gear, "y")
    return None if along is None or off is None else (along, off)


def whole_steps(meshes: Sequence[MeshOfScene], least: Sequence[int]) -> list[int]:
    """Steps of the cycle of each mesh, all of one length in time and at least so many: whole numbers, by the teeth of
    the gears on each shaft. Raises SceneError where they are too many."""
    lengths = [Fraction(1)]
    for before, mesh in zip(meshes, meshes[1:]):
        lengths.append(lengths[-1] * Fraction(before.pair.wheel.teeth, mesh.pair.pinion.teeth))
    whole = lcm(*(each.denominator for each in lengths))
    units = [int(each * whole) for each in lengths]
    common = gcd(*units)
    units = [each // common for each in units]
    times = max(ceil(wanted / unit) for wanted, unit in zip(least, units))
    steps = [times * unit for unit in units]
    if sum(steps) > MOST_POSITIONS:
        raise SceneError(
            f"stages: their mesh cycles have steps of one length in {' : '.join(map(str, steps))} steps; allowed are"
            f" up to {MOST_POSITIONS} of all meshes together. Take numbers of teeth with common factors, fewer stages,"
            f" or fewer accuracy.steps_per_mesh_cycle, or leave out what makes stages move together. {NOTHING_DONE}"
        )
    return steps


def check_supports(meshes: Sequence[MeshOfScene]) -> None:
    """Raise SceneError for an idler whose support has directions: those of either mesh would be meant."""
    for before, mesh in zip(meshes, meshes[1:]):
        if mesh.idler is None:
            continue
        of_idler = [_support(before.scene, GEARS[1]), _support(mesh.scene, GEARS[0])]
        if of_idler[0] != of_idler[1] or of_idler[0] is not None and of_idler[0][0] != of_idler[0][1]:
            raise SceneError(
                f"{mesh.name}: bearings of an idler have one stiffness in all directions. Allowed: bearings.stiffness,"
                f" for all gears of the row. {NOTHING_DONE}"
            )


def model_of_mesh(mesh: MeshOfScene, scene: Scene) -> Model:
    """As `model_of`, of a mesh with such a scene; what is wrong with shafts is said with their names in the train."""
    try:
        return model_of(scene)
    except SceneError as error:
        if not mesh.bent:
            raise
        raise SceneError(in_words_of_train(mesh.bent, str(error))) from error


def bent_of(meshes: Sequence[MeshOfScene], shafts: TrainShafts) -> BentShafts | None:
    if not shafts.bent:
        return None
    # Trains on rigid shafts load neither beams nor bearings.
    from .train_shafts import bent_shafts

    return bent_shafts(meshes, shafts)


def check_alike(meshes: Sequence[MeshOfScene], models: Sequence[Model]) -> None:
    """Raise SceneError for what meshes that move together do not have yet."""
    in_rows = [models[number] for row in rows_of(meshes) if len(row) > 1 for number in row]
    for model in in_rows:
        if model.pair.effective_face_widths != (model.pair.face_width,) * 2:
            raise SceneError(
                "gears of a row that are not equally wide are not yet computed. Allowed: one face_width for the row."
                f" {NOTHING_DONE}"
            )
    coefficients = {model.friction_coefficient for model in models}
    if len(coefficients) > 1:
        raise SceneError(
            "friction: its formula gives each mesh another coefficient"
            f" ({', '.join(f'{each:.4g}' for each in sorted(coefficients))}), which is not yet computed where meshes"
            f" move together. Allowed: one friction.coefficient. {NOTHING_DONE}"
        )
