"""Compliance between slices of a face, found where it is asked for."""

import numpy as np
import pytest
from scipy import sparse

from fenics_gears.elasticity.slice_compliance import SliceCompliance

NODES, HEIGHTS, SLICES, TEETH = 3, 5, 4, 3


@pytest.mark.parametrize("flanks", [1, 2])
def test_slices_average_what_layers_tell(flanks):
    """Brute force, in both directions between two teeth; zero where nobody asked."""
    random, size = np.random.default_rng(3), flanks * HEIGHTS * NODES
    blocks = random.standard_normal((TEETH, 3 * size, 3 * size))
    blocks[0] += blocks[0].T
    averages = [
        sparse.random(SLICES * NODES, HEIGHTS * NODES, 0.5, "csr", random_state=7 + flank) for flank in range(flanks)
    ]
    seen = np.kron(sparse.block_diag(averages).toarray(), np.eye(3))
    sections = flanks * SLICES
    expected = [seen @ block @ seen.T for block in (*(block.T for block in blocks[:0:-1]), *blocks)]
    found = SliceCompliance(blocks, averages, SLICES)
    asked = np.array([[0, 0, 0], [0, 1, 3], [1, 2, 0], [-2, 1, 2], [2, sections - 1, 1], [0, sections - 1, 0]])
    for part in (asked[:2], asked):
        found.find(*part.T)
    both = {tuple(each) for each in np.vstack([asked, asked[:, [0, 2, 1]] * [-1, 1, 1]]).tolist()}
    for number, own, other in np.ndindex(2 * TEETH - 1, sections, sections):
        block = expected[number].reshape(sections, NODES, 3, sections, NODES, 3)[own, :, :, other]
        known = (number - TEETH + 1, own, other) in both
        values = block.transpose(0, 2, 1, 3).reshape(NODES, NODES, 9) if known else 0.0
        np.testing.assert_allclose(found.values[number, own, other], values, rtol=1e-11, atol=1e-12)
