"""Half a swept sector in two parts: its tooth, with the flank, and its body, with the cut.

They meet in the tooth's neck, in fewer nodes than flank or cut have, and act on each other through it alone: of the
tooth come its flank's compliance with the neck held, the flank's motion per motion of the neck, and its stiffness on
the neck; of the body, with this stiffness added, the neck's compliance, its motion per motion of the cut, and the
stiffness of the cut (`mirrored_ring.flank_free`).

A part is the half on the drive flank's side, its centreline free, condensed onto lines along the face
(`runs_of_layers`). On the centreline an even or odd motion (`fold`) at a height gives that at the opposite one, which
leaves the half of its dofs.
"""

import numpy as np
from scipy.linalg.blas import dsyrk, dtrmm
from scipy.spatial import cKDTree

from ..condensation import dofs_of
from ..element_nodes import ElementNodes, element_nodes, numbers_at
from ..mesh_data import BodyMesh
from ..mirrored_ring import flank_free
from ..ring import definite_factor
from ..triangle import symmetric
from .fold import Fold
from .layers import Sweep
from .runs_of_layers import condensed_onto_lines, eliminated
from .swept_stiffness import ELEMENT, SectionForms

# In the largest coordinate.
ON_CENTRELINE = 1e-9
ROWS_AT_ONCE = 64


def condensed_halves(
    mesh: BodyMesh, poissons_ratio: float, sweep: Sweep, fold: Fold, signs: tuple[float, ...], pair=None
) -> list[tuple[np.ndarray, ...]]:
    """Of the EVEN or ODD motions of a sector what `condensed.in_shapes` takes: the flank's compliance with the cut
    held, the neck's motion by the cut, the cut's stiffness, the flank's motion by the neck.

    pair: communicator of two ranks, one of which condenses the tooth, the other the body.
    """
    nodes, (flank, cut) = element_nodes(mesh, ELEMENT), fold.lines
    half = nodes.middles @ fold.across > 0.0
    of_tooth = half & _tooth(nodes, half, fold, sweep)
    if not of_tooth.any():
        whole = _Part(mesh, half, poissons_ratio, sweep, fold, (flank, cut))
        whole.condense()
        return [flank_free(*whole.folded(sign)) for sign in signs]
    shared = nodes.points[np.intersect1d(nodes.cells[of_tooth], nodes.cells[half & ~of_tooth])]
    # Under a thin rim the neck reaches the hub, which holds what it has of it.
    neck = shared[cKDTree(fold.hub).query(shared)[0] > ON_CENTRELINE * np.abs(fold.nodes).max()]
    tooth = _Part(mesh, of_tooth, poissons_ratio, sweep, fold, (flank, neck))
    body = _Part(mesh, half & ~of_tooth, poissons_ratio, sweep, fold, (neck, cut))
    if pair is None:
        tooth.condense()
    else:
        (tooth, body)[pair.rank].condense()
        for rank, part in enumerate((tooth, body)):
            part.share(pair, rank)
    held = [flank_free(*tooth.folded(sign)) for sign in signs]
    del tooth
    if pair is None:
        body.condense()
    return [_with_body(*of_flank, *body.folded(sign)) for of_flank, sign in zip(held, signs)]


def _with_body(
    of_flank: np.ndarray, to_neck: np.ndarray, on_neck: np.ndarray, stiffness: np.ndarray, size: int
) -> tuple[np.ndarray, ...]:
    """As `condensed_halves`, of a tooth's parts and of the body's stiffness; `size`: dofs of the neck, its first."""
    stiffness[:size, :size] += on_neck
    of_neck, to_cut, of_cut = flank_free(stiffness, size)
    moved = dtrmm(1.0, definite_factor(of_neck.T, "a tooth's neck"), to_neck, side=1, trans_a=1)
    of_flank += symmetric(dsyrk(1.0, moved))
    return of_flank, -to_cut, of_cut, to_neck


def _tooth(nodes: ElementNodes, half: np.ndarray, fold: Fold, sweep: Sweep) -> np.ndarray:
    """Which cells (m,) are above the neck: the place with the fewest nodes between flank and cut, off a web; none where
    cells are too large for one."""
    flank, cut = (np.isin(np.arange(len(nodes.points)), numbers_at(nodes.points, line)) for line in fold.lines)
    on_centreline = np.abs(nodes.points @ fold.across) < ON_CENTRELINE * np.abs(nodes.points).max()
    below = cut.copy()
    if sweep.web is not None:
        below |= np.linalg.norm(nodes.points, axis=1) < sweep.web.rim_radius * (1.0 + ON_CENTRELINE)
    height, may = nodes.middles @ fold.axes[:2, 0], half & ~below[nodes.cells].any(axis=1)
    fewest, found = np.inf, np.zeros(len(half), dtype=bool)
    for level in np.unique(height[may]):
        above = may & (height >= level)
        in_tooth, in_body = (
            np.bincount(nodes.cells[part].ravel(), minlength=len(cut)) > 0 for part in (above, half & ~above)
        )
        shared = in_tooth & in_body
        # Nodes on the centreline count half: half of their motions are even.
        count = shared.sum() - 0.5 * (shared & on_centreline).sum()
        if not (flank & in_body).any() and count < fewest:
            fewest, found = count, above
    return found


class _Part:
    """Cells of half a sector, condensed onto lines along the face: two `groups` of places (k, 2) of the section, and
    the nodes on the centreline, whose dofs are along it, across it and along z."""

    def __init__(
        self,
        mesh: BodyMesh,
        cells: np.ndarray,
        poissons_ratio: float,
        sweep: Sweep,
        fold: Fold,
        groups: tuple[np.ndarray, np.ndarray],
    ):
        used = np.unique(mesh.cells[cells])
        part = BodyMesh(mesh.points[used], np.searchsorted(used, mesh.cells[cells]), {})
        self._section, self._sweep = SectionForms(part, poissons_ratio, sweep.web), sweep
        places, near = self._section.nodes.points, ON_CENTRELINE * np.abs(fold.nodes).max()
        first, second = (numbers_at(places, group) for group in groups)
        self._held = np.flatnonzero(cKDTree(fold.hub).query(places)[0] < near)
        middle = np.flatnonzero(np.abs(places @ fold.across) < near)
        inner = np.setdiff1d(middle, np.concatenate([first, second, self._held]))
        self._lines = lines = np.concatenate([first, second, inner])
        self._middle, self._there = np.isin(lines, middle), self._section.material(sweep)[:, lines]
        self._groups = np.split(np.arange(len(lines)), np.cumsum([len(first), len(second)]))
        self._axes = np.where(np.isin(np.arange(len(places)), middle)[:, None, None], fold.axes, np.eye(3))

    def condense(self) -> None:
        """Make the stiffness on the lines."""
        stiffness = condensed_onto_lines(self._section, self._sweep, self._lines, self._held, self._axes)
        # Transposed, its rows follow one another.
        self._stiffness = symmetric(stiffness).T

    def share(self, pair, rank: int) -> None:
        """Give the stiffness that a rank has made to the other."""
        if pair.rank != rank:
            self._stiffness = np.empty((3 * int(self._there.sum()),) * 2)
        pair.Bcast(self._stiffness, root=rank)

    def folded(self, sign: float) -> tuple[np.ndarray, int]:
        """Stiffness of the EVEN or ODD motions on both groups, each by height, then place; and dofs of the first
        one."""
        first, second, inner = (self._dofs(group, sign) for group in self._groups)
        dofs, free = [np.concatenate(each) for each in zip(inner, first, second)], len(inner[0])
        kept = len(dofs[0]) - free
        parts = np.empty((free, free)), np.empty((kept, free)), np.empty((kept, kept))
        # Few rows at a time: whole matrices would be made anew for each step.
        for of_kept, (start, end) in enumerate(((0, free), (free, free + kept))):
            for row in range(start, end, ROWS_AT_ONCE):
                rows = [each[row : min(row + ROWS_AT_ONCE, end)] for each in dofs]
                moved = _folded_rows(_folded_rows(self._stiffness, *rows).T, *dofs).T
                here = slice(row - start, row - start + len(moved))
                parts[of_kept][here] = moved[:, :free]
                if of_kept:
                    parts[2][here] = moved[:, free:]
        # Transposed, they are in LAPACK's order.
        return symmetric(eliminated(*(part.T for part in parts))).T, len(first[0])

    def _dofs(self, lines: np.ndarray, sign: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Dofs (k,) of some lines that stand for all, those at the opposite height that move with them (k,), -1 where
        none does, and by which factor (k,), then that of their own motion."""
        heights, number = len(self._there), np.cumsum(self._there).reshape(self._there.shape) - 1
        height, line = np.nonzero(self._there[:, lines])
        line = lines[line]
        above = np.where(self._middle[line], height - heights // 2, heights)
        kept = above >= 0
        height, line, above = height[kept], line[kept], np.repeat(above[kept], 3)
        own, opposite = (dofs_of(number[each, line], 3) for each in (height, heights - 1 - height))
        # Half a turn keeps what is along the centreline.
        factor = np.tile(sign * np.array([1.0, -1.0, -1.0]), len(line))
        alive = (above > 0) | (factor > 0.0)
        # At mid-width a node is its own image, which doubles its energy.
        factor = np.where(above == 0, 2.0**0.5, np.where(above < heights, factor, 1.0))
        image = np.where((above > 0) & (above < heights), opposite, -1)
        return own[alive], image[alive], factor[alive]


def _folded_rows(matrix: np.ndarray, own: np.ndarray, image: np.ndarray, factor: np.ndarray) -> np.ndarray:
    """Rows (k, n) of a matrix that belong to dofs of `_Part._dofs`."""
    rows, paired, alone = matrix[own], np.flatnonzero(image >= 0), np.flatnonzero((image < 0) & (factor != 1.0))
    rows[alone] *= factor[alone, None]
    rows[paired] += factor[paired, None] * matrix[image[paired]]
    return rows
