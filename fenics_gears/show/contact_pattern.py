"""The contact pattern: the largest pressure at each point of a flank while it is in mesh."""

import numpy as np
import xarray as xr

from fenics_gears.contact.window import coast_roll_angles, contact_roll_angles
from fenics_gears.geometry.pair import GearPair
from fenics_gears.inputs.tree import GEARS
from fenics_gears.results.face_ends import slice_ends
from fenics_gears.results.mesh_curves import read_off
from fenics_gears.results.pairs import carrying_side

from .chart import Chart, Curve, Field
from .panels import DARK, GREY
from .pressure import COLOURS, colour_limit, counted_on, has_pressure, node_edges
from .run import ShownRun

ACROSS = "Distance along the axes from the middle of the common face (mm)"
ROWS = 200
# A peak is an edge's and not the flank's from this many times the pressure of a neighbouring step.
EDGE_PEAK = 2.0
NOTE = "Averaged over five contact nodes; between steps the peak is interpolated along the flank."


def contact_patterns(run: ShownRun) -> list[Chart]:
    """Patterns on the flanks of pinion and wheel that carry, in the last cycles whose contact fields are stored."""
    if not has_pressure(run) or run.pair is None:
        return []
    side = carrying_side(run.dataset)
    part = run.last_fields
    pressure, rolls = over_face(part, side)
    pressed = pressure[(pressure > 0.0) & np.isfinite(rolls)]
    if not pressed.size:
        return []
    limit = colour_limit(run, pressed)
    peak = pressed.max()
    above = f": colours end at {limit:.0f} MPa, the peak is {peak:.0f} MPa" if peak > limit * (1 + 1e-9) else ""
    both = (rolls, rolls_on_wheel(run.pair, part, side, rolls))
    return [_pattern(run, gear, side, pressure, of_gear, limit, above) for gear, of_gear in enumerate(both)]


def over_face(part: xr.Dataset, side: str) -> tuple[np.ndarray, np.ndarray]:
    """Pressure (MPa) and the pinion's roll angle (rad) of the contact nodes, both (step, slot, slice, node)."""
    order = ("contact_time", "slot", "face_position", "contact_node")
    pressure, rolls = (part[f"{side}contact_{name}"].transpose(*order).values for name in ("pressure", "roll_angle"))
    return read_off(pressure, rolls), rolls


def rolls_on_wheel(pair: GearPair, part: xr.Dataset, side: str, rolls: np.ndarray) -> np.ndarray:
    """Roll angles (rad) on the wheel's flank of contact nodes from those on the pinion's: they are as far from the
    point of contact, on the other side."""
    numbers = part["contact_pair_number"]
    since = part["contact_mesh_phase"].values[:, None] - (numbers.values - numbers.attrs["number_at_phase_0"])
    ahead = (pair.slope * part["face_position"].values)[:, None]
    xi = pair.path_start + since[..., None, None] * pair.base_pitch + ahead
    of_pinion, of_wheel = (coast_roll_angles if side else contact_roll_angles)(pair, xi)
    along = 0.5 * pair.pinion.base_radius * (rolls**2 - of_pinion**2)
    return np.sqrt(np.maximum(of_wheel**2 - 2.0 * along / pair.wheel.base_radius, 0.0))


def _pattern(run: ShownRun, gear: int, side: str, pressure, rolls, limit: float, above: str) -> Chart:
    pair = run.pair
    name = GEARS[gear]
    data = getattr(pair, name)
    ends = data.roll_ends
    numbers = run.last_fields["contact_pair_number"].values

    def radius(roll):
        return np.abs(data.radius(roll))

    field = pattern(pressure, rolls, numbers, ends, radius, slice_ends(run.dataset), limit)
    pitch = 2.0 * radius(contact_roll_angles(pair, pair.pitch_point)[gear])
    active = 2.0 * radius(pair.sap_roll_angles[gear])
    face = np.array(pair.common_face)
    lines = [("pitch cylinder", pitch, DARK, "dash"), ("start of the active profile", active, GREY, "dot")]
    flank = " (coast flank)" if side else ""
    return Chart(
        f"Largest contact pressure on the {name}'s flank{flank}{above}",
        [Curve(words, face, np.full(2, d), colour, dash, 1.0) for words, d, colour, dash in lines],
        ACROSS, f"Diameter on the {name} (mm)", x_range=pair.common_face,
        y_range=(2.0 * radius(ends[0]), 2.0 * radius(ends[1])),
        field=field, height=380, note=NOTE,
    )  # fmt: skip


def pattern(pressure, rolls, numbers, ends: tuple[float, float], radius, slices: np.ndarray, limit: float) -> Field:
    """The largest pressure (MPa) in cells of slices and diameter, of pressures and roll angles (step, slot, slice,
    node) of pairs with numbers (step, slot).

    Nodes reach half-way to their neighbours; the peak of a pair in a slice goes straight from step to step. ends: roll
    angles between which the cells lie; radius: mm, of a roll angle; slices: their ends (S + 1,), mm.
    """
    diameters = np.linspace(2.0 * radius(ends[0]), 2.0 * radius(ends[1]), ROWS + 1)
    values = np.full((ROWS, len(slices) - 1), -np.inf)

    def fill(begin, end, first, last, column) -> None:
        """Pressures from `begin` to `end` (n,) into the cells between diameters `first` and `last` of columns (n,)."""
        bounds = np.minimum(first, last), np.maximum(first, last)
        low, high = (np.clip(np.searchsorted(diameters, each) - 1, 0, ROWS - 1) for each in bounds)
        each, row = counted_on(low, high - low + 1)
        way = np.where(first == last, 1.0, last - first)[each]
        part = np.clip((0.5 * (diameters[row] + diameters[row + 1]) - first[each]) / way, 0.0, 1.0)
        np.maximum.at(values, (row, column[each]), (1.0 - part) * begin[each] + part * end[each])

    edges = [2.0 * radius(np.clip(edge, *ends)) for edge in node_edges(rolls)]
    pressed = (pressure > 0.0) & np.isfinite(edges[0]) & np.isfinite(edges[1])
    fill(pressure[pressed], pressure[pressed], edges[0][pressed], edges[1][pressed], np.nonzero(pressed)[2])
    node = np.where(pressed, pressure, 0.0).argmax(axis=-1)[..., None]
    places = 2.0 * radius(np.clip(rolls, *ends))
    peak, place = (np.take_along_axis(each, node, -1)[..., 0] for each in (pressure, places))
    # The peak of an edge, many times that of the flank, is no larger at the steps between.
    alike = np.maximum(peak[1:], peak[:-1]) < EDGE_PEAK * np.minimum(peak[1:], peak[:-1])
    goes_on = alike & (numbers[1:] == numbers[:-1])[..., None] & np.isfinite(place[1:] + place[:-1])
    fill(peak[:-1][goes_on], peak[1:][goes_on], place[:-1][goes_on], place[1:][goes_on], np.nonzero(goes_on)[2])
    values[np.isneginf(values)] = np.nan
    return Field(slices, diameters, values, "Contact pressure (MPa)", limit, COLOURS)
