"""What ``gears import`` does."""

import argparse
from pathlib import Path

from fenics_gears import GeometryError, SceneError, check_geometry, scene_from_text, train_from_text
from fenics_gears.command_line import file_to_write, write_whole

from .gearbox import imported_train
from .imported import imported_scene


def import_rexs(options: argparse.Namespace) -> int:
    """Write the scene, once it is found right, and say what was assumed and left out."""
    output = file_to_write(options, Path((options.file.stem.removesuffix(".rexs") or "scene") + ".toml"), "a scene")
    if output.exists():
        # A scene is the user's own work.
        raise SceneError(f"{output} exists already. Name another file with --output SCENE, or remove it.")
    if options.train:
        return _import_train(options, output)
    if options.shafts:
        raise SceneError("--shafts is of a train. Give --train beside it.")
    imported = imported_scene(
        options.file, options.stage, options.load_case, options.wheel_torque, options.pinion_speed
    )
    _check_scene(imported, options.file, output)
    write_whole(output, lambda path: path.write_text(imported.text, encoding="utf-8"))
    if not options.quiet:
        first = f"{output}: {imported.stage.pinion.gear} drives {imported.stage.wheel.gear}."
        print(_summary([first], imported, output))
    return 0


def _import_train(options: argparse.Namespace, output: Path) -> int:
    """The same of all stages."""
    if options.stage is not None:
        raise SceneError("--stage is of one pair; leave it out beside --train.")
    given = options.load_case, options.wheel_torque, options.pinion_speed
    imported = imported_train(options.file, *given, bent=options.shafts)
    source = f"{options.file} as a train"
    try:
        train_from_text(imported.text, output.stem, source=source)
    except GeometryError as error:
        assumed = "".join(f"\n    assumed: {each}" for each in imported.assumed if each.startswith("stages."))
        raise SceneError(f"{source}: {error}\nNothing was written.{assumed}") from error
    write_whole(output, lambda path: path.write_text(imported.text, encoding="utf-8"))
    if not options.quiet:
        print(_summary([f"{output}:", *imported.stages], imported, output))
    return 0


def _check_scene(imported, file: Path, output: Path) -> None:
    """What the file says makes a scene and gears that mesh. Raises SceneError, which also says what had to be
    assumed."""
    source = f"{file} as a scene"
    try:
        scene = scene_from_text(imported.text, output.stem, source=source, with_lines=False)
        check_geometry(scene)
    except SceneError as error:
        words = f"{source}: {error}\nNothing was written." if isinstance(error, GeometryError) else str(error)
        gears = f"The pinion is {imported.stage.pinion.gear}, the wheel {imported.stage.wheel.gear}."
        assumed = "".join(f"\n    assumed: {each}" for each in imported.assumed if each.startswith("gears."))
        raise SceneError(f"{words}\n{gears}{assumed}") from error


def _summary(lines: list[str], imported, output: Path) -> str:
    for heading, listed in (("Assumed:", imported.assumed), ("Left out:", imported.left_out)):
        if listed:
            lines += [heading, *(f"    {each}" for each in listed)]
    return "\n".join([*lines, f"Next: gears check {output}"])
