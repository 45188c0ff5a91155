"""What ``gears map`` does."""

import argparse
import sys
from pathlib import Path

from fenics_gears import ComputationError, Scene, save_tables
from fenics_gears.charts import design, draw_charts
from fenics_gears.command_line import (
    INTERRUPTED,
    WITHOUT_SOMETHING,
    after_result,
    check_writable,
    checked_model,
    print_files,
    print_rows,
    seconds_in_words,
    shown_progress,
)
from fenics_gears.many_runs import Outcome, kinds_of_meshes, last_words, ranks, run_with, summary_rows
from fenics_gears.scene_text import load_scene_or_train

from .charts import map_pictures
from .load_map import OVER_SPEED, QUASI_STATIC, LoadMap, load_map
from .map_results import map_dataset
from .train_map import TrainMap, train_map
from .train_map_results import train_map_dataset, train_map_pictures


def draw_map(options: argparse.Namespace) -> int:
    """Run what is missing of a map and draw it."""
    with ranks() as team:
        return 0 if team is None else _run(options, team)


def _run(options: argparse.Namespace, team) -> int:
    scene = load_scene_or_train(options.scene)
    asked = options.loads, options.speeds, options.most_runs
    wanted: LoadMap | TrainMap
    if isinstance(scene, Scene):
        scene = checked_model(options.scene).scene
        wanted = load_map(options.scene, scene, *asked)
    else:
        wanted = train_map(options.scene, scene, *asked)
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
    dataset = _dataset(wanted, outcomes[QUASI_STATIC], outcomes.get(OVER_SPEED))
    tables = save_tables(dataset, directory, "map")
    pictures = after_result(tables[0], "pictures", lambda: _drawn(dataset, directory, scene))
    print_files([*tables, *(pictures or [])], options.quiet)
    if any(outcome.failures for outcome in outcomes.values()):
        return ComputationError.exit_code
    return WITHOUT_SOMETHING if pictures is None else 0


def _dataset(wanted: LoadMap | TrainMap, at_rest: Outcome, over_speed: Outcome | None):
    if isinstance(wanted, TrainMap):
        return train_map_dataset(wanted, at_rest, over_speed)
    return map_dataset(wanted, at_rest, over_speed)


def _drawn(dataset, directory: Path, scene) -> list[Path]:
    if not isinstance(scene, Scene):
        kinds = kinds_of_meshes([mesh.name for mesh in scene.meshes])
        pairs = {name: scene.meshes[places[0]].pair for name, places in kinds.items()}
        stages = (f"{name} {own.pinion.teeth}/{own.wheel.tooth_count} teeth" for name, own in pairs.items())
        return draw_charts(train_map_pictures(dataset), directory, scene.title, ", ".join(stages))
    supports = [name for name in ("shafts", "bearings") if getattr(scene, name) is not None]
    more = f"{design(scene)}{', elastic ' + ' and '.join(supports) if supports else ''}"
    return draw_charts(map_pictures(dataset), directory, scene.title, more)
