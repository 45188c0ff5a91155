"""Sections of pages that commands write: between two marker lines, all else left alone."""

from pathlib import Path


def markers(name: str) -> tuple[str, str]:
    return f"<!-- {name}: begin -->", f"<!-- {name}: end -->"


def replaced(page: str, begin: str, end: str, words: str, where: str = "the page") -> str:
    """The page with `words` between its two marker lines. Raises SystemExit where they are missing."""
    before, found, rest = page.partition(begin)
    _, closed, after = rest.partition(end)
    if not (found and closed):
        raise SystemExit(f"{where}: the lines {begin} and {end} are missing; put them where the section shall stand")
    return f"{before}{begin}\n\n{words}\n\n{end}{after}"


def write_section(page: Path, begin: str, end: str, words: str) -> None:
    """Put `words` between the two marker lines of a page."""
    page.write_text(replaced(page.read_text(encoding="utf-8"), begin, end, words, str(page)), encoding="utf-8")
