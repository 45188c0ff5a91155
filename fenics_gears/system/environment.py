"""What MPI, PETSc and BLAS read from the process environment, set before they are loaded.

What the user has set is never changed, unless it names a folder for temporary files or caches that cannot be written.
Numba and DOLFINx keep compiled code there, matplotlib its list of fonts. MPI ends the process where temporary files
have no room.
"""

import os
import re
import stat
import sys
import tempfile
from collections.abc import Callable, Mapping, MutableMapping
from pathlib import Path

from fenics_gears.errors import SceneError

from . import blas

RANK_COUNTS = ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS")
"""Where Open MPI, MPICH and Slurm say how many processes run together."""
LOCAL_COUNTS = ("OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS", "SLURM_STEP_TASKS_PER_NODE")
"""Where they say how many of these are on one machine."""
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")
"""Where a user says how many threads a process may have at work."""


def prepare(environment=os.environ):
    """Give MPI, PETSc and BLAS the settings this program needs; call it before NumPy or mpi4py is imported.

    Raises SceneError where compiled code can be kept nowhere.
    """
    for name, value in defaults(environment).items():
        environment.setdefault(name, value)
    have_folders(environment, aloud=started_ranks(environment) == 1)
    blas.choose(environment)


def defaults(environment):
    """Variables and their values where the user has not set them; `environment` shows how the process was started."""
    # PETSc would take a reader of the output that has gone for a crash, and abort.
    # OpenBLAS's threads look for work for so many cycles (a power of two) before they sleep. By default that is some 25
    # ms after every product, on one core as long as the march of a short run.
    values = {"PETSC_OPTIONS": "-no_signal_handler", "OPENBLAS_THREAD_TIMEOUT": "18"}
    if os.geteuid() == 0:
        # Containers run as root, where the mpirun started by this process (Open MPI 4, then 5) refuses to work without.
        for prefix in ("OMPI", "PRTE"):
            values[f"{prefix}_ALLOW_RUN_AS_ROOT"] = "1"
            values[f"{prefix}_ALLOW_RUN_AS_ROOT_CONFIRM"] = "1"
    ranks = started_ranks(environment)
    if ranks == local_ranks(environment):
        # On one machine ranks meet in shared memory; TCP only warns about interfaces it cannot pair, and to look for
        # networks of other kinds takes 0.2 s.
        values |= {"OMPI_MCA_btl": "^tcp,ofi", "OMPI_MCA_pml": "ob1"}
    if ranks > 1:
        # OpenBLAS and MKL follow it unless each is set by itself.
        values["OMP_NUM_THREADS"] = "1"
    return values


def started_ranks(environment=os.environ):
    """How many processes were started together, at least 1."""
    return _largest(environment, RANK_COUNTS)


def local_ranks(environment=os.environ):
    """How many of them are on this machine, or on the one that has most."""
    return _largest(environment, LOCAL_COUNTS)


def threads() -> int:
    """Threads that this process may have at work: as the user says, else as it has cores; one in an MPI job."""
    if any(name in os.environ for name in RANK_COUNTS):
        return 1
    given = [int(value) for name in THREADS if (value := os.environ.get(name, "")).isdecimal()]
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min([*given, cores])


def on_terminal_of_its_own():
    """Whether this process's terminal is nobody's: Open MPI and MPICH start each process on a pseudo-terminal."""
    return any(name in os.environ for name in RANK_COUNTS[:2])


def _largest(environment, names):
    # Slurm counts by machine, "4(x2),3": four on each of two, three on another.
    counts = re.findall(r"\d+", re.sub(r"\(x\d+\)", "", ",".join(environment.get(name, "") for name in names)))
    return max([1, *map(int, counts)])


Environment = MutableMapping[str, str]
# Where temporary files go unless TMPDIR says where, and how many bytes of room they need.
TEMPORARY = ("/tmp", "/var/tmp")
ROOM = 10e6
# Folders within the user's folder for caches.
CACHES = ("numba", "fenics", "matplotlib", "fenics_gears")


def have_folders(environment: Environment, aloud: bool) -> None:
    """Set TMPDIR, XDG_CACHE_HOME and MPLCONFIGDIR where their values cannot be used; `aloud`: say so on the standard
    error.

    Raises SceneError where compiled code can be kept nowhere.
    """
    say = (lambda sentence: print(f"gears: {sentence}", file=sys.stderr)) if aloud else (lambda sentence: None)
    _have_temporary_files(environment, say)
    if not _keeps_caches(environment):
        _cache_elsewhere(environment, say)


def _have_temporary_files(environment: Environment, say: Callable[[str], None]) -> None:
    wanted = environment.get("TMPDIR") or TEMPORARY[0]
    folder = next((each for each in (wanted, *TEMPORARY) if _has_room(each)), None)
    if folder != wanted:
        environment["TMPDIR"] = folder or wanted
        used = f"{folder} is used in its place" if folder else "nor is there room elsewhere"
        say(f"temporary files cannot be written into {wanted} ({used}); let TMPDIR name a folder with room.")


def _has_room(folder: str) -> bool:
    try:
        volume = os.statvfs(folder)
    except (OSError, ValueError):
        return False
    return _can_be_written(Path(folder)) and volume.f_bavail * volume.f_frsize >= ROOM


def cache_folder(environment: Mapping[str, str] = os.environ) -> Path:
    """The user's folder for caches, by the XDG specification."""
    home = environment.get("HOME") or os.path.expanduser("~")
    return Path(environment.get("XDG_CACHE_HOME") or Path(home, ".cache"))


def _keeps_caches(environment: Environment) -> bool:
    """Whether the user's folder for caches is there, or can be made, and all that lies in it can be written."""
    if not os.path.isabs(environment.get("HOME") or os.path.expanduser("~")):
        return False
    folder = cache_folder(environment)
    return all(_can_be_written(each) for each in (folder, *(folder / name for name in CACHES)))


def _can_be_written(folder: Path) -> bool:
    there = next((each for each in (folder, *folder.parents) if os.path.lexists(each)), folder)
    return there.is_dir() and os.access(there, os.W_OK | os.X_OK)


def _cache_elsewhere(environment: Environment, say: Callable[[str], None]) -> None:
    folder, is_new = _own_temporary_folder()
    environment["XDG_CACHE_HOME"] = environment["MPLCONFIGDIR"] = folder
    if not os.path.isabs(environment.get("HOME") or os.path.expanduser("~")):
        # A user whom the system does not know; DOLFINx asks for the folder even where it does not need it.
        environment["HOME"] = folder
    if is_new:
        remedy = "let XDG_CACHE_HOME name a folder that you can write."
        say(f"your folder for caches cannot be written, so compiled code is kept in {folder}; {remedy}")


def _own_temporary_folder() -> tuple[str, bool]:
    """A temporary folder that nobody else can write, since code in it is run, and whether it is new."""
    try:
        folder = os.path.join(tempfile.gettempdir(), f"fenics_gears-{os.getuid()}")
        try:
            os.mkdir(folder, 0o700)
            return folder, True
        except FileExistsError:
            state = os.lstat(folder)
        if stat.S_ISDIR(state.st_mode) and state.st_uid == os.getuid() and not state.st_mode & 0o077:
            return folder, False
        return tempfile.mkdtemp(prefix="fenics_gears-"), True
    except OSError as error:
        raise SceneError(
            "Compiled code can be kept neither in your folder for caches nor in one for temporary files "
            f"({error.strerror or error}). Let XDG_CACHE_HOME name a folder that you can write."
        ) from None
