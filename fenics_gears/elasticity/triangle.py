"""Symmetric matrices of which one triangle is known."""

import numpy as np

# Rows that are transposed at once.
BLOCK = 128


def symmetric(upper: np.ndarray) -> np.ndarray:
    """The symmetric or Hermitian matrix whose upper triangle is given, in its place."""
    # Block by block: a transposed copy of a large matrix takes as long as a product of smaller ones.
    for first in range(0, len(upper), BLOCK):
        last = first + BLOCK
        upper[last:, first:last] = upper[first:last, last:].conj().T
        own = upper[first:last, first:last]
        own[:] = np.triu(own) + np.triu(own, 1).conj().T
    return upper
