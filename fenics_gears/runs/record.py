"""What is kept of a run in memory: its numbers, curves and warnings."""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from fenics_gears.results.contact_variables import largest_normal_force
from fenics_gears.results.dataset import RunResult
from fenics_gears.results.key_numbers import STUDIED
from fenics_gears.results.layout import OVERALL
from fenics_gears.results.pairs import shown_steps
from fenics_gears.results.path_shares import OF_SHARES
from fenics_gears.results.planetary import LARGEST_OF_SETS
from fenics_gears.results.settled import settled_steps
from fenics_gears.results.stored import StoredResult

from .spent import seconds_of

if TYPE_CHECKING:
    from fenics_gears.results.together import NumbersOfRun

    from .run import Run
    from .train import RunOfTrain

# Units and long name of each number that every record has.
NUMBERS = {
    "peak_to_peak_transmission_error": ("rad", "transmission error, peak to peak"),
    "mean_transmission_error": ("rad", "transmission error, mean"),
    "max_normal_force": ("N", "largest contact force of the mesh, on its drive or its coast flanks"),
    "newton_iterations": (
        "1",
        "Newton iterations of the run; without friction fewer after another run on the same contact equations",
    ),
    "steps_per_mesh_cycle": ("1", "steps per mesh cycle"),
    "wall_time": ("s", "wall time of the run"),
}
# Those of a train: of the whole, and in place of a pair's, by which its pictures are drawn.
OF_TRAINS = {
    "peak_to_peak_overall_transmission_error": ("rad", "overall transmission error, peak to peak"),
    "mean_overall_transmission_error": ("rad", "overall transmission error, mean"),
    **{name: NUMBERS[name] for name in ("newton_iterations", "wall_time")},
}
TRAIN_ERROR = f"peak_to_peak_{OVERALL}"
# Of trains with friction.
OF_LOSS = ("friction_loss",)
# Curves of the last cycles, taken where a run has them.
CURVES = (
    "transmission_error", "centre_x", "centre_y", "axial_position", "tilt_x", "tilt_y", "shaft_end_rotation",
    "normal_force", "friction_force", "mesh_stiffness", OVERALL,
)  # fmt: skip


@dataclass(frozen=True)
class RunRecord:
    """Numbers and curves of one run.

    `numbers`: by name, including the ones of `STUDIED` that the run has. `curves`: (steps,) or (steps, 2), in the units
    of the run. `mesh_phase` (steps,): mesh cycles since the first recorded step. `base_radius`: of the wheel, mm.
    `labels`: units and long name of each curve. `seconds`: as in `spent.seconds_of`, of a run that was computed here.

    `of_train`: whether it is a train's.
    Of a train, numbers and curves are those of the whole, mesh cycles those of its first mesh, and `of_meshes` has by
    name what pairs have as numbers, for each of the `meshes`.
    """

    numbers: dict[str, float]
    mesh_phase: np.ndarray
    curves: dict[str, np.ndarray]
    base_radius: float
    labels: dict[str, dict[str, str]] = field(default_factory=dict)
    warnings: str = ""
    seconds: tuple[float, ...] = ()
    meshes: tuple[str, ...] = ()
    of_meshes: dict[str, np.ndarray] = field(default_factory=dict)

    @property
    def of_train(self) -> bool:
        return TRAIN_ERROR in self.numbers


def line_of(run: Run, result: RunResult | RunOfTrain | NumbersOfRun) -> dict[str, Any]:
    """What is kept of a run whose numbers alone are kept, for `record_of_line`."""
    said = result.attrs
    numbers = train_numbers_of(result) if TRAIN_ERROR in said else numbers_of(result)  # type: ignore[arg-type]
    others = {"warnings": said.get("warnings", ""), "base_radius": said.get("base_radius_wheel", np.nan)}
    return {"numbers": numbers, "seconds": seconds_of(result), **others}  # type: ignore[arg-type]


def record_of_line(line: Mapping[str, Any]) -> RunRecord:
    """The record of a run of which a line is kept: it has no curves."""
    said = line["warnings"]
    return RunRecord(
        line["numbers"], np.empty(0), {}, line["base_radius"], warnings=said, seconds=tuple(line["seconds"])
    )


def _of_train(run: xr.Dataset | StoredResult) -> RunRecord:
    """The record of a train's run."""
    names = tuple(each.decode() if isinstance(each, bytes) else str(each) for each in run["mesh"].values)
    error = run[OVERALL]
    time, phase = (run[name].values[1, 0] for name in ("time_of_mesh", "mesh_phase"))
    known = [name for name in (*NUMBERS, *STUDIED, *OF_SHARES) if name in run]
    return RunRecord(
        train_numbers_of(run),
        run["time"].values * phase / time,
        {OVERALL: error.values},
        np.nan,
        {OVERALL: {key: error.attrs[key] for key in ("units", "long_name")}},
        run.attrs.get("warnings", ""),
        meshes=names,
        of_meshes={name: values for name in known if (values := run[name].values).shape == (len(names),)}
        | {"max_normal_force": np.nanmax(run["normal_force"].values, axis=0)},
    )


def train_numbers_of(run: xr.Dataset | StoredResult) -> dict[str, float]:
    """The numbers of a train's complete run, of the whole."""
    said = ChainMap({"newton_iterations": run.attrs["newton_iterations_total"]}, run.attrs)
    return {
        name: float(said[name])
        for name in (*OF_TRAINS, *(name for name in (*OF_LOSS, *LARGEST_OF_SETS) if name in said))
    }


def numbers_of(run: RunResult | xr.Dataset | StoredResult) -> dict[str, float]:
    """The numbers of a complete run; the wall time is the attribute `wall_time`, s."""
    said = ChainMap(
        {
            "max_normal_force": largest_normal_force(run, settled_steps(run)),
            "newton_iterations": run.attrs["newton_iterations_total"],
        },
        run.attrs,
    )
    names = (*NUMBERS, *(name for name in STUDIED if name in said))
    return {name: float(said[name]) for name in names}


def record_of(run: xr.Dataset | StoredResult) -> RunRecord:
    """The record of a complete run."""
    if OVERALL in run:
        return _of_train(run)
    last = shown_steps(run)
    phase = run["mesh_phase"].values[last]
    taken = {name: run[name] for name in CURVES if name in run}
    curves = {name: each.values[last] for name, each in taken.items()}
    labels = {name: {key: each.attrs[key] for key in ("units", "long_name")} for name, each in taken.items()}
    return RunRecord(
        numbers_of(run),
        phase - np.floor(phase[0]),
        curves,
        float(run.attrs["base_radius_wheel"]),
        labels,
        run.attrs.get("warnings", ""),
    )
