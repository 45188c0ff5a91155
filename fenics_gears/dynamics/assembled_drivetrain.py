"""A drivetrain put together of shafts, bearings, masses and damping.

Mass and moment of inertia of a gear are given, or follow from its cross-section and a density.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.contact.kinematics import COORDINATES, FACE_COORDINATES
from fenics_gears.errors import SceneError
from fenics_gears.geometry.pair import GearPair
from fenics_gears.inputs.tree import GEARS

from .damping import Damping, damping_of
from .drivetrain import ROTATIONS, SIDE, Drivetrain, forces_of_torque, gear_of, kind_of
from .inertia import Inertia

if TYPE_CHECKING:
    from fenics_gears.geometry.gear_data import LumpedGear

    from .bearings import Bearings
    from .shaft_system import ShaftSystem
    from .shafts import Shafts

# The load's moment of inertia over the wheel's, at most: their sum keeps six digits of the wheel's.
MOST_OF_WHEEL = 1e10
# Each centre's translations: of which gear, in which direction.
TRANSLATIONS = {f"centre_{axis}{number}": (gear, axis) for number, gear in enumerate(GEARS, 1) for axis in "xy"}
# What of a gear is moved, by the first word of the coordinate's name.
MOVED = {
    "centre": "mass",
    "axial": "mass",
    "rotation": "moment_of_inertia",
    "shaft": "moment_of_inertia",
    "tilt": "tilting_inertia",
}
# Beginnings of the names of rotations that are carried as arc lengths.
ARCS = ("rotation", "shaft", "tilt", "face_tilt", "face_turn")


@dataclass(frozen=True)
class Supports:
    """Shafts, bearings, masses and damping of a drivetrain, None where a scene has none; `gears`: "pinion" and "wheel"
    as lumped masses; `systems`: those of shafts that also bend."""

    shafts: Shafts | None = None
    bearings: Bearings | None = None
    inertia: Inertia | None = None
    gears: Mapping[str, LumpedGear] = field(default_factory=dict)
    damping: Damping | None = None
    systems: tuple[ShaftSystem, ...] = ()


def assembled(pair: GearPair, wheel_torque: float, supports: Supports, mesh_stiffness: float) -> Drivetrain:
    """The drivetrain of a pair under a torque (N mm) on the wheel's shaft; coordinates that cannot move do not appear.

    `mesh_stiffness`, N/mm: of one tooth pair, roughly; damping ratios are of the modes with it. Raises SceneError for a
    load beside which the wheel's own moment of inertia is lost in round-off.
    """
    names = _moving_coordinates(supports)
    radii = np.array([getattr(pair, gear_of(name)).base_radius if name.startswith(ARCS) else 1.0 for name in names])
    scale = np.outer(1.0 / radii, 1.0 / radii)
    stiffness, in_bearings = _stiffness(names, supports)
    mass = mesh = None
    coupling = np.zeros(len(names))
    if supports.inertia is not None:
        mass, coupling = _mass_of_all(names, supports)
        mass = scale * mass
        # Turned by the pinion's base pitch, as its own rotation is.
        coupling = coupling / pair.pinion.base_radius / radii
        if pair.slope or not set(names).isdisjoint(FACE_COORDINATES):
            from .tilting import mesh_over_face

            mesh = mesh_over_face(pair, names)
    load = forces_of_torque(names, radii, wheel_torque)
    seats = tuple(seat for system in supports.systems for seat in system.yielding)
    undamped = Drivetrain(
        names,
        radii,
        scale * stiffness,
        load,
        mass,
        None,
        mesh,
        supports.systems,
        scale * in_bearings,
        coupling,
        seats=seats,
    )
    if supports.systems:
        from .rolling_springs import springs_of

        undamped = replace(undamped, rolling=springs_of(undamped))
    if mass is None:
        return undamped
    of_elements = sum(scale * each.over(each.motions_of_pair(names), "damping") for each in supports.systems)
    return replace(undamped, damping=damping_of(undamped, supports.damping, mesh_stiffness, of_elements))


def _stiffness(names: tuple[str, ...], supports: Supports) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness (k, k) of all springs, in N, mm and rad, and the part of it that is in bearings."""
    stiffness = np.zeros((len(names), len(names)))
    if supports.bearings is not None:
        for name, side in TRANSLATIONS.items():
            if (own := supports.bearings.of(*side)) is not None:
                stiffness[names.index(name), names.index(name)] = own
        if supports.bearings.places is not None:
            from .tilting import add_bearings

            add_bearings(stiffness, names, supports.bearings)
    in_bearings = stiffness.copy()
    for system in supports.systems:
        moved = system.motions_of_pair(names)
        stiffness += system.over(moved, "stiffness")
        in_bearings += system.over(moved, "bearing_stiffness")
    for name, torsion in _torsion(supports).items():
        stiffness[names.index(name), names.index(name)] += torsion or 0.0
    return stiffness, in_bearings


def _mass_of_all(names: tuple[str, ...], supports: Supports) -> tuple[np.ndarray, np.ndarray]:
    """Mass (k, k) of gears, load and shafts, and momentum (k,) of input shafts per speed of their coupling."""
    mass = _mass(names, supports.inertia, supports.gears)
    coupling = np.zeros(len(names))
    for system in supports.systems:
        mass += system.over(system.motions_of_pair(names), "mass")
        coupling += system.momentum_of_coupling(names)
    return mass, coupling


def _moving_coordinates(supports: Supports) -> tuple[str, ...]:
    moving = {ROTATIONS[1], *_torsion(supports)}
    if supports.bearings is not None:
        moving.update(name for name, side in TRANSLATIONS.items() if supports.bearings.of(*side) is not None)
        moving.update(_leaning(supports.bearings))
    moving.update(name for system in supports.systems for name in system.moved)
    of_faces = (name for system in supports.systems for name in system.moved if name not in COORDINATES)
    modes = (name for system in supports.systems for name in system.modes)
    return (*(name for name in COORDINATES if name in moving), *of_faces, *modes)


def _leaning(bearings: Bearings) -> set[str]:
    """The coordinates of gears whose bearings have places: tilts, and the axial one where the shaft is not held."""
    tilting = [name for name in FACE_COORDINATES if bearings.places_of(SIDE[name]) is not None]
    return {name for name in tilting if kind_of(name) == "tilt" or bearings.axial(SIDE[name]) is not None}


def _torsion(supports: Supports) -> dict[str, float | None]:
    """The shafts that twist, by coordinate, and their torsional stiffness (N mm/rad), None of one that bends: the input
    shaft's between the prescribed rotation and phi1; the output shaft's, whose twist is phi3 - phi2 [4]-[6]."""
    if supports.shafts is None:
        return {}
    bent = {shaft.name: shaft for system in supports.systems for shaft in system.shafts}
    stiffnesses: dict[str, float | None] = {}
    for name, shaft in ((ROTATIONS[0], "input"), ("shaft_twist", "output")):
        own = bent.get(SIDE[name])
        torsion = None if own is not None else supports.shafts.of(shaft)
        if torsion is not None or own is not None and own.coupled is None:
            stiffnesses[name] = torsion
    return stiffnesses


def _mass(names: tuple[str, ...], inertia: Inertia, gears: Mapping[str, LumpedGear]) -> np.ndarray:
    """Lumped masses; J3 phi3'' with phi3 = phi2 + twist couples the wheel's rotation with the twist."""
    end = inertia.shaft_end
    of_gears = {name: getattr(gears[SIDE[name]], MOVED[kind_of(name)]) for name in names if name in SIDE}
    lumped = dict.fromkeys(names, 0.0) | of_gears
    mass = np.diag([lumped[name] for name in names])
    second = names.index(ROTATIONS[1])
    if "shaft_twist" in names:
        _check_load(end, lumped[ROTATIONS[1]])
        twist = names.index("shaft_twist")
        mass[twist, twist] = end
        mass[second, second] += end
        mass[second, twist] = mass[twist, second] = end
    elif inertia.load is not None:
        mass[second, second] += inertia.load.moment_of_inertia
    return mass


def _check_load(end: float, wheel: float) -> None:
    """Raise SceneError for a load (N mm s^2) beside which the wheel's own moment of inertia is round-off."""
    if end > MOST_OF_WHEEL * wheel:
        raise SceneError(
            f"inertia.load: a moment of inertia of {end / wheel:.3g} times the wheel's; allowed are up to"
            f" {MOST_OF_WHEEL:g} times, beyond which the far end of the output shaft stands still all the same. Lower"
            " inertia.load.moment_of_inertia, or raise that of [inertia.wheel]"
        )
