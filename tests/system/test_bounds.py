"""Compiled code looks for no index beyond an array."""

import sys

import pytest
from tests.programs import CHECKOUT, ended

# Contact and march in the plane and over the face, with friction, coast flanks and rigid flanks.
PARTS = (
    "contact/test_coast_flanks_over_the_face.py", "contact/test_formed_rows.py", "contact/test_interpolation.py",
    "contact/test_newton.py", "contact/test_operator.py", "results/test_mesh_stiffness.py",
    "dynamics/test_compiled_march.py", "hard_cases/test_over_the_face_any_scene.py",
)  # fmt: skip


@pytest.mark.nightly
def test_no_index_is_beyond_its_array(tmp_path):
    """numba's look at each index; what a C function raises is printed only."""
    call = [sys.executable, "-m", "pytest", "-n", "0", "-q", "-s", "--tb=line", "-p", "no:cacheprovider"]
    done = ended(
        [*call, *(CHECKOUT / "tests" / part for part in PARTS)], timeout=1200, NUMBA_BOUNDSCHECK="1",
        NUMBA_CACHE_DIR=str(tmp_path),
    )  # fmt: skip
    said = (done.stdout + done.stderr).splitlines()
    failed = [line for line in said if line.startswith(("FAILED", "ERROR")) or "IndexError" in line]
    assert not failed and done.returncode == 0, "\n".join(failed or said[-20:])
