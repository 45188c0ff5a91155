"""Gears of a train that stand in several meshes: between which of their teeth compliance is needed, and what their
meshes must have alike."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations, permutations, product
from math import ceil, floor, isclose

import numpy as np

from fenics_gears.contact.tooth_pair import COAST, DRIVE
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear_train import Layout, SharedGear
from fenics_gears.inputs.problem import NOTHING_DONE
from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.planetary_run_out import of_flanks

from .model import Model

# Reliefs (mm) of one flank that two meshes may have differently, and places along it that are compared.
ROUND_OFF = 1e-9
PLACES = 101
# Of differences of phases, in mesh cycles.
PHASE_ROUND_OFF = 1e-9


def couplings(layout: Layout, gear: int) -> list[SharedGear]:
    """A gear of several meshes in each two of them."""
    return [layout.shared(gear, *both) for both in combinations((mesh for mesh, _ in layout.graph.sides[gear]), 2)]


def reach_of(models: Sequence[Model], layout: Layout, gear: int) -> Reach:
    """Between which teeth of a gear of several meshes compliance is needed: on its flanks of each mesh, and from one to
    another."""
    teeth = layout.gear(gear).tooth_count
    over_face = models[0].scene.three_dimensional
    of_meshes = [models[mesh].touching.reach for mesh, _ in layout.graph.sides[gear]]
    same = max(each.same for each in of_meshes)
    own = _hull(each.across for each in of_meshes)
    found = [Reach(same, own, None, own if over_face else None)]
    for shared in couplings(layout, gear):
        for flanks in product(*(_loaded(models[mesh]) for mesh in shared.meshes)):
            opposite, least, most = _between(models, layout, shared, flanks)
            most = min(most, least + teeth - 1)
            round_about = teeth * round(0.5 * (least + most) / teeth)
            least, most = least - round_about, most - round_about
            if opposite:
                found.append(Reach(same, (least, most)))
                continue
            # Round the gear no tooth is further than half of them.
            farthest = min(max(abs(least), abs(most)), teeth // 2)
            if over_face:
                found.append(Reach(same, None, (max(least, -most, 0), farthest)))
            else:
                found.append(Reach(max(same, farthest)))
    return _joined(found, teeth)


def _loaded(model: Model) -> tuple[int, ...]:
    """Which flanks of its gears a mesh loads."""
    return (DRIVE,) if model.touching.coast is None else (DRIVE, COAST)


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
    across = _hull(reach.across for reach in reaches)
    if across is not None:
        across = across[0], min(across[1], across[0] + teeth - 1)
    far, own = (_hull(getattr(reach, name) for reach in reaches) for name in ("far", "own"))
    return Reach(same, across, far, own)


def _hull(ranges: Iterable[tuple[int, int] | None]) -> tuple[int, int] | None:
    """Of ranges one of all that they have; None where there is none."""
    known = [each for each in ranges if each is not None]
    return (min(each[0] for each in known), max(each[1] for each in known)) if known else None


def _between(
    models: Sequence[Model], layout: Layout, shared: SharedGear, flanks: tuple[int, int]
) -> tuple[bool, int, int]:
    """Of such flanks of the first mesh of a shared gear and of the second that touch at the same time whether they are
    opposite ones, and the least and largest number of pitches by which the tooth of the first is ahead: of opposite
    ones as `Reach.across` counts them."""
    first, other = (
        _teeth(models[mesh], layout.phases[mesh], side, flank)
        for mesh, side, flank in zip(shared.meshes, shared.sides, flanks)
    )
    counted = [shared.flank(1, (each, flanks[1])) for each in other]
    flank = counted[0][1]
    least = ceil(first[0] - max(tooth for tooth, _ in counted) - PHASE_ROUND_OFF)
    most = floor(first[1] - min(tooth for tooth, _ in counted) + PHASE_ROUND_OFF)
    if flank != flanks[0] == COAST:
        least, most = -most, -least
    return flank != flanks[0], least, most


def _teeth(model: Model, phase: float, side: int, flank: int) -> tuple[float, float]:
    """Between which numbers, as of `Place.teeth` and beyond the mesh cycles since the run began, the tooth is of a
    gear's flank while it touches."""
    steps = model.touching.steps
    first, last = model.touching.drive if flank == DRIVE else model.touching.coast
    # Pairs touch between steps too, which is less than one at either end of either mesh; with friction one mesh is
    # looked at a step before the other one.
    ends = (first - 1.5) / steps - phase, (last + 1.5) / steps - phase
    return (flank - ends[1], flank - ends[0]) if side else ends


def check_shared(layout: Layout, models: Sequence[Model], gears: Sequence[str], meshes: Sequence[str]) -> None:
    """Raise SceneError for gears in several meshes that these describe differently; names of all `gears` and
    `meshes`."""
    for gear in layout.graph.shared:
        sides = layout.graph.sides[gear]
        named = [(mesh, side, meshes[mesh]) for mesh, side in sides]
        _check_alike(models, gears[gear], named)
        for one, other in permutations(named, 2):
            _check_coast_flanks(models, gears[gear], one, other)


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
                f"{gear}: it meshes in {name} and in {other_name}, whose gears are not equally wide. This is not"
                f" computed yet. Allowed: one face_width for all of them. {NOTHING_DONE}"
            )
        materials = [each.scene.gears.material_of(GEARS[at]) for each, at in ((one, side), (other, other_side))]
        if materials[0] != materials[1]:
            raise SceneError(f"{gear}: has another material in {other_name} than in {name}. {NOTHING_DONE}")
        if not isclose(one.face.slope, other.face.slope):
            raise SceneError(
                f"{gear}: {name} and {other_name} have it in common, but would have it of either hand. Allowed: one"
                f" pinion_hand in both, that of the pinion of the first; the hands of the others follow. {NOTHING_DONE}"
            )
        if side == other_side and (apart := _reliefs_apart(one, other, side)) > ROUND_OFF:
            raise SceneError(
                f"{gear}: {name} and {other_name} load the same flanks of it, but their reliefs differ by up to"
                f" {1e3 * apart:.3g} um. Allowed: one shape in both, with starts that do not depend on the mate."
                f" {NOTHING_DONE}"
            )
        if side == other_side and _lead(one, side) != _lead(other, side):
            raise SceneError(
                f"{gear}: {name} and {other_name} load the same flanks of it, but have other lead modifications of it."
                f" Allowed: the same lead_modifications.{GEARS[side]} in both. {NOTHING_DONE}"
            )


def _check_coast_flanks(
    models: Sequence[Model], gear: str, one: tuple[int, int, str], other: tuple[int, int, str]
) -> None:
    """Raise SceneError where coast flanks, which have their nominal shape, are the drive flanks of another mesh, which
    have not. As of `_check_alike`."""
    (coasting, side, name), (driving, other_side, other_name) = one, other
    if side == other_side or models[coasting].touching.coast is None:
        return
    model = models[driving]
    errors = model.scene.flank_errors
    own_errors = errors is not None and of_flanks(errors.of_gears[other_side])
    if own_errors or model.removal[other_side] is not None or _lead(model, other_side) is not None:
        raise SceneError(
            f"{gear}: its coast flanks in {name} are its drive flanks in {other_name}, where they have modifications or"
            f" errors; coast flanks are computed without. Allowed: no coast_flanks in {name}, or in {other_name} no"
            f" reliefs, lead modifications and flank errors but pitches of this gear. {NOTHING_DONE}"
        )


def _lead(model: Model, side: int) -> object:
    """Lead modification of a mesh's pinion (0) or wheel (1)."""
    leads = model.scene.lead_modifications
    return None if leads is None else getattr(leads, GEARS[side])


def _reliefs_apart(one: Model, other: Model, side: int) -> float:
    """The largest difference (mm) of what is removed from a flank of a gear in two meshes."""
    gear = one.pair.gears[side]
    rolls = np.linspace(gear.form_roll_angle, gear.tip_roll_angle, PLACES)
    removed = [np.zeros(PLACES) if each.removal[side] is None else each.removal[side](rolls) for each in (one, other)]
    return float(np.abs(removed[1] - removed[0]).max())
