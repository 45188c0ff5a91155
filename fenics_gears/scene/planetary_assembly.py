"""Whether the gears of a planetary set fit: one centre distance, places where planets can be assembled, room between
them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import pi

from fenics_gears.errors import GeometryError
from fenics_gears.geometry.pair import GearPair
from fenics_gears.geometry.planetary import RING, PlanetarySet, planets_that_assemble
from fenics_gears.inputs.problem import NOTHING_DONE

from .planetary_schema import PlanetaryText

# Planets may be so far from where they can be assembled, in pitches: angles are written with few digits.
LEAST_BESIDE = 1e-3
# Of a diameter; circles that overlap by less meet.
ROUNDING = 1e-9


def check_centres(pairs: Sequence[GearPair], gears: tuple[str, str], place: str) -> None:
    """Raise GeometryError where the planets would have two centre distances; `gears` of the second mesh."""
    planet, second = gears
    external = f"z_{second} + z_{planet}"
    without = f"z_sun + z_planet = {external if second != RING else f'z_ring - z_{planet}'}"
    if planet == "planet":
        without = "z_ring = z_sun + 2 z_planet"
    sun, ring = (abs(pair.centre_distance) for pair in pairs)
    if abs(sun - ring) > 1e-6 * pairs[0].pinion.module:
        raise GeometryError(
            f"{place}: the planets do not fit: their centres are {sun:.6g} mm from that of the sun and {ring:.6g} mm"
            f" from that of the {second}. Give centre_distance, with profile shifts that leave backlash there, or"
            f" change the profile shifts or the teeth: without shifts, of one module, {without}. {NOTHING_DONE}"
        )


def set_of(text: PlanetaryText, pairs: Sequence[GearPair], gears: tuple[str, str], place: str) -> PlanetarySet:
    """The set, its planets where they can be assembled; `gears` of the second mesh. Raises GeometryError, with the
    nearest places that can."""
    teeth = pairs[0].pinion.teeth, pairs[0].wheel.teeth, pairs[1].wheel.tooth_count
    assert text.fixed is not None and text.input is not None
    step = None if gears[0] == "planet" else pairs[1].pinion.teeth
    own = PlanetarySet(teeth, (), text.fixed, text.input, "", step, gears[1])
    turn = own.turn
    if not turn:
        raise GeometryError(
            f"{place}: both suns turn alike, whatever the carrier does: z_sun z_step = z_second_sun z_planet ="
            f" {teeth[2] * teeth[1]}. Allowed: numbers of teeth of which these products differ. {NOTHING_DONE}"
        )
    if text.planets is not None:
        wanted = [number * turn / text.planets for number in range(text.planets)]
        sizes = abs(pairs[0].centre_distance), _largest_tip(pairs)
        possible = ", ".join(map(str, planets_that_assemble(turn, *sizes)[:8])) or "none"
        more = f" Equally spaced, {possible} planets can."
    else:
        wanted = [float(angle) / (2.0 * pi) * turn for angle in text.planet_angles or ()]
        more = ""
    places = [round(each - wanted[0]) for each in wanted]
    beside = [each - wanted[0] - found for each, found in zip(wanted, places)]
    if max(map(abs, beside)) > LEAST_BESIDE:
        worst = max(range(len(beside)), key=lambda each: abs(beside[each]))
        nearest = ", ".join(f'"{360.0 * (each + wanted[0]) / turn:.8g} deg"' for each in places)
        raise GeometryError(
            f"{place}: the set cannot be assembled: planet {worst + 1} would {_beside(own, abs(beside[worst]))}"
            f" = {360.0 / turn:.6g} deg.{more} The nearest that can: planet_angles = [{nearest}]. {NOTHING_DONE}"
        )
    output = text.output or next(each for each in own.members if each not in (text.fixed, text.input))
    return replace(own, places=tuple(places), output=output)


def _beside(own: PlanetarySet, part: float) -> str:
    """What a planet does that is beside its place by a part of what is between two places, and where places are."""
    if not own.stepped:
        return (
            f"stand {part:.4g} pitches beside the teeth of sun and ring. Planets fit at multiples of 360 deg/(z_sun"
            " + z_ring)"
        )
    # Its teeth stand alike after this angle.
    alike = 360.0 / (own.teeth[1] * own.cycles[1])
    return (
        f"need its gears turned against each other by {part * alike:.4g} deg more than those of planet 1, and planets"
        f" are alike. They fit at multiples of 360 deg/{own.turn}"
    )


def _largest_tip(pairs: Sequence[GearPair]) -> float:
    """Diameter (mm) of the larger tip circle of a planet."""
    return 2.0 * max(pairs[0].wheel.tip_radius, pairs[1].pinion.tip_radius)


def check_clear(own: PlanetarySet, pairs: Sequence[GearPair], place: str) -> None:
    """Raise GeometryError for planets that touch each other."""
    distance = abs(pairs[0].centre_distance)
    tip = _largest_tip(pairs)
    for one, other, clear in own.clearances(distance, tip):
        if clear <= 0.0:
            most = max(planets_that_assemble(own.turn, distance, tip), default=0)
            allowed = f"Equally spaced, up to {most} planets have room." if most else "No two planets have room."
            overlap = f" overlap by {-clear:.4g} mm" if -clear > ROUNDING * tip else " meet, without room between them"
            raise GeometryError(
                f"{place}: planets {one + 1} and {other + 1} touch: their tip circles of {tip:.6g} mm{overlap}."
                f" {allowed} {NOTHING_DONE}"
            )
