"""The report on the run of a train: the train drawn, its power flow, motion and orders of the whole, and each mesh."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from fenics_gears import MICRORADIANS, SceneError, overall_orders
from fenics_gears.many_runs import Progress, SilentProgress, result_rows, train_rows
from fenics_gears.pages import (
    Block,
    Facts,
    Page,
    PageSection,
    Table,
    Tile,
    Tiles,
    Words,
    made_by,
    scene_section,
    sentence,
    version_section,
)
from fenics_gears.shown import (
    MeshOfScene,
    Rows,
    ShownRun,
    TrainScene,
    bent_shafts_of,
    digits,
    drawing_of,
    factor,
    frequencies_of_train,
    has_pressure,
    largest_pressures,
    line_loads,
    motion_rows,
    pair_forces,
    shown_mesh,
    train_errors,
    train_model_of,
    train_orders,
)

from .effects import effects_of_train
from .face import FACTORS
from .overview import as_sentence, warnings
from .power_flow import power_flow
from .stress import stresses
from .train_power import powers

LISTED_ORDERS = 20
# Of the largest amplitude; what is below is round-off.
LEAST_LISTED = 1e-6


def mesh_runs(dataset: xr.Dataset, train: TrainScene, file: Path, **asked: Any) -> dict[int, ShownRun]:
    """The meshes of a train's run that have sections, by their numbers: of a planetary set those that are like others
    are left out. A stage of two gears has a folder of its own. `asked`: of their stress pictures."""
    return {
        number: shown_mesh(dataset, train, number, file=file.parent / mesh.name / file.name, **asked)
        for number, mesh in enumerate(train.meshes)
        if mesh.like is None
    }


def train_page(
    dataset: xr.Dataset, train: TrainScene, runs: Mapping[int, ShownRun], file: Path, progress: Progress | None = None
) -> Page:
    """The page of a train's run, read from `file`, with its `mesh_runs`."""
    progress = progress or SilentProgress()
    progress.stage("sections")
    sections = [
        _summary(dataset, train), warnings(ShownRun(dataset)), _geometry(train), *powers(dataset, train),
        PageSection("motion", "Transmission error", train_errors(train, dataset)), _orders(dataset, train),
        *_shafts(dataset, train), *_frequencies(train),
    ]  # fmt: skip
    sections += [_mesh(run, number, train.meshes[number].name) for number, run in runs.items()]
    progress.stage("stresses")
    sections += [
        *stresses(runs), effects_of_train(dataset, train, runs, file),
        PageSection("numbers", "Numbers", [Facts(train_rows(dataset), "Of the whole and of each mesh")]),
        version_section(dataset.attrs, file), scene_section(str(dataset.attrs.get("scene", ""))),
    ]  # fmt: skip
    title = " ".join(train.title.split()) or file.stem
    return Page("Gear train: report on a run", title, _conditions(train), sections, made_by())


def _conditions(train: TrainScene) -> str:
    speed = f", {digits(60.0 * train.input_speed)} rpm" if train.speed_given else ""
    if train.shafts.ramp is not None:
        speed = f"{speed.removesuffix(' rpm')} to {digits(30.0 / pi * train.shafts.ramp.end_speed)} rpm"
    torque = digits(train.input_torque * factor("N mm", "N m"))
    return f"{torque} N m on the {_ends(train)[0]}{speed}, {len(train.meshes)} meshes, {_motion(train)}"


def _ends(train: TrainScene) -> tuple[str, str]:
    """What is driven, and what drives the load."""
    return ("input", "output") if any(part.shafts.carrier for part in train.parts) else ("first shaft", "last shaft")


def _motion(train: TrainScene) -> str:
    carrier = train.shafts.carrier
    inert = train.meshes[0].scene.inertia is not None or carrier is not None and carrier.in_time
    return f"with inertia, numbers of the last {train.recorded_cycles} cycles" if inert else "quasi-static"


def _shafts(dataset: xr.Dataset, train: TrainScene) -> list[PageSection]:
    """Shafts that bend, and the loads of their bearings."""
    charts = bent_shafts_of(train, dataset)
    if not charts:
        return []
    headings = ("Bearing", "Place (mm)", "To the right (N)", "Upwards (N)", "Axial (N)", "Largest (N)")
    table = Table(headings, _bearing_rows(dataset), "Mean forces of the shafts on their bearings", numbers=1)
    return [PageSection("shafts", "Shafts that bend", [*charts, table])]


def _bearing_rows(dataset: xr.Dataset) -> list[tuple[str, ...]]:
    """Of each bearing its name, its place (mm), the mean of its force in each direction, and the largest, N."""
    forces = np.stack([dataset[f"bearing_force_{axis}"].values for axis in "xyz"])
    largest = np.linalg.norm(forces, axis=0).max(axis=0)
    means = forces.mean(axis=1).T
    # What a bearing does not carry along its axis is round-off.
    means[np.abs(means) < LEAST_LISTED * largest.max()] = 0.0
    names, places = (dataset[name].values for name in ("bearing", "bearing_place"))
    return [
        (str(name), digits(place), *(digits(each) for each in mean), digits(most))
        for name, place, mean, most in zip(names, places, means, largest)
    ]


def _frequencies(train: TrainScene) -> list[PageSection]:
    """Natural frequencies of a train with inertia."""
    if train.meshes[0].scene.inertia is None:
        return []
    (row,) = train_model_of(train).rows
    facts = [
        Facts(_said(motion_rows(row)), "Masses and shafts"),
        Facts(_said(frequencies_of_train(row)), "About, with one tooth pair in each mesh"),
    ]
    return [PageSection("frequencies", "Natural frequencies", facts)]


def _said(rows: Rows) -> list[tuple[str, str, str]]:
    return [(label, value if isinstance(value, str) else digits(value), unit) for label, value, unit in rows]


def _summary(dataset: xr.Dataset, train: TrainScene) -> PageSection:
    said = dataset.attrs
    tiles = [
        Tile(
            f"Overall transmission error, {words}",
            digits(MICRORADIANS * said[f"{name}_overall_transmission_error"]),
            "µrad",
        )
        for name, words in (("peak_to_peak", "peak to peak"), ("mean", "mean"))
    ]
    first, last = _ends(train)
    tiles.append(Tile("Ratio", digits(train.ratio), "", f"turns of the {first} in one of the {last}"))
    for words, torque, note in ((first, train.input_torque, "without losses"), (last, train.output_torque, "")):
        tiles.append(Tile(f"Torque on the {words}", digits(torque * factor("N mm", "N m")), "N m", note))
    if "friction_loss" in said:
        efficiency = said["efficiency"] if "efficiency" in said else power_flow(dataset, train).efficiency
        tiles.append(Tile("Efficiency", f"{100.0 * efficiency:.4g}", "%", "of all meshes, by their friction"))
    return PageSection("summary", "Summary", [Tiles(tiles)])


def _geometry(train: TrainScene) -> PageSection:
    headings = (
        "Mesh", "Teeth", "Module (mm)", "Helix angle (°)", "Centre distance (mm)", "Direction (°)", "Contact ratio",
    )  # fmt: skip
    rows = [_of_mesh(each) for each in train.meshes if each.like is None]
    note = Words("Direction: of the wheel's centre from the pinion's. Contact ratio: with overlap.")
    return PageSection("geometry", "Gears", [drawing_of(train), Table(headings, rows), note])


def _of_mesh(mesh: MeshOfScene) -> tuple[str, ...]:
    pair = mesh.pair
    gears = mesh.scene.gears
    return (
        mesh.name, f"{pair.pinion.teeth} / {pair.wheel.tooth_count}", f"{gears.module:g}",
        f"{gears.helix_angle * factor('rad', 'deg'):g}", f"{abs(pair.centre_distance):.6g}",
        f"{180.0 / pi * mesh.direction:.4g}", f"{pair.total_contact_ratio:.4g}",
    )  # fmt: skip


def _orders(dataset: xr.Dataset, train: TrainScene) -> PageSection:
    try:
        charts = train_orders(train, dataset)
    except SceneError as error:
        return sentence("orders", "Orders of the overall transmission error", as_sentence(str(error)), True)
    if train.shafts.ramp is not None:
        return PageSection("orders", "Orders of the overall transmission error over the speed", charts)
    found = sorted(overall_orders(dataset, train, turns=True), key=lambda each: -each.amplitude)[:LISTED_ORDERS]
    least = LEAST_LISTED * max((each.amplitude for each in found), default=0.0)
    rows = [
        (
            each.meshes, f"{each.harmonic}", f"{each.order:.5g}", digits(MICRORADIANS * each.amplitude),
            *((digits(each.frequency),) if train.speed_given else ()),
        )
        for each in found
        if each.amplitude > least
    ]  # fmt: skip
    of_speed = ("Frequency (Hz)",) if train.speed_given else ()
    headings = ("Mesh", "Harmonic", f"Order of the {_ends(train)[0]}", "Amplitude (µrad)", *of_speed)
    return PageSection("orders", "Orders of the overall transmission error", [*charts, Table(headings, rows)])


def _mesh(run: ShownRun, number: int, name: str) -> PageSection:
    """What a mesh has as a pair: shares of its tooth pairs, pressure, line load over the face."""
    charts = list(pair_forces(run))[:1]
    charts += largest_pressures(run) if has_pressure(run) else []
    said: list[Block] = []
    if run.over_face:
        charts += line_loads(run)
        attributes = run.dataset.attrs
        said = [Words(words.format(attributes[name])) for name, words in FACTORS.items() if name in attributes]
    rows = result_rows(run.dataset)
    return PageSection(f"mesh-{number + 1}", f"Mesh: {name}", [*charts, *said, Facts(rows, f"Of mesh {name}")])
