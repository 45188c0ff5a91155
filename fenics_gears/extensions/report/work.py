"""What ``gears report`` does."""

import argparse
from collections.abc import Mapping
from contextlib import closing
from dataclasses import dataclass
from math import nan
from os.path import exists, isdir
from pathlib import Path
from typing import Any

from fenics_gears import OVERALL, SceneError, carried_train
from fenics_gears.command_line import (
    CASES,
    JOURNAL,
    REPORT_FILE,
    RUN_FILE,
    STUDY_FILE,
    check_writable,
    loaded_run,
    print_files,
    run_or_journal,
    shown_progress,
    write_whole,
)
from fenics_gears.many_runs import load_combined
from fenics_gears.pages import Page, rendered
from fenics_gears.shown import ShownRun, stored_index

from .layout import laid_out, load_layout
from .run_page import run_page
from .study_page import study_page
from .train_page import mesh_runs, train_page

ENDINGS = (".html", ".htm")


def report(options: argparse.Namespace) -> int:
    file, is_study = run_or_study_file(options.run)
    output = output_file(options.output, file, is_study)
    _check(options, file, output, is_study)
    # Nothing is drawn for a layout that is wrong.
    layout = None if options.layout is None else load_layout(options.layout)
    if is_study and layout is not None and layout.limits:
        raise SceneError(f"{options.layout}: [limits] are of a run; this is a study. Leave them out, or name a case.")
    with closing(shown_progress(options.quiet)) as progress:
        written = (_study if is_study else _run)(options, file, _Writing(output, layout), progress)
    print_files(written, options.quiet)
    return 0


@dataclass(frozen=True)
class _Writing:
    """Where a page goes, and its layout, None for the usual one."""

    output: Path
    layout: Any

    def write(self, page: Page, numbers: Mapping[str, Any], micrometres: Any = nan) -> Path:
        """Write the page; `numbers`: of its result, `micrometres`: of one radian of the wheel."""
        shown = page if self.layout is None else laid_out(page, self.layout, numbers, micrometres)
        text = rendered(shown)
        return write_whole(self.output, lambda path: path.write_text(text, encoding="utf-8"))


def run_or_study_file(path: Path) -> tuple[Path, bool]:
    """The result's file that is meant, and whether it is a study's. Raises SceneError where there is none."""
    run = run_or_journal(path)
    if exists(run):
        return run, run.name == STUDY_FILE
    if isdir(path):
        if (path / STUDY_FILE).is_file():
            return path / STUDY_FILE, True
        if (path / CASES).is_dir():
            raise SceneError(f"{path}: there is no {STUDY_FILE} yet beside its cases; run the study again.")
        missing = f"there is neither {RUN_FILE} nor {STUDY_FILE} in it"
    else:
        missing = "there is no such file or directory"
    raise SceneError(f"{path}: {missing}. A report is on what `gears run` or `gears study` wrote.")


def output_file(asked: Path | None, file: Path, is_study: bool) -> Path:
    """The page's file: as asked for, in the directory asked for, or in that of the result; a study's case has its own
    name."""
    own = file.name in (RUN_FILE, STUDY_FILE, JOURNAL)
    name = REPORT_FILE if own else f"{file.stem}.html"
    if asked is None:
        return file.parent / name
    if isdir(asked) or not asked.suffix:
        return asked / name
    if asked.suffix.lower() not in ENDINGS:
        raise SceneError(f"{asked}: the report is an .html file; give --output such a name, or a directory")
    return asked


def _check(options: argparse.Namespace, file: Path, output: Path, is_study: bool) -> None:
    check_writable(output.parent, output.name)
    if is_study and (options.effects or options.at is not None):
        raise SceneError("--effects and --at are for a run; this is a study. Leave them out, or name one of its cases.")


def _run(options: argparse.Namespace, file: Path, writing: _Writing, progress) -> list[Path]:
    dataset = loaded_run(file, trains=True)
    asked = {"at": options.at, "stress": not options.no_stress}
    if OVERALL in dataset:
        return _train(options, file, dataset, writing, progress, asked)
    run = ShownRun(dataset, file, **asked)
    if run.steps:
        _check_time(run)
    written = []
    if options.effects:
        if run.scene is None:
            raise SceneError(f"{file}: the scene in it is none of this version. Run the scene again.")
        written = options.effects(run.scene, file.parent, progress)
    return [*written, writing.write(run_page(run, progress), dataset.attrs, run.micrometres)]


def _train(options, file: Path, dataset, writing: _Writing, progress, asked: Mapping[str, Any]) -> list[Path]:
    train = carried_train(dataset)
    runs = mesh_runs(dataset, train, file, **asked)
    for run in runs.values():
        _check_time(run)
    written = options.effects(train, file.parent, progress) if options.effects else []
    numbers = {str(name): of.values for name, of in dataset.variables.items() if of.dims == ("mesh",)}
    page = train_page(dataset, train, runs, file, progress)
    return [*written, writing.write(page, numbers | dataset.attrs, 1e3 * numbers["base_radius_wheel"])]


def _check_time(run: ShownRun) -> None:
    """Raises SceneError where a time is asked for that the run has not stored."""
    if run.at is not None:
        stored_index(run.dataset, run.at)


def _study(options: argparse.Namespace, file: Path, writing: _Writing, progress) -> list[Path]:
    return [writing.write(study_page(loaded_run(file, load_combined), file, writing.output, progress), {})]
