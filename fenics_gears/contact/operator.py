"""The contact equations at one position of the gears: the nodes that may touch, and their response.

Unknowns of the mixed form (model.md section 4) are nodal forces `p` and centre coordinates `q`; the relative
displacement of the contact nodes is `u = G q - C p`. Rows come normals first, then tangents where friction asks for
them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fenics_gears.geometry.side import Side

from .addresses import GAP, row_of
from .face import Face
from .kinematics import IN_THE_PLANE, Lines, lines_of
from .tooth_pair import DRIVE, Nodes, PairNodes, per_node

if TYPE_CHECKING:
    from .formed_rows import FormedRows

NO_NODES_BEFORE = np.empty(0, dtype=np.int64)


class _ReadOtherwise:
    """A field of an operator without a default: `read` turns what is stored into what is read. None stays None."""

    def __init__(self, read: Callable[[Any, ContactOperator], np.ndarray]):
        self._read = read

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __set__(self, operator: ContactOperator, stored: Any) -> None:
        operator.__dict__[self._name] = stored

    def __get__(self, operator: ContactOperator | None, owner: type | None = None):
        if operator is None:
            raise AttributeError(self._name)
        stored = operator.__dict__[self._name]
        return stored if stored is None else self._read(stored, operator)


def _with_all_rows(compliance: np.ndarray | FormedRows, operator: ContactOperator) -> np.ndarray:
    """All rows are formed when a compliance is read (`contact.formed_rows`)."""
    return compliance if isinstance(compliance, np.ndarray) else compliance.whole()


def _with_all_columns(jacobian: np.ndarray, operator: ContactOperator) -> np.ndarray:
    """Columns of coordinates that move no contact are zero, and are not stored."""
    more = operator.coordinates - jacobian.shape[1]
    return np.pad(jacobian, ((0, 0), (0, more))) if more > 0 else jacobian


class Stored(NamedTuple):
    """A compliance as it lies in memory, by rows (m, m'), mm/N.

    The rows of nodes that were closed are there at least; `address`: of the function that forms the others, 0 where
    all are there.
    """

    rows: np.ndarray
    address: int = 0


@dataclass(frozen=True)
class ContactOperator:
    """Contact at one position: n nodes, m = n without friction, 2 n with it; k centre coordinates.

    `pairs`: the tooth pairs whose nodes these are, in order; `sides` of the mesh; `normal_lever_arms` (2, n), mm: of a
    normal force about either centre.

    `compliance` C (m, m), mm/N; `jacobian` G (m, k); `gap` (n,), mm; `rigid_slip` (n,), mm: slip of rigid flanks during
    the step that ends here; `previous_compliance` E (n, m of the step before) and `previous_jacobian` (n, k): the
    tangential displacement that the material points touching now had at the end of the step before is
    `previous_jacobian q - E p`. The last three are None without friction.

    `dependent_rows`: rows of the compliance that are combinations of others, see `contact.pairing`. `face`: whose
    slices the pairs are in. `sliding` (n,): sign of the nominal motion's, where friction follows it, else None.
    `coordinates`: k, where jacobians are stored without the last columns, of coordinates that move no contact.
    """

    pairs: tuple[PairNodes, ...]
    sides: tuple[Side, Side]
    normal_lever_arms: np.ndarray
    compliance: np.ndarray = _ReadOtherwise(_with_all_rows)  # type: ignore[assignment]
    jacobian: np.ndarray = _ReadOtherwise(_with_all_columns)  # type: ignore[assignment]
    gap: np.ndarray
    rigid_slip: np.ndarray | None
    previous_compliance: np.ndarray | None = _ReadOtherwise(_with_all_rows)  # type: ignore[assignment]
    previous_jacobian: np.ndarray | None = _ReadOtherwise(_with_all_columns)  # type: ignore[assignment]
    dependent_rows: int = 0
    face: Face = IN_THE_PLANE
    sliding: np.ndarray | None = None
    coordinates: int = 0

    def changed(self, **fields: Any) -> ContactOperator:
        """The same with other fields; what is known of it is not found again, and no rows are formed."""
        # A tenth of the time that `copy` takes.
        other = ContactOperator.__new__(ContactOperator)
        other.__dict__.update(self.__dict__)
        other.__dict__.update(fields)
        return other

    @property
    def nodes(self) -> int:
        """Number of contact nodes."""
        return len(self.gap)

    @property
    def stored(self) -> Stored:
        """The compliance as far as its rows are formed."""
        held = self.__dict__["compliance"]
        return Stored(held) if isinstance(held, np.ndarray) else Stored(held.matrix, held.address)

    @property
    def untouched(self) -> bool:
        """Whether rows of the compliance are formed when nodes close, and none has closed yet."""
        held = self.__dict__["compliance"]
        # The first row is there from the beginning.
        return not isinstance(held, np.ndarray) and not held.formed[1:].any()

    @property
    def stored_before(self) -> Stored | None:
        """The previous compliance by columns, (m before, n), as far as they are formed; None without friction."""
        held = self.__dict__["previous_compliance"]
        if held is None:
            return None
        return (
            Stored(np.ascontiguousarray(held.T)) if isinstance(held, np.ndarray) else Stored(held.matrix, held.address)
        )

    @property
    def stored_jacobians(self) -> tuple[np.ndarray, np.ndarray | None]:
        """G (m, c) and the previous jacobian (n, c) over the coordinates that contact moves, as they lie in memory."""
        return self.__dict__["jacobian"], self.__dict__["previous_jacobian"]

    @property
    def lines(self) -> Lines:
        """The nodes' lines of action, with the lever arms of normal forces."""
        return replace(lines_of(self.pairs, self.sides, self.face), lever_arms=self.normal_lever_arms)

    @cached_property
    def node_pair(self) -> np.ndarray:
        """Position in `pairs` of the pair that each node (n,) belongs to."""
        return per_node(self.pairs, np.arange(len(self.pairs)))

    @cached_property
    def on_drive_flanks(self) -> np.ndarray:
        """Whether a node (n,) is on the drive flanks, not the coast flanks."""
        return np.array([pair.place.flank == DRIVE for pair in self.pairs], dtype=bool)[self.node_pair]


class Passage(NamedTuple):
    """Contact nodes on their way from one position to the next: the `pairs` now and the `previous` ones, None without
    friction.

    `node_before`: as of a Position; `index` and `index_before`: place of both in the mesh cycle, in steps; `advance`:
    mesh cycles by which the gears turn.
    """

    pairs: tuple[PairNodes, ...]
    previous: tuple[PairNodes, ...] | None = None
    node_before: np.ndarray = NO_NODES_BEFORE
    index: float = 0
    index_before: float = -1
    advance: float = 0.0


class Response(NamedTuple):
    """How contact nodes yield: fields as of a ContactOperator.

    `previous_compliance` is None without friction. `normal_lever_arms` and `previous_jacobian`, over all coordinates,
    are None where flanks slide along the line of action.
    """

    compliance: np.ndarray | FormedRows
    previous_compliance: np.ndarray | FormedRows | None = None
    dependent_rows: int = 0
    normal_lever_arms: np.ndarray | None = None
    previous_jacobian: np.ndarray | None = None
    sliding: np.ndarray | None = None


# Of an operator whose rows are formed when nodes are closed.
SHARE_FORMED = 0.3


@dataclass(frozen=True)
class Position:
    """The contact operator of one phase, and for each node the one it was a step before, (n,), -1 where it is new.

    `index`: place in the mesh cycle, in steps; `nodes`: what gave the contact nodes there, as of a Mesh.
    """

    operator: ContactOperator
    node_before: np.ndarray
    index: float = 0
    nodes: Nodes | None = None

    @cached_property
    def in_memory(self) -> tuple[np.ndarray, list[np.ndarray]]:
        """For compiled code: the operator's row of `contact.addresses`, and the arrays whose addresses it has.

        The previous compliance lies there by columns: few nodes are loaded.
        """
        operator = self.operator
        rows, forms = operator.stored
        columns, forms_before = operator.stored_before or (None, 0)
        now, before = operator.stored_jacobians
        return row_of(operator.nodes, (
            rows, now, operator.gap, operator.on_drive_flanks, operator.node_pair,
            self.node_before, operator.rigid_slip, before, columns, operator.sliding,
            forms, forms_before, now.shape[1],
        ))  # fmt: skip

    @property
    def of_wheels(self) -> tuple[slice, ...]:
        """The contact nodes of each mesh."""
        return (slice(None),)

    @property
    def bytes(self) -> int:
        """Size of the arrays of the contact operator."""
        whole = sum(array.nbytes for array in self.in_memory[1])
        return whole if not self.operator.stored.address else int(SHARE_FORMED * whole)

    @property
    def as_built(self) -> Position:
        """The position without what opens it."""
        return self

    def with_gap(self, gap: np.ndarray, row: np.ndarray | None = None) -> Position:
        """The same position with other gaps (n,), mm, in one piece; what is known of it already is not found again.
        `row`: as of `in_memory` with these gaps, where it is known."""
        opened = _Opened.__new__(_Opened)
        opened.__dict__.update(node_before=self.node_before, index=self.index, nodes=self.nodes, true=self, gap=gap)
        if row is not None:
            opened.__dict__["in_memory"] = row, [*self.in_memory[1], gap]
        return opened


class StepRows:
    """The rows (steps, r) of all positions of a mesh cycle, whatever opens them."""

    table: np.ndarray | None = None

    def of(self, positions: Sequence[Position]) -> np.ndarray:
        """The rows of the positions of their cycle."""
        if self.table is None:
            self.table = np.array([position.in_memory[0] for position in positions])
        return self.table


class _Opened(Position):
    """A position `true` with another `gap`. Of most steps compiled code alone reads it, so that its operator is put
    together when it is asked for."""

    true: Position
    gap: np.ndarray

    @property
    def as_built(self) -> Position:
        return self.true

    @cached_property
    def operator(self) -> ContactOperator:  # type: ignore[override]
        """That of the position with these gaps."""
        true = self.true.operator
        return true.changed(gap=self.gap, node_pair=true.node_pair, on_drive_flanks=true.on_drive_flanks)

    @cached_property
    def in_memory(self) -> tuple[np.ndarray, list[np.ndarray]]:
        """As of the position, with these gaps."""
        row, held = self.true.in_memory
        row = row.copy()
        row[GAP] = self.gap.ctypes.data
        return row, [*held, self.gap]
