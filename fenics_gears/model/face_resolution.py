"""How finely the face of a pair is resolved: the scene's own `[accuracy]` values, and for the rest defaults."""

from __future__ import annotations

from collections.abc import Callable
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.contact.face import Face, even_slices
from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.geometry.pair import GearPair
from fenics_gears.geometry.rough_stiffness import mean_youngs_modulus
from fenics_gears.scene.data import Scene

if TYPE_CHECKING:
    from fenics_gears.model.model import Model

# Width of a slice, in normal modules. The peak-to-peak transmission error of a helical pair is then some 2 % off, and an error falls as the square of it; the
# mean is within 0.2 %.
SLICE_WIDTH = 0.35
FEWEST_SLICES = 5


def face_of(scene: Scene, pair: GearPair) -> Face:
    """The slices of the common face, all of one width."""
    slices = scene.accuracy.slices or max(ceil(pair.face_width / (SLICE_WIDTH * scene.gears.module)), FEWEST_SLICES)
    positions, widths = even_slices(pair.face_width, slices)
    return Face(positions, widths, pair.slope, pair.gear_middles)


# Length of the window of contact nodes where no edge is near, in half-widths of the contact; and mesh stiffness per face width, as a part of Young's modulus:
# the largest line load is the mean one and this stiffness times the largest difference of openings along the face.
INNER_HALF_WIDTHS, MESH_STIFFNESS = 4.5, 0.1


def inner_length(scene: Scene, pair: GearPair, line_load: float, half_width_of: Callable[[float], float]) -> float:
    """Length (mm) of that window, for the largest line load that is expected; `half_width_of`: half-width (mm) of the contact under a line load (N/mm)."""
    # Imported here: plane scenes have none.
    from fenics_gears.geometry.face import face_opening

    opening = face_opening(pair, scene.lead_modifications, scene.misalignment, np.linspace(*pair.common_face, 21))
    return INNER_HALF_WIDTHS * half_width_of(line_load + MESH_STIFFNESS * mean_youngs_modulus(scene.tooth_elasticity) * float(np.ptp(opening)))


# Elements of the body's section and its layers, in normal modules.
SECTION_SIZE, LAYER_THICKNESS = 0.3, 0.7
FEWEST_LAYERS = 4
# A layer is of second order and tells two slices apart. With 16 slices in a layer, line loads that vary over it err by up to half; the mean over the face does not.
SLICES_OF_A_LAYER, MOST_SLICES_OF_A_LAYER = 2, 4


def face_discretisation(model: Model, gear: int) -> FaceDiscretisation:
    """How the body of the pinion (0) or the wheel (1) is divided over its face."""
    asked, pair, module = model.scene.accuracy, model.pair, model.scene.gears.module
    width = pair.face_widths[gear]
    slices = model.face.slices * width / pair.face_width
    layers = asked.layers or max(ceil(width / (LAYER_THICKNESS * module)), ceil(slices / SLICES_OF_A_LAYER - 1e-9), FEWEST_LAYERS)
    body = (pair.pinion, pair.wheel)[gear]
    twist = (1.0, -1.0)[gear] * pair.slope / body.base_radius
    return FaceDiscretisation(asked.body_element_size or SECTION_SIZE * module, layers, width, twist)


def face_warnings(model: Model) -> list[str]:
    """A sentence where the layers of a body do not tell the slices of the face apart."""
    found = []
    for gear, name in enumerate(("pinion", "wheel")):
        division = face_discretisation(model, gear)
        slices = model.face.slices * division.face_width / model.pair.face_width
        if slices > MOST_SLICES_OF_A_LAYER * division.layers:
            found.append(
                f"accuracy.layers = {division.layers}: the {name}'s body has {slices / division.layers:.3g} slices of the face to a layer, which it cannot tell apart; a line load that "
                f"varies over a layer is then wrong. Take accuracy.layers = {ceil(slices / SLICES_OF_A_LAYER - 1e-9)}, or fewer accuracy.slices"
            )
    return found
