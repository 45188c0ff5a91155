"""``gears python ...``: the Python that the program runs in, with the program to be imported."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import NoReturn


def add(commands) -> None:
    """Add the command to the parser, for its help only: Python's options are not ours to parse."""
    commands.add_parser(
        "python",
        help=(
            "run a Python script that imports fenics_gears, or a module such as `-m jupyter lab`, in the program's own"
            " Python"
        ),
        add_help=False,
    )


def run_python(options: Sequence[str]) -> NoReturn:
    """Become Python with these arguments, in the folder of the call; ./gears has set the path to the checkout."""
    sys.stdout.flush()
    os.execv(sys.executable, [sys.executable, *options])
