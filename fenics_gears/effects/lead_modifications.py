"""``[lead_modifications]``: crowning, helix slope and end relief of either gear (``geometry.face``)."""

from fenics_gears.geometry.lead_modification import LEFT, RIGHT, LeadModifications
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.tree import GEARS, Tree, quantity_at, value_at

from .effect import Effect


def end_reliefs_have_room(tree: Tree) -> Broken:
    for gear in GEARS:
        yield from _end_relief_has_room(tree, gear)


def _end_relief_has_room(tree: Tree, gear: str) -> Broken:
    home = ("lead_modifications", gear, "end_relief")
    length = quantity_at(tree, *home, "length")
    sides = value_at(tree, *home, "sides")
    width = quantity_at(tree, "gears", gear, "face_width") or quantity_at(tree, "gears", "face_width")
    if length is None or width is None or not width > 0.0:
        return
    room = width if sides in (LEFT, RIGHT) else 0.5 * width
    if length > room:
        ends = f"the {sides} end" if sides in (LEFT, RIGHT) else "both ends"
        message = f"is too long for {ends} of a face of {width:g} mm. Allowed: up to {room:g} mm."
        yield (*home, "length"), message


EFFECT = Effect(
    section="lead_modifications",
    description="crowning, helix slope and end relief of the flanks",
    absent="flanks without lead modifications",
    fields=LeadModifications,
    terms=("gaps between the flanks that vary along the face",),
    needs=("tooth_elasticity",),
    excludes=("body_meshes",),
    rules=end_reliefs_have_room,
)
