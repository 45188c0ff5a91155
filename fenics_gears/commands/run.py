"""``gears run SCENE``: run a scene; write run.nc and pictures."""

import argparse
import gc
import sys
from collections.abc import Sequence
from pathlib import Path

from fenics_gears.errors import ComputationError
from fenics_gears.show import FACE_PICTURE_FILES, PICTURE_FILES
from fenics_gears.system.job import Job, led
from fenics_gears.system.progress import Interruption

from .shared import (
    INTERRUPTED,
    JOURNAL,
    NO_MEANING,
    RUN_FILE,
    add_memory_argument,
    add_output_argument,
    add_scene_argument,
    checked_model_and_directory,
    plots,
    shown_progress,
)


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("run", parents=[shared])
    add_scene_argument(command)
    add_output_argument(command)
    command.add_argument(
        "--no-pictures", action="store_true", help="write run.nc without pictures; `gears plot` can draw them later"
    )
    add_memory_argument(command)
    command.set_defaults(command=run)


def run(options: argparse.Namespace) -> int:
    return led(lambda job: _run(options, job))


def _run(options: argparse.Namespace, job: Job | None) -> int:
    model, directory = checked_model_and_directory(options, RUN_FILE, *PICTURE_FILES, *FACE_PICTURE_FILES)
    from fenics_gears.results.journal import Place, is_journal
    from fenics_gears.simulation.simulate import simulate

    # What imports have made stays: the search for garbage need not look at it.
    gc.freeze()
    journal = Place(directory / JOURNAL, options.scene.parent)
    with Interruption(shown_progress(options.quiet)) as interruption:
        try:
            dataset = simulate(model, progress=interruption, job=job, journal=journal)
        except ComputationError as error:
            if getattr(error, "partial", None) is None or not error.partial.sizes["time"]:
                # Nothing was done that an earlier result in the directory should give way to.
                if is_journal(journal.directory):
                    said = f"What was done until then is in {journal.directory}; `gears plot {directory}` draws it."
                    raise ComputationError(f"{error}\n{said}") from error
                raise
            file = _save(error.partial, directory, interruption)
            raise ComputationError(f"{error}\n{_kept(error.partial, file)}") from error
        files = [_save(dataset, directory, interruption)]
        complete = bool(dataset.attrs.get("complete", 1))
        last_words = "" if complete else f"Interrupted. {_kept(dataset, files[0])}"
        if complete and not options.no_pictures:
            try:
                interruption.heed()
                interruption.stage("draw pictures")
                files += plots().draw_run(dataset, directory)
            except KeyboardInterrupt:
                draws = f"`gears plot {directory}` draws them"
                last_words = f"Interrupted while the pictures were drawn. The result is whole: {files[0]}; {draws}."
    if not options.quiet:
        _print_summary(model, dataset, files, interruption.finished)
    if last_words:
        print(last_words, file=sys.stderr)
        return INTERRUPTED
    from fenics_gears.results import validity

    worthless = [said for said in dataset.attrs.get("warnings", "").splitlines() if validity.NO_MEANING in said]
    if worthless:
        print(f"{files[0]}: {worthless[0]}", file=sys.stderr)
    return NO_MEANING if worthless else 0


def _save(dataset, directory: Path, interruption: Interruption) -> Path:
    """Write the result where no Ctrl-C can lose it, and return its file."""
    from fenics_gears import results
    from fenics_gears.results.journal import remove
    from fenics_gears.system.output import write_whole

    interruption.ignore()
    file = write_whole(directory / RUN_FILE, lambda path: results.save(dataset, path))
    remove(directory / JOURNAL)
    for picture in (*PICTURE_FILES, *FACE_PICTURE_FILES):
        # Those of an earlier run would be taken for pictures of this one.
        (directory / picture).unlink(missing_ok=True)
    return file


def _kept(dataset, file: Path) -> str:
    steps = max(dataset.sizes["time"] - 1, 0)
    return f"What was done until then is kept, marked incomplete: {file}, {steps or 'none'} of the run's steps"


def _print_summary(model, dataset, files: Sequence[Path], stages: Sequence[tuple[str, float]]) -> None:
    from fenics_gears.results.summary import summary_rows, what_is_there
    from fenics_gears.system.console import print_rows

    first = []
    if not dataset.attrs.get("complete", 1) and dataset.sizes["time"]:
        there = what_is_there(dataset, model.steps, model.scene.motion.mesh_cycles)
        first = [("INTERRUPTED", f"the run was stopped before its end: {there}", "")]
    print_rows(model.scene.title, [*first, *summary_rows(dataset, stages)])
    print_rows("Files", [("", str(file), "") for file in files])
