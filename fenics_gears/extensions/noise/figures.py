"""Noise figures of a run: levels of mesh orders, sideband energy, and the orders followed over a speed ramp.

Levels are of amplitudes (peak, not r.m.s.): of the transmission error re 1 um along the line of action, of the mesh
force re 1 N. Steps are at equal phases of the mesh also where the speed changes, so that a spectrum over steps is one
over orders without resampling.
"""

import numpy as np
import xarray as xr

from fenics_gears import MICROMETRE, ComputationError, carried_scene, of_settled, spectrum
from fenics_gears.scene_text import GEARS

from .sidebands import sidebands

SIGNALS = {
    "transmission_error": ("um", "transmission error along the line of action"),
    "mesh_force": ("N", "mesh force"),
}
HARMONICS = np.arange(1, 11)


def noise_figures(result: xr.Dataset, window: str | None = None) -> xr.Dataset:
    """Amplitudes and levels of transmission error and mesh force, by `order` (mesh orders) of the settled cycles, or by
    `mesh_frequency` and `order` of a ramp.

    `..._sideband_energy` over `harmonic` and `gear`: sum of squares of the sidebands of a mesh harmonic at whole turns
    of a gear. `..._sideband_ratio`: the sum over the sidebands of both gears, each once, over the square of the
    harmonic; NaN where that is round-off. Both are NaN where the record cannot tell them apart. window: one of
    `spectrum.WINDOWS`; None: none, over whole hunting tooth periods or else whole mesh cycles, and the flat top for a
    ramp. Raises ComputationError for a record too short to have mesh orders apart.
    """
    gears = carried_scene(result).gears
    ramp = "mesh_frequency" in result
    run = result if ramp else of_settled(result)
    cycles = float(np.ptp(run["mesh_phase"].values)) if run.sizes["time"] > 1 else 0.0
    used = window or (spectrum.FLAT_TOP if ramp else spectrum.NO_WINDOW)
    needed = window_cycles(used) if ramp or used != spectrum.NO_WINDOW else 1
    if cycles < needed - 1e-9:
        raise ComputationError(
            f'{cycles:.3g} settled mesh cycles are stored; a spectrum in the window "{used}" needs {needed}. Run more'
            " of them, or take another window."
        )
    over = f", over {needed} mesh cycles at a time" if ramp else ""
    figures = xr.Dataset(attrs={"window": f"{used}{over}", "references": "amplitudes of 1 um and of 1 N"})
    for name, values in signals(run).items():
        if ramp:
            figures = figures.assign(_followed(name, values, run, used)).set_coords("mesh_frequency")
        else:
            figures = figures.assign(_steady(name, values, cycles, gears.teeth, window))
    return figures


def signals(run: xr.Dataset) -> dict[str, np.ndarray]:
    """Transmission error (time,), um, and the mesh force (time,), N, where it varies."""
    error = run["transmission_error"].values * run.attrs["base_radius_wheel"] / MICROMETRE
    force = spectrum.varying_mesh_force(run)
    return {"transmission_error": error} | ({} if force is None else {"mesh_force": force})


def window_cycles(window: str) -> int:
    """Fewest mesh cycles whose spectrum in a window has neighbouring mesh orders apart."""
    return 2 * len(spectrum.WINDOWS[window])


def _labels(units: str, name: str) -> dict[str, str]:
    return {"units": units, "long_name": name}


def _levels(name: str, dimensions: tuple[str, ...], amplitudes: np.ndarray) -> dict[str, tuple]:
    unit, words = SIGNALS[name]
    words = f"amplitude of the {words}"
    levels = spectrum.level(amplitudes)
    return {
        f"{name}_amplitude": (dimensions, amplitudes, _labels(unit, words)),
        f"{name}_level": (dimensions, levels, _labels(f"dB re 1 {unit}", f"level of the {words}")),
    }


def _steady(
    name: str, values: np.ndarray, cycles: float, teeth: tuple[int, int], window: str | None
) -> dict[str, tuple]:
    lines = spectrum.order_lines(values, cycles, teeth, window)
    known = True
    if lines is None or not lines.exact and window is None:
        # Whole mesh cycles have exact mesh orders, though nothing that turns with a gear.
        lines = spectrum.order_lines(values, cycles, (1, 1), window)
        known = False
    orders = lines.orders / (teeth[0] if known else 1)
    figures = {"order": (("order",), orders, _labels("1", "mesh order")), **_levels(name, ("order",), lines.amplitudes)}
    return figures | (_beside(name, lines, teeth) if known else {})


def _beside(name: str, lines: spectrum.OrderLines, teeth: tuple[int, int]) -> dict[str, tuple]:
    each = [sidebands(lines, teeth, int(harmonic)) for harmonic in HARMONICS]
    energy = np.array([[np.nan, np.nan] if one is None else [one.pinion, one.wheel] for one in each])
    ratio = np.array([np.nan if one is None else one.ratio for one in each])
    of_energy = _labels(f"{SIGNALS[name][0]}^2", "sum of squares of the sidebands' amplitudes")
    of_ratio = _labels("1", "sidebands' sum of squares over the square of the mesh order's amplitude")
    return {
        "harmonic": (("harmonic",), HARMONICS, _labels("1", "multiple of the mesh frequency")),
        "gear": (("gear",), np.array(GEARS, dtype=object), {"long_name": "gear"}),
        f"{name}_sideband_energy": (("harmonic", "gear"), energy, of_energy),
        f"{name}_sideband_ratio": (("harmonic",), ratio, of_ratio),
    }


def _followed(name: str, values: np.ndarray, run: xr.Dataset, window: str) -> dict[str, tuple]:
    """Mesh orders in overlapping parts of the record, one from each half of a window's length to the next."""
    phase = run["mesh_phase"].values
    length = window_cycles(window)
    steps = round(1.0 / (phase[1] - phase[0]))
    starts = np.arange(0, len(values) - length * steps, length * steps // 2)
    records = [slice(start, start + length * steps + 1) for start in starts]
    parts = [spectrum.order_lines(values[record], length, (1, 1), window) for record in records]
    orders = HARMONICS[HARMONICS <= parts[0].orders[-1]]
    speed = np.array([run["mesh_frequency"].values[record].mean() for record in records])
    return {
        "order": (("order",), orders, _labels("1", "mesh order")),
        "mesh_frequency": (("part",), speed, _labels("Hz", "mean mesh frequency of a part of the record")),
        **_levels(name, ("part", "order"), np.array([[part.at(order) for order in orders] for part in parts])),
    }
