"""Charts for pictures and pages, and their colours: what a program takes that draws its own.

A `Chart` is data: curves over one axis, with titles and units. `draw_charts` writes charts as PNG.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path

from fenics_gears.commands.work.shared import plots
from fenics_gears.show.chart import BAND, BARS, LINES, MARKED_LINES, MARKERS, WORDS, Chart, Curve, span, stems
from fenics_gears.show.harris_map import harris_map, words_apart
from fenics_gears.show.panels import DARK, GREY, PALETTE, shades
from fenics_gears.show.run import design

__all__ = [
    "BAND", "BARS", "DARK", "GREY", "LINES", "MARKED_LINES", "MARKERS", "PALETTE", "WORDS", "Chart", "Curve",
    "design", "draw_charts", "harris_map", "shades", "span", "stems", "words_apart",
]  # fmt: skip


def draw_charts(
    pictures: Mapping[str, tuple[str, Sequence[Chart]]], directory: Path, title: str, *more: str
) -> list[Path]:
    """Write pictures as PNG into a directory, all or none, and return their files.

    pictures: by file name the subject and the charts, which are drawn below each other. The heading is the subject and
    the title, then `more` in lines of its own. Raises ComputationError where the directory cannot be written.
    """
    drawing = plots()
    picture = plots("drawing").picture
    figures = {
        name: picture(drawing.heading(subject, title, *more), charts) for name, (subject, charts) in pictures.items()
    }
    return drawing.save_figures(figures, directory)
