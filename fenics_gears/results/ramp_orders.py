"""Orders of the overall transmission error of a train over the speeds of a ramp.

In each window of whole cycles of the slowest mesh the harmonics of all mesh frequencies are fitted by least squares
over the phases of the meshes, in which steps are equal whatever the speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from fenics_gears.scene.train import TrainScene

from .overall_orders import harmonics

HARMONICS = 3
WINDOW_CYCLES = 2


@dataclass(frozen=True, eq=False)
class RampOrder:
    """A harmonic of a mesh, named as the first that has this frequency: `order` of the first shaft; `amplitudes` (w,),
    rad of the last shaft, at the mean `speeds` (w,) of the first shaft, turns in a second."""

    mesh: str
    harmonic: int
    order: float
    speeds: np.ndarray
    amplitudes: np.ndarray


def ramp_orders(result: xr.Dataset, train: TrainScene) -> list[RampOrder]:
    """The first harmonics of each mesh frequency, window by window of a run with a speed ramp; of those that several
    meshes have, the first mesh's."""
    steps = result["steps_per_mesh_cycle"].values.astype(int)
    turned = [mesh.scene.motion.mesh_frequency / train.input_speed for mesh in train.meshes]
    orders: dict[float, tuple[int, int]] = {}
    for mesh, order in enumerate(turned):
        for n in range(1, min(HARMONICS, steps[mesh] // 2 - 1) + 1):
            orders.setdefault(round(n * order, 9), (mesh, n))
    lag = result["overall_transmission_error"].values
    speed = result["mesh_frequency"].isel(mesh=0).values / turned[0]
    width = min(WINDOW_CYCLES * steps.max(), len(lag) - 1)
    starts = range(0, len(lag) - width, width)
    # Mesh cycles of all harmonics at the steps of a window, from its start on.
    cycles = np.outer(np.arange(width), [n / steps[mesh] for mesh, n in orders.values()])
    windows = np.array([lag[start : start + width] for start in starts]).reshape(-1, width)
    speeds = np.array([speed[start : start + width].mean() for start in starts])
    amplitudes = np.hypot(*harmonics(cycles, windows.T))
    return [
        RampOrder(train.meshes[mesh].name, n, order, speeds, own)
        for (order, (mesh, n)), own in zip(orders.items(), amplitudes)
    ]
