"""What a command of its own takes from the program: arguments that several commands have, the runs and scenes that they
name, progress, and files that are written whole or not at all.

docs/adding_an_extension.md shows a command.
"""

from fenics_gears.commands.shared import (
    INTERRUPTED,
    WITHOUT_SOMETHING,
    add_memory_argument,
    add_output_argument,
    add_processes_argument,
    add_run_argument,
    add_scene_argument,
    after_result,
    checked_model,
    file_to_write,
    loaded_run,
    number_of_option,
    positive_count,
    print_files,
    run_file,
    shown_progress,
    under_mpirun,
)
from fenics_gears.system.console import print_rows
from fenics_gears.system.output import check_writable, write_whole
from fenics_gears.system.progress import seconds_in_words

__all__ = [
    "INTERRUPTED", "WITHOUT_SOMETHING", "add_memory_argument", "add_output_argument", "add_processes_argument",
    "add_run_argument", "add_scene_argument", "after_result", "check_writable", "checked_model", "file_to_write",
    "loaded_run", "number_of_option", "positive_count", "print_files", "print_rows", "run_file", "seconds_in_words",
    "shown_progress", "under_mpirun", "write_whole",
]  # fmt: skip
