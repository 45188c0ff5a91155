"""The contact nodes of consecutive steps in one array, so that numpy treats them all at once."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from fenics_gears.contact.laws import OPEN
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.operator import ContactOperator, displacement_jacobian, node_slices, over_nodes, per_node
from fenics_gears.contact.tooth_pair import DRIVE
from fenics_gears.contact.window import flank_ends
from fenics_gears.dynamics.march import Record


class Layout:
    """What belongs to the contact nodes (n,) of a position of the gears, whatever the step.

    `index`: of the node's tooth pair at the position; `node`: its place in that pair; `drive`: whether it is on a drive flank; `at_end`:
    whether it stands on an end of the window; `on_tip`: on the edge of the pinion's and of the wheel's tip; `rows` (6, n or 2 n): reaction
    of both centres to a unit of each force: force (x, y), N, and torque, N mm.
    """

    def __init__(self, operator: ContactOperator, cycle: Cycle, tangential: bool):
        # Held, so that no other tuple can have its address.
        self.pairs = pairs = operator.pairs
        counts = [len(pair.offsets) for pair in pairs]
        self.index = per_node(pairs, np.array([pair.place.index for pair in pairs], dtype=int))
        self.node = np.concatenate([np.arange(count) for count in counts] or [np.empty(0, dtype=int)])
        self.drive = per_node(pairs, np.array([pair.place.flank == DRIVE for pair in pairs], dtype=bool))
        self.area, self.offsets, self.rolls = (over_nodes(pairs, name) for name in ("lengths", "offsets", "pinion_roll"))
        self.area = self.area * cycle.pair.face_width
        self.at_end = np.abs(self.offsets) >= 0.5 * cycle.grid.length * (1.0 - 1e-9)
        self.on_tip = _on_tips(cycle, pairs, counts) if cycle.traits.has_pressure else None
        self.rows = _reaction_rows(operator, tangential)


def _on_tips(cycle: Cycle, pairs, counts: Sequence[int]) -> np.ndarray:
    """Nodes (2, n) that stand on the edge that ends a flank: the pinion's tip below the line of action, the wheel's above it."""
    found, half = np.zeros((2, sum(counts)), dtype=bool), 0.5 * cycle.grid.length * (1.0 - 1e-9)
    for pair, nodes in zip(pairs, node_slices(pairs)):
        if pair.place.line is not None:
            continue
        below, above = flank_ends(cycle.pair, pair.place.contact_rolls)
        found[0, nodes.start] = below[0] >= below[1] and below[0] > -half
        found[1, nodes.stop - 1] = above[1] <= above[0] and above[1] < half
    return found


def _reaction_rows(operator: ContactOperator, tangential: bool) -> np.ndarray:
    """-G^T of all six coordinates of both centres, rotations as torques."""
    rows = displacement_jacobian(operator.pairs, operator.base_radii, operator.normal_lever_arms, tangential)
    units = np.concatenate([[1.0, 1.0, radius] for radius in operator.base_radii])
    return -rows.T[:6] * units[:, None]


class SideBySide:
    """The contact nodes (N,) of consecutive records, one record's after the other's.

    `step`: the record each node is of; `slot`: where its tooth pair is kept, pairs being numbered from `first_number` on for the pair of
    index 0 in cycle 0; `layouts`: those that are known, by the address of their pairs; `normal` and `tangential`: its forces, N, the latter None without friction.
    """

    def __init__(self, cycle: Cycle, records: Sequence[Record], layouts: dict[int, Layout], slots: int, first_number: int):
        self.cycle, self.records, self.slots, self.first_number = cycle, records, slots, first_number
        self.layouts = [self._layout(layouts, record) for record in records]
        counts = [len(layout.node) for layout in self.layouts]
        self.step = np.repeat(np.arange(len(records)), counts)
        self.cycles = np.array([record.step // cycle.steps for record in records], dtype=int)
        forces = [record.solution.forces for record in records]
        self.normal = np.concatenate([each[:count] for each, count in zip(forces, counts)])
        tangential = any(len(each) > count for each, count in zip(forces, counts))
        self.tangential = np.concatenate([each[count:] for each, count in zip(forces, counts)]) if tangential else None
        self.number = self.cycles[self.step] - self.of("index") + first_number
        self.slot = self.number % slots

    def _layout(self, layouts: dict[int, Layout], record: Record) -> Layout:
        operator = record.position.operator
        found = layouts.get(id(operator.pairs))
        if found is None:
            found = layouts[id(operator.pairs)] = Layout(operator, self.cycle, len(record.solution.forces) > operator.nodes)
        return found

    def of(self, name: str) -> np.ndarray:
        """An array of the layouts' nodes, side by side."""
        return np.concatenate([getattr(layout, name) for layout in self.layouts], axis=-1)

    def slot_of(self, record: int, index: int) -> int:
        """Slot of the tooth pair of that index at a record, given by its place."""
        return int(self.cycles[record] - index + self.first_number) % self.slots

    @cached_property
    def drive(self) -> np.ndarray:
        """Whether each node (N,) is on a drive flank."""
        return self.of("drive")

    @cached_property
    def closed(self) -> np.ndarray:
        """Whether each node (N,) is closed."""
        return np.concatenate([record.solution.status for record in self.records]) != OPEN

    def summed(self, values: np.ndarray) -> np.ndarray:
        """Sum of values (N,) over the nodes of each record."""
        return np.bincount(self.step, values, minlength=len(self.records))

    def any(self, which: np.ndarray) -> np.ndarray:
        """Whether any node of each record is among those, (N,)."""
        return np.bincount(self.step[which], minlength=len(self.records)) > 0

    def by_slot(self, values: np.ndarray) -> np.ndarray:
        """Sum of values (N,) over the nodes of each tooth pair (records, slots)."""
        place = self.step * self.slots + self.slot
        return np.bincount(place, values, minlength=len(self.records) * self.slots).reshape(len(self.records), self.slots)

    def over_nodes(self, values: np.ndarray, drive: bool, absent: float) -> np.ndarray:
        """Values (N,) of drive or coast flanks by record, slot and contact node of the pair; `absent` where there is no node."""
        field = np.full((len(self.records), self.slots, self.cycle.grid.nodes), absent)
        chosen = self.drive == drive
        field[self.step[chosen], self.slot[chosen], self.of("node")[chosen]] = values[chosen]
        return field

    @cached_property
    def pair_number(self) -> np.ndarray:
        """Number of the tooth pair in each slot (records, slots); 0 where none is in reach."""
        numbers = np.zeros((len(self.records), self.slots), dtype=np.int32)
        numbers[self.step, self.slot] = self.number
        return numbers
