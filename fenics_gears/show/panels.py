"""What all pictures share: palette, fonts, ends and ticks of axes, long curves with fewer points; numbers and units as
people read them."""

import functools
from collections.abc import Callable, Sequence

import matplotlib
import matplotlib.style  # `rcdefaults` needs it
import numpy as np
import xarray as xr
from matplotlib.ticker import LogLocator, MaxNLocator

from fenics_gears.errors import ComputationError
from fenics_gears.inputs.units import QuantityError, quantity

# Okabe and Ito's palette without its yellow, which is too pale for a line: told apart with any colour vision.
PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00")
DARK = "#222222"
GREY = "#8C8C8C"
GRID = "#E3E3E3"
WARNING = "#B00020"
# From low to high, in order of lightness (viridis).
LOW_TO_HIGH = ("#440154", "#414487", "#2A788E", "#22A884", "#7AD151", "#FDE725")
DOTS_PER_INCH = 150

_STYLE = {
    "font.size": 12.0,
    "axes.titlesize": 12.5,
    "axes.titlelocation": "left",
    "axes.titlepad": 8.0,
    "axes.edgecolor": DARK,
    "axes.spines.top": False,
    "axes.formatter.useoffset": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": GRID,
    "grid.linewidth": 0.8,
    "lines.linewidth": 1.8,
    "legend.frameon": False,
    "legend.fontsize": 11.5,
    "figure.dpi": DOTS_PER_INCH,
}


def styled(draw: Callable) -> Callable:
    """Run a drawing function in the style of these pictures, whatever the settings of the user's matplotlib are."""

    @functools.wraps(draw)
    def inside(*arguments, **options):
        with matplotlib.rc_context():
            matplotlib.rcdefaults()
            matplotlib.rcParams.update(_STYLE)
            return draw(*arguments, **options)

    return inside


def shades(count: int) -> list[str]:
    """Colours of curves in an order, the last one darkest; without the palest, which are no colours of a line."""
    ends = np.array([[int(colour[place : place + 2], 16) for place in (1, 3, 5)] for colour in LOW_TO_HIGH])
    places = np.linspace(0.87 * (len(ends) - 1), 0.0, count) if count > 1 else np.zeros(count)
    return [
        "#" + "".join(f"{round(np.interp(place, range(len(ends)), part)):02X}" for part in ends.T) for place in places
    ]


def limits(values: np.ndarray, least: float) -> tuple[float, float]:
    """Ends of an axis around the finite values, not closer than ``least``."""
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
    half = 0.5 * max(1.12 * (high - low), least)
    return 0.5 * (low + high) - half, 0.5 * (low + high) + half


def legend(axes, columns: int, location: str = "lower right", **options) -> None:
    """Legend above the panel, where no curve can be."""
    anchor = (1.0 if location.endswith("right") else 0.0, 1.0)
    options |= {"bbox_to_anchor": anchor, "borderaxespad": 0.1, "handlelength": 1.6, "columnspacing": 1.4}
    axes.legend(loc=location, ncol=columns, **options)


def framed(axes) -> None:
    """A panel without a grid, in a pale frame."""
    axes.grid(False)
    for spine in axes.spines.values():
        spine.set_visible(True)
        spine.set_color("#BBBBBB")


def ticks(ends: Sequence[float], most: float, logarithmic: bool = False) -> np.ndarray:
    """Round numbers (n,) between an axis' ends."""
    low, high = sorted(ends)
    if logarithmic:
        locator = LogLocator(subs=(1.0,) if high > 100.0 * low else (1.0, 2.0, 5.0))
        beyond = 0.0
    else:
        locator = MaxNLocator(max(2, min(10, int(most))), steps=[1, 2, 2.5, 5, 10])
        beyond = 1e-9 * (high - low)
    places = locator.tick_values(low, high)
    return places[(places >= low - beyond) & (places <= high + beyond)]


def tick_labels(places: np.ndarray, logarithmic: bool = False) -> list[str]:
    """Numbers with as many decimals as the finest of them needs; with powers of ten where they are large or small."""
    step = places[1] - places[0] if len(places) > 1 else 0.0
    told = (count for count in range(12) if np.abs(np.round(places, count) - places).max() < 1e-3 * step)
    if logarithmic or not 1e-4 <= np.abs(places).max(initial=0.0) < 1e6 or (decimals := next(told, None)) is None:
        words = [f"{place:g}" for place in places]
    else:
        words = [f"{place:.{decimals}f}" for place in np.round(places, decimals) + 0.0]
    return [each.replace("-", "−") for each in words]


# As many as a screen tells apart, and few enough to keep some twenty curves of a page below 10 MB.
MOST_POINTS = 2000


def thinned(values: np.ndarray, most: int = MOST_POINTS) -> np.ndarray:
    """Indices (k,) of the values (n,) that a curve is drawn through: all of them up to `most`. Of longer curves they
    are both ends and, of each of most/2 slices, the smallest and the largest value, and one that is not a number where
    there is any."""
    count = len(values)
    if count <= most:
        return np.arange(count)
    width = -(-count // (most // 2))
    padded = np.concatenate([values, np.full(-count % width, values[-1])]).reshape(-1, width)
    missing = np.isnan(padded)
    lowest = np.where(missing, np.inf, padded).argmin(axis=1)
    highest = np.where(missing, -np.inf, padded).argmax(axis=1)
    first = width * np.arange(len(padded))
    gaps = (first + missing.argmax(axis=1))[missing.any(axis=1)]
    places = np.concatenate([first + lowest, first + highest, gaps, [0, count - 1]])
    return np.unique(np.minimum(places, count - 1))


def factor(unit: str, wanted: str) -> float:
    """What a number in ``unit`` is multiplied with to be one in ``wanted`` ("rad", "µrad").

    Raises ComputationError where they measure different things or one is unknown.
    """
    try:
        size, kind = quantity(f"1 {unit}")
        wanted_size, wanted_kind = quantity(f"1 {wanted}")
    except QuantityError as error:
        raise ComputationError(f"a unit of the result {error}") from error
    if kind != wanted_kind:
        raise ComputationError(f'a variable in "{unit}" ({kind}) cannot be shown in "{wanted}" ({wanted_kind})')
    return size / wanted_size


def in_unit(variable: xr.DataArray, wanted: str) -> np.ndarray:
    """The values of a variable, any shape, in the unit ``wanted``; its own unit is its attribute ``units``.

    Raises ComputationError where it has no unit, or one that does not fit.
    """
    if "units" not in variable.attrs:
        raise ComputationError(f"{variable.name}: the result does not say its units")
    try:
        return variable.values * factor(variable.attrs["units"], wanted)
    except ComputationError as error:
        raise ComputationError(f"{variable.name}: {error}") from error


def digits(value: float) -> str:
    """Four digits; three and a power of ten where a tile is too narrow for the number."""
    if abs(value) >= 1e6:
        mantissa, _, exponent = f"{value:.2e}".partition("e")
        return f"{mantissa}e{int(exponent)}"
    return f"{value:,.0f}" if abs(value) >= 1e4 else f"{value:.4g}"
