"""Contact nodes that elasticity cannot tell apart: the rank of a contact compliance, and what is made of one that lacks it.

Nodes that coincide, or more of them on an element than it has degrees of freedom, give way together: how a force is shared
between them has no answer in elasticity. They then get a layer of their own, so thin that nothing else feels it, and share alike.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import dpstrf

# Pivots and the layer's compliance in parts of the largest self-compliance of a node.
SMALLEST_PIVOT = 1e-10
LAYER = 1e-10


def dependent_rows(compliance: np.ndarray) -> int:
    """Rows of a positive semi-definite matrix (m, m) that follow from the others; by Cholesky with pivots."""
    if not len(compliance):
        return 0
    tolerance = SMALLEST_PIVOT * compliance.diagonal().max()
    return len(compliance) - int(dpstrf(compliance, tol=tolerance, lower=1)[2])


def of_full_rank(compliance: np.ndarray) -> tuple[np.ndarray, int]:
    """The compliance (m, m), mm/N, itself where it has full rank, else with a thin layer at every node; and its dependent rows."""
    dependent = dependent_rows(compliance)
    if not dependent:
        return compliance, 0
    return compliance + LAYER * compliance.diagonal().max() * np.eye(len(compliance)), dependent
