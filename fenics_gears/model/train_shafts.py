"""Shafts of a train that bend: their parts, one for each gear, on the bearings that the scene has."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.dynamics.elastic_shaft import ElasticShaft
from fenics_gears.dynamics.shaft_at_work import at_work
from fenics_gears.dynamics.shaft_system import ShaftSystem
from fenics_gears.dynamics.train_shafts import (
    SIDES,
    BentShafts,
    GearOnShaft,
    MeshFrame,
    even_loads,
    mesh_axes,
    shaft_axes,
    torsional_stiffness,
    turned_motions,
)
from fenics_gears.effects.elastic_shaft_rules import check_held_at_work
from fenics_gears.effects.elastic_shaft_seats import sections_between
from fenics_gears.errors import SceneError
from fenics_gears.inputs.problem import NOTHING_DONE
from fenics_gears.scene.train_mesh import MeshOfScene, layout_of
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
    for mesh in meshes:
        if mesh.scene.inertia is not None:
            of_mesh = lumped_gears(mesh.scene, mesh.pair)
            masses |= {name: of_mesh[side] for name, side in zip(mesh.gears, SIDES)}
            up_to = max(up_to, 2.0 * highest_of_interest(mesh.scene, mesh.pair, of_mesh))
    systems = []
    axes = []
    gears: list[GearOnShaft] = []
    for bent in shafts.bent:
        parts = _parts(bent, meshes, up_to)
        system = ShaftSystem(parts)
        first, _ = _places(meshes, bent.own.carries[0])[0]
        axes.append(shaft_axes(frames[first].axes))
        own = [
            GearOnShaft(part, mesh, side, turned_motions(axes[-1], frames[mesh].axes))
            for part in parts
            for mesh, side in _places(meshes, part.gear)
        ]
        systems.append(_at_work(system, own, frames, bent))
        gears += own
    names = tuple(bent.name for bent in shafts.bent)
    return BentShafts(names, tuple(systems), tuple(axes), tuple(gears), tuple(frames), masses)


def torsions_of(meshes: Sequence[MeshOfScene], shafts: TrainShafts) -> Mapping[int, float]:
    """Torsional stiffness (N mm/rad) of the shafts that bend, by their numbers."""
    return {bent.number: torsional_stiffness(ShaftSystem(_parts(bent, meshes, 0.0))) for bent in shafts.bent}


def mesh_frames(meshes: Sequence[MeshOfScene]) -> list[MeshFrame]:
    """Frames of all meshes in space: of a stage as of a pair whose pinion turns counter-clockwise, seen from the end
    where it does; behind an idler as the mirror image."""
    forwards = [1.0] * len(meshes)
    for members in layout_of(meshes).graph.members:
        for number in members:
            # Places along the axes count one way in all meshes of a gear.
            forwards[number] = float(meshes[members[0]].sense)
    frames = []
    for mesh, own in zip(meshes, forwards):
        axes = mesh_axes(mesh.direction, mesh.pair.operating_pressure_angle, mesh.sense, own)
        frames.append(MeshFrame(axes, mesh.pair, mesh.scene.load.wheel_torque))
    return frames


def _places(meshes: Sequence[MeshOfScene], gear: str) -> list[tuple[int, int]]:
    """The meshes of a gear, and whether it is the pinion (0) or the wheel (1) there."""
    return [(number, mesh.gears.index(gear)) for number, mesh in enumerate(meshes) if gear in mesh.gears]


def _parts(bent: BentShaft, meshes: Sequence[MeshOfScene], up_to: float) -> tuple[ElasticShaft, ...]:
    """A shaft cut in the middle between its gears; modes `up_to` a frequency (Hz) where it has a mass."""
    own = bent.own
    order = sorted(zip(own.gears_at, own.carries))
    widths = []
    for _, gear in order:
        mesh, side = _places(meshes, gear)[0]
        widths.append(meshes[mesh].pair.face_widths[side])
    ends = [(at - 0.5 * width, at + 0.5 * width) for (at, _), width in zip(order, widths)]
    cuts = [0.0, *_cuts(bent, order, ends), sum(each.length for each in own.sections)]
    mesh, side = _places(meshes, own.carries[0])[0]
    scene = meshes[mesh].scene
    constants = own.material.constants(scene.gears.materials[side])
    density = 0.0
    if scene.inertia is not None:
        density = own.material.density or scene.inertia.of(SIDES[side]).density or 0.0
    parts = []
    part_of = np.searchsorted(cuts[1:-1], [each.at for each in own.bearings])
    for number, ((at, gear), width, (begin, end)) in enumerate(zip(order, widths, pairwise(cuts))):
        bearings = [each for each, part in zip(own.bearings, part_of) if part == number]
        torque_at = at if own.torque_at is None else own.torque_at
        parts.append(ElasticShaft(
            gear, sections_between(own.sections, begin, end), constants, at - begin, width, torque_at - begin,
            tuple(replace(each, at=each.at - begin) for each in bearings), density=density,
            goes_on=gear != order[-1][1],
        ))  # fmt: skip
        if density:
            parts[-1] = replace(parts[-1], up_to=up_to)
    return tuple(parts)


def _cuts(bent: BentShaft, order: Sequence[tuple[float, str]], ends: Sequence[tuple[float, float]]) -> Iterator[float]:
    """Places in the middle between neighbouring gears."""
    for (_, one), (_, other), (_, before), (behind, _) in zip(order, order[1:], ends, ends[1:]):
        if behind - before < LEAST_GAP:
            raise SceneError(
                f"shafts.{bent.name}.gears_at: the face of {one} ends at {before:g} mm, that of {other} begins at"
                f" {behind:g} mm; allowed are gears that are at least {LEAST_GAP:g} mm apart. {NOTHING_DONE}"
            )
        yield 0.5 * (before + behind)


def _at_work(
    system: ShaftSystem, gears: Sequence[GearOnShaft], frames: Sequence[MeshFrame], bent: BentShaft
) -> ShaftSystem:
    if not system.in_rolling:
        return system
    try:
        system = at_work(system, even_loads(system.shafts, gears, frames))
    except SceneError as error:
        words = " and ".join(f"bearings.{shaft.gear}" for shaft in system.shafts)
        raise SceneError(f"{str(error).replace(words, f'shafts.{bent.name}.bearings')}. {NOTHING_DONE}") from error
    first = system.shafts[0]
    whole = replace(first, gear=bent.name, sections=bent.own.sections, bearings=tuple(_bearings(system)))
    check_held_at_work([whole], np.asarray(system.springs), "shafts.{}.bearings")
    return system


def _bearings(system: ShaftSystem) -> Iterator:
    """All bearings of a shaft in parts at their places from its left end."""
    begin = 0.0
    for part in system.shafts:
        yield from (replace(each, at=each.at + begin) for each in part.bearings)
        begin += part.length
