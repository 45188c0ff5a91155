"""The numbers and curves that a study's dataset takes from the run of a case."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import xarray as xr

from fenics_gears.results.contact_variables import largest_normal_force
from fenics_gears.results.key_numbers import STUDIED
from fenics_gears.results.pairs import shown
from fenics_gears.results.settled import of_settled

# Curves of the last cycles, taken where a run has them.
CURVES = ("transmission_error", "centre_x", "centre_y", "shaft_end_rotation", "normal_force", "friction_force", "mesh_stiffness")


@dataclass(frozen=True)
class CaseRecord:
    """Numbers and curves of one run.

    `numbers`: by name, also those of `STUDIED` that the run has; `curves`: (steps,) or (steps, 2), in the units of the run; `mesh_phase`
    (steps,): mesh cycles since the first recorded step; `labels`: units and long name of each curve; `warnings`: those of the run.
    """

    numbers: dict[str, float]
    mesh_phase: np.ndarray
    curves: dict[str, np.ndarray]
    labels: dict[str, dict[str, str]] = field(default_factory=dict)
    warnings: str = ""


def record_of(run: xr.Dataset) -> CaseRecord:
    """The record of a complete run; the wall time is the attribute `wall_time`, s."""
    numbers = {
        "peak_to_peak_transmission_error": float(run.attrs["peak_to_peak_transmission_error"]),
        "mean_transmission_error": float(run.attrs["mean_transmission_error"]),
        "max_normal_force": largest_normal_force(of_settled(run)),
        "newton_iterations": float(run.attrs["newton_iterations_total"]),
        "steps_per_mesh_cycle": float(run.attrs["steps_per_mesh_cycle"]),
        "wall_time": float(run.attrs["wall_time"]),
    }
    numbers |= {name: float(run.attrs[name]) for name in STUDIED if name in run.attrs}
    last = shown(run)
    phase = last["mesh_phase"].values
    curves = {name: last[name].values for name in CURVES if name in run}
    labels = {name: {key: run[name].attrs[key] for key in ("units", "long_name")} for name in curves}
    return CaseRecord(numbers, phase - np.floor(phase[0]), curves, labels, run.attrs.get("warnings", ""))
