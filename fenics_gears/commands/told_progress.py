"""How a command tells its progress: not at all, by lines, or by bars on a terminal."""

from __future__ import annotations

import sys

from fenics_gears.system.console import on_terminal
from fenics_gears.system.progress import BarProgress, LineProgress, Progress, SilentProgress


def told_progress(quiet: bool) -> Progress:
    """Bars on a terminal, lines elsewhere, nothing if `quiet`; all of it on the standard error."""
    if quiet:
        return SilentProgress()
    if not on_terminal(sys.stderr):
        return LineProgress()
    from rich.console import Console

    return BarProgress(Console(stderr=True))
