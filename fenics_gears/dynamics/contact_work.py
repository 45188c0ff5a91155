"""Work of the contact over one step, split without remainder as in `dynamics.energy_account`; compiled, since every
step needs it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from fenics_gears.contact.addresses import (
    CARRIED,
    COMPLIANCE,
    GAP,
    JACOBIAN,
    PREVIOUS_COMPLIANCE,
    PREVIOUS_JACOBIAN,
    RIGID_SLIP,
    integers_at,
    matrix_at,
    vector_at,
)
from fenics_gears.dynamics.steps import Steps


@dataclass(frozen=True)
class ContactWork:
    """Work of the contact over some steps (s,), N mm: `rotation` by the prescribed rotation, `friction` lost, `changes`
    by the time stepping."""

    rotation: np.ndarray
    friction: np.ndarray
    changes: np.ndarray


def contact_work(steps: Steps) -> ContactWork:
    """The contact's work from each of consecutive steps to the next."""
    works = _works(steps.table, steps.starts, steps.kinds, steps.states[:, 0].copy(), steps.forces, steps.displacement)
    return ContactWork(*works)


@njit(cache=True)
def _works(table, starts, kinds, positions, forces, displacement):
    works, k = np.zeros((3, max(len(table) - 1, 0))), positions.shape[1]
    for s in range(1, len(table)):
        n_0, n_1 = starts[s] - starts[s - 1], starts[s + 1] - starts[s]
        m_0, m_1 = kinds * n_0, kinds * n_1
        then, now = slice(kinds * starts[s - 1], kinds * starts[s]), slice(kinds * starts[s], kinds * starts[s + 1])
        before, row, slides = table[s - 1], table[s], 0 if table[s, RIGID_SLIP] == 0 else n_1
        works[:, s - 1] = _work(
            integers_at(row[CARRIED], n_1),
            vector_at(before[GAP], n_0), matrix_at(before[JACOBIAN], m_0, k), matrix_at(before[COMPLIANCE], m_0, m_0),
            forces[then], displacement[then], positions[s - 1],
            vector_at(row[GAP], n_1), matrix_at(row[JACOBIAN], m_1, k), matrix_at(row[COMPLIANCE], m_1, m_1),
            forces[now], displacement[now], positions[s],
            vector_at(row[RIGID_SLIP], slides), matrix_at(row[PREVIOUS_JACOBIAN], slides, k),
            matrix_at(row[PREVIOUS_COMPLIANCE], m_0, slides),
        )  # fmt: skip
    return works


@njit(cache=True)
def _work(
    carried, gap_0, jacobian_0, compliance_0, forces_0, displaced_0, x_0, gap_1, jacobian_1, compliance_1, forces_1,
    displaced_1, x_1,
    rigid_slip, previous_jacobian, columns,
):  # fmt: skip
    """Rotation, friction and changes, N mm. `carried` (n,): the node before of each node now, -1 where it is new.

    `columns` (m_0, n_1): of the operator's previous compliance. Where two nodes come from one, as beside a moving edge,
    the later of them is that node and the other is new.
    """
    n_0, n_1, kinds = len(gap_0), len(gap_1), 2 if len(rigid_slip) else 1
    successor, fresh = np.full(n_0, -1), np.ones(n_1, dtype=np.bool_)
    for node in range(n_1):
        if carried[node] >= 0:
            successor[carried[node]] = node
    for node in successor:
        if node >= 0:
            fresh[node] = False
    # Rows, before and now, of the nodes that both ends of the step have.
    rows_0, rows_1 = np.empty(kinds * n_0, dtype=np.int64), np.empty(kinds * n_0, dtype=np.int64)
    kept = 0
    for kind in range(kinds):
        for node in range(n_0):
            if successor[node] >= 0:
                rows_0[kept], rows_1[kept] = kind * n_0 + node, kind * n_1 + successor[node]
                kept += 1
    rows_0, rows_1 = rows_0[:kept], rows_1[:kept]
    rotation, changes, friction = (
        _by_shape(rows_0, rows_1, jacobian_0, compliance_0, forces_0, x_0, jacobian_1, compliance_1, forces_1, x_1),
        0.0,
        0.0,
    )
    for node in range(n_0):
        p_0, after = forces_0[node], successor[node]
        if after >= 0:
            p_1 = forces_1[after]
            rotation -= 0.5 * (p_0 + p_1) * (gap_1[after] - gap_0[node])
            changes += 0.5 * (p_0 * (gap_1[after] - displaced_1[after]) - p_1 * (gap_0[node] - displaced_0[node]))
        elif p_0 != 0.0:
            changes += (
                0.5 * p_0 * (gap_0[node] - _at_other(node, jacobian_0, compliance_0, x_1, rows_0, rows_1, forces_1))
            )
        if after < 0 and kinds == 2 and forces_0[n_0 + node] != 0.0:
            there = _at_other(n_0 + node, jacobian_0, compliance_0, x_1, rows_0, rows_1, forces_1)
            changes -= 0.5 * forces_0[n_0 + node] * (there - displaced_0[n_0 + node])
    loaded = np.flatnonzero(forces_0)
    for node in range(n_1):
        if fresh[node] and forces_1[node] != 0.0:
            changes -= (
                0.5
                * forces_1[node]
                * (gap_1[node] - _at_other(node, jacobian_1, compliance_1, x_0, rows_1, rows_0, forces_0))
            )
        if kinds == 1:
            continue
        # `slid`: slip of rigid flanks less the displacement that the same points had before; `moved`: displacement that
        # the node had then.
        before = carried[node] if not fresh[node] else -1
        p_1, p_0 = forces_1[n_1 + node], forces_0[n_0 + before] if before >= 0 else 0.0
        if p_0 == 0.0 and p_1 == 0.0:
            continue
        slid = rigid_slip[node] - previous_jacobian[node] @ x_0
        for column in loaded:
            slid += columns[column, node] * forces_0[column]
        if before >= 0:
            moved = displaced_0[n_0 + before]
        else:
            moved = _at_other(n_1 + node, jacobian_1, compliance_1, x_0, rows_1, rows_0, forces_0)
        slip = displaced_1[n_1 + node] + slid
        rotation += 0.5 * (p_0 + p_1) * (slid + moved)
        friction += p_1 * slip
        changes += 0.5 * (p_1 - p_0) * slip
    return np.array([rotation, friction, changes])


@njit(cache=True)
def _by_shape(rows_0, rows_1, jacobian_0, compliance_0, forces_0, x_0, jacobian_1, compliance_1, forces_1, x_1):
    """Half of p0 (G1 - G0) x1 + p1 (G1 - G0) x0 - p0 (C1 - C0) p1 over the rows of both ends, N mm."""
    work, loaded = 0.0, np.flatnonzero(forces_1[rows_1])
    for row in range(len(rows_0)):
        i_0, i_1 = rows_0[row], rows_1[row]
        p_0, p_1 = forces_0[i_0], forces_1[i_1]
        if p_0 == 0.0 and p_1 == 0.0:
            continue
        for k in range(len(x_0)):
            work += (jacobian_1[i_1, k] - jacobian_0[i_0, k]) * (p_0 * x_1[k] + p_1 * x_0[k])
        if p_0 != 0.0:
            for column in loaded:
                work -= (
                    p_0
                    * (compliance_1[i_1, rows_1[column]] - compliance_0[i_0, rows_0[column]])
                    * forces_1[rows_1[column]]
                )
    return 0.5 * work


@njit(cache=True)
def _at_other(row, jacobian, compliance, x, rows, other_rows, forces):
    """Displacement G x - C p (mm) that a row of one end would have at the other: `rows` here are `other_rows` there,
    with its `forces`."""
    found = 0.0
    for k in range(len(x)):
        found += jacobian[row, k] * x[k]
    for column in range(len(rows)):
        force = forces[other_rows[column]]
        if force != 0.0:
            found -= compliance[row, rows[column]] * force
    return found
