"""Shafts of a train that bend: their deflection lines, with what is on them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from fenics_gears.scene.train import TrainScene
from fenics_gears.scene.train_shafts import BentShaft

from .chart import MARKERS, Chart, Curve
from .panels import PALETTE, digits

MICRO = 1e3
DIRECTIONS = {"x": "to the right", "y": "upwards"}
NOTE = (
    "Mean of the recorded steps, in space: directions as those of the stages are counted. The right end is that from"
    " which the first gear is seen to turn counter-clockwise."
)


def deflections(scene: TrainScene, dataset: xr.Dataset) -> list[Chart]:
    """Deflection of each shaft that bends along its axis, with its gears and bearings."""
    # Of one scale, also where only the lowest chart has its numbers.
    longest = float(np.nanmax(dataset["shaft_place"].values))
    along = (-0.02 * longest, 1.02 * longest)
    return [_of_shaft(scene, bent, dataset.sel(shaft=bent.name), along) for bent in scene.shafts.bent]


def _of_shaft(scene: TrainScene, bent: BentShaft, own: xr.Dataset, along: tuple[float, float]) -> Chart:
    curves = []
    places = own["shaft_place"].values
    faces = list(_faces(scene, bent))
    bearings = np.sort([each.at for each in bent.own.bearings or ()])
    for number, (axis, words) in enumerate(DIRECTIONS.items()):
        colour = PALETTE[number]
        line = MICRO * own[f"shaft_deflection_{axis}"].values
        curves.append(Curve(words, places, line, colour))
        for gear, face in faces:
            curves.append(
                Curve(f"{gear}, {words}", face, np.interp(face, places, line), colour, width=5.0, listed=False)
            )
        at_bearings = np.interp(bearings, places, line)
        name = f"bearings, {words}"
        curves.append(Curve(name, bearings, at_bearings, colour, mode=MARKERS, width=8.0, listed=False))
    gears = ", ".join(f"{gear} at {digits(face.mean())} mm" for gear, face in faces)
    return Chart(
        f"Shaft {bent.name}: {gears} (thick); bearings are dots", curves, "Place from the left end of the shaft (mm)",
        "Deflection (µm)", NOTE if not bent.number else "", height=280, x_range=along,
    )  # fmt: skip


def _faces(scene: TrainScene, bent: BentShaft) -> Iterator[tuple[str, np.ndarray]]:
    """Both ends of the face of each gear, mm from the left end."""
    for gear, at in zip(bent.own.carries, bent.own.gears_at or ()):
        mesh = next(each for each in scene.meshes if gear in each.gears)
        width = mesh.pair.face_widths[mesh.gears.index(gear)]
        yield gear, at + 0.5 * width * np.array([-1.0, 1.0])
