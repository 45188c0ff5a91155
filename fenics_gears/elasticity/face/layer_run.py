"""A run of layers of a swept tooth, condensed onto its end sections and the flank between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..ring import definite_inverse, without_first

WHAT = "a tooth held at its root"


@dataclass(frozen=True, eq=False)
class LayerRun:
    """stiffness: (2 s + f, 2 s + f), N/mm: `section` s dofs of the lower end, as many of the upper one, and f of the
    flank between them by height. The last `flank` dofs of a section are kept at each height."""

    stiffness: np.ndarray
    section: int
    flank: int

    @classmethod
    def of_layer(cls, blocks: dict[tuple[int, int], np.ndarray], flank: int) -> LayerRun:
        """One layer, of blocks (s, s) between its lower, middle and upper section."""
        stiffness = np.block([[blocks[row, column] for column in range(3)] for row in range(3)])
        section = len(stiffness) // 3
        lower, middle, upper = np.split(np.arange(len(stiffness)), 3)
        kept = np.concatenate([lower, upper, middle[-flank:]])
        return cls(_condensed(stiffness, middle[:-flank], kept), section, flank)

    def joined(self, above: LayerRun) -> LayerRun:
        """This run and the one above it."""
        ends = 2 * self.section
        inner, inner_above = len(self.stiffness) - ends, len(above.stiffness) - ends
        sizes = (self.section, self.section, self.section, inner, inner_above)
        lower, middle, upper, own, other = np.split(np.arange(sum(sizes)), np.cumsum(sizes)[:-1])
        stiffness = np.zeros((sum(sizes),) * 2)
        for run, places in ((self, (lower, middle, own)), (above, (middle, upper, other))):
            stiffness[np.ix_(*[np.concatenate(places)] * 2)] += run.stiffness
        kept = np.concatenate([lower, upper, own, middle[-self.flank :], other])
        return LayerRun(_condensed(stiffness, middle[: -self.flank], kept), self.section, self.flank)

    def compliance(self) -> np.ndarray:
        """Of the flank at all heights, mm/N, both ends free."""
        lower, upper, inner = np.split(np.arange(len(self.stiffness)), [self.section, 2 * self.section])
        free = np.concatenate([lower[: -self.flank], upper[: -self.flank]])
        kept = np.concatenate([lower[-self.flank :], inner, upper[-self.flank :]])
        return definite_inverse(_condensed(self.stiffness, free, kept), WHAT)


def _condensed(stiffness: np.ndarray, free: np.ndarray, kept: np.ndarray) -> np.ndarray:
    """On the dofs that are kept, the others free."""
    order = np.concatenate([free, kept])
    return without_first(stiffness[np.ix_(order, order)], len(free), WHAT)
