"""The whole gallery: run every study of this folder, draw the paper's figures, write the table of its claims.

Called by `run`; a second call computes only what is missing.
"""

from __future__ import annotations

import multiprocessing
import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from itertools import repeat
from pathlib import Path

from demos.arguments import output_directory

INTERRUPTED = 130
# Those that read and draw most first.
FIGURES = (
    "readings_of_inertia",
    "figure10",
    "figure06",
    "figure09",
    "figure02",
    "figure04",
    "figure05",
    "figure08",
    "undamped",
)
# Longest first, so that no process is left alone with one at the end.
LONGEST_FIRST = (
    "figure10_high",
    "figure06_high",
    "figure10_low",
    "figure06_low",
    "figure06_beyond",
    "figure09",
    "undamped",
)


def main(arguments: list[str] | None = None) -> int:
    """Run, draw, write; returns the exit code of `gears study`."""
    directory = output_directory(
        "lundvall2004", "The figures and claims of Lundvall, Strömberg and Klarbring, 2004.", arguments
    )
    begun = time.perf_counter()
    # Processes of their own: one that is forked shares locks of BLAS and MPI.
    with ProcessPoolExecutor(_cores(), multiprocessing.get_context("spawn")) as pool:
        code = run_studies(pool, directory / "studies", begun)
        if code:
            return code
        pictures = pool.map(draw_one, FIGURES, repeat(directory))
        from demos.lundvall2004.measured import Measured
        from demos.lundvall2004.table import write_table

        table = write_table(Measured(directory / "studies"), directory / "claims.md")
        for file in (*pictures, table):
            print(file)
    _say(f"done after {time.perf_counter() - begun:.0f} s")
    return 0


def run_studies(pool: ProcessPoolExecutor, directory: Path, begun: float) -> int:
    """Run every study, as many at a time as there are cores; the exit code of the worst."""
    from demos.lundvall2004.measured import study_files

    files = study_files()
    waiting = sorted(files, key=_turn)
    _say(f"{len(files)} studies on {_cores()} cores; results go to {directory}")
    worst = 0
    try:
        tasks = {pool.submit(run_one, files[name], directory / name): name for name in waiting}
        for number, task in enumerate(as_completed(tasks), 1):
            code, words, seconds = task.result()
            worst = max(worst, code)
            _say(
                f"[{number}/{len(files)}] {tasks[task]}: {words}, {seconds:.1f} s (after"
                f" {time.perf_counter() - begun:.0f} s)"
            )
    except KeyboardInterrupt:
        pool.shutdown(cancel_futures=True)
        _say("interrupted; the same command goes on from here")
        return INTERRUPTED
    return worst


def run_one(file: Path, directory: Path) -> tuple[int, str, float]:
    """Run what is missing of one study: exit code, what came of it, wall time in s."""
    from fenics_gears.errors import ComputationError, GearsError
    from fenics_gears.system.progress import SilentProgress
    from fenics_gears.studies.run_study import run_study

    begun = time.perf_counter()
    try:
        outcome = run_study(file, directory, SilentProgress(), quiet=True)
    except GearsError as error:
        return error.exit_code, str(error), time.perf_counter() - begun
    computed = len(outcome.records) - outcome.kept
    words = f"{computed} runs" + (f", {outcome.kept} kept" if outcome.kept else "")
    if outcome.failures:
        index, reason = next(iter(outcome.failures.items()))
        words += f"; {len(outcome.failures)} failed, the first {outcome.study.cases[index]}: {reason}"
    code = INTERRUPTED if outcome.interrupted else ComputationError.exit_code if outcome.failures else 0
    return code, words, time.perf_counter() - begun


def draw_one(name: str, directory: Path) -> Path:
    """Draw a figure from the studies below a directory into it."""
    from demos.lundvall2004.figures import draw_figure
    from demos.lundvall2004.measured import Measured

    return draw_figure(name, Measured(directory / "studies"), directory)


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _turn(name: str) -> int:
    return next((place for place, part in enumerate(LONGEST_FIRST) if part in name), len(LONGEST_FIRST))


def _say(words: str) -> None:
    print(words, file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
