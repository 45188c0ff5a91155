"""Tables for people: drawn by rich on a terminal, plain aligned lines elsewhere."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any, TextIO

from fenics_gears.system.environment import on_terminal_of_its_own

Row = tuple[str, Any, str]


def on_terminal(stream: TextIO) -> bool:
    """Whether colours and bars reach a person by a stream: they do not by a pipe or a file, also behind mpirun."""
    return stream.isatty() and not on_terminal_of_its_own()


def print_rows(heading: str, rows: Sequence[Row]) -> None:
    """Print rows of label, value and unit under a heading to the standard output."""
    _print(heading, (), [(label, f"{number_text(value)} {unit}".rstrip()) for label, value, unit in rows], left=2)


def print_table(heading: str, headings: Sequence[Sequence[str]], rows: Sequence[Sequence[str]]) -> None:
    """Print rows of cells in columns under a heading; `headings`: lines above the columns."""
    _print(heading, headings, rows, left=1)


def _print(heading: str, headings: Sequence[Sequence[str]], rows: Sequence[Sequence[str]], left: int) -> None:
    """Print a table whose first columns, `left` of them, begin at the left and the others end at the right."""
    columns = list(zip(*headings, *rows))
    if on_terminal(sys.stdout):
        _print_rich(heading, [column[: len(headings)] for column in columns], rows, left)
        return
    widths = [max(map(len, column)) for column in columns]
    print(heading)
    for line in (*headings, *rows):
        cells = (cell.ljust(width) if place < left else cell.rjust(width) for place, (cell, width) in enumerate(zip(line, widths)))
        print("  " + "  ".join(cells).rstrip())
    print()


def _print_rich(heading: str, headings: Sequence[Sequence[str]], rows: Sequence[Sequence[str]], left: int) -> None:
    from rich.console import Console
    from rich.padding import Padding
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, show_header=any(headings), pad_edge=False, padding=(0, 2, 0, 0))
    for place, words in enumerate(headings):
        table.add_column(Text("\n".join(words)), justify="left" if place < left else "right", no_wrap=place == 0, overflow="fold")
    for row in rows:
        table.add_row(*map(Text, row))
    console = Console(highlight=False)
    console.print(Text(heading, style="bold"))
    console.print(Padding(table, (0, 0, 1, 2)))


def number_text(value: Any) -> str:
    """A value for people: six significant digits are more than a picture or a drawing shows."""
    return f"{float(value):.6g}" if hasattr(value, "__float__") and not isinstance(value, (str, int)) else str(value)
