"""Rules of internal gears: what a scene with one needs, and what is not computed with one yet.

They read the parsed TOML file, as those of ``rules`` do.
"""

from collections.abc import Iterator

from fenics_gears.geometry.gear_data import FOUNDATION
from fenics_gears.inputs.problem import Broken, Path
from fenics_gears.inputs.section import allowed_in
from fenics_gears.inputs.tree import (
    GEARS,
    INTERNAL,
    OF_INTERNAL,
    Tree,
    dotted,
    is_internal,
    table,
    value_at,
    with_gears,
)

from .accuracy_rules import EVERY_STEP
from .gear_parts import SupportText
from .gear_schema import GearText

OF_EXTERNAL = {
    "bore_diameter": "has no meaning for an internal gear, whose body ends at outer_diameter. Leave it out.",
    "web": "has no meaning for an internal gear. Leave it out.",
    "base_tangent_length": "is not computed for an internal gear. Allowed: profile_shift or tooth_thickness.",
    "dimension_over_balls": "is not computed for an internal gear. Allowed: profile_shift or tooth_thickness.",
    "spanned_teeth": "is not computed for an internal gear. Leave it out.",
    "tip_chamfer": "is not computed for an internal gear. Leave it out.",
}
OF_A_RACK = ("protuberance", "protuberance_angle", "finishing_stock")
# What a pair may have and a pair with an internal gear may not have yet. A gear's shaft is in its bore.
NOT_COMPUTED = (
    ("body_meshes", "wheel"),
    ("corner_contact",),
    ("flank_errors", "wheel", "measured_profile"),
    ("flank_errors", "wheel", "waviness"),
    ("shafts", "output", "sections"),
)


def gears_have_their_bodies(tree: Tree) -> Broken:
    """The outer circle of an internal gear, and what else belongs to either kind."""
    for gear in GEARS:
        own = table(table(tree, "gears") or {}, gear)
        if own is None:
            continue
        internal = is_internal(tree, gear)
        if internal and "outer_diameter" not in own:
            allowed = allowed_in(GearText, "outer_diameter").description
            yield ("gears", gear, "outer_diameter"), f"is missing. Allowed: {allowed}."
        if gear == "pinion" and internal:
            message = "is an internal gear (ISO 21771). Allowed: an external pinion that drives an internal wheel."
            yield ("gears", gear, "teeth"), f"{message} Call the internal gear the wheel."
        for name in () if internal else OF_INTERNAL:
            if name in own:
                message = "has no meaning for an external gear. Leave it out, or make teeth negative."
                yield ("gears", gear, name), message
        if internal:
            yield from _of_an_internal_gear(tree, gear)


def _of_an_internal_gear(tree: Tree, gear: str) -> Broken:
    own = value_at(tree, "gears", gear)
    for name, message in OF_EXTERNAL.items():
        if name in own:
            yield ("gears", gear, name), message
    for name in OF_A_RACK:
        for place in (("gears", "rack", name), ("gears", gear, "rack", name)):
            if value_at(tree, *place) is not None:
                message = "is of a rack, and an internal gear has a cutter. Give it in [gears.pinion.rack]."
                yield place, message
    support = table(own, "support") or {}
    for name in ("radial_stiffness", "tangential_stiffness"):
        place = ("gears", gear, "support", name)
        if support.get("kind") == FOUNDATION and name not in support:
            yield place, f"is missing. Allowed: {allowed_in(SupportText, name).description}."
        elif support.get("kind") != FOUNDATION and name in support:
            yield place, f'has no meaning without kind = "{FOUNDATION}". Leave it out, or give the kind.'
    for path in _not_computed(tree):
        message = "is not computed with an internal gear yet. Leave it out."
        yield path, message


def _not_computed(tree: Tree) -> Iterator[Path]:
    yield from (path for path in NOT_COMPUTED if value_at(tree, *path) is not None)
    if value_at(tree, "accuracy", "condensation") == EVERY_STEP:
        yield ("accuracy", "condensation")


def internal_gears_have_negative_teeth(tree: Tree) -> Broken:
    """Names that other programs have for it."""
    for path, section in with_gears(tree, "gears").items():
        for name in (each for each in INTERNAL if each in section):
            message = "is not known. An internal gear is the wheel with a negative number of teeth: "
            yield (*path, name), f"{message}{dotted(('gears', 'wheel', 'teeth'))} = -61, or with internal = true."
