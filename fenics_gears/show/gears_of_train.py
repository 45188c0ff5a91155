"""The gears of a train as outlines where they stand as its run begins, and how each turns."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.outline import centreline_angle, rotation
from fenics_gears.geometry.planetary import CARRIER
from fenics_gears.scene.train import TrainScene
from fenics_gears.scene.train_layout import centres

from .pair_drawing import tooth_points


@dataclass(frozen=True)
class DrawnGear:
    """A gear seen along its axis, mm: the `outline` (n, 2) of its teeth, closed, the radius of its other circle
    (`around`: its bore, or the rim of an internal gear), its centre and its largest radius. `turn`: the angle (rad,
    counter-clockwise) by which it turns in a cycle of the first mesh."""

    outline: np.ndarray
    around: float
    centre: tuple[float, float]
    radius: float
    turn: float


def gears_of_train(scene: TrainScene) -> tuple[list[DrawnGear], float]:
    """All gears, those first that others are drawn over; and the angle (rad) by which the carrier of a planetary set
    turns in a cycle of the first mesh, 0 of other trains: a set's gears turn as its carrier sees them."""
    if scene.joined:
        raise SceneError(
            "stages: planetary sets beside other stages turn in frames of their own, and are not shown in motion yet."
            " Allowed: a set as the only stage, or gears plot, which draws all parts."
        )
    layout = scene.layout
    graph = layout.graph
    at = centres(layout)
    of_cycle = 2.0 * pi / scene.meshes[0].pair.pinion.teeth
    first = scene.turns[graph.between[0][0]]
    drawn = []
    for number, shaft in enumerate(graph.shafts):
        gear = layout.gear(number)
        centre = at[shaft]
        around = abs(gear.bore_radius)
        drawn.append(
            DrawnGear(
                outline_of(gear, layout.tooth_angle(number), centre),
                around,
                (centre.real, centre.imag),
                max(abs(gear.tip_radius), around),
                graph.senses[shaft] * scene.turns[shaft] / first * of_cycle,
            )
        )
    drawn.sort(key=lambda each: -each.radius)
    carrier = scene.shafts.carrier
    turn = 0.0 if carrier is None else float(carrier.set.speeds[CARRIER] / carrier.set.sun_by_carrier) * of_cycle
    return drawn, turn


def outline_of(gear: Gear, angle: float, centre: complex) -> np.ndarray:
    """Outline (n, 2), mm, of a gear of which a tooth's centreline stands at an angle (rad), closed."""
    tooth = tooth_points(gear)
    turned = angle - centreline_angle(gear) - gear.angular_pitch * np.arange(gear.tooth_count)
    around = np.vstack([tooth @ rotation(each).T for each in turned]) + [centre.real, centre.imag]
    return np.vstack([around, around[:1]])
