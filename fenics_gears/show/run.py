"""A stored run for charts, pictures and the report: the cycles shown, curves of tooth pairs, contact fields."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from fenics_gears.effects import ALONG_THE_FACE, effects_on
from fenics_gears.errors import GearsError
from fenics_gears.geometry.pair import GearPair, gear_pair
from fenics_gears.results.carried_scene import carried_scene
from fenics_gears.results.pairs import carrying_side, in_middle_slice, lives
from fenics_gears.results.settled import of_settled
from fenics_gears.scene.data import LOAD_WORDS, Scene

from .panels import digits, factor, in_unit

if TYPE_CHECKING:
    from fenics_gears.scene.train_scene import TrainScene

NO_SCENE = (
    "The scene in this file is none of this version of the program, so that this section cannot be made; run the scene"
    " again."
)
TOO_FEW = "Fewer than two steps are stored; a curve needs two."
# Most mesh cycles side by side in a chart. Of longer records the last ones are shown, and all of them cycle by cycle.
MOST_CYCLES = 4.0
# Cycles whose least and largest values differ by less than this part of the largest span are alike.
ALIKE = 0.01


@dataclass(frozen=True)
class ShownRun:
    """A result, the file it was read from, and the settings of its report.

    at: mesh cycles after the first stored step at which the stress picture is drawn, None for where the largest force
    is; stress: whether it is drawn at all. of_train: where it is a mesh of a train, the train's result, the train and
    the number of the mesh.
    """

    dataset: xr.Dataset
    file: Path | None = None
    at: float | None = None
    stress: bool = True
    of_train: tuple[xr.Dataset, TrainScene, int] | None = None

    @cached_property
    def scene(self) -> Scene | None:
        """The scene that was run; None where its text is no scene of this version."""
        if self.of_train is None:
            return scene_of(self.dataset)
        _, train, number = self.of_train
        return train.meshes[number].scene

    @property
    def title(self) -> str:
        """The scene's title in one line, empty where it has none."""
        return " ".join(str(self.dataset.attrs.get("title", "")).split())

    @cached_property
    def pair(self) -> GearPair | None:
        """The gear pair; None as for the scene."""
        try:
            return None if self.scene is None else gear_pair(self.scene.gears)
        except GearsError:
            return None

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

    @cached_property
    def phase(self) -> np.ndarray:
        """Mesh cycles since the start (time,)."""
        return self.dataset["mesh_phase"].values

    @property
    def cycles(self) -> float:
        """Mesh cycles from the first to the last stored step."""
        return float(self.phase[-1] - self.phase[0])

    @cached_property
    def settled(self) -> ShownRun:
        """The settled part of the run, from which all its numbers are taken."""
        return replace(self, dataset=of_settled(self.dataset))

    @cached_property
    def window(self) -> tuple[float, float]:
        """The mesh cycles that charts show before they are zoomed: the last ones, as many as can be told apart."""
        cycles = min(float(self.dataset.attrs.get("shown_cycles", MOST_CYCLES)), MOST_CYCLES)
        return max(float(self.phase[0]), float(self.phase[-1]) - cycles), float(self.phase[-1])

    @property
    def in_window(self) -> np.ndarray:
        """Which stored steps (time,) these are."""
        return self.phase >= self.window[0] - 1e-9

    @property
    def shows_all(self) -> bool:
        """Whether that is all that is stored."""
        return bool(self.in_window.all())

    @property
    def on_coast_flanks(self) -> bool:
        """Whether the coast flanks carry more than the drive flanks, over the stored steps."""
        return bool(carrying_side(self.dataset))

    @property
    def micrometres(self) -> float:
        """µm on the wheel's base circle of a transmission error of 1 rad."""
        radius = self.dataset.attrs.get("base_radius_wheel")
        return float(radius) * factor("mm", "µm") if radius else float("nan")

    def values(self, name: str, unit: str) -> np.ndarray:
        """A variable (time,), or (time, gear), in a unit."""
        return in_unit(self.dataset[name].transpose("time", ...), unit)

    @cached_property
    def whole_cycles(self) -> list[slice]:
        """The steps of each stored mesh cycle, both ends included; none where cycles are not of equally many steps."""
        count = int(self.cycles * (1 + 1e-9))
        steps = (self.steps - 1) / self.cycles if self.cycles else 0.0
        if abs(steps - round(steps)) > 1e-6 or steps < 2:
            return []
        return [slice(round(steps) * each, round(steps) * (each + 1) + 1) for each in range(count)]

    @property
    def cycle_axis(self) -> tuple[np.ndarray, str]:
        """Middle (n,) of each stored mesh cycle and the axis' words: its mesh frequency where that changes."""
        ramp = "mesh_frequency" in self.dataset
        axis = self.values("mesh_frequency", "Hz") if ramp else self.phase
        title = "Mesh frequency (Hz)" if ramp else "Middle of the mesh cycle (mesh cycles since the start)"
        return np.array([axis[each].mean() for each in self.whole_cycles]), title

    def varies(self, values: np.ndarray) -> bool:
        """Whether the settled mesh cycles of values (time,) differ."""
        first = float(self.settled.phase[0])
        settled = (values[each] for each in self.whole_cycles if self.phase[each][0] >= first - 1e-9)
        ends = np.array([(each.min(), each.max()) for each in settled])
        return len(ends) > 1 and bool(np.ptp(ends, axis=0).max() > ALIKE * np.ptp(ends))

    def of_pairs(self, name: str, unit: str, **place) -> list[tuple[str, np.ndarray, int]]:
        """Curves of a variable of the tooth pairs that carry in the cycles shown: words for it, values (time,), not a
        number where the pair has none, and its number."""
        part = np.flatnonzero(self.in_window)
        values = in_unit(self.dataset[name].sel(place).transpose("time", "slot"), unit)
        curves = []
        for life in lives(self.dataset["pair_number"].values[part]):
            own = np.full(self.steps, np.nan)
            steps = part[life.steps]
            own[steps] = values[steps, life.slot]
            there = np.isfinite(own) & (own != 0.0)
            if there.any():
                curves.append((f"pair {life.number}", np.where(_with_ends(there), own, np.nan), life.number))
        return curves

    @property
    def over_face(self) -> bool:
        """Whether the flanks are resolved over the face."""
        return "face_position" in self.dataset.dims

    @cached_property
    def last_fields(self) -> xr.Dataset:
        """The last cycles whose contact fields are stored, no more than can be told apart."""
        phase = self.dataset["contact_mesh_phase"].values
        return self.dataset.isel(contact_time=phase >= phase[-1] - MOST_CYCLES - 1e-9)

    def fields(self, side: str) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Contact pressure (MPa) and the pinion's roll angle (deg) of the contact nodes, both (step, slot, node), in
        the middle of the face if they are resolved over it. Then the steps' mesh cycles (step,) and the pairs' numbers
        (step, slot). side: how the result's variables of that side begin."""
        part = in_middle_slice(self.last_fields)
        order = ("contact_time", "slot", "contact_node")
        pressure = in_unit(part[f"{side}contact_pressure"].transpose(*order), "MPa")
        place = in_unit(part[f"{side}contact_roll_angle"].transpose(*order), "deg")
        return pressure, place, part["contact_mesh_phase"].values, part["contact_pair_number"].values


def shown_mesh(dataset: xr.Dataset, train: TrainScene, number: int, **asked: Any) -> ShownRun:
    """A mesh of a train's result as the run of its pair. `asked`: further fields of it."""
    # Here: a pair's run has none.
    from fenics_gears.results.mesh_of_train import mesh_run

    return ShownRun(mesh_run(dataset, train, number), of_train=(dataset, train, number), **asked)


def _with_ends(there: np.ndarray) -> np.ndarray:
    """Where there are values (time,), and one step before and after, so that curves begin and end at zero."""
    near = there.copy()
    near[1:] |= there[:-1]
    near[:-1] |= there[1:]
    return near


def scene_of(dataset: xr.Dataset) -> Scene | None:
    """The scene that a result was computed from; None where its text is no scene of this version."""
    try:
        return carried_scene(dataset)
    except GearsError:
        return None


def conditions(scene: Scene) -> str:
    """Load, speed and `design` of a scene: what tells apart two pictures of the same gears."""
    ramp = "" if scene.speed_ramp is None else f" to {scene.speed_ramp.end_frequency:g}"
    speed = "quasi-static" if scene.inertia is None else f"{scene.motion.mesh_frequency:g}{ramp} Hz mesh frequency"
    return f"{load_in_words(scene)}, {speed}, {design(scene)}"


def load_in_words(scene: Scene) -> str:
    """The load as the scene gives it: torque of the wheel or of the pinion, or power."""
    unit, words = LOAD_WORDS[scene.load.given]
    value = digits(scene.given_load * factor("N mm/s" if unit == "kW" else "N mm", unit))
    return f"{value} {unit}{words.removeprefix('torque').removeprefix('power')}"


def design(scene: Scene) -> str:
    """Friction, modifications, errors and ripple of a scene, whatever its load and speed."""
    friction = "no friction"
    if (own := scene.friction) is not None:
        friction = f"friction after {own.formula}" if own.formula else f"friction coefficient {own.coefficient:g}"
    helix = f", helix angle {scene.gears.helix_angle * factor('rad', 'deg'):g}°" if scene.gears.helix_angle else ""
    aligned = "misalignment" if scene.misalignment is not None and scene.misalignment.is_none else ""
    effects = effects_on(scene)
    shaping = [each.section for each in effects if each.removal or each.gaps or each.section in ALONG_THE_FACE]
    shapes = helix + "".join(f", {section.replace('_', ' ')}" for section in shaping if section != aligned)
    ripple = "" if scene.torque_ripple is None else ", torque ripple"
    return f"{friction}{shapes}{ripple}"
