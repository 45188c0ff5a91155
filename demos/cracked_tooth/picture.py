"""A turn of the pinion with a tooth cracked to several depths: transmission error, stiffness, load share, orders, and
the mesh."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from demos.cracked_tooth.depths import ITS_CYCLE, Turn
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.outline import centreline_angle
from fenics_gears.show.panels import DARK, GREY, PALETTE, styled
from meshes.root_crack import RootCrack, crack_line

COLOURS = (DARK, PALETTE[4], PALETTE[0], PALETTE[1])
CRACK = PALETTE[1]
# Mesh cycles around the cracked tooth, and orders, that are shown.
AROUND, HIGHEST_ORDER = (ITS_CYCLE - 0.4, ITS_CYCLE + 1.9), 52.0
LEAST_AMPLITUDE = 5e-3  # um
ARROW = {"arrowstyle": "-", "linewidth": 0.8, "color": DARK, "shrinkB": 2.0}


@styled
def draw(turns: Sequence[Turn], gear: Gear, sector: BodyMesh, crack: RootCrack) -> Figure:
    """`turns`: the healthy one first; `sector`: the mesh (mm) of the cracked tooth's sector in its body frame, with
    `crack`."""
    figure = Figure(figsize=(13.0, 12.0), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12, h_pad=0.12)
    axes = figure.subplot_mosaic(
        [["error", "error", "sector"], ["stiffness", "share", "sector"], ["orders", "orders", "tip"]],
        height_ratios=[1.0, 1.0, 1.0], width_ratios=[1.0, 1.0, 0.85],
    )  # fmt: skip
    load = turns[0].load
    figure.suptitle(
        f"One cracked tooth of {gear.teeth}: the paper's pair under {load / 1e3:.3g} kN, quasi-static, without "
        f"friction",
        x=0.012, ha="left", fontsize=15,
    )  # fmt: skip
    _error(axes["error"], turns)
    _stiffness(axes["stiffness"], turns)
    _share(axes["share"], turns)
    _orders(axes["orders"], turns, gear.teeth)
    _mesh(axes["sector"], gear, sector, crack)
    axes["sector"].set_title(f"The tooth's mesh, crack of {crack.depth:g} mm")
    _mesh(axes["tip"], gear, sector, crack, around_crack=True)
    axes["tip"].set_title("Its root, enlarged")
    return figure


def name(turn: Turn) -> str:
    """A curve's name in legends."""
    return f"crack of {turn.depth:g} mm" if turn.depth else "no crack"


def _error(axes: Axes, turns: Sequence[Turn]) -> None:
    for turn, colour in zip(turns, COLOURS):
        axes.plot(turn.phase, turn.error, color=colour, label=name(turn), linewidth=1.4, zorder=3.0 - 0.1 * turn.depth)
    axes.set_title("A turn of the pinion")
    axes.set_xlim(turns[0].phase[0], turns[0].phase[-1])
    axes.set_xlabel("Mesh cycle")
    axes.set_ylabel("Transmission error on the\nwheel's base circle (µm)")
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.18 * (high - low))  # room for the legend
    axes.legend(loc="upper left", ncols=len(turns))


def _stiffness(axes: Axes, turns: Sequence[Turn]) -> None:
    for turn, colour in zip(turns, COLOURS):
        axes.plot(turn.phase, turn.stiffness, color=colour)
    axes.set_title("Stiffness of the mesh")
    axes.set_xlim(*AROUND)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("Mesh cycle")
    axes.set_ylabel("Load over deflection (N/µm)")


def _share(axes: Axes, turns: Sequence[Turn]) -> None:
    for turn, colour in zip(turns, COLOURS):
        for cycle, style in ((ITS_CYCLE - 1, ":"), (ITS_CYCLE, "-"), (ITS_CYCLE + 1, ":")):
            axes.plot(
                turn.phase,
                100.0 * turn.force_of(cycle) / turn.load,
                style,
                color=colour,
                linewidth=2.0 if style == "-" else 1.4,
            )
    axes.set_title("Load share (neighbours dotted)")
    axes.set_xlim(*AROUND)
    axes.set_ylim(0.0, 106.0)
    axes.set_xlabel("Mesh cycle")
    axes.set_ylabel("Share of the load (%)")


def _orders(axes: Axes, turns: Sequence[Turn], teeth: int) -> None:
    width = 0.22
    for place, (turn, colour) in enumerate(zip(turns, COLOURS)):
        lines = turn.orders(teeth)
        seen = (lines.orders <= HIGHEST_ORDER) & (lines.amplitudes > LEAST_AMPLITUDE)
        at = lines.orders[seen] + width * (place - 0.5 * (len(turns) - 1))
        axes.vlines(at, LEAST_AMPLITUDE, lines.amplitudes[seen], color=colour, linewidth=2.0)
    axes.set_yscale("log")
    axes.set_ylim(LEAST_AMPLITUDE, 40.0)
    axes.set_xlim(0.0, HIGHEST_ORDER)
    axes.set_xticks([1, *range(8, int(HIGHEST_ORDER), 8)])
    axes.set_title("Orders of the transmission error: the mesh's, and the crack's between them")
    axes.set_xlabel("Order (events a turn of the pinion)")
    axes.set_ylabel("Amplitude (µm)")
    top = axes.get_ylim()[1]
    for multiple in range(1, int(HIGHEST_ORDER / teeth) + 1):
        axes.annotate(
            "mesh" if multiple == 1 else f"{multiple} × mesh",
            (multiple * teeth, 0.8 * top),
            ha="center",
            va="top",
            color=DARK,
        )


def _mesh(axes: Axes, gear: Gear, sector: BodyMesh, crack: RootCrack, around_crack: bool = False) -> None:
    """The sector's mesh with its tooth upright, all of it or what is around the crack."""
    upright = 0.5 * np.pi - centreline_angle(gear)
    turn = np.array([[np.cos(upright), np.sin(upright)], [-np.sin(upright), np.cos(upright)]])
    points = sector.points @ turn
    mouth, direction = crack_line(gear, crack)
    line = np.array([mouth, mouth + crack.depth * direction]) @ turn
    axes.triplot(points[:, 0], points[:, 1], sector.cells, color=GREY, linewidth=0.5)
    axes.plot(*line.T, color=CRACK, linewidth=3.0 if not around_crack else 2.2, solid_capstyle="butt")
    axes.set_aspect("equal")
    axes.grid(False)
    axes.set_xlabel("mm")
    axes.set_ylabel("mm")
    if around_crack:
        centre, half = line.mean(axis=0), 0.85 * crack.depth
        axes.set_xlim(centre[0] - half, centre[0] + half)
        axes.set_ylim(centre[1] - half, centre[1] + half)
    else:
        axes.annotate("crack", line[1], (-42, -26), textcoords="offset points", color=DARK, arrowprops=ARROW)
        flank = points[np.unique(sector.edges["flank"])]
        upper = flank[np.argmin(np.abs(flank[:, 1] - 0.8 * gear.tip_radius - 0.2 * gear.root_radius))]
        axes.annotate(
            "drive\nflank", upper, (-34, 12), textcoords="offset points", ha="center", color=DARK, arrowprops=ARROW
        )
