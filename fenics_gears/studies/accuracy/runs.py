"""Runs of settings without the cache, that share their gears or stand alone, and how long they take, stage by stage and without the cache; of several rounds, in which runs take turns, the median."""

from __future__ import annotations

import statistics
from collections.abc import Callable
from dataclasses import dataclass

import xarray as xr

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.model import Model
from fenics_gears.progress import Progress, SilentProgress
from fenics_gears.resolution import EVERY_STEP
from fenics_gears.scene.data import Scene
from fenics_gears.simulation import gear_compliance, mesh_cycle, prepared, simulate, tooth_reach
from fenics_gears.studies.workshop import GEARS, gear_key

STAGES = ("mesh", "condense", "march")


@dataclass(frozen=True)
class Times:
    """Seconds of every round: meshing, condensing, marching with the contact operators. Compiling does not count."""

    mesh: tuple[float, ...] = ()
    condense: tuple[float, ...] = ()
    march: tuple[float, ...] = ()

    def and_also(self, run: xr.Dataset) -> Times:
        """With one more run."""
        return Times(*((*getattr(self, stage), float(run.attrs[f"time_{stage}"])) for stage in STAGES))

    @property
    def rounds(self) -> int:
        """How many runs."""
        return len(self.march)

    @property
    def totals(self) -> tuple[float, ...]:
        """Seconds of all stages, by run."""
        return tuple(map(sum, zip(self.mesh, self.condense, self.march)))

    @property
    def total(self) -> float:
        """The median run."""
        return statistics.median(self.totals)

    def median(self, stage: str) -> float:
        """Of one stage."""
        return statistics.median(getattr(self, stage))


def run_afresh(scene: Scene) -> tuple[xr.Dataset, Cycle]:
    """A run that takes nothing from the cache and leaves nothing there, and its mesh cycle. Ctrl-C in its march ends all."""
    return _run(scene, lambda built: prepared(built, SilentProgress(), None))


class SharedGears:
    """Gears condensed once for all runs that share them, without the cache; each keeps the times that it took.

    `most`: how many gears are kept, those last used; all without it.
    """

    def __init__(self, most: int | None = None):
        self._gears: dict = {}
        self._most = most

    def run(self, scene: Scene, progress: Progress | None = None) -> xr.Dataset:
        """A run of the full contact; its times are those of a run of its own. KeyboardInterrupt from `progress` ends all."""
        return _run(scene, self._prepared, progress)[0]

    def run_with_cycle(self, scene: Scene) -> tuple[xr.Dataset, Cycle]:
        """The same, and its mesh cycle."""
        return _run(scene, self._prepared)

    def _prepared(self, built: Model):
        if built.resolution.condensation == EVERY_STEP:
            return prepared(built, SilentProgress(), None)
        reach = tooth_reach(built)
        for name in GEARS:
            key = gear_key(built, name, reach)
            # Last in the dictionary, last to be given up.
            self._gears[key] = self._gears.pop(key, None) or gear_compliance(built, name, reach, None)
        compliances = tuple(self._gears[gear_key(built, name, reach)] for name in GEARS)
        while self._most is not None and len(self._gears) > self._most:
            del self._gears[next(iter(self._gears))]
        return compliances, mesh_cycle(built, compliances)


def _run(scene: Scene, prepare: Callable[[Model], tuple], progress: Progress | None = None) -> tuple[xr.Dataset, Cycle]:
    """A complete run of a scene whose gears and mesh cycle `prepare(model)` makes."""
    cycles = []

    def preparation(built: Model, progress, cache):
        gears, cycle = prepare(built)
        cycles.append(cycle)
        return gears, cycle

    result = simulate(scene, progress=progress, preparation=preparation)
    if not result.attrs["complete"]:
        raise KeyboardInterrupt
    return result, cycles[0]
