"""``gears python ...``: run a Python script that imports fenics_gears, or a module such as `-m jupyter lab`, in the
program's own Python."""

import os
import sys
from collections.abc import Sequence
from typing import NoReturn


def carry_out(options: Sequence[str]) -> NoReturn:
    """Become Python with these arguments, in the folder of the call; ./gears has set the path to the checkout."""
    sys.stdout.flush()
    os.execv(sys.executable, [sys.executable, *options])
