"""A tip relief by depth and length, and the transmission error that it leaves the paper's gears."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import xarray as xr

from fenics_gears import load_scene, simulate
from fenics_gears.effects.corner_contact import EdgeRadii
from fenics_gears.geometry.relief import LINEAR, PARABOLIC, Relief
from fenics_gears.effects.tip_relief import TipRelief
from fenics_gears.geometry.pair import GearPair
from fenics_gears.model.model import model_of
from fenics_gears.results import shown
from fenics_gears.scene.data import Accuracy, Load, Motion, Scene
from fenics_gears.runs.gear_store import GearStore

SHAPES = (LINEAR, PARABOLIC)
SHORT, LONG = 0.5, 1.0
"""Lengths by the names that the field has for them: short leaves one base pitch of involute, long begins at the highest
point of single tooth contact."""
MICROMETRES = 1e3  # in a millimetre
# Fine enough for contact of twice the load; the paper's elements and steps.
ACCURACY = Accuracy(
    element="P2", flank_element_size=0.08, contact_length=2.5, contact_nodes=32, steps_per_mesh_cycle=100
)


@dataclass(frozen=True)
class Design:
    """Relief of both gears: depth at the tip (um), length from the tip as a part of the double contact, "linear" or
    "parabolic"."""

    depth: float
    length: float
    shape: str = LINEAR


def paper_scene(accuracy: Accuracy = ACCURACY) -> Scene:
    """The paper's gears at its torque, quasi-static, one mesh cycle; tips touch where they do, before and after the
    path of contact too."""
    scene = load_scene(Path(__file__).parents[1] / "lundvall2004.toml")
    return replace(
        scene, inertia=None, damping=None, corner_contact=EdgeRadii(0.0), accuracy=accuracy, motion=Motion(200.0, 1, 1)
    )


def conditions(scene: Scene) -> dict[str, Scene]:
    """What a relief is chosen under: friction and what carries it."""
    stiff = {"shafts": None, "bearings": None}
    return {
        "μ = 0": replace(scene, friction=None),
        "μ = 0.05": replace(scene, friction=replace(scene.friction, coefficient=0.05)),
        "μ = 0.1": scene,
        "μ = 0.1, stiff shafts and bearings": replace(scene, **stiff),
    }


def relief(pair: GearPair, design: Design) -> TipRelief:
    """The relief of both gears as a scene has it; a length of 1 begins at HPSTC."""
    ends = (
        (pair.pinion.tip_roll_angle, pair.hpstc_roll_angles[0]),
        (pair.wheel.tip_roll_angle, pair.hpstc_roll_angles[1]),
    )
    return TipRelief(
        *(
            Relief(design.depth / MICROMETRES, tip - design.length * (tip - single), shape=design.shape)
            for tip, single in ends
        )
    )


class Bench:
    """Runs a scene with one relief after another."""

    def __init__(self, scene: Scene, store: GearStore):
        self.scene, self.pair, self._store = scene, model_of(scene).pair, store

    def torque(self, load: float | np.ndarray = 1.0) -> float | np.ndarray:
        """Couple on the wheel, N m, at a `load` in parts of the scene's."""
        return load * self.scene.load.wheel_torque / 1e3

    def run(self, design: Design | None, load: float = 1.0) -> xr.Dataset:
        """The scene's result with a relief, or true involutes, at a `load` in parts of the scene's torque."""
        changed = replace(self.scene, load=Load(load * self.scene.load.wheel_torque))
        if design is not None and design.depth > 0.0:
            changed = replace(changed, tip_relief=relief(self.pair, design))
        return simulate(changed, preparation=self._store.prepared)

    def error(self, design: Design | None, load: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
        """Time (n,) in mesh cycles, and transmission error (n,) in um on the wheel's base circle, load included."""
        result = shown(self.run(design, load))
        return result["mesh_phase"].values, result[
            "transmission_error"
        ].values * self.pair.wheel.base_radius * MICROMETRES

    def peak_to_peak(self, design: Design | None, load: float = 1.0) -> float:
        """Peak-to-peak transmission error, um on the wheel's base circle."""
        return float(np.ptp(self.error(design, load)[1]))
