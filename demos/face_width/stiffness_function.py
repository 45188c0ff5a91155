"""Mesh stiffness of helical gears over the mesh cycle by published formulas, from the two contact ratios alone."""

from __future__ import annotations

import numpy as np

TERMS = 200


def contact_lines(phase: np.ndarray, contact_ratio: float, overlap_ratio: float) -> np.ndarray:
    """Length of the lines of contact over its mean, at mesh phases (k,).

    P. Velex, M. Maatar, A mathematical model for analyzing the influence of shape deviations and mounting errors on
    gear dynamic behaviour, Journal of Sound and Vibration 191, 1996.
    """
    return _series(phase, contact_ratio, overlap_ratio, lambda order: np.sinc(order))


def mesh_stiffness(phase: np.ndarray, contact_ratio: float, overlap_ratio: float) -> np.ndarray:
    """Mesh stiffness over its mean, at mesh phases (k,): a line of contact is softer towards root and tip of the teeth.

    X. Gu, P. Velex, P. Sainsot, J. Bruyère, Analytical investigations on the mesh stiffness function of solid spur and
    helical gears, Journal of Mechanical Design 137, 2015, 063301, eq. (10).
    """
    return _series(
        phase,
        contact_ratio,
        overlap_ratio,
        lambda order: (0.7 + 0.09 / order**2) * np.sinc(order) - 0.09 * np.cos(np.pi * order) / order**2,
    )


def _series(phase: np.ndarray, contact_ratio: float, overlap_ratio: float, along_path) -> np.ndarray:
    order = np.arange(1, TERMS + 1)[:, None]
    factors = along_path(order * contact_ratio) * np.sinc(order * overlap_ratio)
    return 1.0 + 2.0 * (factors * np.cos(np.pi * order * (2.0 * phase - contact_ratio - overlap_ratio))).sum(axis=0)
