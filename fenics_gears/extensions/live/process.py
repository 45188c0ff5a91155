"""The computing process as the server has it: started, listened to, and started anew where it ends."""

from __future__ import annotations

from collections.abc import Callable
from multiprocessing import get_context
from multiprocessing.connection import Connection
from threading import Lock, Thread
from typing import Any

from .computing import END, Work, serve

ENDED = "The process that computes has ended, perhaps for want of memory. It was started anew: change something."


class ComputingProcess:
    """Takes work at any time, and hands on what it answers from a thread of its own."""

    def __init__(self, name: str, directory: str):
        self._arguments = name, directory
        self._lock = Lock()
        self._over = False
        self._connection: Connection | None = None
        self._process: Any = None

    def start(self, answered: Callable[[dict[str, Any]], None]) -> None:
        self._begin()
        Thread(target=self._listen, args=(answered,), daemon=True).start()

    def send(self, work: Work) -> None:
        with self._lock:
            try:
                if self._connection is not None:
                    self._connection.send(work)
            except OSError:
                # It has just ended, which the thread that listens says.
                pass

    def end(self) -> None:
        self._over = True
        self.send(Work(END))
        if self._process is not None:
            self._process.join(1.0)
            self._process.kill()

    def _begin(self) -> None:
        # A copy of this process would have its threads and sockets.
        context = get_context("spawn")
        ours, theirs = context.Pipe()
        process = context.Process(target=serve, args=(theirs, *self._arguments), daemon=True)
        process.start()
        theirs.close()
        with self._lock:
            self._connection = ours
            self._process = process

    def _listen(self, answered: Callable[[dict[str, Any]], None]) -> None:
        while True:
            connection = self._connection
            assert connection is not None
            try:
                answered(connection.recv())
            except (EOFError, OSError):
                if self._over:
                    return
                self._process.join()
                self._begin()
                answered({"kind": "ended", "message": ENDED})
