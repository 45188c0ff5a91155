"""The dataset of a map over loads and speeds, from the cases of its studies."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import xarray as xr

import fenics_gears
from fenics_gears import results
from fenics_gears.dynamics.frequencies import Vibration, vibrations
from fenics_gears.errors import ComputationError
from fenics_gears.geometry.pair import GearPair
from fenics_gears.inputs.units import quantity
from fenics_gears.model.drivetrain import mesh_stiffness
from fenics_gears.model.model import model_of
from fenics_gears.results.key_numbers import HARMONIC_NAMES, MICROMETRE
from fenics_gears.results.settled import of_settled
from fenics_gears.results.spectrum import NO_WINDOW, order_lines
from fenics_gears.scene.data import Load, Scene
from fenics_gears.studies.combine import load_combined
from fenics_gears.studies.load_map import LoadMap
from fenics_gears.studies.run_study import Outcome

# Half mesh orders tell a motion that repeats only after two mesh cycles.
ORDERS = np.arange(1, 21) / 2.0
HARMONIC, MODE = "harmonic", "mode"
# What the study over loads has, in its own units.
TAKEN = ("mean_mesh_stiffness", "mean_mesh_stiffness_tangent", "peak_contact_pressure", "largest_pair_force", "mesh_efficiency")
Columns = dict[str, tuple[tuple[str, ...], np.ndarray, dict[str, str]]]


def map_dataset(wanted: LoadMap, at_rest: Outcome, over_speed: Outcome | None) -> xr.Dataset:
    """Everything of a map over `load` (N m); with speeds also over `mesh_frequency` (Hz).

    Transmission errors are in um along the line of action. A case without a result has not a number.
    """
    scene, pair = wanted.scene, model_of(wanted.scene).pair
    loads = np.array([quantity(each)[0] * 1e-3 for each in wanted.loads])
    found = xr.Dataset(coords={"load": ("load", loads, _labels("N m", "torque on the wheel"))})
    found = found.assign(_over_loads(load_combined(at_rest.file), pair))
    if scene.inertia is not None:
        found = found.assign(_natural_frequencies(scene, loads, found.get("mean_mesh_stiffness_tangent"), pair))
    if over_speed is not None:
        found = found.assign(_over_speeds(over_speed, pair, len(loads))).set_coords("pinion_speed")
    said = {"title": scene.title, "scene": scene.text, "fenics_gears_version": fenics_gears.__version__, "base_radius_wheel": pair.wheel.base_radius}
    return found.assign_attrs(said)


def _labels(units: str, name: str) -> dict[str, str]:
    return {"units": units, "long_name": name}


def _over_loads(study: xr.Dataset, pair: GearPair) -> Columns:
    """Curves and numbers of the quasi-static study."""
    length = pair.wheel.base_radius / MICROMETRE
    found: Columns = {}
    if "mesh_phase" in study:
        found["mesh_phase"] = (("mesh_phase",), study["mesh_phase"].values, _labels("1", "mesh cycles"))
        found["transmission_error"] = (("load", "mesh_phase"), study["transmission_error"].values * length, _labels("um", "transmission error along the line of action"))
        if "mesh_stiffness" in study:
            found["mesh_stiffness"] = (("load", "mesh_phase"), study["mesh_stiffness"].values, dict(study["mesh_stiffness"].attrs))
    for name in ("peak_to_peak_transmission_error", "mean_transmission_error"):
        found[name] = (("load",), study[name].values * length, _labels("um", f"{study[name].attrs['long_name']}, along the line of action"))
    for name in TAKEN:
        if name in study:
            found[name] = (("load",), study[name].values, dict(study[name].attrs))
    harmonics = [name for name in HARMONIC_NAMES if name in study]
    if harmonics:
        found[HARMONIC] = ((HARMONIC,), np.arange(1, len(harmonics) + 1), _labels("1", "multiple of the mesh frequency"))
        amplitudes = np.stack([study[name].values for name in harmonics], axis=-1)
        found["transmission_error_harmonic"] = (("load", HARMONIC), amplitudes, _labels("um", "amplitude of the transmission error along the line of action"))
    return found


def _natural_frequencies(scene: Scene, loads: np.ndarray, tangents: xr.DataArray | None, pair: GearPair) -> Columns:
    """Natural frequencies of the drivetrain (load, mode), the mesh being a spring of its mean tangent stiffness at the load."""
    every = []
    for place, torque in enumerate(loads):
        rough = mesh_stiffness(scene)
        stiffness = rough if tangents is None else float(tangents.values[place]) * pair.face_width / MICROMETRE
        drivetrain = model_of(replace(scene, load=Load(1e3 * torque))).drivetrain
        every.append(vibrations(drivetrain, stiffness, scene.friction is not None) if np.isfinite(stiffness) or stiffness == rough else None)
    modes = next((each for each in every if each), [])
    nothing = [Vibration(np.nan, np.nan, False)] * len(modes)
    values = np.array([[(mode.frequency, mode.damping_ratio) for mode in each or nothing] for each in every]).reshape(len(loads), len(modes), 2)
    note = _labels("Hz", "natural frequency with the mean tangent mesh stiffness")
    return {
        MODE: ((MODE,), np.arange(1, len(modes) + 1), _labels("1", "number of the mode")),
        "natural_frequency": (("load", MODE), values[..., 0], note),
        "damping_ratio": (("load", MODE), values[..., 1], _labels("1", "part of the critical damping of the mode")),
        "excited": ((MODE,), np.array([int(mode.excited) for mode in modes], dtype=int), _labels("1", "1 where contact forces excite the mode")),
        "motion": ((MODE,), np.array([mode.motion for mode in modes], dtype=object), {"long_name": "what moves, where a gear tilts or moves along its axis"}),
    }


def _over_speeds(outcome: Outcome, pair: GearPair, loads: int) -> Columns:
    """Numbers and spectra of the steady runs; the last axis of the study is the speed."""
    cases = outcome.study.cases
    frequencies = np.array([case.scene.motion.mesh_frequency for case in cases[: len(cases) // loads]])
    found: Columns = {
        "mesh_frequency": (("mesh_frequency",), frequencies, _labels("Hz", "mesh frequency")),
        "pinion_speed": (("mesh_frequency",), 60.0 * frequencies / pair.pinion.teeth, _labels("rpm", "speed of the pinion")),
        "order": (("order",), ORDERS, _labels("1", "mesh order")),
    }
    every = [_of_case(outcome, case.index, pair) for case in cases]
    known = next((each for each in every if each), {})
    for name, (values, labels) in known.items():
        inner = ("order",) if np.ndim(values) else ()
        stacked = np.array([each[name][0] if name in each else np.full(np.shape(values), np.nan) for each in every])
        found[name] = (("load", "mesh_frequency", *inner), stacked.reshape(loads, len(frequencies), *np.shape(values)), labels)
    return found


def _of_case(outcome: Outcome, index: int, pair: GearPair) -> dict[str, tuple]:
    """What a run has, by name with labels; nothing where it failed."""
    record = outcome.records.get(index)
    if record is None:
        return {}
    try:
        run = of_settled(results.load(outcome.file.parent / "cases" / f"{outcome.study.cases[index].name}.nc"))
    except ComputationError:
        return {}
    error = run["transmission_error"].values * pair.wheel.base_radius / MICROMETRE
    force = run["normal_force"].values - (run["coast_normal_force"].values if "coast_normal_force" in run else 0.0)
    found = {
        "dynamic_peak_to_peak_transmission_error": (
            record.numbers["peak_to_peak_transmission_error"] * pair.wheel.base_radius / MICROMETRE, _labels("um", "transmission error, peak to peak, with inertia")),
        "rms_transmission_error": (float(error[:-1].std()), _labels("um", "r.m.s. of the transmission error without its mean, with inertia")),
        "rms_normal_force": (float(force[:-1].std()), _labels("N", "r.m.s. of the mesh force without its mean")),
        "dynamic_factor": (record.numbers.get("dynamic_factor_by_force", np.nan), _labels("1", "largest force of a tooth pair over that without inertia")),
        "contact_loss_share": (record.numbers.get("contact_loss_share", 0.0), _labels("1", "share of the time without contact")),
        "transmission_error_order": (_orders(run, error), _labels("um", "amplitude of the transmission error along the line of action, with inertia")),
        "normal_force_order": (_orders(run, force), _labels("N", "amplitude of the mesh force")),
    }  # fmt: skip
    return found


def _orders(run: xr.Dataset, values: np.ndarray) -> np.ndarray:
    """Amplitudes at ORDERS of the last settled mesh cycles, an even number of them so that half orders stand alone; not a number of what the steps do not sample."""
    phase = run["mesh_phase"].values
    steps, cycles = round(1.0 / (phase[1] - phase[0])), int((phase[-1] - phase[0]) * (1.0 + 1e-9))
    whole = cycles - cycles % 2 or cycles
    lines = order_lines(values[-whole * steps - 1 :], whole, (1, 1), NO_WINDOW) if whole else None
    if lines is None:
        return np.full(len(ORDERS), np.nan)
    known = (lines.orders[-1] >= ORDERS) & ((ORDERS % 1.0 == 0.0) | (whole > 1))
    return np.array([lines.at(order) if there else np.nan for order, there in zip(ORDERS, known)])
