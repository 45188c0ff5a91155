"""NREL's 5 MW gearbox, its suns floating and held, the first pin of both sets in and beside its place."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from fenics_gears import simulate_train, train_from_text
from fenics_gears.results.sets_in_train import set_run
from fenics_gears.scene.train_scene import TrainScene
from fenics_gears.show.panels import DARK, PALETTE, styled
from fenics_gears.show.train import drawing_of

SCENE = Path(__file__).parent / "nrel_5mw.toml"
# um
ERRORS = (0, 50)
COLUMNS = ("suns", "pin errors (µm)", "K_gamma, first set", "K_gamma, second set", "T_EPP (µrad of the generator)")
FLOATING = "floating"
HELD = "held"
Case = tuple[str, int]


def scene_text(suns: str, error: int, accuracy: str = "") -> str:
    """The scene with floating or held suns; `error`, um: of the first pin of both sets."""
    text = SCENE.read_text(encoding="utf-8")
    text = text.replace('N/mm" }', f'N/mm", pin_errors = ["{error} um", "0 um", "0 um"] }}') if error else text
    return (text if suns == FLOATING else text.replace('floating = ["sun"]\n', "")) + accuracy


def row(case: Case, result) -> tuple[str, ...]:
    """A row of the table."""
    factors = [f"{float(each):.3f}" for each in result["load_sharing_factor"]]
    return case[0], f"{case[1]}", *factors, f"{1e6 * result.attrs['peak_to_peak_overall_transmission_error']:.0f}"


def wind_turbine(accuracy: str = "") -> tuple[list[tuple[str, ...]], Figure]:
    """The rows of the table and the picture."""
    cases = list(product((FLOATING, HELD), ERRORS))
    scenes = {case: train_from_text(scene_text(*case, accuracy), "nrel_5mw") for case in cases}
    results = {case: simulate_train(scene) for case, scene in scenes.items()}
    return [row(case, result) for case, result in results.items()], picture(scenes[FLOATING, 0], results)


@styled
def picture(scene: TrainScene, results: dict) -> Figure:
    """The gearbox to scale; how its planets share the load on held suns, a pin beside its place; how far the generator
    lags."""
    figure = Figure(figsize=(12.0, 7.6), layout="constrained")
    parts = figure.subplot_mosaic([["train"] * 3, ["first", "second", "whole"]], height_ratios=(1.5, 1.0))
    figure.suptitle(scene.title, x=0.012, ha="left", fontsize=14)
    for curve in drawing_of(scene).curves:
        if curve.fill:
            parts["train"].fill(curve.x, curve.y, facecolor=curve.fill, edgecolor=DARK, linewidth=0.6)
        elif not curve.words:
            parts["train"].plot(curve.x, curve.y, color=DARK, linewidth=0.6, linestyle=curve.dash.replace("dash", "--"))
    parts["train"].set_aspect("equal")
    parts["train"].set_axis_off()
    for name in ("first", "second"):
        own = set_run(results[HELD, ERRORS[-1]], name)
        phase = np.linspace(0.0, 1.0, own.sizes["time"])
        for number, share in enumerate(own["planet_load_share"].values.T):
            parts[name].plot(phase, share, color=PALETTE[number], label=f"planet {number + 1}")
        factor = own.attrs["load_sharing_factor"]
        words = f"{name}: sun held, pin {ERRORS[-1]} µm off, K_gamma {factor:.3f}"
        parts[name].set_title(words, loc="left", fontsize=10)
        parts[name].set_xlabel("Mesh cycles")
        parts[name].set_ylabel("Load share")
        parts[name].legend(fontsize=8)
    found = results[FLOATING, 0]
    lag = 1e6 * found["overall_transmission_error"].values
    parts["whole"].plot(found["time"], lag - lag.mean(), color=DARK, linewidth=0.8)
    parts["whole"].set_title("The lag of the generator, suns floating", loc="left", fontsize=10)
    parts["whole"].set_xlabel("Time (s)")
    parts["whole"].set_ylabel("Lag, less its mean (µrad)")
    return figure
