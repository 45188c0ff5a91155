"""The whole gallery: run every study of this folder, draw the paper's figures, write the table of its claims.

Called by `run`; a second call computes only what is missing.
"""

from __future__ import annotations

import multiprocessing
import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

from demos.arguments import output_directory

INTERRUPTED = 130
# Longest first, so that no process is left alone with one at the end.
LONGEST_FIRST = ("figure06_high", "figure10_high", "figure10_low", "figure06_low", "figure09", "undamped", "figure06_beyond")


def main(arguments: list[str] | None = None) -> int:
    """Run, draw, write; returns the exit code of `gears study`."""
    directory = output_directory("lundvall2004", "The figures and claims of Lundvall, Strömberg and Klarbring, 2004.", arguments)
    begun = time.perf_counter()
    code = run_studies(directory / "studies", begun)
    if code:
        return code
    from demos.lundvall2004.figures import draw_figures
    from demos.lundvall2004.measured import Measured
    from demos.lundvall2004.table import write_table

    measured = Measured(directory / "studies")
    for picture in draw_figures(measured, directory):
        print(picture)
    print(write_table(measured, directory / "claims.md"))
    _say(f"done after {time.perf_counter() - begun:.0f} s")
    return 0


def run_studies(directory: Path, begun: float) -> int:
    """Run every study, as many at a time as there are cores; the exit code of the worst."""
    from demos.lundvall2004.measured import study_files

    files = study_files()
    waiting = sorted(files, key=_turn)
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    _say(f"{len(files)} studies on {cores} cores; results go to {directory}")
    worst = 0
    # Processes of their own: one that is forked shares locks of BLAS and MPI.
    with ProcessPoolExecutor(min(cores, len(files)), multiprocessing.get_context("spawn")) as pool:
        try:
            tasks = {pool.submit(run_one, files[name], directory / name): name for name in waiting}
            for number, task in enumerate(as_completed(tasks), 1):
                code, words, seconds = task.result()
                worst = max(worst, code)
                _say(f"[{number}/{len(files)}] {tasks[task]}: {words}, {seconds:.1f} s (after {time.perf_counter() - begun:.0f} s)")
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


def _turn(name: str) -> int:
    return next((place for place, part in enumerate(LONGEST_FIRST) if part in name), len(LONGEST_FIRST))


def _say(words: str) -> None:
    print(words, file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
