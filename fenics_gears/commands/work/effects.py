"""What ``gears effects`` does."""

import argparse

from fenics_gears.show.effect_costs import effect_costs
from fenics_gears.studies.effect_costs import table
from fenics_gears.studies.effect_costs.measured import measure
from fenics_gears.system.console import print_rows, print_table

from ..shared import WITHOUT_SOMETHING
from .measuring import measured, print_origin, scene_to_measure, write_report


def effects(options: argparse.Namespace) -> int:
    scene, directory = scene_to_measure(options, "effects")
    report = measured(lambda progress: measure(scene, progress), options.quiet)
    files = write_report(report, directory, "effects", table.write_csv, effect_costs)
    if not options.quiet:
        _print(report, files)
    return 0 if len(files) > 1 else WITHOUT_SOMETHING


def _print(report, files) -> None:
    heading = f"{report.scene.title}: effects, one more than the bare scene and one less than all"
    print_table(heading, table.headings(report), table.table_rows(report))
    print_rows("Remarks", [(f"[{number}]", remark, "") for number, remark in enumerate(table.remarks(report), 1)])
    if report.skipped:
        print_rows("Not run", [(each.name, each.reason, "") for each in report.skipped])
    print_rows("Bare and full scene", table.ratio_in_words(report))
    print_origin(report, files)
