"""The files of an optimisation: all designs as a dataset and as a table, and the chosen one as a scene."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

import fenics_gears
from fenics_gears import as_toml
from fenics_gears.command_line import write_whole
from fenics_gears.many_runs import save
from fenics_gears.scene_text import STAGES, AllowedFile, fields, known_paths, value_at

from .design import QUANTILE
from .optimize import BEST, RESULT, TABLE, SearchOutcome


def write_result(outcome: SearchOutcome) -> list[Path]:
    """Write the dataset, the table and the scene, and return their files. Raises ComputationError where they cannot be
    written."""
    result = dataset(outcome)
    directory = outcome.directory
    columns = result.drop_dims([name for name in result.dims if name != "design"]).to_dataframe()
    titled = columns.rename(
        columns={name: f"{name} ({unit})" for name in columns if (unit := result[name].attrs.get("units", "1")) != "1"}
    )
    return [
        write_whole(directory / BEST, lambda aside: aside.write_text(best_scene(outcome), encoding="utf-8")),
        write_whole(directory / TABLE, lambda aside: titled.to_csv(aside)),
        write_whole(directory / RESULT, lambda aside: save(result, aside)),
    ]


def dataset(outcome: SearchOutcome) -> xr.Dataset:
    """All designs over the dimension `design`: variables by their paths, goals, constraints, whether allowed, on the
    front, and why they failed.

    Goals are what designs are judged by; over `sample` they are also there one by one, over `point` as mean at each
    operating point. The transmission errors of the Harris map are over `choice` ("before", "best"), `load` and
    `mesh_phase`.
    """
    design = outcome.design
    tried = outcome.tried
    numbers = np.arange(len(tried))
    described = {"long_name": "design, in the order in which they were tried"}
    result = xr.Dataset(coords={"design": ("design", numbers, described)})

    def add(name: str, values, unit: str, words: str, *dims: str) -> None:
        result[name] = ("design", *dims), np.array(values), {"units": unit, "long_name": words}

    for variable in design.variables:
        values = np.array([each.values[variable.name] for each in tried], dtype=object if variable.words else float)
        add(variable.name, values, variable.unit or "1", variable.name)
    judged = f"{design.tolerances.quantile:g} quantile" if design.tolerances.judged == QUANTILE else "mean"
    for goal in design.goals:
        words = f"{goal.words}, {judged} over the tolerances" if design.tolerances.scatters else goal.words
        add(goal.name, [each.goals.get(goal.name, np.nan) for each in tried], goal.unit, words)
    units = {each.name: each.unit for each in (*design.goals, *(bound.goal for bound in design.bounds))}
    for name, unit in units.items():
        for dimension, curves in (
            ("sample", [each.of_samples.get(name) for each in tried]),
            ("point", [each.at_points.get(name) for each in tried]),
        ):
            known = next((each for each in curves if each is not None), None)
            if known is not None and len(known) > 1:
                filled = [np.full(len(known), np.nan) if each is None else each for each in curves]
                add(f"{name}_at_{dimension}", filled, unit, name.replace("_", " "), dimension)
    add("violation", [each.violation for each in tried], "1", "how far bounds are broken, in parts of them")
    add("on_front", np.isin(numbers, outcome.front).astype(int), "1", "on the Pareto front")
    add("best", np.isin(numbers, [outcome.best]).astype(int), "1", "the chosen design")
    failures = np.array([each.failure for each in tried], dtype=object)
    result["failure"] = "design", failures, {"long_name": "why the design has no numbers"}
    result = result.merge(harris_dataset(outcome))
    before = {f"before: {name}": value for name, value in outcome.before.goals.items()}
    return result.assign_attrs(
        title=design.title, design=design.text, fenics_gears_version=fenics_gears.__version__, **before
    )


def harris_dataset(outcome: SearchOutcome) -> xr.Dataset:
    """The transmission errors before and after over load and mesh phase; empty where a run of them failed."""
    torques, curves = outcome.harris
    every = [each for of_choice in curves for each in of_choice]
    if not every or any(each is None or each.shape != every[0].shape for each in every):
        return xr.Dataset()
    values = np.array([[each[1] for each in of_choice] for of_choice in curves])
    described = {"units": "rad", "long_name": "transmission error"}
    return xr.Dataset(
        {"transmission_error": (("choice", "load", "mesh_phase"), values, described)},
        coords={
            "choice": np.array(["before", "best"], dtype=object),
            "load": (
                "load",
                torques,
                {"units": "N m", "long_name": "torque on the wheel, of a train on the last shaft"},
            ),
            "mesh_phase": ("mesh_phase", every[0][0], {"units": "1", "long_name": "mesh cycles"}),
        },
    )


def _paths(tree: Mapping[str, Any]) -> dict[fields.Path, bool]:
    """Every path that a scene may have, within its stages too; True for a section."""
    within = {
        (STAGES, name, *path): section for name in tree.get(STAGES, ()) for path, section in fields.of_stages().items()
    }
    return known_paths() | within


def best_scene(outcome: SearchOutcome) -> str:
    """The chosen design as the text of a scene file in the folder of the result."""
    tree = outcome.design.scene_tree(outcome.chosen.values)
    for path, is_section in _paths(tree).items():
        name = None if is_section else value_at(tree, *path)
        if isinstance(name, str) and isinstance(fields.allowed_at(path)[0], AllowedFile):
            file = (outcome.design.directory / name).resolve()
            tree = fields.changed(tree, path, os.path.relpath(file, outcome.directory.resolve()))
    goals = ", ".join(f"{name} = {value:.5g}" for name, value in outcome.chosen.goals.items())
    head = f"# Chosen by `gears optimize` from {len(outcome.tried)} designs of {outcome.design.name}: {goals}."
    return f"{head}\n\n{as_toml(tree)}"
