"""What the `run` scripts of the demonstrations share: their one argument, and what must be set before NumPy is
loaded."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from fenics_gears.system import environment


def output_directory(demo: str, description: str, arguments: list[str] | None = None) -> Path:
    """Where a demonstration shall write: the argument, `results/<demo>` unless given.

    arguments: those of the command line where None. Call it before NumPy is loaded: one thread for BLAS, which small
    matrices are quickest with.
    """
    environment.prepare()
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    parser = argparse.ArgumentParser(prog=f"demos/{demo}/run", description=description)
    parser.add_argument(
        "directory",
        nargs="?",
        type=Path,
        metavar="DIR",
        default=Path("results") / demo,
        help="where to write (default: %(default)s)",
    )
    return parser.parse_args(arguments).directory
