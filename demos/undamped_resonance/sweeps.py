"""What the runs of the study say: transmission error and loss of contact against mesh frequency."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from fenics_gears import results
from fenics_gears.scene.read import scene_from_text

WITH, WITHOUT = "with coast flanks", "drive flanks only"


@dataclass(frozen=True)
class Sweep:
    """One curve over `frequency` (n,), Hz.

    `amplitude` (n,): peak-to-peak transmission error of the recorded cycles, rad; `base_radius`: of the wheel, mm;
    `share` (n,): of the run's time without contact of the drive flanks; `opening` (n,): the widest, mm, 0 where contact
    was kept; `meaningless` (n,):
    whether the run says that it has no meaning from some time on.
    """

    frequency: np.ndarray
    amplitude: np.ndarray
    base_radius: float
    share: np.ndarray
    opening: np.ndarray
    meaningless: np.ndarray

    @property
    def lost(self) -> np.ndarray:
        """Whether contact was lost (n,)."""
        return self.share > 0.0


def sweeps(directory: Path) -> dict[str, Sweep]:
    """The curves with coast flanks and without, from the study in a directory."""
    with xr.open_dataset(directory / "study.nc", engine="h5netcdf") as opened:
        files = opened.case_file.load().values.ravel()
    runs = {WITH: [], WITHOUT: []}
    for name in files:
        run = results.load(directory / str(name))
        scene = scene_from_text(run.attrs["scene"])
        runs[WITHOUT if scene.coast_flanks is None else WITH].append((scene.motion.mesh_frequency, run.attrs))
    return {name: _sweep(found) for name, found in runs.items()}


def _sweep(found: list[tuple[float, dict]]) -> Sweep:
    found = sorted(found, key=lambda each: each[0])
    attributes = [each for _, each in found]
    return Sweep(
        frequency=np.array([frequency for frequency, _ in found]),
        amplitude=np.array([each["peak_to_peak_transmission_error"] for each in attributes]),
        base_radius=attributes[0]["base_radius_wheel"],
        share=np.array([each.get("contact_loss_share", 0.0) for each in attributes]),
        opening=np.array([each.get("contact_loss_opening", 0.0) for each in attributes]),
        meaningless=np.array(["no meaning from that time on" in each["warnings"] for each in attributes]),
    )
