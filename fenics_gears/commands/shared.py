"""What several commands share: exit codes, arguments, the files that they read, and their progress."""

import argparse
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterable
from importlib import import_module
from math import inf
from os.path import exists, isdir
from pathlib import Path
from types import ModuleType

from fenics_gears.errors import ComputationError, Found, SceneError, attempted
from fenics_gears.system.console import on_terminal, printable
from fenics_gears.system.memory import size_in_bytes
from fenics_gears.system.output import check_writable
from fenics_gears.system.progress import BarProgress, LineProgress, Progress, SilentProgress

# Exit codes that no error carries itself. The run came to its end, but jammed or came apart.
NO_MEANING = 4
# The result is whole and kept; something that follows it failed.
WITHOUT_SOMETHING = 5
INTERRUPTED = 130
# 128 + SIGPIPE, as a shell has it.
NOBODY_READS = 141

RUN_FILE = "run.nc"
STUDY_FILE = "study.nc"
CASES = "cases"
# What a long run has recorded so far, removed when it has written RUN_FILE.
JOURNAL = f"{RUN_FILE}.part"


def add_scene_argument(command) -> None:
    """The argument SCENE of a command's parser."""
    command.add_argument("scene", type=Path, metavar="SCENE", help="a scene file (TOML)")


def add_output_argument(
    command, default: str = "results/<name of the scene file>", what: str = "folder to write into", metavar: str = "DIR"
) -> None:
    """The option --output of a command that writes something; `default`: in words, for the help."""
    command.add_argument("-o", "--output", type=Path, metavar=metavar, help=f"{what} (default: {default})")


def add_memory_argument(command) -> None:
    """The option --memory of a command that runs scenes."""
    command.add_argument(
        "--memory", metavar="SIZE", default=argparse.SUPPRESS, type=_size,
        help='memory that a run may take, such as "8 GB" (default: 0.6 of what is free, shared by the processes of an '
            'MPI job on a machine)',
    )  # fmt: skip


def add_processes_argument(command) -> None:
    """The option --processes of a command that computes many cases."""
    command.add_argument(
        "-n",
        "--processes",
        type=positive_count,
        metavar="N",
        help="start mpirun with N processes, which share the cases",
    )


def under_mpirun(options: argparse.Namespace, arguments: list[str]) -> int:
    """The command of these arguments under mpirun, with --output and --quiet as they are."""
    mpirun = shutil.which("mpirun")
    if mpirun is None:
        raise SceneError("There is no mpirun on PATH. Install Open MPI or MPICH, or leave --processes out.")
    command = [mpirun, "-n", str(options.processes)]
    if options.processes > (os.cpu_count() or 1):
        command.append("--oversubscribe")
    command += [sys.executable, "-m", "fenics_gears", *arguments]
    command += ["--output", str(options.output)] if options.output is not None else []
    command += ["--quiet"] if options.quiet else []
    interrupted: list[int] = []
    # Ctrl-C reaches mpirun too, which ends its processes and itself; to kill it meanwhile would leave them behind. It
    # takes Ctrl-C even where a shell has this process ignore it.
    before = signal.signal(signal.SIGINT, lambda number, frame: interrupted.append(number))
    try:
        code = subprocess.Popen(command).wait()
    finally:
        signal.signal(signal.SIGINT, before)
    if not interrupted:
        return code
    print("Interrupted. The cases that were done are kept; the same command goes on from there.", file=sys.stderr)
    return INTERRUPTED


def positive_count(text: str) -> int:
    """A whole number above zero, for argparse."""
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number above 0")
    return int(text)


def _size(text: str) -> str:
    try:
        size_in_bytes(text, "--memory", "8 GB")
    except SceneError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    return text


def number_of_option(option: str, text: str, unit: str, low: float = 0.0, high: float = inf) -> float:
    """The number, in `unit`, of a quantity that an option gives in any unit of its kind. Raises SceneError for another
    kind and for a number beyond `low` to `high`; without `high` it must be greater than zero."""
    from fenics_gears.inputs import units

    try:
        value, kind = units.quantity(text)
        factor, wanted = units.quantity(f"1 {unit}")
    except units.QuantityError as error:
        raise SceneError(f'{option} "{text}": {error}') from None
    number = value / factor
    if kind != wanted or not (low <= number <= high if high < inf else number > 0.0):
        limits = f"from {low:g} {unit} to {high:g} {unit}" if high < inf else f'greater than zero, such as "1 {unit}"'
        raise SceneError(f'{option} "{text}": allowed is {wanted} {limits}.')
    return number


def add_run_argument(command) -> None:
    """The argument RUN of a command that reads a finished run."""
    command.add_argument("run", type=Path, metavar="RUN", help="folder of a run or its run.nc")


def checked_model(path: Path):
    """The model of a scene file, its values, geometry and files found right. Raises SceneError and GeometryError."""
    from fenics_gears.scene.read import load_scene

    scene = load_scene(path)
    from fenics_gears.inputs.problem import placed
    from fenics_gears.model.model import model_of

    try:
        return model_of(scene)
    except SceneError as error:
        raise type(error)(placed(str(error), scene.written, str(path))) from error


def checked_model_and_directory(options, *names: str):
    """The model of a command's scene, and the directory to write into, which takes files of these names. Raises as
    `checked_model` does, and SceneError for the directory."""
    model = checked_model(options.scene)
    directory = options.output or Path("results") / model.scene.name
    check_writable(directory, *names, room=model.least_file_bytes if RUN_FILE in names else 0)
    return model, directory


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
    if not isdir(path) or path.name == JOURNAL:
        return path
    from fenics_gears.results.journal import is_journal

    return path / (JOURNAL if not (path / RUN_FILE).is_file() and is_journal(path / JOURNAL) else RUN_FILE)


def loaded_run(file: Path, load: Callable | None = None):
    """The dataset of a run's file, by `load` where it is another kind of result; of a run that has not ended that of
    its journal, and the standard error says what is missing. Raises SceneError where it cannot be read."""
    from fenics_gears import results

    try:
        if file.name == JOURNAL:
            from fenics_gears.simulation.unfinished import unfinished

            dataset = unfinished(file)
            print(f"{file}: {dataset.attrs['warnings'].splitlines()[0]}", file=sys.stderr)
            return dataset
        return (load or results.load)(file)
    except ComputationError as error:
        raise SceneError(str(error)) from error


def shown_progress(quiet: bool) -> Progress:
    """What shows a computation's progress on the standard error: bars on a terminal, lines elsewhere, nothing if
    `quiet`."""
    if quiet:
        return SilentProgress()
    if not on_terminal(sys.stderr):
        return LineProgress()
    from rich.console import Console

    return BarProgress(Console(stderr=True))


def plots(name: str = "plots") -> ModuleType:
    """The module of that name in `show`; matplotlib is imported without the lists of properties in its docstrings,
    which take a quarter of that time."""
    from matplotlib import artist

    properties = artist.kwdoc
    artist.kwdoc = lambda kind: ""
    try:
        return import_module(f"fenics_gears.show.{name}")
    finally:
        artist.kwdoc = properties


def file_to_write(options: argparse.Namespace, default: Path, what: str) -> Path:
    """The file of --output, or the default, which can be written; `what`: "the table", say. Raises SceneError for
    another ending than the default's, or where it cannot be written."""
    output = options.output or default
    if output.suffix != default.suffix:
        raise SceneError(f"{output}: {what} is a {default.suffix} file; give --output such a name.")
    check_writable(output.parent, output.name)
    return output


def after_result(kept: Path, what: str, carry_out: Callable[[], Found]) -> Found | None:
    """What `carry_out` makes of a result that is kept in a file already; None where it fails, which the error output
    says."""
    said: dict[str, str] = {}
    found = attempted(said, what, carry_out)
    if said:
        print(printable(f"{said['warnings']}. The result is kept: {kept}"), file=sys.stderr)
    return found


def print_files(files: Iterable[Path], quiet: bool) -> None:
    """Print the files that a command wrote, a line each, unless `quiet`."""
    if not quiet:
        for file in files:
            print(printable(str(file)))
