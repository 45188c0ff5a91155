"""Products of the compliance over a face with contact nodes' weights, against dense arithmetic."""

import numpy as np
import pytest
from tests.stand_in import stand_in_compliance

from fenics_gears import ComputationError
from fenics_gears.contact.fine_sections import stacked
from fenics_gears.contact.formed_rows import Fine, FormedRows, Side, form_rows

NODES, SLICES, OFFSETS = 6, 3, 2
TEETH, IN_SLICES = np.array([0, 0, 1, 2]), np.array([0, 2, 2, 1])
# The third group is the second in its slice, of three contact nodes each.
GROUPS = np.array([[0, 3, 6, 9], IN_SLICES, [0, 0, 3, 0], [3, 6, 6, 3]])


def symmetric(random, size):
    """Blocks of teeth up to OFFSETS apart, those behind the transposes of those ahead."""
    ahead = random.standard_normal((OFFSETS + 1, size, size))
    ahead[0] += ahead[0].T
    return np.stack([*(each.T for each in ahead[:0:-1]), *ahead])


def side(random, kinds):
    """Three contact nodes in each group, which see 2 nodes of either flank; and the weights (2, 12, NODES) of all."""
    firsts, near = random.integers(0, NODES - 2, (2, 4, 3)), random.random((2, 12, 2))
    lowest = firsts.min(axis=2)
    widths = firsts.max(axis=2) + 2 - lowest
    weights = np.zeros((2, 12, NODES))
    for gear, node in np.ndindex(2, 12):
        first = firsts[gear].ravel()[node]
        weights[gear, node, first : first + 2] = near[gear, node]
    on_gears = [
        [TEETH, width, np.cumsum(width) - width, IN_SLICES, 3 * low, 2 * low] for width, low in zip(widths, lowest)
    ]
    places = np.array(on_gears)[:, 2, :, None]
    first = (firsts - lowest[:, :, None] + places).reshape(2, 12)
    group, axes = np.repeat(np.arange(4), 3), random.standard_normal((2, 4, kinds, 5))
    return Side(group, first, GROUPS, np.array(on_gears), near, axes), weights


def by_whole_matrices(bodies, fine, rows, columns):
    """Every group's weights over all flank nodes and directions, times the whole blocks less the sections in the same
    slice; and the fine sections there."""
    (own, weights), (other, others) = rows, columns
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
    for number in range(SLICES):
        nodes = np.flatnonzero(np.repeat(IN_SLICES, 3) == number)
        size = kinds * kinds_of_columns * len(nodes) ** 2
        part = fine.numbers[fine.begins[number] : fine.begins[number] + size]
        part = part.reshape(kinds, len(nodes), kinds_of_columns, len(nodes))
        expected[:, nodes[:, None], :, nodes] += fine.shares[number] * part.transpose(1, 3, 0, 2)
    return expected.reshape(kinds * 12, kinds_of_columns * 12)


@pytest.mark.parametrize("kinds", [(1, 1), (2, 2), (2, 1)], ids=["frictionless", "friction", "step before"])
def test_rows_are_those_of_whole_matrices(kinds):
    """Brute force; rows that nobody asked for stay zero."""
    random = np.random.default_rng(5)
    rows, columns = (side(random, each) for each in kinds)
    bodies = [(symmetric(random, 3 * NODES * SLICES), symmetric(random, 2 * NODES)) for _ in range(2)]
    shape = (-1, SLICES, 3 * NODES, SLICES, 3 * NODES)
    by_section = [(blocks.reshape(shape).transpose(0, 1, 3, 2, 4), sections) for blocks, sections in bodies]
    sizes = [kinds[0] * kinds[1] * count**2 for count in (3, 3, 6)]
    fine = Fine(random.standard_normal(sum(sizes)), np.cumsum([0, *sizes[:2]]), random.random(SLICES))
    expected = by_whole_matrices(bodies, fine, rows, columns)
    found = FormedRows.of(by_section, rows[0], columns[0], fine)
    asked = np.array([1, 4, 5])
    form_rows(found.address, asked)
    both = np.concatenate([12 * kind + asked for kind in range(kinds[0])])
    np.testing.assert_allclose(found.matrix[both], expected[both], rtol=1e-11, atol=1e-12 * np.abs(expected).max())
    assert not np.delete(found.matrix, both, axis=0).any()
    np.testing.assert_allclose(found.whole(), expected, rtol=1e-11, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize("coast", [False, True], ids=["drive flanks", "both flanks"])
def test_stacked_sections_are_all_that_is_known(paper_pair, coast):
    """Identity: as far as any two flanks' compliance is known, also that of drive and coast flanks, which reaches
    further; beyond it not a number."""
    section = stand_in_compliance(paper_pair.pinion, elements=4, offsets=1, coast_flank=coast)
    blocks = stacked(section)
    reach = len(blocks) // 2
    assert reach == section.farthest
    for ahead, side, other in np.ndindex(2 * reach + 3, section.flanks, section.flanks):
        try:
            known = section.between(ahead - reach - 1, 0, (side, other))
        except ComputationError:
            known = np.nan
        if 0 < ahead < 2 * reach + 2:
            np.testing.assert_array_equal(blocks[ahead - 1, side, other], known)
        else:
            assert known is np.nan
