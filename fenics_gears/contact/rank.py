"""Rank of a contact compliance, and a thin layer for contact nodes that elasticity cannot tell apart.

Nodes that coincide, or more nodes on an element than it has degrees of freedom, yield together: elasticity does not
determine how they share a force. Each node then gets a thin elastic layer of its own, and nodes that coincide share the
force evenly.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import dpstrf

# In parts of the largest self-compliance of a node. Newton does not converge with a layer below 1e-5; this one changes
# the transmission error of the paper's pair by 1e-5 of itself, a hundredth of the error that such a grid has anyway.
SMALLEST_PIVOT = 1e-10
LAYER = 1e-4


def dependent_rows(compliance: np.ndarray) -> int:
    """Rows of a positive semi-definite matrix (m, m) that follow from the others; by Cholesky with pivots."""
    if not len(compliance):
        return 0
    tolerance = SMALLEST_PIVOT * compliance.diagonal().max()
    # Turned over, in the order of Fortran: it is symmetric.
    return len(compliance) - int(dpstrf(compliance.T, tol=tolerance, lower=1)[2])


def of_full_rank(compliance: np.ndarray) -> tuple[np.ndarray, int]:
    """The compliance (m, m), mm/N, itself where it has full rank, else with a thin layer at every node; and its
    dependent rows."""
    dependent = dependent_rows(compliance)
    if not dependent:
        return compliance, 0
    return compliance + LAYER * compliance.diagonal().max() * np.eye(len(compliance)), dependent
