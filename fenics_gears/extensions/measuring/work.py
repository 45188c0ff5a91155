"""What ``gears accuracy`` and ``gears effects`` do."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

from fenics_gears import Scene, SceneError
from fenics_gears.charts import save_figures
from fenics_gears.command_line import (
    WITHOUT_SOMETHING,
    after_result,
    check_writable,
    checked_model,
    print_rows,
    print_table,
    shown_progress,
    write_whole,
)
from fenics_gears.many_runs import communicator
from fenics_gears.scene_text import load_scene_or_train

from . import train_accuracy
from .accuracy import report, work_precision
from .accuracy import table as accuracy_table
from .effect_costs import measured, table
from .effect_costs.picture import effect_costs

NO_TIMES = "measures times, which mean nothing while processes share the machine. Start gears without mpirun."


def effects(options: argparse.Namespace) -> int:
    return report_of(options, "effects", measured.measure, table.write_csv, effect_costs, _print_effects)


def effects_of(scene: Scene, directory: Path, progress) -> list[Path]:
    """The files of ``gears effects`` on a scene, written into a directory. Raises SceneError under mpirun."""
    if communicator() is not None:
        raise SceneError(f"--effects {NO_TIMES}")
    return write_report(measured.measure(scene, progress), directory, "effects", table.write_csv, effect_costs)


def _print_effects(report, files: list[Path]) -> None:
    heading = f"{report.scene.title}: effects, one more than the bare scene and one less than all"
    print_table(heading, table.headings(report), table.table_rows(report))
    print_rows("Remarks", [(f"[{number}]", remark, "") for number, remark in enumerate(table.remarks(report), 1)])
    if report.skipped:
        print_rows("Not run", [(each.name, each.reason, "") for each in report.skipped])
    print_rows("Bare and full scene", table.ratio_in_words(report))
    print_origin(report, files)


def accuracy(options: argparse.Namespace) -> int:
    def measure(scene, progress):
        if isinstance(scene, Scene):
            return report.measure(scene, progress, quick=options.quick)
        return train_accuracy.measure(scene, progress)

    def write_csv(found, file: Path) -> None:
        of_train = isinstance(found, train_accuracy.TrainReport)
        (train_accuracy if of_train else accuracy_table).write_csv(found, file)

    def draw(found):
        of_train = isinstance(found, train_accuracy.TrainReport)
        return train_accuracy.picture(found) if of_train else work_precision.work_precision(found)

    return report_of(options, "accuracy", measure, write_csv, draw, _print_accuracy)


def _print_accuracy_of_train(report, files: list[Path]) -> None:
    title = f"{report.title}: numbers, and how they change with one setting finer in all meshes"
    print_table(title, train_accuracy.headings(report), train_accuracy.table_rows(report))
    if report.failures:
        print_rows("Not run", [(name, reason, "") for name, reason in report.failures])
    print_origin(report, files)


def _print_accuracy(report, files: list[Path]) -> None:
    if isinstance(report, train_accuracy.TrainReport):
        _print_accuracy_of_train(report, files)
        return
    title = f"{report.scene.title}: each setting's error, the others at {report.fine.words}"
    print_table(title, accuracy_table.headings(report), accuracy_table.table_rows(report))
    print_table(
        "Combinations of settings, and cheaper models; * on the Pareto front",
        accuracy_table.whole_headings(report),
        accuracy_table.whole_rows(report),
    )
    print_rows("Result", [("", accuracy_table.in_one_sentence(report), "")])
    remarks = *accuracy_table.remarks(report), accuracy_table.timed(report)
    print_rows("Remarks", [("", remark, "") for remark in remarks])
    if report.failures:
        print_rows("Not run", [(name, reason, "") for name, reason in report.failures])
    print_origin(report, files)


def scenes_to_measure(options, command: str) -> list[tuple[Any, Path]]:
    """The scene and the directory of a command that measures times; of a train those of its stages of two gears, each
    by itself, or the train where `gears accuracy` measures meshes that are computed together. Raises SceneError under
    mpirun, and as `checked_model` does."""
    scene = load_scene_or_train(options.scene)
    if isinstance(scene, Scene):
        found = [(checked_model(options.scene).scene, options.output or Path("results") / scene.name)]
    elif command == "accuracy" and not scene.alone:
        found = [(scene, options.output or Path("results") / scene.name)]
    else:
        found = _stages(scene, options, command)
    for _, directory in found:
        check_writable(directory, f"{command}.csv", f"{command}.png")
    if communicator() is not None:
        raise SceneError(f"gears {command} {NO_TIMES}")
    if any(isinstance(each, Scene) and each.accuracy.target is not None for each, _ in found):
        raise SceneError(f"gears {command} takes settings as they stand: leave accuracy.target out.")
    return found


def _stages(train, options, command: str) -> list[tuple[Scene, Path]]:
    """The pairs of a train that are computed by themselves, and a folder for each; the standard error says so."""
    alone = [train.meshes[number] for number in train.alone]
    if not alone:
        raise SceneError(
            f"gears {command} takes stages of two gears, each by itself; the meshes of this train are computed together"
            f" ({', '.join(train.together)}), whose effects are not measured yet: make a scene of one of its pairs."
        )
    coupled = ", ".join(train.together)
    left = f" Left out, since their meshes are computed together: {coupled}." if coupled else ""
    if not options.quiet:
        said = "Each stage of two gears by itself, under its torque: shafts between them are rigid."
        print(f"{said}{left}", file=sys.stderr)
    directory = options.output or Path("results") / train.name
    return [(mesh.scene, directory / mesh.name) for mesh in alone]


def report_of(options, command: str, measure: Callable, write_csv: Callable, draw: Callable, tell: Callable) -> int:
    """Carry a command out that measures times: `measure(scene, progress)` makes the report, `write_csv` and `draw` its
    files as in `write_report`, `tell(report, files)` prints it. Returns the exit code."""
    undrawn = False
    for scene, directory in scenes_to_measure(options, command):
        with closing(shown_progress(options.quiet)) as progress:
            report = measure(scene, progress)
        files = write_report(report, directory, command, write_csv, draw)
        undrawn |= len(files) < 2
        if not options.quiet:
            tell(report, files)
    return WITHOUT_SOMETHING if undrawn else 0


def write_report(report, directory: Path, name: str, write_csv: Callable, draw: Callable) -> list[Path]:
    """Write `name`.csv by `write_csv(report, file)`, then `name`.png, the figure `draw(report)`; return the files."""
    written = write_whole(directory / f"{name}.csv", lambda path: write_csv(report, path))
    drawn = after_result(written, "picture", lambda: save_figures({f"{name}.png": draw(report)}, directory))
    return [written, *(drawn or [])]


def print_origin(report, files: list[Path]) -> None:
    """The end of a report: what it was measured on, and its files."""
    print_rows("Measured on", [(name, words, "") for name, words in report.machine.items()])
    print_rows("Files", [("", str(file), "") for file in files])
