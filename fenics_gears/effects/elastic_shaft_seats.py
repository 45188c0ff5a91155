"""How a gear sits on a shaft with sections, where its seat is not rigid, and what is wrong with that. Not an effect by
itself."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from fenics_gears.dynamics.elastic_shaft import ElasticShaft, SeatedGear
from fenics_gears.dynamics.elastic_shaft_hub import Hub, Ring
from fenics_gears.dynamics.shafts import PRESS_FIT, RIGID_SEAT, ShaftSection
from fenics_gears.inputs.tree import GEARS

if TYPE_CHECKING:
    from fenics_gears.geometry.gear import Gear
    from fenics_gears.geometry.gear_data import Material

# Bearings of a shaft (mm) that are no further apart, and ends that protrude by as little, are so by round-off.
ROUND_OFF = 1e-9
# Part of a bore by which the shaft in it may be thinner or thicker without a word: a press fit's.
OFF_THE_BORE = 0.01


def seated(shaft: ElasticShaft, number: int, seat: str, gear: Gear, material: Material) -> ElasticShaft:
    """A shaft one of whose gears, by its number, is of a material and has a seat that may give way."""
    if seat == RIGID_SEAT:
        return shaft
    own = shaft.seats[number]
    hub = hub_of(shaft, own, gear, material) if seat == PRESS_FIT else None
    yielding = replace(own, integral=hub is None, hub=hub)
    shaft = replace(shaft, seats=(*shaft.seats[:number], yielding, *shaft.seats[number + 1 :]))
    if hub is not None:
        return shaft
    # The gear's own mass is counted down to its bore.
    heavy = _toothed(shaft.heavy or shaft.sections, own.ends, 2.0 * gear.bore_radius)
    return replace(shaft, sections=_toothed(shaft.sections, own.ends, 2.0 * gear.root_radius), heavy=heavy)


def hub_of(shaft: ElasticShaft, seat: SeatedGear, gear: Gear, material: Material) -> Hub:
    """Gear and shaft within the face as rings, the shaft as bored as it is there."""
    half = 0.5 * seat.width
    bore = gear.bore_radius
    constants = (material.youngs_modulus, material.poissons_ratio)
    bores = [part.bore for part, under in _cut_at(shaft.sections, seat.ends) if under]
    hollow = 0.5 * max(bores, default=0.0)
    within = Ring(hollow, bore, -half, half, *shaft.material)
    if gear.web is None:
        return Hub((Ring(bore, gear.root_radius, -half, half, *constants),), within)
    middle = gear.web.offset * seat.width
    thick = 0.5 * gear.web.share * seat.width
    hub = gear.web.hub_radius
    rim = gear.web.rim_radius
    rings = [
        Ring(rim, gear.root_radius, -half, half, *constants),
        Ring(hub, rim, middle - thick, middle + thick, *constants),
    ]
    return Hub((*rings, *([Ring(bore, hub, -half, half, *constants)] if hub > bore else [])), within)


def _toothed(sections: Sequence[ShaftSection], face: tuple[float, float], diameter: float) -> tuple[ShaftSection, ...]:
    """The sections of a shaft, which between both ends of a gear's `face` (mm from the left end) is a cylinder of a
    diameter (mm), bored as it is."""
    return tuple(
        replace(part, diameter=diameter, end_diameter=diameter) if under else part
        for part, under in _cut_at(sections, face)
    )


def _cut_at(sections: Sequence[ShaftSection], face: tuple[float, float]) -> Iterator[tuple[ShaftSection, bool]]:
    """The sections of a shaft, cut at both ends of a gear's `face`, and whether each part is under it."""
    begin = 0.0
    for section in sections:
        end = begin + section.length
        slope = (section.right_diameter - section.diameter) / section.length
        stops = [begin, *(each for each in face if begin + ROUND_OFF < each < end - ROUND_OFF), end]
        for left, right in pairwise(stops):
            thick, end_thick = (section.diameter + slope * (each - begin) for each in (left, right))
            yield ShaftSection(right - left, thick, end_thick, section.bore), face[0] < 0.5 * (left + right) < face[1]
        begin = end


def sections_between(sections: Sequence[ShaftSection], begin: float, end: float) -> tuple[ShaftSection, ...]:
    """The sections of a shaft from one place to another, mm from its left end."""
    return tuple(part for part, between in _cut_at(sections, (begin, end)) if between)


def under_the_face(sections: Sequence[ShaftSection], face: tuple[float, float]) -> list[float]:
    """Diameters (mm) of a shaft at both ends of each section, as far as a gear's face reaches over it."""
    return [diameter for part in sections_between(sections, *face) for diameter in (part.diameter, part.right_diameter)]


def wrong_with_seat(scene: Any, pair: Any, elastic: ElasticShaft, shaft: str) -> Iterator[str]:
    """The shaft fits within the root circle; a gear cut into it is of the same material, and its coupling is outside
    the face."""
    (seat,) = elastic.seats
    own = scene.shafts.sections[elastic.name]
    gear = getattr(pair, seat.gear)
    root = 2.0 * gear.root_radius
    thickest = max(under_the_face(own.sections, seat.ends), default=0.0)
    if thickest > root:
        yield (
            f"shafts.{shaft}.sections: the shaft is {thickest:g} mm thick under the {seat.gear}'s face, more than"
            f" the root diameter of {root:g} mm; allowed are smaller ones"
        )
    if not seat.yields_within:
        return
    named = f'shafts.{shaft}.seat = "{own.seat}"'
    material = scene.gears.materials[GEARS.index(seat.gear)]
    if seat.hub is not None:
        yield from _is_a_cylinder(own, seat, 2.0 * gear.bore_radius, named)
    elif elastic.material != (material.youngs_modulus, material.poissons_ratio):
        made_of = f"{seat.gear} and shaft are one piece, but of two materials"
        yield f"{named}: {made_of}; leave shafts.{shaft}.material out"
    if gear.web is not None and seat.integral:
        web = f"gears.{seat.gear}.web"
        yield f'{named}: {web} stands between teeth and shaft; leave one out, or seat = "{RIGID_SEAT}"'
    if abs(elastic.torque_at - seat.at) < 0.5 * seat.width + ROUND_OFF:
        where = f"torque_at = {elastic.torque_at:g} mm is within the face or at its end"
        yield f"{named}: {where}; move the coupling out of it"


def _is_a_cylinder(own: Any, seat: SeatedGear, bore: float, named: str) -> Iterator[str]:
    """The shaft in an elastic hub is as thick as the hub's bore, and has one bore itself."""
    under = [part for part, within in _cut_at(own.sections, seat.ends) if within]
    ends = [each for part in under for each in (part.diameter, part.right_diameter)]
    off = [each for each in ends if abs(each - bore) > OFF_THE_BORE * bore]
    if off:
        yield (
            f"{named}: the shaft is {off[0]:g} mm thick under the {seat.gear}'s face; allowed is a cylinder as thick"
            f" as gears.{seat.gear}.bore_diameter, {bore:g} mm"
        )
    elif len({part.bore for part in under}) > 1:
        yield f"{named}: the shaft's bore changes under the {seat.gear}'s face; let it change outside the face"
