"""Rotations and centres of all gears of a train, the turn of its first shaft prescribed.

A gear's rotation is counted as the mesh does in which it is driven, and carried as the arc of its base circle (mm). In
the next mesh, whose frame is the mirror image, the same rotation counts the other way, whether that is the next mesh of
an idler or that of the next gear on the same shaft. A shaft that twists adds its twist, as the arc of the gear or of
the load at its far end. All matrices are summed over gears and shafts, each of which moves by its own rows of the
coordinates.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import cos, isfinite, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.geometry.pair import GearPair

from .damping import Damping
from .drivetrain import Drivetrain
from .frequencies import ACROSS_DIRECTION, MESH_DIRECTION
from .modal_damping import modal_damping

if TYPE_CHECKING:
    from fenics_gears.geometry.gear_data import LumpedGear

# Coordinates of one mesh in their order: of the centre along and off the line of action, and the rotation, of either
# gear.
OF_A_GEAR = ("centre_x{}", "centre_y{}", "rotation_{}")


@dataclass(frozen=True)
class MeshSprings:
    """How the coordinates move the flanks of all meshes (f, k), along their normals and across."""

    normals: np.ndarray
    across: np.ndarray


@dataclass(frozen=True)
class TrainDrivetrain(Drivetrain):
    """Equations of motion of a train. `motions` (f, k): of each mesh the motion of all behind it, which without mass it
    alone holds. `angle` (k,): rotation (rad) of the last gear; `of_meshes`: of each mesh, how its own coordinates
    (l, k) follow; `end` (k,): rotation (rad) of the load."""

    motions: tuple[tuple[float, ...], ...] = ()
    angle: np.ndarray = field(default_factory=lambda: np.zeros(0))
    of_meshes: tuple[np.ndarray, ...] = ()
    end: np.ndarray = field(default_factory=lambda: np.zeros(0))

    @property
    def free_motion(self) -> np.ndarray:  # type: ignore[override]
        """The motions of all meshes, (f k,)."""
        return np.array(self.motions).ravel()

    @property
    def free_words(self) -> str:
        torque = 1e-3 * float(self.load @ self.motions[-1]) / float(self.angle @ self.motions[-1])
        return f"the last gear turns freely under its torque of {torque:.4g} N m"


@dataclass(frozen=True)
class TrainParts:
    """What a train is put together of: the `pairs` of its meshes, and whether the pinion of each is the wheel of the
    mesh before, an idler (`idlers`); `torque` (N mm) on the last shaft.

    `torsion` (f + 1,): stiffness (N mm/rad) of each shaft, of the first between drive and gear, of the last between
    gear and load, infinite where it is rigid. By gear, from the first on: `masses`, none without inertia, and
    `supports` along and off the line of action (N/mm), None where its centre is fixed. `turned`: of each idler, how
    displacements (2,) in its first mesh's frame stand in that of its second. `load`: moment of inertia (N mm s^2) on
    the last shaft.
    """

    pairs: Sequence[GearPair]
    idlers: Sequence[bool]
    torque: float
    torsion: Sequence[float]
    masses: Sequence[LumpedGear] = ()
    supports: Sequence[tuple[float, float] | None] = ()
    turned: Sequence[np.ndarray | None] = ()
    load: float | None = None

    @property
    def gears(self) -> list[tuple[int, int]]:
        """Of each mesh the numbers of its gears; an idler has one number."""
        found: list[tuple[int, int]] = []
        for idler in self.idlers:
            pinion = found[-1][1] + (0 if idler else 1) if found else 0
            found.append((pinion, pinion + 1))
        return found

    def support(self, gear: int) -> tuple[float, float] | None:
        return self.supports[gear] if self.supports else None


def idler_turn(first: GearPair, second: GearPair, to_first: float, to_second: float) -> np.ndarray:
    """How displacements (2,) of an idler along and off the line of action of its first mesh stand in its second, (2,
    2); the angles to its mates as `geometry.gear_train.second_mesh` has them."""
    # The line of action of the first mesh, from its pinion on, and that of the second, in the frame of the first.
    one = to_first + pi + 0.5 * pi - first.operating_pressure_angle
    other = to_second - 0.5 * pi + second.operating_pressure_angle
    turn = other - one
    # Seen in the mirror image, the direction off the line is on its other side.
    return np.array([[cos(turn), sin(turn)], [sin(turn), -cos(turn)]])


class _Rows:
    """How each gear moves (k,) by the coordinates of a train, in mm and rad."""

    def __init__(self, parts: TrainParts):
        self.parts = parts
        pairs = parts.pairs
        names = ["rotation_1"] if isfinite(parts.torsion[0]) else []
        radii = [pairs[0].base_radii[0]] * len(names)
        gears = parts.gears
        for mesh, pair in enumerate(pairs):
            if mesh and isfinite(parts.torsion[mesh]):
                names.append(f"twist_{mesh + 1}")
                radii.append(pair.base_radii[0])
            names.append(f"rotation_{mesh + 2}")
            radii.append(pair.base_radii[1])
        if isfinite(parts.torsion[-1]):
            names.append(f"twist_{len(pairs) + 1}")
            radii.append(pairs[-1].base_radii[1])
        for gear in range(gears[-1][1] + 1):
            if parts.support(gear) is not None:
                names += [f"centre_x of gear {gear + 1}", f"centre_y of gear {gear + 1}"]
                radii += [1.0, 1.0]
        self.names = tuple(names)
        self.radii = np.array(radii)

    def of(self, name: str) -> np.ndarray:
        """One coordinate by itself, in mm or rad; zero where it is none."""
        row = np.zeros(len(self.names))
        if name in self.names:
            place = self.names.index(name)
            row[place] = 1.0 / self.radii[place]
        return row

    def driven(self, mesh: int) -> np.ndarray:
        """Rotation of a mesh's wheel."""
        return self.of(f"rotation_{mesh + 2}")

    def driving(self, mesh: int) -> np.ndarray:
        """Rotation of a mesh's pinion, as that mesh counts it."""
        if mesh == 0:
            return self.of("rotation_1")
        return self.of(f"twist_{mesh + 1}") - self.driven(mesh - 1)

    @property
    def end(self) -> np.ndarray:
        """Rotation of the load."""
        return self.driven(len(self.parts.pairs) - 1) + self.of(f"twist_{len(self.parts.pairs) + 1}")

    def centre(self, gear: int) -> np.ndarray:
        """Displacements (2, k) of a gear's centre, along and off the line of action of its first mesh."""
        return np.array([self.of(f"centre_{axis} of gear {gear + 1}") for axis in "xy"])

    def of_mesh(self, mesh: int) -> np.ndarray:
        """A mesh's own coordinates (l, k), in mm."""
        pair = self.parts.pairs[mesh]
        rows = []
        gears = self.parts.gears[mesh]
        for side, (gear, angle) in enumerate(zip(gears, (self.driving(mesh), self.driven(mesh)))):
            if self.parts.support(gear) is not None:
                centre = self.centre(gear)
                rows += list(self.parts.turned[mesh] @ centre if side == 0 and self.parts.idlers[mesh] else centre)
            rows.append(pair.base_radii[side] * angle)
        return np.array(rows)

    def motion_behind(self, mesh: int) -> tuple[float, ...]:
        """The motion (k,) of all gears behind a mesh that turn together, of length 1."""
        motion = np.zeros(len(self.names))
        turned = 1.0
        for number in range(mesh, len(self.parts.pairs)):
            turned *= self.parts.pairs[number].rotation_ratio if number > mesh else 1.0
            place = self.names.index(f"rotation_{number + 2}")
            motion[place] = self.radii[place] * turned
        return tuple(motion / np.linalg.norm(motion))


def train_drivetrain(
    parts: TrainParts, damping: Damping | None = None, mesh_stiffness: Sequence[float] = ()
) -> TrainDrivetrain:
    """The gears of a train under a torque on the last shaft. `mesh_stiffness` (f,), N/mm: of one tooth pair of each
    mesh, roughly; damping ratios are of the modes with them."""
    rows = _Rows(parts)
    meshes = range(len(parts.pairs))
    of_meshes = tuple(rows.of_mesh(mesh) for mesh in meshes)
    names_of = [coordinates_of_mesh(parts, mesh) for mesh in meshes]

    def flanks(direction: dict[str, float]) -> np.ndarray:
        own = (np.array([direction.get(name, 0.0) for name in names]) for names in names_of)
        return np.array([along @ of_mesh for along, of_mesh in zip(own, of_meshes)])

    # Of helical teeth the normal leans along the axis.
    cosines = np.array([[pair.cosine] for pair in parts.pairs])

    stiffness, in_bearings = _stiffness(rows)
    undamped = TrainDrivetrain(
        rows.names,
        rows.radii,
        stiffness,
        parts.torque * rows.end,
        _mass(rows) if parts.masses else None,
        None,
        MeshSprings(cosines * flanks(MESH_DIRECTION), flanks(ACROSS_DIRECTION)),
        bearing_stiffness=in_bearings,
        motions=tuple(rows.motion_behind(mesh) for mesh in meshes),
        angle=rows.driven(len(parts.pairs) - 1),
        of_meshes=of_meshes,
        end=rows.end,
    )
    return undamped if damping is None else damped(undamped, damping, mesh_stiffness)


def damped(undamped: TrainDrivetrain, damping: Damping, mesh_stiffness: Sequence[float]) -> TrainDrivetrain:
    """A drivetrain with damping beside what it has; `mesh_stiffness`, N/mm: of each of its mesh springs, roughly."""
    if undamped.mass is None:
        return undamped
    before = 0.0 if undamped.damping is None else undamped.damping
    if damping.modal:
        own = modal_damping(undamped, np.array(mesh_stiffness), damping.modal)
    else:
        alpha = damping.stiffness_proportional or 0.0
        beta = damping.mass_proportional or 0.0
        own = alpha * undamped.stiffness_at_work + beta * undamped.mass
    return replace(undamped, damping=before + own)


def _stiffness(rows: _Rows) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness (k, k) of shafts and bearings, N/mm, and the part of it in bearings."""
    parts = rows.parts
    in_bearings = np.zeros((len(rows.names), len(rows.names)))
    for gear in range(parts.gears[-1][1] + 1):
        support = parts.support(gear)
        if support is not None:
            centre = rows.centre(gear)
            in_bearings += centre.T @ np.diag(support) @ centre
    stiffness = in_bearings.copy()
    for shaft, torsion in enumerate(parts.torsion):
        twist = rows.of("rotation_1" if shaft == 0 else f"twist_{shaft + 1}")
        if isfinite(torsion):
            stiffness += torsion * np.outer(twist, twist)
    return stiffness, in_bearings


def _mass(rows: _Rows) -> np.ndarray:
    """Mass (k, k), N s^2/mm, of gears and load."""
    parts = rows.parts
    found = np.zeros((len(rows.names), len(rows.names)))
    for mesh, gears in enumerate(parts.gears):
        for side, (gear, angle) in enumerate(zip(gears, (rows.driving(mesh), rows.driven(mesh)))):
            if side == 0 and parts.idlers[mesh]:
                continue  # counted as the wheel of the mesh before
            centre = rows.centre(gear)
            own = parts.masses[gear]
            found += own.moment_of_inertia * np.outer(angle, angle) + own.mass * centre.T @ centre
    if parts.load is not None:
        found += parts.load * np.outer(rows.end, rows.end)
    return found


def coordinates_of_mesh(parts: TrainParts, mesh: int) -> tuple[str, ...]:
    """The coordinates that a mesh has of its own two gears."""
    names: list[str] = []
    for number, gear in enumerate(parts.gears[mesh], 1):
        names += [each.format(number) for each in OF_A_GEAR[0 if parts.support(gear) is not None else 2 :]]
    return tuple(names)


def drivetrain_of_mesh(
    pair: GearPair,
    wheel_torque: float,
    names: tuple[str, ...] = ("rotation_1", "rotation_2"),
    supports: Sequence[tuple[float, float] | None] = (),
) -> Drivetrain:
    """Both gears of one mesh of a train, whose coordinates follow from those of all gears; `supports` as of the
    train."""
    turning = ("rotation", "tilt")
    radii = np.array([pair.base_radii[int(name[-1]) - 1] if name.startswith(turning) else 1.0 for name in names])
    load = np.array([wheel_torque if name == "rotation_2" else 0.0 for name in names]) / radii
    nothing = np.zeros((len(names), len(names)))
    in_bearings = nothing.copy()
    for number, support in enumerate(supports, 1):
        for axis, own in zip("xy", support or ()):
            place = names.index(f"centre_{axis}{number}")
            in_bearings[place, place] = own
    return Drivetrain(names, radii, nothing, load, None, None, bearing_stiffness=in_bearings)
