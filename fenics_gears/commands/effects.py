"""``gears effects SCENE``: what each effect of a scene costs, and what it changes in the answer."""

from __future__ import annotations

import argparse
from pathlib import Path

from fenics_gears.commands.scene_file import add_scene_argument, checked_scene
from fenics_gears.commands.told_progress import told_progress
from fenics_gears.errors import SceneError
from fenics_gears.job import communicator


def add(commands, shared: argparse.ArgumentParser) -> None:
    """Add the command to the parser."""
    words = "run a scene with subsets of its effects; print what each effect costs and changes, write it as table and picture"
    command = commands.add_parser("effects", parents=[shared], help=words)
    add_scene_argument(command)
    command.add_argument("-o", "--output", type=Path, metavar="DIR", help="where to write (default: results/<name of the scene file>)")
    command.set_defaults(command=effects)


def effects(options: argparse.Namespace) -> int:
    """Measure the subsets of a scene's effects, print and write the report."""
    from fenics_gears.output import check_writable

    scene = checked_scene(options.scene)
    directory = options.output or Path("results") / scene.name
    check_writable(directory)
    if communicator() is not None:
        raise SceneError("gears effects measures times, which mean nothing while processes share the machine. Start it without mpirun.")
    from fenics_gears.studies.effect_lattice.measured import measure

    progress = told_progress(options.quiet)
    try:
        report = measure(scene, progress)
    finally:
        progress.close()
    files = _write(report, directory)
    if not options.quiet:
        _print(report, files)
    return 0


def _write(report, directory: Path) -> list[Path]:
    from fenics_gears.output import written_aside
    from fenics_gears.show.effect_costs import effect_costs
    from fenics_gears.show.plots import save_figure
    from fenics_gears.studies.effect_lattice.table import write_csv

    written: list[Path] = []
    with written_aside(directory, written) as aside:
        write_csv(report, aside / "effects.csv")
        save_figure(effect_costs(report), aside / "effects.png")
    return written


def _print(report, files: list[Path]) -> None:
    from fenics_gears.console import print_rows, print_table
    from fenics_gears.studies.effect_lattice import table

    heading = f"{report.scene.title}: effects, one more than the bare scene and one less than all"
    print_table(heading, [table.HEADINGS, table.UNITS], table.table_rows(report))
    print_rows("Remarks", [(f"[{number}]", remark, "") for number, remark in enumerate(table.remarks(report), 1)])
    if report.skipped:
        print_rows("Not run", [(each.name, each.reason, "") for each in report.skipped])
    print_rows("Bare and full scene", table.ratio_in_words(report))
    print_rows("What leaving out changes, the most important first", table.needs_in_words(report))
    print_rows("Measured on", [(name, words, "") for name, words in report.machine.items()])
    print_rows("Files", [("", str(file), "") for file in files])
