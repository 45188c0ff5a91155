"""The power through a train: speed, torque and power of each shaft, and what the friction of each mesh takes."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
import xarray as xr

from fenics_gears.scene.train import TrainScene


@dataclass(frozen=True)
class ShaftFlow:
    """`speed`: turns in a second; `torque`, N mm, `power`, N mm/s."""

    speed: float
    torque: float

    @property
    def power(self) -> float:
        return 2.0 * pi * self.speed * self.torque


@dataclass(frozen=True)
class MeshFlow:
    """A mesh, or meshes that are computed together, and the efficiency by friction."""

    name: str
    efficiency: float


@dataclass(frozen=True)
class PowerFlow:
    """From the driven shaft on; `meshes` are empty without friction."""

    shafts: tuple[ShaftFlow, ...]
    meshes: tuple[MeshFlow, ...]
    speed_given: bool

    @property
    def efficiency(self) -> float:
        """Of the whole."""
        return float(np.prod([each.efficiency for each in self.meshes]))


def power_flow(result: xr.Dataset, train: TrainScene) -> PowerFlow:
    """Of a train's run, backwards from the load on the last shaft: mean torques, each higher by what its mesh loses.
    In a row the loss is told of all its meshes together, at the last one."""
    lost = result["friction_loss"].values if "friction_loss" in result else np.zeros(len(train.meshes))
    lost = np.nan_to_num(lost)
    speeds = [train.input_speed]
    for mesh in train.meshes:
        speeds.append(speeds[-1] * mesh.pair.rotation_ratio)
    torques = [train.output_torque]
    for mesh, loss in zip(reversed(train.meshes), reversed(lost)):
        torques.append(torques[-1] * mesh.pair.rotation_ratio / (1.0 - loss))
    shafts = map(ShaftFlow, speeds, reversed(torques))
    meshes = [
        MeshFlow(", ".join(train.meshes[number].name for number in row), float(1.0 - lost[row[-1]]))
        for row in train.rows
    ]
    return PowerFlow(tuple(shafts), tuple(meshes) if lost.any() else (), train.speed_given)
