"""What ``gears run`` does: the scene is checked first, since a scene that is refused shall not wait for libraries."""

import argparse

from fenics_gears.show import FACE_PICTURE_FILES, PICTURE_FILES
from fenics_gears.system.job import Job, led

from ..shared import RUN_FILE
from .scenes import checked_model_and_directory, train_in


def run(options: argparse.Namespace) -> int:
    return led(lambda job: _run(options, job))


def _run(options: argparse.Namespace, job: Job | None) -> int:
    if (train := train_in(options.scene)) is not None:
        from .train import run_train

        return run_train(train, options)
    model, directory = checked_model_and_directory(options, RUN_FILE, *PICTURE_FILES, *FACE_PICTURE_FILES)
    from .kept_run import run_and_keep

    return run_and_keep(model, directory, options, job)
