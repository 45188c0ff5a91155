"""What is wrong with shafts that have sections, and with the bearings that they turn in. Not an effect by itself."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import pi
from typing import Any

import numpy as np

from fenics_gears.dynamics.beam import STEEPEST_CONE
from fenics_gears.dynamics.bearings import BALLS, OF_BALLS, OF_ROLLERS, ROLLERS, Bearing, RollingBearing, Stiffnesses
from fenics_gears.dynamics.elastic_shaft import ElasticShaft, SeatedGear, free_motions
from fenics_gears.dynamics.shaft_at_work import at_work, even_load
from fenics_gears.dynamics.shaft_system import ShaftSystem
from fenics_gears.dynamics.shafts import INTEGRAL, RIGID_SEAT
from fenics_gears.errors import SceneError
from fenics_gears.inputs.problem import LISTED, NOTHING_DONE, Broken
from fenics_gears.inputs.section import names_in
from fenics_gears.inputs.tree import GEARS, SHAFTS, Tree, given_for, shafts_with_sections, table, value_at

from .elastic_shaft_housing import check_housing, stiffness_of_seats
from .elastic_shaft_seats import OFF_THE_BORE, ROUND_OFF, seated, under_the_face, wrong_with_seat

BESIDE_MATRIX = ("radial_stiffness", "axial_stiffness", "tilting_stiffness", "rolling")
BESIDE_ROLLING = ("radial_stiffness", "tilting_stiffness")


def rules_of_elastic_shafts(tree: Tree) -> Broken:
    """A shaft with sections says where gear and torque are. It has bearings of its own and, in a scene with [inertia],
    a density."""
    both = table(tree, "shafts") or {}
    if "torsional_stiffness" in both:
        message = (
            "is given together with a shaft with sections, so that it is not clear whose it is. Leave it out, or give"
            " it to [shafts.input] or [shafts.output]."
        )
        yield ("shafts", "torsional_stiffness"), message
    for shaft in shafts_with_sections(tree):
        if "housing" in both and "housing" in (table(both, shaft) or {}):
            message = "is given together with the housing of [shafts], which is that of both shafts. Leave one out."
            yield ("shafts", shaft, "housing"), message
        for name in ("gear_at", "torque_at"):
            if name not in (table(both, shaft) or {}):
                message = 'is missing. Allowed: a length from the left end of the shaft, such as "58 mm".'
                yield ("shafts", shaft, name), message
        gear = GEARS[SHAFTS.index(shaft)]
        if value_at(tree, "bearings", gear, LISTED) is None:
            message = (
                f"is missing: nothing holds [shafts.{shaft}], which has sections. Add its bearings, each as a table"
                f" [[bearings.{gear}]] with at and radial_stiffness."
            )
            yield ("bearings", gear), message
        if "inertia" in tree and _has_no_density(tree, shaft, gear):
            message = (
                "is missing: with [inertia] the shaft's own mass counts, and nothing gives its density. Allowed:"
                ' such as "7.85 g/cm^3", here or as density of [inertia] or of the gear in it.'
            )
            yield ("shafts", shaft, "material", "density"), message


def _has_no_density(tree: Tree, shaft: str, gear: str) -> bool:
    """Whether nothing says how dense a shaft is."""
    return value_at(tree, "shafts", shaft, "material", "density") is None and "density" not in given_for(
        table(tree, "inertia") or {}, gear
    )


def rules_of_listed_bearings(tree: Tree, both: Tree, listed: Sequence[str]) -> Broken:
    """Only shafts with sections have listed bearings, and such a gear has no others."""
    for gear in listed:
        shaft = SHAFTS[GEARS.index(gear)]
        own = table(both, gear) or {}
        if shaft not in shafts_with_sections(tree):
            message = (
                f"are bearings of a shaft with sections. Add sections to [shafts.{shaft}], or give [bearings.{gear}] a"
                " stiffness."
            )
            yield ("bearings", gear), message
        beside = [(gear, name) for name in names_in(Stiffnesses) if name in own]
        beside += [("places", gear)] if gear in (table(both, "places") or {}) else []
        for path in beside:
            message = f"is given together with [[bearings.{gear}]], all of the {gear}'s bearings. Leave one out."
            yield ("bearings", *path), message
    for name in names_in(Stiffnesses) if listed else ():
        if name in both:
            other = next((gear for gear in GEARS if gear not in listed), "")
            unclear = f"is given together with [[bearings.{listed[0]}]], so that it is not clear whose it is"
            message = f"{unclear}. Leave it out" + (f", or give it to [bearings.{other}]." if other else ".")
            yield ("bearings", name), message


def check_shafts(scene: Any, pair: Any) -> None:
    """Raise SceneError for all that does not fit along the shafts of a scene, or is not held by their bearings."""
    wrong: list[str] = []
    of_both = len(scene.bearings.each or ())
    check_housing(scene.shafts.housing, "shafts.housing", of_both)
    for gear, shaft in zip(GEARS, SHAFTS):
        if gear in scene.shafts.sections:
            own = scene.shafts.sections[gear].housing
            check_housing(own, f"shafts.{shaft}.housing", len(scene.bearings.each_of(gear)), of_both)
            elastic = elastic_shaft(scene, pair, gear)
            wrong += [*_sections_are_solid(elastic, shaft), *_places_are_on_the_shaft(elastic, shaft)]
            wrong += [*_bearings_brace(elastic)] if not wrong else []
            wrong += wrong_with_seat(scene, pair, elastic, shaft)
    if not wrong:
        wrong += [said for system in shaft_systems(scene, pair) for said in bearings_hold(system)]
    if wrong:
        raise SceneError("\n".join(wrong))


def systems_at_work(scene: Any, pair: Any) -> tuple[ShaftSystem, ...]:
    """The shafts of a scene that have sections, with rolling bearings as stiff as they are under an even line load."""
    systems = []
    for system in shaft_systems(scene, pair):
        loads = [even_load(seat.gear, pair, scene.load.wheel_torque) for _, seat in system.seated]
        systems.append(held_at_work(system, np.concatenate(loads), "bearings.{}"))
    return tuple(systems)


def held_at_work(system: ShaftSystem, load: np.ndarray, field: str) -> ShaftSystem:
    """Shafts under a load (5 g,) of their gears (`at_work`). Raises SceneError where rolling elements that carry the
    load leave a shaft free, as one alone does across it; `field`: where bearings are in the scene."""
    system = at_work(system, load)
    for gear, free in free_motions(system.shafts, system.springs).items() if system.in_rolling else ():
        if free:
            raise SceneError(
                f"{field.format(gear)}: under the load of the teeth so few rolling elements carry that the shaft freely"
                f" {' and '.join(free)}. Allowed: more rolling elements, less clearance or a preload. {NOTHING_DONE}"
            )
    return system


def shaft_systems(scene: Any, pair: Any) -> tuple[ShaftSystem, ...]:
    """The shafts of a scene that have sections, without load: each by itself, or both in one housing."""
    shafts = [elastic_shaft(scene, pair, gear) for gear in scene.shafts.sections]
    if scene.shafts.housing is not None:
        return (ShaftSystem(tuple(shafts), stiffness_of_seats(scene.shafts.housing)),)
    housings = [stiffness_of_seats(scene.shafts.sections[shaft.name].housing) for shaft in shafts]
    return tuple(ShaftSystem((shaft,), housing) for shaft, housing in zip(shafts, housings))


def elastic_shaft(scene: Any, pair: Any, gear: str) -> ElasticShaft:
    """The shaft with sections on which the "pinion" or the "wheel" of a scene sits, without load."""
    shaft = scene.shafts.sections[gear]
    number = GEARS.index(gear)
    material = scene.gears.materials[number]
    constants = shaft.material.constants(material)
    width = pair.face_widths[number]
    bearings = scene.bearings.each_of(gear)
    elastic = ElasticShaft(
        gear, shaft.sections, constants, (SeatedGear(gear, shaft.gear_at, width),), shaft.torque_at, bearings,
    )  # fmt: skip
    return seated(elastic, 0, shaft.seat, getattr(pair, gear), material)


def shaft_warnings(scene: Any, pair: Any) -> list[str]:
    """A sentence on each gear whose bore is not as wide as the shaft in it is thick."""
    sentences = []
    for gear, shaft in scene.shafts.sections.items():
        bore = 2.0 * getattr(pair, gear).bore_radius
        name = SHAFTS[GEARS.index(gear)]
        if shaft.seat != RIGID_SEAT:
            continue
        under = under_the_face(shaft.sections, elastic_shaft(scene, pair, gear).seats[0].ends)
        off = [each for each in under if abs(each - bore) > OFF_THE_BORE * bore]
        if off:
            sentences.append(
                f"shafts.{name}.sections: the shaft is {off[0]:g} mm thick under the {gear}'s face, whose bore is"
                f" {bore:g} mm wide: the seat is rigid all the same, and the material between them is in neither"
                f" body. Let the sections there and gears.{gear}.bore_diameter agree"
                + (
                    ""
                    if scene.shafts.in_train
                    else f', or take seat = "{INTEGRAL}" where the teeth are cut into the shaft'
                )
            )
    return sentences


def _sections_are_solid(elastic: ElasticShaft, shaft: str) -> Iterator[str]:
    for number, section in enumerate(elastic.sections, 1):
        thin, thick = sorted((section.diameter, section.right_diameter))
        if section.bore >= thin:
            yield (
                f"shafts.{shaft}.sections: the bore of {section.bore:g} mm at place {number} leaves nothing of the"
                f" diameter of {thin:g} mm; allowed are smaller ones"
            )
        elif thick - section.bore > STEEPEST_CONE * (thin - section.bore):
            yield (
                f"shafts.{shaft}.sections: the wall of the cone at place {number} is {thick - section.bore:g} mm at one"
                f" end, more than {STEEPEST_CONE:g} times that at the other; divide it into two cones"
            )


def _places_are_on_the_shaft(elastic: ElasticShaft, shaft: str) -> Iterator[str]:
    """The gear's whole face and the coupling are on the shaft; bearings are outside the gear's face."""
    (seat,) = elastic.seats
    length = elastic.length
    half = 0.5 * seat.width
    width = f"{seat.width:g} mm"
    if length < seat.width - ROUND_OFF:
        yield (
            f"shafts.{shaft}.sections: are {length:g} mm long in all, shorter than the {seat.gear}'s face of"
            f" {width}; lengthen them"
        )
    elif not half - ROUND_OFF <= seat.at <= length - half + ROUND_OFF:
        yield (
            f"shafts.{shaft}.gear_at = {seat.at:g} mm: the {seat.gear}'s face of {width} reaches beyond the"
            f" shaft, which is {length:g} mm long; allowed is {half:g} mm to {length - half:g} mm"
        )
    if elastic.torque_at > length + ROUND_OFF:
        yield f"shafts.{shaft}.torque_at = {elastic.torque_at:g} mm: is beyond the shaft, which is {length:g} mm long"
    for number, bearing in enumerate(elastic.bearings, 1):
        name = f"bearings.{seat.gear}: the bearing at {bearing.at:g} mm, place {number},"
        if bearing.at > length + ROUND_OFF:
            yield f"{name} is beyond the shaft, which is {length:g} mm long"
        elif abs(bearing.at - seat.at) < half - ROUND_OFF:
            yield (
                f"{name} overlaps the gear, whose face reaches from {seat.at - half:g} mm to"
                f" {seat.at + half:g} mm; move it out"
            )
        yield from _stiffness_is_given_once(bearing, name)


def _stiffness_is_given_once(bearing: Bearing, name: str) -> Iterator[str]:
    if bearing.stiffness_matrix is None and bearing.radial_stiffness is None and bearing.rolling is None:
        yield f'{name} has no radial_stiffness; allowed is such as "0.3e6 N/mm", or a stiffness_matrix, or rolling'
    for whole, others in (("stiffness_matrix", BESIDE_MATRIX), ("rolling", BESIDE_ROLLING)):
        beside = [each for each in others if getattr(bearing, each)]
        if getattr(bearing, whole) is not None and beside:
            yield f"{name} has {beside[0]} beside its {whole}, which is all of its stiffness there; leave one out"
    if bearing.rolling is not None:
        yield from (f"{name} {said}" for said in _rolling_elements_fit(bearing.rolling))


def _bearings_brace(elastic: ElasticShaft) -> Iterator[str]:
    """Preloads of a shaft's bearings are each other's."""
    braced = [each.rolling.bracing for each in elastic.bearings if each.rolling is not None and each.rolling.preload]
    if abs(sum(braced)) > ROUND_OFF * sum(map(abs, braced)):
        yield (
            f"bearings.{elastic.name}: preloads push the shaft with {sum(braced):g} N along its axis; bearings that"
            " brace each other have the same preload, and contact angles of opposite signs"
        )


def bearings_hold(system: ShaftSystem) -> Iterator[str]:
    """The bearings leave no motion free, and rings with rolling elements between them stand apart."""
    free_of = free_motions(system.shafts, system.springs)
    for shaft in system.shafts:
        for number, bearing in enumerate(shaft.bearings):
            there = [each for each in shaft.bearings[:number] if abs(each.at - bearing.at) < ROUND_OFF]
            if any(each.rolling is not None for each in there) or there and bearing.rolling is not None:
                yield (
                    f"bearings.{shaft.name}: the bearing at {bearing.at:g} mm, place {number + 1}, stands where another"
                    " one does, and one of them is rolling; allowed is another place, or one bearing alone"
                )
        free = free_of[shaft.name]
        if free:
            count = len(shaft.bearings)
            held = "one bearing holds" if count == 1 else f"{count} bearings hold"
            remedies = {
                "along its axis": "give one of them an axial_stiffness",
                "tilts": "add a second bearing at another place, or give one a tilting_stiffness",
                "moves along x": "add a bearing with a radial_stiffness",
            }
            remedy = "; ".join(words for motion, words in remedies.items() if any(motion in each for each in free))
            yield (
                f"bearings.{shaft.name}: {held} the shaft, which freely {' and '.join(free)}"
                + (f": {remedy}" if remedy else "")
            )


def _rolling_elements_fit(rolling: RollingBearing) -> Iterator[str]:
    """What does not fit within a rolling bearing, to be read after its name."""
    for names, without in ((OF_ROLLERS, BALLS), (OF_BALLS, ROLLERS)):
        given = [name for name in names if getattr(rolling, name) is not None]
        if rolling.elements == without and given:
            yield f"has {given[0]}, which {without} do not have; leave it out"
    if rolling.rollers and rolling.length is None:
        yield 'has rollers without length; allowed is such as "14 mm"'
    needed = rolling.number * rolling.diameter / pi
    if needed > rolling.pitch_diameter:
        yield (
            f"has {rolling.number} {rolling.elements} of {rolling.diameter:g} mm, which do not fit on a pitch_diameter"
            f" of {rolling.pitch_diameter:g} mm; allowed are {needed:.4g} mm and more"
        )
    if rolling.preload and not rolling.contact_angle:
        yield "has a preload without contact_angle; give one, or a negative clearance for an interference"
