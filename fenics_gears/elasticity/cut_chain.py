"""How the cuts of a ring of equal sectors move under forces on one of them, by joining runs of sectors: for gears with
many teeth.

A run of n sectors is two of n/2 with the cut between them eliminated, so that the cost grows with the logarithm of the
number of teeth. The Fourier transform (`elasticity.ring`) takes one dense inverse for every other tooth. A run is its
stiffness (2 c, 2 c) over its clockwise and its counter-clockwise cut, each cut's dofs (c) in its own sector's frame.
"""

from collections.abc import Callable, Sequence
from math import log2

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from fenics_gears.errors import ComputationError

# Response (c, c) of the cut m pitches ahead to forces on a cut, as a function of m.
CutResponse = Callable[[int], np.ndarray]


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


def chain_response(link: np.ndarray, teeth: int, reach: int) -> CutResponse:
    """Response of cuts up to `reach` pitches from the loaded one, in a ring of `teeth` sectors; reach < teeth. The
    sectors between these cuts are single, those the long way round one run."""
    cut = len(link) // 2
    stiffness = closed_ring([link] * reach + [run_of(link, teeth - reach)], cut)
    columns = _solved(stiffness, np.eye(len(stiffness), cut)).reshape(reach + 1, cut, cut)
    return lambda offset: columns[offset] if offset >= 0 else columns[-offset].T


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


def chain_is_quicker(teeth: int, reach: int) -> bool:
    """Whether joining runs takes less than half of the Fourier transform's operations, both in cubes of a cut's dofs.
    Else the transform is kept: its result is the same to the last bit for any reach."""
    chain = (reach + 1) ** 3 / 3.0 + 2.0 * (reach + 1) ** 2 + 6.0 * log2(teeth)
    # A complex inverse, of four real operations each, for half of the harmonics, and its share in every response.
    fourier = 2.5 * teeth
    return reach < teeth and 2.0 * chain < fourier


def _solved(stiffness: np.ndarray, loads: np.ndarray) -> np.ndarray:
    try:
        return cho_solve(cho_factor(stiffness), loads)
    except np.linalg.LinAlgError as error:
        raise ComputationError(
            "joining sectors: the stiffness of a cut is not positive definite; is the hub held?"
        ) from error
