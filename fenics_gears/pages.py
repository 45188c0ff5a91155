"""Pages like the report of ``gears report``: blocks of words, numbers, tables and pictures, written as one HTML file.

>>> from fenics_gears.pages import Page, PageSection, Words, rendered
>>> sections = [PageSection("pairs", "What was compared", [Words("A pair with relief and one without.")])]
>>> "one without" in rendered(Page("Comparison", "Two pairs", "at 437 N m", sections))
True
"""

from pathlib import Path

import xarray as xr

from fenics_gears.show.report.origin import made_by, scene_section
from fenics_gears.show.report.overview import counted
from fenics_gears.show.report.page import Block, Cell, Facts, Page, PageSection, Table, Tile, Tiles, Words
from fenics_gears.show.report.rendering import colours, rendered
from fenics_gears.show.run import ShownRun

__all__ = [
    "Block", "Cell", "Facts", "Page", "PageSection", "Table", "Tile", "Tiles", "Words", "colours", "counted", "made_by",
    "rendered", "run_report", "scene_section",
]  # fmt: skip


def run_report(dataset: xr.Dataset, file: Path) -> str:
    """The page of ``gears report`` on a run that is in a file."""
    # Pages of other kinds need none of it.
    if "mesh" in dataset.dims:
        from fenics_gears.show.report.train_page import train_page

        return rendered(train_page(dataset, file))
    from fenics_gears.show.report.run_page import run_page

    return rendered(run_page(ShownRun(dataset, file)))
