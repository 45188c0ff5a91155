"""What the studies of this folder have computed: their datasets, and the runs behind them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import xarray as xr

from fenics_gears import load_scene, results
from fenics_gears.geometry.pair import GearPair
from fenics_gears.dynamics.frequencies import natural_frequencies
from fenics_gears.model.model import model_of
from fenics_gears.model.drivetrain import mesh_stiffness
from fenics_gears.scene.data import Scene
from fenics_gears.scene.read import scene_from_text
from fenics_gears.studies.combine import load_combined

HERE = Path(__file__).parent
BASE_SCENE = HERE.parent / "lundvall2004.toml"
READ, PRINTED = "", "printed_inertia/"
"""Prefixes of the studies with J = 24.5 N mm s^2, as we read it, and J = 24.5 kg mm^2, as printed."""
WITH, WITHOUT = "present", "absent"
"""The values of the swept section `friction`."""


def study_files() -> dict[str, Path]:
    """Every study of this folder by its name, "figure02" or "printed_inertia/figure05"."""
    return {str(path.relative_to(HERE).with_suffix("")): path for path in sorted(HERE.rglob("*.toml"))}


@dataclass(frozen=True)
class Measured:
    """Results of the studies below a directory, each at `directory / name`."""

    directory: Path
    # What has been read: figures and claims ask for the same studies again and again.
    _read: dict[Path, xr.Dataset] = field(default_factory=dict, compare=False)

    def study(self, name: str) -> xr.Dataset:
        """The combined dataset of a study."""
        return self._once(self.directory / name / "study.nc", load_combined)

    def _once(self, file: Path, load: Callable[[Path], xr.Dataset]) -> xr.Dataset:
        if file not in self._read:
            self._read[file] = load(file)
        return self._read[file]

    def sweep(self, *names: str) -> xr.Dataset:
        """Peak-to-peak transmission error (rad) and warnings of studies that continue each other in mesh frequency
        (Hz)."""
        parts = [self.study(name)[["peak_to_peak_transmission_error", "warnings"]] for name in names]
        return xr.concat(parts, "mesh_frequency")

    def curves(self, reading: str, figure: str) -> xr.Dataset:
        """Fig. "06" or "10" over all its frequencies, under a reading of J."""
        bands = ["low", "high"] + (["beyond"] if reading == PRINTED and figure == "06" else [])
        return self.sweep(*(f"{reading}figure{figure}_{band}" for band in bands))

    def run(self, name: str, **where) -> xr.Dataset:
        """The last cycles of the run of one case: run("figure04", friction="present")."""
        case = self.study(name).case_file.sel(where)
        return results.shown(self._once(self.directory / name / str(case.item()), results.load))


def peak_to_peak(dataset: xr.Dataset, friction: str) -> np.ndarray:
    """Peak-to-peak transmission error (rad) along the swept field, with or without friction."""
    return dataset.peak_to_peak_transmission_error.sel(friction=friction).values


def one_cycle(dataset: xr.Dataset, variable: str, friction: str) -> np.ndarray:
    """A curve over the first recorded mesh cycle, its end left out; of the wheel where both gears have one."""
    curve = dataset[variable].sel(friction=friction)
    if "gear" in curve.dims:
        curve = curve.sel(gear="wheel")
    return curve.values[: int(np.searchsorted(dataset.mesh_phase.values, 1.0 - 1e-9))]


def base_scene() -> Scene:
    """The paper's scene."""
    return load_scene(BASE_SCENE)


def base_pair() -> GearPair:
    """The paper's gear pair."""
    return model_of(base_scene()).pair


def frequencies_of(run: xr.Dataset) -> np.ndarray:
    """Natural frequencies (Hz) of the scene of a run, with one tooth pair in mesh."""
    scene = scene_from_text(run.attrs["scene"])
    return natural_frequencies(model_of(scene).drivetrain, mesh_stiffness(scene))
