"""Numbers of a benchmark as lines of a CSV and of a page's table."""

import csv
from pathlib import Path

from matplotlib.figure import Figure

PICTURES = Path(__file__).parents[3] / "docs" / "pictures" / "third_dimension"

Row = dict[str, float]


def write_rows(name: str, rows: list[Row]) -> None:
    PICTURES.mkdir(parents=True, exist_ok=True)
    with open(PICTURES / f"{name}.csv", "w", encoding="utf-8", newline="") as opened:
        writer = csv.DictWriter(opened, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows([{key: f"{value:.8g}" for key, value in row.items()} for row in rows])


def read_rows(name: str) -> list[Row]:
    with open(PICTURES / f"{name}.csv", encoding="utf-8", newline="") as opened:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(opened)]


def with_picture(name: str, words: str, figure: Figure, headings: list[str], lines: list[list[str]]) -> str:
    """The picture, which is written, above the table."""
    figure.savefig(PICTURES / f"{name}.png")
    return "\n".join([f"![{words}](../pictures/third_dimension/{name}.png)", "", *table(headings, lines)])


def table(headings: list[str], lines: list[list[str]]) -> list[str]:
    return [f"| {' | '.join(cells)} |" for cells in (headings, ["---"] * len(headings), *lines)]
