"""The drivetrain of model.md section 4: masses, shafts, bearings and load over those centre coordinates that move.

Rotations are carried as arc lengths rb phi (mm), so that all coordinates are lengths and all rows forces.
Mass and moment of inertia of a gear are given, or follow from its cross-section and a density.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf, isfinite
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.contact.kinematics import COORDINATES, FACE_COORDINATES
from fenics_gears.errors import SceneError
from fenics_gears.geometry.pair import GearPair

from .damping import Damping
from .inertia import Inertia

if TYPE_CHECKING:
    from fenics_gears.effects.bearings import Bearings
    from fenics_gears.effects.shafts import Shafts
    from fenics_gears.geometry.gear_data import LumpedGear

    from .elastic_shaft import ElasticShaft
    from .rolling_springs import RollingSprings
    from .shaft_system import ShaftSystem
    from .tilting import MeshOverFace

# The load's moment of inertia over the wheel's, at most: their sum keeps six digits of the wheel's.
MOST_OF_WHEEL = 1e10
FREE = {"rotation_1": "the pinion", "rotation_2": "the wheel"}
# Each centre's translations: of which gear, in which direction.
TRANSLATIONS = {
    f"centre_{axis}{number}": (gear, axis) for gear, number in (("pinion", 1), ("wheel", 2)) for axis in "xy"
}
# Each coordinate's gear, with the shaft and the bearings that are on its side of the mesh.
SIDE = {name: "pinion" if name.endswith("1") else "wheel" for name in COORDINATES}
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
class Drivetrain:
    """Equations of motion [26]-[28] without the contact forces, over k of the centre coordinates.

    `coordinates`: their names; `radii` (k,): mm per rad of a rotation, 1 for a translation; `stiffness` (k, k), N/mm;
    `load` (k,), N; `mass` (k, k), N s^2/mm, and `damping` (k, k), N s/mm, or None where the scene has none. `mesh`: how
    the coordinates move flanks that have a width; None in the plane. `systems`: of the shafts that also bend, and
    `bearing_stiffness` (k, k), N/mm, the part of the stiffness that is in the bearings. `of_the_coupling` (k,),
    N s^2/mm: mass of an elastic input shaft that turns with its coupling, whose rotation is prescribed. `rolling`: by
    how much bearings depart from the stiffness that the matrix has for them, None where none does.
    """

    coordinates: tuple[str, ...]
    radii: np.ndarray
    stiffness: np.ndarray
    load: np.ndarray
    mass: np.ndarray | None
    damping: np.ndarray | None
    mesh: MeshOverFace | None = None
    systems: tuple[ShaftSystem, ...] = ()
    bearing_stiffness: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))
    of_the_coupling: np.ndarray | float = 0.0
    rolling: RollingSprings | None = None

    @property
    def indices(self) -> list[int]:
        """Positions of the coordinates among COORDINATES; modes of shafts, which contact does not move, are beyond."""
        known = [COORDINATES.index(name) for name in self.coordinates if name in COORDINATES]
        return [*known, *range(len(COORDINATES), len(COORDINATES) + len(self.coordinates) - len(known))]

    @property
    def elastic(self) -> tuple[ElasticShaft, ...]:
        """The shafts that also bend."""
        return tuple(shaft for system in self.systems for shaft in system.shafts)

    @property
    def bearings(self) -> int:
        """Number of the bearings of shafts that also bend."""
        return sum(len(shaft.bearings) for shaft in self.elastic)

    @property
    def modes(self) -> int:
        """How many of the coordinates, the last ones, are motions in rolling bearings and modes of shafts, which no
        contact moves."""
        return sum(len(system.modes) for system in self.systems)

    @cached_property
    def bending_faces(self) -> np.ndarray:
        """Stiffness and flexibility (2, f, f), N/mm, of the faces that bend by coordinates of their own."""
        own = [self.coordinates.index(name) for shaft in self.elastic for name in shaft.of_face]
        of_faces = self.stiffness[np.ix_(own, own)]
        return np.stack([of_faces, np.linalg.inv(of_faces)])

    @cached_property
    def stiffness_at_work(self) -> np.ndarray:
        """Stiffness (k, k), N/mm, against small motions about the place under an even load."""
        if self.rolling is None:
            return self.stiffness
        return self.stiffness + self.rolling.departure(self.rolling.reference).stiffness

    def elastic_forces(self, coordinates: np.ndarray) -> np.ndarray:
        """Forces (k,), N, of all springs at coordinates (k,)."""
        found = self.stiffness @ coordinates
        return found if self.rolling is None else found + self.rolling.departure(coordinates).forces

    @property
    def right_up_to(self) -> float:
        """Frequency (Hz) up to which natural frequencies are right: half of that beyond which modes of shafts are left
        out."""
        return min((0.5 * shaft.up_to for shaft in self.elastic), default=inf)

    @property
    def driven_backwards(self) -> bool:
        """Whether the load drives the pair from the wheel."""
        return bool(self.load[self.coordinates.index("rotation_2")] < 0.0)

    @cached_property
    def free_motion(self) -> np.ndarray:
        """How the load moves the drivetrain (k,) where, without mass, only contact holds it; empty where its stiffness
        does."""
        values, vectors = np.linalg.eigh(self.stiffness)
        if values[0] > 1e-14 * max(values[-1], 0.0) and values[-1] > 0.0:
            return np.empty(0)
        motion = vectors[:, 0]
        along = motion @ self.load or -motion[self.coordinates.index("rotation_2")]
        return motion * np.sign(along)

    @property
    def free_words(self) -> str:
        """The free motion and the load that works on it, in words; empty where there is none."""
        motion = self.free_motion
        if not len(motion):
            return ""
        turning = int(np.argmax(np.abs(motion)))
        torque = 1e-3 * self.load[turning] * self.radii[turning]
        name = FREE.get(self.coordinates[turning], "the drivetrain")
        return f"{name} turns freely under its torque of {torque:.4g} N m"

    def value(self, states: np.ndarray, name: str) -> np.ndarray:
        """Coordinate `name`, or "shaft_end" (phi3), of states (..., k), in mm or rad; zero where the scene holds it
        fixed."""
        if name == "shaft_end":
            return self.value(states, "rotation_2") + self.value(states, "shaft_twist")
        if name not in self.coordinates:
            return np.zeros(states.shape[:-1])
        position = self.coordinates.index(name)
        return states[..., position] / self.radii[position]


@dataclass(frozen=True)
class Supports:
    """Shafts, bearings, masses and damping of a drivetrain, None where a scene has none; `gears`: "pinion" and "wheel"
    as lumped masses; `systems`: those of shafts that also bend, `even_loads` (5,): of their gears, where bearings
    roll."""

    shafts: Shafts | None = None
    bearings: Bearings | None = None
    inertia: Inertia | None = None
    gears: Mapping[str, LumpedGear] = field(default_factory=dict)
    damping: Damping | None = None
    systems: tuple[ShaftSystem, ...] = ()
    even_loads: tuple[np.ndarray, ...] = ()


def assembled(pair: GearPair, wheel_torque: float, supports: Supports, mesh_stiffness: float) -> Drivetrain:
    """The drivetrain of a pair under a torque (N mm) on the wheel's shaft; coordinates that cannot move do not appear.

    `mesh_stiffness`, N/mm: of one tooth pair, roughly; damping ratios are of the modes with it. Raises SceneError for a
    load beside which the wheel's own moment of inertia is lost in round-off.
    """
    names = _moving_coordinates(supports)
    arms = {name: getattr(pair, gear_of(name)).base_radius if name.startswith(ARCS) else 1.0 for name in names}
    radii = np.array([*arms.values()])
    stiffness, mass, mesh = np.zeros((len(names), len(names))), None, None
    if supports.bearings is not None:
        for name, side in TRANSLATIONS.items():
            if (own := supports.bearings.of(*side)) is not None:
                stiffness[names.index(name), names.index(name)] = own
        if supports.bearings.places is not None:
            from .tilting import add_bearings

            add_bearings(stiffness, names, supports.bearings)
    in_bearings = stiffness.copy()
    for system in supports.systems:
        bent = [names.index(name) for name in system.coordinates]
        stiffness[np.ix_(bent, bent)] += system.stiffness
        in_bearings[np.ix_(bent, bent)] += system.bearing_stiffness
    for name, torsion in _torsion(supports).items():
        stiffness[names.index(name), names.index(name)] += torsion
    coupling: np.ndarray | float = 0.0
    if supports.inertia is not None:
        mass = _mass(names, supports.inertia, supports.gears)
        for system in supports.systems:
            own_mass, momentum = system.mass_over(names)
            mass += own_mass
            # Turned by the pinion's base pitch, as its own rotation is.
            coupling = coupling + momentum / pair.pinion.base_radius
    scale = np.outer(1.0 / radii, 1.0 / radii)
    stiffness, mass = stiffness * scale, None if mass is None else mass * scale
    if mass is not None and (pair.slope or not set(names).isdisjoint(FACE_COORDINATES)):
        from .tilting import mesh_over_face

        mesh = mesh_over_face(pair, names)
    load = forces_of_torque(names, radii, wheel_torque)
    in_bearings, coupling = in_bearings * scale, coupling / radii
    undamped = Drivetrain(names, radii, stiffness, load, mass, None, mesh, supports.systems, in_bearings, coupling)
    if supports.even_loads:
        from .rolling_springs import springs_of

        undamped = replace(undamped, rolling=springs_of(undamped, supports.even_loads))
    damping = None
    if supports.damping is not None and mass is not None:
        damping = _damping(supports.damping, undamped, mesh_stiffness)
    for system in supports.systems:
        if mass is not None and system.damping.any():
            bent = [names.index(name) for name in system.coordinates]
            own = np.zeros_like(stiffness)
            own[np.ix_(bent, bent)] = system.damping
            damping = own * scale + (0.0 if damping is None else damping)
    return replace(undamped, damping=damping)


def forces_of_torque(names: tuple[str, ...], radii: np.ndarray, torque: float) -> np.ndarray:
    """Forces (k,), N, of a torque (N mm) on the output shaft's end, which moves with the wheel and with the twist."""
    return np.array([torque if name in ("rotation_2", "shaft_twist") else 0.0 for name in names]) / radii


def _moving_coordinates(supports: Supports) -> tuple[str, ...]:
    moving = {"rotation_2", *_torsion(supports)}
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
    return {name for name in tilting if _kind(name) == "tilt" or bearings.axial(SIDE[name]) is not None}


def _kind(name: str) -> str:
    """First word of a coordinate's name."""
    return name.partition("_")[0]


def gear_of(name: str) -> str:
    """Gear on whose side of the mesh a coordinate is; the name of a mode ends with it."""
    return SIDE.get(name) or name.rpartition("_")[2]


def _torsion(supports: Supports) -> dict[str, float]:
    """Torsional stiffness (N mm/rad) of the shafts that twist, by coordinate: the input shaft's between the prescribed
    rotation and phi1; the output shaft's, whose twist is phi3 - phi2 [4]-[6]."""
    found = {}
    for name, shaft in (("rotation_1", "input"), ("shaft_twist", "output")) if supports.shafts is not None else ():
        bent = [
            system.torsional_stiffness(each)
            for system in supports.systems
            for each in system.shafts
            if each.gear == SIDE[name]
        ]
        torsion = bent[0] if bent else supports.shafts.of(shaft)
        if torsion is not None and isfinite(torsion):
            found[name] = torsion
    return found


def _mass(names: tuple[str, ...], inertia: Inertia, gears: Mapping[str, LumpedGear]) -> np.ndarray:
    """Lumped masses; J3 phi3'' with phi3 = phi2 + twist couples the wheel's rotation with the twist."""
    end = inertia.shaft_end
    of_gears = {name: getattr(gears[SIDE[name]], MOVED[_kind(name)]) for name in names if name in SIDE}
    lumped = dict.fromkeys(names, 0.0) | of_gears
    mass, second = np.diag([lumped[name] for name in names]), names.index("rotation_2")
    if "shaft_twist" in names:
        _check_load(end, lumped["rotation_2"])
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


def _damping(damping: Damping, undamped: Drivetrain, mesh_stiffness: float) -> np.ndarray:
    """D (k, k): alpha K + beta M of either shaft, or by the ratios of the modes with one tooth pair in mesh."""
    if damping.modal:
        from .modal_damping import modal_damping

        return modal_damping(undamped, mesh_stiffness, damping.modal)
    # No spring and no mass connects both sides of the mesh: a row and its column have the same factors.
    alpha, beta = np.array([damping.rayleigh(gear_of(name)) for name in undamped.coordinates]).T[:, :, None]
    return alpha * undamped.stiffness_at_work + beta * undamped.mass
