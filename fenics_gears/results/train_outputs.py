"""Lags of the shafts of a train that drive no gear, where all meshes move together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.model.train import TrainModel

from .layout import OF_OUTPUTS

if TYPE_CHECKING:
    from .train import MeshResult


def lag_of_output(model: TrainModel, meshes: Sequence[MeshResult], shaft: int) -> np.ndarray:
    """Lag (rad) of a shaft that drives no gear behind the nominal motion of the first, at all steps of meshes that
    move together."""
    # The gears that their shafts' clocking does not turn.
    carried = model.scene.shafts.carried
    sides = [mesh.gears for mesh in model.scene.meshes]
    ends = [[both[0] for both in sides].index(carried[0][0]), [both[1] for both in sides].index(carried[shaft][0])]
    first, last = (np.asarray(meshes[number].variables["rotation"][1])[:, side] for side, number in enumerate(ends))
    ratio = model.scene.ratio if shaft == model.scene.graph.last else 1.0 / model.scene.turns[shaft]
    return model.scene.meshes[ends[1]].pair.wheel.sign * last + first / ratio


def of_outputs(model: TrainModel, meshes: Sequence[MeshResult]) -> dict[str, tuple]:
    """Lag of each shaft that drives no gear, where there are several."""
    scene = model.scene
    outputs = scene.graph.outputs
    if len(outputs) == 1:
        return {}
    lags = np.stack([lag_of_output(model, meshes, shaft) for shaft in outputs], axis=1)
    names = [scene.shafts.carried[shaft][0] for shaft in outputs]
    words = "lag of each shaft that drives no gear behind the nominal motion of the first"
    last = slice(-1 - model.rows[0].recorded if model.rows[0].recorded else None, None)
    return {
        f"peak_to_peak_{OF_OUTPUTS}": ("output", np.ptp(lags[last], axis=0), {"units": "rad", "long_name": words}),
        OF_OUTPUTS: (("time", "output"), lags, {"units": "rad", "long_name": words}),
        "output": ("output", names, {"long_name": "first gear of a shaft that drives no gear"}),
    }
