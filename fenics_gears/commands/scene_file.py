"""The scene file that a command is given."""

from __future__ import annotations

from pathlib import Path

from fenics_gears.errors import GeometryError


def checked_scene(path: Path):
    """The scene of a file, its values and its geometry found right. Raises SceneError and GeometryError."""
    from fenics_gears.scene.read import load_scene

    scene = load_scene(path)
    from fenics_gears.geometry.modification import corner, removals
    from fenics_gears.geometry.pair import gear_pair

    try:
        pair = gear_pair(scene.gears)
        removals(scene, pair)
        corner(scene, pair)
    except GeometryError as error:
        raise GeometryError(f"{path}: {error}\nNothing was computed or written.") from error
    return scene


def add_scene_argument(command) -> None:
    """The argument SCENE of a command's parser."""
    command.add_argument("scene", type=Path, metavar="SCENE", help="a scene file (TOML)")
