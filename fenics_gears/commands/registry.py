"""Finds the commands: first of this folder, then of extensions. These are in the folder ``fenics_gears/extensions``, or
in installed packages that name themselves in the entry point group of the same name.

Each is a module with a function ``add(commands, shared)``: `commands` takes parsers of commands by
`commands.add_parser`, `shared` is the parser of -v and -q (docs/adding_an_extension.md). Its docstring begins with
"``gears NAME ...``: summary.", once for each command that the module adds or changes, its own first. So a call imports
only the modules that have its command, and those whose docstrings name none.
"""

import argparse
import os
import re
import sys
from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

GROUP = "fenics_gears.extensions"
HERE = Path(__file__).parent
# Their options belong to Python and pytest.
UNPARSED = ("python", "test")
# In the order of their use.
CORE = ("check", "run", "study", "plot", "picture", "export", "cache", *UNPARSED)


class CommandModule(NamedTuple):
    """A module of commands: what messages call it, what imports it, and its commands with their summaries."""

    label: str
    load: Callable
    commands: dict[str, str]


def add(commands, shared: argparse.ArgumentParser, called: str) -> None:
    """Add all commands; only modules that have the one that is called add arguments.

    An extension that fails is left out, which the standard error says: no other command needs it.
    """
    # One module may add an option to a command of another, which is added first.
    extensions = sorted([*_of_the_folder(), *_of_installed_packages()], key=lambda each: len(each.commands) > 1)
    modules = [*_of_the_core(), *extensions]
    needed = {called}.union(*(each.commands for each in modules if called in each.commands))
    for label, load, own in modules:
        try:
            if own and (needed.isdisjoint(own) or label in UNPARSED):
                for name in [each for each in own if each not in commands.choices]:
                    commands.add_parser(name, help=own[name], add_help=False)
            else:
                load().add(commands, shared)
        except Exception as error:
            if label in CORE:
                raise
            why = f"{type(error).__name__}: {error}. Mend, update or uninstall it."
            print(f"The extension {label} cannot be loaded and is left out: {why}", file=sys.stderr)


def _of_the_core() -> Iterator[CommandModule]:
    for name in CORE:
        yield _module(name, partial(import_module, f"{__package__}.{name}"), HERE / f"{name}.py")


def _of_the_folder() -> Iterator[CommandModule]:
    for file in sorted(HERE.parent.glob("extensions/*/command.py")):
        name = file.parent.name
        yield _module(name, partial(import_module, f"{GROUP}.{name}.command"), file)


def _of_installed_packages() -> Iterator[CommandModule]:
    if not any(map(_names_the_group, sys.path)):
        return
    from importlib.metadata import entry_points

    for each in sorted(entry_points(group=GROUP), key=lambda each: each.name):
        yield _module(f"{each.name} ({each.value})", each.load, _file(each.module))


def _module(label: str, load: Callable, file: str | Path) -> CommandModule:
    """The module by its docstring, which is read, not imported."""
    docstring = re.match(rb'"""(.*?)"""', _content(file), re.DOTALL)
    words = " ".join(docstring[1].decode(errors="replace").split()) if docstring else ""
    told = re.findall(r"``gears ([\w-]+)[^`]*``: (.+?)\.(?: |$)", words)
    return CommandModule(label, load, dict(told) if words.startswith("``gears ") else {})


def _file(module: str) -> str:
    from importlib.util import find_spec

    try:
        return getattr(find_spec(module), "origin", None) or ""
    except Exception:
        # To find a module imports the package that it is in.
        return ""


def _names_the_group(folder: str) -> bool:
    """Whether a package that is installed in a folder may have an extension: every call looks into these files, in 2
    ms; to load importlib.metadata takes 25 ms."""
    try:
        names = [name for name in os.listdir(folder or ".") if name.endswith((".dist-info", ".egg-info"))]
    except OSError:
        return False
    return any(GROUP.encode() in _content(f"{folder or '.'}/{name}/entry_points.txt") for name in names)


def _content(file: str | Path) -> bytes:
    try:
        with open(file, "rb") as opened:
            return opened.read()
    except OSError:
        return b""
