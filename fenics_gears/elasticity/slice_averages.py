"""Averages over slices of a face of what is known at the nodes of its layers."""

import numpy as np

from .face.layers import shapes

GAUSS_POINTS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(3)


def slice_averages(heights: np.ndarray, order: int, positions: np.ndarray, widths: np.ndarray) -> np.ndarray:
    """Weights (S, h) of the layers' nodes at `heights` (h,), mm, in the averages over slices with middles and widths
    (S,), mm.

    `order`: 1 or 2, of the shape functions along a layer. Raises ValueError for a slice that reaches beyond the layers.
    """
    if len(heights) == 1:
        return np.ones((len(positions), 1))
    ends = heights[::order]
    slack = 1e-9 * (ends[-1] - ends[0])
    low, high = positions - 0.5 * widths, positions + 0.5 * widths
    if low.min() < ends[0] - slack or high.max() > ends[-1] + slack:
        raise ValueError(
            f"slices from {low.min():g} to {high.max():g} mm reach beyond the layers, {ends[0]:g} to {ends[-1]:g} mm"
        )
    weights = np.zeros((len(positions), len(heights)))
    for number, (start, end, width) in enumerate(zip(low, high, widths)):
        for layer in range(len(ends) - 1):
            bottom, top = max(start, ends[layer]), min(end, ends[layer + 1])
            if top <= bottom:
                continue
            points = 0.5 * (top + bottom) + 0.5 * (top - bottom) * GAUSS_POINTS
            local = (points - ends[layer]) / (ends[layer + 1] - ends[layer])
            share = 0.5 * (top - bottom) / width * GAUSS_WEIGHTS
            for node, values in enumerate(shapes(2.0 * local - 1.0)[0] if order == 2 else (1.0 - local, local)):
                weights[number, order * layer + node] += share @ values
    return weights


def on_slices(blocks: np.ndarray, weights: np.ndarray, flanks: int = 1) -> np.ndarray:
    """Compliance (k, D, D) of teeth on the nodes of layers as that on slices, of every tooth from k - 1 behind to k - 1
    ahead: (2 k - 1, F S, F S, d, d), between the d dofs of a flank's section in one slice and in another.

    `weights` (S, h) of `slice_averages`; dofs of layers by flank, then height, then the section's own.
    """
    slices, heights = weights.shape
    own, ahead = blocks.shape[1] // (heights * flanks), len(blocks) - 1
    found = np.empty((2 * ahead + 1, flanks * slices, flanks * slices, own, own))
    for number, block in enumerate(blocks):
        of_layers = block.reshape(flanks, heights, own, flanks, heights, own)
        # Slice by slice, which stays in the processor's cache; a slice reaches over few layers.
        for flank, place in np.ndindex(flanks, slices):
            over, at = np.flatnonzero(weights[place]), flank * slices + place
            averaged = np.tensordot(weights[place, over], of_layers[flank, over], 1)
            for other in range(flanks):
                others = slice(other * slices, (other + 1) * slices)
                seen = np.matmul(weights, averaged[:, other]).transpose(1, 0, 2)
                # What is read together at a position, two sections, lies together.
                found[ahead + number, at, others] = seen
                if number:
                    found[ahead - number, others, at] = seen.transpose(0, 2, 1)
    return found
