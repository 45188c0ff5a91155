"""How the cuts of a swept sector move: in a few hundred ways, while they have thousands of dofs.

A ring is solved for each of its harmonics (`elasticity.ring`), in which loads on all teeth are alike but for a phase
from tooth to tooth. The motions of a cut change smoothly with this phase. So those at a few phases span those at all
(Galerkin's method: what the space misses enters a compliance squared).
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial.legendre import legvander
from scipy.linalg import cho_solve, eigh, solve_triangular

from ..ring import Parts, cyclic, definite_factor

# All motions are kept of a cut of so few dofs.
FEW = 300
# Of motions under loads that each do as much work, those with less than this part (squared) of all are left out.
LEAST_MOTION = 2e-3
# Shapes of a load along a profile.
PROFILE_SHAPES = 2
# Of phases, from one to the next at most.
GROWTH = 2.5


def between_few_motions(parts: Parts, profile: int, teeth: int) -> Parts:
    """Parts of a ring (`ring.between_cuts`) whose cuts move as under loads on flanks with `profile` nodes at a height:
    each cut's (c, r) motions in place of its dofs."""
    held, to_cuts, link = parts
    motions = cut_motions(link, to_cuts.T @ loads_on_flanks(len(held), profile), teeth)
    return held, loads_over_motions(to_cuts.T, motions).T, over_motions(link, motions)


def cut_motions(link: np.ndarray, loads: np.ndarray, teeth: int) -> np.ndarray:
    """Motions (c, r) of a cut in a ring of sectors between their cuts (2 c, 2 c), N/mm, under loads (2 c, k) on the
    cuts of each sector; orthonormal by the stiffness of a cut whose neighbours are held."""
    same, ahead = cyclic(link)
    if len(same) <= FEW:
        return np.eye(len(same))
    lower, upper = np.split(loads, 2)
    moved = []
    turns = _turns(teeth)
    for turn in turns:
        forces = lower + upper * turn
        # Transposed, the conjugate is in LAPACK's order.
        factor = definite_factor((same + ahead * turn + ahead.T * np.conj(turn)).T, "a harmonic")
        motion = cho_solve((factor, False), forces, check_finite=False)
        work = np.einsum("ij,ij->j", forces.conj(), motion).real
        motion /= np.sqrt(np.maximum(work, np.finfo(float).tiny))
        moved += [motion.real, motion.imag] if np.iscomplexobj(motion) else [motion]
    # What this makes of a motion is as long as the root of its work.
    root = np.triu(definite_factor(same.T, "a cut"))
    whitened = root @ np.hstack(moved)
    squares = whitened @ whitened.T
    least = LEAST_MOTION**2 * len(turns)
    directions = eigh(squares, subset_by_value=(least, np.inf), overwrite_a=True, check_finite=False)[1]
    return solve_triangular(root, directions, overwrite_b=True, check_finite=False)


def _turns(teeth: int) -> list[complex]:
    """Turns of the phase back from one tooth to the next: none, that of the first harmonic, and others up to opposite
    signs. These two are real, which a harmonic's stiffness becomes by them."""
    opposite = abs(teeth) / 2.0
    steps = int(np.ceil(np.log(opposite) / np.log(GROWTH)))
    harmonics = np.geomspace(1.0, opposite, steps + 1)[:-1]
    return [1.0, *np.exp(-1j * np.pi * harmonics / opposite), -1.0]


def over_motions(link: np.ndarray, motions: np.ndarray) -> np.ndarray:
    """Stiffness (2 r, 2 r) of a sector between its cuts with their `motions` (c, r) in place of dofs."""
    return loads_over_motions(loads_over_motions(link, motions).T, motions)


def loads_over_motions(loads: np.ndarray, motions: np.ndarray) -> np.ndarray:
    """Loads (2 r, k) on the motions of both cuts from loads (2 c, k) on their dofs."""
    return np.vstack([motions.T @ each for each in np.split(loads, 2)])


def loads_on_flanks(flanks: int, profile: int) -> np.ndarray:
    """Loads (f, k): at each height in each direction, even and linear along the `profile` nodes of a flank.
    Mirrored, they are the same set."""
    shapes = legvander(np.linspace(-1.0, 1.0, profile), min(PROFILE_SHAPES, profile) - 1)
    return np.kron(np.eye(flanks // (3 * profile)), np.kron(np.linalg.qr(shapes)[0], np.eye(3)))
