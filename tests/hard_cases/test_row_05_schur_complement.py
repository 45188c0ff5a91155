"""Row 5: the Schur complement of a gear has the rigid motions for its kernel, and nothing else."""

import numpy as np
import pytest
from tests.coarse_sector import coarse_condensed_sector

from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.ring import centre_motion


def check_kernel(stiffness, rigid, what, measured):
    """Exact identities: `norm(S R) / norm(S)` with R orthonormal, symmetry, and the first eigenvalue that is not of
    a rigid motion."""
    basis = np.linalg.qr(rigid)[0]
    in_kernel = np.linalg.norm(stiffness @ basis) / np.linalg.norm(stiffness)
    asymmetry = np.abs(stiffness - stiffness.T).max() / np.abs(stiffness).max()
    # The centre's rotation is in rad, all else in mm: lengths make the eigenvalues comparable.
    eigenvalues = np.linalg.eigvalsh(0.5 * (stiffness + stiffness.T)) / np.linalg.norm(stiffness, 2)
    motions = rigid.shape[1]
    largest, next_one = np.abs(eigenvalues[:motions]).max(), eigenvalues[motions]
    last = "third and fourth" if motions == 3 else "sixth and seventh"
    measured(
        f"{what}: norm(S R)/norm(S), asymmetry, {last} eigenvalue",
        f"{in_kernel:.1g}, {asymmetry:.1g}, {largest:.1g}, {next_one:.1g}",
        "1e-10, 1e-12, 1e-10, above 1e-6",
        row=5,
    )
    assert in_kernel <= 1e-10
    assert asymmetry <= 1e-12
    assert largest <= 1e-10
    assert next_one > 1e-6


@pytest.mark.parametrize("poissons_ratio", [0.3, 0.499])
@pytest.mark.parametrize("name", ELEMENTS)
def test_kernel_of_a_sector(name, poissons_ratio, measured):
    """A sector condensed by PETSc onto flank, cuts and hub: it floats."""
    sector = coarse_condensed_sector(name, poissons_ratio)
    points = np.vstack(list(sector.points.values()))
    check_kernel(sector.stiffness, centre_motion(points), f"sector, {name}, nu {poissons_ratio:g}", measured)
