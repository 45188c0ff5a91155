"""What a march has recorded, in a file while it goes on: it outlives a process that is killed.

The file is written anew each time, and takes its name when it is whole. The longer that takes, the less often it is
done.
"""

import json
import logging
import os
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import fenics_gears
from fenics_gears.dynamics.marched import March
from fenics_gears.errors import ComputationError, GearsError
from fenics_gears.model.storage import ArraysInMemory
from fenics_gears.scene.data import Scene
from fenics_gears.scene.read import scene_from_text
from fenics_gears.system.output import seal_of, unsealed, whole_file

logger = logging.getLogger(__name__)

# A march that is over sooner keeps no journal.
SECONDS_WITHOUT = 2.0
# Time between two writes, in that of a write.
APART = 20.0
HEADER = "header"
# What a March counts, and the lists that it makes longer.
COUNTS = ("newton_iterations", "steps", "steps_by_method", "judged", "uncertified")
LISTS = ("separations", "locked")


@dataclass(frozen=True)
class JournalPlace:
    """The `file` of a journal, and the folder of the scene's file, by which a scene names others."""

    file: Path
    scene_folder: Path = Path()


class Journal:
    """Writes what is recorded of a run of a `scene` to a `place`; no more where that cannot be written."""

    def __init__(self, place: JournalPlace, scene: Scene):
        self._place = place
        self._scene = scene
        self._due = time.monotonic() + SECONDS_WITHOUT

    def write(self, room: ArraysInMemory, steps: int, march: March) -> None:
        """Write the values of the first so many steps, and the counts of the `march`, where it is time to."""
        begun = time.monotonic()
        if begun < self._due:
            return
        header = {
            "version": fenics_gears.__version__,
            "scene": self._scene.text,
            "name": self._scene.name,
            "folder": str(self._place.scene_folder.absolute()),
            "steps": room.steps,
            "march": {name: getattr(march, name) for name in COUNTS},
        }
        values = {name: room.get(name, steps) for name in room.kinds}
        values |= {name: np.array(getattr(march, name)) for name in LISTS}
        try:
            with whole_file(self._place.file) as file:
                np.savez(file, **{HEADER: json.dumps(header)}, **values)
                file.write(seal_of(file, file.seek(0, os.SEEK_END)))
        except OSError as failure:
            logger.warning(
                "%s: %s. The run goes on without writing its steps as they come: if it is killed, they are lost.",
                self._place.file,
                failure.strerror or failure,
            )
            self._due = float("inf")
        else:
            now = time.monotonic()
            self._due = now + APART * (now - begun)


@dataclass(frozen=True)
class Recorded:
    """The content of a journal: the run's `scene`, how many `steps` it was to have after the start, the `march` so far,
    and the `values` of its steps by name."""

    scene: Scene
    steps: int
    march: dict
    values: dict[str, np.ndarray]

    def get(self, name: str, steps: int) -> np.ndarray:
        return self.values[name]


def read(path: Path) -> Recorded:
    """What a journal holds, also one that is still written. Raises ComputationError where it is damaged or of another
    version."""
    try:
        with unsealed(path) as file, np.load(file) as stored:
            values = dict(stored)
        header = json.loads(str(values.pop(HEADER)))
        if header["version"] != fenics_gears.__version__:
            raise ValueError(
                f"only version {header['version']} of this program, which wrote it, can read it; this is"
                f" {fenics_gears.__version__}"
            )
        scene = scene_from_text(header["scene"], header["name"], directory=Path(header["folder"]))
    except (OSError, ValueError, KeyError, GearsError) as failure:
        raise ComputationError(f"{path}: cannot be read as the journal of a run: {failure}") from failure
    separations = [(int(step), float(opening)) for step, opening in values.pop("separations")]
    march = header["march"] | {"separations": separations, "locked": values.pop("locked").astype(int).tolist()}
    return Recorded(scene, header["steps"] - 1, march, values)
