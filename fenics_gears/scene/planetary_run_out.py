"""Gears of a planetary set that run out, as the pairs of its meshes have it.

In the frame of the carrier each gear turns at its own rate about a centre that stands still, and takes its run-out
along. Each of its meshes sees the same displacement from its own line of action.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import atan2, cos, sin

import numpy as np

from fenics_gears.contact.eccentricity import Eccentricity, Offset

from .carrier import RunOut
from .planetary_schema import RunOutsOfSet
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


def with_run_outs(meshes: Sequence[MeshOfScene], run_outs: Sequence[RunOut]) -> list[MeshOfScene]:
    """The meshes of a set with the `[eccentricity]` of their pairs."""
    known = {each.gear: each for each in run_outs}
    layout = layout_of(meshes)
    found = []
    for number, mesh in enumerate(meshes):
        axes = layout.axes(number)
        sides = zip(mesh.pair.sides, mesh.gears)
        offsets = [_offset(axes, side.turning, known[gear]) if gear in known else None for side, gear in sides]
        if any(offsets):
            mesh = replace(mesh, scene=replace(mesh.scene, eccentricity=Eccentricity(*offsets)))
        found.append(mesh)
    return found


def _offset(axes: np.ndarray, turning: float, own: RunOut) -> Offset:
    """The run-out of a gear as a mesh with such `axes` (2, 2) has it; `turning`: as of Side."""
    along, off = (axes @ np.array([cos(own.phase), sin(own.phase)])).tolist()
    return Offset(distance=own.distance, phase=turning * atan2(off, along))
