"""A shaft on rolling bearings in balance with the load of its gear, and the springs that such bearings then are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import minimize

from fenics_gears.errors import SceneError

from .rolling_bearing import MOTIONS, reaction, secant_stiffness
from .tilting import coast_normal, contact_normal, moved

if TYPE_CHECKING:
    from fenics_gears.effects.bearings import Bearing
    from fenics_gears.geometry.pair import GearPair

    from .elastic_shaft import ElasticShaft

# Lever arm, mm, that makes tilts comparable with displacements; mm/N that every bearing yields besides in the search of
# a minimum; parts of the load that the search may leave, and that Newton's method may, with its largest number of
# iterations.
ARM, YIELDING, NEAR, LEFT, POLISHED = 30.0, 1e-9, 1e-6, 1e-11, 30


def even_load(shaft: ElasticShaft, pair: GearPair, torque: float) -> np.ndarray:
    """Load (5,) of the gear on its shaft under a torque (N mm) on the wheel, spread evenly over the common face, at the
    pitch point and without friction, on coast flanks if that is negative."""
    names = (*shaft.coordinates[:MOTIONS], "rotation_2")
    # Both lines of action pass through the pitch point.
    normal = coast_normal(pair) if torque < 0.0 else contact_normal(pair)
    row = moved(pair, names, (pair.pitch_point, 0.0), normal)
    # Tilts are arc lengths there.
    scale = np.array([1.0, 1.0, 1.0, *[getattr(pair, shaft.gear).base_radius] * 2])
    return -abs(torque / pair.wheel.base_radius / row[-1]) * row[:-1] * scale


def at_work(shaft: ElasticShaft, load: np.ndarray) -> tuple[Bearing, ...]:
    """The bearings of a shaft under a load (5,) of its gear, rolling ones with their `secant_stiffness`: springs that
    bend and displace the shaft as they would.

    Raises SceneError where no place of the shaft is found that balances the load.
    """
    return _at_work(shaft, tuple(load.tolist())) if np.any(load) else shaft.bearings


# Runs of a search begin with the same shafts under the same load.
@lru_cache(maxsize=256)
def _at_work(shaft: ElasticShaft, load: tuple[float, ...]) -> tuple[Bearing, ...]:
    motions = _balanced(shaft, np.array(load)).reshape(-1, MOTIONS)
    return tuple(
        each if each.rolling is None else replace(each, worked=each.with_axial(secant_stiffness(each.rolling, motion)))
        for each, motion in zip(shaft.bearings, motions)
    )


def _balanced(shaft: ElasticShaft, load: np.ndarray) -> np.ndarray:
    """Motions (5 b,) in the bearings in which a load (5,) of the gear, and the beam between, are in balance.

    The energy of beam and bearings less the load's work has no minimum but this one. It is sought within a trust
    region, and what is left of balance is then driven to round-off by Newton's method.
    """
    flexibility, rigid = shaft.held_flexibility, shaft.rigid_motions
    bearings, count = shaft.bearings, len(flexibility)
    scale = np.tile([1.0, 1.0, 1.0, 1.0 / ARM, 1.0 / ARM], len(bearings) + 1)
    start = np.linalg.solve(shaft.stiffness, load)
    # A place beside the seat does not yield: there it does as little as does not count.
    beam = np.linalg.inv(flexibility + np.diag(YIELDING * scale[:count] ** 2))
    bent = np.hstack([np.eye(count), -rigid])
    of_beam, worked = bent.T @ beam @ bent, np.concatenate([np.zeros(count), load])

    def energy(scaled: np.ndarray) -> tuple[float, np.ndarray]:
        motion = scale * scaled
        stored, loads, _ = _of_all(bearings, motion[:count])
        elastic = of_beam @ motion
        slope = elastic - worked + np.concatenate([loads, np.zeros(MOTIONS)])
        return 0.5 * motion @ elastic + stored - worked @ motion, scale * slope

    def curvature(scaled: np.ndarray) -> np.ndarray:
        found = of_beam.copy()
        found[:count, :count] += _of_all(bearings, scale[:count] * scaled[:count])[2]
        return scale[:, None] * found * scale

    begun = np.concatenate([shaft.bearings_at_rest @ start, start]) / scale
    size = float(np.abs(load).max())
    found = minimize(energy, begun, jac=True, hess=curvature, method="trust-exact", options={"gtol": NEAR * size})
    motion, near = scale * found.x, False
    for _ in range(POLISHED):
        _, loads, stiffness = _of_all(bearings, motion[:count])
        apart, missing = bent @ motion + flexibility @ loads, rigid.T @ loads - load
        # One step after that: a hardly loaded bearing is as stiff as its load divided by a small part of the motion.
        near, before = max(np.abs(apart).max() / np.abs(motion).max(), np.abs(missing).max() / size) <= LEFT, near
        if near and before:
            return motion[:count]
        matrix = np.block(
            [[np.eye(count) + flexibility @ stiffness, -rigid], [rigid.T @ stiffness, np.zeros((MOTIONS,) * 2)]]
        )
        motion = motion - np.linalg.lstsq(matrix, np.concatenate([apart, missing]), rcond=None)[0]
    raise SceneError(
        f"bearings.{shaft.gear}: no place of the shaft was found in which its rolling bearings balance the load. Check"
        " numbers, diameters, contact_angle and clearance of their rolling elements"
    )


def _of_all(bearings: Sequence[Bearing], motions: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Energy, N mm, of all bearings at motions (5 b,) in them, loads (5 b,) on them, and their derivatives
    (5 b, 5 b)."""
    energy, loads, stiffness = 0.0, np.zeros_like(motions), np.zeros((len(motions),) * 2)
    for number, bearing in enumerate(bearings):
        own = slice(MOTIONS * number, MOTIONS * (number + 1))
        motion = motions[own]
        if bearing.rolling is None:
            linear = np.array(bearing.matrix)
        else:
            found, linear = reaction(bearing.rolling, motion), np.diag([0.0, 0.0, bearing.axial_stiffness, 0.0, 0.0])
            energy, loads[own], stiffness[own, own] = energy + found.energy, found.loads, found.stiffness
        pushed = linear @ motion
        energy, loads[own] = energy + 0.5 * float(motion @ pushed), loads[own] + pushed
        stiffness[own, own] += linear
    return energy, loads, stiffness
