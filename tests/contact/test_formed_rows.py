"""Compliance over a face times contact nodes' weights, against dense arithmetic."""

import ctypes
from types import SimpleNamespace

import numpy as np
import pytest
from tests.stand_in import stand_in_compliance

from fenics_gears import ComputationError
from fenics_gears.contact.addresses import form_rows
from fenics_gears.contact.between_flank_nodes import Between, between_flank_nodes
from fenics_gears.contact.closed_compliance import functions
from fenics_gears.contact.face_ends import displacement_beside
from fenics_gears.contact.factored_compliance import FORMER
from fenics_gears.contact.fine_sections import Fine, SectionNodes, by_nodes, stacked
from fenics_gears.contact.formed_rows import FormedRows, fine_section, uncertain_slices

NODES, FINE_NODES, SLICES, OFFSETS = 6, 9, 3, 2
TEETH, IN_SLICES = np.array([0, 0, 1, 2]), np.array([0, 2, 2, 1])
# The third group is the second in its slice, of three contact nodes each.
GROUPS = np.array([[0, 3, 6, 9], IN_SLICES, [0, 0, 3, 0], [3, 6, 6, 3]])


def symmetric(random, size):
    """Blocks of teeth up to OFFSETS apart; those behind are the transposes."""
    ahead = random.standard_normal((OFFSETS + 1, size, size))
    ahead[0] += ahead[0].T
    return np.stack([*(each.T for each in ahead[:0:-1]), *ahead])


def side(random, kinds):
    (first, near, weights), (fine_first, fine_near, fine) = (
        views(random, *each) for each in ((NODES, 2), (FINE_NODES, 3))
    )
    lowest = first.reshape(2, 4, 3).min(axis=2)
    widths = first.reshape(2, 4, 3).max(axis=2) + 2 - lowest
    # Flank nodes stand one section's after the other's.
    order = np.argsort(IN_SLICES, kind="stable")
    places = np.empty_like(widths)
    places[:, order] = np.cumsum(widths[:, order], axis=1) - widths[:, order]
    of_each = zip(widths, places, lowest)
    on_gears = [[TEETH, width, place, IN_SLICES, low, low] for width, place, low in of_each]
    first += np.repeat(np.array(on_gears)[:, 2] - lowest, 3, axis=1)
    group, axes = np.repeat(np.arange(4), 3), random.standard_normal((2, 4, kinds, 5))
    begins, flanks = 9 * np.arange(8).reshape(2, 4), np.zeros(4, dtype=int)
    seen = flanks, fine_first, fine_near.ravel(), begins, np.full((2, 4), 3)
    offsets = 0.1 * np.arange(12.0)
    return SectionNodes(group, offsets, first, GROUPS, np.array(on_gears), near, axes, *seen), weights, fine


def views(random, count, width):
    first, near, weights = (
        random.integers(0, count - width, (2, 12)),
        random.random((2, 12, width)),
        np.zeros((2, 12, count)),
    )
    for gear, node in np.ndindex(2, 12):
        weights[gear, node, first[gear, node] : first[gear, node] + width] = near[gear, node]
    return first, near, weights


def by_whole_matrices(bodies, fine, rows, columns):
    """Every group's weights times the whole blocks less the sections in the same slice, and times the fine sections."""
    (own, weights, own_fine), (other, others, other_fine) = rows, columns
    kinds, kinds_of_columns = own.axes.shape[2], other.axes.shape[2]
    expected = np.zeros((kinds, 12, kinds_of_columns, 12))
    for gear, (blocks, sections) in enumerate(bodies):
        for p, q in np.ndindex(len(TEETH), len(TEETH)):
            number, (here, there) = OFFSETS + TEETH[p] - TEETH[q], (slice(3 * p, 3 * p + 3), slice(3 * q, 3 * q + 3))
            block = blocks[number].reshape(SLICES, NODES, 3, SLICES, NODES, 3)[IN_SLICES[p], :, :, IN_SLICES[q]]
            found = "ni,da,iajb,eb,mj->dnem"
            own_axes, other_axes = own.axes[gear, p], other.axes[gear, q]
            expected[:, here, :, there] += np.einsum(
                found, weights[gear, here], own_axes[:, :3], block, other_axes[:, :3], others[gear, there]
            )
            if IN_SLICES[p] == IN_SLICES[q]:
                section = sections[number].reshape(NODES, 2, NODES, 2)
                expected[:, here, :, there] -= fine.shares[IN_SLICES[p]] * np.einsum(
                    found, weights[gear, here], own_axes[:, 3:], section, other_axes[:, 3:], others[gear, there]
                )
                section = fine[gear][number, 0, 0].reshape(FINE_NODES, 2, FINE_NODES, 2)
                expected[:, here, :, there] += fine.shares[IN_SLICES[p]] * np.einsum(
                    found, own_fine[gear, here], own_axes[:, 3:], section, other_axes[:, 3:], other_fine[gear, there]
                )
    return expected.reshape(kinds * 12, kinds_of_columns * 12)


@pytest.mark.parametrize("kinds", [(1, 1), (2, 2), (2, 1)], ids=["frictionless", "friction", "step before"])
def test_rows_are_those_of_whole_matrices(kinds):
    """Brute force; rows that nobody asked for stay zero."""
    random = np.random.default_rng(5)
    rows, columns = (side(random, each) for each in kinds)
    bodies = [(symmetric(random, 3 * NODES * SLICES), symmetric(random, 2 * NODES)) for _ in range(2)]
    shape = (-1, SLICES, 3 * NODES, SLICES, 3 * NODES)
    by_section = [
        (by_nodes(blocks.reshape(shape).transpose(0, 1, 3, 2, 4), 3), by_nodes(sections, 2))
        for blocks, sections in bodies
    ]
    sections = [symmetric(random, 2 * FINE_NODES)[:, None, None] for _ in range(2)]
    layers, shares = random.random(SLICES) if kinds[0] == kinds[1] else np.zeros(SLICES), random.random(SLICES)
    # An end of the first slice.
    ends = np.zeros((SLICES, 1, 1, 4)) if kinds[0] == kinds[1] else np.zeros((SLICES, 1, 0, 4))
    ends[0, :, :] = 3.0, 0.0, 0.5, 0.2
    expected = by_whole_matrices(bodies, Fine(*sections, shares, layers, ends), rows, columns)
    fine = Fine(*(by_nodes(each, 2) for each in sections), shares, layers, ends)
    if kinds[0] == kinds[1]:
        expected += np.diag(np.tile(np.repeat((fine.shares * layers)[IN_SLICES], 3), kinds[0]))
        apart = rows[0].offsets[:3, None] - rows[0].offsets[:3]
        expected[:3, :3] += shares[0] * np.vectorize(lambda each: displacement_beside.py_func(ends[0, 0, 0], each))(
            apart
        )
    found = FormedRows.of(by_section, rows[0], columns[0], fine)
    asked = np.array([1, 4, 5])
    form_rows(found.address, asked)
    both = np.concatenate([12 * kind + asked for kind in range(kinds[0])])
    np.testing.assert_allclose(found.matrix[both], expected[both], rtol=1e-11, atol=1e-12 * np.abs(expected).max())
    assert not np.delete(found.matrix, both, axis=0).any()
    np.testing.assert_allclose(found.whole(), expected, rtol=1e-11, atol=1e-12 * np.abs(expected).max())


def test_without_friction_no_rows_are_needed():
    """Identity: between closed nodes, whatever the order in which they close, and of what forces displace, it is the
    compliance of all rows; also where other positions are built with it."""
    random = np.random.default_rng(7)
    (own, _, _), (other, _, _) = side(random, 1), side(random, 1)
    shape = (-1, SLICES, 3 * NODES, SLICES, 3 * NODES)
    blocks = [
        by_nodes(symmetric(random, 3 * NODES * SLICES).reshape(shape).transpose(0, 1, 3, 2, 4), 3) for _ in range(2)
    ]
    planes = [by_nodes(symmetric(random, 2 * NODES), 2) for _ in range(2)]
    sections = [by_nodes(symmetric(random, 2 * FINE_NODES)[:, None, None], 2) for _ in range(2)]
    ends = np.zeros((SLICES, 1, 1, 4))
    ends[0, :, :] = 3.0, 0.0, 0.5, 0.2
    fine = Fine(*sections, random.random(SLICES), random.random(SLICES), ends)
    bodies = [*zip(blocks, planes)]
    matrices = tuple(
        between_flank_nodes(SimpleNamespace(values=block), plane, fine.shares, [other, own], gear)[1]
        for gear, (block, plane) in enumerate(bodies)
    )
    found = FormedRows.of(bodies, own, own, fine, between=Between(matrices, functions()))
    forces = np.where(np.arange(12) % 3, random.random(12), 0.0)
    displaced = np.zeros(12)
    call_of(found.table[0, 3])(found.address, forces.ctypes.data, displaced.ctypes.data)
    for closed in (np.array([1, 7, 10]), np.arange(12)):
        former = call_of(found.factors.table[FORMER], 4)
        former(found.address, found.factors.table.ctypes.data, closed.ctypes.data, len(closed))
    known, members, slots = found.factors.arrays[-3:]
    assert not found.formed.any() and sorted(members) == [*range(12)] and slots[0] == 12
    expected = FormedRows.of(bodies, own, own, fine).whole()
    scale = np.abs(expected).max()
    np.testing.assert_allclose(-displaced, expected @ forces, rtol=0.0, atol=1e-13 * scale)
    np.testing.assert_allclose(
        np.tril(known), np.tril(expected[np.ix_(members, members)]), rtol=0.0, atol=1e-13 * scale
    )
    # Whichever closed first: to the last bit, so that runs on the same operators do not differ by each other.
    other = FormedRows.of(bodies, own, own, fine, between=Between(matrices, functions()))
    for closed in (np.array([2, 11]), np.array([0, 3, 5, 9]), np.arange(12)):
        former(other.address, other.factors.table.ctypes.data, closed.ctypes.data, len(closed))
    again, at, _ = other.factors.arrays[-3:]
    whole, once_more = (np.tril(each) + np.tril(each, -1).T for each in (known, again))
    one, two = members.argsort(), at.argsort()
    assert one.tolist() != two.tolist()
    np.testing.assert_array_equal(whole[np.ix_(one, one)], once_more[np.ix_(two, two)])


def call_of(address, numbers=3):
    """The C function at an address, of so many integers."""
    return ctypes.CFUNCTYPE(ctypes.c_int64, *[ctypes.c_int64] * numbers)(int(address))


def test_slices_that_are_taken_as_independent_are(paper_pair):
    """Brute force: no eigenvalue is below the bound; nodes that coincide are found."""
    random, kinds = np.random.default_rng(2), 2
    nodes, _, _ = side(random, kinds)
    nodes = nodes._replace(fine_first=np.tile([0, 2, 4], (2, 4)), fine_near=np.abs(nodes.fine_near))
    turn = random.uniform(0.0, 3.0, (2, 4))
    nodes.axes[..., 3:] = np.stack([np.cos(turn), np.sin(turn), -np.sin(turn), np.cos(turn)], axis=2).reshape(
        2, 4, 2, 2
    )
    own = np.eye(2 * FINE_NODES) + 0.01 * symmetric(random, 2 * FINE_NODES)[OFFSETS]
    blocks = [np.zeros((2 * OFFSETS + 1, 1, 1, *own.shape)) for _ in range(2)]
    for block in blocks:
        block[OFFSETS, 0, 0] = own
    fine = Fine(
        *(by_nodes(block, 2) for block in blocks), np.ones(SLICES), np.zeros(SLICES), np.zeros((SLICES, 1, 0, 4))
    )
    by_section = [(np.zeros((2 * OFFSETS + 1, SLICES, SLICES, 1, 1, 9)), np.zeros((2 * OFFSETS + 1, 1, 1, 4)))] * 2
    softest = np.full(2, np.linalg.eigvalsh(own)[0])

    def uncertain(side, least):
        held = FormedRows.of(by_section, side, side, fine)
        return uncertain_slices(held.address, softest, least)

    held = FormedRows.of(by_section, nodes, nodes, fine)
    for number in range(SLICES):
        section = fine_section(held.address, number)
        section = section.reshape(2 * [kinds * section.shape[1]])
        smallest = np.linalg.eigvalsh(section)[0]
        assert uncertain(nodes, 1.01 * smallest)[number] and not uncertain(nodes, 1e-3 * smallest)[number]
    nodes.fine_first[:, :2], nodes.fine_near.reshape(2, 12, 3)[:, 0] = 0, nodes.fine_near.reshape(2, 12, 3)[:, 1]
    assert uncertain(nodes, 1e-9).tolist() == [True, False, False]


@pytest.mark.parametrize("coast", [False, True], ids=["drive flanks", "both flanks"])
def test_stacked_sections_are_all_that_is_known(paper_pair, coast):
    """Identity: as far as any two flanks' compliance is known; beyond it not a number."""
    section = stand_in_compliance(paper_pair.pinion, elements=4, offsets=1, coast_flank=coast)
    blocks = stacked(section)
    reach = len(blocks) // 2
    assert reach == section.farthest
    for ahead, side, other in np.ndindex(2 * reach + 3, section.flanks, section.flanks):
        try:
            known = by_nodes(section.between(ahead - reach - 1, 0, (side, other)), 2)
        except ComputationError:
            known = np.nan
        if 0 < ahead < 2 * reach + 2:
            np.testing.assert_array_equal(blocks[ahead - 1, side, other], known)
        else:
            assert known is np.nan
