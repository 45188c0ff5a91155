"""How unevenly a mesh carries along the face and between its tooth pairs, read off the computed contact.

Face and transverse load factor follow the definitions of ISO 6336-1 (method A). None has the dynamic factor in it: each
compares loads of the same steps.
"""

import numpy as np
import xarray as xr

from fenics_gears.contact.laws import NO_FORCE
from fenics_gears.contact.window import coast_roll_angles
from fenics_gears.geometry.pair import GearPair

from .face_ends import end_depth, in_end_zone, inner_widths, windows
from .pairs import carrying_side

# Mesh cycles before and after a phase at which the lines of contact change.
BESIDE = 1e-9
# Share of a force that is round-off.
NO_SHARE = 1e-9


def load_factors(counted: xr.Dataset, pair: GearPair) -> dict[str, float]:
    """Overlap and total contact ratio, and the load factors of the flanks that carry in the settled steps of a result;
    nothing of flanks without load. Factors along the face need contact fields."""
    factors = {"overlap_ratio": pair.overlap_ratio, "total_contact_ratio": pair.total_contact_ratio}
    side = carrying_side(counted)
    pressed = counted[f"{side}normal_force"].values > NO_FORCE
    if pressed.any():
        of_pairs, of_mesh = (counted[f"{each}{side}normal_force"].values[pressed] for each in ("pair_", ""))
        largest = of_pairs.max(axis=1) / of_mesh
        factors["transverse_load_factor"] = float(largest.max()) / largest_even_share(pair)
    if counted.sizes.get("contact_time"):
        settled = counted.isel(contact_time=counted["contact_time"].values >= counted["time"].values[0])
        factors |= _of_cycle(settled, pair, side) | _of_instants(settled, pair, side)
    return factors


def line_loads(result: xr.Dataset, side: str) -> np.ndarray:
    return result[f"{side}line_load"].transpose("contact_time", "slot", "face_position").values


def _of_cycle(settled: xr.Dataset, pair: GearPair, side: str) -> dict[str, float]:
    """Of the line load averaged over whole mesh cycles: its largest mean over a window of the inner face, divided by
    its mean over the inner face. Nothing where the end zones alone carry."""
    load = mean_line_load(settled, side)
    factor = None if load is None else face_load_factor(load, settled, pair)
    return {} if factor is None else {"face_load_factor": factor}


def face_load_factor(load: np.ndarray, face: xr.Dataset, pair: GearPair) -> float | None:
    """Largest mean of a line load (S,) over a window of the inner face, divided by its mean over the inner face, hence
    at least 1. None where the end zones alone carry."""
    widths = inner_widths(face, pair)
    inner = float(load @ widths)
    if inner <= NO_SHARE * float(load @ face["face_slice_width"].values):
        return None
    return float((windows(face, pair) @ load).max() * widths.sum() / inner)


def mean_line_load(result: xr.Dataset, side: str) -> np.ndarray | None:
    """Line load (S,), N/mm, of all tooth pairs together on those flanks, mean over as many whole mesh cycles as are
    stored; None of less than one."""
    phase = result["contact_mesh_phase"].values
    cycles = np.floor(np.ptp(phase) + BESIDE)
    if cycles < 1:
        return None
    counted = phase >= phase[-1] - cycles - BESIDE
    between = np.diff(phase[counted])
    parts = 0.5 * (np.append(between, 0.0) + np.append(0.0, between))
    return np.tensordot(parts / parts.sum(), line_loads(result, side)[counted].sum(axis=1), axes=1)


def _of_instants(settled: xr.Dataset, pair: GearPair, side: str) -> dict[str, float]:
    """Of the largest line load of one tooth pair at any stored step: its mean over a window away from edges, and that
    of a slice at edges. Both are over the line load of an even spread: the force of that step over the shortest sum of
    the lines of contact of rigid gears. It is no mean of the same places: where edges carry more than that, the rest
    carries less, and the factor away from edges may be below 1."""
    loads = line_loads(settled, side)
    z = settled["face_position"].values
    force = (loads @ settled["face_slice_width"].values).sum(axis=1)
    ended = _line_ends(settled, pair, side, z)
    shares = windows(settled, pair)
    away = np.where(ended @ (shares > BESIDE).T, 0.0, loads @ shares.T)
    edges = np.where(ended | in_end_zone(pair, z), loads, 0.0)
    factors = {}
    for name, values in (("largest_line_load_factor", away), ("edge_line_load_factor", edges)):
        # Under a torque of nothing loads are round-off, of either sign.
        largest = float(values.max(initial=0.0))
        if largest > 0.0 and (own := force[np.unravel_index(values.argmax(), values.shape)[0]]) > 0.0:
            factors[name] = largest * shortest_lines(pair) / float(own)
    return factors


def at_edges(result: xr.Dataset, pair: GearPair, side: str) -> np.ndarray:
    """Whether the contact of each tooth pair in each slice (n, slots, S) is near an end of the face, or where its line
    of contact ends on the flank."""
    z = result["face_position"].values
    return _line_ends(result, pair, side, z) | in_end_zone(pair, z)


def _line_ends(result: xr.Dataset, pair: GearPair, side: str, z: np.ndarray) -> np.ndarray:
    """Whether each tooth pair's line of contact ends at a tip or form circle near places z (mm) of the face (n, slots,
    len(z)), or has ended before them. The line of a spur pair ends nowhere along the face."""
    numbers = result["contact_pair_number"]
    since = result["contact_mesh_phase"].values[:, None] - (numbers.values - numbers.attrs["number_at_phase_0"])
    position = pair.path_start + since[..., None] * pair.base_pitch + pair.slope * z
    if side:
        position = passing(pair, position, side)
    return (position < pair.path_start + _near(pair)) | (position > pair.path_end - _near(pair))


def _near(pair: GearPair) -> float:
    """How far (mm) along the path of contact the end zones of a line of contact reach; 0 of spur pairs."""
    return end_depth(pair) * abs(pair.slope)


def end_of_line(pair: GearPair, position: float) -> str:
    """Which end of the pinion's active profile, where lines of contact of a helical pair end, is near a position (mm
    from T1): `start`, `end`, or nothing."""
    return "start" if position < pair.path_start + _near(pair) else "end" * (position > pair.path_end - _near(pair))


def passing(pair: GearPair, position, side: str):
    """Position (mm from T1) of a pair's contact on the drive flanks when its contact on the flanks of `side` passes a
    position on their own line of action. Coast flanks pass theirs the other way."""
    return pair.pinion.base_radius * coast_roll_angles(pair, 0.0)[0] - position if side else position


def contact_line_lengths(pair: GearPair, positions) -> np.ndarray:
    """Length (mm) along the axes of the line of contact of pairs at positions (mm from T1, any shape) in the middle of
    the face."""
    positions = np.asarray(positions, dtype=float)
    half = 0.5 * pair.face_width
    slope = abs(pair.slope)
    if slope == 0.0:
        return np.where((positions >= pair.path_start) & (positions <= pair.path_end), pair.face_width, 0.0)
    low, high = ((end - positions) / slope for end in (pair.path_start, pair.path_end))
    return np.maximum(np.minimum(high, half) - np.maximum(low, -half), 0.0)


def largest_even_share(pair: GearPair) -> float:
    """Largest share of a tooth pair in the mesh's force if the line load were the same along all lines of contact, over
    a mesh cycle."""
    lengths = _lengths_where_they_turn(pair)
    return float((lengths.max(axis=1) / lengths.sum(axis=1)).max())


def shortest_lines(pair: GearPair) -> float:
    """Length (mm) along the axes of all lines of contact of rigid gears together, when they are shortest."""
    return float(_lengths_where_they_turn(pair).sum(axis=1).min())


def _lengths_where_they_turn(pair: GearPair) -> np.ndarray:
    """Lengths (phases, pairs), mm, just before and after the phases at which a line begins or ends to reach an end of
    the face. Between them lengths are linear and shares monotonic."""
    lead = 0.5 * pair.face_width * abs(pair.slope)
    ends = [end + side * lead for end in (pair.path_start, pair.path_end) for side in (-1.0, 1.0)]
    phases = np.mod(np.array(ends) / pair.base_pitch, 1.0)[:, None] + [-BESIDE, BESIDE]
    reach = np.arange(np.floor(min(ends) / pair.base_pitch) - 1, np.ceil(max(ends) / pair.base_pitch) + 2)
    return contact_line_lengths(pair, pair.base_pitch * (phases.ravel()[:, None] + reach))
