"""``gears effects SCENE``: run a scene with subsets of its effects; print and write, as table and picture, the time
each effect takes and how it changes the result."""

import argparse

from fenics_gears.system.console import print_rows, print_table

from .measuring import measured, print_origin, scene_to_measure, write_report
from .shared import WITHOUT_SOMETHING, add_memory_argument, add_output_argument, add_scene_argument


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("effects", parents=[shared])
    add_scene_argument(command)
    add_output_argument(command)
    add_memory_argument(command)
    command.set_defaults(command=effects)


def effects(options: argparse.Namespace) -> int:
    scene, directory = scene_to_measure(options, "effects")
    from fenics_gears.show.effect_costs import effect_costs
    from fenics_gears.studies.effect_costs.measured import measure
    from fenics_gears.studies.effect_costs.table import write_csv

    report = measured(lambda progress: measure(scene, progress), options.quiet)
    files = write_report(report, directory, "effects", write_csv, effect_costs)
    if not options.quiet:
        _print(report, files)
    return 0 if len(files) > 1 else WITHOUT_SOMETHING


def _print(report, files) -> None:
    from fenics_gears.studies.effect_costs import table

    heading = f"{report.scene.title}: effects, one more than the bare scene and one less than all"
    print_table(heading, table.headings(report), table.table_rows(report))
    print_rows("Remarks", [(f"[{number}]", remark, "") for number, remark in enumerate(table.remarks(report), 1)])
    if report.skipped:
        print_rows("Not run", [(each.name, each.reason, "") for each in report.skipped])
    print_rows("Bare and full scene", table.ratio_in_words(report))
    print_origin(report, files)
