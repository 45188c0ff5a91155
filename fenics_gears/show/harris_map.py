"""Harris map: the transmission error over two mesh cycles, a curve for each load.

After S. L. Harris, Dynamic loads on the teeth of spur gears, Proc. IMechE 172 (1958).
"""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from fenics_gears.errors import ComputationError

from .chart import WORDS, Chart, Curve
from .motion import LEAST_LENGTH
from .panels import DARK, digits, factor, in_unit, shades

CYCLES = 2.0
MOST_NAMED = 20
# Room for the loads' words right of the curves, in mesh cycles, and the least distance of two of them, in parts of the
# chart's height.
ROOM = 0.245
APART = 0.042


def harris_map(result: xr.Dataset | xr.DataArray, caption: str = "") -> Chart:
    """The chart of a transmission error with the dimensions `load` (a torque, or a power in kW) and `mesh_phase` (mesh
    cycles), in um along the line of action.

    result: a variable in a unit of length; or a dataset with `transmission_error` in a unit of length, or in rad of the
    wheel with the attribute `base_radius_wheel` (mm). The coordinate `load` has units. Curves of one mesh cycle are
    drawn twice; of more than two the first two; a load without a result (not a number) has no curve. Raises
    ComputationError for a result without these dimensions and units.
    """
    error = result["transmission_error"] if isinstance(result, xr.Dataset) else result
    if not {"load", "mesh_phase"} <= set(error.coords) or set(error.dims) != {"load", "mesh_phase"}:
        raise ComputationError(
            "a Harris map needs the dimensions load and mesh_phase with their coordinates; there are"
            f" {', '.join(map(str, error.dims)) or 'none'}"
        )
    error = error.transpose("load", "mesh_phase").sortby("load").dropna("load", how="all")
    values = _micrometres(error, result.attrs)
    unit = "kW" if error["load"].attrs.get("units") == "kW" else "N m"
    loads = in_unit(error["load"], unit)
    phase = error["mesh_phase"].values
    curves = [
        Curve(f"{digits(load)} {unit}", *_two_cycles(phase, each), colour, listed=False)
        for load, each, colour in zip(loads, values, shades(len(loads)))
    ]
    drawn = [*curves, *_names(curves)]
    y_title = "Transmission error along the line of action (µm)"
    options = {"height": 520, "least": LEAST_LENGTH, "x_range": (0.0, CYCLES + ROOM)}
    return Chart(caption, drawn, "Mesh phase (mesh cycles)", y_title, **options)


def _micrometres(error: xr.DataArray, attributes: dict) -> np.ndarray:
    """Values (load, mesh_phase) in um on the wheel's base circle, which are those along the line of action."""
    try:
        return in_unit(error, "µm")
    except ComputationError:
        if "base_radius_wheel" not in attributes:
            raise
    return in_unit(error, "rad") * float(attributes["base_radius_wheel"]) * factor("mm", "µm")


def _two_cycles(phase: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Phase (n,) from 0 on and values (n,) of two mesh cycles."""
    phase = phase - np.floor(phase[0] + 1e-9)
    if 1.0 - 1e-9 < phase[-1] - phase[0] < CYCLES - 1e-9:
        again = phase > phase[-1] - 1.0 + 1e-9
        phase = np.concatenate([phase, phase[again] + 1.0])
        values = np.concatenate([values, values[again]])
    seen = phase <= CYCLES + 1e-9
    return phase[seen], values[seen]


def _names(curves: list[Curve]) -> list[Curve]:
    if not curves:
        return []
    every = np.concatenate([curve.y for curve in curves])
    count = len(curves)
    named = np.unique(np.linspace(0, count - 1, min(count, MOST_NAMED)).round().astype(int))
    ends = [(CYCLES, float(curves[place].y[-1]), curves[place].name) for place in named]
    return [words_apart(ends, APART * (np.ptp(every[np.isfinite(every)]) or 1.0), "right")]


def words_apart(ends: Sequence[tuple[float, float, str]], apart: float, beside: str) -> Curve:
    """Words next to places of a chart; words that would overlap are moved up until they are apart."""
    ends = sorted(ends, key=lambda end: end[1])
    heights = np.array([height for _, height, _ in ends])
    for place in range(1, len(heights)):
        heights[place] = max(heights[place], heights[place - 1] + apart)
    x = np.array([x for x, *_ in ends])
    words = [words for *_, words in ends]
    return Curve("words", x, heights, DARK, mode=WORDS, listed=False, words=words, beside=beside)
