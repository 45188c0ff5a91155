"""Contact pressure over flank and time, as a map: every closed contact node at every stored step is one cell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure

from fenics_gears.geometry.pair import GearPair
from fenics_gears.results.pairs import contact_times
from fenics_gears.show.panels import DARK, legend, panels, styled
from fenics_gears.show.run_scene import gear_pair_of
from fenics_gears.show.units import factor, in_unit

# A tip that enters or leaves presses with its edge: a few cells far above all others, which would leave these one colour.
COMMON_SHARE = 98.0  # per cent of the cells that the colour scale spans
NAMED_SHARE = 0.2  # of the time axis, that a pair's band must span to have its number beside it

# Which side of the teeth: how the result's variables of that side begin.
DRIVE, COAST = "", "coast_"

_DEGREES = factor("rad", "deg")


@dataclass(frozen=True)
class Cells:
    """Rectangles of the map: corners (n, 4, 2) as mesh cycles and degrees, pressure (n,) in MPa, pair number (n,)."""

    corners: np.ndarray
    pressure: np.ndarray
    pair: np.ndarray


@styled
def contact_pressure(dataset: xr.Dataset) -> Figure | None:
    """Pressure (MPa) over mesh cycles and the pinion's roll angle (deg), the wheel's beside it, the pitch point marked."""
    if "contact_pressure" not in dataset or "contact_roll_angle" not in dataset:
        return None
    dataset = contact_times(dataset)
    sides = _sides_under_pressure(dataset)
    figure, every_axes = panels(dataset, "Contact pressure on the flanks", [5.2] * len(sides))
    for axes, side in zip(every_axes, sides):
        _draw_side(figure, axes, dataset, side)
        if COAST in sides:
            name, note = "Coast flanks" if side == COAST else "Drive flanks", axes.get_title(loc="left").split(" (")[0]
            axes.set_title(f"{name}. {note}" if note else name)
    return figure


def _sides_under_pressure(dataset: xr.Dataset) -> list[str]:
    """The sides of the teeth that carry in the record; drive flanks where neither does."""
    sides = [side for side in (DRIVE, COAST) if f"{side}contact_pressure" in dataset and (dataset[f"{side}contact_pressure"] > 0.0).any()]
    return sides or [DRIVE]


def _draw_side(figure: Figure, axes: Axes, dataset: xr.Dataset, side: str) -> None:
    cells = pressure_cells(dataset, side)
    axes.set_ylabel("Roll angle on the pinion's flank (deg)")
    places = in_unit(dataset[f"{side}contact_roll_angle"], "deg")
    finite = places[np.isfinite(places)]
    if finite.size:
        axes.set_ylim(finite.min() - 0.5, finite.max() + 0.5)
    pair = gear_pair_of(dataset)
    if pair is not None:
        _draw_pitch_point(axes, pair)
        _draw_wheel_axis(axes, pair)
    _draw_cells(figure, axes, cells)
    _name_pairs(axes, cells)


def pressure_cells(dataset: xr.Dataset, side: str = DRIVE) -> Cells:
    """One rectangle for each contact node under pressure: a time step wide, reaching half-way to the node's neighbours."""
    order = ("contact_time", "slot", "contact_node")
    pressure = in_unit(dataset[f"{side}contact_pressure"].transpose(*order), "MPa")
    place = in_unit(dataset[f"{side}contact_roll_angle"].transpose(*order), "deg")
    phase = dataset["contact_mesh_phase"].values
    low, high = _node_edges(place)
    before, after = _step_edges(phase)
    step, slot, node = np.nonzero((pressure > 0.0) & np.isfinite(low) & np.isfinite(high))
    left, right, bottom, top = before[step], after[step], low[step, slot, node], high[step, slot, node]
    corners = np.stack(
        [np.stack([left, bottom], 1), np.stack([right, bottom], 1), np.stack([right, top], 1), np.stack([left, top], 1)], axis=1
    )
    return Cells(corners, pressure[step, slot, node], dataset["contact_pair_number"].values[step, slot])


def _step_edges(phase: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Begin and end (n,) of each step's cells, half-way between the steps; the record's ends bound the first and the last."""
    middle = 0.5 * (phase[1:] + phase[:-1])
    return np.append(phase[0], middle), np.append(middle, phase[-1])


def _node_edges(place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper edge of each node's cell, both of the shape of ``place``; a node without a neighbour mirrors the other edge."""
    missing = np.full(place.shape[:-1] + (1,), np.nan)
    half = 0.5 * np.diff(place, axis=-1)
    back, forth = np.concatenate([missing, half], axis=-1), np.concatenate([half, missing], axis=-1)
    back, forth = np.where(np.isnan(back), forth, back), np.where(np.isnan(forth), back, forth)
    edges = np.stack([place - back, place + forth])
    return edges.min(axis=0), edges.max(axis=0)


def _draw_cells(figure: Figure, axes: Axes, cells: Cells) -> None:
    highest = float(cells.pressure.max()) if cells.pressure.size else 1.0
    common = float(np.percentile(cells.pressure, COMMON_SHARE)) if cells.pressure.size else 1.0
    clipped = highest > 1.2 * common
    # Without antialiasing, neighbouring cells leave no seams between them.
    patches = PolyCollection(
        cells.corners, array=cells.pressure, cmap=_colours(), norm=Normalize(0.0, common if clipped else highest), antialiased=False
    )
    axes.add_collection(patches, autolim=False)
    bar = figure.colorbar(patches, ax=axes, extend="max" if clipped else "neither", pad=0.02, fraction=0.05)
    bar.set_label("Contact pressure (MPa)")
    bar.outline.set_visible(False)
    if clipped:
        when = cells.corners[np.argmax(cells.pressure), :, 0].mean()
        axes.set_title(f"Beyond the colour scale: up to {highest:.0f} MPa (mesh cycle {when:.2f})")


def _colours() -> LinearSegmentedColormap:
    """From light to dark in lightness, so that zero lies close to the paper and grey print keeps the order."""
    return LinearSegmentedColormap.from_list("pressure", ["#FDE9B8", "#F6A04D", "#D9483B", "#8A1A63", "#2A0A4A"])


def _draw_pitch_point(axes: Axes, pair: GearPair) -> None:
    roll = float(pair.pinion_roll_angle(pair.pitch_point)) * _DEGREES
    axes.axhline(roll, color=DARK, linewidth=1.0, linestyle=(0, (5, 3)), label="pitch point")
    legend(axes, columns=1)


def _draw_wheel_axis(axes: Axes, pair: GearPair) -> None:
    """Roll angle of the point on the wheel's flank that meets the pinion's; it falls as the pinion's rises."""
    first, second, length = pair.pinion.base_radius, pair.wheel.base_radius, pair.line_of_action_length * _DEGREES
    wheel = axes.secondary_yaxis(
        "right", functions=(lambda roll: (length - first * roll) / second, lambda roll: (length - second * roll) / first)
    )
    wheel.set_ylabel("Roll angle on the wheel's flank (deg)")


def _name_pairs(axes: Axes, cells: Cells) -> None:
    """The number of each pair beside the middle of its band, where the band is long enough to leave it room."""
    begin, end = axes.get_xlim()
    for number in np.unique(cells.pair):
        corners = cells.corners[cells.pair == number]
        left, right = corners[:, :, 0].min(), corners[:, :, 0].max()
        if right - left < NAMED_SHARE * (end - begin):
            continue
        middle = 0.5 * (left + right)
        nearest = np.argmin(np.abs(corners[:, :, 0].mean(axis=1) - middle))
        place = (middle, corners[nearest, :, 1].max())
        axes.annotate(f"pair {number}", place, xytext=(-8, 6), textcoords="offset points", ha="right", fontsize=11)
