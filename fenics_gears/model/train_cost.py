"""Expected time and memory of a train: of its rows one after the other, of a row by what its meshes take as pairs."""

from __future__ import annotations

from dataclasses import replace

from fenics_gears.scene.data import Accuracy

from .cost import expected_cost, refused, settings_that_fit, too_large
from .cost_parts import CONDENSING_PROGRAM, OF_FRICTION, ExpectedCost
from .row_model import RowModel
from .train import TrainModel, together

# Contact operators of all meshes together, in the square of their nodes: with factors of what is closed, which those of
# a pair are counted without (measured, of rows of two meshes over the face).
WITH_FACTORS = 1.3


def train_cost(model: TrainModel) -> ExpectedCost:
    """Of all rows, one after the other."""
    costs = [row_cost(row) for row in model.rows]
    return ExpectedCost(
        sum(each.condensing or 0.0 for each in costs),
        sum(each.marching for each in costs),
        max(each.memory for each in costs),
    )


def row_cost(row: RowModel) -> ExpectedCost:
    """Of a row: the operators of each mesh are those of its pair, and those of all meshes stand beside them. Equal
    gears are condensed once; an idler, with both of its flanks, takes what its two meshes would as pairs."""
    costs = [expected_cost(each) for each in row.models]
    if row.single:
        return costs[0]
    # Beside meshes with friction one without has as many rows as they have.
    more = [OF_FRICTION if row.friction and each.scene.friction is None else 1.0 for each in row.models]
    together = WITH_FACTORS * sum((times * each.operators) ** 0.5 for times, each in zip(more, costs)) ** 2
    # Meshes that are like others share their operators. Over the face they are solved one by one without friction.
    own = sum(each.operators for each, mesh in zip(costs, row.meshes) if mesh.like is None)
    alone = row.over_face and not row.friction
    operators = own + (0.0 if row.passes_once or alone else together)
    # Gears are condensed one after the other.
    passing = max(each.passing for each in costs)
    held = CONDENSING_PROGRAM + passing + sum(each.held - each.passing - CONDENSING_PROGRAM for each in costs)
    of_gears = {(each.pair.gears, each.scene.gears.materials): cost.condensing for each, cost in zip(row.models, costs)}
    return ExpectedCost(
        sum(each or 0.0 for each in of_gears.values()),
        # A step of all meshes takes as many times longer as there are.
        len(costs) * sum(each.marching for each in costs),
        held + operators,
        operators,
        passing=passing,
    )


def row_too_large(row: RowModel, cost: ExpectedCost, allowed: float) -> str:
    """As `cost.too_large`, of a row."""
    if row.single or cost.held <= allowed:
        return too_large(row.models[0], cost, allowed)

    def held(accuracy: Accuracy) -> float:
        meshes = [replace(mesh, scene=replace(mesh.scene, accuracy=accuracy)) for mesh in row.meshes]
        return row_cost(together(meshes, row.shafts)).held

    fits = settings_that_fit(row.models[0], held, allowed)
    return f"{row.meshes[0].name} and those behind it: {refused(cost, allowed, fits)}"
