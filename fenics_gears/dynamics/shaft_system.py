"""Elastic shafts with their bearings, condensed onto the motions of their gears: those that one housing ties together,
or one by itself.

At rest a shaft follows its gear, its coupling and its rolling bearings; with a mass it also has modes in which these
are held (R. R. Craig and M. C. C. Bampton, Coupling of substructures for dynamic analyses, AIAA Journal 6 (1968)).
Stiffness then falls apart: that of rest, exact, and of each mode by itself. Modes come from the flexibility of the
nodes, which stiff bearings do not spoil. Gyroscopic moments are left out, as for gears that tilt.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import block_diag, eigh

from .elastic_shaft import FIVE, ROUND_OFF, ElasticShaft, in_series
from .elastic_shaft_seat import BentBySeat, Seat
from .shaft_elements import ARM, SIX, STIFFNESS, Assembly, Element, Held, Link, Springs, carried, motions_of

if TYPE_CHECKING:
    from fenics_gears.effects.bearings import Bearing
    from fenics_gears.inputs.allowed import Matrix

# mm/N that a place moves at least whose motions are coordinates: beside the seat it does as little as does not count.
LEAST_YIELDING = 1e-12
# N/mm of a rolling bearing in a housing, whose own motions are coordinates.
RIGID = 1e6 * STIFFNESS
TILTING = (1.0, 1.0, 1.0, ARM**2, ARM**2)
KINDS = {"bending": [0, 1, 3, 4], "axial": [2], "torsion": [5]}


@dataclass(frozen=True, eq=False)
class ShaftSystem:
    """`shafts` with the stiffness of one `housing` between the seats of all of their bearings (5 b, 5 b), N, mm and
    rad, None where it is rigid; `more`: elements that hold or join their nodes otherwise.

    Its coordinates are those of the gears' middles, of faces that bend, the motions in rolling bearings, and the
    shafts' own modes in mm, each of which has the mass of the shafts.
    """

    shafts: tuple[ElasticShaft, ...]
    housing: Matrix | None = None
    more: tuple[Element, ...] = ()

    @property
    def key(self) -> tuple:
        """What systems have in common that are alike."""
        return self.shafts, self.housing, self.more

    @property
    def bearings(self) -> tuple[Bearing, ...]:
        """The bearings of all shafts, one after the other."""
        return tuple(bearing for shaft in self.shafts for bearing in shaft.bearings)

    @property
    def moved(self) -> tuple[str, ...]:
        """Names of the coordinates that contact moves."""
        of_gears = [name for shaft in self.shafts for name in shaft.of_gear]
        return (*of_gears, *(name for shaft in self.shafts for name in shaft.of_face))

    @property
    def in_rolling(self) -> tuple[str, ...]:
        """Names of the motions in rolling bearings as coordinates."""
        return tuple(name for shaft in self.shafts for name in shaft.in_rolling)

    @property
    def modes(self) -> tuple[str, ...]:
        """Names of the coordinates that contact does not move."""
        return (*self.in_rolling, *self.own_modes)

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names (k,) of the coordinates that the shafts' bending and their bearings act on."""
        return (*self.moved, *self.modes)

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Of shafts and bearings over the coordinates (k, k)."""
        at_rest = self._bending.T @ self._held.stiffness @ self._bending
        for shaft in self.shafts:
            if shaft.of_face:
                own = [self.moved.index(name) for name in shaft.of_face]
                at_rest[np.ix_(own, own)] += self.seat(shaft).stiffness_of_face
        return block_diag(0.5 * (at_rest + at_rest.T), np.diag(self._vibrations[0]))

    @cached_property
    def damping(self) -> np.ndarray:
        """Of the elements over the coordinates (k, k), N s/mm."""
        assembly = self._held.assembly
        moved = self._moved(assembly.names)
        return moved.T @ assembly.sum("damping") @ moved

    @cached_property
    def gear_stiffness(self) -> np.ndarray:
        """Of shafts and bearings at the middles of all gears (5 g, 5 g) on rigid seats: their loads per motion."""
        found = self.rigid.T @ self._at_rest.stiffness @ self.rigid
        return 0.5 * (found + found.T)

    def stiffness_at(self, shaft: ElasticShaft) -> np.ndarray:
        """The same (5, 5) of the gear on one shaft, with no load on the other."""
        if len(self.shafts) == 1:
            return self.gear_stiffness
        first = FIVE * self.shafts.index(shaft)
        own = slice(first, first + FIVE)
        return np.linalg.inv(np.linalg.inv(self.gear_stiffness)[own, own])

    def torsional_stiffness(self, shaft: ElasticShaft) -> float:
        """Of a shaft between gear and coupling, N mm/rad; infinite where the torque is coupled within the seat."""
        if shaft.coupled_within:
            return inf
        place = self._ends.index(*shaft.coupling(shaft.chain))
        return float(self._at_rest.stiffness[place, place])

    @cached_property
    def springs(self) -> np.ndarray:
        """Stiffness (5 b, 5 b) of all bearings in their housing, those that roll as under an even load."""
        found = block_diag(*(each.matrix for each in self.bearings))
        return found if self.housing is None else in_series(found, np.array(self.housing))

    @cached_property
    def bearing_stiffness(self) -> np.ndarray:
        """The part (k, k) of the stiffness whose energy is in bearings and housing."""
        found = np.zeros((len(self.coordinates),) * 2)
        for each in self._springs:
            found += self._moved(each.motions).T @ self._loads_on(each)
        return found

    @cached_property
    def at_bearings(self) -> np.ndarray:
        """Motions (5 b, k) of the shafts in their bearings per coordinate."""
        return self._moved(self._rings)

    @cached_property
    def bearing_loads(self) -> np.ndarray:
        """Loads (5 b, k) of the shafts on their bearings per coordinate."""
        loads: dict[str, np.ndarray] = {}
        # The housing is the last: what rolls carries by its own springs.
        for each in reversed(self._springs):
            loads |= dict(zip(each.motions, self._loads_on(each)))
        return np.array([loads[name] for name in self._in_bearings])

    @cached_property
    def bearings_at_rest(self) -> np.ndarray:
        """Motions (5 b, 5 g) in the bearings per motion of the gears on rigid seats, at rest."""
        return self._at_rest.motions_of(self._in_bearings) @ self.rigid

    @cached_property
    def free_of_rolling(self) -> Held:
        """The shafts at rest without their rolling bearings, in which they are free, over what `rigid` moves."""
        return self._assembled(loaded=False).held(self._ends)

    @property
    def in_rolling_motions(self) -> tuple[str, ...]:
        """Names of the motions in rolling bearings."""
        return tuple(name for shaft in self.shafts for number in shaft.rolling for name in shaft.in_bearing(number))

    @cached_property
    def rigid(self) -> np.ndarray:
        """Motions of both ends of all faces, and of couplings, per motion (5 g) of the gears on rigid seats."""
        return self._bending[: len(self._ends), : FIVE * len(self.shafts)]

    # Seats.

    def seat(self, shaft: ElasticShaft) -> Seat:
        """The seat of a shaft's gear between what holds it on either side."""
        own, carry = self._face(shaft)
        return Seat(shaft, carry.T @ self._at_rest.stiffness[np.ix_(own, own)] @ carry)

    def bent_by_seat(self, shaft: ElasticShaft, heights: np.ndarray, places: np.ndarray) -> BentBySeat:
        """A shaft whose gear is loaded at `heights` (h,), mm from its middle, and `places` (p,), mm from the left end:
        what is beside the face follows its ends."""
        within = (places > shaft.seat_ends[0]) & (places < shaft.seat_ends[1])
        found = self.seat(shaft).under(heights, places[within] - shaft.gear_at)
        own, carry = self._face(shaft)
        ends = carry @ found.ends.reshape(2 * SIX, -1)
        line = np.zeros((len(places), FIVE, len(heights), SIX))
        line[within] = found.axis[:, :FIVE]
        beside = self._beside(shaft, places[~within], ()) @ np.eye(len(self._ends))[:, own]
        line[~within] = (beside @ ends).reshape(-1, *line.shape[1:])
        moved = self._at_rest.motions_of(self._in_bearings)[:, own] @ ends
        loads = self.springs @ moved
        return BentBySeat(found.compliance, line, loads.reshape(-1, *line.shape[2:]))

    def deflection(self, shaft: ElasticShaft, places: Sequence[float]) -> np.ndarray:
        """Motions (p, 5, k) of places on a shaft's axis (mm from its left end) per coordinate."""
        at = np.asarray(places, dtype=float)
        within = (at >= shaft.seat_ends[0]) & (at <= shaft.seat_ends[1])
        bent = np.zeros((len(at), FIVE, self._bending.shape[1]))
        heights = at[within] - shaft.gear_at
        columns = [self.moved.index(name) for name in shaft.of_gear]
        inside = np.zeros((len(heights), *bent.shape[1:]))
        inside[:, :, columns] = np.reshape([carried(each)[:FIVE, :FIVE] for each in heights], (-1, FIVE, FIVE))
        if shaft.of_face:
            columns = [self.moved.index(name) for name in shaft.of_face]
            inside[:, :, columns] = self.seat(shaft).axis_follows(heights)[:, :FIVE]
        bent[within] = inside
        bent[~within] = self._beside(shaft, at[~within], self.in_rolling_motions) @ self._bending
        nodes = range(len(shaft.chain.places))
        shapes = self._shapes[self._nodes.numbers(name for node in nodes for name in motions_of(shaft.gear, node))]
        own = [np.interp(at, shaft.chain.places, each) for each in shapes.reshape(len(nodes), -1).T]
        vibrating = np.reshape(own, (SIX, -1, len(at)))[:FIVE]
        return np.concatenate([bent, np.moveaxis(vibrating, 2, 0)], axis=2)

    # With mass.

    @cached_property
    def mass(self) -> np.ndarray:
        """Over all given motions and the modes (g + m, g + m), N, mm, s and rad."""
        moved = np.concatenate([self._nodes_at_rest, self._shapes], axis=1)
        return moved.T @ self._mass_of_nodes @ moved

    def mass_over(self, names: Sequence[str]) -> tuple[np.ndarray, np.ndarray]:
        """The mass (k, k) over a drivetrain's coordinates of such names, in N, mm, s and rad; and the momentum (k,)
        over these per speed (rad/s) of the prescribed rotation of a whole input shaft, as far as it is not that of the
        gear."""
        moved = np.zeros((len(self.mass), len(names)))
        places = [names.index(name) for name in self.coordinates]
        moved[:, places] = block_diag(self._selected(self._bending_names), np.eye(len(self.own_modes)))
        turning = np.zeros(len(self.mass))
        given = len(self._given)
        for shaft in self.shafts:
            for name, turned in shaft.turned_by.items():
                if name in names:
                    moved[:given, names.index(name)] = self._selected(turned).sum(axis=1)
            if shaft.driven:
                gear = self._selected(motions_of(shaft.gear, "gear")[-1:]).sum(axis=1)
                turning[:given] += self._selected(shaft.coupling(shaft.chain)).sum(axis=1)
                turning[:given] += gear * (shaft.rotation not in names)
        return moved.T @ self.mass @ moved, moved.T @ self.mass @ turning

    @cached_property
    def own_modes(self) -> tuple[str, ...]:
        """Names of the shafts' own modes, by frequency."""
        energies = self._shapes * (self._mass_of_nodes @ self._shapes)
        counted = dict.fromkeys((shaft.gear for shaft in self.shafts), 0)
        shafts = np.array([name.partition("/")[0] for name in self._nodes.names])
        motions = np.arange(len(shafts)) % SIX
        found = []
        for energy in energies.T:
            gear = max(counted, key=lambda each: energy[shafts == each].sum())
            kind = max(KINDS, key=lambda each: energy[np.isin(motions, KINDS[each])].sum())
            counted[gear] += 1
            found.append(f"{kind}_mode_{counted[gear]}_{gear}")
        return tuple(found)

    @property
    def _shapes(self) -> np.ndarray:
        """Motions (n, m) of all nodes per mode."""
        return self._vibrations[1]

    @cached_property
    def _vibrations(self) -> tuple[np.ndarray, np.ndarray]:
        """Stiffness (m,), N/mm, and shapes (n, m) of the modes in which all that is given is held."""
        names = self._nodes.names
        if not self.vibrates:
            return np.zeros(0), np.zeros((len(names), 0))
        held = self._held
        fixed = {*held.names, *(self._tied if self.housing is None else ())}
        free = [name for name in names if name in held.assembly and name not in fixed]
        nodes = self._nodes.numbers(free)
        places = held.assembly.numbers(free)
        root = np.linalg.cholesky(self._mass_of_nodes[np.ix_(nodes, nodes)])
        flexible = root.T @ held.flexibility[np.ix_(places, places)] @ root
        slowest = (2.0 * np.pi * min(shaft.up_to for shaft in self.shafts)) ** -2
        squares, found = eigh(0.5 * (flexible + flexible.T), subset_by_value=(slowest, np.inf))
        own = sum(shaft.mass_of_all for shaft in self.shafts)
        shapes = np.zeros((len(names), len(squares)))
        shapes[nodes] = np.sqrt(own) * np.linalg.solve(root.T, found)
        return own / squares[::-1], shapes[:, ::-1]

    @property
    def vibrates(self) -> bool:
        """Whether the shafts have a mass."""
        return any(shaft.density for shaft in self.shafts)

    @cached_property
    def _nodes(self) -> Assembly:
        """All beams, also those within the faces."""
        return Assembly(beam for shaft in self.shafts for beam in (*shaft.chain.beside, *shaft.chain.within))

    @cached_property
    def _mass_of_nodes(self) -> np.ndarray:
        return self._nodes.sum("mass")

    @cached_property
    def _nodes_at_rest(self) -> np.ndarray:
        """Motions (n, g) of all nodes per given one."""
        names = self._nodes.names
        known = [name in self._held.assembly for name in names]
        found = np.zeros((len(names), len(self._given)))
        found[known] = self._held.motions_of(each for each, has in zip(names, known) if has) @ self._of_given
        for shaft in self.shafts:
            left, right = shaft.chain.faces[0]
            for node in range(left + 1, right):
                rows = self._nodes.numbers(motions_of(shaft.gear, node))
                height = shaft.chain.places[node] - shaft.gear_at
                found[rows] = carried(height) @ self._selected(motions_of(shaft.gear, "gear")).T
                if shaft.of_face:
                    bent = self.seat(shaft).axis_follows(np.array([height]))[0]
                    found[rows] += bent @ self._selected(motions_of(shaft.gear, "face")).T
        return found

    # Names and elements.

    @cached_property
    def _given(self) -> tuple[str, ...]:
        """Names (g,) of all motions that others follow at rest."""
        found: list[str] = []
        for shaft in self.shafts:
            found += motions_of(shaft.gear, "gear")
            found += motions_of(shaft.gear, "face") if shaft.of_face else ()
            found += shaft.coupling(shaft.chain)
        return (*found, *self.in_rolling_motions)

    @cached_property
    def _bending_names(self) -> tuple[str, ...]:
        """Those that are coordinates, in the order of these."""
        of_gears = [name for shaft in self.shafts for name in motions_of(shaft.gear, "gear")[:FIVE]]
        of_faces = [name for shaft in self.shafts if shaft.of_face for name in motions_of(shaft.gear, "face")]
        return (*of_gears, *of_faces, *self.in_rolling_motions)

    def _selected(self, names: Sequence[str]) -> np.ndarray:
        """Given motions (g, n) per one of such names."""
        return np.array([[float(each == name) for name in names] for each in self._given])

    @cached_property
    def _ends(self) -> tuple[str, ...]:
        """Names of the motions of both ends of all faces, and of the turns of couplings."""
        return self._ends_of(())

    def _ends_of(self, chains) -> tuple[str, ...]:
        found: list[str] = []
        for shaft, chain in zip(self.shafts, chains or self._chains):
            left, right = shaft.ends(chain)
            found += [*left, *right, *shaft.coupling(chain)]
        return tuple(found)

    @cached_property
    def _of_given(self) -> np.ndarray:
        """Motions of `_ends` and in rolling bearings per given one."""
        found = np.zeros((len(self._held.names), len(self._given)))
        for shaft in self.shafts:
            own, carry = self._face(shaft)
            gear = np.concatenate([np.eye(SIX)] * 2) @ self._selected(motions_of(shaft.gear, "gear")).T
            if shaft.of_face:
                gear += self.seat(shaft).apart @ self._selected(motions_of(shaft.gear, "face")).T
            found[own] = carry @ gear
        for number, name in enumerate(self._held.names):
            if name in self._given:
                found[number] = self._selected((name,))[:, 0]
        return found

    @cached_property
    def _bending(self) -> np.ndarray:
        """The same per coordinate but for modes."""
        return self._of_given @ self._selected(self._bending_names)

    def _face(self, shaft: ElasticShaft) -> tuple[list[int], np.ndarray]:
        """Numbers (12,) of the motions of both ends of a face among `_ends`, and these motions per motion of either end
        as one of the gear's middle."""
        left, right = shaft.ends(shaft.chain)
        own = [self._ends.index(name) for name in (*left, *right)]
        return own, block_diag(carried(-0.5 * shaft.seat), carried(0.5 * shaft.seat))

    @property
    def _chains(self) -> list:
        return [shaft.chain for shaft in self.shafts]

    @property
    def _rings(self) -> tuple[str, ...]:
        """Names (5 b,) of the motions of the rings on the shafts."""
        return tuple(
            name for shaft in self.shafts for number in range(len(shaft.bearings)) for name in shaft.ring(number)
        )

    @property
    def _in_bearings(self) -> tuple[str, ...]:
        """Names (5 b,) of the motions in the bearings."""
        return tuple(
            name
            for shaft in self.shafts
            for number, bearing in enumerate(shaft.bearings)
            for name in (shaft.ring(number) if bearing.rolling is None else shaft.in_bearing(number))
        )

    @property
    def _tied(self) -> Iterator[str]:
        """Names of the motions of nodes in rolling bearings."""
        for shaft in self.shafts:
            yield from (name for number in shaft.rolling for name in shaft.at_bearing(shaft.chain, number))

    @cached_property
    def _held(self) -> Held:
        return self._assembled().held((*self._ends, *self.in_rolling_motions))

    @cached_property
    def _at_rest(self) -> Held:
        """With rolling bearings as under an even load."""
        return self._held if not self.in_rolling else self._assembled().held(self._ends)

    def _beside(self, shaft: ElasticShaft, places: np.ndarray, more: Sequence[str]) -> np.ndarray:
        """Motions (p, 5, h) of places beside a shaft's face per motion of `_ends` and of `more`."""
        chains = [each.chain_with(places) if each is shaft else each.chain for each in self.shafts]
        held = self._assembled(chains).held((*self._ends_of(chains), *more))
        chain = chains[self.shafts.index(shaft)]
        found = [held.motions_of(shaft.motions_at(chain, place)) for place in places]
        return np.reshape(found, (len(places), FIVE, len(held.names)))

    @property
    def _springs(self) -> list[Springs]:
        return [each for each in self._held.assembly.elements if isinstance(each, Springs)]

    def _moved(self, names: Sequence[str]) -> np.ndarray:
        """Motions (n, k) per coordinate."""
        at_rest = self._held.motions_of(names) @ self._bending
        vibrating = np.zeros((len(names), self._shapes.shape[1]))
        known = [number for number, name in enumerate(names) if self._node_of.get(name, name) in self._nodes]
        nodes = (self._node_of.get(names[number], names[number]) for number in known)
        vibrating[known] = self._shapes[self._nodes.numbers(nodes)]
        return np.concatenate([at_rest, vibrating], axis=1)

    def _loads_on(self, element: Element) -> np.ndarray:
        """Loads (n, k) on an element per coordinate."""
        at_rest = self._held.loads_on(element) @ self._bending
        vibrating = element.stiffness @ self._moved(element.motions)[:, self._bending.shape[1] :]
        return np.concatenate([at_rest, vibrating], axis=1)

    @cached_property
    def _node_of(self) -> dict[str, str]:
        """The motion of a node that each ring has."""
        found: dict[str, str] = {}
        for shaft in self.shafts:
            for number in range(len(shaft.bearings)):
                found |= dict(zip(shaft.ring(number), shaft.at_bearing(shaft.chain, number)))
        return found

    def _assembled(self, chains=None, loaded: bool = True) -> Assembly:
        """The sum of all elements, of shafts with such `chains`; without rolling bearings where it is not `loaded`."""
        elements: list[Element] = [*self.more]
        matrices = []
        for shaft, chain in zip(self.shafts, chains or self._chains):
            elements += chain.beside
            for number, bearing in enumerate(shaft.bearings):
                ring = shaft.ring(number)
                inner = shaft.in_bearing(number)
                elements.append(Link((*ring, *shaft.at_bearing(chain, number))))
                rolls = bearing.rolling is not None
                if rolls and self.housing is None:
                    at_face = any(abs(bearing.at - end) <= ROUND_OFF for end in shaft.seat_ends)
                    elements.append(Link((*ring, *inner), LEAST_YIELDING if at_face else 0.0))
                elif self.housing is None:
                    elements.append(Springs(ring, np.array(bearing.matrix)))
                if rolls and loaded:
                    elements.append(Springs(inner, np.array(bearing.matrix)))
                matrices.append(RIGID * np.diag(TILTING) if rolls else np.array(bearing.matrix))
        if self.housing is not None:
            elements.append(self._in_housing(in_series(block_diag(*matrices), np.array(self.housing))))
        return Assembly(elements, self._ends_of(chains))

    def _in_housing(self, springs: np.ndarray) -> Springs:
        """All bearings on the housing; in those that roll the motion in them is apart."""
        rolling = [each.rolling is not None for each in self.bearings]
        apart = np.eye(len(springs))[:, np.repeat(rolling, FIVE)]
        rows = np.concatenate([np.eye(len(springs)), -apart], axis=1)
        return Springs((*self._rings, *self.in_rolling_motions), springs, rows)
