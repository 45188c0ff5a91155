"""The mixed form by factors that last, against the whole system by numpy."""

import ctypes

import numpy as np
import pytest

from fenics_gears.contact.addresses import KNOWN, OF_FRICTION, march_with_inertia
from fenics_gears.contact.border import MOST_CHANGES
from fenics_gears.contact.factored_compliance import Factors, factored_solver
from fenics_gears.contact.laws import OPEN, SLIP_BACKWARD, SLIP_FORWARD, STICK

NODES, COORDINATES, FRICTION = 60, 3, 0.1


class Contact:
    def __init__(self, frictional: bool):
        draw, forces = np.random.default_rng(1), NODES * (2 if frictional else 1)
        root = draw.normal(size=(forces, forces))
        self.compliance, self.frictional = 1e-5 * (root @ root.T / forces + np.eye(forces)), frictional
        self.jacobian, self.opening = draw.normal(size=(forces, COORDINATES)), 1e-3 * draw.normal(size=forces)
        self.stiffness, self.load = 1e4 * np.eye(COORDINATES), np.full(COORDINATES, 100.0)
        self.factors, self.solver = Factors(forces, forces), ctypes.PYFUNCTYPE(ctypes.c_int64, ctypes.c_int64)

    def of_sets(self, status):
        closed = np.flatnonzero(status != OPEN)
        return self.rows(closed, status[closed])

    @property
    def factored(self) -> list[int]:
        """Rows of the forces between which there are factors with friction."""
        known = ctypes.cast(int(self.factors.table[OF_FRICTION + KNOWN]), ctypes.POINTER(ctypes.c_int64))
        return known[1 : 1 + known[0]]

    def rows(self, closed, status):
        if not self.frictional:
            return closed, np.empty(0)
        slip = np.select([status == SLIP_FORWARD, status == SLIP_BACKWARD], [FRICTION, -FRICTION], 0.0)
        return np.concatenate([closed, NODES + closed[status == STICK]]), slip

    def solved(self, rows, slip):
        """Forces and coordinates by the factors; None where they do not serve."""
        forces, opening = len(self.compliance), self.opening[rows]
        result = np.zeros(forces + COORDINATES)
        arrays = self.compliance, self.jacobian, self.stiffness, self.load, rows, slip, opening, result
        sizes = forces, COORDINATES, len(rows), len(slip)
        numbers = np.array([self.factors.table.ctypes.data, *sizes, *(array.ctypes.data for array in arrays)])
        return result if self.solver(factored_solver().address)(numbers.ctypes.data) else None

    def expected(self, rows, slip):
        compliance, jacobian = self.compliance[np.ix_(rows, rows)], self.jacobian[rows]
        of_forces, slipping = jacobian.copy(), NODES + rows[: len(slip)]
        compliance[:, : len(slip)] += slip * self.compliance[np.ix_(rows, slipping)] if len(slip) else 0.0
        of_forces[: len(slip)] += slip[:, None] * self.jacobian[slipping] if len(slip) else 0.0
        whole = np.block([[-compliance, jacobian], [of_forces.T, self.stiffness]])
        found = np.linalg.solve(whole, np.concatenate([self.opening[rows], self.load]))
        forces = np.zeros(len(self.compliance))
        forces[rows] = found[: len(rows)]
        if len(slip):
            forces[slipping] += slip * forces[rows[: len(slip)]]
        return np.concatenate([forces, found[len(rows) :]])


@pytest.mark.parametrize("frictional", [False, True])
def test_factors_give_what_the_whole_system_gives_whatever_was_factored_before(frictional):
    """numpy's solution; and exact identity of new and lasting factors."""
    contact, status = Contact(frictional), np.random.default_rng(2).integers(SLIP_FORWARD, STICK + 1, size=NODES)
    one, other = (contact.rows(closed, status[closed]) for closed in (np.arange(5, 50), np.arange(8, 55)))
    found = [contact.solved(*rows) for rows in (one, one, other, one)]
    for result, rows in zip(found, (one, one, other, one)):
        np.testing.assert_allclose(result, contact.expected(*rows), rtol=1e-10, atol=1e-10 * np.abs(result).max())
    assert np.array_equal(found[1], found[0]) and np.array_equal(found[3], found[0])


def test_nodes_that_depend_on_each_other_are_left_to_elimination():
    """A compliance of which two rows are one has no Cholesky factor."""
    contact = Contact(frictional=False)
    contact.compliance[7], contact.compliance[:, 7] = contact.compliance[6], contact.compliance[:, 6]
    contact.compliance[7, 7] = contact.compliance[6, 6]
    assert contact.solved(*contact.rows(np.arange(5, 50), None)) is None
    assert contact.solved(*contact.rows(np.arange(10, 55), None)) is not None


STATES = OPEN, SLIP_FORWARD, SLIP_BACKWARD, STICK


def all_changes() -> list[np.ndarray]:
    """Sets, first those of the factors: then one node in each other state, then several at once."""
    draw = np.random.default_rng(3)
    first = draw.choice(STATES, size=NODES, p=(0.2, 0.3, 0.3, 0.2)).astype(np.int8)
    found = [first]
    for before in STATES:
        for after in STATES:
            if after != before:
                found.append(first.copy())
                found[-1][np.flatnonzero(first == before)[2]] = after
    for nodes in (3, 6, MOST_CHANGES // 2):
        found.append(first.copy())
        found[-1][draw.choice(NODES, nodes, replace=False)] = draw.choice(STATES, size=nodes)
    return found


def test_factors_of_a_march_serve_sets_that_differ_in_a_few_nodes():
    """numpy's solution; sets that differ in more are factored."""
    contact, sets = Contact(frictional=True), all_changes()
    with march_with_inertia():
        for status in sets:
            rows = contact.of_sets(status)
            found, expected = contact.solved(*rows), contact.expected(*rows)
            np.testing.assert_allclose(found, expected, rtol=1e-10, atol=1e-12 * np.abs(expected).max())
            assert contact.factored == contact.of_sets(sets[0])[0].tolist()
        others = contact.of_sets(np.where(np.arange(NODES) < MOST_CHANGES + 4, OPEN, STICK))
        np.testing.assert_allclose(contact.solved(*others), contact.expected(*others), rtol=1e-9, atol=1e-9)
        assert contact.factored == others[0].tolist()


def test_a_march_finds_the_same_whatever_was_factored_before_it():
    """Identity, to the last bit: after other sets in another march and in none, and after the same."""
    sets, found = all_changes(), []
    for before in ([], sets[5:], sets[:1]):
        contact = Contact(frictional=True)
        with march_with_inertia():
            for status in before:
                contact.solved(*contact.of_sets(status))
        for status in before[-1:]:
            contact.solved(*contact.of_sets(status))
        with march_with_inertia():
            found.append([contact.solved(*contact.of_sets(status)) for status in sets])
    assert np.array_equal(found[1], found[0]) and np.array_equal(found[2], found[0])


@pytest.mark.parametrize("state", [SLIP_FORWARD, STICK])
def test_a_change_that_makes_nodes_depend_on_each_other_is_left_to_elimination(state):
    """Of two nodes that are one, the second closes; where motions tell them apart, numpy's solution."""
    contact, status = Contact(frictional=True), np.full(NODES, SLIP_FORWARD, dtype=np.int8)
    for row in (7, NODES + 7):
        contact.compliance[row] = contact.compliance[row - 1]
        contact.compliance[:, row] = contact.compliance[:, row - 1]
    apart = contact.jacobian.copy()
    contact.jacobian[[7, NODES + 7]] = contact.jacobian[[6, NODES + 6]]
    with march_with_inertia():
        for nodes_7, there in ((OPEN, True), (state, False), (OPEN, True)):
            status[7] = nodes_7
            rows = contact.of_sets(status)
            found = contact.solved(*rows)
            assert (found is not None) == there
            if there:
                expected = contact.expected(*rows)
                np.testing.assert_allclose(found, expected, rtol=1e-10, atol=1e-12 * np.abs(expected).max())
    contact.jacobian = apart
    with march_with_inertia():
        contact.solved(*rows)
        status[7] = state
        found, expected = contact.solved(*contact.of_sets(status)), contact.expected(*contact.of_sets(status))
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())
