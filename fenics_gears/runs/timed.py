"""Runs without the cache that may share gears, and their times by stages."""

from __future__ import annotations

import statistics
from dataclasses import dataclass

import xarray as xr

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.elasticity.cache import Cache
from fenics_gears.model.model import Model
from fenics_gears.scene.data import Scene
from fenics_gears.simulation.routes import Prepared
from fenics_gears.system.progress import Progress, SilentProgress

from .gear_store import GearStore
from .one_run import completed

STAGES = ("mesh", "condense", "march")


@dataclass(frozen=True)
class Times:
    """Seconds of every round: meshing, condensing, marching with the contact operators; without compiling."""

    mesh: tuple[float, ...] = ()
    condense: tuple[float, ...] = ()
    march: tuple[float, ...] = ()

    def and_also(self, run: xr.Dataset) -> Times:
        """These times and the times of one more run."""
        return Times(*((*getattr(self, stage), float(run.attrs[f"time_{stage}"])) for stage in STAGES))

    @property
    def rounds(self) -> int:
        return len(self.march)

    @property
    def totals(self) -> tuple[float, ...]:
        """Seconds of all stages, by run."""
        return tuple(map(sum, zip(self.mesh, self.condense, self.march)))

    @property
    def total(self) -> float:
        return statistics.median(self.totals)

    def median(self, stage: str) -> float:
        return statistics.median(getattr(self, stage))


def shared_gears(most: int | None = None) -> GearStore:
    """A store for runs that are timed: it shares gears, but no mesh cycles; `most`: how many gears are kept."""
    return GearStore(most, cycles=False)


def run_sharing(scene: Scene | Model, gears: GearStore, progress: Progress | None = None) -> tuple[xr.Dataset, Cycle]:
    """A run that shares gears with others, without the cache, and its mesh cycle; its times include condensing these
    gears.

    Raises KeyboardInterrupt on Ctrl-C, or from `progress`.
    """
    cycles = []

    def preparation(model: Model, progress: Progress, cache: Cache | None) -> Prepared:
        prepared = gears.prepared(model, SilentProgress(), None)
        cycles.append(prepared[1])
        return prepared

    return completed(scene, preparation, progress).dataset, cycles[0]
