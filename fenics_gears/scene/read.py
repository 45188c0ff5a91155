"""Scenes from files, texts and dictionaries."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fenics_gears.errors import SceneError
from fenics_gears.inputs.problem import NOTHING_DONE
from fenics_gears.inputs.written import as_toml

from . import data
from .parsing import is_train, name_of, parsed, text_of, values_of_text

if TYPE_CHECKING:
    from .train import TrainScene


def load_scene(path: str | os.PathLike) -> data.Scene:
    """Read and validate a scene file; its name is the file's name without the ending.

    Raises SceneError, naming every mistake at once, where the file cannot be read or is wrong.

    >>> from fenics_gears import load_scene
    >>> scene = load_scene("demos/lundvall2004.toml")
    >>> scene.gears.wheel.teeth, scene.load.wheel_torque  # N mm
    (24, 437000.0)
    """
    path = Path(path)
    return scene_from_text(text_of(path, "scene"), name_of(path), source=str(path), directory=path.parent)


def load_scene_or_train(path: Path) -> data.Scene | TrainScene:
    """The scene of a pair or the train that a file has. Errors as of `load_scene` and `load_train`."""
    text = text_of(path, "scene")
    if "stages" in text and is_train(tree := parsed(text, str(path))):
        from .train import train_of

        return train_of(tree, text, name_of(path), str(path), path.parent)
    return scene_from_text(text, name_of(path), source=str(path), directory=path.parent)


def build_scene(sections: Mapping[str, Any], name: str = "scene", *, directory: str | os.PathLike = ".") -> data.Scene:
    """The scene that plain dictionaries describe, with the sections, keys and quantities of a scene file, validated
    like one. An entry that is None is left out.

    name: what messages and, without ``title``, pictures call the scene. directory: from which files are looked for that
    the sections name. Raises SceneError, naming every mistake at once.

    >>> from fenics_gears import build_scene
    >>> gear = {"profile_shift": 0, "bore_diameter": "20 mm"}
    >>> gears = {"module": "3 mm", "pressure_angle": "20 deg", "face_width": "25 mm", "backlash": "0.1 mm"}
    >>> gears |= {"pinion": gear | {"teeth": 20}, "wheel": gear | {"teeth": 40}}
    >>> scene = build_scene({"gears": gears, "load": {"wheel_torque": "100 N m"}})
    >>> scene.gears.centre_distance, scene.load.wheel_torque  # mm, N mm
    (90.0, 100000.0)
    """
    try:
        text = as_toml(sections)
    except (TypeError, ValueError, RecursionError) as error:
        allowed = "Allowed: dictionaries of what a scene file has."
        raise SceneError(f"{name}: is no scene: {error}. {allowed}\n{NOTHING_DONE}") from None
    return scene_from_text(text, name, directory=Path(directory), with_lines=False)


def scene_from_text(
    text: str, name: str = "scene", *, source: str | None = None, directory: Path = Path(), with_lines: bool = True
) -> data.Scene:
    """The scene that a TOML text describes.

    source: what messages call the text (the name, unless given).
    directory: the folder from which files are looked for that the text names.
    with_lines: whether messages say in which line of the text a mistake is.

    Raises SceneError, naming every mistake at once.

    >>> scene = load_scene("demos/lundvall2004.toml")
    >>> scene_from_text(scene.text).gears == scene.gears
    True
    """
    scene = data.Scene(**values_of_text(text, name, source=source, directory=directory, with_lines=with_lines))
    # Known already; a scene that is made of this one has to find its own.
    scene.__dict__["text"] = text
    return scene
