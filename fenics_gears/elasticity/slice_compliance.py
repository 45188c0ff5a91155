"""Compliance of a gear's teeth between slices of the face, of what the layers of its body tell, and of what is added to
it. It is found where it is asked for: of two slices a few of all teeth touch at a time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby

import numpy as np
from scipy import sparse

from fenics_gears.system.memory import pages

# Adds to values (n, n, 3, 3) between the flank nodes of two sections, the responding one so many teeth ahead.
Addition = Callable[[np.ndarray, int, int, int], None]


class SliceCompliance:
    """Compliance between flank nodes in sections, each a flank in a slice. `values` (2 k - 1, F S, F S, n, n, 9), mm/N:
    of every tooth from k - 1 behind to k - 1 ahead, by components of either node; zero where it was not asked for.

    `blocks` (k, D, D): of teeth on the nodes of layers, dofs by flank, then height, node, x, y, z. `averages`: of each
    flank (S n, h n), of `slice_averages.oblique_averages`. `additions`: to what these give.
    """

    def __init__(
        self, blocks: np.ndarray, averages: Sequence[sparse.csr_matrix], slices: int, additions: Sequence[Addition] = ()
    ):
        flanks = len(averages)
        nodes = averages[0].shape[1]
        size = averages[0].shape[0] // slices
        self._blocks = blocks.reshape(len(blocks), flanks, nodes, 3, flanks, 3 * nodes)
        self._additions = additions
        self._slices = slices
        shape = (2 * len(blocks) - 1, flanks * slices, flanks * slices)
        self._there = np.zeros(shape, dtype=bool)
        self.values = pages(int(np.prod(shape)), 9 * size**2).reshape(*shape, size, size, 9)
        sections = (flank[size * number : size * (number + 1)] for flank in averages for number in range(slices))
        self._seen = [_columns_in_use(section) for section in sections]

    def find(self, ahead: np.ndarray, own: np.ndarray, other: np.ndarray) -> None:
        """Have values between sections `own` (i,) and `other` (i,), the teeth of the former `ahead` (i,) pitches."""
        number = len(self.values) // 2
        asked = np.stack([ahead, own, other], axis=1)[~self._there[number + ahead, own, other]]
        # The others are these with both sections exchanged.
        back = (asked[:, 0] < 0) | ((asked[:, 0] == 0) & (asked[:, 1] > asked[:, 2]))
        asked[back] = asked[back][:, [0, 2, 1]] * [-1, 1, 1]
        for (teeth, section), pairs in groupby(np.unique(asked, axis=0).tolist(), lambda pair: pair[:2]):
            self._put(teeth, section, [pair[2] for pair in pairs])

    def _put(self, ahead: int, section: int, others: list[int]) -> None:
        """Put values of one section under forces on others, and the other way round, into place."""
        number = len(self.values) // 2
        nodes, weights = self._seen[section]
        size = self.values.shape[3]
        for flank, of_flank in groupby(others, lambda other: other // self._slices):
            loaded = list(of_flank)
            # Of all heights those of few sections are loaded.
            first = min(self._seen[other][0].start for other in loaded)
            end = max(self._seen[other][0].stop for other in loaded)
            of_layers = self._blocks[ahead, section // self._slices, nodes, :, flank, 3 * first : 3 * end]
            displaced = (weights @ of_layers.reshape(weights.shape[1], -1)).reshape(3 * size, -1, 3)
            # By loaded node: what a section averages is a product of matrices.
            by_nodes = np.ascontiguousarray(displaced.transpose(1, 0, 2)).reshape(displaced.shape[1], -1)
            for other in loaded:
                under, averaged = self._seen[other]
                between = (
                    (averaged @ by_nodes[under.start - first : under.stop - first])
                    .reshape(size, size, 3, 3)
                    .transpose(1, 0, 2, 3)
                )
                for add in self._additions:
                    add(between, ahead, section, other)
                self.values[number + ahead, section, other] = between.reshape(size, size, 9)
                self.values[number - ahead, other, section] = between.transpose(1, 0, 3, 2).reshape(size, size, 9)
                self._there[number + ahead, section, other] = self._there[number - ahead, other, section] = True


def _columns_in_use(weights: sparse.csr_matrix) -> tuple[slice, np.ndarray]:
    """The columns between which a matrix has entries, and these."""
    used = slice(weights.indices.min(), weights.indices.max() + 1)
    return used, weights[:, used].toarray()


def along_normals(
    averages: sparse.csr_matrix, compliance: sparse.csr_matrix, normals: np.ndarray, first: int
) -> Addition:
    """Adds, to a tooth under its own load, a compliance (H n, H n) of one of its flanks along `normals` (n, 3),
    averaged (S n, H n) over slices. `first`: section of the flank."""
    nodes = len(normals)
    entries = (averages @ compliance @ averages.T).tobsr((nodes, nodes))
    rows = np.repeat(np.arange(len(entries.indptr) - 1), np.diff(entries.indptr))
    known = dict(zip(zip(rows.tolist(), entries.indices.tolist()), entries.data))
    directions = np.einsum("ai,bj->abij", normals, normals)

    def add(values: np.ndarray, ahead: int, section: int, other: int) -> None:
        own = known.get((section - first, other - first))
        if own is not None and ahead == 0:
            values += own[:, :, None, None] * directions

    return add
