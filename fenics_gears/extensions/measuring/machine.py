"""The machine on which times were measured, and the CSV file of what was measured."""

import csv
import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from fenics_gears.measuring import processor, versions


def machine() -> dict[str, str]:
    return {
        "processor": processor(),
        "load": load(),
        "threads": "1 in the march (2 over a face at rest), " + threads() + " elsewhere",
        "versions": versions(),
    }


def in_words(machine: Mapping[str, str]) -> str:
    return f"{machine['processor']}, load {machine['load']}; threads: {machine['threads']}; {machine['versions']}"


def load() -> str:
    """Processes that wanted a core in the last minute, this one included."""
    try:
        return f"{os.getloadavg()[0]:.1f}"
    except OSError:
        return "unknown"


def threads() -> str:
    from threadpoolctl import threadpool_info

    counts = [pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"]
    return str(max(counts, default=1))


def write_lines(file: Path, lines: Sequence[Mapping[str, object]], machine: Mapping[str, str]) -> None:
    """Write a line for each of `lines` to a CSV file, each with the machine's words; a name that a line lacks is empty
    in it."""
    columns = dict.fromkeys(name for line in (*lines, machine) for name in line)
    with open(file, "w", encoding="utf-8", newline="") as opened:
        writer = csv.DictWriter(opened, list(columns), restval="")
        writer.writeheader()
        writer.writerows({**line, **machine} for line in lines)
