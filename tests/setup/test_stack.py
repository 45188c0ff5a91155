"""What set-up installs is loaded by one process."""

import os
import subprocess
import sys

import pytest

# DOLFINx by the program's adapter first, VTK after it: the order that aborts where nobody takes care of it.
GRID_FILE = """
from fenics_gears.system import environment
environment.prepare()
from fenics_gears.elasticity import dolfinx_adapter
import sys, numpy, pyvista
grid = pyvista.UnstructuredGrid(numpy.array([3, 0, 1, 2]), numpy.array([5], dtype=numpy.uint8), numpy.eye(3))
grid.point_data["stress"] = numpy.arange(3.0)
grid.save(sys.argv[1])
read = pyvista.read(sys.argv[1])
assert read.n_cells == 1 and (read.points == numpy.eye(3)).all() and (read["stress"] == numpy.arange(3.0)).all()
"""

RESULT_FILE = """
from fenics_gears.elasticity import dolfinx_adapter
import sys, numpy, xarray
written = xarray.Dataset({"force": ("time", numpy.arange(3.0), {"units": "N"})})
written.to_netcdf(sys.argv[1], engine="h5netcdf")
with xarray.open_dataset(sys.argv[1], engine="h5netcdf") as read:
    assert read.identical(written), read
"""

TWO_RANKS = """
from fenics_gears.system import environment
environment.prepare()
import os
from mpi4py import MPI
from petsc4py import PETSc
threads = MPI.COMM_WORLD.gather(os.environ["OMP_NUM_THREADS"])
if MPI.COMM_WORLD.rank == 0:
    print(*threads)
"""


def run(code, *arguments, launcher=()):
    # As Python knows the environment: once MPI is initialised in this process, its C library has added variables to the
    # real one that make mpirun give up.
    environment = {name: value for name, value in os.environ.items() if name != "OMP_NUM_THREADS"}
    done = subprocess.run(
        [*launcher, sys.executable, "-c", code, *arguments],
        capture_output=True, text=True, timeout=120, env=environment,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_files_for_paraview_and_results_are_written_beside_dolfinx(tmp_path):
    """VTK, DOLFINx and h5py, each with its HDF5: read back exactly."""
    run(
        GRID_FILE.replace("sys.argv[1]", "sys.argv[2]") + RESULT_FILE,
        str(tmp_path / "run.nc"),
        str(tmp_path / "grid.vtu"),
    )


@pytest.mark.ranks
def test_two_ranks_meet_with_one_thread_each():
    """mpirun works as any user, and each rank finds the other."""
    from fenics_gears.system import environment

    environment.prepare()
    assert run(TWO_RANKS, launcher=("mpirun", "--oversubscribe", "-n", "2")).split() == ["1", "1"]
