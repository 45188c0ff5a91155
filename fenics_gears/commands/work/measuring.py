"""What the commands share that measure times of a scene's variants."""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING

from fenics_gears.errors import SceneError
from fenics_gears.show.plots import save_figures
from fenics_gears.system.console import print_rows
from fenics_gears.system.job import communicator
from fenics_gears.system.output import check_writable, written_aside

from ..shared import WITHOUT_SOMETHING
from .scenes import checked_model_and_directory, train_in
from .shared import after_result, shown_progress

if TYPE_CHECKING:
    from fenics_gears.scene.data import Scene
    from fenics_gears.scene.train import TrainScene

NO_TIMES = "measures times, which mean nothing while processes share the machine. Start gears without mpirun."


def scenes_to_measure(options, command: str) -> list[tuple[Scene, Path]]:
    """The scene and the directory of a command that measures times; of a train those of its stages of two gears, each
    by itself. Raises SceneError under mpirun, and as `checked_model` does."""
    names = f"{command}.csv", f"{command}.png"
    train = train_in(options.scene)
    if train is None:
        model, directory = checked_model_and_directory(options, *names)
        found = [(model.scene, directory)]
    else:
        found = _stages(train, options, command)
        for _, directory in found:
            check_writable(directory, *names)
    if communicator() is not None:
        raise SceneError(f"gears {command} {NO_TIMES}")
    if any(scene.accuracy.target is not None for scene, _ in found):
        raise SceneError(f"gears {command} takes settings as they stand: leave accuracy.target out.")
    return found


def _stages(train: TrainScene, options, command: str) -> list[tuple[Scene, Path]]:
    """The pairs of a train that are computed by themselves, and a folder for each; the standard error says so."""
    alone = [train.meshes[number] for number in train.alone]
    coupled = [mesh.name for mesh in train.meshes if mesh not in alone]
    if not alone:
        raise SceneError(
            f"gears {command} takes stages of two gears, each by itself; the meshes of this train are computed together"
            f" ({', '.join(coupled)}), which is not measured yet: run it with finer settings, or make a scene of one of"
            " its pairs."
        )
    left = f" Left out, since they have gears in common: {', '.join(coupled)}." if coupled else ""
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
    written: list[Path] = []
    with written_aside(directory, written) as aside:
        write_csv(report, aside / f"{name}.csv")
    drawn = after_result(written[0], "picture", lambda: save_figures({f"{name}.png": draw(report)}, directory))
    return [*written, *(drawn or [])]


def print_origin(report, files: list[Path]) -> None:
    """The end of a report: what it was measured on, and its files."""
    print_rows("Measured on", [(name, words, "") for name, words in report.machine.items()])
    print_rows("Files", [("", str(file), "") for file in files])
