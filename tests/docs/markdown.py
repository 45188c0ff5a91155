"""Pieces of Markdown of the generated pages."""

import re
from collections.abc import Iterable, Sequence

from tests.docs.blocks import ROOT

# How the prose at the top of a page ends whose other lines are generated.
WRITTEN = "a test says when it is out of date.\n"


def table(heading: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """A bar in a cell would end it and is escaped."""
    lines = [heading, ["---"] * len(heading), *rows]
    return ["| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines]


def from_docstring(text: str) -> str:
    paragraph = " ".join(text.strip().split("\n\n")[0].split())
    return re.sub(r"``(.+?)``", r"`\1`", paragraph)


def capital(words: str) -> str:
    words = words[:1].upper() + words[1:]
    return words if words.endswith(".") else words + "."


def prose(page: str) -> str:
    text, found, _ = (ROOT / "docs" / page).read_text(encoding="utf-8").partition(WRITTEN)
    assert found, f"docs/{page} does not say who writes it"
    return text + found
