"""Runs of settings without the cache, that share their gears or stand alone, and how long they take, stage by stage and without the cache; of several rounds, in which runs take turns, the median."""

from __future__ import annotations

import statistics
from collections.abc import Callable
from dataclasses import dataclass

import xarray as xr

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.model.model import Model
from fenics_gears.scene.data import Scene
from fenics_gears.simulation.routes import prepared
from fenics_gears.simulation.simulate import simulate
from fenics_gears.studies.gear_store import GearStore
from fenics_gears.system.progress import Progress, SilentProgress

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
    return _run(scene, lambda model: prepared(model, SilentProgress(), None))


def run_sharing(scene: Scene, gears: GearStore, progress: Progress | None = None) -> tuple[xr.Dataset, Cycle]:
    """A run that shares gears with others, without the cache, and its mesh cycle; its times are those of a run of its own.

    KeyboardInterrupt from `progress` ends all.
    """
    return _run(scene, lambda model: gears.prepared(model, SilentProgress(), None), progress)


def shared_gears(most: int | None = None) -> GearStore:
    """For runs whose times count, so that no mesh cycle is taken over; `most`: how many gears are kept."""
    return GearStore(most, cycles=False)


def _run(scene: Scene, prepare: Callable[[Model], tuple], progress: Progress | None = None) -> tuple[xr.Dataset, Cycle]:
    """A complete run of a scene whose gears and mesh cycle `prepare(model)` makes."""
    cycles = []

    def preparation(model: Model, progress, cache):
        gears, cycle = prepare(model)
        cycles.append(cycle)
        return gears, cycle

    result = simulate(scene, progress=progress, preparation=preparation)
    if not result.attrs["complete"]:
        raise KeyboardInterrupt
    return result, cycles[0]
