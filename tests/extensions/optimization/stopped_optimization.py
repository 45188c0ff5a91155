"""`gears optimize` that kills itself in the middle of the line of its last run: python -m
tests.extensions.optimization.stopped_optimization RUNS ARGUMENTS OF THE COMMAND."""

import os
import signal
import sys

if "OMPI_COMM_WORLD_RANK" not in os.environ:
    sys.modules["mpi4py"] = None

from fenics_gears.commands import cli
from fenics_gears.runs import lines

done, append = 0, lines.append


def killed_in_time(directory, line):
    """As the program does; the last line is cut short."""
    global done
    done += 1
    append(directory, line)
    if done == int(sys.argv[1]):
        file = directory / "0.jsonl"
        os.truncate(file, file.stat().st_size - 20)
        os.kill(os.getpid(), signal.SIGKILL)


if __name__ == "__main__":
    lines.append = killed_in_time
    sys.exit(cli.main(sys.argv[2:]))
