"""Where the face of a result ends: its slices, and the zone at either end whose line load and pressure are an
edge's."""

import numpy as np
import xarray as xr

from fenics_gears.geometry.pair import GearPair

# Depth of the zone at either end of the common face, in normal modules, and the largest part of the face that it
# takes. Within it the tooth's free end, or the edge of the narrower gear on the wider one, changes the line load.
END_DEPTH = 0.5
LARGEST_PART = 0.1
ROUNDING = 1e-9


def end_depth(pair: GearPair) -> float:
    """Depth (mm) of the zone at either end of the common face."""
    return min(END_DEPTH * pair.pinion.normal_module, LARGEST_PART * pair.face_width)


def inner_face(pair: GearPair) -> tuple[float, float]:
    """Ends z (mm) of the common face without those zones."""
    low, high = pair.common_face
    return low + end_depth(pair), high - end_depth(pair)


def in_end_zone(pair: GearPair, positions: np.ndarray) -> np.ndarray:
    """Whether the middle of each slice (S,), mm, is within the zone at either end."""
    low, high = inner_face(pair)
    round_off = ROUNDING * pair.face_width
    return (positions < low - round_off) | (positions > high + round_off)


def slice_ends(result: xr.Dataset) -> np.ndarray:
    """Ends (S + 1,), mm, of the slices along the face."""
    z = result["face_position"].values
    widths = result["face_slice_width"].values
    return np.append(z - 0.5 * widths, z[-1] + 0.5 * widths[-1])


def window_depth(pair: GearPair) -> float:
    """Depth (mm) of the windows of the inner face over which means are compared, about that of an end zone. A whole
    number of them makes the inner face, so that no largest mean is below the mean of the inner face."""
    low, high = inner_face(pair)
    return (high - low) / round((high - low) / end_depth(pair))


def windows(result: xr.Dataset, pair: GearPair) -> np.ndarray:
    """Shares (k, S) of the slices in windows of the inner face: all windows over which the mean of values of slices can
    be largest. Values are not resolved within a layer of the bodies; means over such a window are."""
    ends = slice_ends(result)
    low, high = inner_face(pair)
    depth = window_depth(pair)
    # Side by side they fill the inner face.
    beside = low + depth * np.arange(round((high - low) / depth))
    starts = np.unique(np.clip(np.concatenate([ends, ends - depth, beside]), low, high - depth))
    return np.diff(np.clip(ends, starts[:, None], starts[:, None] + depth), axis=1) / depth


def inner_widths(result: xr.Dataset, pair: GearPair) -> np.ndarray:
    """Width (S,), mm, of each slice on the inner face."""
    return np.diff(np.clip(slice_ends(result), *inner_face(pair)))
