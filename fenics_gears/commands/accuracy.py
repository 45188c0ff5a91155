"""``gears accuracy SCENE``: error against time, for the user's own scene."""

from __future__ import annotations

import argparse
from pathlib import Path

from fenics_gears.commands.scene_file import add_scene_argument, checked_scene
from fenics_gears.commands.told_progress import told_progress
from fenics_gears.errors import SceneError
from fenics_gears.job import communicator


def add(commands, shared: argparse.ArgumentParser) -> None:
    """Add the command to the parser."""
    words = "measure what each accuracy setting of a scene costs in time and gains; print and write table and work-precision picture"
    command = commands.add_parser("accuracy", parents=[shared], help=words)
    add_scene_argument(command)
    command.add_argument("-o", "--output", type=Path, metavar="DIR", help="where to write (default: results/<name of the scene file>)")
    command.add_argument("--quick", action="store_true", help="few and coarse rungs, each timed once")
    command.set_defaults(command=accuracy)


def accuracy(options: argparse.Namespace) -> int:
    """Measure the ladder of a scene, print and write the report."""
    from fenics_gears.output import check_writable

    scene = checked_scene(options.scene)
    directory = options.output or Path("results") / scene.name
    check_writable(directory)
    if communicator() is not None:
        raise SceneError("gears accuracy measures times, which mean nothing while processes share the machine. Start it without mpirun.")
    from fenics_gears.studies.accuracy.measured import measure

    progress = told_progress(options.quiet)
    try:
        report = measure(scene, progress, options.quick)
    finally:
        progress.close()
    files = _write(report, directory)
    if not options.quiet:
        _print(report, files)
    return 0


def _write(report, directory: Path) -> list[Path]:
    from fenics_gears.output import written_aside
    from fenics_gears.show.plots import save_figure
    from fenics_gears.show.work_precision import work_precision
    from fenics_gears.studies.accuracy.table import write_csv

    written: list[Path] = []
    with written_aside(directory, written) as aside:
        write_csv(report, aside / "accuracy.csv")
        save_figure(work_precision(report), aside / "accuracy.png")
    return written


def _print(report, files: list[Path]) -> None:
    from fenics_gears.console import print_rows, print_table
    from fenics_gears.studies.accuracy import table

    title = f"{report.scene.title}: each knob's error, the others at {report.fine.words}"
    print_table(title, [table.HEADINGS, table.UNITS], table.table_rows(report))
    print_table("Whole settings and cheaper models; * pays", [table.WHOLE_HEADINGS, table.WHOLE_UNITS], table.whole_rows(report))
    print_rows("In one sentence", [("", table.in_one_sentence(report), "")])
    print_rows("Remarks", [("", remark, "") for remark in table.remarks(report)])
    if report.failures:
        print_rows("Not run", [(name, reason, "") for name, reason in report.failures])
    print_rows("Measured on", [(name, words, "") for name, words in report.machine.items()])
    print_rows("Files", [("", str(file), "") for file in files])
