"""Rotations and centres of all gears of a train, the turn of its first shaft prescribed.

A shaft's rotation is counted as the meshes do that drive it, and carried as the arc of a base circle (mm), which of an
internal gear has a negative radius. In a mesh that it drives, whose frame is the mirror image, the same rotation counts
the other way, whether an idler drives there or another gear on the shaft; where an internal gear is driven, the frame
stays. A shaft that twists adds its twist between the gears that are driven and those that drive,
or the load, as the arc of what is at its far end. All matrices are summed over gears and shafts, each of which moves by
its own rows of the coordinates.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from math import isfinite
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.contact.kinematics import MOTIONS
from fenics_gears.geometry.pair import GearPair
from fenics_gears.geometry.train_graph import PINION, TrainGraph, turns_of_shafts

from .damping import Damping, damping_of
from .drivetrain import Drivetrain, MeshSprings

if TYPE_CHECKING:
    from fenics_gears.geometry.gear_data import LumpedGear

    from .tilting import Tilting

# Relative normal displacement of the flanks per coordinate of a mesh; see contact.operator.displacement_jacobian.
# Friction also acts across.
MESH_DIRECTION = {"centre_x1": 1.0, "rotation_1": 1.0, "centre_x2": -1.0, "rotation_2": 1.0}
ACROSS_DIRECTION = {"centre_y1": 1.0, "centre_y2": -1.0}
# Coordinates of one mesh in their order: of the centre along and off the line of action, and the rotation, of either
# gear.
OF_A_GEAR = ("centre_x{}", "centre_y{}", "rotation_{}")


@dataclass(frozen=True)
class TrainParts:
    """What a train is put together of: the `graph` of its meshes, their `pairs` and the directions `axes` (2, 2), in
    rows, along and off the line of action of each; the `torques` (N mm) that resist the rotation of each shaft, 0 where
    there are none.

    `torsion`: stiffness (N mm/rad) of each shaft, of the first between drive and gears, of outputs between gears and
    load, of others between the gears that are driven and those that only drive, infinite where it is rigid. By gear:
    `masses`, none without inertia, and `supports` along and off the line of action of its first mesh (N/mm), None where
    its centre is fixed, infinite in directions in which it is fixed beside its place. `loads`: moments of inertia
    (N mm s^2) of the loads by the numbers of their shafts. `turning`: numbers of gears that turn against their shaft,
    one that bends. `tilting`: the gears of a pair that tilt, None where none does. `centred`: of gears that have the
    centre of another one on their shaft, that one. `together`: gears (n) that one support holds, and its stiffness
    (2 n, 2 n), N/mm, in space, gear after gear.
    """

    graph: TrainGraph
    pairs: Sequence[GearPair]
    axes: Sequence[np.ndarray]
    torques: Sequence[float]
    torsion: Sequence[float]
    masses: Sequence[LumpedGear] = ()
    supports: Sequence[tuple[float, float] | None] = ()
    loads: Mapping[int, float] = field(default_factory=dict)
    turning: Sequence[int] = ()
    tilting: Tilting | None = None
    centred: Mapping[int, int] = field(default_factory=dict)
    together: tuple[Sequence[int], np.ndarray] | None = None

    @property
    def gears(self) -> Sequence[tuple[int, int]]:
        """Of each mesh the numbers of its gears; one that stands in several has one number."""
        return self.graph.gears

    def support(self, gear: int) -> tuple[float, float] | None:
        return self.supports[gear] if self.supports else None


class Rows:
    """How each gear moves (k,) by the coordinates of a train, in mm and rad."""

    def __init__(self, parts: TrainParts):
        self.parts = parts
        self.graph = parts.graph
        pairs = parts.pairs
        last = self.graph.last
        radii: dict[str, float] = {}
        # Stiffness of the supports, N/mm.
        self.held: dict[str, float] = {}
        for shaft in range(last + 1):
            for gear in self.graph.on(shaft):
                if gear in parts.centred:
                    continue
                along_and_off = zip("xy", parts.support(gear) or ())
                self.held |= {f"centre_{axis}{gear + 1}": own for axis, own in along_and_off if isfinite(own)}
            radii |= {name: 1.0 for name in self.held if name not in radii}
            driven = [pairs[mesh].base_radii[1] for mesh in self.graph.into(shaft)]
            driving = [pairs[mesh].base_radii[0] for mesh in self.graph.out_of(shaft)]
            if shaft or isfinite(parts.torsion[0]):
                radii[f"rotation_{shaft + 1}"] = (driven or driving)[0]
            if shaft and isfinite(parts.torsion[shaft]):
                radii[f"twist_{shaft + 1}"] = (driving or driven)[0]
        for gear in parts.turning:
            mesh, side = self.graph.sides[gear][0]
            radii[f"turn of gear {gear + 1}"] = pairs[mesh].base_radii[side]
        if parts.tilting is not None:
            radii |= parts.tilting.radii
        self.names = tuple(radii)
        self.radii = np.array([*radii.values()])

    def of(self, name: str) -> np.ndarray:
        """One coordinate by itself, in mm or rad; zero where it is none."""
        row = np.zeros(len(self.names))
        if name in self.names:
            place = self.names.index(name)
            row[place] = 1.0 / self.radii[place]
        return row

    def rotation(self, gear: int, side: int) -> np.ndarray:
        """Rotation of a gear, as a mesh counts it in which it is the pinion (0) or the wheel (1)."""
        shaft = self.graph.shafts[gear]
        own = self.of(f"rotation_{shaft + 1}") + self.of(f"turn of gear {gear + 1}")
        if shaft == 0 or side != PINION:
            return own
        with_shaft = self.graph.driven(gear) or gear in self.parts.turning
        # Of external gears the frame is the mirror image.
        return (0.0 if with_shaft else self.of(f"twist_{shaft + 1}")) + self.onwards(shaft) * own

    def onwards(self, shaft: int) -> int:
        """1 where the gear that is driven on a shaft is internal, -1 where it turns against its mate."""
        return self.graph.onwards(self.graph.into(shaft)[0])

    def end(self, shaft: int) -> np.ndarray:
        """Rotation of the load on a shaft: of an output behind what twists, else where it is driven."""
        far = 0.0 if self.graph.out_of(shaft) else self.of(f"twist_{shaft + 1}")
        return self.of(f"rotation_{shaft + 1}") + far

    def lag(self, shaft: int) -> np.ndarray:
        """The same against the nominal rotation: of an internal gear its frame counts it the other way."""
        return -self.onwards(shaft) * self.end(shaft)

    def centre(self, gear: int) -> np.ndarray:
        """Motions (5, k) of a gear's centre along and off the line of action of the first mesh of `owner` and along the
        axis, in mm, and about the first two, in rad."""
        return np.array([self.of(motion.format(self.owner(gear) + 1)) for motion in MOTIONS[:5]])

    def owner(self, gear: int) -> int:
        """The gear whose centre it has: itself, but for one that is `centred` by another."""
        return self.parts.centred.get(gear, gear)

    def moved(self, gear: int) -> tuple[np.ndarray, np.ndarray]:
        """Rotation (k,), in either sense, and motions (5, k) of a gear's centre as its inertia has them."""
        return self.rotation(gear, self.graph.sides[gear][0][1]), self.centre(gear)

    def of_mesh(self, mesh: int) -> np.ndarray:
        """A mesh's own coordinates (l, k), in mm."""
        pair = self.parts.pairs[mesh]
        axes = self.parts.axes
        rows = []
        for side, gear in enumerate(self.graph.gears[mesh]):
            if self.parts.support(gear) is not None:
                first, _ = self.graph.sides[self.owner(gear)][0]
                centre = self.centre(gear)[:2]
                rows += list(centre if first == mesh else axes[mesh] @ axes[first].T @ centre)
            rows.append(pair.base_radii[side] * self.rotation(gear, side))
        return np.array(rows)

    def nominal(self, turns: Sequence[Fraction]) -> np.ndarray:
        """The nominal motion (k,) in a rad of the first shaft: the shafts that are driven turn against the sense in
        which their rotations are counted."""
        motion = np.zeros(len(self.names))
        for shaft, turn in enumerate(turns):
            name = f"rotation_{shaft + 1}"
            if name in self.names:
                place = self.names.index(name)
                motion[place] = -abs(self.radii[place]) * float(turn) if shaft else self.radii[place]
        return motion

    def momentum(self, mass: np.ndarray, turns: Sequence[Fraction]) -> np.ndarray:
        """Momentum (k,), N s, of gears and load, whose `mass` (k, k) it is, as the first shaft turns by 1 rad/s."""
        found = mass @ self.nominal(turns)
        if "rotation_1" not in self.names:
            # Its turn is prescribed: gears that turn against it are moved on all the same.
            for gear in self.graph.on(0):
                found += self.parts.masses[gear].moment_of_inertia * self.rotation(gear, PINION)
        return found

    def motion_of(self, shafts: Sequence[int], turns: Sequence[Fraction]) -> tuple[float, ...]:
        """The motion (k,) of shafts that turn together, of length 1; `turns` of each shaft in one of the first."""
        return self.of_rotations({f"rotation_{each + 1}": float(turns[each] / turns[shafts[0]]) for each in shafts})

    def of_rotations(self, rotations: Mapping[str, float]) -> tuple[float, ...]:
        """The motion (k,), of length 1, in which coordinates turn in these ratios."""
        motion = np.array([abs(each) * rotations.get(name, 0.0) for name, each in zip(self.names, self.radii)])
        return tuple(motion / np.linalg.norm(motion))


def train_drivetrain(
    parts: TrainParts,
    damping: Damping | None = None,
    mesh_stiffness: Sequence[float] | float = (),
    rows: Rows | None = None,
) -> Drivetrain:
    """The gears of a train under the torques on its shafts; coordinates that cannot move do not appear.
    `mesh_stiffness` (f,), N/mm: of one tooth pair of each mesh, roughly; damping ratios are of the modes with them.
    `rows`: how gears move, unless as in any train."""
    rows = rows or Rows(parts)
    graph = parts.graph
    meshes = range(len(parts.pairs))
    turns = turns_of_shafts(graph, [pair.teeth for pair in parts.pairs])
    of_meshes = tuple(rows.of_mesh(mesh) for mesh in meshes)
    names_of = [coordinates_of_mesh(parts, mesh) for mesh in meshes]

    def flanks(direction: dict[str, float]) -> np.ndarray:
        own = (np.array([direction.get(name, 0.0) for name in names]) for names in names_of)
        return np.array([along @ of_mesh for along, of_mesh in zip(own, of_meshes)])

    # Of helical teeth the normal leans along the axis.
    cosines = np.array([[pair.cosine] for pair in parts.pairs])

    mesh = MeshSprings(cosines * flanks(MESH_DIRECTION), flanks(ACROSS_DIRECTION))
    if parts.tilting is not None:
        mesh = parts.tilting.mesh(rows.names)
    stiffness, in_bearings = _stiffness(rows)
    undamped = Drivetrain(
        rows.names,
        rows.radii,
        stiffness,
        sum(
            (torque * rows.lag(shaft) for shaft, torque in enumerate(parts.torques) if torque),
            np.zeros(len(rows.names)),
        ),
        _mass(rows) if parts.masses else None,
        None,
        mesh,
        bearing_stiffness=in_bearings,
        motions=tuple(rows.motion_of(shafts, turns) for shafts in graph.cuts),
        angle=-rows.onwards(graph.last) * rows.of(f"rotation_{graph.last + 1}"),
        of_meshes=of_meshes,
        ends=tuple(rows.lag(driven) for _, driven in graph.between),
    )
    if undamped.mass is None:
        return undamped
    dampers = damping_of(undamped, damping, np.array(mesh_stiffness))
    return replace(undamped, damping=dampers, nominal_momentum=rows.momentum(undamped.mass, turns))


def _stiffness(rows: Rows) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness (k, k) of shafts and bearings, N/mm, and the part of it in bearings."""
    parts = rows.parts
    springs = np.diag([rows.held.get(name, 0.0) for name in rows.names])
    if parts.tilting is not None:
        parts.tilting.add_bearings(springs, rows.names)
    in_bearings = springs / np.outer(rows.radii, rows.radii)
    if parts.together is not None:
        gears, own = parts.together
        first = [rows.graph.sides[gear][0][0] for gear in gears]
        inside = np.vstack([parts.axes[mesh].T @ rows.centre(gear)[:2] for mesh, gear in zip(first, gears)])
        in_bearings += inside.T @ own @ inside
    stiffness = in_bearings.copy()
    for shaft, torsion in enumerate(parts.torsion):
        twist = rows.of("rotation_1" if shaft == 0 else f"twist_{shaft + 1}")
        if isfinite(torsion):
            stiffness += torsion * np.outer(twist, twist)
    return stiffness, in_bearings


def _mass(rows: Rows) -> np.ndarray:
    """Mass (k, k), N s^2/mm, of gears and load."""
    parts = rows.parts
    found = np.zeros((len(rows.names), len(rows.names)))
    for gear, own in enumerate(parts.masses):
        angle, centre = rows.moved(gear)
        found += own.moment_of_inertia * np.outer(angle, angle) + mass_of_gear(own, centre)
    for shaft, load in parts.loads.items():
        end = rows.end(shaft)
        found += load * np.outer(end, end)
    return found


def mass_of_gear(gear: LumpedGear, moved: np.ndarray) -> np.ndarray:
    """Mass (k, k) of a gear whose middle moves so (5, k), in mm along x, y and z, in rad about x and y."""
    return moved.T @ np.diag([gear.mass] * 3 + [gear.tilting_inertia] * 2) @ moved


def coordinates_of_mesh(parts: TrainParts, mesh: int) -> tuple[str, ...]:
    """The coordinates that a mesh has of its own two gears."""
    names: list[str] = []
    for number, gear in enumerate(parts.gears[mesh], 1):
        names += [each.format(number) for each in OF_A_GEAR[0 if parts.support(gear) is not None else 2 :]]
    return tuple(names)
