"""Code in the documentation's pages, and the commands in it."""

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
    """Its fence's language ("" for an indented block), its text and the line (from 1) that the text begins at."""

    language: str
    code: str
    line: int


def name_of(page: Path) -> str:
    return str(page.relative_to(ROOT))


def blocks(page: Path) -> list[Block]:
    found = []
    for token in _tokens(page):
        if token.type == "fence":
            found.append(Block(token.info.strip(), token.content, token.map[0] + 2))
        elif token.type == "code_block":
            found.append(Block("", token.content, token.map[0] + 1))
    return found


def in_text(page: Path) -> Iterator[str]:
    for token in _tokens(page):
        yield from (child.content for child in token.children or () if child.type == "code_inline")


def _tokens(page: Path):
    return MarkdownIt("commonmark").enable("table").parse(page.read_text(encoding="utf-8"))
