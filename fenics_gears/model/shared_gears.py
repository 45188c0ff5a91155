"""Gears of a train that stand in several meshes: between which of their teeth compliance is needed, and what their
meshes must have alike."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from fenics_gears.elasticity.compliance import Reach
from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear_train import Layout, SharedGear
from fenics_gears.geometry.train_graph import PINION, WHEEL
from fenics_gears.inputs.problem import NOTHING_DONE
from fenics_gears.inputs.tree import GEARS

from .model import Model

# Reliefs (mm) of one flank that two meshes may have differently, and places along it that are compared.
ROUND_OFF = 1e-9
PLACES = 101


def couplings(layout: Layout, gear: int) -> list[SharedGear]:
    """A gear of several meshes in each two of them."""
    return [layout.shared(gear, *both) for both in combinations((mesh for mesh, _ in layout.graph.sides[gear]), 2)]


def reach_of(models: Sequence[Model], layout: Layout, gear: int) -> Reach:
    """Between which teeth of a gear of several meshes compliance is needed: on its flanks of each mesh, and from one to
    another."""
    teeth = layout.gear(gear).tooth_count
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
    return _joined([Reach(same, each) for each in across] or [Reach(same)], teeth)


def reach_of_alike(models: Sequence[Model], layout: Layout, gear: int, likes: Sequence[int | None]) -> Reach:
    """The same on any of the gears whose meshes are like those of this one, so that planets that are counted from other
    teeth are one body all the same. `likes`: which mesh each is like, None one of its own."""

    def kinds(of: int) -> list[int]:
        meshes = [mesh for mesh, _ in layout.graph.sides[of]]
        return [mesh if (like := likes[mesh]) is None else like for mesh in meshes]

    alike = [other for other in layout.graph.shared if kinds(other) == kinds(gear)]
    return _joined([reach_of(models, layout, other) for other in alike], layout.gear(gear).tooth_count)


def _joined(reaches: Sequence[Reach], teeth: int) -> Reach:
    """One reach for several of gears of so many `teeth`."""
    same = max(reach.same for reach in reaches)
    across = [reach.across for reach in reaches if reach.across is not None]
    if not across:
        return Reach(same)
    least = min(each[0] for each in across)
    most = max(each[1] for each in across)
    return Reach(same, (least, min(most, least + teeth - 1)))


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


def check_shared(layout: Layout, models: Sequence[Model], gears: Sequence[str], meshes: Sequence[str]) -> None:
    """Raise SceneError for gears in several meshes that these describe differently, or that are not computed yet; names
    of all `gears` and `meshes`."""
    for gear in layout.graph.shared:
        sides = layout.graph.sides[gear]
        if models[0].scene.three_dimensional and [side for _, side in sides] != [WHEEL, PINION]:
            raise SceneError(
                f"{gears[gear]}: over the face a gear is so far computed in one mesh, or as an idler, driven in one and"
                " then driving in another. Allowed: several mates of spur gears in the plane, on shafts without"
                f" sections. {NOTHING_DONE}"
            )
        _check_alike(models, gears[gear], [(mesh, side, meshes[mesh]) for mesh, side in sides])


def _check_alike(models: Sequence[Model], gear: str, sides: Sequence[tuple[int, int, str]]) -> None:
    """A gear in all its meshes, by their numbers, what it is in them, and their names."""
    (first, side, name), *others = sides
    one = models[first]
    for mesh, other_side, other_name in others:
        other = models[mesh]
        widths = {each.pair.face_width for each in (one, other)}
        widths |= {width for each in (one, other) for width in each.pair.effective_face_widths}
        if len(widths) > 1:
            raise SceneError(
                f"{gear}: gears that are not equally wide are not yet computed in {name} and {other_name}, which have"
                f" it in common. Allowed: one face_width for both. {NOTHING_DONE}"
            )
        materials = [each.scene.gears.material_of(GEARS[at]) for each, at in ((one, side), (other, other_side))]
        if materials[0] != materials[1]:
            raise SceneError(f"{gear}: has another material in {other_name} than in {name}. {NOTHING_DONE}")
        if side == other_side and (apart := _reliefs_apart(one, other, side)) > ROUND_OFF:
            raise SceneError(
                f"{gear}: {name} and {other_name} load the same flanks of it, but their reliefs differ by up to"
                f" {1e3 * apart:.3g} um. Allowed: one shape in both, with starts that do not depend on the mate."
                f" {NOTHING_DONE}"
            )


def _reliefs_apart(one: Model, other: Model, side: int) -> float:
    """The largest difference (mm) of what is removed from a flank of a gear in two meshes."""
    gear = one.pair.gears[side]
    rolls = np.linspace(gear.form_roll_angle, gear.tip_roll_angle, PLACES)
    removed = [np.zeros(PLACES) if each.removal[side] is None else each.removal[side](rolls) for each in (one, other)]
    return float(np.abs(removed[1] - removed[0]).max())
