"""How finely the face of a pair is resolved: the scene's own `[accuracy]` values, and for the rest defaults."""

from __future__ import annotations

from math import ceil
from typing import TYPE_CHECKING

from fenics_gears.contact.face import Face, even_slices
from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.geometry.pair import GearPair
from fenics_gears.scene.data import Scene

if TYPE_CHECKING:
    from fenics_gears.model.model import Model

# Width of a slice, in normal modules.
SLICE_WIDTH = 0.25
FEWEST_SLICES = 5


def face_of(scene: Scene, pair: GearPair) -> Face:
    """The slices of the common face, all of one width."""
    slices = scene.accuracy.slices or max(ceil(pair.face_width / (SLICE_WIDTH * scene.gears.module)), FEWEST_SLICES)
    positions, widths = even_slices(pair.face_width, slices)
    return Face(positions, widths, pair.slope, pair.gear_middles)


# Elements of the body's section and its layers, in normal modules.
SECTION_SIZE, LAYER_THICKNESS = 0.3, 0.8
FEWEST_LAYERS = 4


def face_discretisation(model: Model, gear: int) -> FaceDiscretisation:
    """How the body of the pinion (0) or the wheel (1) is divided over its face."""
    asked, pair, module = model.scene.accuracy, model.pair, model.scene.gears.module
    width = pair.face_widths[gear]
    layers = asked.layers or max(ceil(width / (LAYER_THICKNESS * module)), FEWEST_LAYERS)
    body = (pair.pinion, pair.wheel)[gear]
    twist = (1.0, -1.0)[gear] * pair.slope / body.base_radius
    return FaceDiscretisation(asked.body_element_size or SECTION_SIZE * module, layers, width, twist)
