"""How finely the face of a pair is resolved: the scene's own `[accuracy]` values, and for the rest defaults."""

from __future__ import annotations

from math import ceil

from fenics_gears.contact.face import Face, even_slices
from fenics_gears.geometry.pair import GearPair
from fenics_gears.scene.data import Scene

# Width of a slice, in normal modules.
SLICE_WIDTH = 0.25
FEWEST_SLICES = 5


def face_of(scene: Scene, pair: GearPair) -> Face:
    """The slices of the common face, all of one width."""
    slices = scene.accuracy.slices or max(ceil(pair.face_width / (SLICE_WIDTH * scene.gears.module)), FEWEST_SLICES)
    positions, widths = even_slices(pair.face_width, slices)
    return Face(positions, widths, pair.slope, pair.gear_middles)
