"""The mixed form by factors that last, against the whole system by numpy."""

import ctypes

import numpy as np
import pytest

from fenics_gears.contact.factored_compliance import Factors, factored_solver
from fenics_gears.contact.laws import SLIP_BACKWARD, SLIP_FORWARD, STICK

NODES, COORDINATES, FRICTION = 60, 3, 0.1


class Contact:
    def __init__(self, frictional: bool):
        draw, forces = np.random.default_rng(1), NODES * (2 if frictional else 1)
        root = draw.normal(size=(forces, forces))
        self.compliance, self.frictional = 1e-5 * (root @ root.T / forces + np.eye(forces)), frictional
        self.jacobian, self.opening = draw.normal(size=(forces, COORDINATES)), 1e-3 * draw.normal(size=forces)
        self.stiffness, self.load = 1e4 * np.eye(COORDINATES), np.full(COORDINATES, 100.0)
        self.factors, self.solver = Factors(forces, forces), ctypes.PYFUNCTYPE(ctypes.c_int64, ctypes.c_int64)

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
        numbers = np.array([self.factors.table.ctypes.data, *sizes, *(array.ctypes.data for array in arrays), 0])
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
