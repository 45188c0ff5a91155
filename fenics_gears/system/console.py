"""Tables for people, drawn by rich on a terminal, plain lines elsewhere; streams that take any text; text that a
terminal and a file of results can take."""

import io
import os
import re
import sys
from collections.abc import Sequence
from typing import Any, TextIO

from .environment import on_terminal_of_its_own

# A terminal obeys control characters, NUL ends a text of HDF5. All but tab and new line.
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f]")
# Python's stand-ins for bytes of a file's name that are no UTF-8; no encoding takes them.
_BYTES = re.compile("[\ud800-\udfff]")


def control_character(text: str) -> str:
    """The first control character of a text as Unicode writes it, "U+001B"; empty where there is none."""
    match = _CONTROL.search(text)
    return f"U+{ord(match[0]):04X}" if match else ""


def printable(text: str) -> str:
    """The text with a replacement character for each that is none of a text."""
    return _BYTES.sub("\ufffd", _CONTROL.sub("\ufffd", text))


Row = tuple[str, Any, str]


class NeverFull(io.FileIO):
    """A stream for words about a computation, which goes on where they cannot be written."""

    def write(self, content) -> int:
        try:
            super().write(content)
        except BrokenPipeError:
            raise
        except OSError:
            pass
        return len(content)


def prepare_streams() -> None:
    """Make the standard streams take any text: what their encoding lacks is replaced, what is closed keeps nothing."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            _open_nowhere(number, name)
    if sys.stderr is sys.__stderr__:
        raw = NeverFull(sys.stderr.fileno(), "w", closefd=False)
        buffer = io.BufferedWriter(raw)
        encoding = sys.stderr.encoding
        sys.stderr = io.TextIOWrapper(buffer, encoding, "replace", line_buffering=True, write_through=True)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")


def _open_nowhere(number: int, name: str) -> None:
    """Open a closed standard stream. A file that is opened later must not get its number, to which libraries print."""
    opened = os.open(os.devnull, os.O_RDWR)
    if opened != number:
        os.dup2(opened, number)
        os.close(opened)
    setattr(sys, name, open(number, "r" if name == "stdin" else "w", closefd=False))


def on_terminal(stream: TextIO) -> bool:
    """Whether colours and bars reach a person by a stream."""
    return stream.isatty() and not on_terminal_of_its_own()


def print_rows(heading: str, rows: Sequence[Row]) -> None:
    """Print rows of label, value and unit under a heading to the standard output."""
    _print(heading, (), [(label, f"{number_text(value)} {unit}".rstrip()) for label, value, unit in rows], left=2)


def print_table(heading: str, headings: Sequence[Sequence[str]], rows: Sequence[Sequence[str]]) -> None:
    """Print rows of cells in columns under a heading; `headings`: lines above the columns."""
    _print(heading, headings, rows, left=1)


def _print(heading: str, headings: Sequence[Sequence[str]], rows: Sequence[Sequence[str]], left: int) -> None:
    """Print a table whose first columns, `left` of them, begin at the left and the others end at the right."""
    heading = printable(heading)
    rows = [[printable(cell) for cell in row] for row in rows]
    columns = list(zip(*headings, *rows))
    if on_terminal(sys.stdout):
        _print_rich(heading, [column[: len(headings)] for column in columns], rows, left)
        return
    widths = [max(map(len, column)) for column in columns]
    print(heading)
    for line in (*headings, *rows):
        cells = (
            cell.ljust(width) if place < left else cell.rjust(width)
            for place, (cell, width) in enumerate(zip(line, widths))
        )
        print("  " + "  ".join(cells).rstrip())
    print()


def _print_rich(heading: str, headings: Sequence[Sequence[str]], rows: Sequence[Sequence[str]], left: int) -> None:
    from rich.console import Console
    from rich.padding import Padding
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, show_header=any(headings), pad_edge=False, padding=(0, 2, 0, 0))
    for place, words in enumerate(headings):
        table.add_column(
            Text("\n".join(words)), justify="left" if place < left else "right", no_wrap=place == 0, overflow="fold"
        )
    for row in rows:
        table.add_row(*map(Text, row))
    console = Console(highlight=False)
    console.print(Text(heading, style="bold"))
    console.print(Padding(table, (0, 0, 1, 2)))


def number_text(value: Any) -> str:
    """A value for people: six significant digits are more than a picture or a drawing shows."""
    return f"{float(value):.6g}" if hasattr(value, "__float__") and not isinstance(value, (str, int)) else str(value)
