"""``gears map SCENE``: run a scene over loads and speeds; draw its Harris map, Campbell diagram and waterfalls, alone
or under mpirun; a stopped map is continued."""

import argparse
import sys
from pathlib import Path

from fenics_gears import ComputationError
from fenics_gears.command_line import (
    INTERRUPTED,
    WITHOUT_SOMETHING,
    add_memory_argument,
    add_output_argument,
    add_processes_argument,
    add_scene_argument,
    after_result,
    check_writable,
    checked_model,
    positive_count,
    print_files,
    print_rows,
    seconds_in_words,
    shown_progress,
    under_mpirun,
)

MOST_RUNS = 1000


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("map", parents=[shared])
    add_scene_argument(command)
    command.add_argument(
        "--loads", nargs="+", metavar="TORQUE", default=[],
        help='torques on the wheel, such as "100 N m" "200 N m"; or ranges, "50 .. 500 N m in 10", "50 .. 500 N m by '
            '50 N m"; torques on the pinion, or powers such as "15 kW", if the scene gives its load so (default: that '
            'of the scene)',
    )  # fmt: skip
    command.add_argument(
        "--speeds", nargs="+", metavar="SPEED", default=[],
        help='mesh frequencies or speeds of the pinion, such as "200 Hz", "100 .. 3000 rpm in 30" or "50 .. 1000 Hz '
            'in 24, logarithmic"; needs [inertia] (default: quasi-static only)',
    )  # fmt: skip
    add_output_argument(command, "results/<name of the scene file>_map")
    most = f"number of runs that are allowed (default: {MOST_RUNS})"
    command.add_argument("--most-runs", type=positive_count, metavar="N", default=MOST_RUNS, help=most)
    add_processes_argument(command)
    add_memory_argument(command)
    command.set_defaults(command=draw_map)


def draw_map(options: argparse.Namespace) -> int:
    """Run what is missing of a map and draw it."""
    if options.processes is not None:
        given = (("--loads", options.loads), ("--speeds", options.speeds))
        values = [word for name, words in given if words for word in (name, *words)]
        return under_mpirun(options, ["map", str(options.scene), *values, "--most-runs", str(options.most_runs)])
    from fenics_gears.runs.team import ranks

    with ranks() as team:
        return 0 if team is None else _run(options, team)


def _run(options: argparse.Namespace, team) -> int:
    from fenics_gears.studies.run_study import run_with
    from fenics_gears.studies.summary import last_words, summary_rows

    from .load_map import OVER_SPEED, QUASI_STATIC, load_map

    scene = checked_model(options.scene).scene
    wanted = load_map(options.scene, scene, options.loads, options.speeds, options.most_runs)
    directory = options.output or Path("results") / f"{scene.name}_map"
    outcomes = {}
    check_writable(directory, "map.nc", "harris_map.png", "over_load.png", "over_speed.png", "campbell.png")
    studies = wanted.studies
    if not options.quiet:
        time = f"about {seconds_in_words(wanted.expected_seconds)} on one core of an idle machine"
        print(f"{scene.title}: {wanted.count} runs, {time}.", file=sys.stderr, flush=True)
    for name, study in studies.items():
        outcome = outcomes[name] = run_with(team, study, directory / name, shown_progress(options.quiet), options.quiet)
        if not options.quiet:
            print_rows(study.title, summary_rows(outcome))
        if words := last_words(outcome, "the map"):
            print(words, file=sys.stderr)
        if outcome.interrupted:
            return INTERRUPTED
    from .map_results import map_dataset

    found = map_dataset(wanted, outcomes[QUASI_STATIC], outcomes.get(OVER_SPEED))
    from fenics_gears import save_tables

    tables = save_tables(found, directory, "map")
    pictures = after_result(tables[0], "pictures", lambda: _drawn(found, directory, scene))
    print_files([*tables, *(pictures or [])], options.quiet)
    if any(outcome.failures for outcome in outcomes.values()):
        return ComputationError.exit_code
    return WITHOUT_SOMETHING if pictures is None else 0


def _drawn(found, directory: Path, scene) -> list[Path]:
    from fenics_gears.charts import design, draw_charts

    from .charts import map_pictures

    supports = [name for name in ("shafts", "bearings") if getattr(scene, name) is not None]
    more = f"{design(scene)}{', elastic ' + ' and '.join(supports) if supports else ''}"
    return draw_charts(map_pictures(found), directory, scene.title, more)
