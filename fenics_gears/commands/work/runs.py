"""The runs that commands name."""

import sys
from collections.abc import Callable
from os.path import exists, isdir
from pathlib import Path

from fenics_gears import results
from fenics_gears.errors import ComputationError, SceneError
from fenics_gears.results.layout import OVERALL
from fenics_gears.simulation.unfinished import unfinished

from ..shared import CASES, JOURNAL, RUN_FILE, STUDY_FILE


def run_file(path: Path) -> Path:
    """The file of the run that is meant by its directory or the file itself. Raises SceneError for what is no run, a
    study among others."""
    has_cases = isdir(path) and ((path / STUDY_FILE).is_file() or (path / CASES).is_dir())
    if path.name == STUDY_FILE or has_cases and not (path / RUN_FILE).is_file():
        directory = path if isdir(path) else path.parent
        raise SceneError(
            f"{path} is a study. `gears report {directory}` writes a page on all its runs; of a single case this"
            f" command takes the file, {directory / CASES}/NAME.nc."
        )
    file = run_or_journal(path)
    if not exists(file):
        raise SceneError(f"{file}: there is no such file. A run is the directory that `gears run` wrote.")
    if file.suffix == ".toml":
        raise SceneError(f"{file} is a scene, this command takes a run: `gears run {file}` makes one.")
    return file


def run_or_journal(path: Path) -> Path:
    """The file of a run in a directory or, where there is none, the journal of one that has not ended; any other path
    as it is."""
    if not isdir(path):
        return path
    return path / (JOURNAL if not (path / RUN_FILE).is_file() and (path / JOURNAL).is_file() else RUN_FILE)


def loaded_run(file: Path, load: Callable | None = None, trains: bool = False):
    """The dataset of a run's file, by `load` where it is another kind of result. Where the run has not ended it is that
    of its journal, and the standard error says what is missing. Raises SceneError where it cannot be read, and for the
    run of a train unless the command takes `trains`."""
    try:
        if file.name == JOURNAL:
            dataset = unfinished(file)
            print(f"{file}: {dataset.attrs['warnings'].splitlines()[0]}", file=sys.stderr)
            return dataset
        dataset = (load or results.load)(file)
    except ComputationError as error:
        raise SceneError(str(error)) from error
    if load is None and not trains and of_train(dataset):
        raise SceneError(f"{file} is the run of a train, which this command does not take. {stages_beside(file)}")
    return dataset


def of_train(dataset) -> bool:
    """Whether a run is that of a train."""
    return OVERALL in dataset


def stages_beside(file: Path) -> str:
    """Which runs of a train's stages are beside its own, in words."""
    stages = [str(each.parent) for each in sorted(file.parent.glob(f"*/{RUN_FILE}"))]
    if not stages:
        return "It takes the run of a stage of two gears, which stands in a folder of its own; this train has none."
    return f"It takes the run of a stage of two gears: {', '.join(stages)}."
