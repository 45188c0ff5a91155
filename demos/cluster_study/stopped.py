"""A study under mpirun, left to its end or stopped on the way as Ctrl-C or the end of a job's time would."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

LOOK_EVERY = 0.05  # s


def run(study: Path, directory: Path, processes: int, stop_after: int | None = None) -> int:
    """Run what is missing of a study with so many processes; its exit code, not 0 where it was stopped.

    stop_after: end it once so many of its cases lie in the directory.
    """
    command = [
        sys.executable,
        "-m",
        "fenics_gears",
        "study",
        str(study),
        "--output",
        str(directory),
        "--processes",
        str(processes),
    ]
    # A session of its own: the signal shall reach mpirun and its processes, and not this one. The environment as Python
    # knows it: where this process has loaded MPI, its C library has put more into it, which an mpirun would trip over.
    running = subprocess.Popen(command, start_new_session=True, env=os.environ.copy())
    try:
        while running.poll() is None:
            if stop_after is not None and done(directory) >= stop_after:
                os.killpg(running.pid, signal.SIGINT)
                return running.wait() or 1
            time.sleep(LOOK_EVERY)
    except KeyboardInterrupt:
        os.killpg(running.pid, signal.SIGINT)
        running.wait()
        raise
    return running.returncode


def done(directory: Path) -> int:
    """How many cases lie in a study's directory."""
    return len(list((directory / "cases").glob("*.nc")))
