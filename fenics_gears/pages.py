"""Pages like the report of ``gears report``: blocks of words, numbers, tables and pictures, written as one HTML file.

>>> from fenics_gears.pages import Page, PageSection, Words, rendered
>>> sections = [PageSection("pairs", "What was compared", [Words("A pair with relief and one without.")])]
>>> "one without" in rendered(Page("Comparison", "Two pairs", "at 437 N m", sections))
True
"""

from fenics_gears.show.report.origin import made_by, scene_section
from fenics_gears.show.report.overview import counted
from fenics_gears.show.report.page import Block, Cell, Facts, Page, PageSection, Table, Tile, Tiles, Words
from fenics_gears.show.report.rendering import rendered

__all__ = [
    "Block", "Cell", "Facts", "Page", "PageSection", "Table", "Tile", "Tiles", "Words", "counted", "made_by",
    "rendered", "scene_section",
]  # fmt: skip
