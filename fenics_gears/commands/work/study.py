"""What ``gears study`` does."""

import argparse

from fenics_gears.studies.index import directory_of, seems_complete

from .shared import under_mpirun


def study(options: argparse.Namespace) -> int:
    here = options.processes is None
    # Where all cases are kept, several processes would take longer to start than one takes for what is left to do.
    if here or seems_complete(options.study, directory_of(options.study, options.output)):
        # A second that the process which starts mpirun does not take.
        from .study_here import outcome_of, told

        outcome = outcome_of(options)
        if outcome is not None or here:
            return told(outcome, options)
    return under_mpirun(options, ["study", str(options.study)])
