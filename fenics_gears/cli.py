"""The command ``gears``. Logging and progress are configured here and nowhere else.

Exit codes: 0 done, 2 the scene or the call is wrong (nothing written), 3 the computation failed (what was done is kept, marked
incomplete), 130 interrupted by Ctrl-C (likewise).
"""

from __future__ import annotations

import argparse
import logging
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from fenics_gears import __version__, environment
from fenics_gears.errors import ComputationError, GearsError, GeometryError, SceneError
from fenics_gears.interruption import Interruption
from fenics_gears.job import communicator
from fenics_gears.progress import BarProgress, LineProgress, Progress, SilentProgress
from fenics_gears.show import PICTURE_FILES

INTERRUPTED = 130
RUN_FILE = "run.nc"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line (``sys.argv`` where none is given) and return the exit code."""
    arguments = list(sys.argv[1:] if arguments is None else arguments)
    environment.prepare()
    if arguments[:1] == ["test"]:
        # pytest's options are not ours to parse.
        arguments, options = ["test"], arguments[1:]
        return _reported(lambda: run_tests(options))
    options = _parser().parse_args(arguments)
    _configure_logging(options.verbose)
    return _reported(lambda: options.command(options))


def _reported(command) -> int:
    """The command's exit code, with errors said in words."""
    try:
        return command()
    except GearsError as error:
        print(error, file=sys.stderr)
        return error.exit_code
    except (KeyboardInterrupt, SystemError) as error:
        # Compiled code that Ctrl-C hits in the middle turns it into a SystemError.
        if not isinstance(error, KeyboardInterrupt) and not isinstance(error.__cause__, KeyboardInterrupt):
            raise
        print("Interrupted before there was anything to keep.", file=sys.stderr)
        return INTERRUPTED


def check(options: argparse.Namespace) -> int:
    """``gears check SCENE``: what the scene is and what it would cost; computes nothing."""
    from fenics_gears.console import print_rows

    scene = _checked_scene(options.scene)
    from fenics_gears.description import describe

    description = describe(scene)
    print(f"{scene.title}\n")
    for heading, rows in description.sections:
        print_rows(heading, rows)
    print_rows("Effects", _effect_rows(scene))
    return 0


def run(options: argparse.Namespace) -> int:
    """``gears run SCENE``: simulate, write the result and its pictures, print a summary."""
    from fenics_gears.output import check_writable

    scene = _checked_scene(options.scene)
    directory = options.output or Path("results") / scene.name
    check_writable(directory)
    # Every rank has now found the scene and the directory right, and none leaves the others waiting.
    comm = communicator()
    if comm is not None and comm.rank > 0:
        from fenics_gears.simulation import assist

        assist(scene, comm)
        return 0
    from fenics_gears.simulation import simulate

    with Interruption(_progress(options.quiet)) as interruption:
        try:
            dataset = simulate(scene, progress=interruption, comm=comm)
        except ComputationError as error:
            if getattr(error, "partial", None) is None or not error.partial.sizes["time"]:
                # Nothing was done that an earlier result in the directory should give way to.
                raise
            file = _save(error.partial, directory, interruption)
            raise ComputationError(f"{error}\n{_kept(error.partial, file)}") from error
        files = [_save(dataset, directory, interruption)]
        complete = bool(dataset.attrs.get("complete", 1))
        last_words = "" if complete else f"Interrupted. {_kept(dataset, files[0])}"
        if complete:
            try:
                interruption.heed()
                files += _draw(dataset, directory)
            except KeyboardInterrupt:
                last_words = f"Interrupted while the pictures were drawn. The result is whole: {files[0]}; `gears plot {directory}` draws them."
    if not options.quiet:
        _print_summary(scene.title, dataset, files)
    if last_words:
        print(last_words, file=sys.stderr)
    return INTERRUPTED if last_words else 0


def study(options: argparse.Namespace) -> int:
    """``gears study STUDY``: run what is missing of a parameter study, alone or as one of the processes that mpirun started."""
    if options.processes is not None:
        return _under_mpirun(options)
    from fenics_gears.studies.run_study import run_study
    from fenics_gears.studies.summary import last_words, summary_rows

    outcome = run_study(options.study, options.output, _progress(options.quiet), options.quiet)
    if outcome is None:
        return 0
    if not options.quiet:
        from fenics_gears.console import print_rows

        print_rows(outcome.study.title, summary_rows(outcome))
    if last_words(outcome):
        print(last_words(outcome), file=sys.stderr)
    if outcome.interrupted:
        return INTERRUPTED
    return ComputationError.exit_code if outcome.failures else 0


def _under_mpirun(options: argparse.Namespace) -> int:
    """The same study under mpirun, which finds its settings (as root, say) in the environment that `prepare` has completed."""
    mpirun = shutil.which("mpirun")
    if mpirun is None:
        raise SceneError("There is no mpirun on PATH. Install Open MPI or MPICH, or leave --processes out to run the study alone.")
    command = [mpirun, "-n", str(options.processes)]
    if options.processes > (os.cpu_count() or 1):
        command.append("--oversubscribe")
    command += [sys.executable, "-m", "fenics_gears", "study", str(options.study)]
    command += ["--output", str(options.output)] if options.output is not None else []
    command += ["--quiet"] if options.quiet else []
    return subprocess.call(command)


def _count(text: str) -> int:
    """A whole number above zero, for argparse."""
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number above 0")
    return int(text)


def plot(options: argparse.Namespace) -> int:
    """``gears plot RUN``: draw the pictures of a run again."""
    from fenics_gears.output import check_writable

    file = options.run / RUN_FILE if options.run.is_dir() else options.run
    if not file.is_file():
        raise SceneError(f"{file}: there is no such file. A run is the directory that `gears run` wrote, or the {RUN_FILE} in it.")
    directory = options.output or file.parent
    check_writable(directory)
    from fenics_gears import results

    try:
        dataset = results.load(file)
    except ComputationError as error:
        # Nothing was computed: the call is wrong.
        raise SceneError(str(error)) from error
    for picture in _draw(dataset, directory):
        if not options.quiet:
            print(picture)
    return 0


def run_tests(options: Sequence[str]) -> int:
    """``gears test ...``: pytest on the checkout's tests, with pytest's own options; paths count from the checkout."""
    checkout = Path(__file__).resolve().parents[1]
    tests = checkout / "tests"
    if not tests.is_dir():
        raise SceneError(f"{tests}: there are no tests beside an installed program. Run `gears test` in a checkout of the project.")
    chosen = any((checkout / option.partition("::")[0]).exists() for option in options if not option.startswith("-"))
    return subprocess.call([sys.executable, "-m", "pytest", *options, *([] if chosen else ["tests"])], cwd=checkout)


def _checked_scene(path: Path):
    """The scene of a file, its values and its geometry found right."""
    from fenics_gears.scene.read import load_scene

    scene = load_scene(path)
    from fenics_gears.geometry.modification import removals
    from fenics_gears.geometry.pair import gear_pair

    try:
        removals(scene, gear_pair(scene.gears))
    except GeometryError as error:
        raise GeometryError(f"{path}: {error}\nNothing was computed or written.") from error
    return scene


def _save(dataset, directory: Path, interruption: Interruption) -> Path:
    """Write the result where no Ctrl-C can lose it, and return its file."""
    from fenics_gears import results
    from fenics_gears.output import written_aside

    interruption.ignore()
    written: list[Path] = []
    with written_aside(directory, written) as aside:
        results.save(dataset, aside / RUN_FILE)
    for picture in PICTURE_FILES:
        # Those of an earlier run would be taken for pictures of this one.
        (directory / picture).unlink(missing_ok=True)
    return written[0]


def _kept(dataset, file: Path) -> str:
    """What an incomplete result holds."""
    steps = dataset.sizes["time"]
    return f"What was done until then is kept, marked incomplete: {file}, {steps or 'none'} of the recorded steps"


def _draw(dataset, directory: Path) -> list[Path]:
    from fenics_gears.show.plots import draw_run

    return draw_run(dataset, directory)


def _print_summary(title: str, dataset, files: Sequence[Path]) -> None:
    from fenics_gears.console import print_rows
    from fenics_gears.summary import summary_rows

    print_rows(title, summary_rows(dataset))
    print_rows("Files", [("", str(file), "") for file in files])


def _effect_rows(scene) -> list[tuple[str, str, str]]:
    """Each effect: on with what it adds, off with what the model is without it."""
    from fenics_gears.effects import EFFECTS

    rows = []
    for effect in EFFECTS:
        if getattr(scene, effect.section) is None:
            rows.append((effect.section, f"off  {effect.absent}", ""))
            continue
        added = {"unknowns": effect.unknowns, "terms": effect.terms, "results": [variable.name for variable in effect.variables]}
        listed = "".join(f"; {kind}: {', '.join(names)}" for kind, names in added.items() if names)
        rows.append((effect.section, f"on   {effect.description}{listed}", ""))
    return rows


def _progress(quiet: bool) -> Progress:
    if quiet:
        return SilentProgress()
    if not sys.stderr.isatty():
        return LineProgress()
    from rich.console import Console

    return BarProgress(Console(stderr=True))


def _configure_logging(verbose: bool) -> None:
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s: %(message)s", stream=sys.stderr)
    logging.getLogger("fenics_gears").setLevel(logging.DEBUG if verbose else logging.WARNING)
    # Warnings of libraries speak to developers.
    logging.captureWarnings(True)
    logging.getLogger("py.warnings").setLevel(logging.WARNING if verbose else logging.ERROR)


def _parser() -> argparse.ArgumentParser:
    shared = argparse.ArgumentParser(add_help=False)
    loudness = shared.add_mutually_exclusive_group()
    loudness.add_argument("-v", "--verbose", action="store_true", default=argparse.SUPPRESS, help="say what is being done in detail")
    loudness.add_argument("-q", "--quiet", action="store_true", default=argparse.SUPPRESS, help="no progress and no summary, only errors")
    parser = argparse.ArgumentParser(
        prog="gears",
        description="Spur gear pairs as flexible multi-body systems with frictional contact.",
        epilog="Exit codes: 0 done, 2 wrong scene or call, 3 computation failed, 130 interrupted.",
        parents=[shared],
    )
    parser.set_defaults(verbose=False, quiet=False)
    parser.add_argument("--version", action="version", version=f"gears {__version__}")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)

    command = commands.add_parser("check", parents=[shared], help="validate a scene, print its geometry, effects and cost; compute nothing")
    command.add_argument("scene", type=Path, metavar="SCENE", help="a scene file (TOML)")
    command.set_defaults(command=check)

    command = commands.add_parser("run", parents=[shared], help="run a scene; write run.nc and pictures")
    command.add_argument("scene", type=Path, metavar="SCENE", help="a scene file (TOML)")
    command.add_argument("-o", "--output", type=Path, metavar="DIR", help="where to write (default: results/<name of the scene file>)")
    command.set_defaults(command=run)

    command = commands.add_parser("study", parents=[shared], help="run a parameter study, alone or under mpirun; resumes where it was stopped")
    command.add_argument("study", type=Path, metavar="STUDY", help="a study file (TOML)")
    command.add_argument("-o", "--output", type=Path, metavar="DIR", help="where to write (default: results/<name of the study file>)")
    command.add_argument("-n", "--processes", type=_count, metavar="N", help="start mpirun with N processes and share the cases among them")
    command.set_defaults(command=study)

    command = commands.add_parser("plot", parents=[shared], help="draw the pictures of a run again")
    command.add_argument("run", type=Path, metavar="RUN", help="a run's directory or its run.nc")
    command.add_argument("-o", "--output", type=Path, metavar="DIR", help="where to write (default: beside run.nc)")
    command.set_defaults(command=plot)

    commands.add_parser("test", help="run the tests of the checkout; options go to pytest", add_help=False)
    return parser
