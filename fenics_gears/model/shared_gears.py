"""Gears of a train that stand in several meshes: between which of their teeth compliance is needed."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from fenics_gears.elasticity.compliance import Reach
from fenics_gears.geometry.gear_train import Layout, SharedGear

from .model import Model


def couplings(layout: Layout, gear: int) -> list[SharedGear]:
    """A gear of several meshes in each two of them."""
    return [layout.shared(gear, *both) for both in combinations((mesh for mesh, _ in layout.graph.sides[gear]), 2)]


def reach_of(models: Sequence[Model], layout: Layout, gear: int) -> Reach:
    """Between which teeth of a gear of several meshes compliance is needed: on its flanks of each mesh, and from one to
    another."""
    teeth = layout.gear(gear).teeth
    same = max(models[mesh].touching.reach.same for mesh, _ in layout.graph.sides[gear])
    across: list[tuple[int, int]] = []
    for shared in couplings(layout, gear):
        least, most = _between(models, shared)
        most = min(most, least + teeth - 1)
        round_about = teeth * round(0.5 * (least + most) / teeth)
        if shared.mirrored:
            across.append((least - round_about, most - round_about))
        else:
            # Round the gear no tooth is further than half of them.
            farthest = max(abs(least - round_about), abs(most - round_about))
            same = max(same, min(farthest, teeth // 2))
    if not across:
        return Reach(same)
    hull = min(each[0] for each in across), max(each[1] for each in across)
    return Reach(same, (hull[0], min(hull[1], hull[0] + teeth - 1)))


def _between(models: Sequence[Model], shared: SharedGear) -> tuple[int, int]:
    """Least and largest number of pitches by which a tooth of the first mesh of a shared gear is ahead of one of the
    second: on opposite flanks as `Reach.across` counts them."""
    one, other = (_teeth_on(models[mesh], side) for mesh, side in zip(shared.meshes, shared.sides))
    if shared.mirrored:
        least, most = one[0] - shared.tooth + other[0], one[1] - shared.tooth + other[1]
    else:
        least, most = one[0] - shared.tooth - other[1], one[1] - shared.tooth - other[0]
    # One further at either end: pairs a step before, and those of a mesh that is ahead by part of a cycle.
    return least - 1, most + 1


def _teeth_on(model: Model, side: int) -> tuple[int, int]:
    """Least and largest place of a tooth of a mesh's pinion (0) or wheel (1) that touches, as `Place.teeth` has it."""
    first, last = (position // model.touching.steps for position in model.touching.drive)
    return (first, last) if side == 0 else (-last, -first)
