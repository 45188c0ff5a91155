"""``gears check SCENE``: what the scene is and what it would cost; computes nothing."""

from __future__ import annotations

import argparse

from fenics_gears.commands.scene_file import add_scene_argument, checked_scene


def add(commands, shared: argparse.ArgumentParser) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("check", parents=[shared], help="validate a scene, print its geometry, effects and cost; compute nothing")
    add_scene_argument(command)
    command.set_defaults(command=check)


def check(options: argparse.Namespace) -> int:
    """Print the description of a scene and its effects."""
    from fenics_gears.console import print_rows

    scene = checked_scene(options.scene)
    from fenics_gears.description import describe

    description = describe(scene)
    print(f"{scene.title}\n")
    for heading, rows in description.sections:
        print_rows(heading, rows)
    print_rows("Effects", effect_rows(scene))
    return 0


def effect_rows(scene) -> list[tuple[str, str, str]]:
    """Each effect: on with what it adds, off with what the model is without it."""
    from fenics_gears.effects import EFFECTS, result_variables

    rows, there = [], {variable.name for variable in result_variables(scene)}
    for effect in EFFECTS:
        if getattr(scene, effect.section) is None:
            rows.append((effect.section, f"off  {effect.absent}", ""))
            continue
        results = [variable.name for variable in effect.variables if variable.name in there]
        added = {"unknowns": effect.unknowns, "terms": effect.terms, "results": results}
        listed = "".join(f"; {kind}: {', '.join(names)}" for kind, names in added.items() if names)
        rows.append((effect.section, f"on   {effect.description}{listed}", ""))
    return rows
