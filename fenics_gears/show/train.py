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

from . import TRAIN_PICTURE_FILES
from .chart import LEAST_SHARE, Chart, Curve
from .drawing import picture
from .panels import PALETTE
from .plots import heading, save_figures

POINTS_OF_A_CIRCLE = 181
MICRO = 1e6


def draw_train(scene: TrainScene, dataset: xr.Dataset, directory: Path) -> list[Path]:
    """Draw the pictures of a train's run, as PNG, and return the files."""
    subjects = {
        TRAIN_PICTURE_FILES[0]: ("Gear train", [drawing_of(scene)]),
        TRAIN_PICTURE_FILES[1]: ("Transmission error", _errors(scene, dataset)),
    }
    figures = {name: picture(heading(subject, scene.title), charts) for name, (subject, charts) in subjects.items()}
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
            curves += _circles(middle, gear, pair, f"{stage}: {name}, {gear.teeth} teeth", _colour(number))
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
    """Of the whole over time, and of each mesh over its own mesh cycles."""
    frequency = scene.meshes[0].scene.motion.mesh_frequency
    overall = MICRO * np.asarray(dataset["overall_transmission_error"])
    # Of the last cycles where stages vibrate.
    span = dataset.attrs["peak_to_peak_overall_transmission_error"]
    charts = [
        Chart(
            f"Overall transmission error: peak to peak {MICRO * span:#.4g} µrad",
            [Curve("overall transmission error", frequency * np.asarray(dataset["time"]), overall)],
            "Time (cycles of the first mesh)",
            "Lag of the last shaft (µrad)",
            least=LEAST_SHARE * float(np.abs(overall).max(initial=0.0)),
            height=320,
        )
    ]
    for number, mesh in enumerate(scene.meshes):
        own = dataset.isel(mesh=number)
        values = 1e3 * mesh.pair.wheel.base_radius * np.asarray(own["transmission_error"])
        known = np.isfinite(values)
        span = 1e3 * mesh.pair.wheel.base_radius * float(own["peak_to_peak_transmission_error"])
        charts.append(
            Chart(
                f"{mesh.name}: peak to peak {span:#.4g} µm on the wheel's base circle",
                [Curve(mesh.name, np.asarray(own["mesh_phase"])[known], values[known], _colour(number))],
                f"Time (cycles of mesh {mesh.name})",
                "Transmission error (µm)",
                least=LEAST_SHARE * float(np.abs(values[known]).max(initial=0.0)),
                height=240,
            )
        )
    return charts


def _colour(number: int) -> str:
    return PALETTE[number % len(PALETTE)]
