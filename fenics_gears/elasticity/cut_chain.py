"""Runs of equal sectors joined to the rest of a ring, where not all its sectors are alike.

A run of n sectors is two of n/2 with the cut between them eliminated, so that the cost grows with the logarithm of the
number of teeth. A run is its
stiffness (2 c, 2 c) over its clockwise and its counter-clockwise cut, each cut's dofs (c) in its own sector's frame.
"""

from collections.abc import Sequence

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from fenics_gears.errors import ComputationError


def joined(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Two runs, the second counter-clockwise of the first, their common cut eliminated."""
    cut = len(first) // 2
    total = np.zeros((3 * cut, 3 * cut))
    total[: 2 * cut, : 2 * cut] += first
    total[cut:, cut:] += second
    numbers = np.arange(3 * cut)
    return eliminated(total, np.delete(numbers, slice(cut, 2 * cut)), numbers[cut : 2 * cut])


def eliminated(stiffness: np.ndarray, kept: np.ndarray, free: np.ndarray) -> np.ndarray:
    """Schur complement on the kept dofs, symmetrised. Raises ComputationError where nothing holds the free ones."""
    coupling = stiffness[np.ix_(free, kept)]
    result = stiffness[np.ix_(kept, kept)] - coupling.T @ _solved(stiffness[np.ix_(free, free)], coupling)
    return 0.5 * (result + result.T)


def run_of(link: np.ndarray, count: int) -> np.ndarray:
    """`count` (at least one) equal sectors one after the other, by doubling."""
    if count == 1:
        return link
    half = run_of(link, count // 2)
    twice = joined(half, half)
    return twice if count % 2 == 0 else joined(twice, link)


def closed_ring(parts: Sequence[np.ndarray], cut: int) -> np.ndarray:
    """Stiffness of two or more parts that go once around the gear: over the lower cut of each part, then over their
    other dofs. parts: counter-clockwise, each over its lower cut (`cut` dofs), its upper cut in the frame of the part
    ahead, and other dofs, if any."""
    inner = np.cumsum([cut * len(parts)] + [len(part) - 2 * cut for part in parts])
    total = np.zeros((inner[-1],) * 2)
    for number, part in enumerate(parts):
        ahead = (number + 1) % len(parts)
        cuts = [slice(each * cut, (each + 1) * cut) for each in (number, ahead)]
        dofs = np.r_[*cuts, inner[number] : inner[number + 1]]
        total[np.ix_(dofs, dofs)] += part
    return total


def _solved(stiffness: np.ndarray, loads: np.ndarray) -> np.ndarray:
    try:
        return cho_solve(cho_factor(stiffness), loads)
    except np.linalg.LinAlgError as error:
        raise ComputationError(
            "joining sectors: the stiffness of a cut is not positive definite; is the hub held?"
        ) from error
