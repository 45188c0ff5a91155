"""`simulate` as users call it: run a scene, and choose its settings first where it has a target."""

from __future__ import annotations

import xarray as xr

from fenics_gears.elasticity.cache import Cache
from fenics_gears.scene.data import Scene
from fenics_gears.simulation import simulate as simulation
from fenics_gears.simulation.routes import Preparation
from fenics_gears.system.progress import Progress, SilentProgress


def simulate(
    scene: Scene,
    *,
    progress: Progress | None = None,
    cache: Cache | None = None,
    preparation: Preparation | None = None,
    comm=None,
) -> xr.Dataset:
    """Run a scene and return its result (docs/result.md).

    With `[accuracy] target` settings are chosen first, by trial runs, and the result has its estimated error. Arguments, results and
    errors are those of `simulation.simulate.simulate`; with a target also TargetNotReached.
    """
    progress = progress or SilentProgress()
    arguments = {"progress": progress, "cache": cache, "preparation": preparation, "comm": comm}
    if scene.accuracy.target is None:
        return simulation.simulate(scene, **arguments)
    from fenics_gears.studies.accuracy_target.run import simulate_to_target

    return simulate_to_target(scene, **arguments)
