"""Finds extensions and adds their commands: those in the folder ``fenics_gears/extensions``, then those of installed
packages that name themselves in the entry point group of the same name.

An extension is a module with a function ``add(commands, shared)``, as each module of this folder has one: `commands`
takes parsers of further commands by `commands.add_parser`, `shared` is the parser of -v and -q
(docs/adding_an_extension.md).
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from pathlib import Path
from types import ModuleType

GROUP = "fenics_gears.extensions"
FOLDER = Path(__file__).parents[1] / "extensions"


def add(commands, shared: argparse.ArgumentParser) -> None:
    """Add the commands of all extensions. One that fails is left out, which the standard error says: no other command
    needs it."""
    for name, load in (*_of_the_folder(), *_of_installed_packages()):
        try:
            load().add(commands, shared)
        except Exception as error:
            print(
                f"The extension {name} cannot be loaded and is left out: {type(error).__name__}: {error}. Mend, update"
                " or uninstall it.",
                file=sys.stderr,
            )


def _of_the_folder() -> Iterator[tuple[str, Callable[[], ModuleType]]]:
    """Name and loader of each, without any being imported."""
    for file in sorted(FOLDER.glob("*/command.py")):
        name = file.parent.name
        yield name, partial(import_module, f"{GROUP}.{name}.command")


def _of_installed_packages() -> Iterator[tuple[str, Callable[[], ModuleType]]]:
    if not any(map(_names_the_group, sys.path)):
        return
    from importlib.metadata import entry_points

    for each in sorted(entry_points(group=GROUP), key=lambda each: each.name):
        yield f"{each.name} ({each.value})", each.load


def _names_the_group(folder: str) -> bool:
    """Whether a package that is installed in a folder may have an extension: to load importlib.metadata takes 25 ms,
    to look into these files 2 ms, and every call of the program does it."""
    try:
        names = [name for name in os.listdir(folder or ".") if name.endswith((".dist-info", ".egg-info"))]
    except OSError:
        return False
    return any(GROUP.encode() in _content(f"{folder or '.'}/{name}/entry_points.txt") for name in names)


def _content(file: str) -> bytes:
    try:
        with open(file, "rb") as opened:
            return opened.read()
    except OSError:
        return b""
