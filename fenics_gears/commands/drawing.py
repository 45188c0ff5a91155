"""The pictures of a run, drawn for a command."""

from __future__ import annotations

from pathlib import Path


def draw(dataset, directory: Path) -> list[Path]:
    """Draw a run's pictures and return their files; matplotlib is loaded here and not before."""
    from fenics_gears.show.plots import draw_run

    return draw_run(dataset, directory)
