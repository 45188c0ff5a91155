"""Tables for people: drawn by rich on a terminal, plain aligned lines elsewhere."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import Any, TextIO

# Open MPI and MPICH start processes on a pseudo-terminal of their own, whatever mpirun itself writes to.
STARTED_BY_MPI = ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE")

Row = tuple[str, Any, str]


def on_terminal(stream: TextIO) -> bool:
    """Whether colours and bars reach a person by a stream: they do not by a pipe or a file, also behind mpirun."""
    return stream.isatty() and not any(name in os.environ for name in STARTED_BY_MPI)


def print_rows(heading: str, rows: Sequence[Row]) -> None:
    """Print rows of label, value and unit under a heading to the standard output."""
    cells = [(label, number_text(value), unit) for label, value, unit in rows]
    if on_terminal(sys.stdout):
        _print_rich(heading, cells)
    else:
        _print_plain(heading, cells)


def print_table(heading: str, headings: Sequence[Sequence[str]], rows: Sequence[Sequence[str]]) -> None:
    """Print rows of cells in columns under a heading; `headings`: lines above the columns, which are left out where they are empty."""
    if on_terminal(sys.stdout):
        _print_rich_table(heading, headings, rows)
    else:
        _print_plain_table(heading, headings, rows)


def _print_rich_table(heading: str, headings: Sequence[Sequence[str]], rows: Sequence[Sequence[str]]) -> None:
    from rich.console import Console
    from rich.padding import Padding
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    for place, words in enumerate(zip(*headings)):
        table.add_column(Text("\n".join(words)), justify="left" if place == 0 else "right", no_wrap=place == 0)
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))
    console = Console(highlight=False)
    console.print(Text(heading, style="bold"))
    console.print(Padding(table, (0, 0, 1, 2)))


def _print_plain_table(heading: str, headings: Sequence[Sequence[str]], rows: Sequence[Sequence[str]]) -> None:
    lines = [*headings, *rows]
    widths = [max(len(cell) for cell in column) for column in zip(*lines)]
    print(heading)
    for line in lines:
        first, *others = (cell.ljust(width) if place == 0 else cell.rjust(width) for place, (cell, width) in enumerate(zip(line, widths)))
        print("  " + "  ".join([first, *others]).rstrip())
    print()


def _print_rich(heading: str, cells: Sequence[tuple[str, str, str]]) -> None:
    from rich.console import Console
    from rich.padding import Padding
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, show_header=False, pad_edge=False, padding=(0, 2, 0, 0))
    table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    for label, value, unit in cells:
        table.add_row(Text(label), Text(f"{value} {unit}".rstrip()))
    console = Console(highlight=False)
    console.print(Text(heading, style="bold"))
    console.print(Padding(table, (0, 0, 1, 2)))


def _print_plain(heading: str, cells: Sequence[tuple[str, str, str]]) -> None:
    width = max((len(label) for label, _, _ in cells), default=0)
    print(heading)
    for label, value, unit in cells:
        print(f"  {label:<{width}}  {value} {unit}".rstrip())
    print()


def number_text(value: Any) -> str:
    """A value for people: six significant digits are more than a picture or a drawing shows."""
    return f"{float(value):.6g}" if hasattr(value, "__float__") and not isinstance(value, (str, int)) else str(value)
