"""What several commands share: exit codes, names of files, arguments, and the way to their work."""

import argparse
from collections.abc import Callable
from pathlib import Path
from pkgutil import resolve_name

from fenics_gears.errors import SceneError
from fenics_gears.system.memory import size_in_bytes

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
CURVES_FILE = "curves.csv"
REPORT_FILE = "report.html"
PICTURE_FILE = "stress.png"
ANIMATION_FILE = "stress.gif"
# What a long run has recorded so far, removed when it has written RUN_FILE.
JOURNAL = f"{RUN_FILE}.part"


def later(place: str) -> Callable[[argparse.Namespace], int]:
    """The function at `place`, "module:function", whose module is loaded when it is called: to say what a command takes
    needs none of what it does."""

    def carried_out(options: argparse.Namespace) -> int:
        return resolve_name(place)(options)

    return carried_out


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


def add_run_argument(command) -> None:
    """The argument RUN of a command that reads a finished run."""
    command.add_argument("run", type=Path, metavar="RUN", help="folder of a run or its run.nc")
