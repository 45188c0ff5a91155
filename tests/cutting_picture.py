"""Draws docs/pictures/cutting.png: ``python -m tests.cutting_picture``."""

from math import pi, radians
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from tests.geometry.test_cutting_simulation import rack_profile

from fenics_gears import Gear
from fenics_gears.geometry.outline import tooth_outline

FILE = Path(__file__).parent.parent / "docs/pictures/cutting.png"
GREY, DARK, RED = "0.75", "#1f2937", "#c2410c"


def standard(teeth, **others):
    return Gear(teeth, 4.0, radians(20.0), 0.0, 2.0 * teeth + 4.0, 2.0 * teeth - 5.0, 10.0, 0.38 * 4.0, **others)


def tooth_points(gear):
    outline = tooth_outline(gear, 401)
    half = np.vstack(
        [
            outline.fillet,
            outline.involute(np.linspace(gear.form_roll_angle, gear.tip_roll_angle, 401))[1:],
            outline.tip_corner,
        ]
    )
    return np.vstack([half, outline.coast(half)[::-1]])


def upright(gear, points):
    turn = 0.5 * pi - tooth_outline(gear).centreline_angle
    sine, cosine = np.sin(turn), np.cos(turn)
    return points @ np.array([[cosine, sine], [-sine, cosine]])


def rack_in_body(gear, rotation):
    """The rack's tooth in the space beside the drive flank (n, 2), mm, in the tooth's frame when the gear has rolled
    by an angle."""
    profile = rack_profile(gear)
    x, depth = np.concatenate([-profile[::-1, 0], profile[:, 0]]), np.concatenate([profile[::-1, 1], profile[:, 1]])
    r = gear.reference_radius
    points = np.column_stack([x + r * rotation, depth - r])
    pose = rotation - pi / gear.teeth + gear.tooth_half_angle_at_base
    sine, cosine = np.sin(-pose), np.cos(-pose)
    return points @ np.array([[cosine, sine], [-sine, cosine]])


def draw(axes, gear, title, middle, half, step):
    """One tooth, dark, and the rack's positions, grey."""
    for rotation in np.arange(-1.4, 1.4, step):
        for mirrored in (False, True):
            rack = rack_in_body(gear, rotation)
            axes.plot(*upright(gear, tooth_outline(gear).coast(rack) if mirrored else rack).T, color=GREY, lw=0.4)
    axes.plot(*upright(gear, tooth_points(gear)).T, color=DARK, lw=1.6, label="computed outline")
    cut_away = tooth_outline(gear).involute(np.linspace(0.0, gear.form_roll_angle, 101))
    axes.plot(*upright(gear, cut_away).T, color=RED, lw=1.2, ls="--", label="involute that is cut away")
    arc = np.linspace(0.3 * pi, 0.7 * pi, 401)
    axes.plot(
        gear.form_radius * np.cos(arc), gear.form_radius * np.sin(arc), color=RED, lw=0.8, ls=":", label="form circle"
    )
    axes.set(
        aspect="equal",
        title=title,
        xlim=(middle[0] - half, middle[0] + half),
        ylim=(middle[1] - half, middle[1] + half),
        xlabel="mm",
    )


def main():
    figure, axes = plt.subplots(1, 3, figsize=(13.0, 4.8), layout="constrained")
    undercut, ground = standard(12), standard(25, tip_chamfer=0.5, protuberance=0.12, protuberance_angle=radians(10.0))
    draw(axes[0], undercut, "12 teeth, undercut", (0.0, undercut.reference_radius - 0.7), 6.2, 0.02)
    edge = upright(undercut, tooth_outline(undercut).fillet[-1:])[0]
    draw(axes[1], undercut, "the edge of fillet and involute", edge, 0.9, 0.005)
    draw(axes[2], ground, "25 teeth, protuberance, tip chamfer", (0.0, ground.reference_radius - 0.7), 6.2, 0.01)
    axes[0].legend(loc="lower center", fontsize=8, framealpha=1.0)
    figure.savefig(FILE, dpi=90)


if __name__ == "__main__":
    main()
