"""Run the study of this folder and draw it: `run` calls this; a second call computes only what is missing."""

from __future__ import annotations

import sys
from pathlib import Path

from demos.arguments import output_directory

HERE = Path(__file__).parent
STUDY = HERE / "study.toml"
PICTURE = "undamped_resonance.png"


def main(arguments: list[str] | None = None) -> int:
    """Run, draw; returns the exit code of `gears study`."""
    directory = output_directory(
        "undamped_resonance", "The undamped pair through its first torsional resonance.", arguments
    )
    code = compute(STUDY, directory)
    if code == 0:
        print(picture(directory))
    return code


def compute(study: Path, directory: Path) -> int:
    """Run what is missing of a study; the exit code, words on failures to the error output."""
    from fenics_gears.errors import ComputationError, GearsError
    from fenics_gears.system.progress import SilentProgress
    from fenics_gears.studies.run_study import run_study

    try:
        outcome = run_study(study, directory, SilentProgress(), quiet=True)
    except GearsError as error:
        print(error, file=sys.stderr)
        return error.exit_code
    for index, reason in outcome.failures.items():
        print(f"{outcome.study.cases[index]}: {reason}", file=sys.stderr)
    if outcome.interrupted:
        return 130
    return ComputationError.exit_code if outcome.failures else 0


def picture(directory: Path) -> Path:
    """Draw the study that lies in a directory, and save the picture there."""
    from demos.undamped_resonance.drawing import draw
    from demos.undamped_resonance.sweeps import sweeps
    from fenics_gears.system.output import written_aside
    from fenics_gears.show.panels import DOTS_PER_INCH

    figure = draw(sweeps(directory))
    with written_aside(directory, written := []) as aside:
        figure.savefig(aside / PICTURE, dpi=DOTS_PER_INCH, metadata={"Software": None})
    return written[0]


if __name__ == "__main__":
    sys.exit(main())
