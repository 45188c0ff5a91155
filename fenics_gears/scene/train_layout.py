"""What is wrong with where the gears of a train stand: gears that overlap, and loops of meshes that lock, do not close
or cannot be assembled."""

from __future__ import annotations

from cmath import rect
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from math import pi

import numpy as np

from fenics_gears.errors import GeometryError, SceneError
from fenics_gears.geometry.gear_train import Layout, check_apart
from fenics_gears.geometry.train_graph import TrainGraph
from fenics_gears.inputs.problem import NOTHING_DONE

from .data import Scene
from .train_topology import NamedMesh

# Centres may be so far from where two paths have them, in modules, and pairs from their places, in mesh cycles: what is
# left of directions with few digits.
LEAST_CLOSURE = 1e-3
MOST_ITERATIONS = 100


def check_layout(layout: Layout, names: Sequence[str], gears: Sequence[str], source: str) -> None:
    """Raise GeometryError for what is wrong with a layout; `names` of its meshes and of its gears."""
    for said in _wrong(layout, names, gears):
        raise GeometryError(f"{source}: {said} {NOTHING_DONE}")
    for one, other, distance in _not_meshing(layout):
        sizes = layout.gear(one), layout.gear(other)
        check_apart(*sizes, distance, f"{source}: gears {gears[one]} and {gears[other]}")


def check_cut_alike(meshes: Sequence[NamedMesh], scenes: Sequence[Scene], graph: TrainGraph, source: str) -> None:
    """Raise SceneError for a gear in several meshes that these have cut by different racks."""
    for gear in graph.shared:
        (first, side), *others = graph.sides[gear]
        for mesh, _ in others:
            for name in ("module", "pressure_angle", "helix_angle"):
                here, there = (getattr(scenes[each].gears, name) for each in (mesh, first))
                if here != there:
                    raise SceneError(
                        f"{source}: stages.{meshes[mesh].stage}.{name}: gear {meshes[first].gears[side]} has another"
                        f" {name} in {meshes[first].name}. Allowed: one, for it is one gear. {NOTHING_DONE}"
                    )


def _wrong(layout: Layout, names: Sequence[str], gears: Sequence[str]) -> Iterator[str]:
    graph = layout.graph
    for gear in graph.shared:
        cut = {layout.pairs[mesh].gears[side] for mesh, side in graph.sides[gear]}
        if len(cut) > 1:
            meshes = " and ".join(names[mesh] for mesh, _ in graph.sides[gear])
            yield (
                f"gear {gears[gear]} would be cut differently for its meshes {meshes}: give them one module and"
                " pressure_angle, and the gear its profile_shift, tip_diameter and root_diameter."
            )
    turns = layout.turns
    for mesh, (driving, driven) in enumerate(graph.between):
        by_this = turns[driving] * abs(Fraction(*layout.pairs[mesh].teeth))
        if by_this != turns[driven]:
            yield (
                f"the loop that {names[mesh]} closes locks: by this mesh its wheel {gears[graph.gears[mesh][1]]} would"
                f" turn {float(by_this):.6g} times in a turn of the first shaft, by the other way {turns[driven]}"
                f" = {float(turns[driven]):.6g} times. Allowed: numbers of teeth that give one ratio by all ways."
            )
    yield from _not_closed(layout, names, gears)


def _not_closed(layout: Layout, names: Sequence[str], gears: Sequence[str]) -> Iterator[str]:
    for mesh, apart in enumerate(closures(layout)):
        pair = layout.pairs[mesh]
        if abs(apart) > LEAST_CLOSURE * pair.pinion.module:
            yield (
                f"the loop that {names[mesh]} closes is not closed: by the directions of all meshes the centre of"
                f" {gears[layout.graph.gears[mesh][1]]} is at two places {abs(apart):.4g} mm apart."
                f" {_nearest(layout, names)}"
            )
    for gear, mesh, off in layout.not_closed():
        if abs(off) > LEAST_CLOSURE:
            yield (
                f"the loop of gears that {names[mesh]} closes cannot be assembled: a tooth of {gears[gear]} would stand"
                f" {abs(off):.4g} pitches beside its place. {_nearest(layout, names)}"
            )


def centres(layout: Layout) -> list[complex]:
    """Where the centre of each shaft stands (mm), the first one at 0."""
    found = {0: 0j}
    for mesh, (driving, driven) in sorted(enumerate(layout.graph.between), key=lambda each: each[1]):
        found.setdefault(driven, found[driving] + _arm(layout, mesh))
    return [found[shaft] for shaft in range(layout.graph.last + 1)]


def _arm(layout: Layout, mesh: int) -> complex:
    return rect(layout.pairs[mesh].centre_distance, layout.directions[mesh])


def closures(layout: Layout) -> list[complex]:
    """Of each mesh by how much (mm) its wheel's centre is beside the place that the shaft has by another mesh."""
    at = centres(layout)
    ends = enumerate(layout.graph.between)
    return [at[driving] + _arm(layout, mesh) - at[driven] for mesh, (driving, driven) in ends]


def _nearest(layout: Layout, names: Sequence[str]) -> str:
    """The nearest directions with which all loops close, in words."""
    found = _closed(layout)
    if found is None:
        return "No directions near these close it: the centre distances are too different."
    turned = [
        f'{name}: "{180.0 / pi * direction:.6f} deg"'
        for name, direction, before in zip(names, found.directions, layout.directions)
        if abs(direction - before) > 1e-9
    ]
    return f"The nearest directions that close: {', '.join(turned)}."


def _closed(layout: Layout) -> Layout | None:
    """The layout with directions changed as little as closes all loops; None where no near ones do."""
    for _ in range(MOST_ITERATIONS):
        off = _off(layout)
        if np.abs(off).max() < 1e-9:
            return layout
        small = 1e-7
        moved = [
            (_off(replace(layout, directions=np.array(layout.directions) + small * unit)) - off) / small
            for unit in np.eye(len(layout.pairs))
        ]
        step = np.linalg.lstsq(np.array(moved).T, -off, rcond=1e-9)[0]
        step *= min(1.0, 0.1 / np.abs(step).max())
        layout = replace(layout, directions=list(np.array(layout.directions) + step))
    return None


def _off(layout: Layout) -> np.ndarray:
    """What is left of closed loops: of centres in modules, of teeth in pitches."""
    apart = np.array(closures(layout)) / layout.pairs[0].pinion.module
    return np.concatenate([apart.real, apart.imag, [off for *_, off in layout.not_closed()]])


def _not_meshing(layout: Layout) -> Iterator[tuple[int, int, float]]:
    """Gears in one plane that do not mesh, with the distance of their centres."""
    at = centres(layout)
    graph = layout.graph
    for plane in graph.members:
        meshing = [{*graph.gears[mesh]} for mesh in plane]
        gears = sorted(set().union(*meshing))
        for place, one in enumerate(gears):
            for other in gears[place + 1 :]:
                if {one, other} not in meshing:
                    yield one, other, abs(at[graph.shafts[one]] - at[graph.shafts[other]])
