"""A run whose result is kept whatever ends it, its pictures, and what is said of it."""

from __future__ import annotations

import argparse
import gc
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from fenics_gears import results
from fenics_gears.errors import FAILED, ComputationError
from fenics_gears.model.model import Model
from fenics_gears.results.journal import JournalPlace
from fenics_gears.results.summary import Row, summary_rows, what_is_there
from fenics_gears.runs.simulate import simulate
from fenics_gears.show import FACE_PICTURE_FILES, PICTURE_FILES
from fenics_gears.system.console import print_rows
from fenics_gears.system.job import Job
from fenics_gears.system.output import write_whole
from fenics_gears.system.progress import Interruption

from ..shared import INTERRUPTED, JOURNAL, RUN_FILE, WITHOUT_SOMETHING
from .shared import after_result, plots, shown_progress, worth


def run_and_keep(model: Model, directory: Path, options: argparse.Namespace, job: Job | None) -> int:
    """Run a model, write its result and pictures into `directory`, print its summary; return the exit code."""
    # What imports have made stays: the search for garbage need not look at it.
    gc.freeze()
    journal = JournalPlace(directory / JOURNAL, options.scene.parent)
    with Interruption(shown_progress(options.quiet)) as interruption:
        kept = _Kept(directory, interruption)
        try:
            kept.keep_all(simulate(model, progress=interruption, job=job, journal=journal, keep=kept.keep))
            last_words = "" if kept.complete else f"Interrupted. {_incomplete(kept)}"
        except ComputationError as error:
            if getattr(error, "partial", None) is None or not error.partial.sizes["time"]:
                # Nothing was done that should replace an earlier result in the directory.
                if journal.file.is_file():
                    said = f"What was done until then is in {journal.file}; `gears plot {directory}` draws it."
                    raise ComputationError(f"{error}\n{said}") from error
                raise
            kept.keep(error.partial)
            raise ComputationError(f"{error}\n{_incomplete(kept)}") from error
        except KeyboardInterrupt:
            if kept.dataset is None:
                raise
            missing = "without the stages after the march"
            last_words = f"Interrupted after the march. The result is whole, {missing}: {kept.file}."
        pictures: list[Path] | None = []
        if not last_words and not options.no_pictures:
            try:
                interruption.heed()
                interruption.stage("draw pictures")
                pictures = after_result(kept.file, "pictures", lambda: plots().draw_run(kept.dataset, directory))
            except KeyboardInterrupt:
                draws = f"`gears plot {directory}` draws them"
                last_words = f"Interrupted while the pictures were drawn. The result is whole: {kept.file}; {draws}."
    rows = after_result(kept.file, "summary", lambda: _summary(model, kept.dataset, interruption.finished))
    if not options.quiet:
        _print(model.scene.title, rows or [], [kept.file, *(pictures or [])])
    if last_words:
        print(last_words, file=sys.stderr)
        return INTERRUPTED
    failed = FAILED in kept.dataset.attrs or pictures is None or rows is None
    return worth(kept.dataset, kept.file) or (WITHOUT_SOMETHING if failed else 0)


class _Kept:
    """The result of a run and its file, written where no Ctrl-C can lose it."""

    def __init__(self, directory: Path, interruption: Interruption):
        self.dataset: Any = None
        self.file = directory / RUN_FILE
        self._written: set[str] = set()
        self._interruption = interruption

    @property
    def complete(self) -> bool:
        return bool(self.dataset.attrs.get("complete", 1))

    def keep(self, dataset) -> None:
        """Write what the march made, before anything follows it; after an interrupted march nothing does."""
        self._save(dataset)
        if self.complete:
            self._interruption.heed()

    def keep_all(self, dataset) -> None:
        """Write the result again where something was added to it."""
        if _names(dataset) != self._written:
            self._save(dataset)

    def _save(self, dataset) -> None:
        self._interruption.ignore()
        self.dataset = dataset
        self._written = _names(dataset)
        directory = self.file.parent
        write_whole(self.file, lambda path: results.save(dataset, path))
        with suppress(OSError):
            (directory / JOURNAL).unlink()
        for picture in (*PICTURE_FILES, *FACE_PICTURE_FILES):
            # Those of an earlier run would be taken for pictures of this one.
            (directory / picture).unlink(missing_ok=True)


def _names(dataset) -> set[str]:
    return {*dataset.variables, *dataset.attrs}


def _incomplete(kept: _Kept) -> str:
    steps = max(kept.dataset.sizes["time"] - 1, 0)
    return f"What was done until then is kept, marked incomplete: {kept.file}, {steps or 'none'} of the run's steps"


def _summary(model, dataset, stages: Sequence[tuple[str, float]]) -> list[Row]:
    first = []
    if not dataset.attrs.get("complete", 1) and dataset.sizes["time"]:
        there = what_is_there(dataset, model.steps, model.scene.motion.mesh_cycles)
        first = [("INTERRUPTED", f"the run was stopped before its end: {there}", "")]
    return [*first, *summary_rows(dataset, stages)]


def _print(title: str, rows: Sequence[Row], files: Sequence[Path]) -> None:
    print_rows(title, rows)
    print_rows("Files", [("", str(file), "") for file in files])
