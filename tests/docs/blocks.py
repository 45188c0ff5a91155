"""The blocks of code in the documentation's pages, and the commands that stand in them and in its text."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from markdown_it import MarkdownIt

ROOT = Path(__file__).parents[2]
PAGES = sorted(
    [
        *(ROOT / name for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md")),
        *(ROOT / "docs").glob("*.md"),
        *(ROOT / "docs" / "evidence").glob("*.md"),
        *(ROOT / "demos").glob("*/README.md"),
    ]
)


@dataclass(frozen=True)
class Block:
    """A block of code: the language that its fence names ("" for an indented block), its text and the line (from 1)
    that the text begins at."""

    language: str
    code: str
    line: int


def name_of(page: Path) -> str:
    """The page's path in the checkout."""
    return str(page.relative_to(ROOT))


def blocks(page: Path) -> list[Block]:
    """All blocks of code of a page."""
    found = []
    for token in _tokens(page):
        if token.type == "fence":
            found.append(Block(token.info.strip(), token.content, token.map[0] + 2))
        elif token.type == "code_block":
            found.append(Block("", token.content, token.map[0] + 1))
    return found


def in_text(page: Path) -> Iterator[str]:
    """What stands as code in the page's text and tables."""
    for token in _tokens(page):
        yield from (child.content for child in token.children or () if child.type == "code_inline")


def _tokens(page: Path):
    return MarkdownIt("commonmark").enable("table").parse(page.read_text(encoding="utf-8"))
