"""The sections on the power through a train: its shafts, how paths share the load; members and planets of its sets."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import xarray as xr

from fenics_gears.pages import Block, PageSection, Table, Words
from fenics_gears.shown import (
    OF_SHARES,
    SHARE,
    TrainScene,
    digits,
    factor,
    orbits,
    planet_shares,
    points_of_ring,
    set_runs,
)

from .power_flow import power_flow


def powers(dataset: xr.Dataset, train: TrainScene) -> list[PageSection]:
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
