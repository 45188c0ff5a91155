"""Charts for pictures and pages, and their colours: what a program takes that draws its own.

A `Chart` is data: curves over one axis, with titles and units. `draw_charts` writes charts as PNG; `plotly_figure` is
what plotly's browser library draws of one. `run_charts` and `gear_outline` show a run, `tooth_points` a tooth.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from fenics_gears.commands.work.shared import plots
from fenics_gears.show import pair_drawing
from fenics_gears.show.chart import BAND, BARS, LINES, MARKED_LINES, MARKERS, WORDS, Chart, Curve, Field, span, stems
from fenics_gears.show.harris_map import harris_map, words_apart
from fenics_gears.show.interactive import figure as plotly_figure
from fenics_gears.show.panels import DARK, GREY, PALETTE, shades, styled
from fenics_gears.show.run import ShownRun, conditions, design

if TYPE_CHECKING:
    import numpy as np
    import xarray as xr
    from matplotlib.figure import Figure

    from fenics_gears.geometry.gear import Gear
    from fenics_gears.geometry.pair import GearPair
    from fenics_gears.scene.train import TrainScene
    from fenics_gears.show.gears_of_train import DrawnGear

__all__ = [
    "BAND", "BARS", "DARK", "GREY", "LINES", "MARKED_LINES", "MARKERS", "PALETTE", "WORDS", "Chart", "Curve", "Field",
    "conditions", "design", "draw_charts", "draw_run", "gear_outline", "gears_of_train", "harris_map",
    "plotly_figure", "run_charts", "save_figures", "shades", "span", "stems", "styled", "tooth_points",
    "train_charts", "words_apart",
]  # fmt: skip


def run_charts(dataset: xr.Dataset) -> list[tuple[str, list[Chart]]]:
    """Subjects and charts of the pictures that a run has."""
    return list(plots().charts_of(ShownRun(dataset)).values())


def train_charts(dataset: xr.Dataset, scene: TrainScene) -> list[tuple[str, list[Chart]]]:
    """The same of a train's run: all but its drawing, which `gears_of_train` gives."""
    return [each for each in plots("train").subjects_of(scene, dataset) if each[1]]


def gears_of_train(scene: TrainScene) -> tuple[list[DrawnGear], float]:
    """Outlines of all gears of a train, those first that others are drawn over; and the angle (rad) by which the
    carrier of a planetary set turns in a cycle of the first mesh, 0 of other trains."""
    from fenics_gears.show.gears_of_train import gears_of_train

    return gears_of_train(scene)


def gear_outline(pair: GearPair, gear: int, phase: float) -> np.ndarray:
    """Outline (n, 2), mm, of the pinion (0) or the wheel (1) at a phase of the mesh cycle; line of centres upright."""
    return pair_drawing.gear_outline(pair, gear, phase)


def tooth_points(gear: Gear) -> np.ndarray:
    """Outline (n, 2), mm, of one tooth, from the middle of a space to the middle of the next."""
    return pair_drawing.tooth_points(gear)


def draw_run(dataset: xr.Dataset, directory: Path) -> list[Path]:
    """Write the pictures of a run, as ``gears plot`` does. Raises ComputationError as that does."""
    if "mesh" in dataset.dims:
        return plots("train").draw_train(dataset, directory)
    return plots().draw_run(dataset, directory)


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


def save_figures(figures: dict[str, Figure], directory: Path) -> list[Path]:
    """Save matplotlib's figures as PNG by their file names, all or none. Raises ComputationError as `draw_charts`."""
    return plots().save_figures(figures, directory)
