"""Numbers of rows as they were measured last, in numbers.csv."""

import csv
from pathlib import Path

from tests.evidence.claim import Numbers, Part

FILE = Path(__file__).with_name("numbers.csv")


def all_kept() -> dict[str, Numbers]:
    if not FILE.exists():
        return {}
    found: dict[str, Numbers] = {}
    with FILE.open(encoding="utf-8", newline="") as lines:
        for line in csv.DictReader(lines):
            found.setdefault(line["part"], {})[line["claim"]] = float(line["authority"]), float(line["here"])
    return found


def keep(part: Part, numbers: Numbers, parts: list[Part]) -> None:
    kept = all_kept() | {part.name: numbers}
    with FILE.open("w", encoding="utf-8", newline="") as lines:
        writer = csv.writer(lines, lineterminator="\n")
        writer.writerow(["part", "claim", "authority", "here"])
        for each in parts:
            for claim in each.claims:
                if claim in kept.get(each.name, {}):
                    writer.writerow([each.name, claim, *map(repr, map(float, kept[each.name][claim]))])


def numbers_of(part: Part) -> Numbers:
    """Of a benchmark's file, or as kept here. Raises SystemExit where a claim was never measured."""
    found = part.read() if part.read else all_kept().get(part.name, {})
    missing = [name for name in part.claims if name not in found]
    if missing:
        raise SystemExit(
            f"{part.name}: {', '.join(missing)} not measured yet; run python -m tests.evidence {part.name}"
        )
    return found
