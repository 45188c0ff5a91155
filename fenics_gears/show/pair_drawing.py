"""The gear pair as a drawing that can be zoomed: teeth, circles, the line of action and the points on it."""

from math import degrees

import numpy as np

from fenics_gears.geometry.characteristics import contact_by_fewest
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.in_mesh import common_depth, extent_of, standing, upright
from fenics_gears.geometry.outline import rotation, tip_corner, tooth_outline
from fenics_gears.geometry.pair import GearPair
from fenics_gears.inputs.tree import GEARS

from .chart import MARKERS, Chart, Curve
from .panels import DARK, GREY, PALETTE

FILLET_POINTS = 9
INVOLUTE_POINTS = 14
CIRCLE_POINTS = 181
FILLS = ("#DCE9F3", "#F3E6DA")


def drawings(pair: GearPair, coast: bool = False) -> list[Chart]:
    """The whole pair, and the teeth along the path of contact, a pair touching at the pitch point with drive or coast
    flanks."""
    phase = (pair.pitch_point - pair.path_start) / pair.base_pitch
    teeth = [gear_outline(pair, gear, phase, coast) for gear in (0, 1)]
    drawn = "Line of centres upright, the pinion above; flanks without relief and errors, which are micrometres."
    note = f"{drawn} Drag to zoom, double click to come back."
    caption = "Teeth along the path of contact" + (" of the coast flanks, which carry" if coast else "")
    whole, close = (_curves(pair, teeth, coast, labels) for labels in (False, True))
    return [
        _drawing("The pair", note, 620, whole, *_whole(pair)),
        _drawing(caption, _points_in_words(pair, coast), 560, close, *_teeth(pair, coast)),
    ]


def _drawing(caption: str, note: str, height: int, curves: list[Curve], middle: np.ndarray, half: float) -> Chart:
    left, bottom = middle - half
    right, top = middle + half
    ends = {"x_range": (left, right), "y_range": (bottom, top)}
    return Chart(caption, curves, "x (mm)", "y (mm)", note, height, equal=True, **ends)


def gear_outline(pair: GearPair, gear: int, phase: float, coast: bool = False) -> np.ndarray:
    """Outline (n, 2), mm, of a gear at a phase of the mesh cycle, tooth after tooth, closed; line of centres upright.
    coast: with the coast flanks where the drive flanks are at that phase."""
    centre, angles = standing(pair, gear, phase)
    tooth = tooth_points(pair.gears[gear])
    # A tooth's outline runs from its drive side, which lies ahead, to its coast side.
    sign = pair.gears[gear].sign
    points = np.vstack([centre + tooth @ rotation(angle).T for angle in sign * np.sort(sign * angles)[::-1]])
    return upright(pair, np.vstack([points, points[:1]]), coast)


def tooth_points(gear: Gear) -> np.ndarray:
    """One tooth (n, 2) from the middle of the space at its drive flank to the middle of the space at its coast
    flank."""
    outline = tooth_outline(gear, FILLET_POINTS)
    involute = outline.involute(np.linspace(gear.form_roll_angle, gear.tip_roll_angle, INVOLUTE_POINTS))[1:]
    # With a negative radius an angle points to the other side.
    foot = np.arctan2(gear.sign * outline.fillet[0, 1], gear.sign * outline.fillet[0, 0])
    middle = outline.centreline_angle
    space = middle + np.remainder(outline.space_angle - middle + np.pi, 2 * np.pi) - np.pi
    land = _arc(gear.root_radius, space, space + np.remainder(foot - space + np.pi, 2 * np.pi) - np.pi)
    chamfer = [tip_corner(gear)] if gear.tip_chamfer else []
    half = np.vstack([land[:-1], outline.fillet, involute, *chamfer])
    return np.vstack([half, outline.coast(half)[::-1]])


def _arc(radius: float, start: float, end: float, points: int = 4) -> np.ndarray:
    angles = np.linspace(start, end, points)
    return radius * np.column_stack([np.cos(angles), np.sin(angles)])


def _curves(pair: GearPair, teeth: list[np.ndarray], coast: bool, labels: bool) -> list[Curve]:
    gears = tuple(zip(GEARS, pair.gears))
    curves = []

    def line(name: str, points: np.ndarray, colour: str, width: float, **style) -> None:
        curves.append(Curve(name, points[:, 0], points[:, 1], colour, width=width, **style))

    bodies = list(zip(gears, teeth, FILLS, _centres(pair)))
    # An internal gear lies around its pinion: first its rim, then the hole that its teeth leave.
    for (name, gear), points, fill, centre in sorted(bodies, key=lambda each: each[0][1].sign):
        around = centre + _circle(gear.bore_radius)
        first, second = (around, points) if gear.internal else (points, around)
        line(name, first, DARK, 1.2, fill=fill)
        line("teeth" if gear.internal else "bore", second, DARK, 1.2, fill="white", listed=False)
    circles = {"base circles": ("base_radius", "dash", GREY), "reference circles": ("reference_radius", "dot", GREY)}
    for name, (radius, dash, colour) in circles.items():
        parts = [centre + _circle(getattr(gear, radius)) for (_, gear), centre in zip(gears, _centres(pair))]
        line(name, np.vstack([parts[0], [[np.nan, np.nan]], parts[1]]), colour, 1.0, dash=dash)
    line("line of action", _on_line(pair, [0.0, pair.line_of_action_length], coast), PALETTE[1], 1.2)
    line("path of contact", _on_line(pair, [pair.path_start, pair.path_end], coast), PALETTE[1], 4.0)
    places = {name: place for name, place in _points(pair, coast).items() if labels or name == "pitch point"}
    at = _on_line(pair, list(places.values()), coast)
    names = list(places)
    # The pitch point lies close to its neighbours, and the path's end has room below alone.
    below = np.array([name in ("pitch point", names[-1]) for name in names])
    for own, side in zip((~below, below), ("top left", "bottom right") if coast else ("top right", "bottom left")):
        if own.any():
            words = np.array(names)[own].tolist()
            line("points", at[own], DARK, 1.6, mode=MARKERS, listed=False, words=words, beside=side)
    return curves


def _centres(pair: GearPair) -> tuple[np.ndarray, np.ndarray]:
    return np.zeros(2), np.array([0.0, -pair.centre_distance])


def _circle(radius: float) -> np.ndarray:
    return _arc(radius, 0.0, 2.0 * np.pi, CIRCLE_POINTS)


def _on_line(pair: GearPair, positions: list[float], coast: bool = False) -> np.ndarray:
    """Points (n, 2) of the picture at positions (mm from T1) on the line of action of drive or coast flanks."""
    return upright(pair, np.column_stack([positions, np.full(len(positions), -pair.pinion.base_radius)]), coast)


def _points(pair: GearPair, coast: bool) -> dict[str, float]:
    """Positions (mm from T1) of the points on the path of contact."""
    letters = contact_by_fewest(pair)[1]
    ends = ("end of contact", "start of contact") if coast else ("start of contact", "end of contact")
    names = (ends[0], f"LP{letters}", "pitch point", f"HP{letters}", ends[1])
    places = (pair.path_start, pair.lpstc, pair.pitch_point, pair.hpstc, pair.path_end)
    return dict(zip(names, places))


def _points_in_words(pair: GearPair, coast: bool) -> str:
    points = _points(pair, coast).items()
    words = [f"{name} {place:.2f} mm ({degrees(pair.pinion_roll_angle(place)):.2f}°)" for name, place in points]
    said = f"From T1 on the line of action, with the pinion's roll angle: {'; '.join(words)}."
    contact, letters = contact_by_fewest(pair)
    return f"{said} LP{letters} and HP{letters}: lowest and highest point of {contact}, of the pinion."


def _whole(pair: GearPair) -> tuple[np.ndarray, float]:
    low, high = extent_of(pair)[1]
    return np.array([0.0, 0.5 * (low + high)]), 0.53 * (high - low)


def _teeth(pair: GearPair, coast: bool) -> tuple[np.ndarray, float]:
    """Middle and half height of a view of the path of contact, with the teeth's roots."""
    middle = _on_line(pair, [0.5 * (pair.path_start + pair.path_end)], coast)[0]
    depth = common_depth(pair) + 3.0 * pair.pinion.module
    return middle, 0.5 * depth
