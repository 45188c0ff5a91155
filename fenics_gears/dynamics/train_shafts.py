"""Shafts of a train that bend: gears at places along them move together, in all of their meshes.

Along all shafts of a train z is the axis, towards the end from which the first gear of the train is seen to turn
counter-clockwise. Across it x is along the line of action of the first mesh of the shaft's first gear. A mesh has a
frame of its own, in which its pinion turns counter-clockwise; displacements stand in it as vectors, tilts as axial
vectors, which a mirror image turns round.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import block_diag

from fenics_gears.geometry.pair import GearPair
from fenics_gears.inputs.tree import GEARS

from .damping import Damping, damping_of
from .drivetrain import Drivetrain, MeshSprings
from .elastic_shaft import FIVE, MOTIONS, SeatedGear
from .rolling_springs import springs_of
from .seat_of_mesh import SeatOfMesh
from .shaft_at_work import even_load
from .shaft_system import ShaftSystem
from .tilting import mesh_over_face
from .train import mass_of_gear

if TYPE_CHECKING:
    from fenics_gears.geometry.gear_data import LumpedGear

# Axes of a train: to the right, up, and along its shafts.
SPACE = np.eye(3)


@dataclass(frozen=True, eq=False)
class MeshFrame:
    """Axes (3, 3) of a mesh in space, one a row: along and off its line of action, and the axis. `pair`; `torque`
    (N mm) on its wheel."""

    axes: np.ndarray
    pair: GearPair
    torque: float

    @property
    def sense(self) -> float:
        """1 where it counts turns as the train does, -1 where its own are those of a mirror image."""
        return float(np.linalg.det(self.axes) * self.axes[2, 2])


@dataclass(frozen=True, eq=False)
class GearOnShaft:
    """A gear in its `seat` on a shaft that bends, as the pinion (0) or the wheel (1) of a `mesh`, by its number;
    `turned` (6, 6): its motions in the frame of the mesh, mm and rad, per those in the frame of the shaft."""

    seat: SeatedGear
    mesh: int
    side: int
    turned: np.ndarray

    @property
    def names(self) -> tuple[str, ...]:
        """Names (5,) of its motions among the coordinates of the mesh."""
        return tuple(f"{name}{self.side + 1}" for name in MOTIONS)


@dataclass(frozen=True, eq=False)
class BentShafts:
    """All shafts of a train that bend: their `systems`, the `gears` on them, once in each of their meshes, the `frames`
    of all meshes; `axes` (3, 3) of each shaft in space, one a row, by its name. `masses`: of the gears by their names,
    none without inertia. `turns`: of each shaft by its name, about the axis of the train, in one of the first."""

    systems: tuple[ShaftSystem, ...]
    axes: Mapping[str, np.ndarray]
    gears: tuple[GearOnShaft, ...]
    frames: tuple[MeshFrame, ...]
    masses: Mapping[str, LumpedGear]
    turns: Mapping[str, float]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the shafts."""
        return tuple(self.axes)

    @property
    def once(self) -> dict[str, GearOnShaft]:
        """The gears by their names, each in its first mesh."""
        found: dict[str, GearOnShaft] = {}
        for gear in self.gears:
            found.setdefault(gear.seat.gear, gear)
        return found

    def seats_in(self, mesh: int) -> list[SeatOfMesh]:
        """The seats of its gears that give way."""
        found = []
        for gear in self.in_mesh(mesh):
            if gear.seat.yields_within:
                system = next(each for each in self.systems if gear.seat in (seat for _, seat in each.seated))
                found.append(SeatOfMesh(system, gear.seat, GEARS[gear.side], gear.turned))
        return found

    def in_mesh(self, mesh: int) -> list[GearOnShaft]:
        """The gears of a mesh that are on such shafts."""
        return [each for each in self.gears if each.mesh == mesh]

    def names_in(self, mesh: int) -> tuple[str, ...]:
        """Names of their motions among the coordinates of the mesh."""
        faces = (name for seat in self.seats_in(mesh) for name in seat.of_face)
        return (*(name for each in self.in_mesh(mesh) for name in each.names), *faces)


def mesh_axes(in_plane: np.ndarray, forwards: float) -> np.ndarray:
    """Axes (3, 3) of a mesh in space, of those `in_plane` (2, 2), along and off its line of action; `forwards`: 1 where
    its axis is that of the train, -1 where it is the opposite."""
    axes = np.diag([0.0, 0.0, forwards])
    axes[:2, :2] = in_plane
    return axes


def shaft_axes(mesh: np.ndarray) -> np.ndarray:
    """Axes (3, 3) of a shaft in space, of those of the first mesh of its first gear."""
    x, y, _ = mesh[0]
    return np.array([[x, y, 0.0], [-y, x, 0.0], [0.0, 0.0, 1.0]])


def turned_motions(of: np.ndarray, to: np.ndarray) -> np.ndarray:
    """Motions (6, 6) along the axes `to` (3, 3) per those along other axes."""
    turn = to @ of.T
    return block_diag(turn, np.linalg.det(turn) * turn)


def shafts_of_pair(
    systems: tuple[ShaftSystem, ...], pair: GearPair, torque: float, masses: Mapping[str, LumpedGear]
) -> BentShafts:
    """The shafts of a pair that bend, in the frame of its mesh, under a torque (N mm) on the wheel."""
    seats = [seat for system in systems for _, seat in system.seated]
    gears = tuple(GearOnShaft(seat, 0, GEARS.index(seat.gear), np.eye(2 * len(SPACE))) for seat in seats)
    axes = {seat.gear: SPACE for seat in seats}
    turns = dict(zip(GEARS, (1.0, -pair.rotation_ratio)))
    return BentShafts(systems, axes, gears, (MeshFrame(SPACE, pair, torque),), masses, turns)


def even_loads(system: ShaftSystem, gears: Sequence[GearOnShaft], frames: Sequence[MeshFrame]) -> np.ndarray:
    """Loads (5 g,) of the gears of a system of shafts, in the frames of these, by an even line load in each mesh."""
    loads = np.zeros((len(system.seated), FIVE))
    for own, (_, seat) in zip(loads, system.seated):
        for gear in gears:
            if gear.seat.gear == seat.gear:
                frame = frames[gear.mesh]
                own += gear.turned[:FIVE, :FIVE].T @ even_load(GEARS[gear.side], frame.pair, frame.torque)
    return loads.ravel()


class _Coordinates:
    """Those of a drivetrain with rigid shafts, and behind them those of shafts that bend; the last ones are modes."""

    def __init__(self, base: Drivetrain, bent: BentShafts):
        self.base = base
        self.bent = bent
        # Of faces behind those of gears, as `Drivetrain.indices` has them.
        moved = sorted((name for system in bent.systems for name in system.moved), key=lambda name: "face_" in name[:5])
        modes = [name for system in bent.systems for name in system.modes]
        self.names = (*base.coordinates, *moved, *modes)
        self.radii = np.concatenate([base.radii, np.ones(len(moved) + len(modes))])
        for gear in bent.gears:
            for name in gear.seat.of_gear:
                if name.startswith("tilt"):
                    radius = bent.frames[gear.mesh].pair.base_radii[gear.side]
                    self.radii[self.names.index(name)] = radius
        for mesh, frame in enumerate(bent.frames):
            for seat in bent.seats_in(mesh):
                self.radii[[self.names.index(name) for name in seat.of_face]] = seat.radii_of_face(frame.pair)

    def padded(self, array: np.ndarray) -> np.ndarray:
        """An array over the coordinates of the rigid shafts as one over all."""
        more = len(self.names) - len(self.base.coordinates)
        return np.pad(array, [(0, more if size == len(self.base.coordinates) else 0) for size in array.shape])

    def of(self, names: Sequence[str]) -> np.ndarray:
        """Motions (n, k) of such names, in mm and rad."""
        rows = np.zeros((len(names), len(self.names)))
        for row, name in zip(rows, names):
            place = self.names.index(name)
            row[place] = 1.0 / self.radii[place]
        return rows

    def moving(self, system: ShaftSystem, names_of: Sequence[tuple[str, ...]]) -> np.ndarray:
        """All motions (g + m, k) of a system of shafts; `names_of`: names of the coordinates of each mesh."""
        moved = system.motions_over(self.names) / self.radii
        for shaft in system.shafts:
            for gear in (self.bent.once[seat.gear] for seat in shaft.seats):
                moved[system.motions.index(gear.seat.motions[-1])] = self.turn(gear, names_of[gear.mesh])
                # The turn of the drive is prescribed.
                if gear.side:
                    sense = self.bent.frames[gear.mesh].sense
                    for name in shaft.coupling(shaft.chain):
                        moved[system.motions.index(name)] = sense * self.padded(self.base.ends[gear.mesh])
        return moved

    def of_mesh(self, mesh: int) -> np.ndarray:
        """A mesh's own coordinates (l, k), in mm: those that it has on rigid shafts, then those of its gears on shafts
        that bend."""
        base = self.base.of_meshes[mesh]
        rows = [np.pad(base, ((0, 0), (0, len(self.names) - base.shape[1])))]
        for gear in self.bent.in_mesh(mesh):
            radius = self.bent.frames[mesh].pair.base_radii[gear.side]
            arcs = np.array([radius if name.startswith("tilt") else 1.0 for name in MOTIONS])
            rows.append(arcs[:, None] * gear.turned[:FIVE, :FIVE] @ self.of(gear.seat.of_gear))
        for seat in self.bent.seats_in(mesh):
            arcs = seat.radii_of_face(self.bent.frames[mesh].pair)
            rows.append(arcs[:, None] * self.of(seat.of_face))
        return np.concatenate(rows)

    def turn(self, gear: GearOnShaft, names: Sequence[str]) -> np.ndarray:
        """Turn (k,) of a gear about the axis of the train, in rad; `names` of the coordinates of its mesh."""
        frame = self.bent.frames[gear.mesh]
        row = self.of_mesh(gear.mesh)[names.index(f"rotation_{gear.side + 1}")]
        return frame.sense * row / frame.pair.base_radii[gear.side]


def with_bent_shafts(
    base: Drivetrain,
    bent: BentShafts,
    names_of: Sequence[tuple[str, ...]],
    damping: Damping | None = None,
    mesh_stiffness: Sequence[float] | float = (),
) -> Drivetrain:
    """A drivetrain whose gears turn and twist their shafts, with some shafts that also bend; `names_of`: names of the
    coordinates of each mesh. `mesh_stiffness`, N/mm: of either half of the face of one tooth pair in each mesh,
    roughly."""
    coordinates = _Coordinates(base, bent)
    moving = [(system, coordinates.moving(system, names_of)) for system in bent.systems]

    def with_shafts(of_base: np.ndarray, matrix: str) -> np.ndarray:
        return coordinates.padded(of_base) + sum(system.over(moved, matrix) for system, moved in moving)

    of_meshes = tuple(coordinates.of_mesh(mesh) for mesh in range(len(names_of)))
    springs = [mesh_over_face(frame.pair, names) for frame, names in zip(bent.frames, names_of)]
    whole = replace(
        base,
        coordinates=coordinates.names,
        radii=coordinates.radii,
        stiffness=with_shafts(base.stiffness, "stiffness"),
        load=coordinates.padded(base.load),
        mass=None if base.mass is None else with_shafts(base.mass, "mass") + _mass_of_gears(coordinates),
        mesh=MeshSprings(
            np.concatenate([each.normals @ rows for each, rows in zip(springs, of_meshes)]),
            np.concatenate([each.across @ rows for each, rows in zip(springs, of_meshes)]),
        ),
        systems=bent.systems,
        bearing_stiffness=with_shafts(base.bearing_stiffness, "bearing_stiffness"),
        motions=tuple(tuple(coordinates.padded(np.array(each)).tolist()) for each in base.motions),
        angle=coordinates.padded(base.angle),
        of_meshes=of_meshes,
        ends=tuple(coordinates.padded(each) for each in base.ends),
    )
    whole = replace(whole, rolling=springs_of(whole))
    if whole.mass is None:
        return whole
    dampers = with_shafts(np.zeros_like(base.stiffness), "damping")
    damping_matrix = damping_of(whole, damping, np.array(mesh_stiffness), dampers)
    momentum = coordinates.padded(base.nominal_momentum) + sum(
        moved.T @ system.mass @ system.turning(bent.turns) for system, moved in moving
    )
    return replace(whole, damping=damping_matrix, nominal_momentum=momentum)


def _mass_of_gears(coordinates: _Coordinates) -> np.ndarray:
    """Mass (k, k), N s^2/mm, of gears as far as they move and tilt with their shafts."""
    mass = np.zeros((len(coordinates.names),) * 2)
    for name, gear in coordinates.bent.once.items():
        mass += mass_of_gear(coordinates.bent.masses[name], coordinates.of(gear.seat.of_gear))
    return mass
