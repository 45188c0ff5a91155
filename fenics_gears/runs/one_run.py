"""One run of many, whose settings are settled: its whole result and the time that it took."""

from __future__ import annotations

import time
from collections.abc import Callable

from fenics_gears.model.model import Model
from fenics_gears.results.dataset import RunResult
from fenics_gears.scene.data import Scene
from fenics_gears.simulation.routes import Preparation
from fenics_gears.simulation.simulate import Ended, solved
from fenics_gears.system.progress import Progress, SilentProgress

Tick = Callable[[], None]


def completed(
    scene: Scene | Model, preparation: Preparation, progress: Progress | None = None, ended: Ended | None = None
) -> RunResult:
    """The whole result of a run and its `wall_time`, s; `ended`: as in `solved`. Raises KeyboardInterrupt on Ctrl-C."""
    begun = time.perf_counter()
    result = solved(scene, progress=progress, preparation=preparation, ended=ended)
    if not result.attrs["complete"]:
        raise KeyboardInterrupt
    result.attrs["wall_time"] = time.perf_counter() - begun
    return result


class Ticking(SilentProgress):
    """Calls ``tick`` as often as a simulation reports; it may raise KeyboardInterrupt."""

    def __init__(self, tick: Tick | None):
        self._tick = tick

    def update(self, done: int, total: int, note: str = "") -> None:
        if self._tick is not None:
            self._tick()
