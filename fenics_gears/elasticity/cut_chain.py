"""How the cuts of a ring of equal sectors move under forces on one of them, by joining runs of sectors: for gears with many teeth.

A run of n sectors is twice as long as two of n/2 with the cut between them eliminated, so that the teeth that are not asked for cost
the logarithm of their number, where the Fourier transform (`elasticity.ring`) takes one dense inverse for every other tooth.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import log2

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from fenics_gears.errors import ComputationError

# Response (c, c) of the cut m pitches ahead to forces on a cut, as a function of m.
CutResponse = Callable[[int], np.ndarray]


@dataclass(frozen=True)
class Run:
    """Stiffness of a run of sectors between its two cuts, all else eliminated, each cut's dofs (c,) in its own sector's frame.

    lower, upper: (c, c), of the clockwise and the counter-clockwise cut alone. across: (c, c), force on the lower per motion of the upper.
    """

    lower: np.ndarray
    upper: np.ndarray
    across: np.ndarray


def joined(first: Run, second: Run) -> Run:
    """Two runs, the second counter-clockwise of the first, their common cut eliminated. Raises ComputationError where nothing holds it."""
    size = len(first.lower)
    try:
        factor = cho_factor(first.upper + second.lower)
    except np.linalg.LinAlgError as error:
        raise ComputationError("ring of sectors: the stiffness of a cut is not positive definite; is the hub held?") from error
    shared = cho_solve(factor, np.hstack([first.across.T, second.across]))
    by_lower, by_upper = shared[:, :size], shared[:, size:]
    return Run(
        _symmetric(first.lower - first.across @ by_lower),
        _symmetric(second.upper - second.across.T @ by_upper),
        -first.across @ by_upper,
    )


def run_of(link: Run, count: int) -> Run:
    """`count` (at least one) equal sectors one after the other, by doubling."""
    if count == 1:
        return link
    half = run_of(link, count // 2)
    twice = joined(half, half)
    return twice if count % 2 == 0 else joined(twice, link)


def chain_response(link: Run, teeth: int, reach: int) -> CutResponse:
    """Response of cuts up to `reach` pitches from the loaded one, in a ring of `teeth` sectors; reach < teeth.

    The cuts 0 ... reach are kept; the sectors between them are single, those the long way round one run.
    """
    size, rest = len(link.lower), run_of(link, teeth - reach)
    stiffness = np.zeros(((reach + 1) * size,) * 2)
    at = [slice(cut * size, (cut + 1) * size) for cut in range(reach + 1)]
    for cut in range(reach + 1):
        stiffness[at[cut], at[cut]] = (link if cut < reach else rest).lower + (link if cut else rest).upper
    for ends, run in [*(((cut, cut + 1), link) for cut in range(reach)), ((reach, 0), rest)]:
        lower, upper = (at[end] for end in ends)
        stiffness[lower, upper] += run.across
        stiffness[upper, lower] += run.across.T
    try:
        columns = cho_solve(cho_factor(stiffness), np.eye(len(stiffness), size))
    except np.linalg.LinAlgError as error:
        raise ComputationError("ring of sectors: the stiffness of its cuts is not positive definite; is the hub held?") from error
    return lambda offset: columns[at[offset]] if offset >= 0 else columns[at[-offset]].T


def chain_is_quicker(teeth: int, reach: int) -> bool:
    """Whether joining runs takes less than half of the Fourier transform's operations, both in cubes of a cut's dofs.

    Else the transform is kept, whose every bit is the same whatever the reach.
    """
    chain = (reach + 1) ** 3 / 3.0 + 2.0 * (reach + 1) ** 2 + 6.0 * log2(teeth)
    # A complex inverse, of four real operations each, for half of the harmonics, and its share in every response.
    fourier = 2.5 * teeth
    return reach < teeth and 2.0 * chain < fourier


def _symmetric(matrix: np.ndarray) -> np.ndarray:
    return 0.5 * (matrix + matrix.T)
