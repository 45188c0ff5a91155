"""Charts of the contact pressure: its largest value over time, and that of the contact nodes over flank and time."""

import numpy as np

from fenics_gears.results.pairs import words_of_slice

from .chart import MESH_CYCLES, TIME, WORDS, Chart, Curve, Field, Second, of_variables
from .panels import DARK, digits, factor
from .run import ShownRun

# Which side of the teeth: how the result's variables of that side begin, and what it is called.
APART_NOTE = " The pressure at edges and kinks does not converge with the mesh."
SIDES = {"": "drive flanks", "coast_": "coast flanks"}
# Edges press several times as much as flanks, which would leave one colour for the flanks. So colours end at this
# multiple of the peak pressure away from edges, within which single nodes scatter.
ABOVE_PEAK = 1.1
# Where that is not known: per cent of the cells that the colours span; times that, from which they end there.
COMMON_SHARE = 98.0
CLIPPED = 1.2
# Relative; cycles that repeat differ by less.
SAME = 1e-6
ROWS = 260
MOST_COLUMNS = 640
# From light to dark in lightness, so that zero lies close to the paper and grey print keeps the order.
COLOURS = ("#FDE9B8", "#F6A04D", "#D9483B", "#8A1A63", "#2A0A4A")
_DEGREES = factor("rad", "deg")


def has_pressure(run: ShownRun) -> bool:
    """Whether the result has contact fields."""
    return {"contact_pressure", "contact_roll_angle"} <= {*run.dataset} and run.dataset.sizes["contact_time"] > 1


def largest_pressures(run: ShownRun) -> list[Chart]:
    """Largest contact pressure at every step, away from edges and kinks and at these."""
    names = {
        "largest_contact_pressure": "away from edges and kinks",
        "largest_edge_pressure": "at edges",
        "largest_kink_pressure": "at kinks of relief",
    }
    for name in ("largest_edge_pressure", "largest_kink_pressure"):
        if name not in run.dataset or not run.dataset[name].any():
            del names[name]
    note = "Averaged over five contact nodes." + (APART_NOTE if len(names) > 1 else "")
    return of_variables(run, "Largest contact pressure", "Pressure", "MPa", names, note=note, height=300)


def pressure_maps(run: ShownRun) -> list[Chart]:
    """Pressure over mesh cycles and the pinion's roll angle, for each side of the teeth that carries."""
    if not has_pressure(run):
        return []
    cells = {side: run.fields(side) for side in SIDES if f"{side}contact_pressure" in run.dataset}
    loaded = [side for side, (pressure, *_) in cells.items() if (pressure > 0.0).any()] or [""]
    return [_map(run, side, *cells[side], named=len(cells) > 1) for side in loaded]


def _map(
    run: ShownRun,
    side: str,
    pressure: np.ndarray,
    place: np.ndarray,
    phase: np.ndarray,
    number: np.ndarray,
    named: bool,
) -> Chart:
    field = pressure_field(pressure, place, phase, colour_limit(run, pressure[pressure > 0.0]))
    highest = float(np.nanmax(field.values, initial=0.0))
    caption = "Contact pressure at each contact node" + (f" on the {SIDES[side]}" if named else "")
    caption += words_of_slice(run.dataset)
    if highest > field.limit * (1 + 1e-9):
        # Of cycles that repeat, the last.
        step = np.flatnonzero(pressure.max(axis=(1, 2)) >= highest * (1.0 - SAME))[-1]
        caption += f". Highest: {highest:.0f} MPa at mesh cycle {phase[step]:.2f}, off the scale"
    curves = []
    second = None
    window = (float(phase[0]), float(phase[-1]))
    if run.pair is not None:
        pair = run.pair
        roll = float(pair.pinion_roll_angle(pair.pitch_point)) * _DEGREES
        curves.append(Curve("pitch point", np.array(window), np.array([roll, roll]), DARK, "dash", 1.0))
        ratio = pair.pinion.base_radius
        length = pair.line_of_action_length * _DEGREES
        radius = pair.wheel.base_radius
        second = Second("Roll angle on the wheel's flank (deg)", -ratio / radius, length / radius)
    heights = (float(field.y[0]), float(field.y[-1]))
    return Chart(
        caption, [*curves, *_names(pressure, place, phase, number, window)], MESH_CYCLES,
        "Roll angle on the pinion's flank (deg)",
        x_range=window, y_range=heights, field=field, second=second, height=480, linked=TIME, note=_peaks(run),
    )  # fmt: skip


def _peaks(run: ShownRun) -> str:
    """The settled run's peak pressures, averaged over several nodes."""
    attributes = run.dataset.attrs
    if "peak_contact_pressure" not in attributes:
        return ""
    peak = digits(attributes["peak_contact_pressure"])
    words = f"The peak contact pressure of the settled run, averaged over five nodes, is {peak} MPa"
    places = {"peak_edge_pressure": "at edges", "peak_kink_pressure": "at kinks of relief"}
    apart = [f"{digits(attributes[name])} MPa {at}" for name, at in places.items() if name in attributes]
    return f"{words} away from edges and kinks, {' and '.join(apart)}." if apart else f"{words}."


def pressure_field(pressure: np.ndarray, place: np.ndarray, phase: np.ndarray, limit: float) -> Field:
    """The largest pressure (MPa) in each cell of a raster over steps and flank, from pressure and roll angle (step,
    pair, node) and the steps' mesh cycles (step,). Nodes reach half-way to their neighbours and to the steps before and
    after. `limit`: where the colours end."""
    low, high = node_edges(place)
    known = (pressure > 0.0) & np.isfinite(low) & np.isfinite(high)
    finite = place[np.isfinite(place)]
    ends = (finite.min() - 0.5, finite.max() + 0.5) if finite.size else (0.0, 1.0)
    rows = np.linspace(*ends, ROWS + 1)
    group = -(-len(phase) // MOST_COLUMNS)
    middle = 0.5 * (phase[1:] + phase[:-1])
    columns = np.append(np.append(phase[0], middle)[::group], phase[-1])
    values = np.full((ROWS, len(columns) - 1), -np.inf)
    first = np.searchsorted(rows, low[known]) - 1
    each, row = counted_on(first, np.maximum(np.searchsorted(rows, high[known]) - 1 - first, 1))
    step = np.nonzero(known)[0][each] // group
    np.maximum.at(values, (np.clip(row, 0, ROWS - 1), step), pressure[known][each])
    values[np.isneginf(values)] = np.nan
    return Field(columns, rows, values, "Contact pressure (MPa)", limit, COLOURS)


def counted_on(first: np.ndarray, count: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of runs of so many numbers (n,) from their `first` (n,) on, one after the other: the run of each, and itself."""
    each = np.repeat(np.arange(len(first)), count)
    return each, first[each] + np.arange(len(each)) - np.repeat(np.cumsum(count) - count, count)


def colour_limit(run: ShownRun, pressures: np.ndarray) -> float:
    """Where the colours of pressures (n,), MPa, end: at the highest, or below it where those at edges are beyond."""
    highest = float(pressures.max(initial=0.0)) or 1.0
    if peak := run.dataset.attrs.get("peak_contact_pressure"):
        return min(highest, ABOVE_PEAK * peak)
    common = float(np.percentile(pressures, COMMON_SHARE)) if pressures.size else highest
    return common if highest > CLIPPED * common else highest


def node_edges(place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper edge of each node's cell, of the shape of ``place``; without a neighbour they mirror each
    other."""
    missing = np.full(place.shape[:-1] + (1,), np.nan)
    half = 0.5 * np.diff(place, axis=-1)
    back = np.concatenate([missing, half], axis=-1)
    forth = np.concatenate([half, missing], axis=-1)
    back, forth = np.where(np.isnan(back), forth, back), np.where(np.isnan(forth), back, forth)
    edges = np.stack([place - back, place + forth])
    return edges.min(axis=0), edges.max(axis=0)


def _names(
    pressure: np.ndarray, place: np.ndarray, phase: np.ndarray, number: np.ndarray, window: tuple[float, float]
) -> list[Curve]:
    """The number of each pair above its band's end, where the band is long enough to leave it room."""
    top = np.where(pressure > 0.0, place, -np.inf).max(axis=2)
    words = []
    x = []
    y = []
    for pair in np.unique(number[np.isfinite(top)]):
        steps, rows = np.nonzero((number == pair) & np.isfinite(top))
        middle = 0.5 * (phase[steps[0]] + phase[steps[-1]])
        if phase[steps[-1]] - phase[steps[0]] >= 0.2 * (window[1] - window[0]):
            nearest = int(np.argmin(np.abs(phase[steps] - middle)))
            words.append(f"pair {pair}")
            x.append(phase[steps[nearest]])
            y.append(top[steps[nearest], rows[nearest]])
    if not words:
        return []
    return [Curve("pairs", np.array(x), np.array(y), DARK, mode=WORDS, listed=False, words=words, beside="top left")]
