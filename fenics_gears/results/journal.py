"""What a march has recorded, on disk while it goes on: it outlives a process that is killed, and takes no memory.

A directory of plain files, a file for each variable, to which the values of every block of steps are written when the block is done; then
STATE, which says how many steps are whole, is replaced. Nothing waits in the process to be written: what was written is in the hands of the
operating system, which loses nothing of it when the process is killed. HDF5 keeps parts of its files in the process; what a kill leaves of
them cannot always be opened.
"""

from __future__ import annotations

import json
import logging
import os
import shutil
import time
from contextlib import suppress
from dataclasses import dataclass
from io import FileIO
from math import prod
from mmap import ACCESS_COPY, mmap
from pathlib import Path

import numpy as np

import fenics_gears
from fenics_gears.dynamics.march import LONGEST_BLOCK, March
from fenics_gears.errors import ComputationError, GearsError
from fenics_gears.model.storage import Arrays
from fenics_gears.results.kept import InMemory, Kind, Values
from fenics_gears.scene.data import Scene
from fenics_gears.scene.read import scene_from_text

logger = logging.getLogger(__name__)

# A march that is over sooner keeps no journal.
SECONDS_WITHOUT = 2.0
HEADER, STATE = "journal.json", "state.json"
# Places beside those of the last steps: values that a reader still needs are not overwritten while a block or two are written.
SPARE = 4 * LONGEST_BLOCK
# What a March counts, and the lists that it makes longer; their files.
COUNTS = ("newton_iterations", "steps", "steps_by_method", "judged", "uncertified")
LISTS = {"separations": Kind(np.dtype(float), (2,)), "locked": Kind(np.dtype(np.int64), ())}


@dataclass(frozen=True)
class Place:
    """The `directory` of a journal, and the folder of the scene's file, by which a scene names others."""

    directory: Path
    scene_folder: Path = Path()


class Journal(InMemory):
    """Keeps values in memory for the first SECONDS_WITHOUT, then in files; in memory again where these cannot be written.

    `place`: the directory, and where files that the `scene` names are looked for.
    """

    def __init__(self, place: Place, scene: Scene, stored: Arrays, steps: int, last: int):
        super().__init__(stored, steps, last)
        self.place, self.directory, self._scene = place, place.directory, scene
        self._due, self._listed = time.monotonic() + SECONDS_WITHOUT, dict.fromkeys(LISTS, 0)
        self._files: dict[str, FileIO] = {}

    def put(self, first: int, values: Values, march: March | None = None) -> None:
        """Keep the values of the steps from `first` on, as InMemory does, and the counts of the `march`."""
        if not self._files:
            super().put(first, values)
            if march is None or time.monotonic() < self._due:
                return
        try:
            if not self._files:
                self._begin(first + len(values["time"]))
            else:
                for name, own in values.items():
                    _write(self._files[name], self.kinds[name], first, own)
            self._commit(first + len(values["time"]), march)
        except OSError as failure:
            logger.warning(
                "%s: %s. The run goes on without writing its steps as they come: if it is killed, they are lost.", self.directory, failure.strerror or failure
            )
            self._give_up(first)
            super().put(first, values)

    def get(self, name: str, steps: int) -> np.ndarray:
        """As InMemory does; curves of all steps are not read into memory before they are used."""
        return _read(self._files[name], self.kinds[name], steps) if self._files else super().get(name, steps)

    def _begin(self, steps: int) -> None:
        """Write all values so far, and hold them no longer."""
        remove(self.directory)
        self.directory.mkdir(parents=True)
        kinds = self.kinds | LISTS
        header = {
            "version": fenics_gears.__version__, "scene": self._scene.text, "name": self._scene.name, "folder": str(self.place.scene_folder.absolute()), "steps": self.steps,
            "kinds": {name: [str(number), kind.type.str, kind.shape, kind.last] for number, (name, kind) in enumerate(kinds.items())},
        }  # fmt: skip
        (self.directory / HEADER).write_text(json.dumps(header), encoding="utf-8")
        files = {name: open(self.directory / str(number), "w+b", buffering=0) for number, name in enumerate(kinds)}
        for name, kind in self.kinds.items():
            _write(files[name], kind, kind.kept_from(steps), super().get(name, steps))
        self._files, self._arrays = files, {}

    def _commit(self, steps: int, march: March) -> None:
        """Say that so many steps are whole."""
        for name, kind in LISTS.items():
            known, longer = self._listed[name], getattr(march, name)
            _write(self._files[name], kind, known, np.array(longer[known:], dtype=kind.type).reshape(-1, *kind.shape))
            self._listed[name] = len(longer)
        state = {"steps": steps, "march": {name: getattr(march, name) for name in COUNTS}, "listed": self._listed}
        aside = self.directory / f"{STATE}.{os.getpid()}"
        aside.write_text(json.dumps(state), encoding="utf-8")
        os.replace(aside, self.directory / STATE)

    def _give_up(self, steps: int) -> None:
        """Hold the values of the first so many steps in memory again, and remove the directory."""
        if self._files:
            for name, kind in self.kinds.items():
                self._arrays[name] = np.empty((kind.last or self.steps, *kind.shape), kind.type)
                self._arrays[name][kind.places(kind.kept_from(steps), steps)] = self.get(name, steps)
        self._files, self._due = {}, float("inf")
        with suppress(OSError):
            remove(self.directory)


@dataclass(frozen=True)
class Recorded:
    """What a journal holds of a run: its `scene`, how many `steps` it was to have beside the start, the `march` so far, and `values` by name."""

    scene: Scene
    steps: int
    march: dict
    values: dict[str, np.ndarray]

    def get(self, name: str, steps: int) -> np.ndarray:
        """The values of a variable, of all steps."""
        return self.values[name]


def is_journal(path: Path) -> bool:
    """Whether a directory is a journal, of which at least a block of steps is whole."""
    return (path / HEADER).is_file() and (path / STATE).is_file()


def remove(directory: Path) -> None:
    """Remove a journal, if there is one."""
    if (directory / HEADER).is_file():
        shutil.rmtree(directory)


def read(directory: Path) -> Recorded:
    """What a journal holds, also one that is still written. Raises ComputationError where it is damaged or of another version of the program."""
    try:
        header = json.loads((directory / HEADER).read_text(encoding="utf-8"))
        if header["version"] != fenics_gears.__version__:
            raise ValueError(f"it was written by version {header['version']} of this program, which can read it; this is {fenics_gears.__version__}")
        kinds = {name: (number, Kind(np.dtype(kind), tuple(shape), last)) for name, (number, kind, shape, last) in header["kinds"].items()}
        state = json.loads((directory / STATE).read_text(encoding="utf-8"))
        lengths = dict.fromkeys(kinds, state["steps"]) | state["listed"]
        values = {}
        for name, (number, kind) in kinds.items():
            with open(directory / number, "rb") as file:
                values[name] = _read(file, kind, lengths[name])
        later = json.loads((directory / STATE).read_text(encoding="utf-8"))
        scene = scene_from_text(header["scene"], header["name"], directory=Path(header["folder"]))
    except (OSError, ValueError, KeyError, GearsError) as failure:
        raise ComputationError(f"{directory}: cannot be read as the journal of a run: {failure}") from failure
    # What a run that goes on has written over since, with the block that it is writing.
    for name, (_, kind) in kinds.items():
        if kind.last:
            overwritten = later["steps"] + LONGEST_BLOCK - (kind.last + SPARE)
            values[name] = values[name][max(overwritten - kind.kept_from(state["steps"]), 0) :]
    march = state["march"] | {name: values.pop(name).tolist() for name in LISTS}
    march["separations"] = [(int(step), opening) for step, opening in march["separations"]]
    return Recorded(scene, header["steps"] - 1, march, values)


def _write(file: FileIO, kind: Kind, first: int, values: np.ndarray) -> None:
    """Write the values of the steps from `first` on to their places."""
    own, size = np.ascontiguousarray(values, kind.type), kind.type.itemsize * prod(kind.shape)
    room = kind.last + SPARE if kind.last else first + len(own)
    while len(own):
        place = first % room
        left, offset = memoryview(own[: room - place]).cast("B"), place * size
        first, own = first + room - place, own[room - place :]
        while left:
            written = os.pwrite(file.fileno(), left, offset)
            left, offset = left[written:], offset + written


def _read(file: FileIO, kind: Kind, steps: int) -> np.ndarray:
    """The values of the first so many steps that are kept, in the order of time; not read before they are used."""
    if not steps:
        return np.empty((0, *kind.shape), kind.type)
    length = min(steps, kind.last + SPARE) if kind.last else steps
    # Whoever changes the values changes them in memory only.
    content = mmap(file.fileno(), length * kind.type.itemsize * prod(kind.shape), access=ACCESS_COPY)
    return np.frombuffer(content, kind.type).reshape(length, *kind.shape)[kind.places(kind.kept_from(steps), steps, SPARE)]
