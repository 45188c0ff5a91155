"""The contact nodes of consecutive steps in one array, so that numpy treats them all at once."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import replace
from functools import cached_property

import numpy as np

from fenics_gears.contact.kinematics import CENTRE_COORDINATES, COLUMNS, COORDINATES, displacement_jacobian, lines_of
from fenics_gears.contact.laws import OPEN
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.operator import ContactOperator, Position
from fenics_gears.contact.tooth_pair import (
    DRIVE,
    Nodes,
    contact_rolls_of,
    flank_points,
    node_ends,
    over_nodes,
    per_node,
)
from fenics_gears.contact.window import ends_of
from fenics_gears.dynamics.steps import Steps
from fenics_gears.geometry.pair import GearPair


def layout(operators: Sequence[ContactOperator], cycle: Cycle, tangential: bool) -> dict[str, np.ndarray]:
    """Properties of the contact nodes (n,) of some positions, in the order of the positions, that do not depend on the
    step. All positions are done at once: a loop over them would take several times as long.

    `index`: of the node's tooth pair at the position. `node`: its place in that pair. `drive`: whether it is on a drive
    flank. `slice`: of the face. `at_end`: whether it is an end of the window. `on_edge` (4, n): on the edge of the
    pinion's tip, of the wheel's tip, and at the form circle of an undercut pinion or wheel. `arcs` (2, n): where it
    touches the pinion's and the wheel's flank, mm along the involute from the base circle. `rows_of_normals` (6, n) and
    `rows_of_tangents` (6, n or 0): reaction of both centres to a unit of each force: force (x, y), N, and torque, N mm.
    Over a face (12, n): then the axial force, N, and the moments about x and y, N mm, of both gears.
    """
    pairs = [pair for operator in operators for pair in operator.pairs]
    face = operators[0].face
    ends = node_ends(pairs)
    offsets = over_nodes(pairs, "offsets")
    places = np.array([(pair.place.index, pair.place.flank, pair.place.slice) for pair in pairs], dtype=int)
    index, flank, number = per_node(pairs, places.reshape(-1, 3)).T
    rolls = contact_rolls_of([pair.place for pair in pairs])
    of_flanks = ends_of(cycle.pair, rolls)
    at_end = np.abs(offsets) >= 0.5 * cycle.grid.length * (1.0 - 1e-9)
    if cycle.grid.inner_length is not None:
        at_end |= _at_inner_end(cycle, offsets, ends, of_flanks)
    columns = {
        "index": index,
        "node": np.arange(len(offsets)) - np.repeat(ends[:-1], np.diff(ends)),
        "drive": flank == DRIVE,
        "slice": number,
        "offsets": offsets,
        "rolls": over_nodes(pairs, "rolls").reshape(2, -1)[0],
        "area": over_nodes(pairs, "lengths") * face.contact_widths[number],
        "at_end": at_end,
    }
    if cycle.traits.has_pressure:
        columns["on_edge"] = _on_edges(cycle, pairs, ends, of_flanks)
        columns["arcs"] = _arcs(cycle.pair, pairs, rolls, offsets, ends)
    rows = _reaction_rows(operators, pairs, tangential)
    normals, tangents = (np.ascontiguousarray(part) for part in np.split(rows, [len(offsets)], axis=1))
    return columns | {"rows_of_normals": normals, "rows_of_tangents": tangents}


def _at_inner_end(cycle: Cycle, offsets: np.ndarray, ends: np.ndarray, of_flanks: np.ndarray) -> np.ndarray:
    """Nodes (n,) that are first or last in a window that is shorter than the whole one, and not on the edge of a
    flank."""
    at_end = np.zeros(len(offsets), dtype=bool)
    round_off = 1e-9 * cycle.grid.length
    first = ends[:-1]
    last = ends[1:] - 1
    at_end[first] = offsets[first] > of_flanks[:, 0].max(axis=1) + round_off
    at_end[last] = offsets[last] < of_flanks[:, 1].min(axis=1) - round_off
    return at_end & (np.abs(np.abs(offsets) - 0.5 * cycle.grid.inner_length) <= cycle.grid.spacing)


def _on_edges(cycle: Cycle, pairs, ends: np.ndarray, of_flanks: np.ndarray) -> np.ndarray:
    """Nodes (4, n) on the edge that ends a flank: the pinion's tip and the wheel's form circle below the line of
    action, the others above.

    `ends` (P + 1,): where the nodes of each pair begin and end; `of_flanks` (P, 2, 2): as in `window.ends_of`.
    """
    on_edge = np.zeros((4, ends[-1]), dtype=bool)
    half = 0.5 * cycle.grid.length * (1.0 - 1e-9)
    cut = [gear.undercut for gear in cycle.pair.gears]
    of_flanks = of_flanks.copy()
    by_line = np.array([pair.place.line is None for pair in pairs], dtype=bool)
    if any(cut) and cycle.corner is not None:
        for pair in np.flatnonzero(~by_line):
            of_flanks[pair] = cycle.corner.ends(cycle.pair, pairs[pair].place)
    first = ends[:-1]
    last = ends[1:] - 1
    below = of_flanks[:, 0].T
    above = of_flanks[:, 1].T
    on_edge[0, first] = by_line & (below[0] >= below[1]) & (below[0] > -half)
    on_edge[1, last] = by_line & (above[1] <= above[0]) & (above[1] < half)
    on_edge[2, last] = cut[0] & (above[0] <= above[1]) & (above[0] < half)
    on_edge[3, first] = cut[1] & (below[1] >= below[0]) & (below[1] > -half)
    return on_edge


def _arcs(gears: GearPair, pairs, contact_rolls: np.ndarray, offsets: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Arcs (2, n) of contact nodes along both flanks; not a number off the line of action, where corners touch."""
    radii = np.array(gears.base_radii)[:, None]
    rolls, _ = flank_points(gears, contact_rolls, radii.repeat(len(pairs), axis=1), offsets, ends)
    by_line = per_node(pairs, np.array([pair.place.line is None for pair in pairs], dtype=bool))
    return np.where(by_line, 0.5 * radii * rolls**2, np.nan)


def _reaction_rows(operators: Sequence[ContactOperator], pairs, tangential: bool) -> np.ndarray:
    """-G^T of all coordinates of both centres, rotations as torques."""
    sides, face = operators[0].sides, operators[0].face
    arms = np.concatenate([each.normal_lever_arms for each in operators], axis=1)
    rows = displacement_jacobian(replace(lines_of(pairs, sides, face), lever_arms=arms), tangential)
    for side, columns in zip(sides, COLUMNS):
        rows[:, columns] *= -np.repeat([1.0, side.gear.base_radius], 3)
    reached = COORDINATES if face.slices > 1 else CENTRE_COORDINATES
    return rows.T[[place for place, name in enumerate(reached) if name != "twist_2"]]


MOST_TIMES_JOINED = 8


class Layouts:
    """The contact nodes of consecutive positions side by side (N,), joined once for each block of the mesh cycle.

    `known`: layouts that hold the nodes of each position, which begin and end at `parts` (s, 2) of all of them one
    after the other. `places` (N,): of these nodes there.
    """

    def __init__(
        self, known: Sequence[dict[str, np.ndarray]], parts: np.ndarray, dependent_rows: np.ndarray, kinds: int
    ):
        counts = parts[:, 1] - parts[:, 0]
        self.starts = np.concatenate(([0], np.cumsum(counts)))
        self.dependent_rows = dependent_rows
        self.step = np.repeat(np.arange(len(counts)), counts)
        # Places of the normal forces among all forces, a step's normals before its tangents.
        self.normal = np.arange(len(self.step)) + (kinds - 1) * np.repeat(self.starts[:-1], counts)
        self.tangential = self.normal + np.repeat(counts, counts)
        self.places = np.arange(len(self.step)) + np.repeat(parts[:, 0] - self.starts[:-1], counts)
        self._known = known
        self._joined: dict[str, np.ndarray] = {}

    def known(self, name: str) -> np.ndarray:
        """Of all nodes of the known layouts, of which those at `places` are these."""
        if len(self._known) == 1:
            return self._known[0][name]
        return np.concatenate([layout[name] for layout in self._known], axis=-1)

    def of(self, name: str) -> np.ndarray:
        if name not in self._joined:
            known = self.known(name)
            as_known = np.array_equal(self.places, np.arange(known.shape[-1]))
            self._joined[name] = known if as_known else known.take(self.places, axis=-1)
        return self._joined[name]


# What the contact nodes of a position are known by.
_Key = tuple[Nodes | None, float]


class KnownLayouts:
    """Layouts of the positions of a cycle, made when first met; runs on the same operators have them in common
    (`Cycle.shared`)."""

    def __init__(self):
        # A layout for each time that positions were met: one of all would be copied with every block of a long cycle.
        self._layouts: list[dict[str, np.ndarray]] = []
        # In which of them the nodes of each position are, where they begin and end there, and its dependent rows.
        self._parts: dict[_Key, tuple[int, int, int, int]] = {}
        self._joined: dict[tuple[_Key, ...], Layouts] = {}

    def joined(self, cycle: Cycle, steps: Steps) -> Layouts:
        key = tuple([(position.nodes, position.index) for position in steps.positions])
        if key not in self._joined:
            new = {each: position for each, position in zip(key, steps.positions) if each not in self._parts}
            if new:
                self._add(cycle, new, steps.kinds)
            parts = np.array([self._parts[each] for each in key])
            numbers, which = np.unique(parts[:, 0], return_inverse=True)
            known = [self._layouts[number] for number in numbers]
            before = np.cumsum([0, *(len(layout["node"]) for layout in known)])[which]
            self._joined[key] = Layouts(known, parts[:, 1:3] + before[:, None], parts[:, 3], steps.kinds)
        return self._joined[key]

    def _add(self, cycle: Cycle, new: dict[_Key, Position], kinds: int) -> None:
        operators = [position.operator for position in new.values()]
        end = 0
        for key, operator in zip(new, operators):
            self._parts[key] = len(self._layouts), end, end + operator.nodes, operator.dependent_rows
            end += operator.nodes
        self._layouts.append(layout(operators, cycle, kinds == 2))

    def forget_beyond(self, positions: int) -> None:
        """Forget all where more are known than so many, as where steps were divided at positions of their own."""
        if len(self._parts) > positions or sum(map(len, self._joined)) > MOST_TIMES_JOINED * positions:
            self.__init__()


class SideBySide:
    """The contact nodes (N,) of consecutive steps, one step's after the other's.

    `step`: the place of the step that each node is of. `slot`: where its tooth pair is kept, pairs being numbered from
    `first_number` on for the pair of index 0 in cycle 0. `normal` and `tangential`: its forces, N, the latter None
    without friction.
    """

    def __init__(self, known: KnownLayouts, cycle: Cycle, steps: Steps, slots: int, first_number: int):
        self.cycle = cycle
        self.slots = slots
        self.first_number = first_number
        self.layouts = known.joined(cycle, steps)
        self.step = self.layouts.step
        self.of = self.layouts.of
        self.cycles = (steps.numbers // self.cycle.steps).astype(int)
        self.number = self.cycles[self.step] - self.of("index") + first_number
        self.slot = self.number % slots
        self._take(steps)

    def _take(self, steps: Steps) -> None:
        self.steps = steps
        self.normal = steps.forces[self.layouts.normal]
        self.tangential = steps.forces[self.layouts.tangential] if steps.kinds == 2 else None

    def with_forces(self, steps: Steps) -> SideBySide:
        """The same nodes with the forces of another run, whose steps have the same positions."""
        other = copy(self)
        other.__dict__.pop("closed", None)
        other._take(steps)
        return other

    def slot_of(self, place: int | np.ndarray, index: int | np.ndarray) -> np.ndarray:
        """Slot of the tooth pair of that index at a step, given by its place; or of many pairs."""
        return (self.cycles[place] - index + self.first_number) % self.slots

    @property
    def drive(self) -> np.ndarray:
        return self.of("drive")

    @cached_property
    def closed(self) -> np.ndarray:
        return self.steps.status != OPEN

    def summed(self, values: np.ndarray) -> np.ndarray:
        """Sum of values (N,) over the nodes of each step."""
        return np.bincount(self.step, values, minlength=len(self.steps))

    def any(self, which: np.ndarray) -> np.ndarray:
        """Whether any node of each step is among those, (N,)."""
        return np.bincount(self.step[which], minlength=len(self.steps)) > 0

    def by_slot(self, values: np.ndarray) -> np.ndarray:
        """Sum of values (N,) over the nodes of each tooth pair (steps, slots)."""
        shape = len(self.steps), self.slots
        return np.bincount(self._slots, values, minlength=np.prod(shape)).reshape(shape)

    def over_nodes(self, values: np.ndarray, drive: bool, absent: float) -> np.ndarray:
        """Values (N,) of drive or coast flanks by step, slot, slice of the face, and contact node; `absent` where there
        is no node."""
        most = self.cycle.grid.most_nodes
        field = np.full((len(self.steps), self.slots, self.cycle.face.slices, most), absent)
        places = self._slices * most + self.of("node")
        if drive and self.drive.all():
            field.reshape(-1)[places] = values
        else:
            chosen = self.drive == drive
            field.reshape(-1)[places[chosen]] = values[chosen]
        return field

    def by_slice(self, values: np.ndarray) -> np.ndarray:
        """Sum of values (N,) over the nodes of each tooth pair in each slice of the face (steps, slots, slices)."""
        shape = len(self.steps), self.slots, self.cycle.face.slices
        return np.bincount(self._slices, values, minlength=np.prod(shape)).reshape(shape)

    @cached_property
    def _slices(self) -> np.ndarray:
        return self._slots * self.cycle.face.slices + self.of("slice")

    @cached_property
    def _slots(self) -> np.ndarray:
        return self.step * self.slots + self.slot

    @cached_property
    def pair_number(self) -> np.ndarray:
        """Number of the tooth pair in each slot (steps, slots); 0 where none is in reach."""
        numbers = np.zeros((len(self.steps), self.slots), dtype=np.int32)
        numbers[self.step, self.slot] = self.number
        return numbers
