"""The pictures of a run and of a study: charts of the dataset, saved under fixed names."""

import struct
import textwrap
import zlib
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import BinaryIO

import numpy as np
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from fenics_gears.errors import ComputationError
from fenics_gears.system.output import written_aside

from . import FACE_PICTURE_FILES, PICTURE_FILES
from .chart import LETTERS, Chart
from .drawing import picture
from .motion import (
    error_by_cycle,
    error_values,
    mesh_forces,
    pair_forces,
    shaft_torques,
    transmission_error,
    wheels_shaft,
)
from .orders import OF_ERROR, order_spectrum
from .panels import DARK, DOTS_PER_INCH, WARNING, styled
from .pressure import pressure_maps
from .run import ShownRun, conditions


def _errors(run: ShownRun) -> list[Chart]:
    if "transmission_error" not in run.dataset:
        return []
    whole = error_by_cycle(run) if run.varies(error_values(run)[0]) else []
    return [transmission_error(run), *wheels_shaft(run), *whole]


def _shares(run: ShownRun) -> list[Chart]:
    return list(pair_forces(run))[:1]


def _orders(run: ShownRun) -> Iterable[Chart]:
    chart = order_spectrum(run)
    # The heading names the subject.
    return [replace(chart, caption=chart.caption.removeprefix(f"{OF_ERROR}, "))] if chart is not None else []


SUBJECTS: tuple[tuple[str, Callable[[ShownRun], Iterable[Chart]]], ...] = (
    ("Transmission error", _errors),
    ("Mesh forces", lambda run: [*mesh_forces(run), *shaft_torques(run)]),
    ("Load sharing between tooth pairs", _shares),
    ("Contact pressure on the flanks", pressure_maps),
    (OF_ERROR, _orders),
)
PICTURES = dict(zip(PICTURE_FILES, SUBJECTS))


ROWS_AT_ONCE = 16


def draw_run(dataset: xr.Dataset, directory: str | Path) -> list[Path]:
    """Draw all pictures for which the result has data, as PNG, and return the files, which appear in ``directory``
    together. Raises ComputationError where fewer than two steps are stored, units do not fit, or the directory cannot
    be written."""
    return save_figures(run_figures(dataset), Path(directory))


def run_figures(dataset: xr.Dataset) -> dict[str, Figure]:
    """The pictures of a result as figures, by file name. Raises ComputationError as ``draw_run`` does."""
    run = ShownRun(dataset)
    _check_steps(run)
    colour = DARK if run.complete else WARNING
    charts = charts_of(run)
    return {name: picture(_heading(run, subject), drawn, colour) for name, (subject, drawn) in charts.items()}


def charts_of(run: ShownRun) -> dict[str, tuple[str, list[Chart]]]:
    """By the file name of each picture that a run has, its subject and its charts."""
    pictures = PICTURES
    if run.over_face:
        # Runs in the plane load none of these charts.
        from .over_face import charts_over_face

        pictures = PICTURES | dict(zip(FACE_PICTURE_FILES, charts_over_face(run).items()))
    subjects = {name: (subject, list(charts(run))) for name, (subject, charts) in pictures.items()}
    return {name: drawn for name, drawn in subjects.items() if drawn[1]}


def _heading(run: ShownRun, subject: str) -> str:
    more = [] if run.scene is None else [conditions(run.scene)]
    if not run.complete:
        more.append(f"INCOMPLETE RUN: stopped at mesh cycle {run.phase[-1]:.2f}")
    return heading(subject, run.title, *more)


def heading(subject: str, title: str, *more: str) -> str:
    """Subject and title in lines that fit a picture's width."""
    first = textwrap.shorten(f"{subject}: {title}" if title.strip() else subject, LETTERS, placeholder=" …")
    return "\n".join([first, *(line for each in more for line in textwrap.wrap(each, LETTERS, break_long_words=False))])


def _check_steps(run: ShownRun) -> None:
    if run.has_curves:
        return
    stored = "no step is stored" if run.steps == 0 else "only one step is stored"
    remedy = "" if run.complete else ", or record more of its mesh cycles"
    raise ComputationError(f"There is nothing to draw: {stored}, and a curve needs two. Run the scene again{remedy}.")


def save_figures(figures: dict[str, Figure], directory: Path) -> list[Path]:
    """Save figures by their file names, all or none."""
    written: list[Path] = []
    with written_aside(directory, written) as aside:
        for name, figure in figures.items():
            save_figure(figure, aside / name)
    return written


@styled
def save_figure(figure: Figure, path: Path | BinaryIO) -> None:
    """Save a figure as PNG."""
    # `savefig` draws twice, once only for the layout.
    figure.set_dpi(DOTS_PER_INCH)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    content = png(np.asarray(canvas.buffer_rgba()), figure.dpi)
    path.write_bytes(content) if isinstance(path, Path) else path.write(content)


def png(pixels: np.ndarray, dots_per_inch: float) -> bytes:
    """Pixels (height, width, 4) as PNG. Rows are not filtered: that would take twice as long and make the file no
    smaller."""
    height, width, _ = pixels.shape
    # The same few rows again and again: fresh memory for a second copy of a picture is slower than the copying.
    rows = np.zeros((ROWS_AT_ONCE, 1 + 4 * width), dtype=np.uint8)
    packer = zlib.compressobj(1)
    packed = []
    for first in range(0, height, ROWS_AT_ONCE):
        part = pixels[first : first + ROWS_AT_ONCE].reshape(-1, 4 * width)
        rows[: len(part), 1:] = part
        packed.append(packer.compress(rows[: len(part)]))
    dots = round(dots_per_inch / 0.0254)
    parts = {
        b"IHDR": struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0), b"pHYs": struct.pack(">IIB", dots, dots, 1),
        b"IDAT": b"".join([*packed, packer.flush()]), b"IEND": b"",
    }  # fmt: skip
    chunks = [
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in parts.items()
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)
