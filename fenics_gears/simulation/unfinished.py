"""The result of a run that has not come to its end, made of its journal: its process was killed, or still runs."""

from pathlib import Path

import xarray as xr

from fenics_gears.dynamics.marched import March
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.model.model import model_of
from fenics_gears.results.journal import read
from fenics_gears.results.recorder import Recorder
from fenics_gears.results.summary import what_is_there
from fenics_gears.system.progress import SilentProgress

from .routes import prepared
from .simulate import result_of, root_stress_of

NOT_ENDED = "not ended"


def unfinished(file: Path) -> xr.Dataset:
    """The result as if the run had been interrupted after the last step of its journal; `complete` 0, `stopped`
    NOT_ENDED. The gears are those of the cache, or condensed again. Raises ComputationError where the journal cannot be
    read."""
    progress = SilentProgress()
    cache = user_cache()
    recorded = read(file)
    model = model_of(recorded.scene)
    gears, cycle = prepared(model, progress, cache)
    recorder = Recorder(model, cycle, stress=root_stress_of(model, cycle, progress, cache))
    recorder.recall(recorded)
    equations = model.equations_of_motion
    march = March(equations.friction, equations.drivetrain.stiffness, **recorded.march)
    result = result_of(recorder, march, gears, 0.0, NOT_ENDED).dataset
    why = "the run has not come to its end (its process was killed, or still runs)"
    missing = f"{why}: {what_is_there(result, recorded.steps, model.scene.motion.mesh_cycles)}"
    return result.assign_attrs(warnings="\n".join([missing, *result.attrs["warnings"].splitlines()]))
