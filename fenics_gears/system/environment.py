"""What MPI, BLAS and the libraries that keep compiled code read from the process environment, set before they are loaded.

A variable the user has set is never changed, unless it names a folder for caches that cannot be written.
"""

import os
import re
import stat
import sys
from pathlib import Path

from fenics_gears.errors import SceneError

RANK_COUNTS = ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS")
"""Where Open MPI, MPICH and Slurm say how many processes run together."""
LOCAL_COUNTS = ("OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS", "SLURM_STEP_TASKS_PER_NODE")
"""Where they say how many of these are on one machine."""


def prepare(environment=os.environ):
    """Give MPI and BLAS the settings this program needs; call it before NumPy or mpi4py is imported.

    environment: the mapping to complete, the process's own unless a test passes another.

    Raises SceneError where compiled code can be kept nowhere.
    """
    for name, value in defaults(environment).items():
        environment.setdefault(name, value)
    if not _keeps_caches(environment):
        _cache_elsewhere(environment)


def defaults(environment):
    """Variables and their values where the user has not set them; `environment` shows how the process was started."""
    values = {}
    if os.geteuid() == 0:
        # Containers run as root, where the mpirun started by this process (Open MPI 4, then 5) refuses to work without.
        for prefix in ("OMPI", "PRTE"):
            values[f"{prefix}_ALLOW_RUN_AS_ROOT"] = "1"
            values[f"{prefix}_ALLOW_RUN_AS_ROOT_CONFIRM"] = "1"
    ranks = started_ranks(environment)
    if ranks == local_ranks(environment):
        # On one machine ranks meet in shared memory; TCP only warns about interfaces it cannot pair.
        values["OMPI_MCA_btl"] = "^tcp,ofi"
    if ranks > 1 and "OMP_NUM_THREADS" not in environment:
        # OpenBLAS and MKL follow OMP_NUM_THREADS unless each is set by itself.
        values["OMP_NUM_THREADS"] = "1"
    return values


# Folders within the user's folder for caches: numba's compiled loops, DOLFINx's compiled forms, matplotlib's list of fonts, condensed gears.
CACHES = ("numba", "fenics", "matplotlib", "fenics_gears")


def _keeps_caches(environment):
    """Whether the user's folder for caches is there, or can be made, and all that lies in it can be written."""
    home = environment.get("HOME") or os.path.expanduser("~")
    if not os.path.isabs(home):
        return False
    folder = Path(environment.get("XDG_CACHE_HOME") or Path(home, ".cache"))
    return all(_can_be_written(each) for each in (folder, *(folder / name for name in CACHES)))


def _can_be_written(folder):
    there = next((each for each in (folder, *folder.parents) if os.path.lexists(each)), folder)
    return there.is_dir() and os.access(there, os.W_OK | os.X_OK)


def _cache_elsewhere(environment):
    """Have compiled code kept in the folder for temporary files, and say so once: as long as that folder stays, nothing is compiled again."""
    folder, is_new = _own_temporary_folder()
    environment["XDG_CACHE_HOME"] = environment["MPLCONFIGDIR"] = folder
    if not os.path.isabs(environment.get("HOME") or os.path.expanduser("~")):
        # A user whom the system does not know; DOLFINx asks for the folder even where it does not need it.
        environment["HOME"] = folder
    if is_new:
        _copy_compiled(Path(folder, "numba"))
    if is_new and started_ranks(environment) == 1:
        print(
            f"gears: your folder for caches cannot be written, so compiled code is kept in {folder}; "
            "to keep it for longer, let XDG_CACHE_HOME name a folder that you can write.", file=sys.stderr,
        )  # fmt: skip


def _copy_compiled(folder):
    """Give numba what lies compiled beside the sources, where this user cannot write: it looks there only for what it could also write."""
    import hashlib
    import shutil

    for sources in {file.parent.parent for file in Path(__file__).parents[1].rglob("__pycache__/*.nbi")}:
        # As numba names its folders. Where another version does not, it compiles.
        place = folder / f"{sources.name}_{hashlib.sha1(str(sources).encode()).hexdigest()}"
        place.mkdir(parents=True)
        for file in (sources / "__pycache__").glob("*.nb[ci]"):
            shutil.copy(file, place)


def _own_temporary_folder():
    """A folder for temporary files that nobody else can write, and whether it is new; compiled code in it is run. Raises SceneError where there can be none."""
    import tempfile

    try:
        folder = os.path.join(tempfile.gettempdir(), f"fenics_gears-{os.getuid()}")
        try:
            os.mkdir(folder, 0o700)
            return folder, True
        except FileExistsError:
            found = os.lstat(folder)
        if stat.S_ISDIR(found.st_mode) and found.st_uid == os.getuid() and not found.st_mode & 0o077:
            return folder, False
        return tempfile.mkdtemp(prefix="fenics_gears-"), True
    except OSError as error:
        raise SceneError(
            f"Compiled code can be kept neither in your folder for caches nor in one for temporary files ({error.strerror or error}). "
            "Let XDG_CACHE_HOME name a folder that you can write."
        ) from None


def started_ranks(environment=os.environ):
    """How many processes were started together; 1 for a process that was started alone."""
    return _largest(environment, RANK_COUNTS)


def local_ranks(environment=os.environ):
    """How many of them are on this machine, or on the one that has most; 1 for a process that was started alone."""
    return _largest(environment, LOCAL_COUNTS)


def on_terminal_of_its_own(environment=os.environ):
    """Whether this process's terminal is nobody's: Open MPI and MPICH start each process on a pseudo-terminal, whatever mpirun itself writes to."""
    return any(name in environment for name in RANK_COUNTS[:2])


def _largest(environment, names):
    # Slurm counts by machine, "4(x2),3": four on each of two, three on another.
    counts = re.findall(r"\d+", re.sub(r"\(x\d+\)", "", ",".join(environment.get(name, "") for name in names)))
    return max([1, *map(int, counts)])
