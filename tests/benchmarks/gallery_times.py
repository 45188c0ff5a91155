"""CPU time of each study of the paper's gallery, of its figures and of its claims, one after the other in this process.

python -m tests.benchmarks.gallery_times DIR [NAME ...]   DIR: an empty folder; NAME: part of a study's name
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

from demos.lundvall2004.gallery import FIGURES, draw_one, run_one
from demos.lundvall2004.measured import Measured, study_files
from demos.lundvall2004.table import write_table


def timed(what: str, work) -> None:
    """Do some work; print its CPU time, s, and what it returned."""
    begun = time.process_time()
    found = work()
    print(f"{what:36s} {time.process_time() - begun:7.2f} s  {found}", flush=True)


def main(directory: Path, parts: list[str]) -> None:
    """Time all, or the studies that have one of these parts in their name."""
    for name, file in study_files().items():
        if not parts or any(part in name for part in parts):
            timed(name, lambda: run_one(file, directory / "studies" / name)[1])
    if not parts:
        timed("figures", lambda: len([draw_one(name, directory) for name in FIGURES]))
        timed("claims", lambda: write_table(Measured(directory / "studies"), directory / "claims.md").name)
    print(f"{'all, with imports':36s} {time.process_time():7.2f} s")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
