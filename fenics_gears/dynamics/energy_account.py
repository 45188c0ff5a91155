"""Energy account of a march, step by step, which closes to round-off.

Average acceleration gives the drivetrain's part exactly: over a step, with the contact forces p and dx = x1 - x0,

    change of (kinetic + springs) = F dx - dx D dx/dt - dx (G0^T p0 + G1^T p1)/2.

With u = G x - C p at both ends, the contact's part splits, without remainder, into the change of the teeth's energy 1/2
p C p; the friction loss p1 slip1, as of backward Euler; the work of the prescribed rotation, by the changing geometry
(G, C, gaps, rigid slip); and the algorithm's own term at changes of contact, 1/2 sum(p0 gap1 - p1 gap0), and the same
for friction. A node that only one end of the step has is given the compliance and the lever arms of that end at the
other.

F is the mean of the loads at both ends of the step, where they vary. Backward Euler, which is used where no vibration
is sampled and for rigid flanks, has another balance: its dissipation is in the defect.

The account is in the frame of the nominal motion. The power that the nominal motion carries through the mesh, load
times nominal speed, is added to input and output alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numba import njit

from fenics_gears.contact.addresses import Arrays, form_rows
from fenics_gears.contact.mixed_form import product

from .clock import Clock
from .compiled_march import slip_at_start
from .drivetrain import Drivetrain
from .stepping import VaryingLoad
from .steps import Steps, forces_at, in_block, operator_at


@dataclass(frozen=True)
class Account:
    """Work since the first step, (steps,), N mm, and its `defect` from the change of energy."""

    rotation: np.ndarray
    load: np.ndarray
    damping: np.ndarray
    friction: np.ndarray
    changes: np.ndarray
    defect: np.ndarray


def account(
    drivetrain: Drivetrain, clock: Clock, steps: Steps, energy: np.ndarray, loads: Sequence[VaryingLoad] = ()
) -> Account:
    """The account of consecutive steps, whose elastic and kinetic `energy` (steps,) is in N mm; `loads` as the march
    had them."""
    # A step that was divided is accounted for part by part.
    passed, whole = steps.with_parts()
    contact = contact_work(passed)
    moved = np.diff(passed.states[:, 0], axis=0)
    damping = np.zeros(len(moved))
    if drivetrain.damping is not None:
        damping = quadratic(moved, drivetrain.damping) / clock.durations(passed.numbers)
    parts = {
        "rotation": _summed(contact.rotation),
        "load": _summed(np.sum(moved * mean_load(drivetrain, loads, passed.numbers), axis=1)),
        "damping": _summed(damping),
        "friction": _summed(contact.friction),
        "changes": _summed(contact.changes),
    }
    parts = {name: work[whole] for name, work in parts.items()}
    gained = parts["rotation"] + parts["load"] + parts["changes"] - parts["damping"] - parts["friction"]
    return Account(**parts, defect=energy - energy[:1] - gained if len(energy) else energy)


def quadratic(vectors: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """v M v (n,) of vectors (n, k) with a matrix (k, k)."""
    return np.sum(vectors @ matrix * vectors, axis=1)


def mean_load(drivetrain: Drivetrain, loads: Sequence[VaryingLoad], steps: Sequence[float]) -> np.ndarray:
    """Forces (n, k), N, on the centre coordinates from each of n + 1 steps to the next, the mean of both."""
    forces = np.tile(drivetrain.load, (len(steps), 1))
    for load in loads:
        # Reshaped for a march that failed at its start and has no steps.
        forces = forces + np.reshape([load(step) for step in steps], forces.shape)
    return 0.5 * (forces[:-1] + forces[1:])


def _summed(steps) -> np.ndarray:
    return np.concatenate(([0.0], np.cumsum(steps)))


@dataclass(frozen=True)
class ContactWork:
    """Work of the contact over some steps (s,), N mm: `rotation` by the prescribed rotation, `friction` lost, `changes`
    by the time stepping."""

    rotation: np.ndarray
    friction: np.ndarray
    changes: np.ndarray


def contact_work(steps: Steps) -> ContactWork:
    """The contact's work from each of consecutive steps to the next."""
    return ContactWork(*_works(steps.in_memory))


ROTATION, FRICTION, CHANGES = range(3)


class End(NamedTuple):
    """An end of a step: its contact, forces p (m,) and displacement u (m,) there, and the coordinates x (k,)."""

    contact: Arrays
    forces: np.ndarray
    displacement: np.ndarray
    coordinates: np.ndarray


class Shared(NamedTuple):
    """What both ends of a step have: `rows` of forces that are loaded at either, those before and the same ones now;
    the `successor` (n_then,) of each node before and the `node_before` (n_now,) of each now, -1 for none.

    Where two nodes come from one, as beside a moving edge, the later of them is that node and the other is new.
    """

    rows: tuple[np.ndarray, np.ndarray]
    successor: np.ndarray
    node_before: np.ndarray


@njit(cache=True)
def _works(block):
    steps = in_block(block)
    works = np.zeros((3, max(len(steps.rows) - 1, 0)))
    for s in range(1, len(steps.rows)):
        then, now = _end(steps, s - 1), _end(steps, s)
        shared = _shared(then, now, steps.kinds)
        rotation, changes = _normal_work(then, now, shared)
        works[ROTATION, s - 1], works[CHANGES, s - 1] = _by_shape(then, now, shared) + rotation, changes
        if steps.kinds == 2:
            _tangential_work(works[:, s - 1], then, now, shared)
    return works


@njit(cache=True)
def _end(steps, s):
    forces = forces_at(steps, s)
    return End(operator_at(steps, s), steps.forces[forces], steps.displacement[forces], steps.states[s, 0])


@njit(cache=True)
def _shared(then, now, kinds):
    node_before, forces_then, forces_now = now.contact.node_before, then.forces, now.forces
    n_then, n_now, count = len(then.contact.gap), len(node_before), 0
    successor, own = np.full(n_then, -1), np.full(n_now, -1)
    for node in range(n_now):
        if node_before[node] >= 0:
            successor[node_before[node]] = node
    rows_then, rows_now = np.empty(kinds * n_then, dtype=np.int64), np.empty(kinds * n_then, dtype=np.int64)
    for kind in range(kinds):
        for node in range(n_then):
            after = successor[node]
            if after >= 0:
                own[after] = node
                row_then, row_now = kind * n_then + node, kind * n_now + after
                if forces_then[row_then] != 0.0 or forces_now[row_now] != 0.0:
                    rows_then[count], rows_now[count] = row_then, row_now
                    count += 1
    return Shared((rows_then[:count], rows_now[:count]), successor, own)


@njit(cache=True)
def _normal_work(then, now, shared):
    """What normal forces do on the rotation, and by closing and opening between steps."""
    # Taken out of the records once: in a loop that would cost more than the numbers.
    gaps_then, forces_then, displaced_then = then.contact.gap, then.forces, then.displacement
    gaps_now, forces_now, displaced_now = now.contact.gap, now.forces, now.displacement
    (rows_then, rows_now), successor, node_before = shared
    rotation, changes = 0.0, 0.0
    for node in range(len(gaps_then)):
        p_then, after = forces_then[node], successor[node]
        if after >= 0:
            p_now = forces_now[after]
            if p_then != 0.0 or p_now != 0.0:
                gap_then, gap_now = gaps_then[node], gaps_now[after]
                rotation -= 0.5 * (p_then + p_now) * (gap_now - gap_then)
                changes += 0.5 * (p_then * (gap_now - displaced_now[after]) - p_now * (gap_then - displaced_then[node]))
        elif p_then != 0.0:
            changes += 0.5 * p_then * (gaps_then[node] - _at_other(node, then, rows_then, now, rows_now))
    for node in range(len(gaps_now)):
        p_now = forces_now[node]
        if node_before[node] < 0 and p_now != 0.0:
            changes -= 0.5 * p_now * (gaps_now[node] - _at_other(node, now, rows_now, then, rows_then))
    return rotation, changes


@njit(cache=True)
def _tangential_work(works, then, now, shared):
    """Add what friction does, with what is lost to it, to `works` (3,)."""
    n_then, forces_then, displaced_then, x_then = (
        len(then.contact.gap),
        then.forces,
        then.displacement,
        then.coordinates,
    )
    n_now, forces_now, displaced_now = len(now.contact.gap), now.forces, now.displacement
    (rows_then, rows_now), successor, node_before = shared
    for node in range(n_then):
        p_then = forces_then[n_then + node]
        if successor[node] < 0 and p_then != 0.0:
            there = _at_other(n_then + node, then, rows_then, now, rows_now)
            works[CHANGES] -= 0.5 * p_then * (there - displaced_then[n_then + node])
    # `slid`: slip of rigid flanks less the displacement that the same points had before; `moved`: displacement that the
    # node had then.
    slid = slip_at_start(
        now.contact.rigid_slip, now.contact.previous_jacobian, now.contact.previous_columns, now.contact.rows_before,
        x_then, forces_then,
    )  # fmt: skip
    for node in range(n_now):
        before = node_before[node]
        p_now, p_then = forces_now[n_now + node], forces_then[n_then + before] if before >= 0 else 0.0
        if p_then == 0.0 and p_now == 0.0:
            continue
        if before >= 0:
            moved = displaced_then[n_then + before]
        else:
            moved = _at_other(n_now + node, now, rows_now, then, rows_then)
        slip = displaced_now[n_now + node] + slid[node]
        works[ROTATION] += 0.5 * (p_then + p_now) * (slid[node] + moved)
        works[FRICTION] += p_now * slip
        works[CHANGES] += 0.5 * (p_now - p_then) * slip


@njit(cache=True)
def _by_shape(then, now, shared):
    """Half of p0 (G1 - G0) x1 + p1 (G1 - G0) x0 - p0 (C1 - C0) p1 over the rows of both ends, N mm.

    By C p = G x - u at either end: products with C are left for the few loaded nodes that only one end has.
    """
    rows_then, rows_now = shared.rows
    work = _by_others(now, rows_now, then.forces, rows_then, shared.node_before)
    work -= _by_others(then, rows_then, now.forces, rows_now, shared.successor)
    for row in range(len(rows_then)):
        i_then, i_now = rows_then[row], rows_now[row]
        work += then.forces[i_then] * (
            now.displacement[i_now] - product(then.contact.jacobian[i_then], now.coordinates)
        )
        work -= now.forces[i_now] * (then.displacement[i_then] - product(now.contact.jacobian[i_now], then.coordinates))
    return 0.5 * work


@njit(cache=True)
def _by_others(here, rows, forces, other_rows, same):
    """Work (N mm) of the `forces` at some rows on what the nodes of an end displace there that the other end does not
    have, of which none is the `same` (n,)."""
    compliance, work = here.contact.compliance, 0.0
    for own in range(len(here.forces)):
        if here.forces[own] != 0.0 and same[own % len(same)] < 0:
            displaced = 0.0
            form_rows(here.contact.rows, np.array([own % len(same)]))
            for row in range(len(rows)):
                # By rows of loaded nodes: others need not be formed.
                displaced += compliance[own, rows[row]] * forces[other_rows[row]]
            work += here.forces[own] * displaced
    return work


@njit(cache=True)
def _at_other(row, here, rows, there, other_rows):
    """Displacement G x - C p (mm) that a row of the end `here` would have at the end `there`: `rows` here are
    `other_rows` there, with the forces there."""
    compliance, forces, displacement = (
        here.contact.compliance,
        there.forces,
        product(here.contact.jacobian[row], there.coordinates),
    )
    form_rows(here.contact.rows, np.array([row % len(here.contact.gap)]))
    for column in range(len(rows)):
        displacement -= compliance[row, rows[column]] * forces[other_rows[column]]
    return displacement
