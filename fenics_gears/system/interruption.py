"""When Ctrl-C takes effect: in a counted stage between its parts, elsewhere at once, and not while a result is
written."""

from __future__ import annotations

import signal
import threading

from fenics_gears.system.progress import Progress


class Interruption:
    """A ``Progress`` that passes everything on and decides when Ctrl-C becomes a KeyboardInterrupt.

    Within a counted stage it waits for the next ``update``: compiled code that it hit in the middle would end in a
    SystemError, a step in the middle would be half done. A second Ctrl-C does not wait. Use it as a context manager.
    """

    def __init__(self, progress: Progress):
        self._progress = progress
        self._counting = self._asked = self._ignoring = False

    @property
    def finished(self) -> list[tuple[str, float]]:
        """Names and seconds of the stages that are over."""
        return self._progress.finished

    def __enter__(self) -> Interruption:
        """Take Ctrl-C over; only the main thread can."""
        self._here = threading.current_thread() is threading.main_thread()
        if self._here:
            self._before = signal.signal(signal.SIGINT, self._on_interrupt)
        return self

    def __exit__(self, *_) -> None:
        """Give Ctrl-C back and end the progress."""
        self._progress.close()
        if self._here:
            signal.signal(signal.SIGINT, self._before)

    def stage(self, name: str) -> None:
        """Begin a stage; until its first ``update`` Ctrl-C acts at once."""
        self._counting = False
        self._progress.stage(name)

    def update(self, done: int, total: int, note: str = "") -> None:
        """Pass the count on; raises KeyboardInterrupt where Ctrl-C was pressed since the last one."""
        self._counting = True
        self._progress.update(done, total, note)
        if self._asked:
            raise KeyboardInterrupt

    def close(self) -> None:
        """End the progress."""
        self._progress.close()

    def ignore(self) -> None:
        """Let no Ctrl-C come between a result and its file; it is remembered. Ends the progress."""
        self._ignoring = True
        self._progress.close()

    def heed(self) -> None:
        """Let Ctrl-C act at once from here on; raises KeyboardInterrupt where one was remembered."""
        self._ignoring = self._counting = False
        if self._asked:
            raise KeyboardInterrupt

    def _on_interrupt(self, *_) -> None:
        if not self._ignoring and (self._asked or not self._counting):
            raise KeyboardInterrupt
        self._asked = True
