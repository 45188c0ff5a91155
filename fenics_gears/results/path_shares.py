"""How paths of a train share the torque: of each mesh its part in the torque of all meshes that drive the same shaft,
or that the same shaft drives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.geometry.train_graph import TrainGraph

if TYPE_CHECKING:
    from fenics_gears.model.train import TrainModel

    from .train import MeshResult

SHARE = "path_share"
# Numbers of each mesh, and what they are.
OF_SHARES = {
    "mean_path_share": "mean part of the torque that a mesh carries of all that drive its shaft, or are driven by it",
    "largest_path_share": "largest part of that torque",
    "least_path_share": "least part of that torque",
}


def beside(graph: TrainGraph, mesh: int) -> list[int]:
    """Meshes among which a mesh shares torque, itself too: those that drive the same shaft, or else those that the same
    shaft drives."""
    driving, driven = graph.between[mesh]
    into = graph.into(driven)
    return into if len(into) > 1 else graph.out_of(driving)


def path_shares(model: TrainModel, meshes: Sequence[MeshResult]) -> dict[str, tuple]:
    """Shares over steps and meshes, by normal forces, and numbers of them; nothing where a train has one path."""
    graph = model.scene.graph
    if not graph.loops:
        return {}
    torques = []
    for own, found in zip(model.models, meshes):
        cosine = own.face.cosine if own.scene.three_dimensional else 1.0
        torques.append(np.asarray(found.variables["normal_force"][1]) * cosine)
    shares = []
    for mesh in range(len(model.models)):
        others = beside(graph, mesh)
        # On the shaft that they have in common.
        side = 1 if graph.between[others[0]][1] == graph.between[mesh][1] else 0
        on_shaft = [torques[each] * abs(model.models[each].pair.base_radii[side]) for each in others]
        whole = np.sum(on_shaft, axis=0)
        carried = on_shaft[others.index(mesh)]
        shares.append(np.divide(carried, whole, out=np.full_like(whole, np.nan), where=whole > 0.0))
    over_steps = np.stack(shares, axis=1)
    recorded = model.rows[0].recorded
    counted = over_steps[-1 - recorded : -1] if recorded else over_steps[:-1]
    numbers = np.nanmean(counted, axis=0), np.nanmax(counted, axis=0), np.nanmin(counted, axis=0)
    labels = {"units": "1", "long_name": "part of the torque on its shaft that a mesh carries"}
    found_numbers = {
        name: (("mesh",), values, {"units": "1", "long_name": words})
        for (name, words), values in zip(OF_SHARES.items(), numbers)
    }
    return {SHARE: (("step", "mesh"), over_steps, labels), **found_numbers}
