"""Runs of layers, by the inverse of all of their sections at once."""

import numpy as np

from fenics_gears.elasticity.face.layer_run import LayerRun

SECTION, FLANK = 7, 2


def _layer(generator) -> np.ndarray:
    """A definite stiffness of a layer's lower, middle and upper section."""
    matrix = generator.standard_normal((3 * SECTION,) * 2)
    return matrix @ matrix.T + np.eye(3 * SECTION)


def _run(matrix: np.ndarray) -> LayerRun:
    blocks = {
        (row, column): matrix[row * SECTION :, column * SECTION :][:SECTION, :SECTION]
        for row, column in np.ndindex(3, 3)
    }
    return LayerRun.of_layer(blocks, FLANK)


def test_joined_layers_are_one_body():
    """Exact: forces on the flank move it as in the whole, which is inverted in one piece."""
    generator = np.random.default_rng(3)
    layers = [_layer(generator) for _ in range(5)]
    whole = np.zeros(((2 * len(layers) + 1) * SECTION,) * 2)
    for number, layer in enumerate(layers):
        own = slice(2 * number * SECTION, (2 * number + 3) * SECTION)
        whole[own, own] += layer
    on_flank = np.flatnonzero(np.arange(len(whole)) % SECTION >= SECTION - FLANK)
    first, second, third, fourth, last = map(_run, layers)
    joined = first.joined(second).joined(third.joined(fourth)).joined(last)
    expected = np.linalg.inv(whole)[np.ix_(on_flank, on_flank)]
    assert np.abs(joined.compliance() - expected).max() < 1e-12 * np.abs(expected).max()
