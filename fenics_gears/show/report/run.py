"""The run that a report is on, as its sections see it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import xarray as xr

from fenics_gears.geometry.pair import GearPair
from fenics_gears.results.pairs import shown
from fenics_gears.scene.data import Scene
from fenics_gears.show.run_scene import gear_pair_of, scene_of
from fenics_gears.show.units import factor

NO_SCENE = "The scene in this file is none of this version of the program, so that this section cannot be made; run the scene again."
TOO_FEW = "Fewer than two steps are stored; a curve needs two."


@dataclass(frozen=True)
class Run:
    """A result, the file it was read from, and the settings of its report.

    at: mesh cycles after the first stored step at which the stress picture is drawn, None for where the largest force is; stress: whether
    it is drawn at all.
    """

    dataset: xr.Dataset
    file: Path
    at: float | None = None
    stress: bool = True

    def __post_init__(self):
        """A report is on the cycles that pictures show; its numbers are those of the result."""
        object.__setattr__(self, "dataset", shown(self.dataset))

    @cached_property
    def scene(self) -> Scene | None:
        """The scene that was run; None where its text is no scene of this version."""
        return scene_of(self.dataset)

    @cached_property
    def pair(self) -> GearPair | None:
        """The gear pair; None as for the scene."""
        return gear_pair_of(self.dataset)

    @property
    def steps(self) -> int:
        """Stored steps."""
        return self.dataset.sizes.get("time", 0)

    @property
    def has_curves(self) -> bool:
        """Whether there is more than a point of a curve."""
        return self.steps >= 2

    @property
    def complete(self) -> bool:
        """Whether the run came to its end."""
        return bool(self.dataset.attrs.get("complete", 1))

    @property
    def cycles(self) -> float:
        """Mesh cycles from the first to the last stored step."""
        phase = self.dataset["mesh_phase"].values
        return float(phase[-1] - phase[0])

    @property
    def on_coast_flanks(self) -> bool:
        """Whether the coast flanks carry more than the drive flanks, over the stored steps."""
        carried = [float(self.dataset[name].sum()) if name in self.dataset else 0.0 for name in ("coast_normal_force", "normal_force")]
        return carried[0] > carried[1]

    @property
    def micrometres(self) -> float:
        """What a transmission error in rad is multiplied with to be micrometres on the wheel's base circle."""
        radius = self.dataset.attrs.get("base_radius_wheel")
        return float(radius) * factor("mm", "µm") if radius else float("nan")
