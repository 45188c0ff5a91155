"""A swept section condensed onto lines along the face, by joining runs of layers.

Layers of one kind are alike but for a rotation, which their dofs share (`swept_stiffness`). Runs of the same kinds
therefore have one stiffness, made once: of two shorter runs, with what is inside of their common height eliminated. All
of it is dense; of N equal layers some 2 log2(N) runs are made.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.linalg.blas import dsyrk, dtrsm

from ..condensation import dofs_of
from ..ring import definite_factor
from .layers import Sweep
from .swept_stiffness import SectionForms, layer_of_kind


@dataclass(frozen=True)
class _Run:
    """Layers with nothing left inside of them but lines.

    stiffness: (n, n), in Fortran's order, its upper triangle, over dofs of the section: at the lowest height off the
    lines `low`, on the lines height by height `lines`, at the highest height off the lines `high`.
    """

    stiffness: np.ndarray
    low: np.ndarray
    lines: tuple[np.ndarray, ...]
    high: np.ndarray


def condensed_onto_lines(
    section: SectionForms, sweep: Sweep, lines: np.ndarray, held: np.ndarray, axes: np.ndarray
) -> np.ndarray:
    """Stiffness (d, d), in Fortran's order, its upper triangle, of a swept section on lines (k,), nodes of the section.

    Dofs go by height, line, then axis, where there is material. held: (j,), nodes that do not move. axes: (n, 3, 3),
    columns, of each of the section's nodes in its frame.
    """
    kinds, known = sweep.kinds, {}
    nodes = np.arange(3 * len(axes) + 1)
    turn = sparse.bsr_matrix((np.tile(axes, (3, 1, 1)), nodes[:-1], nodes)).tocsr()
    layers = {}
    for kind in set(kinds):
        blocks = layer_of_kind(section, sweep.twist, kind, nodes[:-1])
        whole = sparse.bmat([[blocks[row, column] for column in range(3)] for row in range(3)], format="csr")
        layers[kind] = (turn.T @ whole @ turn).tocsr()

    def run(first: int, last: int) -> _Run:
        ends, middle = (first == 0, last == len(kinds)), (first + last) // 2
        key = ends, *kinds[first:last]
        if key not in known:
            if last - first == 1:
                known[key] = _layer(layers[kinds[first]], section.in_layer(kinds[first][1]), ends, lines, held)
            else:
                parts = run(first, middle), run(middle, last)
                if all(ends):
                    # Beside the last run they would be the peak of memory.
                    known.clear()
                known[key] = _joined(*parts)
        return known[key]

    return run(0, len(kinds)).stiffness


def eliminated(free: np.ndarray, coupling: np.ndarray, kept: np.ndarray) -> np.ndarray:
    """Schur complement (k, k), its upper triangle, in the place of that of `kept`: of stiffness (m, m) of `free` dofs
    and their `coupling` (m, k), all in Fortran's order and overwritten. Raises as `ring.definite_factor`."""
    if not len(free):
        # Every node of a coarse section may be on the lines; LAPACK takes no empty matrix.
        return kept
    half = dtrsm(1.0, definite_factor(free, "a layer", overwrite=True), coupling, trans_a=1, overwrite_b=1)
    return dsyrk(-1.0, half, 1.0, kept, trans=1, overwrite_c=1)


def _layer(
    stiffness: sparse.csr_matrix, there: np.ndarray, ends: tuple[bool, bool], lines: np.ndarray, held: np.ndarray
) -> _Run:
    """A layer of a stiffness (9 n, 9 n) with nodes `there` (n,); at `ends` of the body what is off the lines is
    eliminated."""
    line = dofs_of(lines[there[lines]], 3)
    there[held] = there[lines] = False
    inside, size = dofs_of(np.flatnonzero(there), 3), 3 * len(there)
    low, high = (inside[:0] if end else inside for end in ends)
    free = np.concatenate([size + inside, *(number * size + inside for number, end in zip((0, 2), ends) if end)])
    kept = np.concatenate([low, *(number * size + line for number in range(3)), 2 * size + high])
    dense = (
        stiffness[rows][:, columns].toarray(order="F") for rows, columns in ((free, free), (free, kept), (kept, kept))
    )
    return _Run(eliminated(*dense), low, (line, line, line), high)


def _joined(below: _Run, above: _Run) -> _Run:
    """Two runs, what is off the lines at their common height eliminated."""
    # A layer beside a web has a part of what one within it has.
    common, line = max(below.high, above.low, key=len), max(below.lines[-1], above.lines[0], key=len)
    below = _widened(below, [below.low, *below.lines[:-1], line, common])
    above = _widened(above, [common, line, *above.lines[1:], above.high])
    inside, own = len(common), len(below.stiffness) - len(common)
    first, total = own - len(line), own - len(line) + len(above.stiffness) - len(common)
    kept, coupling = np.empty((total, total), order="F"), np.zeros((inside, total), order="F")
    kept[:own, :own] = below.stiffness[:own, :own]
    kept[:first, own:] = 0.0
    kept[first:, own:] = above.stiffness[inside:, inside + len(line) :]
    both = slice(inside, inside + len(line))
    kept[first:own, first:own] += above.stiffness[both, both]
    coupling[:, :own] = below.stiffness[:own, own:].T
    coupling[:, first:] += above.stiffness[:inside, inside:]
    free = below.stiffness[own:, own:] + above.stiffness[:inside, :inside]
    return _Run(eliminated(free, coupling, kept), below.low, below.lines + above.lines[1:], above.high)


def _widened(run: _Run, parts: list[np.ndarray]) -> _Run:
    """A run with nothing where its parts (`low`, `lines`, `high`) have fewer dofs than these."""
    own = [run.low, *run.lines, run.high]
    if [len(part) for part in own] == [len(part) for part in parts]:
        return run
    there = np.concatenate([np.isin(part, of_run) for part, of_run in zip(parts, own)])
    stiffness = np.zeros((len(there), len(there)), order="F")
    stiffness[np.ix_(there, there)] = run.stiffness
    return _Run(stiffness, parts[0], tuple(parts[1:-1]), parts[-1])
