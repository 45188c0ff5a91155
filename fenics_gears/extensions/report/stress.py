"""The gears in mesh with their stresses, drawn as `gears picture` draws them."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import xarray as xr

from fenics_gears import GearsError
from fenics_gears.pages import PageSection, Picture, sentence
from fenics_gears.shown import NO_SCENE, ShownRun, contact_times, stored_index, stress_drawing

HEADING = "Stress in the gears"


def stress(run: ShownRun) -> PageSection:
    """The stress picture where the mesh force is largest, or at the time asked for; or why there is none."""
    if why := _why_not(run):
        return sentence("stress", HEADING, *why)
    dataset = contact_times(run.dataset)
    index = _most_loaded(dataset) if run.at is None else stored_index(dataset, run.at)
    try:
        content, shown, charts = stress_drawing(run, index)
    except GearsError as error:
        return sentence("stress", HEADING, f"It could not be drawn: {error}", True)
    when = "where the force of the mesh is largest" if run.at is None else "as asked for"
    since = float(dataset["mesh_phase"].values[index] - dataset["mesh_phase"].values[0])
    mesh = "" if run.of_train is None else f' --mesh "{_mesh_of(run)}"'
    others = f"`gears picture RUN{mesh} --at PHASE` draws other times, `--animate` a turn."
    note = f"{since:.4g} mesh cycles after the first step with contact fields, {when}; {others}"
    return PageSection("stress", HEADING, [Picture(f"{shown} of both gears in mesh", content, note), *charts])


def stresses(runs: Mapping[int, ShownRun]) -> list[PageSection]:
    """Those of the meshes of a train, by their numbers; one section where they are left out."""
    if not all(run.stress for run in runs.values()):
        return [stress(run) for run in runs.values()][:1]
    return [
        replace(stress(run), name=f"stress-{number + 1}", heading=f"{HEADING}: {_mesh_of(run)}")
        for number, run in runs.items()
    ]


def _mesh_of(run: ShownRun) -> str:
    _, train, number = run.of_train
    return train.meshes[number].name


def _why_not(run: ShownRun) -> tuple[str, bool] | None:
    if not run.stress:
        return "Left out by the option `--no-stress`.", False
    if run.scene is None or not run.steps:
        return NO_SCENE if run.steps else "No step is stored.", True
    if not run.scene.resolves_contact:
        return "There is none: this run's flanks are rigid or its mesh is one of springs.", False
    if run.scene.body_meshes is not None:
        said = "There is none: stresses are recovered from gears of equal sectors, and these are meshed as a whole."
        return said, False
    if not run.dataset.sizes.get("contact_time"):
        return "There is none: the run has stored no contact fields (`[output] contact_fields`).", False
    return None


def _most_loaded(dataset: xr.Dataset) -> int:
    forces = [dataset[name].values for name in ("normal_force", "coast_normal_force") if name in dataset]
    return int(np.argmax(np.max(forces, axis=0)))
