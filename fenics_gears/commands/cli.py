"""The command ``gears``. Logging is configured here and nowhere else; what the commands do is in ``commands``.

Exit codes:

* 0: done.
* 2: the scene or the call is wrong. Nothing is written.
* 3: the computation failed or cannot fit into memory. The steps computed are kept, marked incomplete.
* 4: the run ended with a result that has no meaning. It is kept, with the reason.
* 5: the result is complete and kept, but a later stage failed: proposals, factors, pictures, the summary. A
  warning says which.
* 130: interrupted by Ctrl-C. The steps computed are kept.
* 141: the standard output could not be written, as when the program that reads it closed the pipe.
"""

import argparse
import gc
import logging
import os
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from typing import NoReturn

from fenics_gears import __version__
from fenics_gears.errors import GearsError, MemoryEnded
from fenics_gears.inputs.problem import did_you_mean
from fenics_gears.system import environment
from fenics_gears.system.console import prepare_streams, printable
from fenics_gears.system.memory import MEMORY_VARIABLE
from fenics_gears.system.output import check_working_folder

from . import registry
from .shared import INTERRUPTED, NOBODY_READS

# Messages of argparse on a command and on options that there are not.
_NO_CHOICE = re.compile(r"argument COMMAND: invalid choice: '(.*)' \(choose from (.*)\)", re.DOTALL)
_UNKNOWN = "unrecognized arguments: "


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line (``sys.argv`` where none is given) and return the exit code."""
    if arguments is None:
        # DOLFINx would read them too: it takes -v for its own, and ends at a name that is no UTF-8.
        arguments = sys.argv[1:]
        sys.argv = ["gears"]
    prepare_streams()
    return _written(lambda: _in_words(lambda: _command(list(arguments))))


def _command(arguments: list[str]) -> int:
    environment.prepare()
    with _settings_of_a_command():
        return _carried_out(arguments)


@contextmanager
def _settings_of_a_command() -> Iterator[None]:
    """Look for garbage rarely; afterwards, since a notebook goes on in the same process, put back this and what the
    command freezes and sets FENICS_GEARS_MEMORY to."""
    thresholds = gc.get_threshold()
    frozen = gc.get_freeze_count()
    memory = os.environ.get(MEMORY_VARIABLE)
    # Python's usual search for garbage among a million objects that stay takes a tenth of a short run.
    gc.set_threshold(200_000, 50, 100)
    try:
        yield
    finally:
        gc.set_threshold(*thresholds)
        if not frozen:
            gc.unfreeze()
        if memory is None:
            os.environ.pop(MEMORY_VARIABLE, None)
        else:
            os.environ[MEMORY_VARIABLE] = memory


def _carried_out(arguments: Sequence[str]) -> int:
    if set(arguments) in ({"--version", "-v"}, {"--version", "--verbose"}):
        return import_module(f"{__package__}.work.versions").print_versions()
    if arguments[:1] == ["help"]:
        arguments = [*arguments[1:2], "--help"]
    called = next((word for word in arguments if not word.startswith("-")), "")
    if called in registry.UNPARSED:
        after = arguments.index(called) + 1
        _parser().parse_args(arguments[:after])
        return import_module(f"{__package__}.{called}").carry_out(arguments[after:])
    options = _parser(called).parse_args(arguments)
    _configure_logging(options.verbose)
    if "memory" in options:
        os.environ[MEMORY_VARIABLE] = options.memory
    # No command opens a window; matplotlib refuses to be loaded where the user's choice of one is misspelt.
    os.environ["MPLBACKEND"] = "agg"
    check_working_folder()
    return options.command(options)


def _in_words(command: Callable[[], int]) -> int:
    try:
        return command()
    except GearsError as error:
        print(printable(str(error)), file=sys.stderr)
        return error.exit_code
    except MemoryError:
        ended = MemoryEnded("before the command was done")
        print(ended, file=sys.stderr)
        return ended.exit_code
    except (KeyboardInterrupt, SystemError) as error:
        # Compiled code that Ctrl-C hits in the middle turns it into a SystemError.
        if not isinstance(error, KeyboardInterrupt) and not isinstance(error.__cause__, KeyboardInterrupt):
            raise
        print("Interrupted before there was anything to keep.", file=sys.stderr)
        return INTERRUPTED


def _written(command: Callable[[], int]) -> int:
    """The command's exit code, or NOBODY_READS where its output could not be written."""
    try:
        try:
            return command()
        finally:
            sys.stdout.flush()
    except OSError as error:
        if not isinstance(error, BrokenPipeError):
            if not _output_fails():
                raise
            why = f"The standard output cannot be written: {error.strerror}."
            print(f"{why} Send it elsewhere, or free space.", file=sys.stderr)
        # What Python still writes when it ends goes nowhere too.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return NOBODY_READS


def _output_fails() -> bool:
    try:
        print(flush=True)
    except OSError:
        return True
    return False


def _configure_logging(verbose: bool) -> None:
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s: %(message)s", stream=sys.stderr)
    logging.getLogger("fenics_gears").setLevel(logging.DEBUG if verbose else logging.WARNING)
    # Warnings of libraries speak to developers.
    logging.captureWarnings(True)
    logging.getLogger("py.warnings").setLevel(logging.WARNING if verbose else logging.ERROR)


class Parser(argparse.ArgumentParser):
    """Of the command line, and of each command: argparse makes their parsers of the same class."""

    def error(self, message: str) -> NoReturn:
        super().error(_with_what_is_meant(message, self))


def _with_what_is_meant(message: str, parser: argparse.ArgumentParser) -> str:
    """What a parser says of a wrong call, with what may be meant."""
    if match := _NO_CHOICE.fullmatch(message):
        known = [name.strip("'") for name in match[2].split(", ")]
        return f'there is no command "{match[1]}".{did_you_mean(match[1], known)} Commands: {", ".join(known)}'
    if message.startswith(_UNKNOWN):
        words = message.removeprefix(_UNKNOWN).split()
        options = [word.partition("=")[0] for word in words if word.startswith("-")]
        return f"{message}." + "".join(did_you_mean(each, _options(parser)) for each in options)
    return message


def _options(parser: argparse.ArgumentParser) -> Iterator[str]:
    """The options of a parser, and of the commands that are added to it."""
    for action in parser._actions:
        yield from action.option_strings
        if isinstance(action, argparse._SubParsersAction):
            for each in action.choices.values():
                yield from _options(each)


def _parser(called: str = "") -> argparse.ArgumentParser:
    """The parser of all commands; only the one that is called has arguments."""
    shared = argparse.ArgumentParser(add_help=False)
    loudness = shared.add_mutually_exclusive_group()
    loudness.add_argument(
        "-v", "--verbose", action="store_true", default=argparse.SUPPRESS, help="report in detail what is being done"
    )
    loudness.add_argument(
        "-q", "--quiet", action="store_true", default=argparse.SUPPRESS, help="no progress and no summary, only errors"
    )
    parser = Parser(
        prog="gears",
        description="Spur and helical gear pairs as flexible multi-body systems with frictional contact.",
        epilog=(
            "Exit codes: 0 done, 2 wrong scene or call, 3 computation failed or cannot fit, 4 result without meaning,"
            " 5 result without what follows it (pictures, say), 130 interrupted, 141 output closed."
        ),
        parents=[shared],
    )
    parser.set_defaults(verbose=False, quiet=False)
    parser.add_argument(
        "--version",
        action="version",
        version=f"gears {__version__}",
        help="print the version; with -v also those of libraries, and the kernels of BLAS",
    )
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    registry.add(commands, shared, called)
    return parser
