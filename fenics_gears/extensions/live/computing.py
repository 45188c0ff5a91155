"""The process that computes: the newest scene first, gears and contact operators kept from one to the next.

It is told by `Work`, and answers with dictionaries as the page reads them, each with the number of the scene it is of.
"""

from __future__ import annotations

import io
import signal
import traceback
import zipfile
from collections.abc import Callable
from contextlib import redirect_stderr, suppress
from dataclasses import dataclass, replace
from functools import partial
from multiprocessing.connection import Connection
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from fenics_gears import ComputationError, GearsError, simulate, simulate_train
from fenics_gears.charts import draw_run
from fenics_gears.command_line import PICTURE_FILE, REPORT_FILE, main
from fenics_gears.many_runs import CommonWindows, GearStore, Progress, save, settled_run
from fenics_gears.scene_text import Models, NoScene, Tree, is_train

from .settled import with_steps
from .shown import shown, shown_train

RUN = "run"
PICTURES = "pictures"
REPORT = "report"
RESULT = "result"
STRESS = "stress"
END = "end"


@dataclass(frozen=True)
class Work:
    """What is asked for: a `kind`, the number of the scene, and its parsed text. `steps`: of a mesh cycle, in place of
    the scene's, for a first look. `reach`: scenes whose contact nodes this one is to have as well."""

    kind: str
    number: int = 0
    tree: Any = None
    steps: int | None = None
    reach: tuple[Any, ...] = ()


class Told(Progress):
    """Tells the page how far a run is; gives a run up once something newer is asked for."""

    def __init__(self, tell: Callable[[dict[str, Any]], None], number: int, newer: Callable[[], bool]):
        self._tell = tell
        self._number = number
        self._newer = newer
        self._stage = ""

    def stage(self, name: str) -> None:
        self._stage = name
        self._say(0, 0)

    def update(self, done: int, total: int, note: str = "") -> None:
        self._say(done, total)

    def _say(self, done: int, total: int) -> None:
        if self._newer():
            raise KeyboardInterrupt
        self._tell({"kind": "progress", "number": self._number, "stage": self._stage, "done": done, "total": total})


class Computing:
    """Answers what comes through a connection, until that is closed."""

    def __init__(self, connection: Connection, name: str, directory: str):
        self._connection = connection
        self._models = Models(name, Path(directory))
        self._windows = CommonWindows()
        self._store = GearStore()
        # Of first looks at trains, which have operators of their own.
        self._looks = GearStore()
        # Scenes to be within reach, and the steps for which their windows are known.
        self._reach: tuple[Any, ...] = ()
        self._reached: set[int | None] = set()
        self._name = name
        self._result: Any = None
        self._waiting: list[Work] = []

    def answer_all(self) -> None:
        while (work := self._next()) is not None:
            self._answer(work)

    def _next(self) -> Work | None:
        """The next thing to do: the newest scene, then files of it; None at the end."""
        try:
            if not self._waiting:
                self._waiting.append(self._connection.recv())
            self._receive()
        except (EOFError, OSError):
            return None
        if any(each.kind == END for each in self._waiting):
            return None
        runs = [each for each in self._waiting if each.kind == RUN]
        files = [each for each in self._waiting if each.kind != RUN]
        self._waiting = files if runs else files[1:]
        return runs[-1] if runs else files[0]

    def _receive(self) -> None:
        while self._connection.poll():
            self._waiting.append(self._connection.recv())

    def _newer(self) -> bool:
        """Whether the present run is of no use any more."""
        self._receive()
        return any(each.kind in (RUN, END) for each in self._waiting)

    def _answer(self, work: Work) -> None:
        own = {"number": work.number, "of": work.kind}
        try:
            answer = self._run(work) if work.kind == RUN else self._file(work)
        except KeyboardInterrupt:
            answer = {"kind": "left"}
        except NoScene as error:
            problems = [{"path": ".".join(each.path), "message": each.message} for each in error.problems]
            answer = {"kind": "mistakes", "problems": problems}
        except GearsError as error:
            answer = {"kind": "failed", "message": str(error)}
        except MemoryError:
            answer = {"kind": "failed", "message": "The memory of this machine is not enough for this run."}
        except Exception as error:
            # The page goes on with the next scene; who reports the defect needs the place.
            answer = {"kind": "failed", "message": f"{type(error).__name__}: {error}", "trace": traceback.format_exc()}
        self._connection.send(own | answer)

    def _run(self, work: Work) -> dict[str, Any]:
        told = Told(self._connection.send, work.number, self._newer)
        model = self._model(work)
        first_look = {"kind": "result", "first_look": work.steps is not None}
        if is_train(work.tree):
            store = self._store if work.steps is None else self._looks
            store.of_pairs(len(model.rows))
            found = simulate_train(model, told, preparation=store.prepared, kept_row=store.row)
            self._result = found
            return first_look | shown_train(found, model.scene)
        if work.steps is not None:
            model = replace(model, resolution=replace(model.resolution, steps_per_mesh_cycle=work.steps))
        if work.steps is None:
            result = simulate(model, progress=told, preparation=self._store.prepared)
        else:
            # Without proposed lead modifications, which take longer than few steps.
            result = settled_run(model, told, preparation=self._store.prepared).dataset
        if not result.attrs["complete"]:
            raise KeyboardInterrupt
        self._result = result
        return first_look | shown(result, model.pair)

    def _model(self, work: Work) -> Any:
        """That of the scene, with contact nodes that others within reach have too."""

        def model(tree: Tree) -> Any:
            few = work.steps is not None and is_train(tree)
            return self._models.of(with_steps(tree, work.steps) if few else tree)

        models = [model(work.tree)]
        if work.reach:
            self._reach = work.reach
        # First looks at trains share no operators with what follows.
        new = work.steps not in self._reached
        self._reached.add(work.steps)
        for tree in self._reach if new else ():
            # A slider may go where there is no scene.
            with suppress(NoScene):
                models.append(model(tree))
        return self._windows.of(models)[0]

    def _file(self, work: Work) -> dict[str, Any]:
        """A file that the page has asked for."""
        if self._result is None:
            return {"kind": "failed", "message": "There is no result yet."}
        return {"kind": "file", "content": FILES[work.kind](self._result, self._name)}


def _pictures(result: Any, name: str) -> bytes:
    packed = io.BytesIO()
    with TemporaryDirectory() as folder, zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in draw_run(result, Path(folder)):
            archive.write(file, f"{name}/{file.name}")
    return packed.getvalue()


def _report(result: Any, name: str) -> bytes:
    return _of_saved(result, name, partial(_written_by, "report", REPORT_FILE))


def _stress(result: Any, name: str) -> bytes:
    return _of_saved(result, name, partial(_written_by, "picture", PICTURE_FILE))


def _written_by(command: str, name: str, file: Path) -> bytes:
    """What a command writes on a run, into a file of this name. Raises ComputationError with what it says where it
    fails."""
    own = file.with_name(name)
    with redirect_stderr(io.StringIO()) as said:
        failed = main([command, str(file), "-o", str(own), "-q"])
    if failed:
        raise ComputationError(said.getvalue().strip())
    return own.read_bytes()


def _result(result: Any, name: str) -> bytes:
    return _of_saved(result, name, Path.read_bytes)


def _of_saved(result: Any, name: str, content: Callable[[Path], bytes]) -> bytes:
    """What is made of a result in a file."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / f"{name}.nc"
        save(result, file)
        return content(file)


FILES = {PICTURES: _pictures, REPORT: _report, RESULT: _result, STRESS: _stress}


def serve(connection: Connection, name: str, directory: str) -> None:
    """Be the process that computes."""
    # Ctrl-C goes to the whole group; who started this process ends it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Computing(connection, name, directory).answer_all()
