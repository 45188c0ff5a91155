"""Shafts of a train that bend, with their gears, on the bearings that the scene has."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from math import inf, pi
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import block_diag

from fenics_gears.dynamics.elastic_shaft import FIVE, ElasticShaft, SeatedGear
from fenics_gears.dynamics.shaft_system import ShaftSystem
from fenics_gears.dynamics.shafts import RIGID_SEAT
from fenics_gears.dynamics.train_shafts import (
    SPACE,
    BentShafts,
    GearOnShaft,
    MeshFrame,
    even_loads,
    mesh_axes,
    shaft_axes,
    turned_motions,
)
from fenics_gears.effects.elastic_shaft_housing import check_housing, stiffness_of_seats
from fenics_gears.effects.elastic_shaft_rules import bearings_hold, held_at_work
from fenics_gears.effects.elastic_shaft_seats import seated
from fenics_gears.errors import SceneError
from fenics_gears.geometry.train_graph import TrainGraph
from fenics_gears.inputs.problem import NOTHING_DONE
from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.train_mesh import MeshOfScene, gear_names, layout_of
from fenics_gears.scene.train_shaft import BentShaft
from fenics_gears.scene.train_shafts import TrainShafts

from .drivetrain import highest_of_interest, lumped_gears

if TYPE_CHECKING:
    from fenics_gears.geometry.gear_data import LumpedGear

# Faces of two gears on a shaft (mm) are at least so far apart.
LEAST_GAP = 1e-3


def bent_shafts(meshes: Sequence[MeshOfScene], shafts: TrainShafts) -> BentShafts:
    """The shafts of a train that bend, with rolling bearings as under an even load of all their gears. Raises
    SceneError for gears that overlap on their shaft, and for bearings that do not hold it under load."""
    frames = mesh_frames(meshes)
    masses: dict[str, LumpedGear] = {}
    up_to = 0.0
    layout = layout_of(meshes)
    graph = layout.graph
    first = meshes[graph.out_of(0)[0]]
    speed = 2.0 * pi * first.scene.motion.mesh_frequency / first.pair.pinion.teeth
    faster = 1.0 if shafts.ramp is None else max(shafts.ramp.end_speed / speed, 1.0)
    for mesh in meshes:
        if mesh.scene.inertia is not None:
            of_mesh = lumped_gears(mesh.scene, mesh.pair)
            masses |= {name: of_mesh[side] for name, side in zip(mesh.gears, GEARS)}
            up_to = max(up_to, 2.0 * highest_of_interest(mesh.scene, mesh.pair, of_mesh, faster))
    axes = {}
    for bent in shafts.bent:
        number, _ = _places(meshes, bent.own.carries[0])[0]
        axes[bent.name] = shaft_axes(frames[number].axes)
    systems = []
    gears: list[GearOnShaft] = []
    for system in _in_housings(shafts, [_shaft(bent, meshes, up_to) for bent in shafts.bent], axes):
        own = [
            GearOnShaft(seat, mesh, side, turned_motions(axes[shaft.name], frames[mesh].axes))
            for shaft, seat in system.seated
            for mesh, side in _places(meshes, seat.gear)
        ]
        systems.append(_at_work(system, own, frames))
        gears += own
    turns = {bent.name: graph.senses[bent.number] * float(layout.turns[bent.number]) for bent in shafts.bent}
    return BentShafts(tuple(systems), axes, tuple(gears), tuple(frames), masses, turns)


def _in_housings(
    shafts: TrainShafts, built: Sequence[ElasticShaft], axes: Mapping[str, np.ndarray]
) -> Iterator[ShaftSystem]:
    """Shafts with such axes in space, each by itself or all in one housing, whose matrix is in space. Raises SceneError
    for a matrix that does not fit, and where a housing leaves a shaft free."""
    alone = [(f"shafts.{each.name}.housing", each.own.housing, (shaft,)) for each, shaft in zip(shafts.bent, built)]
    together = [("shafts.housing", shafts.housing, tuple(built))]
    for field, housing, own in alone if shafts.housing is None else together:
        if housing is None:
            yield ShaftSystem(own)
            continue
        check_housing(housing, field, sum(len(shaft.bearings) for shaft in own))
        turn = block_diag(
            *(turned_motions(axes[shaft.name], SPACE)[:FIVE, :FIVE] for shaft in own for _ in shaft.bearings)
        )
        stiffness = turn.T @ np.array(stiffness_of_seats(housing)) @ turn
        system = ShaftSystem(own, tuple(map(tuple, stiffness.tolist())))
        if wrong := list(bearings_hold(system)):
            raise SceneError(f"{_in_words(' '.join(wrong), system)}. {NOTHING_DONE}")
        yield system


def turning_of(
    meshes: Sequence[MeshOfScene], shafts: TrainShafts, graph: TrainGraph
) -> tuple[Mapping[int, float], list[int]]:
    """How the shafts that bend turn in the equations of rigid ones: 0.0 for those that twist, by their numbers, whose
    torsional stiffness is their own, infinite for others; and the gears that turn against them besides.

    A shaft turns with the gear that its torque is coupled to, or the first that is driven. A twist is that of drive or
    load, or of the first gear that only drives.
    """
    names = gear_names(meshes)
    twists = {}
    turning = []
    for bent in shafts.bent:
        shaft = _shaft(bent, meshes, 0.0)
        gears = graph.on(bent.number)
        driven = [gear for gear in gears if graph.driven(gear)]
        coupled = [gear for gear in gears if shaft.coupled is not None and names[gear] == shaft.coupled.gear]
        against = [gear for gear in gears if gear != (coupled or driven or gears)[0]]
        twisted = shaft.torque_at is not None and not coupled
        if shaft.torque_at is None and (driving := [gear for gear in against if gear not in driven]):
            twisted = True
            against.remove(driving[0])
        twists[bent.number] = 0.0 if twisted else inf
        turning += against
    return twists, turning


def mesh_frames(meshes: Sequence[MeshOfScene]) -> list[MeshFrame]:
    """Frames of all meshes in space: of a stage as of a pair whose pinion turns counter-clockwise, seen from the end
    where it does; behind an idler as the mirror image."""
    layout = layout_of(meshes)
    forwards = [1.0] * len(meshes)
    for members in layout.graph.members:
        for number in members:
            # Places along the axes count one way in all meshes of a gear.
            forwards[number] = float(meshes[members[0]].sense)
    return [
        MeshFrame(mesh_axes(layout.axes(number), own), mesh.pair, mesh.scene.load.wheel_torque)
        for number, (mesh, own) in enumerate(zip(meshes, forwards))
    ]


def _places(meshes: Sequence[MeshOfScene], gear: str) -> list[tuple[int, int]]:
    """The meshes of a gear, and whether it is the pinion (0) or the wheel (1) there."""
    return [(number, mesh.gears.index(gear)) for number, mesh in enumerate(meshes) if gear in mesh.gears]


def _shaft(bent: BentShaft, meshes: Sequence[MeshOfScene], up_to: float) -> ElasticShaft:
    """A shaft with its gears; modes `up_to` a frequency (Hz) where it has a mass."""
    own = bent.own
    seats = []
    for at, gear in sorted(zip(own.gears_at, own.carries)):
        mesh, side = _places(meshes, gear)[0]
        seats.append(SeatedGear(gear, at, meshes[mesh].pair.face_widths[side]))
    for one, other in pairwise(seats):
        if other.ends[0] - one.ends[1] < LEAST_GAP:
            raise SceneError(
                f"shafts.{bent.name}.gears_at: the face of {one.gear} ends at {one.ends[1]:g} mm, that of {other.gear}"
                f" begins at {other.ends[0]:g} mm; allowed are gears that are at least {LEAST_GAP:g} mm apart."
                f" {NOTHING_DONE}"
            )
    mesh, side = _places(meshes, own.carries[0])[0]
    scene = meshes[mesh].scene
    constants = own.material.constants(scene.gears.materials[side])
    density = 0.0
    if scene.inertia is not None:
        density = own.material.density or scene.inertia.of(GEARS[side]).density or 0.0
    shaft = ElasticShaft(
        bent.name, own.sections, constants, tuple(seats), own.torque_at, own.bearings, density=density,
        up_to=up_to if density else inf,
    )  # fmt: skip
    kinds = dict(zip(own.carries, own.seats or ()))
    for number, seat in enumerate(seats):
        mesh, side = _places(meshes, seat.gear)[0]
        gear = getattr(meshes[mesh].pair, GEARS[side])
        shaft = seated(shaft, number, kinds.get(seat.gear, RIGID_SEAT), gear, meshes[mesh].scene.gears.materials[side])
    return shaft


def _at_work(system: ShaftSystem, gears: Sequence[GearOnShaft], frames: Sequence[MeshFrame]) -> ShaftSystem:
    try:
        return held_at_work(system, even_loads(system, gears, frames), "shafts.{}.bearings")
    except SceneError as error:
        raise SceneError(_in_words(str(error), system)) from error


def _in_words(said: str, system: ShaftSystem) -> str:
    """What is said of bearings, where a train has them."""
    for shaft in system.shafts:
        said = said.replace(f"bearings.{shaft.name}", f"shafts.{shaft.name}.bearings")
    return said
