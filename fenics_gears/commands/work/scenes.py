"""The scenes that commands name."""

from pathlib import Path

from fenics_gears.errors import SceneError
from fenics_gears.inputs.problem import placed
from fenics_gears.scene.data import Scene
from fenics_gears.scene.read import load_scene, load_scene_or_train
from fenics_gears.system.output import check_writable

from ..shared import RUN_FILE


def checked_model(path: Path):
    """The model of a scene file, its values, geometry and files found right. Raises SceneError and GeometryError."""
    scene = load_scene(path)
    # Half a second that a scene which cannot be read does not take.
    from fenics_gears.model.model import model_of

    try:
        return model_of(scene)
    except SceneError as error:
        raise type(error)(placed(str(error), scene.written, str(path))) from error


def train_in(path: Path):
    """The train of a scene file, its values and geometry found right; None of another file."""
    if not path.is_file() or b"stages" not in path.read_bytes():
        return None
    found = load_scene_or_train(path)
    return None if isinstance(found, Scene) else found


def checked_model_and_directory(options, *names: str):
    """The model of a command's scene, and the directory to write into, which takes files of these names. Raises as
    `checked_model` does, and SceneError for the directory."""
    model = checked_model(options.scene)
    directory = options.output or Path("results") / model.scene.name
    check_writable(directory, *names, room=model.least_file_bytes if RUN_FILE in names else 0)
    return model, directory
