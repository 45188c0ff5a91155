"""What the settings of a train cost whose meshes are computed together: each made finer alone, in all meshes at once.

How much a number then changes is how much of its error that setting leaves, or more: of a setting whose error falls
with its first power half of the error is left, of one with the second power a quarter."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from fenics_gears import ComputationError, GearsError, simulate_train
from fenics_gears.charts import DARK, PALETTE, styled
from fenics_gears.many_runs import Progress
from fenics_gears.measuring import Accuracy, compile_kernels
from fenics_gears.shown import train_model_of

from .machine import in_words, machine, write_lines

OWN = "as they stand"
# Numbers by name: words and unit; of each mesh the largest counts.
NUMBERS = {
    "mean_overall_transmission_error": ("T_E, mean", "rad"),
    "peak_to_peak_overall_transmission_error": ("T_E, peak to peak", "rad"),
    "largest_pair_force": ("largest pair force", "N"),
    "peak_contact_pressure": ("peak pressure", "MPa"),
    "face_load_factor": ("K_Hbeta", ""),
    "load_sharing_factor": ("K_gamma", ""),
    "largest_bearing_force": ("largest bearing force", "N"),
}


@dataclass(frozen=True)
class Row:
    """The settings as they stand, or with one of them finer: seconds of a run with gears of its own, and numbers."""

    name: str
    seconds: float
    numbers: Mapping[str, float]


@dataclass(frozen=True)
class TrainReport:
    """All rows, those as they stand first; `failures`: what did not run, and why."""

    title: str
    rows: tuple[Row, ...]
    failures: tuple[tuple[str, str], ...]
    machine: Mapping[str, str]

    def changes(self, row: Row) -> dict[str, float]:
        """By how much a row's numbers are larger than those as they stand, in parts of these; round-off is none."""
        own = self.rows[0].numbers
        return {name: round(row.numbers[name] / value - 1.0, 9) for name, value in own.items() if value}


def measure(train, progress: Progress) -> TrainReport:
    """Run a train as it stands and with each setting finer. Raises SceneError, GeometryError, and ComputationError
    where it does not run as it stands."""
    progress.stage("compile")
    compile_kernels(any(mesh.scene.friction is not None for mesh in train.meshes), progress=progress)
    models = {mesh.name: model for mesh, model in zip(train.meshes, train_model_of(train).models)}
    progress.stage("settings")
    rows: list[Row] = []
    failures = []
    for name in progress.counted([OWN, *_finer(next(iter(models.values())))], str):
        try:
            changed = _with(train, lambda mesh, name=name: _accuracy(mesh.scene.accuracy, models[mesh.name], name))
            begun = time.perf_counter()
            found = simulate_train(changed)
            rows.append(Row(name, time.perf_counter() - begun, numbers_of(found)))
        except GearsError as error:
            if not rows:
                raise ComputationError(f"the train does not run as it stands: {error}") from error
            failures.append((name, str(error).splitlines()[0]))
    return TrainReport(train.title, tuple(rows), tuple(failures), machine())


def _finer(model) -> dict[str, dict[str, float]]:
    """By row, which settings of a mesh are finer than as they stand."""
    resolution = model.resolution
    body = resolution.body_element_size or model.scene.gears.module
    slices, _ = model.slices_and_layers
    of_face = {"twice the slices": {"slices": 2 * slices}} if slices else {}
    return {
        "twice the steps": {"steps_per_mesh_cycle": 2 * resolution.steps_per_mesh_cycle},
        "flank elements half as large": {"flank_element_size": 0.5 * resolution.flank_element_size},
        "body elements half as large": {"body_element_size": 0.5 * body},
        **of_face,
    }


def _accuracy(own: Accuracy, model, name: str) -> Accuracy:
    """The accuracy of a mesh in a row. Steps and flank elements stay as they were decided where they are no finer."""
    resolution = model.resolution
    decided = {
        "steps_per_mesh_cycle": resolution.steps_per_mesh_cycle,
        "flank_element_size": resolution.flank_element_size,
    }
    return replace(own, **decided | _finer(model).get(name, {}))


def _with(train, change: Callable[..., Accuracy]):
    """The train with another accuracy of each mesh, and so its parts."""
    meshes = tuple(replace(mesh, scene=replace(mesh.scene, accuracy=change(mesh))) for mesh in train.meshes)
    return replace(train, meshes=meshes, joined=tuple(_with(part, change) for part in train.joined))


def numbers_of(found: xr.Dataset) -> dict[str, float]:
    """The numbers that a result has."""
    numbers = {}
    for name in NUMBERS:
        if name in found.attrs:
            numbers[name] = float(found.attrs[name])
        elif name in found:
            values = found[name].values
            if np.isfinite(values).any():
                numbers[name] = float(np.nanmax(values))
    return numbers


def headings(report: TrainReport) -> tuple[tuple[str, ...], tuple[str, ...]]:
    names = [NUMBERS[name] for name in report.rows[0].numbers]
    return ("settings", "time", *(words for words, _ in names)), ("", "s", *(unit for _, unit in names))


def table_rows(report: TrainReport) -> list[tuple[str, ...]]:
    """The numbers as they stand; of the others their change."""
    first, *others = report.rows
    rows = [(first.name, f"{first.seconds:.2f}", *(f"{value:.5g}" for value in first.numbers.values()))]
    for row in others:
        changes = report.changes(row)
        cells = (f"{100.0 * changes[name] + 0.0:+.3f} %" if name in changes else "none" for name in first.numbers)
        rows.append((row.name, f"{row.seconds:.2f}", *cells))
    return rows


def write_csv(report: TrainReport, file: Path) -> None:
    """A line for each row, with its numbers."""
    lines = [{"settings": row.name, "seconds": row.seconds, **row.numbers} for row in report.rows]
    write_lines(file, lines, report.machine)


@styled
def picture(report: TrainReport) -> Figure:
    """Changes of each number in per cent, a panel each, and the seconds of each run."""
    _, *others = report.rows
    names = list(report.rows[0].numbers)
    height = 2.2 + 0.42 * len(report.rows)
    figure = Figure(figsize=(3.2 * (1 + len(names)), height), layout="constrained")
    figure.get_layout_engine().set(rect=(0, 0.5 / height, 1, 1 - 0.5 / height))
    seconds, *panels = figure.subplots(1, 1 + len(names), sharey=True)
    places = np.arange(len(report.rows))
    seconds.barh(places, [row.seconds for row in report.rows], color=DARK, height=0.6)
    seconds.set_title("Time\n(s)")
    seconds.set_yticks(places, [row.name for row in report.rows])
    seconds.set_ylim(places[-1] + 0.6, -0.6)
    for panel, name in zip(panels, names):
        values = [0.0, *(100.0 * report.changes(row).get(name, 0.0) for row in others)]
        if not any(values):
            panel.set_xlim(-1.0, 1.0)
        panel.barh(places, values, color=PALETTE[0], height=0.6)
        panel.axvline(0.0, color=DARK, linewidth=0.8)
        panel.set_title(f"{NUMBERS[name][0][0].upper()}{NUMBERS[name][0][1:]}\n(change, %)")
    for panel in (seconds, *panels):
        panel.grid(axis="y", visible=False)
        panel.tick_params(axis="y", length=0)
        panel.locator_params(axis="x", nbins=4)
    figure.suptitle(f"{report.title}: one setting finer, in all meshes")
    figure.text(0.5, 0.06 / height, f"Measured on {in_words(report.machine)}", ha="center", fontsize=9)
    return figure
