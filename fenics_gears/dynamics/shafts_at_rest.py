"""Elastic shafts with their bearings at rest: those that one housing ties together, or one by itself.

All follow their gears, their couplings and the motions in their rolling bearings.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import block_diag

from .elastic_shaft import FIVE, ROUND_OFF, Chain, ElasticShaft, SeatedGear, in_series
from .elastic_shaft_seat import Seat
from .shaft_elements import ARM, SIX, STIFFNESS, Assembly, Element, Held, Link, Springs, carried

if TYPE_CHECKING:
    from fenics_gears.inputs.allowed import Matrix

    from .bearings import Bearing

# Flexibility, mm/N, between a rolling bearing and the end of a seat at the same place: none would have no inverse, and
# so little changes nothing.
LEAST_YIELDING = 1e-12
# N/mm of a rolling bearing in a housing, whose own motions are coordinates.
RIGID = 1e6 * STIFFNESS
TILTING = (1.0, 1.0, 1.0, ARM**2, ARM**2)


@dataclass(frozen=True, eq=False)
class ShaftsAtRest:
    """`shafts` with the stiffness of one `housing` between the seats of all of their bearings (5 b, 5 b), N, mm and
    rad, None where it is rigid; `more`: elements that hold or join their nodes otherwise; `load` (5 g,): of their
    gears, under which rolling bearings are as stiff as they are, none at rest."""

    shafts: tuple[ElasticShaft, ...]
    housing: Matrix | None = None
    more: tuple[Element, ...] = ()
    load: tuple[float, ...] = ()

    @property
    def key(self) -> tuple:
        """What systems have in common that are alike."""
        return self.shafts, self.housing, self.more

    @cached_property
    def seated(self) -> tuple[tuple[ElasticShaft, SeatedGear], ...]:
        """The gears of all shafts, one after the other, with the shafts that they are on."""
        return tuple((shaft, seat) for shaft in self.shafts for seat in shaft.seats)

    def shaft_of(self, seat: SeatedGear) -> ElasticShaft:
        """The shaft that a gear is on."""
        return next(shaft for shaft, each in self.seated if each.gear == seat.gear)

    @property
    def bearings(self) -> tuple[Bearing, ...]:
        """The bearings of all shafts, one after the other."""
        return tuple(bearing for shaft in self.shafts for bearing in shaft.bearings)

    @property
    def rings(self) -> tuple[str, ...]:
        """Names (5 b,) of the motions of the rings on the shafts."""
        return tuple(
            name for shaft in self.shafts for number in range(len(shaft.bearings)) for name in shaft.ring(number)
        )

    @property
    def in_bearings(self) -> tuple[str, ...]:
        """Names (5 b,) of the motions in the bearings."""
        return tuple(
            name
            for shaft in self.shafts
            for number, bearing in enumerate(shaft.bearings)
            for name in (shaft.ring(number) if bearing.rolling is None else shaft.in_bearing(number))
        )

    @property
    def in_rolling_motions(self) -> tuple[str, ...]:
        """Names of the motions in rolling bearings."""
        return tuple(name for shaft in self.shafts for number in shaft.rolling for name in shaft.in_bearing(number))

    @cached_property
    def given(self) -> tuple[str, ...]:
        """Names (g,) of all motions that others follow at rest."""
        names: list[str] = []
        for shaft in self.shafts:
            for seat in shaft.seats:
                names += seat.motions
                names += seat.apart if shaft.of_face(seat) else ()
            names += shaft.coupling(shaft.chain)
        return (*names, *self.in_rolling_motions)

    @cached_property
    def bending_names(self) -> tuple[str, ...]:
        """Those that are coordinates, in the order of these."""
        of_gears = [name for _, seat in self.seated for name in seat.motions[:FIVE]]
        of_faces = [name for shaft, seat in self.seated if shaft.of_face(seat) for name in seat.apart]
        return (*of_gears, *of_faces, *self.in_rolling_motions)

    def selected(self, names: Sequence[str]) -> np.ndarray:
        """Given motions (g, n) per one of such names."""
        return np.array([[float(each == name) for name in names] for each in self.given])

    @cached_property
    def ends(self) -> tuple[str, ...]:
        """Names of the motions of both ends of all faces, and of the turns of couplings."""
        return self.ends_of([shaft.chain for shaft in self.shafts])

    def ends_of(self, chains: Sequence[Chain]) -> tuple[str, ...]:
        """The same of shafts with such chains."""
        names: list[str] = []
        for shaft, chain in zip(self.shafts, chains):
            for number in range(len(shaft.seats)):
                left, right = shaft.ends(chain, number)
                names += [*left, *right]
            names += shaft.coupling(chain)
        return tuple(names)

    def face(self, seat: SeatedGear) -> tuple[list[int], np.ndarray]:
        """Numbers (12,) of the motions of both ends of a face among `ends`, and these motions per motion of either end
        as one of the gear's middle."""
        shaft = self.shaft_of(seat)
        left, right = shaft.ends(shaft.chain, shaft.seats.index(seat))
        own = [self.ends.index(name) for name in (*left, *right)]
        return own, block_diag(carried(-0.5 * seat.width), carried(0.5 * seat.width))

    @cached_property
    def gear_stiffness(self) -> np.ndarray:
        """Of shafts and bearings at the middles of all gears (5 g, 5 g) on rigid seats: their loads per motion."""
        stiffness = self.rigid.T @ self.at_rest.stiffness @ self.rigid
        return 0.5 * (stiffness + stiffness.T)

    def stiffness_at(self, seat: SeatedGear) -> np.ndarray:
        """The same (5, 5) of one gear, with no load on the others."""
        if len(self.seated) == 1:
            return self.gear_stiffness
        first = FIVE * [each for _, each in self.seated].index(seat)
        own = slice(first, first + FIVE)
        return np.linalg.inv(np.linalg.inv(self.gear_stiffness)[own, own])

    def torsional_stiffness(self, shaft: ElasticShaft) -> float:
        """Of a shaft between two gears, or between gear and coupling, N mm/rad; infinite where nothing of it twists."""
        if len(shaft.turns) < 2:
            return inf
        turned = self.of_given @ self.selected(shaft.turns[:2])
        return float(-(turned.T @ self.held.stiffness @ turned)[0, 1])

    @cached_property
    def springs(self) -> np.ndarray:
        """Stiffness (5 b, 5 b) of all bearings in their housing, those that roll as under an even load."""
        stiffness = block_diag(*(each.matrix for each in self.bearings))
        return stiffness if self.housing is None else in_series(stiffness, np.array(self.housing))

    @cached_property
    def bearings_at_rest(self) -> np.ndarray:
        """Motions (5 b, 5 g) in the bearings per motion of the gears on rigid seats, at rest."""
        return self.at_rest.motions_of(self.in_bearings) @ self.rigid

    @cached_property
    def free_of_rolling(self) -> Held:
        """The shafts at rest without their rolling bearings, in which they are free, over what `rigid` moves."""
        return self.assembled(loaded=False).held(self.ends)

    @cached_property
    def rigid(self) -> np.ndarray:
        """Motions of both ends of all faces, and of couplings, per motion (5 g) of the gears on rigid seats."""
        return self.bending[: len(self.ends), : FIVE * len(self.seated)]

    def seat(self, seat: SeatedGear) -> Seat:
        """The seat of a gear between what holds it on either side."""
        own, carry = self.face(seat)
        return Seat(self.shaft_of(seat), seat, carry.T @ self.at_rest.stiffness[np.ix_(own, own)] @ carry)

    @cached_property
    def held(self) -> Held:
        return self.assembled().held((*self.ends, *self.in_rolling_motions))

    @cached_property
    def at_rest(self) -> Held:
        """With rolling bearings as under an even load."""
        return self.held if not self.in_rolling_motions else self.assembled().held(self.ends)

    @cached_property
    def of_given(self) -> np.ndarray:
        """Motions of `ends` and in rolling bearings per given one."""
        motions = np.zeros((len(self.held.names), len(self.given)))
        for shaft, seat in self.seated:
            own, carry = self.face(seat)
            gear = np.concatenate([np.eye(SIX)] * 2) @ self.selected(seat.motions).T
            if shaft.of_face(seat):
                gear += self.seat(seat).apart @ self.selected(seat.apart).T
            motions[own] = carry @ gear
        for number, name in enumerate(self.held.names):
            if name in self.given:
                motions[number] = self.selected((name,))[:, 0]
        return motions

    @cached_property
    def bending(self) -> np.ndarray:
        """The same per coordinate but for modes."""
        return self.of_given @ self.selected(self.bending_names)

    def shaft_motions(self, shaft: ElasticShaft, places: np.ndarray, more: Sequence[str]) -> np.ndarray:
        """Motions (p, 5, h) of places beside a shaft's faces per motion of `ends` and of `more`."""
        chains = [each.chain_with(places) if each is shaft else each.chain for each in self.shafts]
        held = self.assembled(chains).held((*self.ends_of(chains), *more))
        chain = chains[self.shafts.index(shaft)]
        motions = [held.motions_of(shaft.motions_at(chain, place)) for place in places]
        return np.reshape(motions, (len(places), FIVE, len(held.names)))

    def assembled(self, chains: Sequence[Chain] = (), loaded: bool = True) -> Assembly:
        """The sum of all elements, of shafts with such chains, their own unless given; without rolling bearings where
        it is not `loaded`."""
        chains = chains or [shaft.chain for shaft in self.shafts]
        elements: list[Element] = [*self.more]
        for shaft, chain in zip(self.shafts, chains):
            elements += chain.outside
            for number in range(len(shaft.bearings)):
                elements += self.of_bearing(shaft, chain, number, loaded)
        if self.housing is not None:
            rigid = RIGID * np.diag(TILTING)
            matrices = (rigid if each.rolling is not None else np.array(each.matrix) for each in self.bearings)
            elements.append(self.in_housing(in_series(block_diag(*matrices), np.array(self.housing))))
        return Assembly(elements, self.ends_of(chains))

    def of_bearing(self, shaft: ElasticShaft, chain: Chain, number: int, loaded: bool) -> Iterator[Element]:
        """The ring of a bearing on its shaft, and what it is on by itself."""
        bearing = shaft.bearings[number]
        ring = shaft.ring(number)
        inner = shaft.in_bearing(number)
        yield Link((*ring, *shaft.at_bearing(chain, number)))
        if bearing.rolling is not None and loaded:
            yield Springs(inner, np.array(bearing.matrix))
        if self.housing is None:
            at_face = any(abs(bearing.at - end) <= ROUND_OFF for seat in shaft.seats for end in seat.ends)
            rolls = Link((*ring, *inner), LEAST_YIELDING if at_face else 0.0)
            yield Springs(ring, np.array(bearing.matrix)) if bearing.rolling is None else rolls

    def in_housing(self, springs: np.ndarray) -> Springs:
        """All bearings on the housing; in those that roll the motion in them is apart."""
        rolling = [each.rolling is not None for each in self.bearings]
        apart = np.eye(len(springs))[:, np.repeat(rolling, FIVE)]
        rows = np.concatenate([np.eye(len(springs)), -apart], axis=1)
        return Springs((*self.rings, *self.in_rolling_motions), springs, rows)
