"""Rolling bearings: loads of a shaft on a row of balls or rollers for a motion of the shaft in it.

ISO/TS 16281:2008: a ball's load grows with the power 3/2 of how much nearer the centres of curvature of both grooves
are, by Hertz's theory, and its contact angle turns as they move; a roller is cut into slices, each of which has a load
with the power 10/9 of its approach, less the roller's profile. Rings are rigid but for these contacts; centrifugal
forces are left out. The first rolling element stands in the direction of the line of action.

Motions and loads are those of `elastic_shaft.MOTIONS`, in mm, rad, N and N mm.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from itertools import pairwise
from math import cos, log, pi, sin, sqrt
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.special import ellipe, ellipk

from fenics_gears.errors import SceneError

if TYPE_CHECKING:
    from .bearings import RollingBearing

MOTIONS = 5
# Steel on steel, of which rolling bearings are.
YOUNGS_MODULUS = 210e3
POISSONS_RATIO = 0.3
# N/mm^(10/9) of a roller per mm^(8/9) of its length; slices of a roller (ISO/TS 16281, 4.3).
OF_A_ROLLER = 35948.0
SLICES = 30
BALLS_POWER = 1.5
ROLLERS_POWER = 10.0 / 9.0
# Approach, mm, of every rolling element in the bearing whose stiffness stands for it before its load is known.
NOMINAL_APPROACH = 0.01
# Parts of the way from rest to a motion, finer towards its end, since clearances are at its beginning; Gauss points in
# each; and part of the work that they must find.
PARTS = (0.0, *(1.0 - 0.5 ** np.arange(1, 6)), 1.0)
ON_A_PART = 4
SEEN = 0.5


class Reaction(NamedTuple):
    """Energy, N mm, of a bearing, loads (5,) of the shaft on it, their derivatives (5, 5) by its motions, and the
    largest force of a rolling element, N."""

    energy: float
    loads: np.ndarray
    stiffness: np.ndarray
    largest: float


def reaction(rolling: RollingBearing, motion: np.ndarray) -> Reaction:
    """What a bearing that is braced by its preload, if it has one, does about a motion (5,) of the shaft in it.

    >>> from fenics_gears.dynamics.bearings import RollingBearing
    >>> bearing = RollingBearing(number=9, diameter=12.7, pitch_diameter=65.0)
    >>> round(float(reaction(bearing, np.array([0.05, 0.0, 0.0, 0.0, 0.0])).loads[0]))  # N at 50 um
    8056
    """
    braced = _braced(rolling)
    braced_reaction = _reaction(rolling, motion + braced)
    if not braced.any():
        return braced_reaction
    rest = _reaction(rolling, braced)
    energy = braced_reaction.energy - rest.energy - float(rest.loads @ motion)
    return braced_reaction._replace(energy=energy, loads=braced_reaction.loads - rest.loads)


def secant_stiffness(rolling: RollingBearing, motion: np.ndarray) -> np.ndarray:
    """Stiffness (5, 5), symmetric and not negative, that gives the bearing's loads at a motion (5,) from none at rest:
    the mean of its stiffness on the way there, of which the rest that a quadrature leaves is made up for as in the
    method of Broyden, Fletcher, Goldfarb and Shanno."""
    at_motion = reaction(rolling, motion)
    mean = np.zeros((MOTIONS, MOTIONS))
    points, weights = np.polynomial.legendre.leggauss(ON_A_PART)
    for begin, end in pairwise(PARTS):
        for point, weight in zip(points, weights):
            place = 0.5 * (begin + end) + 0.5 * (end - begin) * point
            mean += 0.5 * (end - begin) * weight * reaction(rolling, place * motion).stiffness
    work = float(motion @ at_motion.loads)
    if work <= 0.0:
        return mean
    if motion @ mean @ motion < SEEN * work:
        # The clearance is nearly all of the way.
        mean = at_motion.stiffness
    spring = mean @ motion
    return mean - np.outer(spring, spring) / (motion @ spring) + np.outer(at_motion.loads, at_motion.loads) / work


def nominal_stiffness(rolling: RollingBearing) -> np.ndarray:
    """Stiffness (5, 5) at rest with every rolling element pressed alike by an interference."""
    return _reaction(replace(rolling, clearance=-2.0 * NOMINAL_APPROACH), np.zeros(MOTIONS)).stiffness


@cache
def _braced(rolling: RollingBearing) -> np.ndarray:
    """Axial motion, as (5,), by which the preload displaces the inner ring."""
    if not rolling.preload:
        return np.zeros(MOTIONS)
    axis = np.eye(MOTIONS)[2]
    far = rolling.diameter

    def missing(distance: float) -> float:
        return _reaction(rolling, np.copysign(distance, rolling.contact_angle) * axis).loads[2] - rolling.bracing

    if missing(0.0) * missing(far) > 0.0:
        raise SceneError(f"bearings: no axial motion gives a preload of {rolling.preload:g} N; lower it")
    return np.copysign(_root(missing, 0.0, far, xtol=1e-15, rtol=1e-15), rolling.contact_angle) * axis


def _reaction(rolling: RollingBearing, motion: np.ndarray) -> Reaction:
    return (_of_rollers if rolling.rollers else _of_balls)(rolling, motion)


def _angles(rolling: RollingBearing) -> np.ndarray:
    """Where the rolling elements stand (n,), rad from the line of action."""
    return 2.0 * pi * np.arange(rolling.number) / rolling.number


def _rows(angles: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Radial and axial displacement, at a radius (mm) on the inner ring, and its tilt towards the axis (n, 5) per
    motion of the shaft."""
    c = np.cos(angles)
    s = np.sin(angles)
    nothing = np.zeros_like(angles)
    radial = np.stack([c, s, nothing, nothing, nothing], axis=1)
    tilt = np.stack([nothing, nothing, nothing, -s, c], axis=1)
    axial = np.stack([nothing, nothing, np.ones_like(angles), nothing, nothing], axis=1) - radius * tilt
    return radial, axial, tilt


def _of_balls(rolling: RollingBearing, motion: np.ndarray) -> Reaction:
    """ISO/TS 16281, 4.2: the distance of the grooves' centres of curvature, less that of balls without load."""
    inner, outer = rolling.grooves
    free = inner + outer - rolling.diameter
    angle = rolling.contact_angle
    pitch = 0.5 * rolling.pitch_diameter + (inner - 0.5 * rolling.diameter) * cos(angle)
    radial, axial, _ = _rows(_angles(rolling), pitch)
    across = free * cos(angle) - 0.5 * rolling.clearance + radial @ motion
    along = free * sin(angle) + axial @ motion
    distance = np.hypot(across, along)
    approach = np.maximum(distance - free, 0.0)
    constant = _spring_of_ball(rolling)
    force = constant * approach**BALLS_POWER
    slope = BALLS_POWER * constant * approach ** (BALLS_POWER - 1.0)
    # Direction of each ball's force, and how it turns.
    normal = (across[:, None] * radial + along[:, None] * axial) / distance[:, None]
    turned = (along[:, None] * radial - across[:, None] * axial) / distance[:, None]
    stiffness = (normal.T * slope) @ normal + (turned.T * (force / distance)) @ turned
    energy = constant / (BALLS_POWER + 1.0) * float((approach ** (BALLS_POWER + 1.0)).sum())
    return Reaction(energy, normal.T @ force, stiffness, float(force.max()))


@cache
def _spring_of_ball(rolling: RollingBearing) -> float:
    """Force, N/mm^(3/2), of a ball between both rings by Hertz's theory (ISO/TS 16281, 4.2.1; its 1.48 is
    sqrt(2) pi/3)."""
    ratio = rolling.diameter * cos(rolling.contact_angle) / rolling.pitch_diameter
    approach = 0.0
    for sign, groove in zip((1.0, -1.0), rolling.grooves):
        rolled = sign * ratio / (1.0 - sign * ratio)
        held = rolling.diameter / (2.0 * groove)
        total = 2.0 + rolled - held
        difference = (rolled + held) / (2.0 + rolled - held)
        slender = _axes_of_ellipse(difference)
        parameter = 1.0 - 1.0 / slender**2
        curvature = 2.0 / rolling.diameter * total
        approach += ellipk(parameter) * (curvature / (slender**2 * ellipe(parameter))) ** (1.0 / 3.0)
    plane_modulus = YOUNGS_MODULUS / (1.0 - POISSONS_RATIO**2)
    return sqrt(2.0) * pi / 3.0 * plane_modulus * approach**-1.5


def _axes_of_ellipse(difference: float) -> float:
    """Ratio of the axes of Hertz's contact ellipse between bodies of a relative difference of curvatures."""

    def missing(logarithm: float) -> float:
        squared = np.exp(2.0 * logarithm)
        parameter = 1.0 - 1.0 / squared
        return 1.0 - 2.0 / (squared - 1.0) * (ellipk(parameter) / ellipe(parameter) - 1.0) - difference

    return float(np.exp(_root(missing, 1e-4, log(1e6), xtol=1e-14)))


def _of_rollers(rolling: RollingBearing, motion: np.ndarray) -> Reaction:
    """ISO/TS 16281, 4.3, with the rollers' axes inclined by the contact angle: the approach of each slice."""
    angle = rolling.contact_angle
    constant = OF_A_ROLLER * rolling.length ** (8.0 / 9.0) / SLICES
    radial, axial, tilt = _rows(_angles(rolling), 0.5 * rolling.pitch_diameter)
    places = ((np.arange(SLICES) + 0.5) / SLICES - 0.5) * rolling.length
    normal = cos(angle) * radial + sin(angle) * axial
    rows = normal[:, None, :] + places[None, :, None] * tilt[:, None, :]
    lacking = 0.5 * rolling.clearance * cos(angle) + 2.0 * _profile(rolling, places)
    approach = np.maximum(rows @ motion - lacking, 0.0)
    force = constant * approach**ROLLERS_POWER
    slope = np.zeros_like(approach)
    closed = approach > 0.0
    slope[closed] = ROLLERS_POWER * constant * approach[closed] ** (ROLLERS_POWER - 1.0)
    stiffness = np.einsum("jki,jk,jkl->il", rows, slope, rows)
    energy = constant / (ROLLERS_POWER + 1.0) * float((approach ** (ROLLERS_POWER + 1.0)).sum())
    return Reaction(energy, np.einsum("jki,jk->i", rows, force), stiffness, float(force.sum(axis=1).max()))


def _profile(rolling: RollingBearing, places: np.ndarray) -> np.ndarray:
    """What rollers lack at places (s,), mm, along their axes, on each ring (ISO/TS 16281, 4.3.3; of tapered rollers the
    profile of 4.3.3 for these)."""
    length = rolling.length
    straight = max(rolling.length - 2.5 * rolling.diameter, 0.0)
    amount = 0.00045 if rolling.contact_angle else 0.0005 if straight else 0.00035
    if rolling.contact_angle:
        straight = 0.0
    beyond = np.maximum(2.0 * np.abs(places) - straight, 0.0) / (length - straight)
    return -amount * rolling.diameter * np.log1p(-(beyond**2))


def _root(function: Callable[[float], float], low: float, high: float, **tolerances: float) -> float:
    # It loads in 50 ms, which shafts without such bearings do not wait for.
    from scipy.optimize import brentq

    return brentq(function, low, high, **tolerances)
