"""FVA's set to scale; the load shares of its planets, the sun held and floating; the orbit of the floating sun."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fenics_gears.scene.train import TrainScene
from fenics_gears.show.panels import DARK, PALETTE, styled
from fenics_gears.show.planetary import set_drawing

HELD = (3, False, 20)
FLOATING = (3, True, 20)


@styled
def picture(scenes: dict, results: dict) -> Figure:
    """Scenes and results by the number of planets, whether the sun floats, and the error of the first pin (µm)."""
    figure = Figure(figsize=(13.0, 6.4), layout="constrained")
    parts = figure.subplot_mosaic(
        [["set", "held", "orbit"], ["set", "floating", "orbit"]], width_ratios=(1.5, 1.2, 1.0)
    )
    figure.suptitle("FVA's planetary set, the pin of planet 1 20 µm beside its place", x=0.012, ha="left", fontsize=14)
    _draw(parts["set"], scenes[FLOATING])
    for name, case, words in (("held", HELD, "sun held"), ("floating", FLOATING, "sun floating")):
        _shares(parts[name], results[case], words)
    _orbit(parts["orbit"], results)
    return figure


def _draw(axes: Axes, scene: TrainScene) -> None:
    for curve in set_drawing(scene).curves:
        if curve.fill:
            axes.fill(curve.x, curve.y, facecolor=curve.fill, edgecolor=DARK, linewidth=0.7)
        for x, y, words in zip(curve.x, curve.y, curve.words):
            axes.text(x, y, words, ha="center", va="center")
    axes.set_aspect("equal")
    axes.set_axis_off()


def _shares(axes: Axes, result, words: str) -> None:
    steps = int(result["steps_per_mesh_cycle"][0])
    phase = result["mesh_phase"].values[-1 - steps :, 0]
    for number, share in enumerate(result["planet_load_share"].values[-1 - steps :].T):
        axes.plot(phase, share, color=PALETTE[number], label=f"planet {number + 1}")
    axes.set_title(f"{words}: K_gamma {result.attrs['load_sharing_factor']:.3f}", loc="left", fontsize=11)
    axes.set_ylabel("Load share")
    axes.set_ylim(0.8, 1.3)
    axes.set_xlabel("Mesh cycles")
    axes.legend(loc="upper right", ncols=3, fontsize=8)


def _orbit(axes: Axes, results: dict) -> None:
    steps = int(results[FLOATING]["steps_per_mesh_cycle"][0])
    for colour, error in zip(PALETTE, (0, 20, 40)):
        own = results[3, True, error]
        x, y = (1e3 * own[f"member_{axis}"].values[-1 - steps :, 0] for axis in "xy")
        axes.plot(x, y, color=colour, label=f"{error} µm")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_title("Orbits of the floating sun", loc="left", fontsize=11)
    axes.set_xlabel("x (µm)")
    axes.set_ylabel("y (µm)")
    axes.legend(loc="upper left", title="pin error", fontsize=8)
