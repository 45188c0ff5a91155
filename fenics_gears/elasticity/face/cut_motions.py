"""How the cuts of a swept sector move: in a few hundred ways, while they have thousands of dofs.

A ring is solved for each of its harmonics (`elasticity.ring`). Half a tooth space and more is between a load on a flank
and a cut, which therefore moves smoothly. Its motions are taken from a space of two parts (Galerkin's method: what the
space misses enters a compliance squared):

* motions under loads on the flanks, of a ring whose teeth are all loaded alike, and of one whose teeth are loaded by
  turns one way and the other: all that is local;
* polynomials of height and radius in hub, web and rim: what the body does as a whole, in the harmonics between.

With 12 layers and 2,100 dofs of a cut 300 motions leave errors of 2e-6 of the largest compliance.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial.legendre import legvander
from scipy.linalg import cho_solve, svd

from ..ring import definite_factor
from .coarse_cuts import ENOUGH
from .layers import SweptWeb

# Local motions below this part of the largest are left out; shapes of a load along a profile.
LEAST_MOTION = 1e-5
PROFILE_SHAPES = 3
# Degree of the polynomials along the radius, and the least along the face; their part of the nodes there. Beside a web
# a rim bends sharply.
DEGREE = 6
OF_NODES = 1 / 3
OF_NODES_OF_MANY = 1 / 5
OF_NODES_WITH_WEB = 1.0
# Motions are told apart by this part of their length. All dofs are kept where fewer than so many of them would go.
TOLD_APART = 1e-6
WORTHWHILE = 0.6
WORTHWHILE_OF_MANY = 0.8
# In the radius.
ROUND_OFF = 1e-9


def cut_motions(stiffness: np.ndarray, loads: np.ndarray, places: np.ndarray, web: SweptWeb | None) -> np.ndarray:
    """Orthonormal motions (c, r) of a cut under loads (f + 2 c, k).

    stiffness: (f + 2 c, f + 2 c), N/mm, of some dofs of a sector, of its lower cut, and of its upper cut in the next
    sector's frame. places: (c / 3, 3), X, Y, z of the lower cut's nodes.
    """
    cut = 3 * len(places)
    smooth = smooth_motions(places, web)
    most = (WORTHWHILE_OF_MANY if _many(places) else WORTHWHILE) * cut
    if smooth.shape[1] > most:
        return np.eye(cut)
    local = np.hstack([_motions(stiffness, loads, cut, sign) for sign in (1.0, -1.0)])
    directions, sizes = _directions(local)
    local = directions[:, sizes > LEAST_MOTION * sizes[0]]
    motions, sizes = _directions(np.hstack([local, smooth]))
    motions = motions[:, sizes > TOLD_APART]
    return motions if motions.shape[1] <= most else np.eye(cut)


def _many(places: np.ndarray) -> bool:
    """Whether nodes stand at so many heights that their motions err by less than the cuts of wide faces do."""
    return len(np.unique(places[:, 2].round(9))) > 2 * ENOUGH + 1


def _directions(motions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Orthonormal directions of motions and their sizes, the largest first."""
    try:
        directions, sizes, _ = np.linalg.svd(motions, full_matrices=False)
    except np.linalg.LinAlgError:
        # Divide and conquer has not converged, as it does now and then; the slower method does.
        directions, sizes, _ = svd(motions, full_matrices=False, lapack_driver="gesvd")
    return directions, sizes


def over_motions(stiffness: np.ndarray, motions: np.ndarray) -> np.ndarray:
    """Such a stiffness with the `motions` (c, r) of each cut in place of its dofs."""
    dofs, size = motions.shape
    if dofs == size:
        return stiffness
    others = len(stiffness) - 2 * dofs
    reduced = np.empty((others + 2 * size,) * 2)
    reduced[:others, :others] = stiffness[:others, :others]
    for number in (0, 1):
        own = slice(others + number * size, others + (number + 1) * size)
        moved = motions.T @ stiffness[others + number * dofs : others + (number + 1) * dofs]
        reduced[own, :others] = moved[:, :others]
        reduced[:others, own] = moved[:, :others].T
        reduced[own, others:] = loads_over_motions(moved[:, others:].T, motions).T
    return reduced


def loads_over_motions(loads: np.ndarray, motions: np.ndarray) -> np.ndarray:
    """Loads (2 r, k) on the motions of both cuts from loads (2 c, k) on their dofs."""
    return np.vstack([motions.T @ each for each in np.split(loads, 2)])


def loads_on_flanks(flanks: int, profile: int) -> np.ndarray:
    """Loads (f, k): at each height in each direction, even, linear and quadratic along the `profile` nodes of a flank.
    Mirrored, they are the same set."""
    shapes = legvander(np.linspace(-1.0, 1.0, profile), min(PROFILE_SHAPES, profile) - 1)
    return np.kron(np.eye(flanks // (3 * profile)), np.kron(np.linalg.qr(shapes)[0], np.eye(3)))


def _motions(stiffness: np.ndarray, loads: np.ndarray, cut: int, sign: float) -> np.ndarray:
    """Of a cut (c, k), where each tooth bears `sign` times what the one before it does."""
    lower = len(stiffness) - cut
    own = slice(lower - cut, lower)
    joined = stiffness[:lower, :lower].copy()
    joined[:, own] += sign * stiffness[:lower, lower:]
    joined[own] += sign * stiffness[lower:, :lower]
    joined[own, own] += stiffness[lower:, lower:]
    forces = loads[:lower].copy(order="F")
    forces[own] += sign * loads[lower:]
    # Transposed, it is in LAPACK's order.
    factor = definite_factor(joined.T, "a ring of equal loads", overwrite=True)
    return cho_solve((factor, False), forces, overwrite_b=True, check_finite=False)[own]


def smooth_motions(places: np.ndarray, web: SweptWeb | None) -> np.ndarray:
    """Orthonormal polynomials (c, k) over hub, web and rim, a part by itself."""
    radius = np.hypot(places[:, 0], places[:, 1])
    # Nodes on the circles belong to hub and rim.
    circles = [] if web is None else [web.hub_radius * (1.0 + ROUND_OFF), web.rim_radius * (1.0 - ROUND_OFF)]
    part = np.searchsorted(circles, radius)
    share = OF_NODES_WITH_WEB if web is not None else OF_NODES_OF_MANY if _many(places) else OF_NODES
    parts = []
    for number in np.unique(part):
        own = np.flatnonzero(part == number)
        along_radius = _by_degree(radius[own])
        along_face = _by_degree(places[own, 2], share)
        products = np.einsum("ni,nj->nij", along_radius, along_face).reshape(len(own), -1)
        # No more than there are nodes, at all heights or not.
        orthonormal = np.linalg.qr(products)[0]
        shapes = np.zeros((len(places), orthonormal.shape[1]))
        shapes[own] = orthonormal
        parts.append(np.kron(shapes, np.eye(3)))
    return np.hstack(parts)


def _by_degree(values: np.ndarray, share: float = 0.0) -> np.ndarray:
    """Legendre polynomials (n, degree + 1) over the range of some values (n,), of DEGREE or of a `share` of the
    different values."""
    different = len(np.unique(values.round(9)))
    middle = 0.5 * (values.max() + values.min())
    half = 0.5 * (values.max() - values.min()) or 1.0
    return legvander((values - middle) / half, min(max(DEGREE, int(share * different)), different - 1))
