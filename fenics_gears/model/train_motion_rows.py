"""What moves in a train whose stages move together, in rows for people: inertia, unknowns and natural frequencies; how
loops of its meshes close, and at which angles of their gears."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import isfinite, lcm, pi

import numpy as np

from fenics_gears.dynamics.frequencies import modes
from fenics_gears.scene.train import TrainScene
from fenics_gears.scene.train_layout import closures
from fenics_gears.scene.train_mesh import gear_names

from .motion_rows import Rows, frequency_rows, rows_of_shafts
from .row_model import RowModel
from .train_parts import parts_of

Row = tuple[str, float | str, str]
# Of the kinetic energy of a mode, at least, for a motion to be named.
NOTABLE_SHARE = 0.2
# What a shaft that bends does by a coordinate, by the first word of its name; otherwise it bends.
OF_SHAFTS = {"axial": "axial motion", "torsion": "torsion"}


def motion_rows(row: RowModel) -> Rows:
    """Masses of the gears, stiffness of the shafts, and the motions that are unknown."""
    parts = parts_of(row.meshes, row.shafts)
    gears = gear_names(row.meshes)
    rows: Rows = []
    for name, lumped in zip(gears, parts.masses):
        rows.append((f"{name}: moment of inertia", 1e3 * lumped.moment_of_inertia, "kg mm^2"))
    for shaft, load in sorted(parts.loads.items(), reverse=True):
        last = shaft == parts.graph.last
        label = "load: moment of inertia" if last else f"load on shaft {shaft + 1}: moment of inertia"
        rows.append((label, 1e3 * load, "kg mm^2, on the last shaft" if last else "kg mm^2"))
    for number, torsion in enumerate(parts.torsion, 1):
        if isfinite(torsion) and torsion:
            rows.append((f"shaft {number}: torsional stiffness", torsion, "N mm/rad"))
    on_bent = []
    if row.bent is not None:
        on_bent = list(row.bent.once)
        of_names = {name: side.gear for mesh in row.meshes for name, side in zip(mesh.gears, mesh.pair.sides)}
        rows += rows_of_shafts(row.bent.systems, of_names)
    said = [motion_in_words(name, gears) for name in row.drivetrain.coordinates if _on_rigid(name)]
    said += [f"displacements and tilts of {', '.join(on_bent)}"] if on_bent else []
    return [*rows, ("motions that are unknown", len(row.drivetrain.of_gears), ", ".join(said))]


def _on_rigid(name: str) -> bool:
    """Whether a coordinate is none of a shaft that bends."""
    return name.startswith(("rotation_", "twist_", "turn of")) or name[-1].isdigit() and name.startswith("centre_")


def frequencies_of_train(row: RowModel) -> Rows:
    """As `motion_rows.frequency_rows`, with what moves most in each mode; none without inertia."""
    if not row.vibrations:
        return []
    moving = [replace(each, motion=f"mostly {motion}") for each, motion in zip(row.vibrations, _moving_most(row))]
    return frequency_rows(moving, row.models[0].time_step)


def _moving_most(row: RowModel) -> list[str]:
    """Of each elastic mode the motions that have most of the kinetic energy."""
    drivetrain = row.drivetrain
    frequencies, shapes = modes(drivetrain, row.mesh_stiffness)
    energy = shapes * (drivetrain.mass @ shapes)
    words = _moving(row)
    kinds = list(dict.fromkeys(words))
    summed = np.array(
        [energy[[place for place, each in enumerate(words) if each == kind]].sum(axis=0) for kind in kinds]
    )
    said = []
    for shares in summed.T[len(frequencies) - len(row.vibrations) :]:
        largest = np.argsort(-shares)
        named = [place for place in largest if shares[place] >= NOTABLE_SHARE] or [largest[0]]
        said.append(" and ".join(kinds[place] for place in named[:2]))
    return said


def _moving(row: RowModel) -> list[str]:
    """What each coordinate moves, in words; of a shaft that bends as a whole."""
    gears = gear_names(row.meshes)
    shaft_of = {}
    for system in row.drivetrain.systems:
        for shaft in system.shafts:
            for coordinate in system.coordinates_of(shaft):
                kind = coordinate.partition("_")[0]
                shaft_of[coordinate] = f"{OF_SHAFTS.get(kind, 'bending')} of shaft {shaft.name}"
    return [shaft_of.get(name) or motion_in_words(name, gears) for name in row.drivetrain.coordinates]


def motion_in_words(name: str, gears: list[str]) -> str:
    """A coordinate of a train for people; `gears`: names of all, from the first on."""
    if name.startswith("turn of gear "):
        return f"turn of {gears[int(name.split()[-1]) - 1]} against its shaft"
    kind, _, number = name.partition("_")
    if kind == "centre":
        direction = "along" if number[0] == "x" else "off"
        return f"centre of {gears[int(number[1:]) - 1]} {direction} the line of action"
    return f"twist of shaft {number}" if kind == "twist" else f"rotation of shaft {number}"


def loop_rows(scene: TrainScene) -> list[Row]:
    """Whether loops close in the plane and by their teeth, and the clocking of their shafts."""
    graph = scene.graph
    apart = max(map(abs, closures(scene.layout)))
    rows: list[Row] = [
        ("loops", graph.loops, "beyond a train of one path: torques are told as if all paths had the same share"),
        ("centres meet within", f"{apart:.2g}", "mm"),
    ]
    if between := [off for *_, off in scene.layout.not_closed()]:
        rows.append(("teeth of gears with several mates meet within", f"{max(map(abs, between)):.2g}", "pitches"))
    return [*rows, *_clockings(scene)]


def _clockings(scene: TrainScene) -> Iterator[Row]:
    """Of each shaft with two gears in a loop how these stand where the loop closes, and by how much they do not."""
    layout = scene.layout
    graph = scene.graph
    names = gear_names(scene.meshes)
    for shaft, clocking in enumerate(scene.shafts.clocking):
        gears = [names.index(name) for name in scene.shafts.carried[shaft]]
        if len(gears) != 2 or not all(any(graph.in_loop(mesh) for mesh, _ in graph.sides[gear]) for gear in gears):
            continue
        one, other = gears
        pitch = 2.0 * pi / lcm(*(layout.gear(gear).tooth_count for gear in gears))
        angle = (layout.tooth_angle(other) - layout.tooth_angle(one)) % pitch
        words = (
            f"rad: 0 closes the loop exactly, where a tooth of {names[other]} stands {180.0 / pi * angle:.5g} deg"
            f" counter-clockwise of one of {names[one]}, modulo {180.0 / pi * pitch:.5g} deg"
        )
        yield f"shaft {shaft + 1}: clocking", f"{clocking or 0.0:.5g}", words
