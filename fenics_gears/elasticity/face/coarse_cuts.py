"""Cuts of a swept sector with fewer nodes deep below the root, where nothing varies along the face within a layer.

There a cut's motion is a parabola over two layers. The stiffness is that of the sector's motions which obey this: what
they miss enters a compliance squared. Measured on both gears of a pair (28 degrees, 23 and 67 teeth, 12 layers): 2e-5
of the largest compliance, 1e-4 of a sum over a flank; the wheel's sector and ring take two thirds of the time.
"""

from __future__ import annotations

from math import ceil
from typing import NamedTuple

import numpy as np
from scipy import sparse

from ..element_nodes import dofs_of
from .layers import Sweep, interpolation_along, layers_of_face

# How far below the root circle a cut has fewer nodes, in pitches along that circle. Half as far the error is three
# times as large.
DEEP = 2 / 3
# Pitches that two layers together may be thick: those measured are 1.1 to 1.75.
THICKEST = 1.8
# Of fewer layers all are kept: there is little to save.
FEWEST = 4
# Layers, an even number: with flanks and cuts held, nothing is felt further off than half of these.
ENOUGH = 12
# Pitches along the root circle over which all of it is felt: of thin layers there are more.
WIDE = 9.0


class CutNodes(NamedTuple):
    """Nodes of a cut at fewer heights: `places` (c, 3), X, Y, z, and `weights` (h k, c) of these in the displacements
    of the k nodes at all h heights, by height, in the section's turning frame."""

    places: np.ndarray
    weights: sparse.csr_matrix


def is_deep(radius: np.ndarray, teeth: int) -> np.ndarray:
    """Which nodes of a cut (k,) are deep, by their radii, negative with `teeth`; the largest is the root circle's."""
    return radius < radius.max() * (1.0 - DEEP * 2.0 * np.pi / teeth)


def boundaries_where_deep(sweep: Sweep, pitch: float) -> np.ndarray:
    """Boundaries of the layers that a cut's deep nodes see, the same from either end of the face; those of the body
    beside a web, whose layers differ, and where layers are few or two are thick for the `pitch` (mm) along the root
    circle."""
    layers = len(sweep.boundaries) - 1
    if sweep.web is not None or layers < FEWEST or 2.0 * sweep.thicknesses.max() > THICKEST * pitch:
        return sweep.boundaries
    half = np.arange(0, layers // 2 + 1, 2)
    middle = [layers // 2, layers // 2 + 1] if layers % 2 else []
    return sweep.boundaries[np.unique(np.concatenate([half, layers - half, middle]).astype(int))]


def narrow_sweep(sweep: Sweep, pitch: float) -> Sweep:
    """The fewest layers that hold all that a wide face's sector has between flanks and held cuts: its own, unless
    they are alike, even in number, more than ENOUGH and wider than some times the `pitch` (mm) along the root
    circle."""
    layers = len(sweep.boundaries) - 1
    thickness = sweep.thicknesses
    enough = max(ENOUGH, 2 * ceil(0.5 * WIDE * pitch / thickness[0]))
    if layers <= enough or layers % 2 or sweep.web is not None or np.ptp(thickness) > 0.0:
        return sweep
    return Sweep(layers_of_face(enough, enough * thickness[0]), sweep.twist)


def root_pitch(line: np.ndarray, teeth: int) -> float:
    """Pitch along the root circle of a gear whose cut has nodes `line` (k, 2) in a section."""
    return 2.0 * np.pi * float(np.copysign(np.linalg.norm(line, axis=1), teeth).max()) / teeth


def cut_nodes(line: np.ndarray, sweep: Sweep, teeth: int) -> CutNodes:
    """Of a body without web, whose cut has nodes `line` (k, 2) in a section."""
    radius = np.copysign(np.linalg.norm(line, axis=1), teeth)
    deep = is_deep(radius, teeth)
    nodes = sparse.eye(len(line), format="csc")
    heights = sweep.heights
    fewer = boundaries_where_deep(sweep, root_pitch(line, teeth))
    along = interpolation_along(fewer, heights)
    shallow = sparse.kron(sparse.eye(len(heights)), nodes[:, ~deep])
    weights = sparse.hstack([shallow, sparse.kron(along, nodes[:, deep])], format="csr")
    places = [_swept(line[~deep], heights), _swept(line[deep], Sweep(fewer).heights)]
    return CutNodes(np.vstack(places), weights)


def _swept(line: np.ndarray, heights: np.ndarray) -> np.ndarray:
    return np.column_stack([np.tile(line, (len(heights), 1)), np.repeat(heights, len(line))])


def on_cut_nodes(
    stiffness: sparse.csr_matrix, flanks: np.ndarray, cuts: list[np.ndarray], weights: sparse.csr_matrix
) -> tuple[sparse.csr_matrix, np.ndarray]:
    """The stiffness (3 n, 3 n) of nodes, with those of `cuts` (h k,) moving by the `weights` (h k, c), and the numbers
    there of the nodes of `flanks` and of the fewer ones of both cuts, which come last."""
    count = stiffness.shape[0] // 3
    others = np.setdiff1d(np.arange(count), np.concatenate(cuts))
    fewer = weights.shape[1]
    new = len(others) + len(cuts) * fewer
    placed = weights.tocoo()
    rows = np.concatenate([others, *(cut[placed.row] for cut in cuts)])
    columns = [len(others) + number * fewer + placed.col for number in range(len(cuts))]
    columns = np.concatenate([np.arange(len(others)), *columns])
    values = np.concatenate([np.ones(len(others)), *[placed.data] * len(cuts)])
    motions = sparse.kron(sparse.csr_matrix((values, (rows, columns)), shape=(count, new)), sparse.eye(3), format="csr")
    kept = np.concatenate([np.searchsorted(others, flanks), np.arange(len(others), new)])
    return (motions.T @ stiffness @ motions).tocsr(), dofs_of(kept, 3)
