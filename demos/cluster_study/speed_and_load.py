"""A study over speed and load under mpirun, stopped on the way and gone on with; its picture and its table. Called by
`run`."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

from demos.arguments import output_directory

STUDY = Path(__file__).parent / "study.toml"
PICTURE, TABLE = "cluster_study.png", "cluster_study.md"
# The demonstration ends the study when so many of its cases are done.
STOPPED_AFTER = 100


def main(arguments: list[str] | None = None) -> int:
    """Run, stop, go on, draw; returns the exit code of `gears study`."""
    directory = output_directory(
        "cluster_study",
        "A tip relief over speed and load: a study under mpirun, stopped on the way and gone on with.",
        arguments,
    )
    from demos.cluster_study.stopped import done, run

    processes = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if done(directory) < STOPPED_AFTER:
        run(STUDY, directory, processes, stop_after=STOPPED_AFTER)
        _say(f"Stopped with {done(directory)} cases done. The same command again:")
    begun, kept = time.perf_counter(), done(directory)
    code = run(STUDY, directory, processes)
    if code:
        return code
    _say(f"{done(directory) - kept} cases by {processes} processes in {time.perf_counter() - begun:.0f} s")
    for file in shown(directory):
        print(file)
    return 0


def shown(directory: Path) -> list[Path]:
    """Draw the study that lies in a directory and write its table, both into it."""
    from demos.cluster_study.gain import gain, table
    from demos.cluster_study.picture import draw
    from fenics_gears.system.output import written_aside
    from fenics_gears.show.plots import save_figure

    found = gain(directory / "study.nc")
    with written_aside(directory, written := []) as aside:
        save_figure(draw(found), aside / PICTURE)
        (aside / TABLE).write_text(table(found), encoding="utf-8")
    return written


def _say(words: str) -> None:
    print(words, file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
