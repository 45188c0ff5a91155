"""What ``gears accuracy`` and ``gears effects`` do."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial
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

from . import train_accuracy, train_effects, train_rows
from .accuracy import report, work_precision
from .accuracy import table as accuracy_table
from .effect_costs import measured, table
from .effect_costs.picture import effect_costs

NO_TIMES = "measures times, which mean nothing while processes share the machine. Start gears without mpirun."


@dataclass(frozen=True)
class Measurement:
    """A command on one scene: `measure(scene, progress)` makes its report, `write_csv(report, file)` and
    `draw(report)` the files of it, and `tell(report)` prints it."""

    measure: Callable
    write_csv: Callable
    draw: Callable
    tell: Callable


def effects(options: argparse.Namespace) -> int:
    return report_of(options, "effects", EFFECTS, _effects_of_train())


def effects_of(scene: Any, directory: Path, progress) -> list[Path]:
    """The files of ``gears effects`` on the scene of a pair or a train, written into a directory. Raises SceneError
    under mpirun."""
    found, _ = _parts(scene, directory)
    _check(found, "effects", "--effects")
    written: list[Path] = []
    for each, own in found:
        measurement = EFFECTS if isinstance(each, Scene) else _effects_of_train()
        written += write_report(measurement, measurement.measure(each, progress), own, "effects")
    return written


def _effects_of_train() -> Measurement:
    return replace(TRAIN, measure=train_effects.measure)


def _tell_effects(report) -> None:
    heading = f"{report.scene.title}: effects, one more than the bare scene and one less than all"
    print_table(heading, table.headings(report), table.table_rows(report))
    print_rows("Remarks", [(f"[{number}]", remark, "") for number, remark in enumerate(table.remarks(report), 1)])
    if report.skipped:
        print_rows("Not run", [(each.name, each.reason, "") for each in report.skipped])
    print_rows("Bare and full scene", table.ratio_in_words(report))


def accuracy(options: argparse.Namespace) -> int:
    of_pair = replace(ACCURACY, measure=partial(report.measure, quick=options.quick))
    of_train = replace(TRAIN, measure=partial(train_accuracy.measure, quick=options.quick))
    return report_of(options, "accuracy", of_pair, of_train)


def _tell_train(report) -> None:
    print_table(f"{report.title}: {report.what}", train_rows.headings(report), train_rows.table_rows(report))
    if report.left:
        print_rows("Not run", [(name, reason, "") for name, reason in report.left])


def _tell_accuracy(report) -> None:
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


EFFECTS = Measurement(measured.measure, table.write_csv, effect_costs, _tell_effects)
ACCURACY = Measurement(report.measure, accuracy_table.write_csv, work_precision.work_precision, _tell_accuracy)
TRAIN = Measurement(train_accuracy.measure, train_rows.write_csv, train_rows.picture, _tell_train)


def scenes_to_measure(options, command: str) -> list[tuple[Any, Path]]:
    """The scenes and directories of a command that measures times, see `_parts`. Raises SceneError under mpirun, and as
    `checked_model` does."""
    scene = load_scene_or_train(options.scene)
    directory = options.output or Path("results") / scene.name
    found, said = _parts(checked_model(options.scene).scene if isinstance(scene, Scene) else scene, directory)
    if said and not options.quiet:
        print(said, file=sys.stderr)
    _check(found, command, f"gears {command}")
    return found


def _parts(scene: Any, directory: Path) -> tuple[list[tuple[Any, Path]], str]:
    """The scene of a pair or a train, and the directory of what is measured of it; of a train those of its stages of
    two gears, each by itself, and words on it, or the train where all its meshes are computed together."""
    if isinstance(scene, Scene) or not scene.alone:
        return [(scene, directory)], ""
    coupled = ", ".join(scene.together)
    left = f" Left out, since their meshes are computed together: {coupled}." if coupled else ""
    said = "Each stage of two gears by itself, under its torque: shafts between them are rigid."
    alone = [scene.meshes[number] for number in scene.alone]
    return [(mesh.scene, directory / mesh.name) for mesh in alone], f"{said}{left}"


def _check(found: list[tuple[Any, Path]], command: str, called: str) -> None:
    """Raises SceneError where the files of a `command`, as it was `called`, cannot be written, under mpirun, and where
    settings are not given."""
    for _, each in found:
        check_writable(each, f"{command}.csv", f"{command}.png")
    if communicator() is not None:
        raise SceneError(f"{called} {NO_TIMES}")
    scenes = [
        own
        for each, _ in found
        for own in ([each] if isinstance(each, Scene) else [mesh.scene for mesh in each.meshes])
    ]
    if any(each.accuracy.target is not None for each in scenes):
        raise SceneError(f"{called} takes settings as they stand: leave accuracy.target out.")


def report_of(options, command: str, of_pair: Measurement, of_train: Measurement) -> int:
    """Carry a command out that measures times. Returns the exit code."""
    undrawn = False
    for scene, directory in scenes_to_measure(options, command):
        own = of_pair if isinstance(scene, Scene) else of_train
        with closing(shown_progress(options.quiet)) as progress:
            found = own.measure(scene, progress)
        files = write_report(own, found, directory, command)
        undrawn |= len(files) < 2
        if not options.quiet:
            own.tell(found)
            print_rows("Measured on", [(name, words, "") for name, words in found.machine.items()])
            print_rows("Files", [("", str(file), "") for file in files])
    return WITHOUT_SOMETHING if undrawn else 0


def write_report(own: Measurement, found, directory: Path, name: str) -> list[Path]:
    """Write `name`.csv and `name`.png of a report; return the files."""
    written = write_whole(directory / f"{name}.csv", lambda path: own.write_csv(found, path))
    drawn = after_result(written, "picture", lambda: save_figures({f"{name}.png": own.draw(found)}, directory))
    return [written, *(drawn or [])]
