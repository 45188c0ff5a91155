"""What several commands do: start mpirun, read options, show progress, write files."""

import argparse
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterable
from importlib import import_module
from math import inf
from pathlib import Path
from types import ModuleType
from typing import Any

from fenics_gears.errors import SceneError, Value, attempted
from fenics_gears.inputs import units
from fenics_gears.system.console import on_terminal, printable
from fenics_gears.system.output import check_writable
from fenics_gears.system.progress import BarProgress, LineProgress, Progress, SilentProgress

from ..shared import INTERRUPTED, NO_MEANING


def under_mpirun(options: argparse.Namespace, arguments: list[str]) -> int:
    """The command of these arguments under mpirun, with --output and --quiet as they are."""
    mpirun = shutil.which("mpirun")
    if mpirun is None:
        raise SceneError("There is no mpirun on PATH. Install Open MPI or MPICH, or leave --processes out.")
    command = [mpirun, "-n", str(options.processes)]
    if options.processes > (os.cpu_count() or 1):
        command.append("--oversubscribe")
    # -P: a file of the user's folder that is called like a module does not take its place.
    command += [sys.executable, "-P", "-m", "fenics_gears", *arguments]
    command += ["--output", str(options.output)] if options.output is not None else []
    command += ["--quiet"] if options.quiet else []
    paths = os.pathsep.join([str(Path(__file__).parents[3]), *filter(None, [os.environ.get("PYTHONPATH")])])
    interrupted: list[int] = []
    # Ctrl-C reaches mpirun too, which ends its processes and itself; to kill it meanwhile would leave them behind. It
    # takes Ctrl-C even where a shell has this process ignore it.
    before = signal.signal(signal.SIGINT, lambda number, frame: interrupted.append(number))
    try:
        code = subprocess.Popen(command, env=os.environ | {"PYTHONPATH": paths}).wait()
    finally:
        signal.signal(signal.SIGINT, before)
    if not interrupted:
        return code
    print("Interrupted. The cases that were done are kept; the same command goes on from there.", file=sys.stderr)
    return INTERRUPTED


def number_of_option(option: str, text: str, unit: str, low: float = 0.0, high: float = inf) -> float:
    """The number, in `unit`, of a quantity that an option gives in any unit of its kind. Raises SceneError for another
    kind and for a number beyond `low` to `high`; without `high` it must be greater than zero."""
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


def after_result(kept: Path, what: str, carry_out: Callable[[], Value]) -> Value | None:
    """What `carry_out` makes of a result that is kept in a file already; None where it fails, which the error output
    says."""
    said: dict[str, str] = {}
    made = attempted(said, what, carry_out)
    if said:
        print(printable(f"{said['warnings']}. The result is kept: {kept}"), file=sys.stderr)
    return made


def print_files(files: Iterable[Path], quiet: bool) -> None:
    """Print the files that a command wrote, a line each, unless `quiet`."""
    if not quiet:
        for file in files:
            print(printable(str(file)))


def worth(result: Any, file: Path) -> int:
    """NO_MEANING, with the reason in words, for a result that has none."""
    from fenics_gears.results import validity

    worthless = [said for said in result.attrs.get("warnings", "").splitlines() if validity.NO_MEANING in said]
    if worthless:
        print(f"{file}: {worthless[0]}", file=sys.stderr)
    return NO_MEANING if worthless else 0
