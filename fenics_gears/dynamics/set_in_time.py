"""A planetary set with masses, in the frame that turns with its carrier at the nominal speed Omega.

Rotations are those beyond the nominal motion, the same in every frame: a member that turns as prescribed, the input or
the fixed one, has none. A planet's centre is off by u on its pin from where the carrier, turned by theta, takes it:

    c = u + theta t,   t = J a,   J: a quarter turn counter-clockwise,

with its place a on the carrier. Of the kinetic energy of all centres, that of sun and ring with u = c, follow

    sum m A^T A   in the mass, with c = A q,
    2 Omega sum m A^T J A   on velocities (Coriolis),
    Omega^2 sum m U^T U   off the stiffness, with u = U q, and Omega^2 m a as the load of each planet on its pin:

what turns with the carrier has the same centrifugal force wherever that stands. Teeth see the gears as the carrier
does, which a rotation of all together does not change. Lin and Parker (J. Vib. Acoust. 121, 1999, 316-321) have c in
place of u off the stiffness: there planets are pulled off the carrier that they have turned with.

On a speed ramp Omega is that of each step, and the nominal motion of all that turns is accelerated: -Omega' m t for a
planet's centre. Of displacements u that is left out, Omega' m u, a millionth of the springs' forces and less.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fenics_gears.geometry.planetary import CARRIER, RING, SUN, WITH_RING
from fenics_gears.geometry.train_graph import PINION

from .damping import Damping, damping_of
from .drivetrain import Drivetrain, TurningFrame
from .train import Rows, TrainParts, train_drivetrain

QUARTER_TURN = np.array([[0.0, -1.0], [1.0, 0.0]])


@dataclass(frozen=True)
class SetInTime:
    """The carrier and the members of a set. `places` (p, 2), mm: of the pins; `speed`, rad/s: Omega, counter-clockwise
    where the carrier sees the sun turn so; `in_a_turn`: turns of the carrier in one of the sun as the carrier sees it;
    `step`, s: of the run at that speed; `carrier` and `load`, N mm s^2: moments of inertia of the carrier and of
    what the `output` drives. `springs`, N mm/rad: of each member that may turn beyond its nominal rotation, zero where
    none holds it. `torque`, N mm, on the output, and `behind`: the sense in which it acts, 1 counter-clockwise."""

    places: np.ndarray
    speed: float
    in_a_turn: float
    step: float
    carrier: float
    load: float
    springs: Mapping[str, float]
    output: str
    torque: float
    behind: int

    @property
    def radius(self) -> float:
        """Of the circle (mm) of the planets."""
        return float(np.hypot(*self.places[0]))


class RowsOfSet(Rows):
    """How the gears of a set move, as its carrier sees them, and its members."""

    def __init__(self, parts: TrainParts, own: SetInTime):
        super().__init__(parts)
        self.own = own
        self._ring = f"rotation_{self.graph.last + 1}"
        radii = dict(zip(self.names, self.radii.tolist()))
        if RING not in own.springs:
            del radii[self._ring]
        if SUN in own.springs:
            radii["rotation_1"] = parts.pairs[0].base_radii[PINION]
        if CARRIER in own.springs:
            radii[CARRIER] = own.radius
        self.names = tuple(radii)
        self.radii = np.array(list(radii.values()))

    def turned(self, member: str) -> np.ndarray:
        """Rotation (k,) of a member beyond its nominal one, counter-clockwise."""
        # The frame of its meshes is the mirror image.
        return -self.of(self._ring) if member == RING else self.of("rotation_1" if member == SUN else member)

    def rotation(self, gear: int, side: int) -> np.ndarray:
        shaft = self.graph.shafts[gear]
        mirrored = shaft == self.graph.last or (shaft != 0 and side == PINION)
        carried = self.of(CARRIER)
        return super().rotation(gear, side) + (carried if mirrored else -carried)

    def moved(self, gear: int) -> tuple[np.ndarray, np.ndarray]:
        shaft = self.graph.shafts[gear]
        centre = self.centre(gear)
        centre[:2] += self._axes(gear) @ self._carried(shaft)
        return self.of(f"rotation_{shaft + 1}"), centre

    def _carried(self, shaft: int) -> np.ndarray:
        """Displacement (2, k), in space, of a gear's place by the carrier."""
        if shaft in (0, self.graph.last):
            return np.zeros((2, len(self.names)))
        return np.outer(QUARTER_TURN @ self.own.places[shaft - 1], self.of(CARRIER))

    def _axes(self, gear: int) -> np.ndarray:
        return self.parts.axes[self.graph.sides[gear][0][0]]

    def in_the_frame(self) -> TurningFrame:
        """What the turning frame brings; its load is that of the planets on their pins."""
        size = len(self.names)
        off = np.zeros((size, size))
        skew = np.zeros((size, size))
        load = np.zeros(size)
        speed = self.own.speed
        for gear, lumped in enumerate(self.parts.masses):
            shaft = self.graph.shafts[gear]
            beside = self._axes(gear).T @ self.centre(gear)[:2]
            centre = beside + self._carried(shaft)
            off += speed**2 * lumped.mass * beside.T @ beside
            skew += 2.0 * speed * lumped.mass * centre.T @ QUARTER_TURN @ centre
            if shaft not in (0, self.graph.last):
                load += speed**2 * lumped.mass * self.own.places[shaft - 1] @ beside
        return TurningFrame(skew, off, load, self.own.step)

    def momentum(self, mass: np.ndarray, turns: Sequence) -> np.ndarray:
        """In space, of all masses, carrier and load among them, as the carrier sees the sun turn by 1 rad/s."""
        own = self.own
        # Counter-clockwise in space: of sun, planets and ring, and of the carrier.
        rotations = own.in_a_turn + np.array([1.0, *(-float(each) for each in turns[1:])])
        found = own.carrier * own.in_a_turn * self.of(CARRIER)
        for gear, lumped in enumerate(self.parts.masses):
            shaft = self.graph.shafts[gear]
            rotation = self.of(f"rotation_{shaft + 1}") * (-1.0 if shaft == self.graph.last else 1.0)
            found = found + lumped.moment_of_inertia * rotations[shaft] * rotation
            if shaft not in (0, self.graph.last):
                centre = self._axes(gear).T @ self.centre(gear)[:2] + self._carried(shaft)
                found = found + lumped.mass * own.in_a_turn * (QUARTER_TURN @ own.places[shaft - 1]) @ centre
        of_members = {SUN: rotations[0], RING: rotations[-1], CARRIER: own.in_a_turn}
        return found + own.load * of_members[own.output] * self.turned(own.output)

    def motion_of(self, shafts: Sequence[int], turns: Sequence) -> tuple[float, ...]:
        """As of any train, but for what rolls back, and turns with all members, until input and fixed member stand
        where they are prescribed."""
        last = self.graph.last
        turned = np.zeros(last + 1)
        for shaft in shafts:
            turned[shaft] = turns[shaft] / turns[shafts[0]]
        rolling = np.array([-1.0, *map(float, turns[1:])])
        # Of sun, ring and carrier; the teeth of all stay where they touch in rolling and in turning together.
        of_members = {SUN: (turned[0], rolling[0]), RING: (turned[last], rolling[last]), CARRIER: (0.0, 0.0)}
        held = [of_members[member] for member in WITH_RING if member != self.own.output]
        parts = np.linalg.solve([[rolls, 1.0] for _, rolls in held], [-own for own, _ in held])
        whole = turned + parts[0] * rolling + parts[1]
        return self.of_rotations(
            {f"rotation_{shaft}": turn for shaft, turn in enumerate(whole, 1)} | {CARRIER: parts[1]}
        )


def set_drivetrain(
    parts: TrainParts, own: SetInTime, damping: Damping | None, mesh_stiffness: Sequence[float]
) -> Drivetrain:
    """The equations of motion of a set with masses; `mesh_stiffness` as of `train_drivetrain`. Its `angle` is the lag
    of the output."""
    # The load is on the output, which the last shaft need not be.
    parts = replace(parts, loads={})
    rows = RowsOfSet(parts, own)
    as_train = train_drivetrain(parts, rows=rows)
    members = np.array([rows.turned(member) for member in WITH_RING])
    springs = np.diag([own.springs.get(member, 0.0) for member in WITH_RING])
    lumped = {CARRIER: own.carrier}
    lumped[own.output] = lumped.get(own.output, 0.0) + own.load
    masses = np.diag([lumped.get(member, 0.0) for member in WITH_RING])
    frame = rows.in_the_frame()
    output = rows.turned(own.output)
    assert as_train.mass is not None
    undamped = replace(
        as_train,
        stiffness=as_train.stiffness + members.T @ springs @ members - frame.softening,
        load=frame.load + own.behind * own.torque * output,
        mass=as_train.mass + members.T @ masses @ members,
        frame=frame if own.speed else None,
        angle=own.behind * output,
        of_members=members,
    )
    return replace(undamped, damping=damping_of(undamped, damping, np.array(mesh_stiffness)))
