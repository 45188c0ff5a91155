"""Progress of a computation: a bar on a terminal, timed lines elsewhere, nothing when asked to be quiet; and when
Ctrl-C takes effect."""

from __future__ import annotations

import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from typing import TextIO, TypeVar

SECONDS_BETWEEN_LINES = 5.0
# A stage begins with what takes longest, such as compiling. The time left is said once a tenth is done, or once a
# minute is over, by the pace of its later half.
ENOUGH_DONE = 0.1
ENOUGH_SECONDS = 60.0


Part = TypeVar("Part")
Finished = list[tuple[str, float]]
"""Names and seconds of stages that are over."""


class Progress:
    """What a computation reports to; ``finished``: the stages that are over, with the seconds that are said of them."""

    finished: Finished = []

    def stage(self, name: str) -> None:
        """Begin the stage of that name, for instance "condense pinion"; the one before it is over."""

    def update(self, done: int, total: int, note: str = "") -> None:
        """Say that ``done`` of ``total`` parts of the present stage are done; ``note``: what else there is to say, such
        as "2 failed"."""

    def say(self, sentence: str) -> None:
        """Tell what no stage says, such as why the present one takes its time."""

    def counted(self, parts: Sequence[Part], name: Callable[[Part], str] = lambda part: "") -> Iterator[Part]:
        """The parts of the present stage one after the other, counted; `name`: the note after the count."""
        for done, part in enumerate(parts):
            self.update(done, len(parts), name(part))
            yield part
        self.update(len(parts), len(parts))

    def close(self) -> None:
        """End the last stage."""


class SilentProgress(Progress):
    """Shows nothing and measures nothing."""


class LineProgress(Progress):
    """One plain line per finished stage, and one every few seconds while a stage goes on."""

    def __init__(self, stream: TextIO | None = None, interval: float = SECONDS_BETWEEN_LINES, clock=time.monotonic):
        self._stream = stream if stream is not None else sys.stderr
        self._interval = interval
        self._clock = clock
        self.finished: Finished = []
        self._begin(None)

    def _begin(self, name: str | None) -> None:
        self._name = name
        self._begun = self._spoken = self._clock()
        # Times and counts of the lines.
        self._seen = [(self._begun, 0)]

    def stage(self, name: str) -> None:
        self.close()
        self._begin(name)

    def update(self, done: int, total: int, note: str = "") -> None:
        now = self._clock()
        if now - self._spoken < self._interval or total <= 0:
            return
        self._spoken = now
        elapsed = now - self._begun
        said = f", {note}" if note else ""
        self._print(
            f"{self._name or 'work'}: {done} of {total} ({100 * done // total} %){said} after"
            f" {seconds_in_words(elapsed)}{self._left(now, done, total)}"
        )

    def _left(self, now: float, done: int, total: int) -> str:
        then, before = next((each for each in reversed(self._seen) if 2 * each[1] <= done), self._seen[0])
        if done != self._seen[-1][1]:
            self._seen.append((now, done))
        if done <= before or not is_enough(done, total, now - self._begun):
            return ""
        # Large parts are counted from the end of the last one.
        since = self._seen[-1][0]
        left = (since - then) * (total - done) / (done - before) - (now - since)
        return f", about {seconds_in_words(left)} left" if left > 0.0 else ""

    def close(self) -> None:
        if self._name is not None:
            self.finished.append((self._name, self._clock() - self._begun))
            self._print(f"{self._name}: {seconds_in_words(self.finished[-1][1])}")
        self._name = None

    def say(self, sentence: str) -> None:
        self._print(sentence)

    def _print(self, line: str) -> None:
        print(line, file=self._stream, flush=True)


class BarProgress(Progress):
    """A bar with the time left for each stage, drawn by rich on a terminal."""

    def __init__(self, console):
        from rich import progress
        from rich.text import Text

        class Remaining(progress.TimeRemainingColumn):
            """Nothing before enough is known."""

            def render(self, task):
                known = is_enough(task.completed, task.total or 0, task.elapsed or 0.0)
                return super().render(task) if task.finished or known else Text("-:--:--", style="progress.remaining")

        described = progress.TextColumn("{task.description}")
        left = progress.TextColumn("left")
        columns = (described, progress.BarColumn(), progress.MofNCompleteColumn(), progress.TimeElapsedColumn(), left)
        self._bars = progress.Progress(*columns, Remaining(), console=console)
        self._task = None
        self._counted = False
        self.finished: Finished = []

    def stage(self, name: str) -> None:
        self._finish_stage()
        self._bars.start()
        self._name = name
        self._task = self._bars.add_task(name, total=None)
        self._counted = False

    def update(self, done: int, total: int, note: str = "") -> None:
        if self._task is None:
            self.stage("work")
        self._counted = True
        said = {"description": f"{self._name}, {note}"} if note else {}
        self._bars.update(self._task, completed=done, total=total, **said)

    def say(self, sentence: str) -> None:
        self._bars.console.print(sentence)

    def close(self) -> None:
        self._finish_stage()
        self._bars.stop()
        # A stage that begins later draws itself alone.
        for each in self._bars.task_ids:
            self._bars.remove_task(each)

    def _finish_stage(self) -> None:
        # A counted stage keeps its count: after an interruption the bar must not claim to be full.
        if self._task is None:
            return
        if not self._counted:
            self._bars.update(self._task, total=1, completed=1)
        self._bars.stop_task(self._task)
        # Their places in the list are not their numbers, once some are removed.
        task = next(each for each in self._bars.tasks if each.id == self._task)
        self._task = None
        self.finished.append((self._name, task.finished_time or task.elapsed))


def is_enough(done: float, total: float, elapsed: float) -> bool:
    """Whether the time left of a stage can be told."""
    return done >= ENOUGH_DONE * total or elapsed >= ENOUGH_SECONDS


def seconds_in_words(seconds: float) -> str:
    """A duration in s as a person writes it: "0.4 s", "75 s", "12 min", "3.5 h"."""
    if seconds < 10:
        return f"{seconds:.1f} s"
    if seconds < 120:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"


class Interruption(Progress):
    """A ``Progress`` that passes everything on and decides, as a context manager, when Ctrl-C becomes a
    KeyboardInterrupt.

    Within a counted stage it waits for the next ``update``. In the middle of compiled code it would end in a
    SystemError, and a step would be half done. A second Ctrl-C does not wait.
    """

    def __init__(self, progress: Progress):
        self._progress = progress
        self.finished = progress.finished
        self._counting = self._asked = self._ignoring = False

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
        """Pass the count on; raises KeyboardInterrupt where Ctrl-C was pressed and parts are left."""
        self._counting = True
        self._progress.update(done, total, note)
        # What is done is whole; `heed` hears of it.
        if self._asked and done < total:
            raise KeyboardInterrupt

    def say(self, sentence: str) -> None:
        self._progress.say(sentence)

    def close(self) -> None:
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
