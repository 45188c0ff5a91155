"""A gear on an elastic shaft: what the shaft is, and the elements that it is made of.

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
class Line:
    """A shaft of such a `name` and a `material` (Young's modulus, N/mm^2, Poisson's ratio), its `sections` from left to
    right, and the `faces` of gears on it, from each one's left to its right end, mm from the left end of the shaft; the
    sections by which it is `heavy`, and the `density`, N s^2/mm^4, if it has a mass."""

    name: str
    sections: tuple[ShaftSection, ...]
    material: tuple[float, float]
    faces: tuple[tuple[float, float], ...]
    heavy: tuple[ShaftSection, ...] = ()
    density: float = 0.0

    def chain(self, stops: Iterable[float]) -> Chain:
        """With a node at each of the stops, mm, beside the ends of the shaft and the faces."""
        sections = np.cumsum([0.0, *(each.length for each in self.sections)])
        length = sections[-1]
        places = np.array([0.0, length]) if not self.density else sections
        for place in (*(end for face in self.faces for end in face), *stops):
            if np.abs(places - place).min() > ROUND_OFF:
                places = np.sort(np.append(places, place))
        if self.density:
            parts = [
                np.linspace(left, right, ceil((right - left) / (LONGEST_ELEMENT * length)) + 1)[:-1]
                for left, right in pairwise(places)
            ]
            places = np.append(np.concatenate(parts), length)
        faces = []
        for begin, end in self.faces:
            left, right = np.abs(places - np.reshape([begin, end], (-1, 1))).argmin(axis=1)
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
            bent, heavy = (properties(of, self.material, ends, MASS_POINTS) for of in (self.sections, self.heavy))
            weights = np.zeros((len(kinds), 12, 12))
            weights[long] = masses(bent, heavy, ends, self.density / self.material[0])
        pieces = beams(self.name, range(len(places)), places, light, weights if self.density else ())
        outside = tuple(each for each, own in zip(pieces, kinds) if not own)
        inside = tuple(each for each, own in zip(pieces, kinds) if own)
        return Chain(places, faces, outside, inside)


@dataclass(frozen=True)
class ElasticShaft:
    """The shaft of the "pinion", the "wheel" or another gear by its name: its `sections` of one `material` (Young's
    modulus, N/mm^2, Poisson's ratio), the middle of the gear's seat, mm from the left end, the `seat`'s width, mm,
    where the torque is coupled, and the bearings.

    `integral`: whether the gear is cut into the shaft. Its `sections` then have the root diameter within the face, and
    it yields there (`elastic_shaft_seat`). `hub`: the gear's hub and the bore's part of the shaft, which yield under a
    gear that is pressed on; None where neither does. `in_housing`: whether the bearings are in a housing that yields.

    Of a shaft that carries several gears each has its part: one `goes_on` where its right end is one with the left end
    of the next shaft of its system.

    Of a shaft that vibrates: the sections that are `heavy`, where not all that bend are, its `density`, N s^2/mm^4, and
    the frequency, Hz, `up_to` which it has modes of its own.
    """

    gear: str
    sections: tuple[ShaftSection, ...]
    material: tuple[float, float]
    gear_at: float
    seat: float
    torque_at: float
    bearings: tuple[Bearing, ...]
    integral: bool = False
    in_housing: bool = False
    heavy: tuple[ShaftSection, ...] | None = None
    density: float = 0.0
    up_to: float = inf
    hub: Hub | None = None
    goes_on: bool = False

    @property
    def yields_within(self) -> bool:
        """Whether flanks give way by what does so under the face."""
        return self.integral or self.hub is not None

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
        return tuple(f"bearing_{axis}_{number + 1}_{self.gear}" for number in self.rolling for axis in AXES)

    @property
    def of_gear(self) -> tuple[str, ...]:
        """Names of the coordinates of the gear's middle."""
        number = NUMBERS.get(self.gear, f" of {self.gear}")
        return tuple(f"{name}{number}" for name in MOTIONS)

    @property
    def of_face(self) -> tuple[str, ...]:
        """Names of the coordinates by which the ends of the gear's face move apart: where the seat gives way between
        bearings on both sides that are not alike in all directions across the axis, since what it does then depends on
        the direction; elsewhere it is part of the flanks' compliance."""
        if not self.yields_within or len({each.at > self.gear_at for each in self.bearings}) < 2:
            return ()
        alike = not self.in_housing and all(_is_alike(each) for each in self.bearings)
        return () if alike else tuple(f"face_{motion}_{self.gear}" for motion in SHAFT_MOTIONS)

    @property
    def mass_of_all(self) -> float:
        """Mass of the whole shaft, N s^2/mm."""
        along = properties(self.heavy or self.sections, self.material, (), MASS_POINTS)
        return self.density * float(along.weights @ (1.0 / along.axial)) / self.material[0]

    @property
    def seat_ends(self) -> tuple[float, float]:
        """Where the gear's face begins and ends, mm from the left end of the shaft."""
        return self.gear_at - 0.5 * self.seat, self.gear_at + 0.5 * self.seat

    @property
    def coupled_within(self) -> bool:
        """Whether the torque is coupled within the gear's seat."""
        return self.seat_ends[0] <= self.torque_at <= self.seat_ends[1]

    @cached_property
    def chain(self) -> Chain:
        """With nodes where bearings and coupling are."""
        return self.chain_with(())

    def chain_with(self, places: Iterable[float]) -> Chain:
        """The same with nodes at more places (mm from the left end)."""
        line = Line(
            self.gear, self.sections, self.material, (self.seat_ends,), self.heavy or self.sections, self.density
        )
        return line.chain([self.torque_at, *(each.at for each in self.bearings), *places])

    def ends(self, chain: Chain) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Names of the motions of the left and the right end of the gear's face."""
        left, right = chain.faces[0]
        return motions_of(self.gear, left), motions_of(self.gear, right)

    def coupling(self, chain: Chain) -> tuple[str, ...]:
        """Name of the turn of the coupling; none where it turns with the gear."""
        return () if self.coupled_within else motions_of(self.gear, int(chain.nodes([self.torque_at])[0]))[-1:]

    def motions_at(self, chain: Chain, place: float) -> tuple[str, ...]:
        """Names (5,) of the motions of the node at a place beside the gear, without the turn."""
        nodes = np.flatnonzero(np.abs(chain.places - place) <= ROUND_OFF)
        # Both ends of a face without width are at one place.
        return motions_of(self.gear, int(nodes[-1] if place >= self.gear_at else nodes[0]))[:FIVE]

    def at_bearing(self, chain: Chain, number: int) -> tuple[str, ...]:
        """The same of the node in a bearing."""
        return self.motions_at(chain, self.bearings[number].at)

    def ring(self, number: int) -> tuple[str, ...]:
        """Names (5,) of the motions of a bearing's ring on the shaft."""
        return motions_of(self.gear, f"ring {number + 1}")[:FIVE]

    def in_bearing(self, number: int) -> tuple[str, ...]:
        """Names (5,) of the motions in a rolling bearing."""
        return motions_of(self.gear, f"bearing {number + 1}")[:FIVE]

    @property
    def driven(self) -> bool:
        """Whether the rotation of the coupling is prescribed."""
        return self.gear == "pinion"

    @property
    def rotation(self) -> str:
        """Name of the coordinate of the gear's turn."""
        return f"rotation_{NUMBERS[self.gear]}"

    @property
    def turned_by(self) -> dict[str, tuple[str, ...]]:
        """What the coordinates of turning turn: the gear, and the coupling of an output shaft."""
        gear = motions_of(self.gear, "gear")[-1:]
        if self.driven:
            return {self.rotation: gear}
        coupling = self.coupling(self.chain)
        return {self.rotation: (*gear, *coupling), "shaft_twist": coupling}


def _is_alike(bearing: Bearing) -> bool:
    """Whether a bearing is alike in all directions across the axis."""
    return bearing.stiffness_matrix is None and bearing.rolling is None


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
    """The motions, in words, that bearings of a stiffness (5 b, 5 b) leave the shaft of each gear free."""
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
    return {shaft.gear: [word for word, part in zip(words, parts) if part > 0.1] for shaft, parts in zip(shafts, free)}
