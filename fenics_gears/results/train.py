"""The result of a train: the variables of a pair with the dimension `mesh`, the numbers of each mesh as variables over
it, and the transmission error of the whole."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import isfinite
from typing import Any

import numpy as np
import xarray as xr

import fenics_gears
from fenics_gears.dynamics.energy_account import account
from fenics_gears.dynamics.march import March
from fenics_gears.dynamics.steps import Steps
from fenics_gears.elasticity.compliance import STAGES, Body
from fenics_gears.model.train import TrainModel
from fenics_gears.numbers_version import NUMBERS_VERSION

from .attributes import RESULT_ATTRIBUTES
from .contact_variables import energy_of_teeth
from .dataset import coordinates_of, variables_of
from .key_numbers import key_numbers
from .layout import OVERALL
from .numbers import RUNG
from .recorder import Recorder

MESH = "mesh"
TIMES = ("time", "contact_time")
# Of a mesh by itself they would leave out what it does through the bodies of its neighbours.
OF_ENERGY = ("energy", "work_")
MICROMETRE = 1e-3


class TrainResult:
    """What a march of a train gives: `recorders` of its meshes, and the motion of its last shaft."""

    def __init__(self, model: TrainModel, recorders: Sequence[Recorder]):
        self._model = model
        self._recorders = recorders
        self._overall: list[np.ndarray] = []
        # Work (N mm) that friction takes, and that of the drive beyond the one without losses.
        self._lost = 0.0
        self._driven = 0.0
        self._last: Steps | None = None

    def take(self, solved: Steps) -> None:
        """The next steps."""
        drivetrain = self._model.drivetrain
        self._overall.append(solved.states[:, 0, -1] / drivetrain.radii[-1])
        if self._model.equations_of_motion.friction:
            together = solved if self._last is None else self._last.followed_by(solved)
            clock = self._model.models[0].clock
            work = account(drivetrain, clock, together, energy_of_teeth(together))
            self._lost += float(work.friction[-1])
            self._driven += float(work.rotation[-1])
            self._last = solved.between(len(solved) - 1, len(solved))

    def dataset(self, march: March, bodies: Iterable[Body], stopped: str) -> xr.Dataset:
        """All of it; `stopped`: why the march did not come to its end, empty where it did."""
        for recorder in self._recorders:
            recorder.finish()
        overall = np.concatenate([np.empty(0), *self._overall])
        longest = max(self._recorders, key=lambda each: each.steps)
        widest = max(self._recorders, key=lambda each: each.slots)
        times = self._model.models[0].clock.times(np.arange(len(overall)))
        variables = dict(self._over_meshes())
        coordinates = {
            name: of
            for name, of in coordinates_of(widest, widest.arrays).items()
            if name in ("gear", "slot", "path_point")
        }
        labels = {"units": "s", "long_name": "time"}
        coordinates |= {
            "time": ("time", times, labels),
            MESH: (MESH, [each.name for each in self._model.scene.meshes], {"long_name": "mesh"}),
        }
        if "contact_time" in longest.arrays:
            coordinates["contact_time"] = ("contact_time", longest.arrays["contact_time"], labels)
        variables[OVERALL] = (
            "time",
            overall,
            {"units": "rad", "long_name": "lag of the last shaft behind the nominal motion of the first"},
        )
        numbers = [self._numbers(recorder) for recorder in self._recorders]
        variables |= _numbers_of_meshes(numbers)
        found = xr.Dataset(variables, coords=coordinates)
        found.attrs = self._attributes(march, bodies, stopped, overall)
        return found

    def _over_meshes(self) -> Iterable[tuple[str, tuple]]:
        """Variables of all meshes, side by side."""
        of_meshes: list[dict[str, tuple]] = []
        for recorder in self._recorders:
            own = {name: (dims, values, labels) for name, dims, values, labels in variables_of(recorder, 0)}
            own |= {
                name: of
                for name, of in coordinates_of(recorder, recorder.arrays).items()
                if name in ("mesh_phase", "pair_number", "contact_pair_number")
            }
            of_meshes.append({name: of for name, of in own.items() if not name.startswith(OF_ENERGY)})
        sizes = _largest_sizes(of_meshes)
        for name in dict.fromkeys(name for own in of_meshes for name in own):
            there = [None if name not in own else np.asarray(own[name][1]) for own in of_meshes]
            dims, _, labels = next(own[name] for own in of_meshes if name in own)
            dims = _names_of(dims)
            values = _side_by_side(there, [sizes[each] for each in dims])
            behind = 1 if dims[0] in TIMES else 0
            yield name, ((*dims[:behind], MESH, *dims[behind:]), np.moveaxis(values, 0, behind), labels)

    def _numbers(self, recorder: Recorder) -> dict[str, float]:
        """Numbers of one mesh, of its whole cycles."""
        if not recorder.steps:
            return {}
        counted = {name: recorder.arrays[name] for name, (dims, _) in recorder.stored.items() if dims[0] == "time"}
        model = recorder.model
        error = counted["transmission_error"]
        cycle = error[:-1] if len(error) > 1 else error
        found = key_numbers(counted, model.pair, None, False)
        found |= {
            "mean_transmission_error": float(cycle.mean()),
            "peak_to_peak_transmission_error": float(np.ptp(error)),
            "base_radius_wheel": model.pair.wheel.base_radius,
        }
        return {name: value for name, value in found.items() if isinstance(value, float | int) and isfinite(value)}

    def _attributes(self, march: March, bodies: Iterable[Body], stopped: str, overall: np.ndarray) -> dict[str, Any]:
        model = self._model
        scene = model.scene
        timings = {name: sum(body.timings[name] for body in bodies) for name in STAGES}
        found: dict[str, Any] = {
            "title": scene.title,
            "scene": scene.text,
            "scene_name": scene.name,
            "fenics_gears_version": fenics_gears.__version__,
            "numbers_version": NUMBERS_VERSION,
            "complete": int(not stopped),
            "steps": march.steps,
            "newton_iterations_total": march.newton_iterations,
            "time_march": march.seconds,
            "warnings": "\n".join([*model.warnings, *self._without_contact(march)]),
            **timings,
            **({"stopped": stopped} if stopped else {}),
            **{f"{RUNG}{rung}": count for rung, count in march.steps_by_method.items() if count},
        }
        if len(overall):
            found["mean_overall_transmission_error"] = float(overall[:-1].mean() if len(overall) > 1 else overall[0])
            found["peak_to_peak_overall_transmission_error"] = float(np.ptp(overall))
        friction = model.equations_of_motion.friction
        if friction and march.steps:
            found["friction_coefficient"] = friction
            found["friction_loss"] = self._lost / (self._driven + self._driving_work(march.steps))
        return found

    def _driving_work(self, steps: int) -> float:
        """Work (N mm) of the drive over so many steps without losses."""
        first = self._model.models[0]
        pitch = first.pair.pinion.angular_pitch
        return self._model.scene.input_torque * pitch * steps / first.resolution.steps_per_mesh_cycle

    @staticmethod
    def _without_contact(march: March) -> list[str]:
        if not march.separations:
            return []
        return [f"no flanks of any mesh touch in {len(march.separations)} of {march.steps} steps"]


def _names_of(dims: str | Sequence[str]) -> tuple[str, ...]:
    return (dims,) if isinstance(dims, str) else tuple(dims)


def _largest_sizes(of_meshes: Sequence[Mapping[str, tuple]]) -> dict[str, int]:
    """The largest size that any variable of any mesh has over each dimension."""
    sizes: dict[str, int] = {}
    for own in of_meshes:
        for dims, values, _ in own.values():
            for name, size in zip(_names_of(dims), np.shape(values)):
                sizes[name] = max(size, sizes.get(name, 0))
    return sizes


def _side_by_side(arrays: Sequence[np.ndarray | None], shape: Sequence[int]) -> np.ndarray:
    """Arrays of all meshes (meshes, ...): not a number, or 0, where one has less than another."""
    kind = next(each.dtype for each in arrays if each is not None)
    values = np.full((len(arrays), *shape), np.nan if kind.kind == "f" else 0, dtype=kind)
    for own, each in zip(values, arrays):
        if each is not None:
            own[tuple(slice(size) for size in each.shape)] = each
    return values


def _numbers_of_meshes(numbers: Sequence[Mapping[str, float]]) -> dict[str, tuple]:
    described = {each.name: each for each in RESULT_ATTRIBUTES}
    found = {}
    for name in dict.fromkeys(name for own in numbers for name in own):
        labels = described[name]
        values = np.array([own.get(name, np.nan) for own in numbers], dtype=float)
        found[name] = ((MESH,), values, {"units": labels.units or "1", "long_name": labels.meaning})
    return found


def train_rows(found: xr.Dataset) -> list[tuple[str, str, str]]:
    """What is printed of a train: rows of label, value and unit."""
    rows = [
        (
            "overall transmission error, peak to peak",
            f"{found.attrs['peak_to_peak_overall_transmission_error']:.5g}",
            "rad",
        ),
        ("overall transmission error, mean", f"{found.attrs['mean_overall_transmission_error']:.5g}", "rad"),
    ]
    if "friction_loss" in found.attrs:
        rows.append(("friction loss, all meshes", f"{100.0 * found.attrs['friction_loss']:.4g}", "%"))
    for name in found[MESH].values:
        own = found.sel({MESH: name})
        radius = float(own["base_radius_wheel"])
        for label, number in (("peak to peak", "peak_to_peak"), ("mean", "mean")):
            angle = float(own[f"{number}_transmission_error"])
            said = f"{angle * radius / MICROMETRE:.4g} um = {angle:.5g} rad"
            rows.append((f"{name}: transmission error, {label}", said, ""))
        for number, label, unit in SAID:
            if number in own and np.isfinite(own[number]):
                rows.append((f"{name}: {label}", f"{float(own[number]):.4g}", unit))
    attrs = found.attrs
    rows.append(("steps, Newton iterations", f"{attrs['steps']}, {attrs['newton_iterations_total']}", ""))
    return rows


SAID = (
    ("mean_mesh_stiffness", "mesh stiffness, mean", "N/(mm um)"),
    ("largest_pair_force", "largest force of a tooth pair", "N"),
    ("peak_contact_pressure", "peak contact pressure", "MPa"),
)
