"""What to change of a scene that memory does not hold: settings with which it fits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import ceil

from fenics_gears.errors import SceneError
from fenics_gears.scene.accuracy import FEWEST_LAYERS, FEWEST_SLICES, SECTION_SIZE
from fenics_gears.scene.data import Accuracy

from .cost import ExpectedCost, expected_cost
from .face_resolution import layers_of_common_face
from .model import Model, model_of

# By how much elements and layers are made coarser from try to try, and how often.
COARSER = 1.2
TRIES = 12


def too_large(model: Model, cost: ExpectedCost, allowed: float) -> str:
    """Why a run that may take `allowed` bytes does not fit, and what to change; empty where it does."""
    if cost.held <= allowed:
        return ""

    def held(accuracy: Accuracy) -> float:
        return expected_cost(model_of(replace(model.scene, accuracy=accuracy))).held

    target = ' In place of settings, target = "5 %" has the run look for some that fit and keep the error;'
    return refused(cost, allowed, settings_that_fit(model, held, allowed), target)


def refused(cost: ExpectedCost, allowed: float, fits: str, target: str = "") -> str:
    """Why a run does not fit, and what to change: settings that fit, in words, if there are any, or a `target`."""
    less = f"{fits} in [accuracy] fit" if fits else "Larger elements, fewer mesh cycles or time steps take less"
    return (
        f"The run would take {cost.held / 1e9:.3g} GB of memory, contact operators apart, and {allowed / 1e9:.3g} GB"
        f" are allowed. Nothing was computed. {less}.{target} `--memory` or FENICS_GEARS_MEMORY allow more."
    )


def settings_that_fit(model: Model, held: Callable[[Accuracy], float], allowed: float) -> str:
    """The least coarse ones that are tried, in words; empty where none fits. `held`: bytes of a run with settings."""
    for times in range(1, TRIES + 1):
        accuracy, words = _coarser(model, COARSER**times)
        try:
            if held(accuracy) <= allowed:
                return words
        except SceneError:
            continue
    return ""


def _coarser(model: Model, factor: float) -> tuple[Accuracy, str]:
    """Settings with larger elements: of the flanks, or over a face of the bodies, with fewer layers and slices."""
    asked = model.scene.accuracy
    if not model.scene.three_dimensional:
        size = _rounded(factor * model.resolution.flank_element_size)
        return replace(asked, flank_element_size=size), f'flank_element_size = "{size:g} mm"'
    now = layers_of_common_face(model.scene, model.pair)
    size = _rounded(factor * (asked.body_element_size or SECTION_SIZE * model.scene.gears.module))
    layers = max(ceil(now / factor), FEWEST_LAYERS)
    slices = max(ceil(model.face.evenly / factor), FEWEST_SLICES)
    words = f'body_element_size = "{size:g} mm", layers = {layers}, slices = {slices}'
    return replace(asked, body_element_size=size, layers=layers, slices=slices), words


def _rounded(size: float) -> float:
    """To two digits."""
    return float(f"{size:.2g}")
