"""Whether a frictional solution is the only one with its slip directions: a certificate from the flexibility of the
closed nodes.

With normal forces p at the closed nodes and friction sigma mu p the gaps respond by M p, M = W_nn + W_nt diag(sigma
mu), W = C + G K^-1 G^T. Two solutions would differ by d with d_j (M d)_j <= 0 at every node. That is impossible where
sym(D M) is positive definite for some positive diagonal D; D = 1 is the certificate of the hard cases.

Where contact alone holds the load, K is singular along a motion f, a = G_n f, b = a + diag(sigma mu) G_t f. Forces then
differ by d with b . d = 0, and gaps may also shift by any multiple of a. With D = diag(b/a) the shift does no work, (D
a) . d = 0: what remains is sym(D M) positive definite on b . d = 0, with the regular part of K in M. b/a > 0 means that
nothing locks. The same D serves where inertia makes K regular but little: its part of D M is then b b^T/lambda, which
is positive too.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable
from functools import lru_cache
from itertools import compress

import numpy as np
from numba import njit

from .laws import OPEN, SLIP_BACKWARD, STICK
from .mixed_form import add_slip, put_entries

# Below this part of the largest eigenvalue a stiffness holds nothing.
SINGULAR = 1e-14


def flexibility(stiffness: np.ndarray, compliance: np.ndarray, jacobian: np.ndarray) -> np.ndarray:
    """W = C + G K^+ G^T (m, m), mm/N; motions that the stiffness does not hold are left out."""
    values, vectors, held = _motions(stiffness.tobytes(), len(stiffness))
    moved = jacobian @ vectors[:, held]
    return compliance + (moved / values[held]) @ moved.T


def is_only_solution(
    stiffness: np.ndarray,
    compliance: np.ndarray,
    jacobian: np.ndarray,
    friction: float,
    closed: np.ndarray,
    sigma: np.ndarray,
) -> bool:
    """Whether no second solution slips in the same directions; `closed` (n,) bool, `sigma` (n,): friction p_t/(mu p_n)
    of a node."""
    return _certified(stiffness, friction, [(compliance, jacobian, np.flatnonzero(closed), sigma)])[0]


def uncertified(stiffness: np.ndarray, friction: float, solved: Iterable) -> int:
    """How many solutions have no certificate; `solved`: contact operator, status (n,) and forces (m,), N, of each.

    Cycles repeat the same operators and sets: each of them is judged once, where no node sticks.
    """
    operators, sets, forces = zip(*solved)
    status, ends = np.concatenate(sets), np.cumsum([len(each) for each in sets]).tolist()
    sigma, parts = np.where(status == SLIP_BACKWARD, -1.0, 1.0), [slice(*each) for each in zip([0, *ends], ends)]
    if (stick := status == STICK).any():
        normal, tangential = np.hstack([each.reshape(2, -1) for each in forces])[:, stick]
        sigma[stick] = tangential / (friction * np.maximum(normal, np.finfo(float).tiny))
    keys = [(id(operator), sigma[own].tobytes(), status[own].tobytes()) for operator, own in zip(operators, parts)]
    times, first = Counter(keys), {key: place for place, key in reversed(list(enumerate(keys)))}
    judged = [
        (
            operators[place].stored.rows,
            operators[place].jacobian,
            np.flatnonzero(sets[place] != OPEN),
            sigma[parts[place]],
        )
        for place in first.values()
    ]
    certified = _certified(stiffness, friction, judged)
    return sum(times[key] for key, only in zip(first, certified) if not only)


def _certified(stiffness: np.ndarray, friction: float, judged: list[tuple]) -> list[bool]:
    """Whether each of many solutions (compliance, Jacobian, closed nodes, sigma) has a certificate, by D = 1 or by D =
    diag(b/a), or by the latter alone where contact alone holds the load: those with as many closed nodes m together."""
    values, vectors, held = _motions(stiffness.tobytes(), len(stiffness))
    certified = [not len(nodes) for *_, nodes, _ in judged]
    if np.count_nonzero(~held) > 1:
        return certified
    of_size: dict[int, list[int]] = defaultdict(list)
    for place, (*_, nodes, _) in enumerate(judged):
        if len(nodes):
            of_size[len(nodes)].append(place)
    for m, places in of_size.items():
        matrices = np.empty((len(places), m, m))
        moved = np.empty((len(places), 2 * m, len(values)))
        share = np.empty((len(places), m))
        for i, place in enumerate(places):
            compliance, jacobian, nodes, sigma = judged[place]
            moved[i] = jacobian[np.concatenate((nodes, len(sigma) + nodes))]
            share[i] = friction * sigma[nodes]
            between_closed(matrices[i], compliance, nodes, share[i])
        moved = moved @ vectors
        normal = moved[:, :m]
        sliding = normal + share[:, :, None] * moved[:, m:]
        matrices = matrices + (normal[..., held] / values[held]) @ sliding[..., held].transpose(0, 2, 1)
        if held.all():
            _certify(certified, places, matrices)
        a = normal[..., 0]
        b = sliding[..., 0]
        left = np.all(a * b > 0.0, axis=1) & ~np.array(certified)[places]
        weighted = (b[left] / a[left])[:, :, None] * matrices[left]
        _certify(certified, list(compress(places, left)), weighted if held.all() else _across(b[left], weighted))
    return certified


def _certify(certified: list[bool], places: list[int], matrices: np.ndarray) -> None:
    """In place, say of `places` whether their matrices are positive definite."""
    together = _positive(matrices)
    for place, matrix in zip(places, matrices):
        certified[place] = together or _positive(matrix)


@njit(cache=True)
def between_closed(matrix, compliance, nodes, share):
    """Put the normal compliance between closed nodes into a matrix (m, m), with what tangential forces give that are
    the `share` (m,) of the normal ones."""
    for i in range(len(nodes)):
        row = compliance[nodes[i]]
        put_entries(matrix[i], row, nodes, np.int64(0), 1.0)
        add_slip(matrix[i], row[len(compliance) // 2 :], nodes, share, 1.0)


@lru_cache(maxsize=4)
def _motions(stiffness: bytes, size: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Eigenvalues, eigenvectors as columns, and which of them a stiffness holds; a march asks for those of one
    stiffness hundreds of times."""
    values, vectors = np.linalg.eigh(np.frombuffer(stiffness).reshape(size, size))
    return values, vectors, values > SINGULAR * max(values[-1], 0.0)


def _across(directions: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """Symmetric parts (..., n - 1, n - 1) of matrices (..., n, n), times two, on what is perpendicular to `directions`
    (..., n): between all axes but the first that the reflections give which take these into the first axis."""
    mirrors = directions / np.linalg.norm(directions, axis=-1, keepdims=True)
    mirrors[..., 0] += np.copysign(1.0, mirrors[..., 0])
    mirrors *= np.sqrt(2.0 / np.sum(mirrors**2, axis=-1))[..., None]
    symmetric = matrix + np.swapaxes(matrix, -1, -2)
    # With the reflection 1 - v v^T: s - v w^T - w v^T, w = s v - (v . s v) v/2.
    shares = (symmetric @ mirrors[..., None])[..., 0]
    shares -= 0.5 * np.sum(mirrors * shares, axis=-1)[..., None] * mirrors
    outer = mirrors[..., :, None] * shares[..., None, :]
    return (symmetric - outer - np.swapaxes(outer, -1, -2))[..., 1:, 1:]


def _positive(matrix: np.ndarray) -> bool:
    """Whether the symmetric part of a matrix (m, m), or of each of several, is positive definite."""
    try:
        np.linalg.cholesky(matrix + np.swapaxes(matrix, -1, -2))
    except np.linalg.LinAlgError:
        return False
    return True
