"""The report on the run of a train: the train drawn, its power flow, motion and orders of the whole, and each mesh."""

from __future__ import annotations

from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import xarray as xr

from fenics_gears import MICRORADIANS, carried_train, mesh_run, overall_orders
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
    version_section,
)
from fenics_gears.shown import (
    OF_SHARES,
    SHARE,
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
    orbits,
    pair_forces,
    planet_shares,
    points_of_ring,
    set_runs,
    train_errors,
    train_model_of,
    train_orders,
)

from .face import FACTORS
from .overview import warnings
from .power_flow import power_flow

LISTED_ORDERS = 20
# Of the largest amplitude; what is below is round-off.
LEAST_LISTED = 1e-6


def train_page(dataset: xr.Dataset, file: Path, progress: Progress | None = None) -> Page:
    """The page of a train's run, read from `file`. Raises SceneError where the train in it is none of this version."""
    progress = progress or SilentProgress()
    progress.stage("sections")
    train = carried_train(dataset)
    sections = [
        _summary(dataset, train), warnings(ShownRun(dataset)), _geometry(train), *_powers(dataset, train),
        PageSection("motion", "Transmission error", train_errors(train, dataset)), _orders(dataset, train),
        *_shafts(dataset, train), *_frequencies(train),
    ]  # fmt: skip
    # Meshes of a planetary set that are like others are left out.
    sections += [_mesh(dataset, train, number) for number, mesh in enumerate(train.meshes) if mesh.like is None]
    sections += [
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
    return f"{torque} N m on the first shaft{speed}, {len(train.meshes)} meshes, {_motion(train)}"


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
    tiles.append(Tile("Ratio", digits(train.ratio), "", "turns of the first shaft in one of the last"))
    for words, torque in (("first", train.input_torque), ("last", train.output_torque)):
        value = digits(torque * factor("N mm", "N m"))
        tiles.append(Tile(f"Torque on the {words} shaft", value, "N m", "without losses" if words == "first" else ""))
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


def _powers(dataset: xr.Dataset, train: TrainScene) -> list[PageSection]:
    """The power flow of each part of a train."""
    if not train.joined:
        return [_power(dataset, train)]
    sets = iter(set_runs(dataset))
    found = []
    for number, (first, part) in enumerate(train.numbered, 1):
        of_meshes = dataset.isel(mesh=slice(first, first + len(part.meshes)))
        own = _power(of_meshes if part.shafts.carrier is None else next(sets), part)
        found.append(replace(own, name=f"power-{number}", heading=f"Power flow: {part.title}"))
    return found


def _power(dataset: xr.Dataset, train: TrainScene) -> PageSection:
    if train.shafts.carrier is not None:
        return _members(dataset, train)
    flow = power_flow(dataset, train)
    rows = [
        (
            f"shaft {number}",
            "counter-clockwise" if sense > 0 else "clockwise",
            digits(each.torque * factor("N mm", "N m")),
            *((digits(60.0 * each.speed), digits(1e-6 * each.power)) if flow.speed_given else ()),
        )
        for number, (each, sense) in enumerate(zip(flow.shafts, train.graph.senses), 1)
    ]
    of_speed = ("Speed (rpm)", "Power (kW)") if flow.speed_given else ()
    loads = [digits(load * factor("N mm", "N m")) if load else "" for load in train.loads]
    several = len(loads) - loads.count("") > 1
    if several:
        rows = [(*row[:3], load, *row[3:]) for row, load in zip(rows, loads)]
    of_speed = ("Its load (N m)", *of_speed) if several else of_speed
    headings = ("Shaft", "Turns", "Torque (N m)", *of_speed)
    blocks: list[Block] = [Table(headings, rows, "Shafts, the first one driven", numbers=2), *_shares(dataset)]
    if train.shafts.ramp is not None:
        blocks.append(Words("Speeds and powers are those at the start of the speed ramp, without what accelerates it."))
    if not flow.speed_given:
        blocks.append(Words("The scene has no speed (`motion.input_speed`), and so no power."))
    lost = [(each.name, f"{100.0 * each.efficiency:.4g}") for each in flow.meshes]
    if lost:
        blocks.append(Table(("Mesh", "Efficiency (%)"), lost, "Friction in the meshes"))
        blocks.append(
            Words("The last shaft has the torque of the load. Before each mesh the torque is higher by what it loses.")
        )
    return PageSection("power", "Power flow", blocks)


def _members(dataset: xr.Dataset, train: TrainScene) -> PageSection:
    """Members of a planetary set, and how the planets share the load."""
    of_speed = ("Speed (rpm)", "Power (kW)") if train.speed_given else ()
    headings = ("Member", "Part", "Torque (N m)", "Turns in one of the input", *of_speed)
    blocks: list[Block] = [
        Table(headings, _member_rows(train, dataset), "Members, mean torques through them", numbers=2)
    ]
    of_sets = [*planet_shares(train, dataset), *orbits(train, dataset), *points_of_ring(train, dataset)]
    return PageSection("power", "Power flow", [*blocks, *of_sets])


def _member_rows(train: TrainScene, dataset: xr.Dataset) -> list[tuple[str, ...]]:
    """Rows of the members: name, part, speed over the input's, rpm and kW where there is a speed, mean torque."""
    carrier = train.shafts.carrier
    assert carrier is not None
    own = carrier.set
    rows: list[tuple[str, ...]] = []
    for place, member in enumerate(dataset["member"].values.tolist()):
        torque = float(dataset["member_torque"][:-1, place].mean())
        part = {own.fixed: "fixed", own.input: "input", own.output: "output"}[member]
        speed = float(own.speeds[member])
        row: tuple[str, ...] = (member, part, f"{1e-3 * torque:.6g}", f"{speed:.6g}")
        if carrier.speed is not None:
            row += (f"{60.0 * carrier.speed * speed / (2.0 * pi):.6g}", f"{1e-6 * torque * carrier.speed * speed:.5g}")
        rows.append(row)
    return rows


def _shares(dataset: xr.Dataset) -> list[Block]:
    """How paths share the torque, where there are several."""
    if SHARE not in dataset:
        return []
    names = [str(each) for each in dataset["mesh"].values]
    numbers = [100.0 * dataset[each].values for each in OF_SHARES]
    rows = [(name, *map(digits, own)) for name, own in zip(names, zip(*numbers))]
    words = "Shares of the torque that all meshes on the same shaft carry"
    return [Table(("Mesh", "Mean (%)", "Largest (%)", "Least (%)"), rows, words)]


def _orders(dataset: xr.Dataset, train: TrainScene) -> PageSection:
    charts = train_orders(train, dataset)
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
    headings = ("Mesh", "Harmonic", "Order of the first shaft", "Amplitude (µrad)", *of_speed)
    return PageSection("orders", "Orders of the overall transmission error", [*charts, Table(headings, rows)])


def _mesh(dataset: xr.Dataset, train: TrainScene, number: int) -> PageSection:
    """What a mesh has as a pair: shares of its tooth pairs, pressure, line load over the face."""
    run = ShownRun(mesh_run(dataset, train, number))
    charts = list(pair_forces(run))[:1]
    charts += largest_pressures(run) if has_pressure(run) else []
    said: list[Block] = []
    if run.over_face:
        charts += line_loads(run)
        attributes = run.dataset.attrs
        said = [Words(words.format(attributes[name])) for name, words in FACTORS.items() if name in attributes]
    rows = result_rows(run.dataset)
    name = train.meshes[number].name
    return PageSection(f"mesh-{number + 1}", f"Mesh: {name}", [*charts, *said, Facts(rows, f"Of mesh {name}")])
