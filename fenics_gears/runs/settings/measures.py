"""The measures by which two runs of a scene are compared, and their relative distance.

All are arrays of the same shape in all runs but the curve of T_E, which has a value for each step of the last mesh
cycle. Curves of different steps are compared at phases that both have. Straight lines between steps would add an error
of their own at the kinks where tooth pairs enter or leave contact. T_EPP is located between steps (`results.extrema`).
The `energy defect` is an error in itself, in parts of the drive's work.
"""

from collections.abc import Container, Sequence
from math import gcd

import numpy as np
import xarray as xr

from fenics_gears.results.load_factors import mean_line_load
from fenics_gears.results.pairs import carrying_side, in_middle_slice

CURVE = "T_E"
SPAN = "T_EPP"
STIFFNESS = "mesh stiffness"
PRESSURE = "pressure"
PEAK = "peak pressure"
ROOT = "root stress"
DEFECT = "energy defect"
MEASURES = (CURVE, SPAN, STIFFNESS, PRESSURE, PEAK, ROOT, DEFECT)
# Of flanks resolved over the face: the line load averaged over the mesh cycle, and two load factors.
LINE_LOAD = "line load"
FACE_LOAD = "face load factor"
LARGEST_LOAD = "largest line load"
OVER_FACE = (LINE_LOAD, FACE_LOAD, LARGEST_LOAD)
# And the mean transmission error, by which nothing is judged: modifications shift it, and may leave nothing of it. At a
# whole overlap the curve is nearly flat. Where its height is below this part of the mean, errors of curve and height
# count in parts of a sine of that height.
MEAN = "mean T_E"
LEAST_SPAN = 0.1
# Settings are judged by both of these: a curve may have the right height and the wrong shape. Over the face they are
# judged by its measures too.
JUDGED = (CURVE, SPAN)
# Places at which line loads are compared, and the part of the face that these take: further out line loads are of
# edges.
PLACES = 41
PART_OF_FACE = 0.8
# Curves are compared at the phases that all of them have, unless these are fewer.
FEWEST_PHASES = 20
PRESSURE_PHASES = 20
PRESSURE_POINTS = 401
PAIRS_BACK = 6
PAIRS = 9

Answer = dict[str, np.ndarray]


def answer(run: xr.Dataset, window: float, root_stress: float | None = None) -> Answer:
    """All measures of a run. `window` (mm): length over which pressures are compared. `root_stress`: MPa, peak at a
    material point (`simulation.root_point`), which is not in a result; None where it is not known."""
    measures = {**judged_answer(run), DEFECT: np.array([_defect(run)])}
    if "energy_teeth" in run:
        measures[STIFFNESS] = np.array([stiffness_by_energy(run)])
    if "contact_pressure" in run:
        measures[PRESSURE] = _pressure(run, window)
        measures[PEAK] = np.array([run.attrs["peak_contact_pressure"]])
    if root_stress is not None:
        measures[ROOT] = np.array([root_stress])
    return measures


def judged_answer(run: xr.Dataset) -> Answer:
    """The measures that settings are judged by: a curve (n,) and T_EPP, mm at the wheel's base circle. The curve is T_E
    less its mean at the steps of the last mesh cycle, of which the last has phase 1."""
    curve = run["transmission_error"].values[_last_cycle(run)]
    height = run.attrs["peak_to_peak_transmission_error"]
    radius = run.attrs["base_radius_wheel"]
    measures = {CURVE: (curve - curve.mean()) * radius, SPAN: np.array([height * radius])}
    return measures | _over_face(run) if "face_position" in run.dims else measures


def _over_face(run: xr.Dataset) -> Answer:
    """Mean T_E, mm; line load, N/mm, of all tooth pairs together, averaged over the mesh cycle, at places along the
    face; and the load factors."""
    names = {FACE_LOAD: "face_load_factor", LARGEST_LOAD: "largest_line_load_factor"}
    measures = {measure: np.array([run.attrs[name]]) for measure, name in names.items() if name in run.attrs}
    measures[MEAN] = np.array([run.attrs["mean_transmission_error"] * run.attrs["base_radius_wheel"]])
    load = mean_line_load(run, carrying_side(run)) if run.sizes.get("contact_time") else None
    if load is not None:
        places = np.linspace(-0.5, 0.5, PLACES) * PART_OF_FACE * run["face_slice_width"].values.sum()
        measures[LINE_LOAD] = np.interp(places, run["face_position"].values, load)
    return measures


def comparable(values: Sequence[np.ndarray], name: str) -> list[np.ndarray]:
    """The same measure of several runs as arrays of one shape: curves at their common phases, their means over these
    removed.

    Curves (n_i,) are compared at their common phases k/n, with n the greatest common divisor of all n_i. Where n is
    below FEWEST_PHASES, all are taken at the phases of the one with fewest steps, straight between the steps of the
    others.
    """
    counts = [len(value) for value in values]
    if name != CURVE or len(set(counts)) == 1:
        return list(values)
    common = gcd(*counts)
    if common < FEWEST_PHASES:
        common = min(counts)
    phases = np.arange(1, common + 1) / common
    curves = [
        value[count // common - 1 :: count // common]
        if count % common == 0
        else np.interp(phases, np.arange(1, count + 1) / count, value)
        for value, count in zip(values, counts)
    ]
    return [value - value.mean() for value in curves]


def stiffness_by_energy(run: xr.Dataset) -> float:
    """Mean over the last mesh cycle (N/mm) of the spring that holds the teeth's energy U under the mesh's force F: F^2
    / (2 U)."""
    force, energy = (run[name].values[_last_cycle(run)] for name in ("normal_force", "energy_teeth"))
    loaded = energy > 0.0
    return float(np.mean(force[loaded] ** 2 / (2.0 * energy[loaded]))) if loaded.any() else np.nan


def distance(one: Answer, other: Answer, name: str) -> float:
    """Relative distance in L2 of a measure from `other`, by which it is divided; NaN where either run has none."""
    if name == DEFECT:
        return float(abs(one[name][0]))
    if name not in one or name not in other:
        return np.nan
    value, reference = comparable((one[name], other[name]), name)
    scale = max(float(np.linalg.norm(reference)), _least_scale(other, name, len(reference)))
    away = float(np.linalg.norm(value - reference))
    return away / scale if scale else np.nan if away else 0.0


def _least_scale(reference: Answer, name: str, count: int) -> float:
    """Of the curve (`count` values) and its span over the face, else 0."""
    if MEAN not in reference or name not in JUDGED:
        return 0.0
    span = LEAST_SPAN * abs(float(reference[MEAN][0]))
    return span if name == SPAN else span * (count / 8.0) ** 0.5


def distances(one: Answer, other: Answer) -> dict[str, float]:
    """The relative distance of one answer from the other, by measure."""
    return {name: distance(one, other, name) for name in measures_of(other)}


def measures_of(names: Container[str]) -> tuple[str, ...]:
    """All measures of a plane run, and those over the face that are among some names."""
    return MEASURES + tuple(name for name in (MEAN, *OVER_FACE) if name in names)


def judged(errors: dict[str, float]) -> float:
    """The one number by which settings are compared; a plane model of a face is not charged for what it lacks."""
    over_face = [errors[name] for name in OVER_FACE if not np.isnan(errors.get(name, np.nan))]
    return max([errors[name] for name in JUDGED] + over_face)


def _last_cycle(run: xr.Dataset) -> np.ndarray:
    phase = run["mesh_phase"].values
    return phase > phase[-1] - 1.0 + 1e-9


def _pressure(run: xr.Dataset, window: float) -> np.ndarray:
    """Pressure (phases, pairs, points), MPa, in the middle of the face at common offsets and common phases, taken from
    the nearest steps; zero beyond a run's contact nodes."""
    run = in_middle_slice(run)
    phase = run["contact_mesh_phase"].values
    numbers = run["contact_pair_number"]
    last = phase[-1]
    first = numbers.attrs["number_at_phase_0"]
    offsets = np.linspace(-0.5 * window, 0.5 * window, PRESSURE_POINTS)
    field = np.zeros((PRESSURE_PHASES, PAIRS, PRESSURE_POINTS))
    pressure, places = (run[name].values for name in ("contact_pressure", "contact_offset"))
    for i in range(PRESSURE_PHASES):
        step = int(np.argmin(np.abs(phase - (last - 1.0 + (i + 1) / PRESSURE_PHASES))))
        for j, number in enumerate(numbers.values[step]):
            row = int(number) - first - round(last) + PAIRS_BACK
            there = np.isfinite(places[step, j])
            if 0 <= row < PAIRS and there.any():
                field[i, row] = np.interp(
                    offsets, places[step, j][there], pressure[step, j][there], left=0.0, right=0.0
                )
    return field.ravel()


def _defect(run: xr.Dataset) -> float:
    work = float(np.abs(run["work_input"].values).max(initial=0.0))
    return float(np.abs(run["energy_defect"].values).max(initial=0.0)) / work if work else 0.0
