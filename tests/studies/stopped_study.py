"""`gears study` that sends itself a signal when it has done so many cases: python -m tests.studies.stopped_study
SIGNAL CASES RANK ARGUMENTS OF THE COMMAND. Under mpirun the rank of that number does, the others wait for mpirun to
end them. Alone the process has no mpi4py."""

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
