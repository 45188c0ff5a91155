"""The result of a run: one labelled dataset, with units and long names.

Dimensions: `time`, all marched steps; `slot`, the tooth pairs that can touch at once; `gear` ("pinion", "wheel");
`contact_time`, the steps whose contact fields are stored; `contact_node`; over the face also `face_position`.
"""

import time
from collections.abc import Sequence
from functools import cached_property
from math import isfinite
from typing import Any

import numpy as np
import xarray as xr

import fenics_gears
from fenics_gears.contact.laws import NO_FORCE
from fenics_gears.dynamics.marched import March
from fenics_gears.effects import common_period, from_effects, result_variables
from fenics_gears.errors import attempted
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.model import Model
from fenics_gears.model.storage import CONTACT_COORDINATES
from fenics_gears.numbers_version import NUMBERS_VERSION

from .carried_scene import scene_attributes
from .contact_variables import Curves, largest_normal_force, transmitted
from .extrema import Extrema, extremes
from .key_numbers import key_numbers, largest_root_stress, path_point_coordinate, path_point_values
from .numbers import RUNG, loss_attributes
from .pairs import shown_steps
from .recorder import Recorder
from .settled import settled
from .validity import warnings_of, warnings_of_energy


class RunResult:
    """What a march gave: numbers and warnings (`attrs`), curves (steps, ...) by name (`result["normal_force"]`), and
    the labelled `dataset`, put together when it is asked for; `seconds`: that its numbers took."""

    def __init__(self, recorder: Recorder, march: March):
        begun = time.perf_counter()
        recorder.finish()
        model = recorder.model
        self.recorder = recorder
        self._curves = recorder.arrays
        counted = settled(model, max(recorder.steps - 1, 0))
        self._first = counted.first
        self.attrs = _attributes(recorder, march, self, counted.first)
        said: dict[str, str] = {}
        numbers = attempted(said, "numbers of the run", lambda: _numbers(recorder, march, self, counted.first))
        self.attrs.update(numbers or {})
        sentences = [counted.warning] if counted.warning else []
        sentences += attempted(said, "judgement of the run", lambda: self._judged(march)) or []
        self.attrs.update(said, warnings="\n".join([*sentences, *said.get("warnings", "").splitlines()]))
        self.seconds = time.perf_counter() - begun

    def _judged(self, march: March) -> list[str]:
        """A sentence for each assumption of the model that the march breaks."""
        recorder = self.recorder
        scene = recorder.model.scene
        warnings = warnings_of(recorder, march, self)
        warnings += warnings_of_energy(scene, self, recorder.cycle.steps, shown_steps(self))
        warnings += _undetermined_shares(self)
        for sentences in from_effects(scene, "findings", recorder.watched):
            warnings += sentences
        return warnings

    def __getitem__(self, name: str) -> np.ndarray:
        return self._curves[name]

    def __contains__(self, name: str) -> bool:
        return name in self._curves

    @property
    def dataset(self) -> xr.Dataset:
        """All of it; every variable with units and long name."""
        self._labelled.attrs = self.attrs
        return self._labelled

    @cached_property
    def _labelled(self) -> xr.Dataset:
        # All variables at once, attributes in place: a copy of so many variables takes a millisecond.
        return xr.Dataset(
            {name: (dims, values, labels) for name, dims, values, labels in variables_of(self.recorder, self._first)},
            coords=coordinates_of(self.recorder, self._curves),
        )


def variables_of(recorder: Recorder, first: int):
    """Name, dimensions, values and labels of each variable; `first`: the first settled step."""
    scene = recorder.model.scene
    arrays = recorder.arrays
    described = {variable.name: variable for variable in result_variables(scene)}
    for name, variable in described.items():
        if name in arrays:
            yield name, variable.dims, arrays[name], variable.labels
    for of_effect in from_effects(scene, "results", scene, recorder.cycle, np.empty(0)):
        for name, (dims, values) in of_effect.items():
            if dims[:1] != ("time",):
                yield name, dims, values, described[name].labels
    forces = arrays["pair_normal_force"][first:]
    numbers = arrays["pair_number"][first:]
    phase = arrays["mesh_phase"][first:]
    points = path_point_values(scene, recorder.model.pair, phase, numbers, forces, recorder.first_number)
    for name, values in points.items():
        if name in described:
            yield name, described[name].dims, values, described[name].labels
    if recorder.stress is not None:
        labels = recorder.stress.labels()[0]
        for along in recorder.along_face:
            labels = along.words(labels)
        for name, words in labels.items():
            if name in arrays:
                yield name, recorder.stored[name][0], arrays[name], {"units": "MPa", "long_name": words}


def coordinates_of(recorder: Recorder, arrays: dict[str, np.ndarray]) -> dict[str, tuple]:
    """Dimensions, values and labels of each coordinate."""
    speed_given = recorder.model.scene.motion.speed_given
    time_name = "time" if speed_given else "nominal time, 1 s for a mesh cycle"
    numbered = {
        "units": "1",
        "long_name": (
            "number of the tooth pair in each slot, from 1 in the order in which they enter; 0 for an empty slot"
        ),
        # A pair's number less this is the mesh phase at which it reaches the start of contact.
        "number_at_phase_0": recorder.first_number,
    }
    coordinates = {
        "time": ("time", arrays["time"], {"units": "s", "long_name": time_name}),
        "mesh_phase": ("time", arrays["mesh_phase"], {"units": "1", "long_name": "mesh cycles since the start"}),
        "pair_number": (("time", "slot"), arrays["pair_number"], numbered),
        "gear": ("gear", list(GEARS), {"long_name": "gear"}),
        "path_point": path_point_coordinate(),
        "slot": ("slot", np.arange(recorder.slots), {"long_name": "slot for a tooth pair that can touch"}),
    }
    if "contact_time" in arrays:
        at = "at the times of the contact fields"
        labels = {
            "contact_time": {"units": "s", "long_name": "time at which contact fields are stored"},
            "contact_mesh_phase": {"units": "1", "long_name": f"mesh cycles since the start {at}"},
            "contact_pair_number": numbered | {"long_name": f"pair_number {at}"},
        }
        coordinates |= {name: (dims, arrays[name], labels[name]) for name, dims in CONTACT_COORDINATES.items()}
    for along in recorder.along_face:
        coordinates |= along.coordinates()
    return coordinates if recorder.stress is None else coordinates | recorder.stress.labels()[1]


def _undetermined_shares(result: RunResult) -> list[str]:
    shares = result["pair_normal_force"]
    steps = int(np.isnan(shares).any(axis=1).sum())
    if not steps:
        return []
    return [
        f"several pairs of rigid flanks touch at once in {steps} of {len(shares)} steps: their shares of the force are"
        " not determined (pair_normal_force); a scene with [gears.material] has them"
    ]


def _attributes(recorder: Recorder, march: March, result: RunResult, first: int) -> dict:
    scene = recorder.model.scene
    attributes = {
        "title": scene.title,
        **scene_attributes(scene),
        "fenics_gears_version": fenics_gears.__version__,
        "numbers_version": NUMBERS_VERSION,
        "complete": int(not march.interrupted),
        "steps": march.steps,
        # Pictures show the last cycles of a steady run, all of one that never repeats.
        "shown_cycles": scene.motion.recorded_cycles if isfinite(common_period(scene)) else scene.motion.mesh_cycles,
        "newton_iterations_total": march.newton_iterations,
        "time_march": march.seconds,
    }
    if scene.friction is not None:
        attributes["friction_coefficient"] = recorder.model.friction_coefficient
    attributes |= {f"{RUNG}{rung}": count for rung, count in march.steps_by_method.items() if count}
    if recorder.steps:
        phase = result["mesh_phase"]
        attributes["settled_from"] = float(result["time"][first])
        attributes["settled_cycles"] = float(phase[-1] - phase[first])
    return attributes


def _numbers(recorder: Recorder, march: March, result: RunResult, first: int) -> dict[str, float | str]:
    if not recorder.steps:
        return {"contact_loss_count": 0}
    model = recorder.model
    counted = recorder.counted(first)
    error = counted["transmission_error"]
    lost = [separation for separation in march.separations if separation[0] > first or first == 0]
    numbers = loss_attributes(lost, first, march.steps, model.clock)
    extrema = Extrema(model, recorder.cycle, counted["mesh_phase"], error, [march])
    friction = friction_loss(result, counted) if not march.locked else {}
    ((found, of_force),) = numbers_of_curves(model, extrema, [(0, counted, friction)])
    numbers |= found
    if recorder.stress is not None or recorder.along_face:
        labelled = result.dataset.isel(time=slice(first, None))
        numbers |= largest_root_stress(labelled)
        for along in recorder.along_face:
            numbers |= along.numbers(labelled, numbers)
    return numbers | of_force


def numbers_of_curves(
    model: Model, extrema: Extrema, runs: Sequence[tuple[int, Curves, dict[str, float]]], key: bool = True
) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    """Of runs that were marched together, each by its place, its settled curves and its friction loss: the numbers, key
    numbers among them unless `key` is not set; and those of the largest pair force between steps."""
    timed = model.scene.motion.speed_given
    others = [
        key_numbers(counted, model.pair, loss.get("friction_loss"), timed) if key else {} for _, counted, loss in runs
    ]
    located = extremes(
        extrema, [(run, counted, "largest_pair_force" in own) for (run, counted, _), own in zip(runs, others)]
    )
    found: list[tuple[dict[str, Any], dict[str, Any]]] = []
    for (_, counted, loss), own, (of_error, of_force) in zip(runs, others, located):
        error = counted["transmission_error"]
        # The last step begins the next cycle.
        mean = float(error[:-1].mean() if len(error) > 1 else error[0])
        found.append((of_error | {"mean_transmission_error": mean} | loss | own, of_force))
    return found


def friction_loss(curves: Curves, counted: Curves) -> dict[str, float]:
    """The share of the drive's work that friction takes in settled steps; nothing where nothing presses, or the drive
    does no work."""
    if "work_friction" not in counted or len(counted["time"]) < 2 or largest_normal_force(curves) <= NO_FORCE:
        return {}
    drive = abs(transmitted(counted).drive)
    taken = counted["work_friction"]
    return {"friction_loss": float(taken[-1] - taken[0]) / drive} if drive else {}
