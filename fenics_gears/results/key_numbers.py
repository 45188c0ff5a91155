"""The key numbers of a run, taken from the curves of its settled mesh cycles; `results.attributes` has their units and
meaning."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from fenics_gears.contact.laws import NO_FORCE
from fenics_gears.geometry.pair import GearPair
from fenics_gears.geometry.sliding import CONTACT_POINTS, contact_points, sliding_speed, specific_sliding
from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.data import Scene

from .contact_variables import Curves, largest_normal_force, mesh_force, transmitted
from .numbers import HARMONICS, first_largest, harmonics, largest_of_one_pair, mean_where_positive, shares_at

MICROMETRE = 1e-3  # mm
WATT = 1e3  # N mm/s
HARMONIC_NAMES = tuple(f"transmission_error_harmonic_{n}" for n in range(1, HARMONICS + 1))
# The numbers that a study takes of each case, where it has them.
STUDIED = (
    *HARMONIC_NAMES, "rms_transmission_error", "rms_normal_force", "mean_mesh_stiffness", "mean_mesh_stiffness_tangent",
    "single_pair_stiffness", "largest_pair_force",
    "dynamic_factor_by_force", "dynamic_factor_by_stress", "peak_contact_pressure", "peak_edge_pressure",
    "peak_kink_pressure", "largest_root_stress_pinion", "largest_root_stress_wheel",
    "input_power", "friction_loss", "friction_power", "mesh_efficiency",
    "contact_loss_share",
    "overlap_ratio", "total_contact_ratio", "face_load_factor", "largest_line_load_factor", "edge_line_load_factor",
    "transverse_load_factor",
    "mean_axis_inclination_in_plane", "largest_bearing_force", "largest_rolling_element_force",
)  # fmt: skip


def key_numbers(
    counted: Mapping[str, np.ndarray], pair: GearPair, friction_loss: float | None, timed: bool
) -> dict[str, float | str]:
    """All numbers of the settled steps of a result except of root stress, as far as their curves are `counted`.
    `friction_loss`: its attribute. `timed`: the scene has a speed, without which there is no power."""
    # The last step begins the next cycle.
    last = max(len(counted["time"]) - 1, 1)
    settled = {name: values[:last] for name, values in counted.items()}
    of_mesh = _harmonics(settled, pair) | _stiffness(settled, pair) | _pair_force(settled) | _pressure(settled, pair)
    return of_mesh | _power(counted, friction_loss, timed)


def _harmonics(settled: Curves, pair: GearPair) -> dict[str, float]:
    """Harmonics and r.m.s. of the transmission error as a length at the wheel's base circle, um, and r.m.s. of the mesh
    force, N, of the last whole mesh cycles. Nothing for less than one cycle, or on a ramp."""
    phase = settled["mesh_phase"]
    if len(phase) < 2 or "mesh_frequency" in settled:
        return {}
    a_cycle = round(1.0 / (phase[1] - phase[0]))
    cycles = len(phase) // a_cycle
    if not cycles:
        return {}
    curve = settled["transmission_error"][-cycles * a_cycle :] * abs(pair.wheel.base_radius) / MICROMETRE
    amplitudes = zip(HARMONIC_NAMES, harmonics(curve, cycles))
    return {name: float(amplitude) for name, amplitude in amplitudes if np.isfinite(amplitude)} | {
        "rms_transmission_error": float(curve.std()),
        "rms_normal_force": float(mesh_force(settled)[-cycles * a_cycle :].std()),
    }


def _stiffness(settled: Curves, pair: GearPair) -> dict[str, float]:
    if "mesh_stiffness" not in settled:
        return {}
    secant, tangent, pairs = (settled[name] for name in ("mesh_stiffness", "mesh_stiffness_tangent", "loaded_pairs"))
    stiffnesses = {
        "mean_mesh_stiffness": mean_where_positive(secant),
        "mean_mesh_stiffness_tangent": mean_where_positive(tangent),
        "single_pair_stiffness": largest_of_one_pair(secant, pairs),
    }
    return {name: value * MICROMETRE / pair.face_width for name, value in stiffnesses.items() if np.isfinite(value)}


def _pair_force(settled: Curves) -> dict[str, float]:
    """The largest normal force of a tooth pair, N, at the steps; nothing where shares of rigid pairs are not
    determined, or nothing presses."""
    if "pair_normal_force" not in settled:
        return {}
    over_time = largest_force_over_time(settled)
    if np.isnan(over_time).any() or over_time.max() <= NO_FORCE:
        return {}
    place = first_largest(over_time)
    return {
        "largest_pair_force": float(over_time[place]),
        "largest_pair_force_mesh_phase": float(settled["mesh_phase"][place]),
    }


def largest_force_over_time(curves: Curves) -> np.ndarray:
    """The largest normal force (time,), N, of a tooth pair, on drive or coast flanks."""
    names = [name for name in ("pair_normal_force", "pair_coast_normal_force") if name in curves]
    return np.max([curves[name].max(axis=1, initial=0.0) for name in names], axis=0)


def _pressure(settled: Curves, pair: GearPair) -> dict[str, float | str]:
    if "largest_contact_pressure" not in settled:
        return {}
    pressure = settled["largest_contact_pressure"]
    place = first_largest(pressure)
    numbers: dict[str, float | str] = {"peak_contact_pressure": float(pressure[place])}
    for name in ("edge", "kink"):
        if f"largest_{name}_pressure" in settled and settled[f"largest_{name}_pressure"].any():
            numbers[f"peak_{name}_pressure"] = float(settled[f"largest_{name}_pressure"].max())
    if pressure[place] <= NO_FORCE / pair.face_width**2:
        return {"peak_contact_pressure": 0.0}

    def at(name: str) -> float:
        return float(settled[name][place])

    on_coast = "coast_normal_force" in settled and at("coast_normal_force") > at("normal_force")
    roll = at("largest_contact_pressure_roll_angle")
    return numbers | {
        "peak_contact_pressure_time": at("time"),
        "peak_contact_pressure_mesh_phase": at("mesh_phase"),
        "peak_contact_pressure_pair": int(at("largest_contact_pressure_pair")),
        "peak_contact_pressure_flank": "coast" if on_coast else "drive",
        "peak_contact_pressure_diameter": 2.0 * float(pair.pinion.radius(roll)),
    }


def largest_root_stress(counted: xr.Dataset) -> dict[str, float | str]:
    """The largest root stress of either gear, MPa, when it is, at the tooth of which pair and on which side; where it
    was asked for."""
    if "root_stress_maximum" not in counted:
        return {}
    settled = counted.isel(time=slice(0, max(counted.sizes["time"] - 1, 1)))
    numbers: dict[str, float | str] = {}
    for gear in GEARS:
        stress = settled["root_stress_maximum"].sel(gear=gear).transpose("time", "slot").values
        if not np.nanmax(stress, initial=0.0):
            continue
        step, slot = np.unravel_index(first_largest(stress), stress.shape)
        at = settled.isel(time=step, slot=slot)
        sides = at["root_stress_at_30_degrees"].sel(gear=gear)
        name = f"largest_root_stress_{gear}"
        numbers |= {
            name: float(stress[step, slot]),
            f"{name}_mesh_phase": float(at["mesh_phase"]),
            f"{name}_pair": int(at["pair_number"]),
            f"{name}_fillet": str(sides["fillet"].values[int(np.nanargmax(sides.values))]),
        }
    return numbers


def _power(counted: Curves, loss: float | None, timed: bool) -> dict[str, float]:
    """Mean power of the drive, W, friction loss, W, and efficiency of the mesh; no power without a speed, nothing if
    the drive does no work."""
    if "work_input" not in counted:
        return {}
    seconds = float(np.ptp(counted["time"]))
    drive = abs(transmitted(counted).drive)
    if not seconds or not drive or largest_normal_force(counted) <= NO_FORCE:
        return {}
    power = drive / seconds / WATT
    numbers = {"input_power": power} if timed else {}
    if loss is not None:
        numbers |= {"friction_power": loss * power} if timed else {}
        # What wedges the teeth is not the load, and the friction that it makes is no loss of the load's power.
        numbers |= {"mesh_efficiency": 1.0 - loss} if loss < 1.0 and not wedged(counted).any() else {}
    return numbers


def wedged(curves: Curves) -> np.ndarray:
    """Steps (time,) at which drive and coast flanks press at once."""
    if "coast_normal_force" not in curves:
        return np.zeros(len(curves["time"]), dtype=bool)
    return np.minimum(curves["normal_force"], curves["coast_normal_force"]) > NO_FORCE


def path_point_values(
    scene: Scene, pair: GearPair, phase: np.ndarray, numbers: np.ndarray, forces: np.ndarray, first_number: int
) -> dict[str, np.ndarray]:
    """What the points A to E of the path of contact have: place, sliding by the nominal motion, share of the load.

    Of settled steps: `phase` (steps,), mesh cycles; the pairs' `numbers` (steps, slots), 0 for none, and their `forces`
    (steps, slots), N. Pair `first_number` reaches the start of contact at phase 0.
    """
    points = contact_points(pair)
    rolls = pair.pinion_roll_angle(points), pair.wheel_roll_angle(points)
    diameters = [2.0 * gear.radius(roll) for gear, roll in zip(pair.gears, rolls)]
    positions = (points - pair.path_start) / pair.base_pitch
    forces = np.where(numbers > 0, forces, np.nan)
    return {
        "path_point_position": points,
        "path_point_diameter": np.transpose(diameters),
        "sliding_speed": sliding_speed(pair, points, scene.mesh_frequencies[1]),
        "specific_sliding": np.transpose(specific_sliding(pair, points)),
        "load_share": shares_at(positions, phase, numbers - first_number, forces),
    }


def path_point_coordinate() -> tuple:
    words = (
        "start of contact, LPSTC of the pinion, pitch point, HPSTC of the pinion, end of contact; with a contact ratio"
        " above 2 the lowest and highest point of contact by the fewest pairs in place of LPSTC and HPSTC"
    )
    return ("path_point", list(CONTACT_POINTS), {"long_name": f"point of the path of contact: {words}"})
