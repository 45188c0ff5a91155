"""``gears map SCENE``: run a scene over loads and speeds; draw its Harris map, Campbell diagram and waterfalls, alone
or under mpirun; a stopped map is continued."""

import argparse

from fenics_gears.command_line import (
    add_memory_argument,
    add_output_argument,
    add_processes_argument,
    add_scene_argument,
    later,
    positive_count,
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
    """Run what is missing of a map and draw it, or start the processes that do."""
    if options.processes is None:
        return later("fenics_gears.extensions.maps.work:draw_map")(options)
    given = (("--loads", options.loads), ("--speeds", options.speeds))
    values = [word for name, words in given if words for word in (name, *words)]
    return under_mpirun(options, ["map", str(options.scene), *values, "--most-runs", str(options.most_runs)])
