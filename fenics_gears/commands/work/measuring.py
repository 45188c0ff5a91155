"""What the commands share that measure times of a scene's variants."""

from collections.abc import Callable
from contextlib import closing
from pathlib import Path

from fenics_gears.errors import SceneError
from fenics_gears.show.plots import save_figures
from fenics_gears.system.console import print_rows
from fenics_gears.system.job import communicator
from fenics_gears.system.output import written_aside

from ..shared import WITHOUT_SOMETHING
from .scenes import checked_model_and_directory
from .shared import after_result, shown_progress

NO_TIMES = "measures times, which mean nothing while processes share the machine. Start gears without mpirun."


def scene_to_measure(options, command: str):
    """The scene and the directory of a command that measures times. Raises SceneError under mpirun, and as
    `checked_model` does."""
    model, directory = checked_model_and_directory(options, f"{command}.csv", f"{command}.png")
    if communicator() is not None:
        raise SceneError(f"gears {command} {NO_TIMES}")
    if model.scene.accuracy.target is not None:
        raise SceneError(f"gears {command} takes settings as they stand: leave accuracy.target out.")
    return model.scene, directory


def report_of(options, command: str, measure: Callable, write_csv: Callable, draw: Callable, tell: Callable) -> int:
    """Carry a command out that measures times: `measure(scene, progress)` makes the report, `write_csv` and `draw` its
    files as in `write_report`, `tell(report, files)` prints it. Returns the exit code."""
    scene, directory = scene_to_measure(options, command)
    with closing(shown_progress(options.quiet)) as progress:
        report = measure(scene, progress)
    files = write_report(report, directory, command, write_csv, draw)
    if not options.quiet:
        tell(report, files)
    return 0 if len(files) > 1 else WITHOUT_SOMETHING


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
