"""Gears of several meshes that run out, or whose pitches differ, in a planetary set or another train, as the pairs of
these have it.

In the frame of the carrier each gear turns at its own rate about a centre that stands still, and takes its run-out
along. Each of its meshes sees the same displacement from its own line of action.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import atan2, cos, sin

import numpy as np

from fenics_gears.contact.eccentricity import Eccentricity, Offset
from fenics_gears.errors import SceneError
from fenics_gears.geometry.flank_errors import FlankErrors, GearErrors
from fenics_gears.inputs.problem import NOTHING_DONE

from .carrier import RunOut
from .planetary_schema import PitchErrorsOfSet, RunOutsOfSet
from .train_mesh import MeshOfScene, layout_of


def run_outs_of(own: RunOutsOfSet | None, sun: str, planets: Sequence[str], ring: str) -> tuple[RunOut, ...]:
    """What runs out of the gears with these names; those without a distance run true."""
    if own is None:
        return ()
    members = (sun, own.sun), (ring, own.ring)
    found = [RunOut(name, member.distance, member.phase) for name, member in members if member is not None]
    if own.planets is not None and own.planets.distance is not None:
        phases = own.planets.phase or (0.0,) * len(planets)
        each_planet = zip(planets, own.planets.distance, phases)
        found += [RunOut(name, float(distance), float(phase)) for name, distance, phase in each_planet]
    return tuple(each for each in found if each.distance)


def pitches_of(
    own: PitchErrorsOfSet | None, sun: str, planets: Sequence[str], ring: str
) -> tuple[tuple[str, tuple[float, ...]], ...]:
    """Deviations of the pitches of the gears with these names; none of those whose pitches are alike."""
    if own is None:
        return ()
    of_planets = np.array(own.planets or (0.0,) * len(planets)).reshape(len(planets), -1).tolist()
    every = (sun, own.sun), (ring, own.ring), *zip(planets, map(tuple, of_planets))
    return tuple((name, pitches) for name, pitches in every if pitches is not None and any(pitches))


def with_pitches(
    meshes: Sequence[MeshOfScene], pitches: Mapping[str, tuple[float, ...]], counted: Mapping[str, int] | None = None
) -> list[MeshOfScene]:
    """Meshes with the `[flank_errors]` of their pairs, where those of gears are listed as one mesh counts teeth, their
    first unless `counted`. All have the section, so that their windows of contact nodes are alike."""
    layout = layout_of(meshes)
    found = []
    for number, mesh in enumerate(meshes):
        own = mesh.scene.flank_errors or FlankErrors(pinion=GearErrors(), wheel=GearErrors())
        errors = [own.pinion, own.wheel]
        for side, (gear, name) in enumerate(zip(layout.graph.gears[number], mesh.gears)):
            if name in pitches:
                by = layout.graph.sides[gear][0][0] if counted is None else counted[name]
                begins = layout.shared(gear, by, number).first
                errors[side] = GearErrors(pitch=pitches[name], first=begins % len(pitches[name]))
        own = replace(own, pinion=errors[0], wheel=errors[1])
        found.append(replace(mesh, scene=replace(mesh.scene, flank_errors=own)))
    return found


def with_run_outs(meshes: Sequence[MeshOfScene], run_outs: Sequence[RunOut]) -> list[MeshOfScene]:
    """Meshes with the `[eccentricity]` of their pairs: that of gears which run out, beside what they have of others."""
    known = {each.gear: each for each in run_outs}
    layout = layout_of(meshes)
    found = []
    for number, mesh in enumerate(meshes):
        axes = layout.axes(number)
        own = mesh.scene.eccentricity
        sides = zip(mesh.pair.sides, mesh.gears, (None, None) if own is None else own.of_gears)
        offsets = [
            _offset(axes, side.turning, known[gear]) if gear in known else offset for side, gear, offset in sides
        ]
        if any(offsets):
            mesh = replace(mesh, scene=replace(mesh.scene, eccentricity=Eccentricity(*offsets)))
        found.append(mesh)
    return found


def in_all_meshes(meshes: Sequence[MeshOfScene], source: str) -> list[MeshOfScene]:
    """Meshes of a train in which a gear with several mates runs out, or has pitch errors, in all of them as the scene
    has it in one."""
    layout = layout_of(meshes)
    run_outs: dict[str, RunOut] = {}
    pitches: dict[str, tuple[float, ...]] = {}
    counted: dict[str, int] = {}
    for number, mesh in enumerate(meshes):
        own = mesh.scene.eccentricity
        errors = mesh.scene.flank_errors
        for side, gear in zip(mesh.pair.sides, layout.graph.gears[number]):
            if gear not in layout.graph.shared:
                continue
            name = mesh.gears[side.number]
            place = f"{source}: {mesh.name}: the gear {name} has several mates and"
            offset = None if own is None else own.of_gears[side.number]
            if offset is not None:
                if offset.wobble or name in run_outs:
                    what = "wobbles, which is not yet computed" if offset.wobble else "runs out in two stages"
                    allowed = "Allowed: its distance and phase in [eccentricity], in one of its stages."
                    raise SceneError(f"{place} {what}. {allowed} {NOTHING_DONE}")
                angle = side.turning * offset.phase
                along, off = layout.axes(number).T @ np.array([cos(angle), sin(angle)])
                run_outs[name] = RunOut(name, offset.distance, atan2(off, along))
            listed = GearErrors() if errors is None else (errors.pinion, errors.wheel)[side.number]
            if errors is None or listed == GearErrors() and errors.tolerance_class is None:
                continue
            if errors.tolerance_class is not None or listed.pitch is None or listed != GearErrors(pitch=listed.pitch):
                raise SceneError(
                    f"{place} flank errors that are not yet computed there. Allowed: a list of its pitch deviations in"
                    f" [flank_errors], in one of its stages. {NOTHING_DONE}"
                )
            if name in pitches:
                raise SceneError(f"{place} flank errors in two stages. Allowed: in one of them. {NOTHING_DONE}")
            pitches[name] = listed.pitch
            counted[name] = number
    found = with_pitches(meshes, pitches, counted) if pitches else list(meshes)
    return with_run_outs(found, list(run_outs.values())) if run_outs else found


def _offset(axes: np.ndarray, turning: float, own: RunOut) -> Offset:
    """The run-out of a gear as a mesh with such `axes` (2, 2) has it; `turning`: as of Side."""
    along, off = (axes @ np.array([cos(own.phase), sin(own.phase)])).tolist()
    return Offset(distance=own.distance, phase=turning * atan2(off, along))
