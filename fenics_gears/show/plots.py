"""The pictures of a run: drawn from its dataset and saved under names that do not change."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from fenics_gears.errors import ComputationError
from fenics_gears.output import written_aside
from fenics_gears.show import PICTURE_FILES
from fenics_gears.show.curves import load_sharing, mesh_forces, transmission_error
from fenics_gears.show.panels import DOTS_PER_INCH, styled
from fenics_gears.show.pressure_map import contact_pressure
from fenics_gears.show.spectrum import order_spectrum

PICTURES: dict[str, Callable[[xr.Dataset], Figure | None]] = dict(
    zip(PICTURE_FILES, (transmission_error, mesh_forces, load_sharing, contact_pressure, order_spectrum))
)


def draw_run(dataset: xr.Dataset, directory: str | Path) -> list[Path]:
    """Draw every picture that the result has something for, as PNG, and return the files.

    They appear in ``directory`` together, when all are drawn. Raises ComputationError where fewer than two steps are stored, a variable's
    units do not fit it, or the directory cannot be written.
    """
    figures = run_figures(dataset)
    written: list[Path] = []
    with written_aside(Path(directory), written) as aside:
        for name, figure in figures.items():
            save_figure(figure, aside / name)
    return written


def run_figures(dataset: xr.Dataset) -> dict[str, Figure]:
    """The pictures of a result as figures, by file name. Raises ComputationError as ``draw_run`` does."""
    _check_steps(dataset)
    drawn = {name: draw(dataset) for name, draw in PICTURES.items()}
    return {name: figure for name, figure in drawn.items() if figure is not None}


def _check_steps(dataset: xr.Dataset) -> None:
    steps = dataset.sizes.get("time", 0)
    if steps >= 2:
        return
    stored = "no step is stored" if steps == 0 else "only one step is stored"
    remedy = "Run the scene again."
    if not dataset.attrs.get("complete", 1):
        remedy = "The run ended before or just as its recorded mesh cycles began. Run the scene again, or record more of its cycles."
    raise ComputationError(f"There is nothing to draw: {stored}, and a curve needs two. {remedy}")


@styled
def save_figure(figure: Figure, path: Path | BinaryIO) -> None:
    """Save a figure as PNG."""
    FigureCanvasAgg(figure)
    figure.savefig(path, dpi=DOTS_PER_INCH, metadata={"Software": None})
