"""Runs of a scene with whole settings, each setting once: what `gears accuracy` and `[accuracy] target` measure errors
by."""

from collections.abc import Callable

import xarray as xr

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.model.model import Model, model_of
from fenics_gears.runs.timed import Times, run_sharing, shared_gears
from fenics_gears.scene.data import Scene
from fenics_gears.system.progress import Progress

from .measures import Answer
from .setting import Setting

Measured = Callable[[xr.Dataset, Model, Cycle], Answer]


class SettingRuns:
    """The runs of a scene so far, which share gears; by setting the answer, which is `measured` of a run, its model and
    its mesh cycle, and the times. `most`: how many gears are held, None for all."""

    def __init__(self, scene: Scene, measured: Measured, most: int | None = None):
        self.scene = scene
        self._measured = measured
        self._gears = shared_gears(most)
        self.times: dict[Setting, Times] = {}
        self.answers: dict[Setting, Answer] = {}

    def __contains__(self, setting: Setting) -> bool:
        return setting in self.answers

    def run(self, setting: Setting, progress: Progress | None = None) -> xr.Dataset:
        """Run a setting. Raises GearsError, and KeyboardInterrupt on Ctrl-C."""
        model = model_of(setting.of(self.scene))
        result, cycle = run_sharing(model, self._gears, progress)
        self.answers[setting] = self._measured(result, model, cycle)
        self.times[setting] = Times().and_also(result)
        return result
