"""What the relief gains over speed and load, from the study's dataset."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from fenics_gears.model.model import model_of
from fenics_gears.scene.read import scene_from_text

WITH, WITHOUT = "present", "absent"
# mesh frequencies (Hz) of the table's columns, the nearest that were run
FREQUENCIES = (50.0, 100.0, 200.0, 400.0, 1000.0)


@dataclass(frozen=True)
class Gain:
    """Peak-to-peak transmission error (torques, frequencies), um on the wheel's base circle, over torque (N m) and mesh
    frequency (Hz)."""

    torques: np.ndarray
    frequencies: np.ndarray
    with_relief: np.ndarray
    without_relief: np.ndarray

    @property
    def ratio(self) -> np.ndarray:
        """With relief over without; above 1 the relief harms."""
        return self.with_relief / self.without_relief


def gain(study: Path) -> Gain:
    """Read what a study over tip relief, torque and mesh frequency has found."""
    with xr.open_dataset(study, engine="h5netcdf") as opened:
        dataset = opened[["peak_to_peak_transmission_error", "case_file"]].load()
    first = str(dataset.case_file.values.ravel()[0])
    with xr.open_dataset(study.parent / first, engine="h5netcdf") as run:
        radius = model_of(scene_from_text(run.attrs["scene"])).pair.wheel.base_radius
    error = (dataset.peak_to_peak_transmission_error * radius * 1e3).transpose(
        "tip_relief", "wheel_torque", "mesh_frequency"
    )
    with_relief, without = (error.sel(tip_relief=relief).values for relief in (WITH, WITHOUT))
    return Gain(dataset.wheel_torque.values, dataset.mesh_frequency.values, with_relief, without)


def table(found: Gain) -> str:
    """Markdown: with relief / without (um), a row for each torque, a column for some of the frequencies."""
    columns = sorted({int(np.argmin(np.abs(found.frequencies - frequency))) for frequency in FREQUENCIES})
    rows = [
        "| torque (N m) | " + " | ".join(f"{found.frequencies[column]:.0f} Hz" for column in columns) + " |",
        "|---|" + "---|" * len(columns),
    ]
    for torque, relieved, plain in zip(found.torques, found.with_relief, found.without_relief):
        rows.append(
            f"| {torque:g} | "
            + " | ".join(f"{relieved[column]:.1f} / {plain[column]:.1f}" for column in columns)
            + " |"
        )
    return "\n".join(rows) + "\n"
