"""The measures by which two runs of a scene are compared, as arrays of the same shape in all runs, and their relative distance.

The `energy defect` is an error in itself, given in parts of the drive's work.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

CURVE, SPAN, STIFFNESS, PRESSURE, PEAK = "T_E", "T_EPP", "mesh stiffness", "pressure", "peak pressure"
ROOT, DEFECT = "root stress", "energy defect"
MEASURES = (CURVE, SPAN, STIFFNESS, PRESSURE, PEAK, ROOT, DEFECT)
# Settings are judged by both of these: a curve may have the right height and the wrong shape.
JUDGED = (CURVE, SPAN)
CURVE_POINTS, PRESSURE_PHASES, PRESSURE_POINTS = 640, 20, 401
PAIRS_BACK, PAIRS = 6, 9

Answer = dict[str, np.ndarray]


def answer(run: xr.Dataset, window: float, root_stress: float | None = None) -> Answer:
    """All measures of a run; `window` (mm): length over which pressures are compared.

    root_stress: MPa, peak at a material point (`root_point`), which is not in a result; None where it is not known.
    """
    found = {**judged_answer(run), DEFECT: np.array([_defect(run)])}
    if "energy_teeth" in run:
        found[STIFFNESS] = np.array([stiffness_by_energy(run)])
    if "contact_pressure" in run:
        found[PRESSURE] = _pressure(run, window)
        found[PEAK] = np.array([run.attrs["peak_contact_pressure"]])
    if root_stress is not None:
        found[ROOT] = np.array([root_stress])
    return found


def judged_answer(run: xr.Dataset, every: int = 1) -> Answer:
    """The two measures that settings are judged by; `every`: take every n-th step only, as in a quasi-static run of longer steps.

    T_EPP is the same then: its extremes are located between steps.
    """
    height = run.attrs["peak_to_peak_transmission_error"] * run.attrs["base_radius_wheel"]
    return {CURVE: _curve(run, every), SPAN: np.array([height])}


def stiffness_by_energy(run: xr.Dataset) -> float:
    """Mean over the last mesh cycle (N/mm) of the spring that holds the teeth's energy U under the mesh's force F: F^2 / (2 U)."""
    force, energy = (run[name].values[_last_cycle(run)] for name in ("normal_force", "energy_teeth"))
    loaded = energy > 0.0
    return float(np.mean(force[loaded] ** 2 / (2.0 * energy[loaded]))) if loaded.any() else np.nan


def distance(one: Answer, other: Answer, name: str) -> float:
    """Relative distance in L2 of a measure from `other`, by which it is divided; NaN where either run has none."""
    if name == DEFECT:
        return float(abs(one[name][0]))
    if name not in one or name not in other:
        return np.nan
    scale = float(np.linalg.norm(other[name]))
    away = float(np.linalg.norm(one[name] - other[name]))
    return away / scale if scale else np.nan if away else 0.0


def distances(one: Answer, other: Answer) -> dict[str, float]:
    """The distances of all measures."""
    return {name: distance(one, other, name) for name in MEASURES}


def judged(errors: dict[str, float]) -> float:
    """The one number by which settings are compared."""
    return max(errors[name] for name in JUDGED)


def _last_cycle(run: xr.Dataset) -> np.ndarray:
    phase = run["mesh_phase"].values
    return phase > phase[-1] - 1.0 + 1e-9


def _curve(run: xr.Dataset, every: int) -> np.ndarray:
    """Transmission error (640,), mm at the wheel's base circle, over the last mesh cycle, straight between steps, its mean removed."""
    phase = run["mesh_phase"].values[::every]
    wanted = phase[-1] - 1.0 + np.arange(1, CURVE_POINTS + 1) / CURVE_POINTS
    curve = np.interp(wanted, phase, run["transmission_error"].values[::every]) * run.attrs["base_radius_wheel"]
    return curve - curve.mean()


def _pressure(run: xr.Dataset, window: float) -> np.ndarray:
    """Pressure (phases, pairs, points), MPa, at common phases and offsets; zero beyond a run's contact nodes.

    Phases are those of the nearest steps: pressures between two steps are no average of both, for they move.
    """
    phase, numbers = run["contact_mesh_phase"].values, run["contact_pair_number"]
    last, first = phase[-1], numbers.attrs["number_at_phase_0"]
    offsets = np.linspace(-0.5 * window, 0.5 * window, PRESSURE_POINTS)
    field = np.zeros((PRESSURE_PHASES, PAIRS, PRESSURE_POINTS))
    pressure, places = (run[name].values for name in ("contact_pressure", "contact_offset"))
    for i in range(PRESSURE_PHASES):
        step = int(np.argmin(np.abs(phase - (last - 1.0 + (i + 1) / PRESSURE_PHASES))))
        for j, number in enumerate(numbers.values[step]):
            row, there = int(number) - first - round(last) + PAIRS_BACK, np.isfinite(places[step, j])
            if 0 <= row < PAIRS and there.any():
                field[i, row] = np.interp(offsets, places[step, j][there], pressure[step, j][there], left=0.0, right=0.0)
    return field.ravel()


def _defect(run: xr.Dataset) -> float:
    work = float(np.abs(run["work_input"].values).max(initial=0.0))
    return float(np.abs(run["energy_defect"].values).max(initial=0.0)) / work if work else 0.0
