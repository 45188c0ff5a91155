"""Settings of the process that hold for one command, and are as before after it: a notebook or a test suite goes on in
the same process."""

from __future__ import annotations

import gc
import os
from collections.abc import Iterator
from contextlib import contextmanager

from fenics_gears.system.memory import MEMORY_VARIABLE


@contextmanager
def settings_of_a_command() -> Iterator[None]:
    """Look for garbage rarely; put back what this changes, what the command freezes and what it sets
    FENICS_GEARS_MEMORY to."""
    thresholds, frozen, memory = gc.get_threshold(), gc.get_freeze_count(), os.environ.get(MEMORY_VARIABLE)
    # Libraries make a million objects that stay; Python's usual search for garbage among them takes a tenth of a short
    # run.
    gc.set_threshold(200_000, 50, 100)
    try:
        yield
    finally:
        gc.set_threshold(*thresholds)
        if not frozen:
            gc.unfreeze()
        if memory is None:
            os.environ.pop(MEMORY_VARIABLE, None)
        else:
            os.environ[MEMORY_VARIABLE] = memory
