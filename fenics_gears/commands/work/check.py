"""What ``gears check`` does."""

import argparse

from fenics_gears.errors import ComputationError
from fenics_gears.system.console import print_rows
from fenics_gears.system.memory import allowed_memory

from .scenes import checked_model, train_in


def check(options: argparse.Namespace) -> int:
    """Print the description of a scene and its effects. Raises ComputationError, as a run would, where memory does not
    hold it."""
    if (train := train_in(options.scene)) is not None:
        from .train import check_train

        return check_train(train)
    model = checked_model(options.scene)
    # A scene that is refused waits for none of it.
    from fenics_gears.model import cost, description

    scene = model.scene
    described = description.describe(scene)
    print(f"{scene.title}\n")
    for heading, rows in described:
        print_rows(heading, rows)
    print_rows("Effects", effect_rows(description.effect_states(scene)))
    # With a target a run computes with settings of its own.
    if scene.accuracy.target is None and (said := cost.too_large(model, cost.expected_cost(model), allowed_memory())):
        raise ComputationError(f"CANNOT FIT: {said}")
    return 0


def effect_rows(states) -> list[tuple[str, str, str]]:
    """Each effect: on with what it adds, off with what the model is without it."""
    rows = []
    for state in states:
        adds = f"; {state.adds}" if state.adds else ""
        rows.append((state.effect.section, f"{'on ' if state.on else 'off'}  {state.words}{adds}", ""))
    return rows
