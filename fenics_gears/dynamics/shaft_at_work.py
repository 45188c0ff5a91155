"""Elastic shafts under the load of their gears: the gap that they open over the face, and the springs that rolling
bearings then are."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.contact.face import even_slices
from fenics_gears.errors import SceneError
from fenics_gears.geometry.pair import GearPair
from fenics_gears.inputs.problem import NOTHING_DONE

from .elastic_shaft import FIVE, NUMBERS, ElasticShaft, SeatedGear
from .rolling_bearing import MOTIONS, reaction, secant_stiffness
from .shaft_elements import carried
from .shaft_system import ShaftSystem
from .tilting import coast_normal, contact_normal, moved

if TYPE_CHECKING:
    from fenics_gears.inputs.allowed import Matrix

    from .bearings import Bearing

SLICES = 40
# Lever arm, mm, that makes tilts comparable with displacements; mm/N that every bearing yields besides in the search of
# a minimum; parts of the load that the search may leave, and that Newton's method may, with its largest number of
# iterations. Part of the largest stiffness that the search sees in all directions.
ARM = 30.0
YIELDING = 1e-9
NEAR = 1e-6
FREE = 1e-12
LEFT = 1e-11
POLISHED = 30


def middles_of_slices(pair: GearPair, slices: int = SLICES) -> np.ndarray:
    """Middles (slices,), mm, of equal slices of the common face.

    >>> from fenics_gears import gear_pair, load_scene
    >>> pair = gear_pair(load_scene("demos/lundvall2004.toml").gears)
    >>> (middles_of_slices(pair, 2) / pair.face_width).tolist()
    [-0.25, 0.25]
    """
    return even_slices(pair.face_width, slices)[0]


def face_compliance_of_shafts(systems: Iterable[ShaftSystem], pair: GearPair, z: np.ndarray) -> np.ndarray:
    """How far bending shafts move the flanks apart along the face: entry (i, j) is the gap, in mm of the transverse
    section, that opens at z[i] by a transverse force of 1 N at z[j]. z (s,): heights on the common face, mm.

    The force acts along the line of action at the pitch point, without friction. Rotations of whole gears are left out.

    >>> from fenics_gears import gear_pair, load_scene
    >>> pair = gear_pair(load_scene("demos/lundvall2004.toml").gears)
    >>> face_compliance_of_shafts((), pair, middles_of_slices(pair, 2)).tolist()  # rigid shafts
    [[0.0, 0.0], [0.0, 0.0]]
    """
    compliance = np.zeros((len(z), len(z)))
    along = pair.pitch_point, pair.pitch_point - pair.line_of_action_length
    across = -pair.pinion.base_radius, pair.wheel.base_radius
    for system in systems:
        moves = []
        for _, seat in system.seated:
            gear = list(NUMBERS).index(seat.gear)
            sense = (1.0, -1.0)[gear]
            x = along[gear]
            y = across[gear]
            lean = -pair.slope
            row = np.array([1.0, 0.0, lean, y * lean, -x * lean, -y])
            heights = z - pair.gear_middles[gear]
            moves.append(sense * np.einsum("i,sij->sj", row, [carried(each) for each in heights])[:, :FIVE])
            if seat.yields_within:
                compliance += np.einsum("i,sitj,j->st", row, system.seat(seat).whole(heights), row)
        moved_by = np.concatenate(moves, axis=1)
        compliance += moved_by @ np.linalg.solve(system.gear_stiffness, moved_by.T)
    return compliance


def even_load(gear: str, pair: GearPair, torque: float) -> np.ndarray:
    """Load (5,) of the "pinion" or the "wheel" on its shaft under a torque (N mm) on the wheel, spread evenly over the
    common face, at the pitch point and without friction, on coast flanks if that is negative."""
    names = (*SeatedGear(gear, 0.0).of_gear, "rotation_2")
    # Both lines of action pass through the pitch point.
    normal = coast_normal(pair) if torque < 0.0 else contact_normal(pair)
    row = moved(pair, names, (pair.pitch_point, 0.0), normal)
    # Tilts are arc lengths there.
    scale = np.array([1.0, 1.0, 1.0, *[getattr(pair, gear).base_radius] * 2])
    return -abs(torque / pair.wheel.base_radius / row[-1]) * row[:-1] * scale


def at_work(system: ShaftSystem, load: np.ndarray) -> ShaftSystem:
    """Shafts whose rolling bearings have the `secant_stiffness` under a load (5 g,) of their gears: springs that bend
    and displace the shafts as they would.

    Raises SceneError where no place of the shafts is found that balances the load.
    """
    system = replace(system, load=tuple(load.tolist()))
    if not system.in_rolling or not np.any(load):
        return system
    bearings = list(_at_work(system.shafts, system.housing, system.load))
    shafts = [replace(each, bearings=tuple(bearings.pop(0) for _ in each.bearings)) for each in system.shafts]
    return replace(system, shafts=tuple(shafts))


# Runs of a search begin with the same shafts under the same load.
@lru_cache(maxsize=256)
def _at_work(shafts: tuple[ElasticShaft, ...], housing: Matrix | None, load: tuple[float, ...]) -> list[Bearing]:
    system = ShaftSystem(shafts, housing)
    motions = list(_balanced(system, np.array(load)).reshape(-1, MOTIONS))
    return [
        each
        if each.rolling is None
        else replace(each, worked=each.with_axial(secant_stiffness(each.rolling, motions.pop(0))))
        for each in system.bearings
    ]


def _balanced(system: ShaftSystem, load: np.ndarray) -> np.ndarray:
    """Motions (5 r,) in the rolling bearings in which a load (5 g,) of the gears, and the shafts between, are in
    balance.

    The energy of shafts and bearings less the load's work has no minimum but this one. It is sought within a trust
    region, and what is left of balance is then driven to round-off by Newton's method.
    """
    # Imported here: slow to load, and few shafts are on rolling bearings.
    from scipy.optimize import minimize

    free = system.free_of_rolling
    rolling = [each for each in system.bearings if each.rolling is not None]
    rows = free.assembly.numbers(system.in_rolling_motions)
    flexibility = free.flexibility[np.ix_(rows, rows)]
    rigid = free.motions[rows] @ system.rigid
    otherwise = system.rigid.T @ free.stiffness @ system.rigid
    count = len(flexibility)
    scale = np.tile([1.0, 1.0, 1.0, 1.0 / ARM, 1.0 / ARM], (count + len(load)) // MOTIONS)
    start = np.linalg.solve(system.gear_stiffness, load)
    # A bearing at the seat itself does not yield, so that its flexibility has no inverse; so little changes nothing.
    beam = np.linalg.inv(flexibility + np.diag(YIELDING * scale[:count] ** 2))
    bent = np.hstack([np.eye(count), -rigid])
    of_beam = bent.T @ beam @ bent
    of_beam[count:, count:] += otherwise
    worked = np.concatenate([np.zeros(count), load])

    def energy(scaled: np.ndarray) -> tuple[float, np.ndarray]:
        motion = scale * scaled
        stored, loads, _ = _of_all(rolling, motion[:count])
        elastic = of_beam @ motion
        slope = elastic - worked + np.concatenate([loads, np.zeros(len(load))])
        return 0.5 * motion @ elastic + stored - worked @ motion, scale * slope

    def curvature(scaled: np.ndarray) -> np.ndarray:
        matrix = of_beam.copy()
        matrix[:count, :count] += _of_all(rolling, scale[:count] * scaled[:count])[2]
        matrix = scale[:, None] * matrix * scale
        # Within a clearance nothing holds the shaft, and of round-off alone the search finds no end.
        return matrix + FREE * matrix.max() * np.eye(len(scale))

    in_rolling = np.repeat([each.rolling is not None for each in system.bearings], MOTIONS)
    begun = np.concatenate([(system.bearings_at_rest @ start)[in_rolling], start]) / scale
    size = float(np.abs(load).max())
    minimum = minimize(energy, begun, jac=True, hess=curvature, method="trust-exact", options={"gtol": NEAR * size})
    motion = scale * minimum.x
    near = False
    for _ in range(POLISHED):
        _, loads, stiffness = _of_all(rolling, motion[:count])
        apart = bent @ motion + flexibility @ loads
        missing = rigid.T @ loads + otherwise @ motion[count:] - load
        # One step after that: a hardly loaded bearing is as stiff as its load divided by a small part of the motion.
        before = near
        near = max(np.abs(apart).max() / np.abs(motion).max(), np.abs(missing).max() / size) <= LEFT
        if near and before:
            return motion[:count]
        matrix = np.block([[np.eye(count) + flexibility @ stiffness, -rigid], [rigid.T @ stiffness, otherwise]])
        motion = motion - np.linalg.lstsq(matrix, np.concatenate([apart, missing]), rcond=None)[0]
    gears = " and ".join(f"bearings.{shaft.name}" for shaft in system.shafts)
    raise SceneError(
        f"{gears}: no place of the shaft was found in which its rolling bearings balance the load. Check numbers,"
        f" diameters, contact_angle and clearance of their rolling elements. {NOTHING_DONE}"
    )


def _of_all(bearings: Sequence[Bearing], motions: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Energy, N mm, of rolling bearings at motions (5 r,) in them, loads (5 r,) on them, and their derivatives
    (5 r, 5 r)."""
    energy = 0.0
    loads = np.zeros_like(motions)
    stiffness = np.zeros((len(motions),) * 2)
    for number, bearing in enumerate(bearings):
        own = slice(MOTIONS * number, MOTIONS * (number + 1))
        reacted = reaction(bearing.rolling, motions[own])
        axial = np.diag([0.0, 0.0, bearing.axial_stiffness, 0.0, 0.0])
        pushed = axial @ motions[own]
        energy += reacted.energy + 0.5 * float(motions[own] @ pushed)
        loads[own] = reacted.loads + pushed
        stiffness[own, own] = reacted.stiffness + axial
    return energy, loads, stiffness
