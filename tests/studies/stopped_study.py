"""`gears study` that a signal reaches in its middle: python -m tests.studies.stopped_study SIGNAL CASES RANK ARGUMENTS
OF THE COMMAND.

The process sends itself the signal when it has done so many cases, which is the same moment every time; one from
outside is not. Under mpirun only the rank of that number does, and every other one that has done as many waits for
mpirun to end it. Alone the process has no mpi4py, for a study alone must run where MPI is absent or broken.
"""

import os
import signal
import sys

if "OMPI_COMM_WORLD_RANK" not in os.environ:
    sys.modules["mpi4py"] = None

from fenics_gears.commands import cli
from fenics_gears.runs import runs

computed = runs.computed

done = 0


def stopped(store, run, tick=None):
    """As the program does, then the signal."""
    global done
    outcome = computed(store, run, tick)
    done += 1
    if done == int(sys.argv[2]):
        if os.environ.get("OMPI_COMM_WORLD_RANK", "0") != sys.argv[3]:
            signal.pause()
        os.kill(os.getpid(), signal.Signals[sys.argv[1]])
    return outcome


if __name__ == "__main__":
    runs.computed = stopped
    sys.exit(cli.main(sys.argv[4:]))
