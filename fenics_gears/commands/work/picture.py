"""What ``gears picture`` does."""

import argparse
from collections.abc import Callable
from contextlib import closing
from functools import partial
from pathlib import Path

from fenics_gears.errors import SceneError
from fenics_gears.inputs.problem import did_you_mean
from fenics_gears.results.mesh_of_train import carried_train, mesh_run
from fenics_gears.show.run import scene_of
from fenics_gears.show.stress_animation import animate, check_suffix, save_series
from fenics_gears.show.stress_grid import save_vtu
from fenics_gears.show.stress_picture import save_picture, still
from fenics_gears.simulation.mesh_stresses import stresses_of_mesh
from fenics_gears.simulation.run_stresses import RunStresses
from fenics_gears.simulation.stored_forces import stored_index
from fenics_gears.system.console import printable
from fenics_gears.system.output import check_writable, write_whole

from ..shared import ANIMATION_FILE, PICTURE_FILE
from .runs import loaded_run, of_train, run_file
from .shared import print_files, shown_progress


def picture(options: argparse.Namespace) -> int:
    """Draw and export what is asked for; without --output and --animate, --vtu or --pvd alone writes no picture."""
    file = run_file(options.run)
    output = options.output or file.parent / (ANIMATION_FILE if options.animate else PICTURE_FILE)
    drawn = options.animate or options.output is not None or options.vtu is None and options.pvd is None
    _check_outputs(options, output if drawn else None)
    dataset = loaded_run(file, trains=True)
    if of_train(dataset):
        return _of_train(options, file, dataset)
    if options.mesh is not None:
        raise SceneError(f"--mesh {options.mesh}: {file} is the run of a pair. Leave the option out.")
    scene = _scene_of(file, dataset)
    index = stored_index(dataset, options.at)
    _draw(options, dataset, lambda: RunStresses(dataset, scene), index, output if drawn else None)
    return 0


def _draw(
    options: argparse.Namespace, dataset, stresses: Callable[[], RunStresses], index: int, output: Path | None
) -> None:
    """Write what is asked for of one pair, and tell its files."""
    written: list[Path] = []
    with closing(shown_progress(options.quiet)) as progress:
        progress.stage("factorise sectors")
        with stresses() as runs:
            if options.vtu is not None:
                written.append(write_whole(options.vtu, lambda path: save_vtu(runs.at(index), path)))
            if options.pvd is not None:
                progress.stage("recover stresses")
                written.append(write_whole(options.pvd, lambda path: save_series(runs, dataset, path, progress.update)))
            if output is not None:
                progress.stage("draw")
                scale = options.scale
                if options.animate:
                    moving = partial(animate, runs, dataset, scale=scale, report=progress.update)
                    written.append(write_whole(output, moving))
                else:
                    drawn = still(runs.at(index), dataset, scale)
                    written.append(write_whole(output, lambda path: save_picture(drawn, path)))
    print_files(written, options.quiet)


def _of_train(options: argparse.Namespace, file: Path, dataset) -> int:
    """Draw the meshes of a train, or one, each in a folder by its name; of meshes that are alike the first."""
    train = carried_train(dataset)
    names = [mesh.name for mesh in train.meshes]
    wanted = [number for number, mesh in enumerate(train.meshes) if mesh.like is None]
    if options.mesh is not None:
        if options.mesh not in names:
            known = f"{did_you_mean(options.mesh, names)} Known: {', '.join(names)}."
            raise SceneError(f"--mesh {options.mesh}: is no mesh of this train.{known}")
        wanted = [names.index(options.mesh)]
    elif options.output is not None or options.vtu is not None or options.pvd is not None:
        raise SceneError(f"--output, --vtu and --pvd are of one mesh. Name it by --mesh; known: {', '.join(names)}.")
    for number in wanted:
        own = mesh_run(dataset, train, number)
        folder = file.parent / names[number].replace(":", "")
        output = options.output or folder / (ANIMATION_FILE if options.animate else PICTURE_FILE)
        check_writable(output.parent, output.name)
        _draw(options, own, partial(stresses_of_mesh, dataset, train, number), stored_index(own, options.at), output)
    return 0


def _scene_of(file: Path, dataset):
    scene = scene_of(dataset)
    if scene is None:
        raise SceneError(f"{file}: the scene in it is none of this version. Run the scene again.")
    if not dataset.sizes["time"]:
        raise SceneError(f"{file}: no step is stored; there is nothing to draw")
    return scene


def _check_outputs(options, output: Path | None) -> None:
    for path in (output, options.vtu, options.pvd):
        if path is not None:
            check_writable(path.parent, path.name)
    for path, suffix in ((options.vtu, ".vtu"), (options.pvd, ".pvd")):
        if path is not None and path.suffix != suffix:
            raise SceneError(f"{path}: --{suffix[1:]} writes a {suffix} file; give it such a name")
        if path is not None and printable(str(path)) != str(path):
            raise SceneError(f"{path}: VTK writes only names in UTF-8; give it such a name")
    if output is None:
        return
    if options.animate:
        check_suffix(output)
    elif output.suffix != ".png":
        raise SceneError(
            f"{output}: a picture is a .png file; give --output such a name, or --animate for a moving one"
        )
