"""The ring of sectors, and joined runs of them. Against brute force and its kernel: hard cases 5 and 6."""

import numpy as np
import pytest
from tests.coarse_sector import relative

from fenics_gears import ComputationError
from fenics_gears.elasticity.cut_chain import joined, run_of
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.ring import condensed_sector, cut_response, ring_compliance


def link_of(seed, size=4):
    """A made-up sector between its cuts: positive definite."""
    square = np.random.default_rng(seed).standard_normal((2 * size, 2 * size))
    return square @ square.T + 0.5 * np.eye(2 * size)


def ring_inverse(link, teeth):
    size = len(link) // 2
    whole, parts = np.zeros((teeth, size, teeth, size)), link.reshape(2, size, 2, size)
    for tooth in range(teeth):
        for row in (0, 1):
            for column in (0, 1):
                whole[(tooth + row) % teeth, :, (tooth + column) % teeth] += parts[row, :, column]
    return np.linalg.inv(whole.reshape(teeth * size, -1)).reshape(teeth, size, teeth, size)[:, :, 0]


@pytest.mark.parametrize("teeth, reach", [(5, 1), (12, 3), (13, 4), (31, 2), (4, 3), (2, 1)])
def test_it_is_the_inverse_of_the_whole_ring(teeth, reach):
    """Brute force: numpy's inverse; odd and even numbers of sectors, a single one too."""
    link = link_of(teeth)
    exact = ring_inverse(link, teeth)
    response = cut_response(link, teeth, reach)
    for offset in range(-reach, reach + 1):
        assert relative(response(offset) - exact[offset % teeth], exact[0]) < 1e-11


def test_joining_eliminates_the_common_cut():
    """numpy's Schur complement; a run of five by doubling is five joined in a row."""
    one, other = link_of(1), link_of(2)
    size = len(one) // 2
    nothing = np.zeros((size, size))
    assembled = np.block(
        [
            [one[:size, :size], nothing, one[:size, size:]],
            [nothing, other[size:, size:], other[size:, :size]],
            [one[size:, :size], other[:size, size:], one[size:, size:] + other[:size, :size]],
        ]
    )
    kept, out = slice(0, 2 * size), slice(2 * size, None)
    exact = assembled[kept, kept] - assembled[kept, out] @ np.linalg.solve(assembled[out, out], assembled[out, kept])
    assert relative(joined(one, other) - exact, exact) < 1e-12
    row = one
    for _ in range(4):
        row = joined(row, one)
    assert relative(row - run_of(one, 5), row) < 1e-10


def test_cuts_that_do_not_match_are_refused(pinion, coarse_sector):
    """A ring of one tooth more has another pitch."""
    sector = condensed_sector(coarse_sector("P1"), ELEMENTS["P1"], 0.3)
    with pytest.raises(ComputationError, match="do not match"):
        ring_compliance(sector, pinion.teeth + 1, 1)
