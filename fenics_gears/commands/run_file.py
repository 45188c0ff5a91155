"""The file of a finished run that a command is given."""

from __future__ import annotations

from pathlib import Path

from fenics_gears.commands.report import CASES, STUDY_FILE
from fenics_gears.commands.run import RUN_FILE
from fenics_gears.errors import ComputationError, SceneError


def run_file(path: Path) -> Path:
    """The result that is meant by a run's directory or its file. Raises SceneError for what is no run, a study among others."""
    if path.name == STUDY_FILE or path.is_dir() and not (path / RUN_FILE).is_file() and ((path / STUDY_FILE).is_file() or (path / CASES).is_dir()):
        directory = path if path.is_dir() else path.parent
        raise SceneError(
            f"{path} is a study, of many runs. `gears report {directory}` writes a page of pictures on all of them; "
            f"of a single case this command takes the file, {directory / CASES}/NAME.nc."
        )
    file = path / RUN_FILE if path.is_dir() else path
    if not file.is_file():
        raise SceneError(f"{file}: there is no such file. A run is the directory that `gears run` wrote, or the {RUN_FILE} in it.")
    return file


def loaded_run(file: Path):
    """The dataset of a run's file. Raises SceneError where it cannot be read: nothing was computed, the call is wrong."""
    from fenics_gears import results

    try:
        return results.load(file)
    except ComputationError as error:
        raise SceneError(str(error)) from error
