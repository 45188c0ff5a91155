"""The scene file that a command is given."""

from __future__ import annotations

from pathlib import Path

from fenics_gears.errors import GeometryError


def checked_scene(path: Path):
    """The scene of a file, its values and its geometry found right. Raises SceneError and GeometryError."""
    from fenics_gears.scene.read import load_scene

    scene = load_scene(path)
    from fenics_gears.effects import check_files
    from fenics_gears.geometry.pair import gear_pair
    from fenics_gears.model.modification import corner, removals

    try:
        pair = gear_pair(scene.gears)
        removals(scene, pair)
        corner(scene, pair)
    except GeometryError as error:
        raise GeometryError(f"{path}: {error}\nNothing was computed or written.") from error
    check_files(scene, pair)
    return scene


def checked_scene_and_directory(options):
    """The scene of a command's options, found right, and the directory to write into, found writable. Raises as `checked_scene` does."""
    from fenics_gears.system.output import check_writable

    scene = checked_scene(options.scene)
    directory = options.output or Path("results") / scene.name
    check_writable(directory)
    return scene, directory


def add_scene_argument(command) -> None:
    """The argument SCENE of a command's parser."""
    command.add_argument("scene", type=Path, metavar="SCENE", help="a scene file (TOML)")


def add_output_argument(command) -> None:
    """The option --output of a command that writes a scene's results."""
    command.add_argument("-o", "--output", type=Path, metavar="DIR", help="where to write (default: results/<name of the scene file>)")
