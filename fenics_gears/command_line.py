"""What a new command takes from the program: arguments that several commands have, the runs and scenes that they name,
progress, and files that are written completely or not at all.

docs/adding_an_extension.md shows a command.
"""

from importlib import import_module

from fenics_gears.commands.cli import main
from fenics_gears.commands.shared import (
    CASES,
    INTERRUPTED,
    JOURNAL,
    PICTURE_FILE,
    REPORT_FILE,
    RUN_FILE,
    STUDY_FILE,
    WITHOUT_SOMETHING,
    add_memory_argument,
    add_output_argument,
    add_processes_argument,
    add_run_argument,
    add_scene_argument,
    later,
    positive_count,
)
from fenics_gears.commands.work.shared import (
    after_result,
    file_to_write,
    number_of_option,
    print_files,
    shown_progress,
    under_mpirun,
)
from fenics_gears.system.console import print_rows, print_table
from fenics_gears.system.output import check_writable, write_whole
from fenics_gears.system.progress import seconds_in_words

# Loaded when first asked for: to read scenes and runs takes libraries that `--help` shall not wait for.
_READERS = {"checked_model": "scenes"}
_READERS |= dict.fromkeys(("loaded_run", "run_file", "run_or_journal", "stages_beside"), "runs")

__all__ = [
    "CASES", "INTERRUPTED", "JOURNAL", "PICTURE_FILE", "REPORT_FILE", "RUN_FILE", "STUDY_FILE", "WITHOUT_SOMETHING",
    "add_memory_argument", "add_output_argument", "add_processes_argument", "add_run_argument", "add_scene_argument",
    "after_result", "check_writable", "file_to_write", "later", "main", "number_of_option", "positive_count",
    "print_files", "print_rows", "print_table", "seconds_in_words", "shown_progress", "under_mpirun", "write_whole",
    *_READERS,
]  # fmt: skip


def __getattr__(name: str):
    """Load a function that reads scenes or runs."""
    if name not in _READERS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"fenics_gears.commands.work.{_READERS[name]}"), name)
