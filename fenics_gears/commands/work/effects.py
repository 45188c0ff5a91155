"""What ``gears effects`` does."""

import argparse

from fenics_gears.show.effect_costs import effect_costs
from fenics_gears.studies.effect_costs import table
from fenics_gears.studies.effect_costs.measured import measure
from fenics_gears.system.console import print_rows, print_table

from .measuring import print_origin, report_of


def effects(options: argparse.Namespace) -> int:
    return report_of(options, "effects", measure, table.write_csv, effect_costs, _print)


def _print(report, files) -> None:
    heading = f"{report.scene.title}: effects, one more than the bare scene and one less than all"
    print_table(heading, table.headings(report), table.table_rows(report))
    print_rows("Remarks", [(f"[{number}]", remark, "") for number, remark in enumerate(table.remarks(report), 1)])
    if report.skipped:
        print_rows("Not run", [(each.name, each.reason, "") for each in report.skipped])
    print_rows("Bare and full scene", table.ratio_in_words(report))
    print_origin(report, files)
