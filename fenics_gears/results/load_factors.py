"""How unevenly a mesh carries along the face and between its tooth pairs: load factors as ISO 6336-1 names them, read off the computed contact.

The standard's methods B and C estimate them; these are its definitions (method A). None of them has the dynamic factor in it: each compares loads of
the same step.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from fenics_gears.contact.laws import NO_FORCE
from fenics_gears.contact.window import coast_roll_angles
from fenics_gears.geometry.pair import GearPair
from fenics_gears.results.pairs import carrying_side

# Mesh cycles beside a phase at which the lines of contact change.
BESIDE = 1e-9


def load_factors(counted: xr.Dataset, pair: GearPair) -> dict[str, float]:
    """Overlap and total contact ratio, and the load factors of the flanks that carry in the settled steps of a result; nothing of flanks without load.

    Face load factors need contact fields, of which those of settled steps count.
    """
    found = {"overlap_ratio": pair.overlap_ratio, "total_contact_ratio": pair.total_contact_ratio}
    side = carrying_side(counted)
    pressed = counted[f"{side}normal_force"].values > NO_FORCE
    if pressed.any():
        largest = counted[f"pair_{side}normal_force"].values[pressed].max(axis=1) / counted[f"{side}normal_force"].values[pressed]
        found["transverse_load_factor"] = float(largest.max()) / largest_even_share(pair)
    if counted.sizes.get("contact_time"):
        settled = counted.isel(contact_time=counted["contact_time"].values >= counted["time"].values[0])
        loads = line_loads(settled, side)
        factors = {"face_load_factor": uneven(loads.sum(axis=1)), "face_load_factor_at_pitch_cylinder": uneven(at_pitch_cylinder(settled, pair, side))}
        found |= {name: float(each.max()) for name, each in factors.items() if each.size}
    return found


def line_loads(result: xr.Dataset, side: str) -> np.ndarray:
    """Line load (n, slots, S), N/mm, of those flanks."""
    return result[f"{side}line_load"].transpose("contact_time", "slot", "face_position").values


def uneven(loads: np.ndarray) -> np.ndarray:
    """Largest over mean of line loads (rows, S) over slices of one width, of the rows with a load."""
    mean = loads.mean(axis=1)
    return loads[mean > 0.0].max(axis=1) / mean[mean > 0.0]


def at_pitch_cylinder(result: xr.Dataset, pair: GearPair, side: str = "") -> np.ndarray:
    """Line load (n, S), N/mm, in each slice when its contact passes the pitch point, the n-th time; straight between steps. `side`: of `carrying_side`.

    Of a helical pair slices pass one after the other: each row is of one line along the flank, on the pitch cylinder.
    """
    phase, slots = result["contact_mesh_phase"].values, result.sizes["slot"]
    loads, first = line_loads(result, side), result["contact_pair_number"].attrs["number_at_phase_0"]
    # Mesh cycles from the start of contact of the drive flanks in the middle of the face to the pitch point in each slice.
    after = (passing(pair, pair.pitch_point, side) - pair.path_start - pair.slope * result["face_position"].values) / pair.base_pitch
    passed = []
    for slice_, since in enumerate(after):
        numbers = np.arange(np.ceil(phase[0] - since - BESIDE), np.floor(phase[-1] - since + BESIDE) + 1).astype(int)
        passed.append([np.interp(number + since, phase, loads[:, (number + first) % slots, slice_]) for number in numbers])
    count = min(map(len, passed), default=0)
    return np.transpose([each[:count] for each in passed])


def passing(pair: GearPair, position: float, side: str) -> float:
    """Where the contact of a pair's drive flanks stands (mm from T1) when that of its flanks of `side` passes a position on their own line of action."""
    # There coast flanks go the other way.
    return pair.pinion.base_radius * coast_roll_angles(pair, 0.0)[0] - position if side else position


def contact_line_lengths(pair: GearPair, positions) -> np.ndarray:
    """Length (mm) along the axes of the line of contact of pairs that stand at positions (mm from T1, any shape) in the middle of the face."""
    positions = np.asarray(positions, dtype=float)
    half, slope = 0.5 * pair.face_width, abs(pair.slope)
    if slope == 0.0:
        return np.where((positions >= pair.path_start) & (positions <= pair.path_end), pair.face_width, 0.0)
    low, high = ((end - positions) / slope for end in (pair.path_start, pair.path_end))
    return np.maximum(np.minimum(high, half) - np.maximum(low, -half), 0.0)


def largest_even_share(pair: GearPair) -> float:
    """Largest share of a tooth pair in the mesh's force if the line load were the same along all lines of contact, over a mesh cycle."""
    lead = 0.5 * pair.face_width * abs(pair.slope)
    # Between the phases at which a line begins or ends to reach an end of the face lengths are linear and shares monotonic.
    ends = [end + side * lead for end in (pair.path_start, pair.path_end) for side in (-1.0, 1.0)]
    phases = np.mod(np.array(ends) / pair.base_pitch, 1.0)[:, None] + [-BESIDE, BESIDE]
    reach = np.arange(np.floor(min(ends) / pair.base_pitch) - 1, np.ceil(max(ends) / pair.base_pitch) + 2)
    lengths = contact_line_lengths(pair, pair.base_pitch * (phases.ravel()[:, None] + reach))
    return float((lengths.max(axis=1) / lengths.sum(axis=1)).max())
