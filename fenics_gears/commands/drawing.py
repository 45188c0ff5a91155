"""The pictures of a run or a study, drawn for a command; matplotlib is loaded here and not before."""

from __future__ import annotations

from pathlib import Path


def draw(dataset, directory: Path) -> list[Path]:
    """Draw a run's pictures and return their files."""
    from fenics_gears.show.plots import draw_run

    return draw_run(dataset, directory)


def draw_study(file: Path) -> list[Path]:
    """Draw a study's results over its parameters beside its file and return the pictures' files."""
    from fenics_gears.show import plots

    return plots.draw_study(file)
