"""Torques on the shafts of a train from outside, and in its meshes without losses."""

from __future__ import annotations

from collections.abc import Sequence

from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear_train import Layout
from fenics_gears.inputs.problem import NOTHING_DONE

from .train_loads import LoadOfShaft, TrainLoad


def torques_of_shafts(
    load: TrainLoad, loads: Sequence[LoadOfShaft], turns: Sequence[float], driving: float
) -> list[float]:
    """Torque (N mm) that resists the rotation of each shaft but the first from outside; `turns` of each in one of the
    first, which turns by `driving` rad/s. Raises SceneError where nothing is left for the last shaft."""
    found = [0.0] * len(turns)
    for each in loads:
        found[each.shaft] = each.torque
    if load.output_torque is not None:
        found[-1] = load.output_torque
    elif load.input_torque is not None or load.power is not None:
        torque = load.input_torque if load.input_torque is not None else (load.power or 0.0) / driving
        others = sum(own * turn for own, turn in zip(found, turns))
        if others and others >= torque:
            raise SceneError(
                f"load: {1e-3 * torque:.6g} N m drive the first shaft, of which load.torques take {1e-3 * others:.6g} N"
                " m: nothing is left for the last shaft. Allowed: more input_torque or power, or smaller load.torques."
                f" {NOTHING_DONE}"
            )
        found[-1] = (torque - others) / turns[-1]
    return found


def even_torques(layout: Layout, of_shafts: Sequence[float]) -> list[float]:
    """Torque (N mm) on the wheel of each mesh without losses, where the meshes that drive a shaft share it evenly;
    `of_shafts`: torque on each shaft from outside."""
    graph = layout.graph
    on_shafts = list(of_shafts)
    found = [0.0] * len(layout.pairs)
    for shaft in range(graph.last, 0, -1):
        driving = graph.into(shaft)
        for mesh in driving:
            found[mesh] = on_shafts[shaft] / len(driving)
            on_shafts[graph.between[mesh][0]] += found[mesh] * abs(layout.pairs[mesh].rotation_ratio)
    return found
