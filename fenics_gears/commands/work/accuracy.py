"""What ``gears accuracy`` does."""

import argparse
from functools import partial

from fenics_gears.show.work_precision import work_precision
from fenics_gears.studies.accuracy import table
from fenics_gears.studies.accuracy.report import measure
from fenics_gears.system.console import print_rows, print_table

from .measuring import print_origin, report_of


def accuracy(options: argparse.Namespace) -> int:
    quick = partial(measure, quick=options.quick)
    return report_of(options, "accuracy", quick, table.write_csv, work_precision, _print)


def _print(report, files) -> None:
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
