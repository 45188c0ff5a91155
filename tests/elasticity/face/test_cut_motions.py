"""Motions of the cuts of a swept sector."""

import numpy as np
import pytest

from fenics_gears.elasticity.face.cut_motions import _directions


def test_directions_come_also_where_divide_and_conquer_does_not_converge(monkeypatch):
    """The other method of LAPACK: the same sizes, directions that span the same motions."""
    motions = np.random.default_rng(1).normal(size=(30, 8)) @ np.diag(np.logspace(0, -6, 8))
    expected, sizes = _directions(motions)

    def failing(*arguments, **options):
        raise np.linalg.LinAlgError("SVD did not converge")

    monkeypatch.setattr(np.linalg, "svd", failing)
    found, same = _directions(motions)
    assert same == pytest.approx(sizes, rel=1e-9)
    assert np.abs(np.abs(np.sum(found * expected, axis=0)) - 1.0).max() < 1e-9
