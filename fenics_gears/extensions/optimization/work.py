"""What ``gears optimize`` does."""

import argparse
import sys

from fenics_gears.command_line import INTERRUPTED, WITHOUT_SOMETHING, after_result, print_rows, shown_progress

from .charts import summary_rows, write_pictures
from .optimize import optimize
from .page import write_page
from .result import write_result


def search(options: argparse.Namespace) -> int:
    """Search, write the result with its pictures and its page, and print the summary."""
    try:
        outcome = optimize(options.design, options.output, shown_progress(options.quiet), options.quiet, options.yes)
    except KeyboardInterrupt:
        print("Interrupted. Finished runs are kept; the same command goes on from there.", file=sys.stderr)
        return INTERRUPTED
    if outcome is None:
        return 0
    files = write_result(outcome)
    drawn = after_result(files[0], "pictures", lambda: write_pictures(outcome))
    page = after_result(files[0], "page", lambda: [write_page(outcome)])
    files += [*(drawn or []), *(page or [])]
    if not options.quiet:
        print_rows(outcome.design.title, summary_rows(outcome))
        print_rows("Files", [("", str(file), "") for file in files])
    return WITHOUT_SOMETHING if drawn is None or page is None else 0
