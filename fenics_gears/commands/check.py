"""``gears check SCENE``: check a scene; print its geometry, effects, accuracy and expected cost; compute nothing."""

import argparse

from fenics_gears.errors import ComputationError
from fenics_gears.system.console import print_rows
from fenics_gears.system.memory import allowed_memory

from .shared import add_memory_argument, add_scene_argument, checked_model


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("check", parents=[shared])
    add_scene_argument(command)
    add_memory_argument(command)
    command.set_defaults(command=check)


def check(options: argparse.Namespace) -> int:
    """Print the description of a scene and its effects. Raises ComputationError, as a run would, where memory does not
    hold it."""
    from fenics_gears.model.cost import expected_cost
    from fenics_gears.model.fitting import too_large

    model = checked_model(options.scene)
    scene = model.scene
    from fenics_gears.model.description import describe

    description = describe(scene)
    print(f"{scene.title}\n")
    for heading, rows in description:
        print_rows(heading, rows)
    print_rows("Effects", effect_rows(scene))
    # With a target a run computes with settings of its own.
    if scene.accuracy.target is None and (said := too_large(model, expected_cost(model), allowed_memory())):
        raise ComputationError(f"CANNOT FIT: {said}")
    return 0


def effect_rows(scene) -> list[tuple[str, str, str]]:
    """Each effect: on with what it adds, off with what the model is without it."""
    from fenics_gears.model.description import effect_states

    rows = []
    for state in effect_states(scene):
        adds = f"; {state.adds}" if state.adds else ""
        rows.append((state.effect.section, f"{'on ' if state.on else 'off'}  {state.words}{adds}", ""))
    return rows
