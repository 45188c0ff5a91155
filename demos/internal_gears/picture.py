"""The pair to scale, and its transmission error for several supports of the ring."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon

from demos.internal_gears.planet_in_ring import words_of
from fenics_gears.geometry.in_mesh import upright
from fenics_gears import gear_pair
from fenics_gears.geometry.pair import GearPair
from fenics_gears.show.panels import DARK, PALETTE, styled
from fenics_gears.show.pair_drawing import FILLS, gear_outline


@styled
def picture(scene, results: dict) -> Figure:
    """`results`: by stiffness of the springs, None where the ring is held."""
    figure = Figure(figsize=(12.0, 5.6), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.25))
    figure.suptitle("A planet in its ring, 22 and 61 teeth, 500 N m on the planet", x=0.012, ha="left", fontsize=14)
    _draw(left, gear_pair(scene.gears))
    for colour, (stiffness, result) in zip(PALETTE, results.items()):
        length = 1e3 * result.attrs["base_radius_wheel"] * result.transmission_error
        unit = "" if stiffness is None else " N/mm³"
        right.plot(
            result.mesh_phase,
            length,
            color=colour,
            label=f"{'' if stiffness is None else 'on springs of '}{words_of(stiffness)}{unit}",
        )
    right.set_xlabel("Mesh cycles")
    right.set_ylabel("Transmission error (µm along the line of action)")
    right.set_ylim(bottom=0.0)
    right.legend(loc="lower right", title="outer circle of the ring")
    return figure


def _draw(axes: Axes, pair: GearPair) -> None:
    phase = (pair.pitch_point - pair.path_start) / pair.base_pitch
    planet, ring = (gear_outline(pair, gear, phase) for gear in (0, 1))
    centre = np.array([0.0, -pair.centre_distance])
    line = {"edgecolor": DARK, "linewidth": 1.0}
    axes.add_patch(Circle(centre, -pair.wheel.bore_radius, facecolor=FILLS[1], **line))
    axes.add_patch(Polygon(ring, facecolor="white", **line))
    axes.add_patch(Polygon(planet, facecolor=FILLS[0], **line))
    axes.add_patch(Circle((0.0, 0.0), pair.pinion.bore_radius, facecolor="white", **line))
    ends = np.array([[xi, -pair.pinion.base_radius] for xi in (pair.path_start, pair.path_end)])
    axes.plot(*upright(pair, ends).T, color=PALETTE[1], linewidth=2.5)
    axes.text(0.0, 0.0, "planet", ha="center", va="center")
    axes.text(*centre + [0.0, -0.6 * pair.wheel.tip_radius], "ring", ha="center", va="center")
    look = {"arrowstyle": "-", "color": DARK}
    axes.annotate("path of\ncontact", upright(pair, ends)[1], (62.0, 92.0), textcoords="offset points", arrowprops=look)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_axis_off()
