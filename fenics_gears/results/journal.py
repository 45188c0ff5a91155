"""What a march has recorded, on disk while it goes on: it outlives a process that is killed, and takes no memory.

A directory with a file for each variable. The values of every block of steps are appended when it is done; then STATE,
which says how many steps are whole, is replaced. Nothing waits in the process to be written, as it would with HDF5.
What was written belongs to the operating system, which loses nothing when the process is killed.
"""

import json
import logging
import os
import shutil
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from io import FileIO
from math import prod
from mmap import ACCESS_COPY
from pathlib import Path

import numpy as np

import fenics_gears
from fenics_gears.dynamics.march import LONGEST_BLOCK
from fenics_gears.dynamics.marched import March
from fenics_gears.errors import ComputationError, GearsError
from fenics_gears.model.storage import Arrays, ArraysInMemory, Kind, Values
from fenics_gears.scene.data import Scene
from fenics_gears.scene.read import scene_from_text
from fenics_gears.system.memory import mapped
from fenics_gears.system.output import seal, unsealed

logger = logging.getLogger(__name__)

# A march that is over sooner keeps no journal.
SECONDS_WITHOUT = 2.0
HEADER = "journal.json"
STATE = "state.json"
DAMAGED = "it does not hold what was written into it"
# Additional places, so that values that a reader still needs are not overwritten while a block or two are written.
SPARE = 4 * LONGEST_BLOCK
# Names of the check sums of a step's values, and whether they are of contact fields.
CHECKS = {"check: curves": False, "check: fields": True}
CHECK = Kind(np.dtype(np.uint32), ())
# What a March counts, and the lists that it makes longer.
COUNTS = ("newton_iterations", "steps", "steps_by_method", "judged", "uncertified")
LISTS = {"separations": Kind(np.dtype(float), (2,)), "locked": Kind(np.dtype(np.int64), ())}


@dataclass(frozen=True)
class JournalPlace:
    """The `directory` of a journal, and the folder of the scene's file, by which a scene names others."""

    directory: Path
    scene_folder: Path = Path()


class Journal(ArraysInMemory):
    """Keeps values in memory for the first SECONDS_WITHOUT, then in files at a `place`; in memory again where these
    cannot be written."""

    def __init__(self, place: JournalPlace, scene: Scene, stored: Arrays, steps: int, last: int):
        super().__init__(stored, steps, last)
        self.place = place
        self.directory = place.directory
        self._scene = scene
        self._due = time.monotonic() + SECONDS_WITHOUT
        self._listed = dict.fromkeys(LISTS, (0, 0))
        self._files: dict[str, FileIO] = {}
        # How many steps are whole on disk.
        self._whole = 0

    def put(self, first: int, values: Values, march: March | None = None) -> None:
        """Keep the values of the steps from `first` on, as InMemory does, and the counts of the `march`."""
        if first < self._whole:
            # Taken again after Ctrl-C, which came as soon as they were whole.
            return
        if not self._files:
            super().put(first, values)
            if march is None or time.monotonic() < self._due:
                return
        try:
            if not self._files:
                self._begin(first + len(values["time"]))
            else:
                self._write(first, len(values["time"]), values)
            self._commit(first + len(values["time"]), march)
        except OSError as failure:
            logger.warning(
                "%s: %s. The run goes on without writing its steps as they come: if it is killed, they are lost.",
                self.directory,
                failure.strerror or failure,
            )
            self._give_up(first)
            super().put(first, values)

    def get(self, name: str, steps: int) -> np.ndarray:
        """As InMemory does; curves of all steps are not read into memory before they are used."""
        return _read(self._files[name], self.kinds[name], steps) if self._files else super().get(name, steps)

    def _write(self, first: int, count: int, values: Values) -> None:
        """Write values of so many steps from `first` on, contact fields of the last ones alone, and their check
        sums."""
        own = {name: np.ascontiguousarray(each, self.kinds[name].type) for name, each in values.items()}
        for name, each in own.items():
            _write(self._files[name], self.kinds[name], first + count - len(each), each)
        for check, of_fields in CHECKS.items():
            summed = [each for name, each in own.items() if bool(self.kinds[name].last) == of_fields]
            known = len(summed[0]) if summed else 0
            sums = np.zeros(count, np.uint32)
            sums[count - known :] = check_sums(first + count - known, known, summed)
            _write(self._files[check], CHECK, first, sums)

    def _begin(self, steps: int) -> None:
        remove(self.directory)
        # Of a process that was killed while it removed its own.
        (self.directory / STATE).unlink(missing_ok=True)
        self.directory.mkdir(parents=True, exist_ok=True)
        kinds = self.kinds | dict.fromkeys(CHECKS, CHECK) | LISTS
        header = {
            "version": fenics_gears.__version__,
            "scene": self._scene.text,
            "name": self._scene.name,
            "folder": str(self.place.scene_folder.absolute()),
            "steps": self.steps,
            "kinds": {
                name: [str(number), kind.type.str, kind.shape, kind.last]
                for number, (name, kind) in enumerate(kinds.items())
            },
        }
        self._write_text(HEADER, header)
        files = {name: open(self.directory / str(number), "w+b", buffering=0) for number, name in enumerate(kinds)}
        values = {name: super(Journal, self).get(name, steps) for name in self.kinds}
        try:
            for name, kind in self.kinds.items():
                if kind.last:
                    # A journal that begins late does not write all places, and readers map them all.
                    files[name].truncate(min(self.steps, kind.last + SPARE) * kind.type.itemsize * prod(kind.shape))
            self._files = files
            self._write(0, steps, values)
        except BaseException:
            # Nothing of memory has been given up yet.
            self._files = {}
            raise
        self._arrays = {}

    def _commit(self, steps: int, march: March) -> None:
        """Say that so many steps are whole."""
        for name, kind in LISTS.items():
            known, check = self._listed[name]
            longer = getattr(march, name)
            new = np.array(longer[known:], dtype=kind.type).reshape(-1, *kind.shape)
            _write(self._files[name], kind, known, new)
            self._listed[name] = len(longer), check + int(check_sums(known, len(new), [new]).sum())
        self._write_text(
            STATE, {"steps": steps, "march": {name: getattr(march, name) for name in COUNTS}, "listed": self._listed}
        )
        self._whole = steps

    def _write_text(self, name: str, content: dict) -> None:
        text = json.dumps(content).encode()
        aside = self.directory / f"{name}.{os.getpid()}"
        aside.write_bytes(text + seal(text))
        os.replace(aside, self.directory / name)

    def _give_up(self, steps: int) -> None:
        """Hold the values of the first so many steps in memory again, and remove the directory."""
        if self._files:
            for name, kind in self.kinds.items():
                self._arrays[name] = np.empty((kind.last or self.steps, *kind.shape), kind.type)
                self._arrays[name][kind.places(kind.kept_from(steps), steps)] = self.get(name, steps)
        self._files = {}
        self._due = float("inf")
        self._whole = 0
        with suppress(OSError):
            remove(self.directory)


@dataclass(frozen=True)
class Recorded:
    """The content of a journal: the run's `scene`, how many `steps` it was to have after the start, the `march` so far,
    and `values` by name."""

    scene: Scene
    steps: int
    march: dict
    values: dict[str, np.ndarray]

    def get(self, name: str, steps: int) -> np.ndarray:
        return self.values[name]


def is_journal(path: Path) -> bool:
    """Whether a directory is a journal, of which at least a block of steps is whole."""
    return (path / HEADER).is_file() and (path / STATE).is_file()


def remove(directory: Path) -> None:
    if (directory / HEADER).is_file():
        shutil.rmtree(directory)


def read(directory: Path) -> Recorded:
    """What a journal holds, also one that is still written. Raises ComputationError where it is damaged or of another
    version of the program."""
    try:
        header = _text(directory / HEADER)
        state = _text(directory / STATE)
        if header["version"] != fenics_gears.__version__:
            raise ValueError(
                f"only version {header['version']} of this program, which wrote it, can read it; this is"
                f" {fenics_gears.__version__}"
            )
        kinds = {
            name: (number, Kind(np.dtype(kind), tuple(shape), last))
            for name, (number, kind, shape, last) in header["kinds"].items()
        }
        lengths = dict.fromkeys(kinds, state["steps"]) | {name: length for name, (length, _) in state["listed"].items()}
        values = {}
        for name, (number, kind) in kinds.items():
            with open(directory / number, "rb") as file:
                values[name] = _read(file, kind, lengths[name])
        # What a run that goes on has written over since, with the block that it is writing.
        later = _text(directory / STATE)["steps"] + LONGEST_BLOCK
        fields = {name: kind for name, (_, kind) in kinds.items() if kind.last}
        for name, kind in fields.items():
            values[name] = values[name][max(later - (kind.last + SPARE) - kind.kept_from(state["steps"]), 0) :]
        listed = {name: values.pop(name) for name in LISTS}
        if any(int(check_sums(0, len(own), [own]).sum()) != state["listed"][name][1] for name, own in listed.items()):
            raise ValueError(DAMAGED)
        _check(state["steps"], values, fields)
        scene = scene_from_text(header["scene"], header["name"], directory=Path(header["folder"]))
    except (OSError, ValueError, KeyError, GearsError) as failure:
        raise ComputationError(f"{directory}: cannot be read as the journal of a run: {failure}") from failure
    separations = [(int(step), float(opening)) for step, opening in listed["separations"]]
    march = state["march"] | {"separations": separations, "locked": listed["locked"].tolist()}
    return Recorded(scene, header["steps"] - 1, march, values)


def check_sums(first: int, count: int, values: Sequence[np.ndarray]) -> np.ndarray:
    """Check sum (s,) of values (s, ...) of so many steps from `first` on: every word, and which step it is, has a part
    in it."""
    sums = np.arange(first + 1, first + 1 + count).astype(np.uint32)
    for own in values:
        flat = own.reshape(len(own), -1) if own.size else np.zeros((len(own), 1))
        words = flat.view(np.uint32 if flat.strides[0] % 4 == 0 else np.uint8).astype(np.uint32)
        # Odd factors: no bit of a word is without effect.
        sums = sums * np.uint32(31) + words @ (2 * np.arange(words.shape[1], dtype=np.uint32) + 1)
    return sums


def _check(steps: int, values: dict[str, np.ndarray], fields: Mapping[str, Kind]) -> None:
    """Raise ValueError where the values are not those whose check sums they have; takes the sums out."""
    for check, of_fields in CHECKS.items():
        own = [each for name, each in values.items() if (name in fields) == of_fields and name not in CHECKS]
        count = min(map(len, own), default=0)
        if not np.array_equal(check_sums(steps - count, count, own), values[check][steps - count :]):
            raise ValueError(DAMAGED)
    for check in CHECKS:
        del values[check]


def _text(path: Path) -> dict:
    """The content of a sealed file of JSON. Raises ValueError where it is damaged."""
    with unsealed(path) as file:
        return json.JSONDecoder().raw_decode(file.read().decode())[0]


def _write(file: FileIO, kind: Kind, first: int, values: np.ndarray) -> None:
    own = np.ascontiguousarray(values, kind.type)
    size = kind.type.itemsize * prod(kind.shape)
    room = kind.last + SPARE if kind.last else first + len(own)
    while len(own):
        place = first % room
        left = memoryview(own[: room - place]).cast("B")
        offset = place * size
        first = first + room - place
        own = own[room - place :]
        while left:
            written = os.pwrite(file.fileno(), left, offset)
            left = left[written:]
            offset = offset + written


def _read(file: FileIO, kind: Kind, steps: int) -> np.ndarray:
    """The values of the first so many steps that are kept, in the order of time; not read before they are used."""
    if not steps:
        return np.empty((0, *kind.shape), kind.type)
    length = min(steps, kind.last + SPARE) if kind.last else steps
    count = length * prod(kind.shape)
    try:
        # Whoever changes the values changes them in memory only.
        content = np.frombuffer(mapped(file.fileno(), count * kind.type.itemsize, access=ACCESS_COPY), kind.type)
    except MemoryError:
        # What was freed may hold them, where addresses have come to an end.
        content = np.empty(count, kind.type)
        os.preadv(file.fileno(), [content], 0)
    return content.reshape(length, *kind.shape)[kind.places(kind.kept_from(steps), steps, SPARE)]
