"""The parts of a report's page: sections of words, tables, charts and pictures. The template decides how they look."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from fenics_gears.show.chart import Chart


@dataclass(frozen=True)
class Words:
    """A paragraph; `warns`: set off as a warning."""

    text: str
    warns: bool = False


@dataclass(frozen=True)
class Tile:
    """One number at the top of a page: its name, its value, its unit, a word on it."""

    label: str
    value: str
    unit: str = ""
    note: str = ""


@dataclass(frozen=True)
class Tiles:
    """The numbers at the top of a page."""

    tiles: Sequence[Tile]


@dataclass(frozen=True)
class Cell:
    """A table's cell: its text, a number to sort by, a page that it leads to, and whether it is a word of warning."""

    text: str
    value: float | None = None
    link: str = ""
    warns: bool = False
    number: bool = False


@dataclass(frozen=True)
class Table:
    """Rows of cells in columns; plain texts are cells. `numbers`: columns from this one on are aligned as numbers."""

    headings: Sequence[str]
    rows: Sequence[Sequence[Cell | str]]
    caption: str = ""
    sortable: bool = False
    numbers: int = 1

    @property
    def cells(self) -> list[list[Cell]]:
        """All cells as such."""
        return [[self._cell(each, column) for column, each in enumerate(row)] for row in self.rows]

    def _cell(self, each: Cell | str, column: int) -> Cell:
        cell = Cell(each) if isinstance(each, str) else each
        return replace(cell, number=column >= self.numbers)


@dataclass(frozen=True)
class Facts:
    """Rows of label, value and unit, as `gears check` and the summary of a run have them."""

    rows: Sequence[tuple[str, Any, str]]
    caption: str = ""


@dataclass(frozen=True)
class Picture:
    """A PNG picture (bytes), and what it shows in words."""

    caption: str
    png: bytes
    note: str = ""


@dataclass(frozen=True)
class Listing:
    """Text as it is in a file."""

    text: str


@dataclass(frozen=True)
class Fold:
    """Blocks under a line that opens them."""

    heading: str
    blocks: Sequence[Any]


@dataclass(frozen=True)
class Beside:
    """Blocks next to each other where the page is wide enough."""

    blocks: Sequence[Any]


Block = Words | Tiles | Table | Facts | Chart | Picture | Listing | Fold | Beside


@dataclass(frozen=True)
class PageSection:
    """A heading, its name in links, and the blocks under it."""

    name: str
    heading: str
    blocks: Sequence[Block]


def sentence(name: str, heading: str, text: str, warns: bool = False) -> PageSection:
    """A section that has nothing but a sentence."""
    return PageSection(name, heading, [Words(text, warns)])


@dataclass(frozen=True)
class Letterhead:
    """Whose report it is: rows of name and value, and a picture as a data address, empty where there is none."""

    rows: Sequence[tuple[str, str]]
    logo: str = ""


@dataclass(frozen=True)
class Page:
    """A whole report; `subject`: of what ("Run", "Study"); `subtitle`: its conditions; `alarm`: what must be known
    first; `letterhead`: of a report with a layout of its own."""

    subject: str
    title: str
    subtitle: str
    sections: Sequence[PageSection]
    origin: str = ""
    alarm: str = ""
    letterhead: Letterhead | None = None


def counted(number: int, thing: str) -> str:
    """A number of things, "1 case" and "30 cases"."""
    return f"{number:,} {thing}{'' if number == 1 else 's'}"
