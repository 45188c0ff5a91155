"""Calls of compiled code that solve many steps each, by two threads where steps do not depend on each other."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import cache
from threading import Event
from time import perf_counter

from threadpoolctl import ThreadpoolController

from fenics_gears.system.second_process import threads

SECONDS_BETWEEN_REPORTS = 0.1
# Blocks at rest of so many steps are solved in two halves: the first step of the later one takes a few iterations more.
FEWEST_IN_HALVES = 20
# Solves places from the first to before the other, and returns the first that is not solved.
Solve = Callable[[int, int], int]


@cache
def thread_pools() -> ThreadpoolController:
    """The libraries with threads that are loaded as the first march begins: to find them takes milliseconds."""
    return ThreadpoolController()


@contextmanager
def meanwhile(solve: Solve, first: int, end: int) -> Iterator[Callable[[], int]]:
    """Solve the places from `first` to before `end` by a second thread during the block, which gets what waits for it:
    the first place that is not solved. With one core they are solved when they are waited for.
    A block that fails ends the thread after the place it is at."""
    ended = Event()

    def solved() -> int:
        for place in range(first, end):
            if ended.is_set() or solve(place, place + 1) == place:
                return place
        return end

    if threads() == 1 or first == end:
        yield solved
        return
    with ThreadPoolExecutor(1) as thread:
        waiting = thread.submit(solved)
        try:
            yield waiting.result
        finally:
            ended.set()


class Calls:
    """Calls of compiled code, each of as many steps as last until the next report, as soon as it is known how long a
    step takes."""

    def __init__(self) -> None:
        self._at_once = 1

    def through(self, solve: Solve, plain: Callable[[int], None], end: int, at_rest: bool) -> Iterator[int]:
        """Solve places 1 to before `end`; gives the one behind the last that is done after each call. `plain` solves
        one that compiled code does not. `at_rest`: no place depends on another, so that the later half is solved
        meanwhile."""
        done, middle = 1, end // 2 if at_rest and end > FEWEST_IN_HALVES else end
        with meanwhile(solve, middle, end) as later:
            while done < end:
                last = min(done + self._at_once, middle if done < middle else end)
                if done == middle:
                    last, done = end, later()
                else:
                    done = self._timed(solve, done, last)
                if done < last:
                    plain(done)
                    done += 1
                yield done

    def _timed(self, solve: Solve, first: int, last: int) -> int:
        begun = perf_counter()
        done = solve(first, last)
        if done == last:
            # Ctrl-C is heard between two calls.
            seconds = perf_counter() - begun
            self._at_once = max(int((last - first) * SECONDS_BETWEEN_REPORTS / max(seconds, 1e-6)), 1)
        return done
