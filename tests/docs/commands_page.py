"""docs/commands.md, made from the argument parser."""

import argparse
import inspect
import re
from functools import cache

from tests.docs.markdown import capital, prose, table

from fenics_gears.commands import cli
from fenics_gears.elasticity.cache import DEFAULT_SIZE
from fenics_gears.system.memory import MEMORY_VARIABLE


@cache
def parser(called: str = "") -> argparse.ArgumentParser:
    return cli._parser(called)


def _choices(called: str = "") -> argparse._SubParsersAction:
    return next(each for each in parser(called)._actions if isinstance(each, argparse._SubParsersAction))


@cache
def commands() -> dict[str, tuple[str, argparse.ArgumentParser]]:
    helps = {action.dest: action.help for action in _choices()._choices_actions}
    return {name: (words, _choices(name).choices[name]) for name, words in helps.items()}


def page() -> str:
    whole = parser()
    lines = [prose("commands.md"), "## `gears`", "", f"    gears{_usage(whole)} COMMAND ...", "", *_options(whole), ""]
    lines += ["Every command also accepts `-h`, `-v` and `-q`.", ""]
    for name, (words, command) in commands().items():
        rest = {"test": " [PYTEST'S OPTIONS]", "python": " [PYTHON'S OPTIONS] FILE"}.get(name) or _usage(command)
        lines += [f"## `gears {name}`", "", capital(words), "", f"    gears {name}{rest}", ""]
        lines += [*_options(command), ""] if _shown(command) else []
    return "\n".join([*lines, *_exit_codes(), *_environment()]) + "\n"


def _shown(command: argparse.ArgumentParser) -> list[argparse.Action]:
    common = () if command.prog == "gears" else ("help", "verbose", "quiet")
    return [
        action
        for action in command._actions
        if not isinstance(action, argparse._SubParsersAction) and action.dest not in common
    ]


def _usage(command: argparse.ArgumentParser) -> str:
    """What may stand after the command, without -h; the places last."""
    given = [action for action in _shown(command) if action.dest != "help"]
    options = "".join(f" [{_spelling(action, action.option_strings[0])}]" for action in given if action.option_strings)
    return options + "".join(f" {action.metavar}" for action in given if not action.option_strings)


def _spelling(action: argparse.Action, name: str) -> str:
    return name if action.nargs == 0 else f"{name} {action.metavar}"


def _options(command: argparse.ArgumentParser) -> list[str]:
    rows = []
    for action in _shown(command):
        names = action.option_strings or [action.metavar]
        written = ", ".join(f"`{_spelling(action, name) if action.option_strings else name}`" for name in names)
        # A name in angle brackets would be taken for a tag.
        rows.append((written, action.help.replace("<", "\\<")))
    return table(("argument", "meaning"), rows)


def _exit_codes() -> list[str]:
    words = " ".join(inspect.getdoc(cli).split("Exit codes:")[1].split())
    codes = re.findall(r"\* (\d+): (.*?)\.(?= \* |$)", words)
    return [
        "## Exit codes",
        "",
        *table(("code", "means"), codes),
        "",
        "What to do: [troubleshooting](troubleshooting.md).",
        "",
    ]


def _environment() -> list[str]:
    rows = [
        ("`FENICS_GEARS_PYTHON`", "Python for `./gears`; if not set, `./gears` finds or makes one"),
        ("`FENICS_GEARS_CACHE`", "folder of the cache of condensed gears; if not set, the user's cache folder"),
        ("`FENICS_GEARS_CACHE_SIZE`", f"largest size of this cache, such as `500 MB`; if not set, {DEFAULT_SIZE}"),
        (f"`{MEMORY_VARIABLE}`", "memory that a run may take, as by `--memory`; if not set, a share of what is free"),
        (
            "`XDG_CACHE_HOME`",
            (
                "folder for compiled code, and for condensed gears where `FENICS_GEARS_CACHE` is not set; if not set,"
                " `~/.cache`, or a temporary folder where that cannot be written"
            ),
        ),
        ("`TMPDIR`", "folder for temporary files; if not set, or without room, `/tmp`"),
        ("`OMP_NUM_THREADS`", "threads of the factorisation; 1 under mpirun"),
    ]
    return ["## Environment", "", *table(("variable", "meaning"), rows)]
