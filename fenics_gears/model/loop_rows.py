"""Loops of a train's meshes, in rows for people: how they close, and at which angles of their gears."""

from __future__ import annotations

from collections.abc import Iterator
from math import lcm, pi

from fenics_gears.scene.train import TrainScene
from fenics_gears.scene.train_layout import closures
from fenics_gears.scene.train_mesh import gear_names

Row = tuple[str, float | str, str]


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
