"""The scene that a result carries in its attributes, and the scene again from these."""

import logging
from functools import lru_cache
from pathlib import Path

import xarray as xr

from fenics_gears.effects import from_effects
from fenics_gears.errors import SceneError
from fenics_gears.scene.data import Scene
from fenics_gears.scene.parsing import NO_FILE
from fenics_gears.scene.read import scene_from_text

LOGGER = logging.getLogger(__name__)


def scene_attributes(scene: Scene) -> dict[str, str]:
    """The text and the name of a scene; where the scene names files, also the folder to look for them from, and a hash
    of each file's content."""
    attributes = {"scene": scene.text, "scene_name": scene.name}
    files = files_of(scene)
    if files:
        attributes |= {
            "scene_folder": scene.folder,
            "scene_files": "\n".join(f"{digest} {name}" for name, digest in files.items()),
        }
    return attributes


def carried_scene(result: xr.Dataset) -> Scene:
    """The scene that was run; a warning is logged where files that it names have changed. Raises SceneError where its
    text is no scene of this version.

    >>> from fenics_gears import load_scene
    >>> scene = load_scene("demos/lundvall2004.toml")
    >>> carried_scene(xr.Dataset(attrs=scene_attributes(scene))) == scene
    True
    """
    text, name, folder = (str(result.attrs.get(each, "")) for each in ("scene", "scene_name", "scene_folder"))
    if text.startswith(NO_FILE):
        raise SceneError(text.removeprefix("# ").rstrip())
    # What names files is read with them each time.
    read = scene_from_text if "scene_files" in result.attrs else _known
    scene = read(text, name or "scene", directory=Path(folder))
    for words in changed_files(result, scene):
        LOGGER.warning("%s", words)
    return scene


# A run that is shown asks several times.
_known = lru_cache(maxsize=4)(scene_from_text)


def changed_files(result: xr.Dataset, scene: Scene) -> list[str]:
    """Sentences on files that the scene of a result names and that are no longer what was read when it was run."""
    now = files_of(scene)
    then = (line.partition(" ")[::2] for line in str(result.attrs.get("scene_files", "")).splitlines())
    folder = result.attrs.get("scene_folder")
    return [
        f"{name}, which the scene names, is not what it was when the scene was run (looked for in {folder}). What is"
        " computed from it now is not of that run."
        for digest, name in then
        if now.get(name) != digest
    ]


def files_of(scene: Scene) -> dict[str, str]:
    """The files that a scene names, each with a hash of its content."""
    return {name: digest for files in from_effects(scene, "files") for name, digest in files.items()}
