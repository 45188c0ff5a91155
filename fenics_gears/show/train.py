"""The pictures of a train's run: the train drawn to scale; transmission errors of the whole and of its meshes."""

from __future__ import annotations

from cmath import rect
from math import cos
from pathlib import Path

import numpy as np
import xarray as xr

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.pair import GearPair
from fenics_gears.scene.train import TrainScene

from .chart import LEAST_SHARE, Chart, Curve
from .drawing import picture
from .panels import DARK, PALETTE, WARNING
from .plots import heading, save_figures

TRAIN_PICTURE_FILES = ("train.png", "transmission_error.png")
POINTS_OF_A_CIRCLE = 181
MICRO = 1e6
MESH_CYCLES = "Time (cycles of the first mesh)"


def draw_train(scene: TrainScene, dataset: xr.Dataset, directory: Path) -> list[Path]:
    """Draw the pictures of a train's run, as PNG, and return the files."""
    complete = bool(dataset.attrs["complete"])
    more = [] if complete else [f"INCOMPLETE RUN: stopped after step {dataset.attrs['steps']}"]
    subjects = {
        TRAIN_PICTURE_FILES[0]: ("Gear train", [drawing_of(scene)]),
        TRAIN_PICTURE_FILES[1]: ("Transmission error", _errors(scene, dataset)),
    }
    figures = {
        name: picture(heading(subject, scene.title, *more), charts, DARK if complete else WARNING)
        for name, (subject, charts) in subjects.items()
    }
    return save_figures(figures, directory)


def drawing_of(scene: TrainScene) -> Chart:
    """All gears seen along their axes: tip circles, and dashed pitch circles. Gears on one shaft have one centre."""
    curves = []
    centre = 0j
    number = 0
    for mesh in scene.meshes:
        pair = mesh.pair
        stage, _, gears = mesh.name.partition(": gears ")
        names = [f"gear {each}" for each in gears.split(" and ")] if gears else ["pinion", "wheel"]
        places = [centre, centre + rect(pair.centre_distance, mesh.direction)]
        centre = places[1]
        both = list(zip(places, (pair.pinion, pair.wheel), names))
        # An idler is drawn in its first mesh.
        for middle, gear, name in both[mesh.idler is not None :]:
            colour = PALETTE[number % len(PALETTE)]
            curves += _circles(middle, gear, pair, f"{stage}: {name}, {gear.teeth} teeth", colour)
            number += 1
    speeds = "turns of the first shaft in one of the last"
    caption = f"Tip and pitch circles (dashed), to scale; {scene.ratio:.5g} {speeds}"
    return Chart(caption, curves, "x (mm)", "y (mm)", height=520, equal=True)


def _circles(centre: complex, gear: Gear, pair: GearPair, name: str, colour: str) -> list[Curve]:
    angles = np.linspace(0.0, 2.0 * np.pi, POINTS_OF_A_CIRCLE)

    def circle(radius: float, **options) -> Curve:
        return Curve(
            name, centre.real + radius * np.cos(angles), centre.imag + radius * np.sin(angles), colour, **options
        )

    return [
        circle(gear.tip_radius),
        circle(gear.base_radius / cos(pair.operating_pressure_angle), dash="dash", listed=False, width=1.0),
    ]


def _errors(scene: TrainScene, dataset: xr.Dataset) -> list[Chart]:
    first = np.asarray(dataset["mesh_phase"].isel(mesh=0))
    known = np.isfinite(first)
    cycles = np.interp(dataset["time"], np.asarray(dataset["time"])[known], first[known]) if known.any() else first
    overall = MICRO * np.asarray(dataset["overall_transmission_error"])
    span = dataset.attrs.get("peak_to_peak_overall_transmission_error", np.nan) * MICRO
    charts = [
        Chart(
            f"Overall transmission error: peak to peak {span:#.4g} µrad",
            [Curve("overall transmission error", cycles, overall)],
            MESH_CYCLES,
            "Lag of the last shaft (µrad)",
            least=LEAST_SHARE * float(np.nanmax(np.abs(overall), initial=0.0)),
            height=320,
        )
    ]
    for number, mesh in enumerate(scene.meshes):
        own = dataset.isel(mesh=number)
        radius = mesh.pair.wheel.base_radius
        values = 1e3 * radius * np.asarray(own["transmission_error"])
        name = f"{mesh.name}: peak to peak {np.nanmax(values) - np.nanmin(values):#.4g} µm on the wheel's base circle"
        charts.append(
            Chart(
                name,
                [Curve(mesh.name, cycles, values, PALETTE[number % len(PALETTE)])],
                MESH_CYCLES,
                "Transmission error (µm)",
                least=LEAST_SHARE * float(np.nanmax(np.abs(values), initial=0.0)),
                height=240,
            )
        )
    return charts
