"""Errors from two runs whose sizes fall, for `[accuracy] target`.

Roache, Verification and Validation in Computational Science and Engineering, 1998, chapter 5: the error of the finer
run is the change over r^p - 1, with r the ratio of sizes and p the order, times a safety factor. Of two runs the order
is the one expected, and the factor 2: at coarse sizes differences fall more slowly, and scatter
(docs/evidence/accuracy.md).
"""

from collections.abc import Sequence

import numpy as np

from .measures import MEAN, Answer, distance

EXPECTED_ORDER = 2.0
SAFETY_OF_TWO = 2.0


class NotComparable(ValueError):
    """A measure, by its name, that two runs do not both have."""


def part_left(sizes: Sequence[float], order: float) -> float:
    """Error of the finest size in parts of the last change: 1/(r^p - 1)."""
    return 1.0 / ((sizes[-2] / sizes[-1]) ** order - 1.0)


def errors_of_two(finer: Answer, coarser: Answer, ratio: float) -> np.ndarray:
    """Relative error of the finer of two runs in each measure but the mean, by the expected order; `ratio` of their
    sizes. Raises NotComparable for a measure that one of them lacks, or of which nothing is left in the finer one."""
    measures = sorted({*finer, *coarser} - {MEAN})
    changes = np.array([distance(coarser, finer, measure) for measure in measures])
    if not np.isfinite(changes).all():
        raise NotComparable(measures[int(np.argmin(np.isfinite(changes)))])
    return SAFETY_OF_TWO * part_left((ratio, 1.0), EXPECTED_ORDER) * changes
