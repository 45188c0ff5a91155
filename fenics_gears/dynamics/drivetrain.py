"""The equations of motion of model.md section 4 over those centre coordinates that move.

Rotations are carried as arc lengths rb phi (mm), so that all coordinates are lengths and all rows forces.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from math import inf
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fenics_gears.contact.kinematics import COORDINATES
from fenics_gears.inputs.tree import GEARS

if TYPE_CHECKING:
    from .elastic_shaft import ElasticShaft
    from .rolling_springs import RollingSprings
    from .seat_of_mesh import SeatOfMesh
    from .shaft_system import ShaftSystem

# Of the driving and of the driven gear.
ROTATIONS = ("rotation_1", "rotation_2")
# Each coordinate's gear, with the shaft and the bearings that are on its side of the mesh.
SIDE = {name: GEARS[0 if name.endswith("1") else 1] for name in COORDINATES}


@dataclass(frozen=True)
class MeshSprings:
    """Displacement of flanks per coordinate: along the contact normal, `normals` (r, k), of each mesh or, over a face,
    at two heights in each, and off the line of action, `across` (f, k).

    The heights are those of two springs that together act as a mesh stiffness spread evenly over the face, in force and
    in moment.
    """

    normals: np.ndarray
    across: np.ndarray


class TurningFrame(NamedTuple):
    """What the frame of a drivetrain brings that turns, at the speed at which a run starts: a skew matrix of velocities
    `gyroscopic` (k, k), N s/mm; and, by the square of the speed, a stiffness that is off, `softening` (k, k), N/mm, and
    a `load` (k,), N. `step`, s: a whole step at that speed."""

    gyroscopic: np.ndarray
    softening: np.ndarray
    load: np.ndarray
    step: float


@dataclass(frozen=True)
class Drivetrain:
    """Equations of motion [26]-[28] without the contact forces, over the k coordinates of a train of gears.

    `coordinates`: their names; `radii` (k,): mm per rad of a rotation, 1 for a translation; `stiffness` (k, k), N/mm;
    `load` (k,), N; `mass` (k, k), N s^2/mm, and `damping` (k, k), N s/mm, or None where the scene has none. `mesh`: how
    the coordinates move flanks. `systems`: of the shafts that also bend, and `bearing_stiffness` (k, k), N/mm, the part
    of the stiffness that is in the bearings. `rolling`: by how much bearings depart from the stiffness that the matrix
    has for them, None where none does. `seats`: those of the gears that give way. `frame`: in which it is,
    None where that stands; what it brings at the start is part of stiffness and load.

    `motions` (f, k): those of shafts that turn together, which without mass some meshes alone hold. `angle` (k,):
    rotation (rad) of the last shaft; `of_meshes`: of each mesh, how its own coordinates (l, k) follow; `ends`: by mesh,
    rotation (k,), rad, of the load on the shaft that it drives. `nominal_momentum` (k,), N s: of all masses, as the
    first shaft turns by 1 rad/s and all others with it; none without mass. `of_members` (3, k), rad/mm: of a planetary
    set with inertia, rotations of its members, counter-clockwise.
    """

    coordinates: tuple[str, ...]
    radii: np.ndarray
    stiffness: np.ndarray
    load: np.ndarray
    mass: np.ndarray | None
    damping: np.ndarray | None
    mesh: MeshSprings | None = None
    systems: tuple[ShaftSystem, ...] = ()
    bearing_stiffness: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))
    rolling: RollingSprings | None = None
    seats: tuple[SeatOfMesh, ...] = ()
    frame: TurningFrame | None = None
    motions: tuple[tuple[float, ...], ...] = ()
    angle: np.ndarray = field(default_factory=lambda: np.zeros(0))
    of_meshes: tuple[np.ndarray, ...] = ()
    ends: tuple[np.ndarray, ...] = ()
    nominal_momentum: np.ndarray = field(default_factory=lambda: np.zeros(0))
    of_members: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))

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
    def of_gears(self) -> list[str]:
        """Names of the coordinates but modes of shafts and motions in bearings and faces."""
        others = "bearing_", "face_"
        return [name for name in self.coordinates if "_mode_" not in name and not name.startswith(others)]

    @property
    def modes(self) -> int:
        """How many of the coordinates, the last ones, are motions in rolling bearings and modes of shafts, which no
        contact moves."""
        return sum(len(system.modes) for system in self.systems)

    @cached_property
    def bending_faces(self) -> np.ndarray:
        """Stiffness and flexibility (2, f, f), N/mm, of the faces that bend by coordinates of their own."""
        own = [self.coordinates.index(name) for seat in self.seats for name in seat.of_face]
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
    def driven(self) -> int:
        """Which of the coordinates is the rotation of the driven gear."""
        return self.coordinates.index(ROTATIONS[1])

    @property
    def nominal_motion(self) -> np.ndarray:
        """How the coordinates (k,) move, mm, as both gears turn by arcs of 1 mm, the driven one backwards."""
        arcs = dict(zip(ROTATIONS, (1.0, -1.0)))
        return np.array([arcs.get(name, 0.0) for name in self.coordinates])

    @property
    def driven_backwards(self) -> bool:
        """Whether the load drives the pair from the wheel."""
        return bool(self.load[self.driven] < 0.0)

    @property
    def free_motion(self) -> np.ndarray:
        """The motions that without mass some meshes alone hold, (f k,); without any load backwards."""
        return np.array(self.motions).ravel() * (1.0 if np.any(self.load) else -1.0)

    @property
    def free_words(self) -> str:
        """What turns freely where a mesh opens, and the load that works on it, in words."""
        if not self.motions or not all(float(self.angle @ each) for each in self.motions):
            return "the gears behind a mesh turn freely under their torque"
        motion = max(self.motions, key=lambda each: abs(float(self.angle @ each)))
        torque = 1e-3 * float(self.load @ motion) / float(self.angle @ motion)
        last = "wheel" if len(self.ends) == 1 else "last gear"
        return f"the {last} turns freely under its torque of {torque:.4g} N m"

    def value(self, states: np.ndarray, name: str) -> np.ndarray:
        """Coordinate `name`, or "shaft_end" (phi3), of states (..., k), in mm or rad; zero where the scene holds it
        fixed."""
        if name == "shaft_end":
            return self.value(states, ROTATIONS[1]) + self.value(states, "twist_2")
        if name not in self.coordinates:
            return np.zeros(states.shape[:-1])
        position = self.coordinates.index(name)
        return states[..., position] / self.radii[position]

    def values(self, states: np.ndarray, names: Iterable[str]) -> np.ndarray:
        """Several coordinates (..., n) of states, as `value` gives each."""
        return np.stack([self.value(states, name) for name in names], axis=-1)

    def bearing_loads(self, states: np.ndarray) -> np.ndarray:
        """Loads (steps, bearings, 5), N and N mm, of shafts that bend on their bearings, of states (steps, k)."""
        springs = [self.values(states, system.coordinates) @ system.bearing_loads.T for system in self.systems]
        loads = np.concatenate(springs, axis=1).reshape(len(states), self.bearings, -1)
        return loads if self.rolling is None else self.rolling.loads(states, loads)


def gear_of(name: str) -> str:
    """Gear on whose side of the mesh a coordinate is; the name of a mode ends with it."""
    return SIDE.get(name) or name.rpartition("_")[2]
