"""The stack works together: what set-up installs is loaded by one process in the order the program loads it."""

import os
import subprocess
import sys

import pytest

# DOLFINx by the program's adapter first, VTK after it: the order that aborts where nobody takes care of it.
PICTURE = """
from fenics_gears.system import environment
environment.prepare()
from fenics_gears.elasticity import dolfinx_adapter
environment.provide_display()
import pyvista
plotter = pyvista.Plotter(off_screen=True, window_size=(80, 60))
plotter.set_background("white")
plotter.add_mesh(pyvista.Sphere(), color="black", lighting=False)
pixels = plotter.screenshot(return_img=True)
plotter.close()
print(*pixels.shape, *pixels[0, 0], *pixels[30, 40])
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
    """Standard output of a fresh interpreter; what it wrote to standard error becomes the failure's text."""
    # As Python knows the environment: once MPI is initialised in this process, its C library has added variables to the
    # real one that make mpirun give up.
    environment = {name: value for name, value in os.environ.items() if name != "OMP_NUM_THREADS"}
    done = subprocess.run(
        [*launcher, sys.executable, "-c", code, *arguments],
        capture_output=True, text=True, timeout=120, env=environment,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_pictures_and_result_files_are_made_beside_dolfinx(tmp_path):
    """Exactly: a black sphere before white, the corner shows the background, the middle the sphere; a dataset read back is the one written,
    though DOLFINx and h5py each bring HDF5 into the process."""
    numbers = [int(number) for number in run(PICTURE + RESULT_FILE, str(tmp_path / "run.nc")).split()]
    assert numbers == [60, 80, 3, 255, 255, 255, 0, 0, 0]


@pytest.mark.ranks
def test_two_ranks_meet_with_one_thread_each():
    """mpirun works as any user, root included, and each rank finds the other."""
    from fenics_gears.system import environment

    environment.prepare()
    assert run(TWO_RANKS, launcher=("mpirun", "--oversubscribe", "-n", "2")).split() == ["1", "1"]
