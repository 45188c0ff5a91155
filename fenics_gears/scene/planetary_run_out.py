"""Gears of several meshes that run out, or whose teeth differ, in a planetary set or another train, as the pairs of
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
from fenics_gears.geometry.flank_errors import FlankErrors, GearErrors, counted_from
from fenics_gears.geometry.gear_train import SharedGear
from fenics_gears.geometry.side import Side
from fenics_gears.inputs.problem import NOTHING_DONE

from .carrier import RunOut
from .planetary_schema import PitchErrorsOfSet, RunOutsOfSet
from .train_mesh import MeshOfScene, layout_of

# Of roll angles, rad, at which active profiles begin.
START_ROUND_OFF = 1e-9


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


def with_pitches(meshes: Sequence[MeshOfScene], pitches: Mapping[str, tuple[float, ...]]) -> list[MeshOfScene]:
    """Meshes with the pitch deviations of gears, which are listed as their first mesh counts teeth."""
    first: dict[str, int] = {}
    for number, mesh in enumerate(meshes):
        for name in mesh.gears:
            first.setdefault(name, number)
    return with_errors(meshes, {(name, first[name]): GearErrors(pitch=own) for name, own in pitches.items()})


def with_errors(meshes: Sequence[MeshOfScene], errors: Mapping[tuple[str, int], GearErrors]) -> list[MeshOfScene]:
    """Meshes with the `[flank_errors]` of their pairs; `errors`: by the names of gears and the mesh that counts their
    teeth. Pitches are of all meshes of a gear, the rest of those that load the same flanks. All have the section, so
    that their windows of contact nodes are alike."""
    layout = layout_of(meshes)
    found = []
    for number, mesh in enumerate(meshes):
        own = mesh.scene.flank_errors or FlankErrors(pinion=GearErrors(), wheel=GearErrors())
        of_gears = list(own.of_gears)
        for side, gear, name in zip(mesh.pair.sides, layout.graph.gears[number], mesh.gears):
            listed = [(layout.shared(gear, by, number), each) for (named, by), each in errors.items() if named == name]
            if listed:
                of_gears[side.number] = _errors_seen(listed, side)
        own = replace(own, pinion=of_gears[0], wheel=of_gears[1])
        found.append(replace(mesh, scene=replace(mesh.scene, flank_errors=own)))
    return found


def _errors_seen(listed: Sequence[tuple[SharedGear, GearErrors]], side: Side) -> GearErrors:
    """Errors of a gear as the second mesh of each `SharedGear` has them, from those that its first mesh counts."""
    found = GearErrors()
    pitch: tuple[float, ...] | None = None
    first = 0
    for shared, own in listed:
        begins = shared.first % side.gear.tooth_count
        if own.pitch is not None:
            pitch = own.pitch
            first = begins
        if not shared.mirrored and of_flanks(own):
            here = shared.meshes[0] == shared.meshes[1]
            found = own if here else counted_from(own, begins, side.gear.tooth_count, side.turn)
    return replace(found, pitch=pitch, first=first)


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
    """Meshes of a train in which a gear with several mates runs out, or has errors of its teeth, in all of them as the
    scene has it in one."""
    layout = layout_of(meshes)
    run_outs: dict[str, RunOut] = {}
    known: dict[tuple[str, int], GearErrors] = {}
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
            if errors.tolerance_class is not None:
                raise SceneError(
                    f"{place} flank errors that are drawn, which is not yet computed there. Allowed: deviations of its"
                    f" teeth in [flank_errors] without a tolerance_class. {NOTHING_DONE}"
                )
            _check_said_once(meshes, known, (name, number), listed, place)
            known[name, number] = listed
    found = with_errors(meshes, known) if known else list(meshes)
    return with_run_outs(found, list(run_outs.values())) if run_outs else found


def _check_said_once(
    meshes: Sequence[MeshOfScene],
    known: Mapping[tuple[str, int], GearErrors],
    where: tuple[str, int],
    own: GearErrors,
    place: str,
) -> None:
    """Raise SceneError for errors of a gear that others `known` are of too, or that another mate would have
    otherwise; `where`: its name and the mesh that has them."""
    name, number = where
    side = meshes[number].gears.index(name)
    for (gear, other), errors in known.items():
        same = meshes[other].gears.index(gear) == side
        flanks_too = same and of_flanks(own) and of_flanks(errors)
        if gear == name and (flanks_too or None not in (own.pitch, errors.pitch)):
            raise SceneError(f"{place} flank errors in two stages. Allowed: in one of them. {NOTHING_DONE}")
    # Between the mean of the active profile, or its ends, a deviation is another where that begins elsewhere.
    curves_stay = own.measured_profile is not None and not own.in_the_mean
    if curves_stay or own.profile_slope is own.profile_form is own.measured_profile is None:
        return
    starts = [mesh.pair.sap_roll_angles[side] for mesh in meshes if mesh.gears[side] == name]
    if max(starts) - min(starts) > START_ROUND_OFF:
        raise SceneError(
            f"{place} profile deviations over its active profile, which begins elsewhere with another mate of the same"
            f" flanks. Allowed: profile_curves that are zero at the reference point. {NOTHING_DONE}"
        )


def of_flanks(own: GearErrors) -> bool:
    """Whether there are errors that are no pitch errors."""
    return replace(own, pitch=None) != GearErrors()


def _offset(axes: np.ndarray, turning: float, own: RunOut) -> Offset:
    """The run-out of a gear as a mesh with such `axes` (2, 2) has it; `turning`: as of Side."""
    along, off = (axes @ np.array([cos(own.phase), sin(own.phase)])).tolist()
    return Offset(distance=own.distance, phase=turning * atan2(off, along))
