"""``gears import FILE.rexs``: write a gear pair of a REXS file as a scene. The scene names the origin of every
value."""

import argparse
from pathlib import Path

from fenics_gears import GeometryError, SceneError
from fenics_gears.command_line import add_output_argument, file_to_write, write_whole


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("import", parents=[shared])
    command.add_argument("file", type=Path, metavar="FILE", help="a REXS file: .rexs, .rexsj or .rexsz")
    add_output_argument(command, "name of FILE with .toml, in the current folder", "scene file to write", "SCENE")
    command.add_argument(
        "--stage", type=int, metavar="ID", help="number of the component of the stage, if the file has several stages"
    )
    command.add_argument("--load-case", metavar="ID", help="number of the load case, if the file has several")
    torque = 'torque on the driven gear in place of that of the file, such as "437 N m"'
    command.add_argument("--wheel-torque", metavar="TORQUE", help=torque)
    speed = 'speed of the driving gear in place of that of the file, such as "750 rpm"'
    command.add_argument("--pinion-speed", metavar="SPEED", help=speed)
    command.set_defaults(command=import_rexs)


def import_rexs(options: argparse.Namespace) -> int:
    """Write the scene, once it is found right, and say what was assumed and left out."""
    output = file_to_write(options, Path((options.file.stem.removesuffix(".rexs") or "scene") + ".toml"), "a scene")
    if output.exists():
        # A scene is the user's own work.
        raise SceneError(f"{output} exists already. Name another file with --output SCENE, or remove it.")
    from .imported import imported_scene

    imported = imported_scene(
        options.file, options.stage, options.load_case, options.wheel_torque, options.pinion_speed
    )
    _check_scene(imported, options.file, output)
    write_whole(output, lambda path: path.write_text(imported.text, encoding="utf-8"))
    if not options.quiet:
        print(_summary(imported, output))
    return 0


def _check_scene(imported, file: Path, output: Path) -> None:
    """What the file says makes a scene and gears that mesh. Raises SceneError, which also says what had to be
    assumed."""
    from fenics_gears import check_geometry, scene_from_text

    source = f"{file} as a scene"
    try:
        scene = scene_from_text(imported.text, output.stem, source=source, with_lines=False)
        check_geometry(scene)
    except SceneError as error:
        words = f"{source}: {error}\nNothing was written." if isinstance(error, GeometryError) else str(error)
        gears = f"The pinion is {imported.stage.pinion.gear}, the wheel {imported.stage.wheel.gear}."
        assumed = "".join(f"\n    assumed: {each}" for each in imported.assumed if each.startswith("gears."))
        raise SceneError(f"{words}\n{gears}{assumed}") from error


def _summary(imported, output: Path) -> str:
    lines = [f"{output}: {imported.stage.pinion.gear} drives {imported.stage.wheel.gear}."]
    for heading, listed in (("Assumed:", imported.assumed), ("Left out:", imported.left_out)):
        if listed:
            lines += [heading, *(f"    {each}" for each in listed)]
    return "\n".join([*lines, f"Next: gears check {output}"])
