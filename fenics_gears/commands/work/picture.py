"""What ``gears picture`` does."""

import argparse
import sys
from contextlib import closing
from pathlib import Path

from fenics_gears.errors import SceneError
from fenics_gears.results.mesh_of_train import carried_train, mesh_run
from fenics_gears.show.run import scene_of
from fenics_gears.show.stress_animation import animate, check_suffix, save_series
from fenics_gears.show.stress_grid import save_vtu
from fenics_gears.show.stress_picture import save_picture, still
from fenics_gears.simulation.run_stresses import RunStresses
from fenics_gears.simulation.stored_forces import stored_index
from fenics_gears.system.console import printable
from fenics_gears.system.output import check_writable, write_whole

from ..shared import ANIMATION_FILE, PICTURE_FILE
from .runs import loaded_run, of_train, run_file, stages_beside
from .shared import print_files, shown_progress


def picture(options: argparse.Namespace) -> int:
    """Draw and export what is asked for; without --output and --animate, --vtu or --pvd alone writes no picture."""
    file = run_file(options.run)
    output = options.output or file.parent / (ANIMATION_FILE if options.animate else PICTURE_FILE)
    drawn = options.animate or options.output is not None or options.vtu is None and options.pvd is None
    _check_outputs(options, output if drawn else None)
    dataset = loaded_run(file, trains=True)
    if of_train(dataset):
        return _of_stages(options, file, dataset)
    scene = _scene_of(file, dataset)
    index = stored_index(dataset, options.at)
    with closing(shown_progress(options.quiet)) as progress:
        progress.stage("factorise sectors")
        written = _written(options, dataset, scene, index, output if drawn else None, progress)
    print_files(written, options.quiet)
    return 0


def _written(options, dataset, scene, index: int, output: Path | None, progress) -> list[Path]:
    written: list[Path] = []
    with RunStresses(dataset, scene) as runs:
        if options.vtu is not None:
            written.append(write_whole(options.vtu, lambda path: save_vtu(runs.at(index), path)))
        if options.pvd is not None:
            progress.stage("recover stresses")
            written.append(write_whole(options.pvd, lambda path: save_series(runs, dataset, path, progress.update)))
        if output is not None:
            progress.stage("draw")
            scale = options.scale
            if options.animate:
                written.append(write_whole(output, lambda path: animate(runs, dataset, path, scale, progress.update)))
            else:
                drawn = still(runs.at(index), dataset, scale)
                written.append(write_whole(output, lambda path: save_picture(drawn, path)))
    return written


def _of_stages(options: argparse.Namespace, file: Path, dataset) -> int:
    """Draw each stage of two gears of a train, in a folder by its name. Bodies of idlers have the forces of two meshes,
    which are not drawn."""
    train = carried_train(dataset)
    if options.output is not None or options.vtu is not None or options.pvd is not None:
        raise SceneError(f"--output, --vtu and --pvd are for the run of a pair. {stages_beside(file)}")
    if not train.alone:
        raise SceneError(
            f"{file}: gears of meshes that are computed together are not drawn yet. Allowed: trains with stages of two"
            " gears, without [shafts], [inertia] and [bearings]."
        )
    for number in train.alone:
        mesh = train.meshes[number]
        own = mesh_run(dataset, train, number)
        output = file.parent / mesh.name / (ANIMATION_FILE if options.animate else PICTURE_FILE)
        check_writable(output.parent, output.name)
        with closing(shown_progress(options.quiet)) as progress:
            written = _written(options, own, mesh.scene, stored_index(own, options.at), output, progress)
        print_files(written, options.quiet)
    if train.together and not options.quiet:
        print(f"Not drawn, since their meshes are computed together: {', '.join(train.together)}.", file=sys.stderr)
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
