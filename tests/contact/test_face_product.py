"""Products of the compliance over a face with contact nodes' weights, against dense arithmetic."""

import numpy as np
import pytest

from fenics_gears.contact.face_product import Groups, OnGear, Side, face_product
from fenics_gears.contact.interpolation import FlankInterpolation

NODES, SLICES, OFFSETS = 6, 3, 2
TEETH, IN_SLICES = np.array([0, 0, 1, 2]), np.array([0, 2, 2, 1])


def symmetric(random, size):
    """Blocks of teeth up to OFFSETS apart, those behind the transposes of those ahead."""
    ahead = random.standard_normal((OFFSETS + 1, size, size))
    ahead[0] += ahead[0].T
    return np.stack([*(each.T for each in ahead[:0:-1]), *ahead])


def groups(random):
    """Contact nodes of each group, 3 of which see 2 nodes of either flank, and their first node."""
    firsts = random.integers(0, NODES - 2, (len(TEETH), 2, 3))
    return [tuple(FlankInterpolation(random.random((3, 2)), first, NODES) for first in each) for each in firsts]


def on_gear(gear, groups, axes, plane_axes):
    first = groups.first[gear]
    return OnGear(
        TEETH,
        IN_SLICES,
        groups.widths[gear],
        groups.places[gear],
        3 * (NODES * IN_SLICES + first),
        2 * first,
        axes,
        plane_axes,
    )


@pytest.mark.parametrize("kinds", [1, 2])
@pytest.mark.parametrize("whole", [True, False], ids=["symmetric", "rows and columns"])
def test_products_are_those_of_whole_matrices(kinds, whole):
    """Brute force: every group's weights over all flank nodes and directions, times the whole blocks less the sections
    in the same slice."""
    random = np.random.default_rng(5)
    rows = groups(random)
    columns = rows if whole else groups(random)
    own, other = Groups.of(rows), Groups.of(columns)
    shares = random.random(SLICES)
    bodies, sides = [], ([], [])
    expected = np.zeros((kinds, 12, kinds, 12))
    for gear in range(2):
        blocks, sections = symmetric(random, 3 * NODES * SLICES), symmetric(random, 2 * NODES)
        axes, plane_axes = (
            random.standard_normal((len(TEETH), kinds, 3)),
            random.standard_normal((len(TEETH), kinds, 2)),
        )
        bodies.append((blocks, sections))
        for side, groups_of_side in zip(sides, (own, other)):
            side.append(on_gear(gear, groups_of_side, axes, plane_axes))
        for p, q in np.ndindex(len(TEETH), len(TEETH)):
            number = OFFSETS + TEETH[p] - TEETH[q]
            block = blocks[number].reshape(SLICES, NODES, 3, SLICES, NODES, 3)[IN_SLICES[p], :, :, IN_SLICES[q]]
            seen_there = np.einsum(
                "ni,da,iajb,eb,mj->dnem", rows[p][gear].weights, axes[p], block, axes[q], columns[q][gear].weights
            )
            if IN_SLICES[p] == IN_SLICES[q]:
                section = sections[number].reshape(NODES, 2, NODES, 2)
                plane = np.einsum(
                    "ni,da,iajb,eb,mj->dnem",
                    rows[p][gear].weights,
                    plane_axes[p],
                    section,
                    plane_axes[q],
                    columns[q][gear].weights,
                )
                seen_there -= shares[IN_SLICES[p]] * plane
            expected[:, 3 * p : 3 * p + 3, :, 3 * q : 3 * q + 3] += seen_there
    first = Side(own, tuple(sides[0]))
    second = first if whole else Side(other, tuple(sides[1]))
    found = face_product(bodies, shares, first, second)
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12 * np.abs(expected).max())
