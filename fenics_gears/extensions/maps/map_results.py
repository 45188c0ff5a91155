"""The dataset of a map over loads and speeds, from its studies."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

import fenics_gears
from fenics_gears import (
    HARMONIC_NAMES,
    MICROMETRE,
    GearPair,
    Load,
    Scene,
    Vibration,
    load,
    mesh_force,
    mesh_stiffness,
    model_of,
    of_settled,
    spectrum,
    vibrations,
)
from fenics_gears.many_runs import Outcome, load_combined
from fenics_gears.scene_text import LOAD_WORDS

from .load_map import LoadMap

# Half mesh orders tell a motion that repeats only after two mesh cycles.
ORDERS = np.arange(1, 21) / 2.0
# What a map takes of its studies; of that with inertia by the prefix.
CURVES = ("transmission_error", "mesh_stiffness")
ERRORS = ("peak_to_peak_transmission_error", "mean_transmission_error", "rms_transmission_error", *HARMONIC_NAMES)
AT_REST = (
    *ERRORS,
    "mean_mesh_stiffness",
    "mean_mesh_stiffness_tangent",
    "peak_contact_pressure",
    "largest_pair_force",
    "mesh_efficiency",
)
WITH_INERTIA = (*ERRORS, "rms_normal_force", "largest_pair_force", "contact_loss_share")
DYNAMIC = "dynamic_"
Columns = dict[str, tuple[tuple[str, ...], np.ndarray, dict[str, str]]]


def map_dataset(wanted: LoadMap, at_rest: Outcome, over_speed: Outcome | None) -> xr.Dataset:
    """Everything of a map over `load` (N m or kW); with speeds also over `mesh_frequency` (Hz).

    Transmission errors are in um along the line of action. A case without a result has not a number.
    """
    scene = wanted.scene
    pair = model_of(wanted.scene).pair
    length = abs(pair.wheel.base_radius) / MICROMETRE
    study = load_combined(at_rest.file)
    dataset = xr.Dataset(coords={"load": ("load", np.array(wanted.numbers), _labels(*LOAD_WORDS[scene.load.given]))})
    dataset = dataset.assign(_taken(study, AT_REST, ("load",), length))
    if "mesh_phase" in study:
        dataset = dataset.assign_coords(mesh_phase=study["mesh_phase"]).assign(
            _taken(study, CURVES, ("load", "mesh_phase"), length)
        )
    if scene.inertia is not None:
        torques = [wanted.wheel_torque(each) for each in wanted.loads]
        tangents = dataset.get("mean_mesh_stiffness_tangent")
        frequencies = frequencies_over_load(scene, 1e-3 * np.array(torques), tangents, pair)
        dataset = dataset.assign(frequencies).set_coords(["excited", "motion"])
    if over_speed is not None:
        study = load_combined(over_speed.file)
        dimensions = ("load", "mesh_frequency")
        dataset = dataset.assign(_spectra(over_speed, pair, dataset.sizes["load"])).set_coords("pinion_speed")
        dataset = dataset.assign(_taken(study, WITH_INERTIA, dimensions, length, DYNAMIC))
        dataset = dataset.assign(_taken(study, ("dynamic_factor_by_force",), dimensions, length))
    return dataset.assign_attrs(
        title=scene.title,
        scene=scene.text,
        fenics_gears_version=fenics_gears.__version__,
        base_radius_wheel=abs(pair.wheel.base_radius),
    )


def _labels(units: str, name: str) -> dict[str, str]:
    return {"units": units, "long_name": name}


def _taken(
    study: xr.Dataset, names: Sequence[str], dimensions: tuple[str, ...], length: float, prefix: str = ""
) -> Columns:
    """Those of the study's variables that it has; angles of the wheel as lengths (um)."""
    columns: Columns = {}
    for name in (name for name in names if name in study):
        units, words = (study[name].attrs[each] for each in ("units", "long_name"))
        labels = _labels("um", f"{words}, along the line of action") if units == "rad" else _labels(units, words)
        columns[prefix + name] = (dimensions, study[name].values * (length if units == "rad" else 1.0), labels)
    return columns


def frequencies_over_load(scene: Scene, loads: np.ndarray, tangents: xr.DataArray | None, pair: GearPair) -> Columns:
    """Natural frequencies of the drivetrain (load, mode), the mesh being a spring of its mean tangent stiffness at
    torques (loads,), N m, on the wheel."""
    every = []
    for place, torque in enumerate(loads):
        rough = mesh_stiffness(scene, pair)
        stiffness = rough if tangents is None else float(tangents.values[place]) * pair.face_width / MICROMETRE
        drivetrain = model_of(replace(scene, load=Load(1e3 * torque))).drivetrain
        known = np.isfinite(stiffness) or stiffness == rough
        every.append(vibrations(drivetrain, stiffness, scene.friction is not None) if known else None)
    # Of shafts that bend the highest frequency that counts may be beyond the limit at one load alone.
    fewest = min((len(each) for each in every if each), default=0)
    every = [each and each[:fewest] for each in every]
    modes = next((each for each in every if each), [])
    nothing = [Vibration(np.nan, np.nan, False)] * len(modes)
    values = np.array([[(mode.frequency, mode.damping_ratio) for mode in each or nothing] for each in every])
    frequency, damping = np.moveaxis(values.reshape(len(loads), len(modes), 2), 2, 0)
    excited = np.array([int(mode.excited) for mode in modes], dtype=int)
    motion = np.array([mode.motion for mode in modes], dtype=object)
    what = "what moves, where a gear tilts or moves"
    note = _labels("Hz", "natural frequency with the mean tangent mesh stiffness")
    return {
        "mode": (("mode",), np.arange(1, len(modes) + 1), _labels("1", "number of the mode")),
        "natural_frequency": (("load", "mode"), frequency, note),
        "damping_ratio": (("load", "mode"), damping, _labels("1", "part of the critical damping of the mode")),
        "excited": (("mode",), excited, _labels("1", "1 where contact forces excite the mode")),
        "motion": (("mode",), motion, {"long_name": f"{what} along its axis"}),
    }


def _spectra(outcome: Outcome, pair: GearPair, loads: int) -> Columns:
    """Amplitudes of the steady runs by mesh order; the last axis of the study is the speed."""
    cases = outcome.study.cases
    frequencies = np.array([case.scene.motion.mesh_frequency for case in cases[: len(cases) // loads]])
    amplitudes = np.full((len(cases), 2, len(ORDERS)), np.nan)
    for index in outcome.records:
        run = of_settled(load(outcome.file.parent / "cases" / f"{cases[index].name}.nc"))
        error = run["transmission_error"].values * abs(pair.wheel.base_radius) / MICROMETRE
        amplitudes[index] = [_orders(run, error), _orders(run, mesh_force(run))]
    dimensions = ("load", "mesh_frequency", "order")
    speeds = 60.0 * frequencies / pair.pinion.teeth
    error, force = np.moveaxis(amplitudes.reshape(loads, len(frequencies), 2, len(ORDERS)), 2, 0)
    words = "amplitude of the transmission error along the line of action, with inertia"
    return {
        "mesh_frequency": (dimensions[1:2], frequencies, _labels("Hz", "mesh frequency")),
        "pinion_speed": (dimensions[1:2], speeds, _labels("rpm", "speed of the pinion")),
        "order": (dimensions[2:], ORDERS, _labels("1", "mesh order")),
        "transmission_error_amplitude": (dimensions, error, _labels("um", words)),
        "mesh_force_amplitude": (dimensions, force, _labels("N", "amplitude of the mesh force")),
    }


def _orders(run: xr.Dataset, values: np.ndarray) -> np.ndarray:
    """Amplitudes at ORDERS of the last settled mesh cycles, an even number of them so that half orders stand alone; NaN
    for what the steps do not sample."""
    phase = run["mesh_phase"].values
    steps = round(1.0 / (phase[1] - phase[0]))
    cycles = int((phase[-1] - phase[0]) * (1.0 + 1e-9))
    whole = cycles - cycles % 2 or cycles
    lines = spectrum.order_lines(values[-whole * steps - 1 :], whole, (1, 1), spectrum.NO_WINDOW) if whole else None
    if lines is None:
        return np.full(len(ORDERS), np.nan)
    known = (lines.orders[-1] >= ORDERS) & ((ORDERS % 1.0 == 0.0) | (whole > 1))
    return np.array([lines.at(order) if there else np.nan for order, there in zip(ORDERS, known)])
