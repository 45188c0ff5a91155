"""What is drawn over a picture of gears in mesh: the line of action, names, frames, a bar of length."""

from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc, FancyArrowPatch, Rectangle
from matplotlib.patheffects import withStroke

from fenics_gears.geometry.in_mesh import upright
from fenics_gears.inputs.tree import GEARS
from fenics_gears.simulation.run_stresses import GearsInMesh

from .panels import DARK

# Radii, points: of a bore that a gear's name fits into with its arrow, and of that arrow.
LEAST_BORE = 28.0
LEAST_ARROW = 12.0


def line_of_action(axes: Axes, mesh: GearsInMesh, coast: bool, labelled: bool) -> None:
    """The line between the base circles, its part that is the path of contact, and the pitch point."""
    pair = mesh.pair
    frame = partial(upright, mesh.pair, coast=coast)
    height = -pair.pinion.base_radius
    ends = frame(np.array([[0.0, height], [pair.line_of_action_length, height]]))
    path = frame(np.array([[pair.path_start, height], [pair.path_end, height]]))
    pitch = frame(np.array([pair.pitch_point, height]))
    for colour, wider in (("white", 1.6), (DARK, 0.0)):
        axes.plot(*ends.T, color=colour, linewidth=1.0 + wider, solid_capstyle="butt", linestyle="-")
        axes.plot(*path.T, color=colour, linewidth=2.4 + wider, solid_capstyle="butt")
    look = {"markerfacecolor": "white", "markeredgecolor": "black", "markeredgewidth": 1.4}
    axes.plot(*pitch, "o", markersize=8 if labelled else 5, **look)
    if labelled:
        side = -1 if coast else 1
        before = frame(np.array([pair.path_start - 0.12 * pair.base_pitch, height]))
        _note(axes, "pitch point", pitch, (side * 14, 16))
        _note(axes, "line of action", before, (side * 12, 30))


def _note(axes: Axes, words: str, point, offset) -> None:
    box = {"boxstyle": "round,pad=0.25", "facecolor": "white", "edgecolor": "#BBBBBB", "alpha": 0.92}
    place = {"xytext": offset, "textcoords": "offset points", "ha": "left" if offset[0] > 0 else "right"}
    axes.annotate(words, point, fontsize=11.5, color=DARK, bbox=box, **place)


def name_gears(axes: Axes, mesh: GearsInMesh, driving: int) -> None:
    """Names in the bores, or above or next to small ones; which gear drives, and the sense in which either turns."""
    bottom, top = axes.get_ylim()
    height = axes.get_position().height * axes.figure.get_figheight() * 72.0
    point = (top - bottom) / height
    for side, name in zip(mesh.pair.sides, GEARS):
        gear = side.gear
        turns = side.turning
        name += "\ndrives" if side.number == driving else ""
        centre = np.array([0.0, -side.number * mesh.pair.centre_distance])
        place, ha, va = place_of_name(gear, point)
        axes.text(*(centre + place), name, ha=ha, va=va, fontsize=11.5, color=DARK)
        radius = max(0.78 * gear.bore_radius, -0.7 * gear.tip_radius, LEAST_ARROW * point)
        # Of a ring on the far side of its pinion.
        start, end = (20.0, 160.0) if gear.internal else (200.0, 340.0)
        axes.add_patch(Arc(centre, 2 * radius, 2 * radius, theta1=start, theta2=end, color=DARK, linewidth=1.4))
        tip = np.radians(end if turns > 0 else start)
        head = centre + radius * np.array([np.cos(tip), np.sin(tip)])
        back = centre + radius * np.array([np.cos(tip - turns * 0.06), np.sin(tip - turns * 0.06)])
        look = {"arrowstyle": "-|>", "mutation_scale": 14, "shrinkA": 0, "shrinkB": 0}
        axes.add_patch(FancyArrowPatch(back, head, color=DARK, **look))


def place_of_name(gear, point: float) -> tuple[np.ndarray, str, str]:
    """Place of a gear's name from its centre (mm), with its alignment."""
    if gear.internal:
        return np.array([0.0, -0.5 * gear.tip_radius]), "center", "center"
    if gear.bore_radius >= LEAST_BORE * point:
        return np.zeros(2), "center", "center"
    if gear.root_radius - gear.bore_radius > 2.0 * LEAST_BORE * point:
        return np.array([0.0, gear.bore_radius + 6.0 * point]), "center", "bottom"
    return np.array([-gear.tip_radius - 4.0 * point, 0.0]), "right", "center"


def frame_in(axes: Axes, enlarged: Axes, moved: np.ndarray | None = None) -> None:
    """Where in one panel another one is."""
    left, right = enlarged.get_xlim()
    bottom, top = enlarged.get_ylim()
    x, y = (0.0, 0.0) if moved is None else moved
    corner = (left + x, bottom + y)
    width = right - left
    height = top - bottom
    for colour, line in (("black", 2.6), ("white", 1.2)):
        axes.add_patch(Rectangle(corner, width, height, fill=False, edgecolor=colour, linewidth=line))


def length_bar(axes: Axes) -> None:
    """A bar of a round length at the panel's lower edge."""
    left, right = axes.get_xlim()
    bottom, top = axes.get_ylim()
    wanted = 0.3 * (right - left)
    power = 10.0 ** np.floor(np.log10(wanted))
    length = max(step * power for step in (1.0, 2.0, 5.0) if step * power <= wanted)
    x = left + 0.06 * (right - left)
    y = bottom + 0.06 * (top - bottom)
    for colour, width in (("black", 5.0), ("white", 2.5)):
        axes.plot([x, x + length], [y, y], color=colour, linewidth=width, solid_capstyle="butt")
    bright = [withStroke(linewidth=3.0, foreground="white")]
    axes.text(x, y + 0.03 * (top - bottom), f"{length:g} mm", fontsize=11.0, color="black", path_effects=bright)
