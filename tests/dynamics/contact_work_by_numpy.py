"""The contact's work over a step by whole arrays, to hold the compiled one to: the same splitting, written another
way."""

from __future__ import annotations

import numpy as np

from fenics_gears.dynamics.contact_work import ContactWork
from fenics_gears.dynamics.steps import Record


def contact_work(last: Record, record: Record) -> ContactWork:
    """The contact's work between two consecutive records."""
    nodes = _Nodes(last, record)
    rotation, changes = _normal(nodes, last, record)
    if record.position.operator.rigid_slip is None:
        return ContactWork(rotation, 0.0, changes)
    rotated, friction, changed = _tangential(nodes, last, record)
    return ContactWork(rotation + rotated, friction, changes + changed)


class _Nodes:
    """Which contact nodes the ends of a step share, and what those that only one end has would do at the other.

    `kept`, `kept_before`: positions of the shared nodes now and before; `new`: now only; `gone`: before only; `both`:
    rows of the shared nodes now and before, tangents included where there are any.
    """

    def __init__(self, last: Record, record: Record):
        carried = record.position.node_before
        self._now, self._before = len(carried), last.position.operator.nodes
        # Where two nodes come from one, as beside a moving edge, one of them is that node and the other is new.
        successor = np.full(self._before + 1, -1)
        successor[carried] = np.arange(self._now)
        survives = successor[:-1] >= 0
        self.kept, self.kept_before, self.gone = (
            successor[:-1][survives],
            np.flatnonzero(survives),
            np.flatnonzero(~survives),
        )
        fresh = np.ones(self._now, dtype=bool)
        fresh[self.kept] = False
        self.new = np.flatnonzero(fresh)
        self.last, self.record = last, record
        kinds = (False, True) if len(record.solution.forces) > self._now else (False,)
        self.both = (
            np.concatenate([self.rows(self.kept, kind) for kind in kinds]),
            np.concatenate([self.rows_before(self.kept_before, kind) for kind in kinds]),
        )
        self._forces_0, self._forces_1 = last.solution.forces[self.both[1]], record.solution.forces[self.both[0]]

    def rows(self, nodes: np.ndarray, tangential: bool) -> np.ndarray:
        """Rows of `nodes` of this end of the step."""
        return nodes + self._now if tangential else nodes

    def rows_before(self, nodes: np.ndarray, tangential: bool) -> np.ndarray:
        """Rows of `nodes` of the end before."""
        return nodes + self._before if tangential else nodes

    def changed_compliance(self) -> float:
        """p0 (C1 - C0) p1 over the shared nodes, N mm."""
        now, before = self.both
        loaded_0, loaded_1 = np.flatnonzero(self._forces_0), np.flatnonzero(self._forces_1)
        new = self.record.position.operator.compliance[now[loaded_0][:, None], now[loaded_1]]
        old = self.last.position.operator.compliance[before[loaded_0][:, None], before[loaded_1]]
        return float(self._forces_0[loaded_0] @ (new - old) @ self._forces_1[loaded_1])

    def changed_arms(self) -> float:
        """p0 (G1 - G0) x1 + p1 (G1 - G0) x0 over the shared nodes, N mm."""
        now, before = self.both
        change = self.record.position.operator.jacobian[now] - self.last.position.operator.jacobian[before]
        along_1, along_0 = change @ self.record.state.position, change @ self.last.state.position
        return float(self._forces_0 @ along_1 + self._forces_1 @ along_0)

    def new_before(self, tangential: bool) -> np.ndarray:
        """Relative displacement (new,), mm, that the new nodes would have had before."""
        rows = self.rows(self.new, tangential)
        return _displacement(self.record, rows, self.both[0], self.last.state.position, self._forces_0)

    def gone_now(self, tangential: bool) -> np.ndarray:
        """Relative displacement (gone,), mm, that the nodes which are no more would have now."""
        rows = self.rows_before(self.gone, tangential)
        return _displacement(self.last, rows, self.both[1], self.record.state.position, self._forces_1)


def _displacement(
    of: Record, rows: np.ndarray, columns: np.ndarray, position: np.ndarray, forces: np.ndarray
) -> np.ndarray:
    """G x - C p on `rows`, with the operators of one record and the position and forces of the other."""
    operator, loaded = of.position.operator, np.flatnonzero(forces)
    return operator.jacobian[rows] @ position - operator.compliance[rows[:, None], columns[loaded]] @ forces[loaded]


def _normal(nodes: _Nodes, last: Record, record: Record) -> tuple[float, float]:
    """Work of the rotation by changing gaps, compliance and arms, and the term at changes of contact, N mm."""
    kept, before = nodes.kept, nodes.kept_before
    gap_0, gap_1 = last.position.operator.gap, record.position.operator.gap
    p_0, p_1 = last.solution.forces, record.solution.forces
    open_0, open_1 = (
        gap_0 - last.solution.displacement[: len(gap_0)],
        gap_1 - record.solution.displacement[: len(gap_1)],
    )
    rotation = -0.5 * float((p_0[before] + p_1[kept]) @ (gap_1[kept] - gap_0[before]))
    rotation += 0.5 * (nodes.changed_arms() - nodes.changed_compliance())
    changes = 0.5 * float(p_0[before] @ open_1[kept] - p_1[kept] @ open_0[before])
    if np.any(p_1[nodes.new]):
        changes -= 0.5 * float(p_1[nodes.new] @ (gap_1[nodes.new] - nodes.new_before(False)))
    if np.any(p_0[nodes.gone]):
        changes += 0.5 * float(p_0[nodes.gone] @ (gap_0[nodes.gone] - nodes.gone_now(False)))
    return rotation, changes


def _tangential(nodes: _Nodes, last: Record, record: Record) -> tuple[float, float, float]:
    """Work of the rotation against friction, what friction loses, and the term at its changes, N mm."""
    operator = record.position.operator
    now, count = np.arange(operator.nodes), operator.nodes
    p_1, p_0 = record.solution.forces[count:], np.zeros(count)
    p_0[nodes.kept] = last.solution.forces[nodes.rows_before(nodes.kept_before, True)]
    displaced = operator.previous_jacobian @ last.state.position - operator.previous_compliance @ last.solution.forces
    slip = record.solution.displacement[nodes.rows(now, True)] + operator.rigid_slip - displaced
    u_0 = np.zeros(count)
    u_0[nodes.kept] = last.solution.displacement[nodes.rows_before(nodes.kept_before, True)]
    if len(nodes.new):
        u_0[nodes.new] = nodes.new_before(True)
    rotation = 0.5 * float((p_0 + p_1) @ (operator.rigid_slip - displaced + u_0))
    friction = float(p_1 @ slip)
    changes = 0.5 * float((p_1 - p_0) @ slip)
    gone = nodes.rows_before(nodes.gone, True)
    if np.any(last.solution.forces[gone]):
        changes -= 0.5 * float(last.solution.forces[gone] @ (nodes.gone_now(True) - last.solution.displacement[gone]))
    return rotation, friction, changes
