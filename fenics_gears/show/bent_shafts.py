"""Shafts that bend, with gears and bearings: to scale with their deflection magnified, and the deflection lines."""

from collections.abc import Iterator
from math import floor, log10
from typing import NamedTuple

import numpy as np

from fenics_gears.inputs.tree import GEARS

from .chart import MARKERS, Chart, Curve
from .panels import DARK, PALETTE
from .run import ShownRun

ACROSS = "Place along the axes, from the middle of the common face (mm)"
# Not divided as the lines are, which have no scale to keep.
LENGTHS = "Place along the axes (mm)"
DIRECTIONS = {"x": "in the plane of action", "y": "off the line of action"}
# Largest deflection of the drawing, in parts of the longest shaft.
DRAWN = 0.05
# A deflection, mm, that is drawn: spur gears push nowhere but along the line of action.
SMALLEST = 1e-6
OF_GEAR = dict(zip(GEARS, PALETTE[2:4]))


class ShaftLine(NamedTuple):
    """The axis of a gear's shaft: `places` (p,), mm from the middle of the common face, and the mean deflection (p,),
    mm, by direction. `bearings` (b,): their places. `seat`: where the gear begins and ends."""

    gear: str
    places: np.ndarray
    deflection: dict[str, np.ndarray]
    bearings: np.ndarray
    seat: np.ndarray


def bent_shafts(run: ShownRun) -> list[Chart]:
    """Shafts, gears and bearings, the deflection in the plane of action magnified; and the deflection in either
    direction."""
    if "shaft_deflection_x" not in run.dataset or not run.dataset.sizes["contact_time"] or run.pair is None:
        return []
    lines = list(_lines(run))
    bent = [each for each in DIRECTIONS if max(np.abs(line.deflection[each]).max() for line in lines) > SMALLEST]
    return [_to_scale(run, lines), *(_deflection(lines, direction) for direction in bent)]


def _lines(run: ShownRun) -> Iterator[ShaftLine]:
    part = run.last_fields
    pair = run.pair
    shafts = run.scene.shafts.sections
    for number, gear in enumerate(GEARS):
        if gear in shafts:
            from_end = pair.gear_middles[number] - shafts[gear].gear_at
            own = part.sel(gear=gear)
            deflection = {each: own[f"shaft_deflection_{each}"].values.mean(axis=0) for each in DIRECTIONS}
            bearings = np.array([each.at for each in run.scene.bearings.each_of(gear)]) + from_end
            seat = pair.gear_middles[number] + np.array([-0.5, 0.5]) * pair.face_widths[number]
            yield ShaftLine(gear, own["shaft_place"].values + from_end, deflection, bearings, seat)


def _to_scale(run: ShownRun, lines: list[ShaftLine]) -> Chart:
    largest = max(np.abs(each.deflection["x"]).max() for each in lines)
    longest = max(np.ptp(each.places) for each in lines)
    # A magnification of one digit.
    wanted = DRAWN * longest / largest if largest > 0.0 else 1.0
    magnified = floor(wanted / 10 ** floor(log10(wanted))) * 10.0 ** floor(log10(wanted))
    curves = []
    for line in lines:
        gear = getattr(run.pair, line.gear)
        colour = OF_GEAR[line.gear]
        axis = _axis(run, line.gear)

        def moved(places: np.ndarray, line: ShaftLine = line, axis: float = axis) -> np.ndarray:
            return axis + magnified * np.interp(places, line.places, line.deflection["x"])

        places, radii = _outline(run, line)
        upper = moved(places) + radii
        lower = moved(places) - radii
        shaft = np.append(places, places[::-1]), np.append(upper, lower[::-1])
        curves.append(_closed(f"{line.gear}'s shaft", *shaft, DARK))
        corners = line.seat[[0, 1, 1, 0]]
        tips = moved(corners) + gear.tip_radius * np.array([1.0, 1.0, -1.0, -1.0])
        curves.append(_closed(line.gear, corners, tips, colour))
        at_bearings = moved(line.bearings)
        curves.append(Curve(f"{line.gear}'s bearings", line.bearings, at_bearings, colour, mode=MARKERS, width=8.0))
    for number, gear in enumerate(GEARS):
        if gear not in {line.gear for line in lines}:
            half = 0.5 * run.pair.face_widths[number]
            tip = getattr(run.pair, gear).tip_radius
            corners = run.pair.gear_middles[number] + half * np.array([-1.0, 1.0, 1.0, -1.0])
            tips = _axis(run, gear) + tip * np.array([1.0, 1.0, -1.0, -1.0])
            curves.append(_closed(f"{gear}, its shaft rigid", corners, tips, OF_GEAR[gear]))
    return Chart(
        f"Shafts, gears and bearings: deflection in the plane of action magnified {magnified:g} times", curves, LENGTHS,
        "Distance from the pinion's axis (mm)", equal=True, height=420,
        note="Mean over the last mesh cycles. Deflection upwards is along the line of action, from pinion to wheel.",
    )  # fmt: skip


def _axis(run: ShownRun, gear: str) -> float:
    return 0.0 if gear == GEARS[0] else -run.pair.centre_distance


def _closed(name: str, x: np.ndarray, y: np.ndarray, colour: str) -> Curve:
    return Curve(name, np.append(x, x[0]), np.append(y, y[0]), colour)


def _outline(run: ShownRun, line: ShaftLine) -> tuple[np.ndarray, np.ndarray]:
    """Places and radii of a shaft from end to end; a step has two radii at one place."""
    begin = line.places[0]
    places = []
    radii = []
    for section in run.scene.shafts.sections[line.gear].sections:
        part = np.linspace(begin, begin + section.length, 9)
        places.append(part)
        radii.append(0.5 * np.interp(part, part[[0, -1]], (section.diameter, section.right_diameter)))
        begin += section.length
    return np.concatenate(places), np.concatenate(radii)


def _deflection(lines: list[ShaftLine], direction: str) -> Chart:
    curves = []
    for line in lines:
        colour = OF_GEAR[line.gear]
        values = 1e3 * line.deflection[direction]
        curves.append(Curve(f"{line.gear}'s shaft", line.places, values, colour))
        at_seat, at_bearings = (np.interp(each, line.places, values) for each in (line.seat, line.bearings))
        curves.append(Curve(f"{line.gear}'s seat", line.seat, at_seat, colour, width=5.0))
        curves.append(Curve(f"{line.gear}'s bearings", line.bearings, at_bearings, colour, mode=MARKERS, width=8.0))
    return Chart(f"Deflection of the shafts {DIRECTIONS[direction]}", curves, ACROSS, "Deflection (µm)", height=260)
