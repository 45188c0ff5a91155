"""What meshes of a train that move together are made of: gears, shafts, supports, and steps of one length in time."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import replace
from math import ceil, gcd, inf, lcm
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.dynamics.set_in_time import SetInTime
from fenics_gears.dynamics.train import TrainParts
from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear_data import LumpedGear
from fenics_gears.geometry.planetary import CARRIER, WITH_RING
from fenics_gears.geometry.train_graph import turns_of_shafts
from fenics_gears.inputs.problem import NOTHING_DONE
from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.data import Scene
from fenics_gears.scene.train_mesh import MeshOfScene, gear_names, layout_of
from fenics_gears.scene.train_shafts import TrainShafts

from .drivetrain import lumped_gears, support_of
from .model import Model, differ_only, model_of
from .shared_gears import check_shared
from .train_shafts import bent_shafts, turning_of

if TYPE_CHECKING:
    from fenics_gears.dynamics.train_shafts import BentShafts
    from fenics_gears.scene.carrier import Carrier

Known = deque[tuple[Scene, Model]]
# Steps of the mesh cycles of all meshes together: each has its contact operators.
MOST_POSITIONS = 20000


def parts_of(meshes: Sequence[MeshOfScene], shafts: TrainShafts) -> TrainParts:
    """What the equations of motion of some meshes are put together of."""
    layout = layout_of(meshes)
    graph = layout.graph
    masses: list[LumpedGear] = []
    supports: list[tuple[float, float] | None] = []
    for sides in graph.sides:
        first, side = sides[0]
        mesh = meshes[first]
        if mesh.scene.inertia is not None:
            masses.append(lumped_gears(mesh.scene, mesh.pair)[GEARS[side]])
        name = mesh.gears[side]
        if shafts.carrier is not None and shafts.carrier.in_time:
            lumped = shafts.carrier.lumped(name.partition(".")[2].split()[0])
            masses.append(LumpedGear(lumped.mass, lumped.moment_of_inertia, mesh.pair.face_width))
        supports.append(support_of(mesh.scene, GEARS[side]) if shafts.carrier is None else shafts.carrier.support(name))
    given = {each.shaft: each.torque for each in shafts.loads}
    torques = [
        given.get(shaft, 0.0)
        if graph.out_of(shaft)
        else sum(meshes[mesh].scene.load.wheel_torque for mesh in graph.into(shaft))
        for shaft in range(graph.last + 1)
    ]
    torsion = [inf if each is None else each for each in shafts.torsion or (None,) * (graph.last + 1)]
    turning: list[int] = []
    if shafts.bent:
        twists, turning = turning_of(meshes, shafts, graph)
        for number, twist in twists.items():
            torsion[number] = twist
    axes = [layout.axes(mesh) for mesh in range(len(meshes))]
    parts = TrainParts(graph, layout.pairs, axes, torques, torsion, masses, supports, shafts.inertias, turning)
    carrier = shafts.carrier
    if carrier is None:
        return parts
    names = gear_names(meshes)
    planets = [names.index(each) for each in carrier.planets]
    together = None if carrier.together is None else (planets, carrier.together)
    return replace(parts, centred=carrier.centred(names), together=together)


def set_in_time(carrier: Carrier, load: float | None, radius: float, step: float) -> SetInTime:
    """The carrier and members of a set with masses, the planets on a circle of this radius (mm); `load` (N mm s^2):
    moment of inertia of what the output drives; `step`, s: of the run at its first speed."""
    own = carrier.set
    springs = {member: getattr(carrier.vibration, member).torsional_stiffness for member in WITH_RING}
    springs[own.output] = 0.0
    # Where the sun drives the planets, torques from outside have the senses of the weights.
    behind = 1 if own.weights[own.output] > 0 else -1
    return SetInTime(
        places=radius * np.array([np.cos(own.angles), np.sin(own.angles)]).T,
        speed=(carrier.speed or 0.0) * float(own.speeds[CARRIER]) * (1 if own.sun_by_carrier > 0 else -1),
        in_a_turn=float(own.speeds[CARRIER] / own.sun_by_carrier),
        step=step,
        carrier=carrier.lumped(CARRIER).moment_of_inertia,
        load=load or 0.0,
        springs={member: spring for member, spring in springs.items() if spring is not None},
        output=own.output,
        torque=abs(own.torques(carrier.torque)[own.output]),
        behind=behind,
    )


def offsets_of(
    meshes: Sequence[MeshOfScene], shafts: TrainShafts, names_of: Sequence[tuple[str, ...]]
) -> list[np.ndarray]:
    """Of each mesh, how its own coordinates (l,), by their names, stand (mm) where nothing moves: by the clocking of
    shafts, of which the second gear is turned ahead, and by pins beside their places."""
    ahead = {carried[1]: clocking for carried, clocking in zip(shafts.carried, shafts.clocking) if clocking is not None}
    axes_of = layout_of(meshes).axes
    found = []
    for number, (mesh, names) in enumerate(zip(meshes, names_of)):
        own = np.zeros(len(names))
        # A wheel's rotation is counted against the sense in which it turns.
        for side, (gear, sign) in enumerate(zip(mesh.gears, (1.0, -1.0))):
            own[names.index(f"rotation_{side + 1}")] = sign * abs(mesh.pair.base_radii[side]) * ahead.get(gear, 0.0)
        if shafts.carrier is not None:
            own += _pins_beside(shafts.carrier, mesh, axes_of(number), names)
        found.append(own)
    return found


def _pins_beside(carrier: Carrier, mesh: MeshOfScene, axes: np.ndarray, names: tuple[str, ...]) -> np.ndarray:
    """The same (l,) of the pins of a planetary set; `axes` (2, 2) of the mesh."""
    own = np.zeros(len(names))
    for number, gear in enumerate(mesh.gears, 1):
        beside = carrier.displaced(gear)
        along = axes @ np.array([beside.real, beside.imag])
        for axis, size in zip("xy", along):
            if f"centre_{axis}{number}" in names:
                own[names.index(f"centre_{axis}{number}")] = size
    return own


def whole_torques(parts: TrainParts) -> list[float]:
    """Torque (N mm) on the wheel of each mesh without losses, as if all power went through it."""
    turns = turns_of_shafts(parts.graph, [pair.teeth for pair in parts.pairs])
    return [
        sum(torque * float(turns[shaft] / turns[driven]) for shaft, torque in enumerate(parts.torques) if torque)
        for _, driven in parts.graph.between
    ]


def whole_steps(meshes: Sequence[MeshOfScene], least: Sequence[int]) -> list[int]:
    """Steps of the cycle of each mesh, all of one length in time and at least so many: whole numbers, by the teeth of
    the gears on each shaft, and such that meshes are whole steps ahead of those that they are like. Raises SceneError
    where they are too many."""
    layout = layout_of(meshes)
    driving = [shaft for shaft, _ in layout.graph.between]
    lengths = [1 / (layout.turns[shaft] * pair.pinion.teeth) for pair, shaft in zip(layout.pairs, driving)]
    whole = lcm(*(each.denominator for each in lengths))
    units = [int(each * whole) for each in lengths]
    common = gcd(*units)
    units = [each // common for each in units]
    times = max(ceil(wanted / unit) for wanted, unit in zip(least, units))
    ahead = lcm(*(mesh.ahead[1] for mesh in meshes))
    times = ahead * ceil(times / ahead)
    steps = [times * unit for unit in units]
    if sum(steps) > MOST_POSITIONS:
        raise SceneError(
            f"stages: their mesh cycles have steps of one length in {' : '.join(map(str, steps))} steps; allowed are"
            f" up to {MOST_POSITIONS} of all meshes together. Take numbers of teeth with common factors, fewer stages,"
            f" or fewer accuracy.steps_per_mesh_cycle, or leave out what makes stages move together. {NOTHING_DONE}"
        )
    return steps


def check_supports(meshes: Sequence[MeshOfScene]) -> None:
    """Raise SceneError for a gear in several meshes whose support has directions: those of any would be meant."""
    for sides in layout_of(meshes).graph.sides:
        found = [support_of(meshes[mesh].scene, GEARS[side]) for mesh, side in sides]
        one = found[0]
        if len(found) > 1 and (set(found) != {one} or one is not None and one[0] != one[1]):
            raise SceneError(
                f"{meshes[sides[1][0]].name}: bearings of a gear in several meshes have one stiffness in all"
                f" directions. Allowed: bearings.stiffness, alike for these meshes. {NOTHING_DONE}"
            )


# Run-out and pitches of a set: its models but for their gaps are those without.
ERRORS_OF_SETS = ("eccentricity", "flank_errors")


def model_of_mesh(mesh: MeshOfScene, scene: Scene, known: Known) -> Model:
    """As `model_of`, of a mesh with such a scene, from those `known` where the meshes of other planets have the same or
    differ in their errors alone; what is wrong with shafts is said with their names in the train."""
    found = next((model for other, model in known if other == scene), None)
    if found is not None:
        return found
    found = next((model for other, model in known if mesh.of_set and differ_only(other, scene, ERRORS_OF_SETS)), None)
    if found is not None:
        return replace(found, scene=scene)
    try:
        found = model_of(scene)
        known.append((scene, found))
        return found
    except SceneError as error:
        if not mesh.bent and mesh.of_set is None:
            raise
        raise SceneError(mesh.words(str(error))) from error


def bent_of(meshes: Sequence[MeshOfScene], shafts: TrainShafts) -> BentShafts | None:
    if not shafts.bent:
        return None
    return bent_shafts(meshes, shafts)


def check_alike(meshes: Sequence[MeshOfScene], models: Sequence[Model]) -> None:
    """Raise SceneError for what meshes that move together do not have yet."""
    check_shared(layout_of(meshes), models, gear_names(meshes), [mesh.name for mesh in meshes])
    targets = list(dict.fromkeys(mesh.scene.accuracy.target for mesh in meshes))
    if len(targets) > 1:
        bare = next(mesh.name for mesh in meshes if mesh.scene.accuracy.target != meshes[0].scene.accuracy.target)
        raise SceneError(
            f"accuracy.target: {bare} has another than {meshes[0].name}, which moves together with it. Allowed: one"
            f" target for all of them, [accuracy] for the whole train. {NOTHING_DONE}"
        )
