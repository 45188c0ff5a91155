"""Modes of shafts, the last coordinates of a drivetrain: contact does not move them, so that they are eliminated before
each step. Compiled code has these functions too."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class Eliminated(NamedTuple):
    """Modes that are eliminated from equations of motion over c other coordinates and m modes: the `stiffness` (c, c)
    that is left, how the modes `follow` (m, c) the others, and their own `flexibility` (m, m)."""

    stiffness: np.ndarray
    follow: np.ndarray
    flexibility: np.ndarray


def eliminated(stiffness, modes):
    """Eliminate so many last coordinates from equations with a stiffness (k, k)."""
    c = len(stiffness) - modes
    if modes == 0:
        return Eliminated(stiffness, np.empty((0, c)), np.empty((0, 0)))
    flexibility = np.ascontiguousarray(np.linalg.inv(np.ascontiguousarray(stiffness[c:, c:])))
    follow = flexibility @ np.ascontiguousarray(stiffness[c:, :c])
    left = stiffness[:c, :c] - np.ascontiguousarray(stiffness[:c, c:]) @ follow
    return Eliminated(left, follow, flexibility)


def left_load(load, modes):
    """The load (c,) on the other coordinates, with what modes hand on to them, of that (k,) on all."""
    c = len(modes.stiffness)
    return load[:c] - load[c:] @ modes.follow if c < len(load) else load


def put_modes(coordinates, load, modes):
    """Put the modes' coordinates into place behind the others (k,), under the load (k,) on all."""
    c = len(modes.stiffness)
    if c < len(load):
        coordinates[c:] = modes.flexibility @ load[c:] - modes.follow @ coordinates[:c]
