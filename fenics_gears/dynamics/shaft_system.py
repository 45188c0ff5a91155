"""Elastic shafts condensed onto the coordinates of a drivetrain.

At rest a shaft follows its gear, its coupling and its rolling bearings (`shafts_at_rest`); with a mass it also has
modes in which these are held (R. R. Craig and M. C. C. Bampton, Coupling of substructures for dynamic analyses, AIAA
Journal 6 (1968)). Stiffness then falls apart: that of rest, exact, and of each mode by itself. Modes come from the
flexibility of the nodes, which stiff bearings do not spoil. Gyroscopic moments are left out, as for gears that tilt.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import block_diag, eigh

from .beam import Beam
from .elastic_shaft import FIVE, ElasticShaft, SeatedGear
from .shaft_elements import SIX, Assembly, Element, Springs, carried, motions_of
from .shafts_at_rest import ShaftsAtRest

KINDS = {"bending": [0, 1, 3, 4], "axial": [2], "torsion": [5]}


@dataclass(frozen=True, eq=False)
class ShaftSystem(ShaftsAtRest):
    """Shafts over the coordinates of the gears' middles, of faces that bend, the motions in rolling bearings, and the
    shafts' own modes in mm, each of which has the mass of the shafts."""

    @property
    def moved(self) -> tuple[str, ...]:
        """Names of the coordinates that contact moves."""
        of_gears = [name for _, seat in self.seated for name in seat.of_gear]
        return (*of_gears, *(name for shaft, seat in self.seated for name in shaft.of_face(seat)))

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

    def coordinates_of(self, shaft: ElasticShaft) -> tuple[str, ...]:
        """Names of those of one shaft."""
        of_gears = (name for each in shaft.seats for name in (*each.of_gear, *shaft.of_face(each)))
        own = (name for name in self.own_modes if name.endswith(f"_{shaft.name}"))
        return (*of_gears, *shaft.in_rolling, *own)

    @cached_property
    def motions(self) -> tuple[str, ...]:
        """Names (g + m,) of all given motions and of the modes."""
        return (*self.given, *self.own_modes)

    @cached_property
    def of_coordinates(self) -> np.ndarray:
        """Numbers (k,) of the coordinates among the motions: all but the turns of gears and couplings."""
        return np.array([self.motions.index(name) for name in (*self.bending_names, *self.own_modes)], dtype=int)

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Of shafts and bearings over the coordinates (k, k)."""
        return self.stiffness_of_motions[np.ix_(self.of_coordinates, self.of_coordinates)]

    @cached_property
    def stiffness_of_motions(self) -> np.ndarray:
        """Of shafts and bearings over all motions (g + m, g + m), N, mm and rad."""
        at_rest = self.of_given.T @ self.held.stiffness @ self.of_given
        for shaft, seat in self.seated:
            if shaft.of_face(seat):
                own = [self.given.index(name) for name in seat.apart]
                at_rest[np.ix_(own, own)] += self.seat(seat).stiffness_of_face
        return block_diag(0.5 * (at_rest + at_rest.T), np.diag(self._vibrations[0]))

    def over(self, moved: np.ndarray, matrix: str) -> np.ndarray:
        """The `stiffness`, its part in bearings, `bearing_stiffness`, the `damping` or the `mass` over k coordinates
        that move all motions by rows `moved` (g + m, k)."""
        if matrix == "mass":
            return moved.T @ self.mass @ moved
        if matrix != "stiffness":
            own = moved[self.of_coordinates]
            return own.T @ getattr(self, matrix) @ own
        moved = moved.copy()
        # No shaft resists its turning as a whole: what it resists is taken from differences, exact however stiff it is.
        for shaft in self.shafts:
            turns = [self.motions.index(name) for name in shaft.turns]
            moved[turns] -= moved[turns[0]]
        return moved.T @ self.stiffness_of_motions @ moved

    @cached_property
    def damping(self) -> np.ndarray:
        """Of the elements over the coordinates (k, k), N s/mm."""
        assembly = self.held.assembly
        moved = self._moved(assembly.names)
        return moved.T @ assembly.sum("damping") @ moved

    @cached_property
    def bearing_stiffness(self) -> np.ndarray:
        """The part (k, k) of the stiffness whose energy is in bearings and housing."""
        stiffness = np.zeros((len(self.coordinates),) * 2)
        for each in self._springs:
            stiffness += self._moved(each.motions).T @ self._loads_on(each)
        return stiffness

    @cached_property
    def at_bearings(self) -> np.ndarray:
        """Motions (5 b, k) of the shafts in their bearings per coordinate."""
        return self._moved(self.rings)

    @cached_property
    def bearing_loads(self) -> np.ndarray:
        """Loads (5 b, k) of the shafts on their bearings per coordinate."""
        loads: dict[str, np.ndarray] = {}
        # The housing is the last: what rolls carries by its own springs.
        for each in reversed(self._springs):
            loads |= dict(zip(each.motions, self._loads_on(each)))
        return np.array([loads[name] for name in self.in_bearings])

    def bent_by_seat(self, seat: SeatedGear, heights: np.ndarray, places: np.ndarray) -> np.ndarray:
        """Motions (p, 5, h, 6) of places (p,), mm from the left end, by loads of the teeth at `heights` (h,), mm from
        the gear's middle, where the seat gives way, beside what coordinates do: what is beside the face follows its
        ends. No bearing feels them."""
        within = (places > seat.ends[0]) & (places < seat.ends[1])
        yielding = self.seat(seat).under(heights, places[within] - seat.at)
        own, carry = self.face(seat)
        ends = carry @ yielding.ends.reshape(2 * SIX, -1)
        line = np.zeros((len(places), FIVE, len(heights), SIX))
        line[within] = yielding.axis[:, :FIVE]
        outside = self.shaft_motions(self.shaft_of(seat), places[~within], ()) @ np.eye(len(self.ends))[:, own]
        line[~within] = (outside @ ends).reshape(-1, *line.shape[1:])
        return line

    def deflection(self, shaft: ElasticShaft, places: Sequence[float]) -> np.ndarray:
        """Motions (p, 5, k) of places on a shaft's axis (mm from its left end) per coordinate."""
        at = np.asarray(places, dtype=float)
        bent = np.zeros((len(at), FIVE, self.bending.shape[1]))
        beside = np.ones(len(at), dtype=bool)
        for seat in shaft.seats:
            within = (at >= seat.ends[0]) & (at <= seat.ends[1])
            heights = at[within] - seat.at
            columns = [self.moved.index(name) for name in seat.of_gear]
            inside = np.zeros((len(heights), *bent.shape[1:]))
            inside[:, :, columns] = np.reshape([carried(each)[:FIVE, :FIVE] for each in heights], (-1, FIVE, FIVE))
            if shaft.of_face(seat):
                columns = [self.moved.index(name) for name in shaft.of_face(seat)]
                inside[:, :, columns] = self.seat(seat).axis_follows(heights)[:, :FIVE]
            bent[within] = inside
            beside &= ~within
        bent[beside] = self.shaft_motions(shaft, at[beside], self.in_rolling_motions) @ self.bending
        nodes = range(len(shaft.chain.places))
        shapes = self._shapes[self._nodes.numbers(name for node in nodes for name in motions_of(shaft.name, node))]
        own = [np.interp(at, shaft.chain.places, each) for each in shapes.reshape(len(nodes), -1).T]
        vibrating = np.reshape(own, (SIX, -1, len(at)))[:FIVE]
        return np.concatenate([bent, np.moveaxis(vibrating, 2, 0)], axis=2)

    @cached_property
    def mass(self) -> np.ndarray:
        """Over all given motions and the modes (g + m, g + m), N, mm, s and rad: of the beams, and of what other
        elements have."""
        moved = np.concatenate([self._nodes_at_rest, self._shapes], axis=1)
        mass = moved.T @ self._mass_of_nodes @ moved
        for each in self.held.assembly.elements:
            if not isinstance(each, Beam) and np.any(each.mass):
                follows = self.held.motions_of(each.motions) @ self.of_given
                own = np.concatenate([follows, self._vibrating(each.motions)], axis=1)
                mass += own.T @ each.mass @ own
        return mass

    def motions_over(self, names: Sequence[str]) -> np.ndarray:
        """All motions (g + m, k) per coordinate of a drivetrain of such names, in mm and rad, as far as the gears'
        turns do not move them."""
        moved = np.zeros((len(self.motions), len(names)))
        moved[self.of_coordinates, [names.index(name) for name in self.coordinates]] = 1.0
        return moved

    def turning(self, turns: Mapping[str, float]) -> np.ndarray:
        """All motions (g + m,) of shafts that turn as a whole by so much, by their names."""
        found = np.zeros(len(self.motions))
        for shaft in self.shafts:
            found[[self.motions.index(name) for name in shaft.turns]] = turns[shaft.name]
        return found

    @cached_property
    def own_modes(self) -> tuple[str, ...]:
        """Names of the shafts' own modes, by frequency."""
        energies = self._shapes * (self._mass_of_nodes @ self._shapes)
        counted = dict.fromkeys((shaft.name for shaft in self.shafts), 0)
        shafts = np.array([name.partition("/")[0] for name in self._nodes.names])
        motions = np.arange(len(shafts)) % SIX
        names = []
        for energy in energies.T:
            shaft = max(counted, key=lambda each: energy[shafts == each].sum())
            kind = max(KINDS, key=lambda each: energy[np.isin(motions, KINDS[each])].sum())
            counted[shaft] += 1
            names.append(f"{kind}_mode_{counted[shaft]}_{shaft}")
        return tuple(names)

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
        held = self.held
        fixed = {*held.names, *(self._tied if self.housing is None else ())}
        free = [name for name in names if name in held.assembly and name not in fixed]
        nodes = self._nodes.numbers(free)
        places = held.assembly.numbers(free)
        root = np.linalg.cholesky(self._mass_of_nodes[np.ix_(nodes, nodes)])
        flexible = root.T @ held.flexibility[np.ix_(places, places)] @ root
        slowest = (2.0 * np.pi * min(shaft.up_to for shaft in self.shafts)) ** -2
        squares, vectors = eigh(0.5 * (flexible + flexible.T), subset_by_value=(slowest, np.inf))
        own = sum(shaft.mass_of_all for shaft in self.shafts)
        shapes = np.zeros((len(names), len(squares)))
        shapes[nodes] = np.sqrt(own) * np.linalg.solve(root.T, vectors)
        return own / squares[::-1], shapes[:, ::-1]

    @property
    def vibrates(self) -> bool:
        """Whether the shafts have a mass."""
        return any(shaft.density for shaft in self.shafts)

    @cached_property
    def _nodes(self) -> Assembly:
        """All beams, also those within the faces."""
        return Assembly(beam for shaft in self.shafts for beam in (*shaft.chain.outside, *shaft.chain.inside))

    @cached_property
    def _mass_of_nodes(self) -> np.ndarray:
        return self._nodes.sum("mass")

    @cached_property
    def _nodes_at_rest(self) -> np.ndarray:
        """Motions (n, g) of all nodes per given one."""
        names = self._nodes.names
        known = [name in self.held.assembly for name in names]
        motions = np.zeros((len(names), len(self.given)))
        motions[known] = self.held.motions_of(each for each, has in zip(names, known) if has) @ self.of_given
        for shaft, seat in self.seated:
            left, right = shaft.chain.faces[shaft.seats.index(seat)]
            for node in range(left + 1, right):
                rows = self._nodes.numbers(motions_of(shaft.name, node))
                height = shaft.chain.places[node] - seat.at
                motions[rows] = carried(height) @ self.selected(seat.motions).T
                if shaft.of_face(seat):
                    motions[rows] += self.seat(seat).axis_follows(np.array([height]))[0] @ self.selected(seat.apart).T
        return motions

    @property
    def _tied(self) -> Iterator[str]:
        """Names of the motions of nodes in rolling bearings."""
        for shaft in self.shafts:
            yield from (name for number in shaft.rolling for name in shaft.at_bearing(shaft.chain, number))

    @property
    def _springs(self) -> list[Springs]:
        return [each for each in self.held.assembly.elements if isinstance(each, Springs)]

    def _moved(self, names: Sequence[str]) -> np.ndarray:
        """Motions (n, k) per coordinate."""
        at_rest = self.held.motions_of(names) @ self.bending
        return np.concatenate([at_rest, self._vibrating(names)], axis=1)

    def _vibrating(self, names: Sequence[str]) -> np.ndarray:
        """Motions (n, m) per mode."""
        vibrating = np.zeros((len(names), self._shapes.shape[1]))
        known = [number for number, name in enumerate(names) if self._node_of.get(name, name) in self._nodes]
        nodes = (self._node_of.get(names[number], names[number]) for number in known)
        vibrating[known] = self._shapes[self._nodes.numbers(nodes)]
        return vibrating

    def _loads_on(self, element: Element) -> np.ndarray:
        """Loads (n, k) on an element per coordinate."""
        at_rest = self.held.loads_on(element) @ self.bending
        vibrating = element.stiffness @ self._moved(element.motions)[:, self.bending.shape[1] :]
        return np.concatenate([at_rest, vibrating], axis=1)

    @cached_property
    def _node_of(self) -> dict[str, str]:
        """The motion of a node that each ring has."""
        motion_of_node: dict[str, str] = {}
        for shaft in self.shafts:
            for number in range(len(shaft.bearings)):
                motion_of_node |= dict(zip(shaft.ring(number), shaft.at_bearing(shaft.chain, number)))
        return motion_of_node
