"""Gears on an elastic shaft: what the shaft is, and the elements that it is made of.

A shaft is a chain of beams between its nodes: ends, bearings, coupling, and both ends of the face of each gear. Within
a face there is no beam: a seat that is rigid carries both ends of the face as one body, and what one does that gives
way is in `elastic_shaft_seat`. `shaft_system` puts shafts together and condenses them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import ceil, inf
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.linalg import block_diag

from .beam import MASS_POINTS, Beam, beams, masses, properties
from .shaft_elements import MOTIONS as SHAFT_MOTIONS
from .shaft_elements import carried, motions_of

if TYPE_CHECKING:
    from .bearings import Bearing
    from .elastic_shaft_hub import Hub
    from .shafts import ShaftSection

# Names of the coordinates of a gear's middle, without its number; and the gears' numbers.
MOTIONS = ("centre_x", "centre_y", "axial_", "tilt_x", "tilt_y")
NUMBERS = {"pinion": "1", "wheel": "2"}
# The same of a node of the shaft, without the turn, in which bearings do not hold it.
AXES = ("x", "y", "z", "tilt_x", "tilt_y")
FIVE = len(AXES)
# Part of the largest stiffness, tilts taken over the shaft's length, below which a motion is free.
LEAST_HELD = 1e-12
# Elements with a mass are no longer than this part of the shaft.
LONGEST_ELEMENT = 1.0 / 60.0
# Places (mm) that are no further apart are one but for round-off.
ROUND_OFF = 1e-9


class Chain(NamedTuple):
    """Nodes of a shaft at `places` (n,), mm from its left end, one behind the other: numbers of the nodes at both ends
    of each of the `faces`, beams `outside` these and `inside`."""

    places: np.ndarray
    faces: tuple[tuple[int, int], ...]
    outside: tuple[Beam, ...]
    inside: tuple[Beam, ...]

    def nodes(self, places: Sequence[float]) -> np.ndarray:
        """Numbers (p,) of the nodes at places."""
        return np.abs(self.places - np.reshape(places, (-1, 1))).argmin(axis=1)


@dataclass(frozen=True)
class SeatedGear:
    """A `gear` by its name, the middle of whose face is `at` (mm) from the left end of its shaft, and which is `width`
    (mm) wide.

    `integral`: whether it is cut into the shaft, which has the root diameter there and yields (`elastic_shaft_seat`).
    `hub`: the gear's hub and the bore's part of the shaft, which yield under a gear that is pressed on; None where
    neither does.
    """

    gear: str
    at: float
    width: float = 0.0
    integral: bool = False
    hub: Hub | None = None

    @property
    def yields_within(self) -> bool:
        """Whether flanks give way by what does so under the face."""
        return self.integral or self.hub is not None

    @property
    def ends(self) -> tuple[float, float]:
        """Where the face begins and ends, mm from the left end of the shaft."""
        return self.at - 0.5 * self.width, self.at + 0.5 * self.width

    @property
    def of_gear(self) -> tuple[str, ...]:
        """Names (5,) of the coordinates of the gear's middle."""
        number = NUMBERS.get(self.gear, f" of {self.gear}")
        return tuple(f"{name}{number}" for name in MOTIONS)

    @property
    def motions(self) -> tuple[str, ...]:
        """Names (6,) of its motions as one body."""
        return motions_of(self.gear, "gear")

    @property
    def apart(self) -> tuple[str, ...]:
        """Names (6,) of the motions by which the ends of its face move apart."""
        return motions_of(self.gear, "face")


@dataclass(frozen=True)
class ElasticShaft:
    """A shaft by its `name`, that of its gear in a pair: its `sections` of one `material` (Young's modulus, N/mm^2,
    Poisson's ratio), its gears in their `seats` from left to right, where the torque is coupled, mm from the left end,
    None where it is not, and the bearings.

    Of a shaft that vibrates: the sections that are `heavy`, where not all that bend are, its `density`, N s^2/mm^4, and
    the frequency, Hz, `up_to` which it has modes of its own.
    """

    name: str
    sections: tuple[ShaftSection, ...]
    material: tuple[float, float]
    seats: tuple[SeatedGear, ...]
    torque_at: float | None = None
    bearings: tuple[Bearing, ...] = ()
    heavy: tuple[ShaftSection, ...] | None = None
    density: float = 0.0
    up_to: float = inf

    @property
    def length(self) -> float:
        """Length of the shaft, mm."""
        return sum(each.length for each in self.sections)

    @property
    def rolling(self) -> tuple[int, ...]:
        """Numbers of the rolling bearings, in which the shaft's motions are coordinates: their law is one of motions
        there."""
        return tuple(number for number, each in enumerate(self.bearings) if each.rolling is not None)

    @property
    def in_rolling(self) -> tuple[str, ...]:
        """Names of these coordinates."""
        return tuple(f"bearing_{axis}_{number + 1}_{self.name}" for number in self.rolling for axis in AXES)

    def of_face(self, seat: SeatedGear) -> tuple[str, ...]:
        """Names of the coordinates by which the ends of a gear's face move apart: where the seat gives way between
        what holds it on both sides; elsewhere what it does is part of the flanks' compliance."""
        others = [each for each in self.seats if each.gear != seat.gear]
        holding = [*(each.at for each in self.bearings), *(each.at for each in others)]
        if others and self.torque_at is not None:
            holding.append(self.torque_at)
        if not seat.yields_within or len({place > seat.at for place in holding}) < 2:
            return ()
        return tuple(f"face_{motion}_{seat.gear}" for motion in SHAFT_MOTIONS)

    @property
    def mass_of_all(self) -> float:
        """Mass of the whole shaft, N s^2/mm."""
        along = properties(self.heavy or self.sections, self.material, (), MASS_POINTS)
        return self.density * float(along.weights @ (1.0 / along.axial)) / self.material[0]

    @property
    def coupled(self) -> SeatedGear | None:
        """The gear within whose seat the torque is coupled."""
        if self.torque_at is None:
            return None
        return next((each for each in self.seats if each.ends[0] <= self.torque_at <= each.ends[1]), None)

    @cached_property
    def chain(self) -> Chain:
        """With nodes where bearings and coupling are."""
        return self.chain_with(())

    def chain_with(self, stops: Iterable[float]) -> Chain:
        """The same with nodes at more places (mm from the left end)."""
        ends = np.cumsum([0.0, *(each.length for each in self.sections)])
        length = ends[-1]
        places = np.array([0.0, length]) if not self.density else ends
        coupling = () if self.torque_at is None else (self.torque_at,)
        of_faces = (end for seat in self.seats for end in seat.ends)
        for place in (*of_faces, *coupling, *(each.at for each in self.bearings), *stops):
            if np.abs(places - place).min() > ROUND_OFF:
                places = np.sort(np.append(places, place))
        if self.density:
            parts = [
                np.linspace(left, right, ceil((right - left) / (LONGEST_ELEMENT * length)) + 1)[:-1]
                for left, right in pairwise(places)
            ]
            places = np.append(np.concatenate(parts), length)
        faces = []
        for seat in self.seats:
            left, right = np.abs(places - np.reshape(seat.ends, (-1, 1))).argmin(axis=1)
            if left == right:
                # Both ends of a face without width are nodes of their own.
                places = np.insert(places, right, places[right])
                right += 1
            faces.append((int(left), int(right)))
        return self._of_nodes(places, tuple(faces))

    def _of_nodes(self, places: np.ndarray, faces: tuple[tuple[int, int], ...]) -> Chain:
        light = properties(self.sections, self.material, places)
        kinds = np.zeros(len(places) - 1, dtype=bool)
        for left, right in faces:
            kinds[left:right] = True
        weights = np.zeros((len(kinds), 0))
        if self.density:
            # Pieces without length have none.
            long = np.diff(places) > 0.0
            ends = places[np.append(True, long)]
            bent, heavy = (
                properties(of, self.material, ends, MASS_POINTS) for of in (self.sections, self.heavy or self.sections)
            )
            weights = np.zeros((len(kinds), 12, 12))
            weights[long] = masses(bent, heavy, ends, self.density / self.material[0])
        pieces = beams(self.name, range(len(places)), places, light, weights if self.density else ())
        outside = tuple(each for each, own in zip(pieces, kinds) if not own)
        inside = tuple(each for each, own in zip(pieces, kinds) if own)
        return Chain(places, faces, outside, inside)

    def ends(self, chain: Chain, number: int) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Names of the motions of the left and the right end of the face of a gear, by its number on the shaft."""
        left, right = chain.faces[number]
        return motions_of(self.name, left), motions_of(self.name, right)

    def coupling(self, chain: Chain) -> tuple[str, ...]:
        """Name of the turn of the coupling; none where there is none or it turns with a gear."""
        if self.torque_at is None or self.coupled is not None:
            return ()
        return motions_of(self.name, int(chain.nodes([self.torque_at])[0]))[-1:]

    @property
    def turns(self) -> tuple[str, ...]:
        """Names of the turns of its gears and of its coupling."""
        return (*(each.motions[-1] for each in self.seats), *self.coupling(self.chain))

    def motions_at(self, chain: Chain, place: float) -> tuple[str, ...]:
        """Names (5,) of the motions of the node at a place beside the gears, without the turn."""
        # Both ends of a face without width are at one place.
        return motions_of(self.name, int(np.flatnonzero(np.abs(chain.places - place) <= ROUND_OFF)[-1]))[:FIVE]

    def at_bearing(self, chain: Chain, number: int) -> tuple[str, ...]:
        """The same of the node in a bearing."""
        return self.motions_at(chain, self.bearings[number].at)

    def ring(self, number: int) -> tuple[str, ...]:
        """Names (5,) of the motions of a bearing's ring on the shaft."""
        return motions_of(self.name, f"ring {number + 1}")[:FIVE]

    def in_bearing(self, number: int) -> tuple[str, ...]:
        """Names (5,) of the motions in a rolling bearing."""
        return motions_of(self.name, f"bearing {number + 1}")[:FIVE]


def in_series(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Stiffness (n, n) of two springs one behind the other, A (A + B)^-1 B; what neither holds is free.

    No difference of large numbers is taken: it is right however much stiffer one is. W. N. Anderson and R. J. Duffin,
    Series and parallel addition of matrices, Journal of Mathematical Analysis and Applications 26 (1969).
    """
    size = np.sqrt(np.diag(first) + np.diag(second))
    size = np.outer(*2 * [np.where(size > 0.0, size, 1.0)])
    both = first @ (np.linalg.pinv((first + second) / size, hermitian=True) / size) @ second
    return 0.5 * (both + both.T)


def free_motions(shafts: Sequence[ElasticShaft], springs: np.ndarray) -> dict[str, list[str]]:
    """The motions, in words, that bearings of a stiffness (5 b, 5 b) leave each of the shafts free, by its name."""
    of_shafts = []
    for shaft in shafts:
        middle = sum(each.at for each in shaft.bearings) / len(shaft.bearings)
        scale = np.diag([1.0, 1.0, 1.0, 1.0 / shaft.length, 1.0 / shaft.length])
        of_shafts.append(np.concatenate([carried(each.at - middle)[:FIVE, :FIVE] @ scale for each in shaft.bearings]))
    moved = block_diag(*of_shafts)
    held = moved.T @ springs @ moved
    values, vectors = np.linalg.eigh(held)
    free = np.linalg.norm(vectors[:, values <= LEAST_HELD * max(values[-1], 0.0)], axis=1).reshape(-1, FIVE)
    words = ("moves along x", "moves along y", "moves along its axis", "tilts about x", "tilts about y")
    return {shaft.name: [word for word, part in zip(words, parts) if part > 0.1] for shaft, parts in zip(shafts, free)}
