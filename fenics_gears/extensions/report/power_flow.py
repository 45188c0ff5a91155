"""The power through a train: speed, torque and power of each shaft, and what the friction of each mesh takes."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
import xarray as xr

from fenics_gears.shown import TrainScene


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
    """Of a train's run, backwards from the loads: mean torques, each higher by what its mesh loses, and of several
    paths by the mean share of each. Of meshes that are computed together the loss is told of all of them, at the last
    one, and taken where they drive the last of their shafts, or of several loads where the first shaft drives."""
    graph = train.graph
    loads = train.loads
    lost = np.nan_to_num(result["friction_loss"].values) if "friction_loss" in result else np.zeros(len(train.meshes))
    taken = lost.copy()
    if graph.loops:
        # All meshes are computed together then.
        taken[graph.into(graph.last)] = lost[-1]
    if sum(load > 0.0 for load in loads) > 1:
        # What all meshes together take is of the work that drives the first shaft.
        taken[:] = 0.0
        taken[graph.out_of(0)] = lost[-1]
    shares = result["mean_path_share"].values if "mean_path_share" in result else np.ones(len(train.meshes))
    torques = list(loads)
    for shaft in range(graph.last, 0, -1):
        driving = graph.into(shaft)
        for mesh in driving:
            own = torques[shaft] * (shares[mesh] if len(driving) > 1 else 1.0)
            before = graph.between[mesh][0]
            torques[before] += own * abs(train.meshes[mesh].pair.rotation_ratio) / (1.0 - taken[mesh])
    shafts = [ShaftFlow(train.input_speed * turns, torque) for turns, torque in zip(train.turns, torques)]
    meshes = [
        MeshFlow(", ".join(train.meshes[number].name for number in row), float(1.0 - lost[row[-1]]))
        for row in train.rows
    ]
    return PowerFlow(tuple(shafts), tuple(meshes) if lost.any() else (), train.speed_given)
