"""``gears accuracy SCENE``: measure error and time of each accuracy setting of a scene; print and write a table and a
picture of error against time."""

import argparse

from fenics_gears.system.console import print_rows, print_table

from .measuring import measured, print_origin, scene_to_measure, write_report
from .shared import WITHOUT_SOMETHING, add_memory_argument, add_output_argument, add_scene_argument


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("accuracy", parents=[shared])
    add_scene_argument(command)
    add_output_argument(command)
    command.add_argument("--quick", action="store_true", help="few, coarse values of each setting, each timed once")
    add_memory_argument(command)
    command.set_defaults(command=accuracy)


def accuracy(options: argparse.Namespace) -> int:
    scene, directory = scene_to_measure(options, "accuracy")
    from fenics_gears.show.work_precision import work_precision
    from fenics_gears.studies.accuracy.report import measure
    from fenics_gears.studies.accuracy.table import write_csv

    report = measured(lambda progress: measure(scene, progress, options.quick), options.quiet)
    files = write_report(report, directory, "accuracy", write_csv, work_precision)
    if not options.quiet:
        _print(report, files)
    return 0 if len(files) > 1 else WITHOUT_SOMETHING


def _print(report, files) -> None:
    from fenics_gears.studies.accuracy import table

    title = f"{report.scene.title}: each setting's error, the others at {report.fine.words}"
    print_table(title, table.headings(report), table.table_rows(report))
    print_table(
        "Combinations of settings, and cheaper models; * on the Pareto front",
        table.whole_headings(report),
        table.whole_rows(report),
    )
    print_rows("Result", [("", table.in_one_sentence(report), "")])
    print_rows("Remarks", [("", remark, "") for remark in (*table.remarks(report), table.timed(report))])
    if report.failures:
        print_rows("Not run", [(name, reason, "") for name, reason in report.failures])
    print_origin(report, files)
