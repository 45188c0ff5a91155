"""Pages like that of ``gears report``: blocks of words, numbers, tables and pictures, written as one HTML file.

>>> from fenics_gears.pages import Page, PageSection, Words, rendered
>>> sections = [PageSection("pairs", "What was compared", [Words("A pair with relief and one without.")])]
>>> "one without" in rendered(Page("Comparison", "Two pairs", "at 437 N m", sections))
True
"""

from fenics_gears.show.pages.origin import made_by, scene_section, version_section
from fenics_gears.show.pages.page import (
    Beside,
    Block,
    Cell,
    Facts,
    Fold,
    Letterhead,
    Listing,
    Page,
    PageSection,
    Picture,
    Table,
    Tile,
    Tiles,
    Words,
    counted,
    sentence,
)
from fenics_gears.show.pages.rendering import colours, rendered

__all__ = [
    "Beside", "Block", "Cell", "Facts", "Fold", "Letterhead", "Listing", "Page", "PageSection", "Picture", "Table",
    "Tile", "Tiles", "Words", "colours", "counted", "made_by", "rendered", "scene_section", "sentence",
    "version_section",
]  # fmt: skip
