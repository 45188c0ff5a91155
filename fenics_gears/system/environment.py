"""What MPI, BLAS and VTK read from the process environment, set before they are loaded; a display for VTK to draw on.

A variable the user has set is never changed.
"""

import os
import shutil
import subprocess
import sys

from fenics_gears.errors import ComputationError

RANK_COUNTS = ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS")
"""Where Open MPI, MPICH and Slurm say how many processes run together."""


def prepare(environment=os.environ):
    """Give MPI, BLAS and VTK the settings this program needs; call it before NumPy, mpi4py or VTK is imported.

    environment: the mapping to complete, the process's own unless a test passes another.
    """
    for name, value in defaults(environment).items():
        environment.setdefault(name, value)


def defaults(environment):
    """Variables and their values where the user has not set them; `environment` shows how the process was started."""
    values = {"PYVISTA_OFF_SCREEN": "true"}
    if sys.platform == "linux":
        # VTK would try an X server first and print a warning where there is none; before 9.4 it ignores the variable.
        values["VTK_DEFAULT_OPENGL_WINDOW"] = "vtkEGLRenderWindow"
    if os.geteuid() == 0:
        # Containers run as root, where the mpirun started by this process (Open MPI 4, then 5) refuses to work without.
        for prefix in ("OMPI", "PRTE"):
            values[f"{prefix}_ALLOW_RUN_AS_ROOT"] = "1"
            values[f"{prefix}_ALLOW_RUN_AS_ROOT_CONFIRM"] = "1"
    ranks = started_ranks(environment)
    if ranks == max(1, _count(environment, "OMPI_COMM_WORLD_LOCAL_SIZE")):
        # On one machine ranks meet in shared memory; TCP only warns about interfaces it cannot pair.
        values["OMPI_MCA_btl"] = "^tcp,ofi"
    if ranks > 1 and "OMP_NUM_THREADS" not in environment:
        # OpenBLAS and MKL follow OMP_NUM_THREADS unless each is set by itself.
        values["OMP_NUM_THREADS"] = "1"
    return values


def started_ranks(environment=os.environ):
    """How many processes were started together; 1 for a process that was started alone."""
    return max(_count(environment, name) for name in RANK_COUNTS)


def _count(environment, name):
    value = environment.get(name, "")
    return int(value) if value.isdigit() else 1


def provide_display():
    """Make sure VTK can draw off screen, starting an X server without a screen where this VTK draws by X only.

    The server ends with the process, however that ends. Call it before the first picture, from the main thread.
    Raises ComputationError where there is nothing to draw on.
    """
    from vtkmodules import vtkRenderingOpenGL2

    if sys.platform != "linux" or hasattr(vtkRenderingOpenGL2, "vtkEGLRenderWindow"):
        return
    if _display_server is not None and _display_server.poll() is None:
        return
    if shutil.which("Xvfb"):
        os.environ["DISPLAY"] = _start_display_server()
    elif not os.environ.get("DISPLAY"):
        raise ComputationError("Pictures: this VTK draws by X only, and there is neither Xvfb nor a display; install Xvfb (Debian: xvfb).")


_display_server = None


def _start_display_server():
    """Start Xvfb on a free display and return the display's name, ":3"; VTK would abort on a display that is not there."""
    global _display_server
    read_end, write_end = os.pipe()
    command = ["Xvfb", "-displayfd", str(write_end), "-screen", "0", "1280x1024x24", "-nolisten", "tcp"]
    if shutil.which("setpriv"):
        command = ["setpriv", "--pdeathsig", "TERM", *command]
    _display_server = subprocess.Popen(
        command, pass_fds=(write_end,), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    os.close(write_end)
    with open(read_end) as announced:
        number = announced.readline().strip()
    if not number:
        raise ComputationError(f"Pictures: Xvfb stopped with exit code {_display_server.wait()} before it offered a display.")
    return f":{number}"
