"""``[wheel_points]``: a wheel that bolts, pins or splines hold at points (``elasticity.whole_body.ring_on_points``)."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import pi

from fenics_gears.dynamics.crack_openings import openings_of
from fenics_gears.inputs.fields import quantities, quantity, whole_number
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.section import Section
from fenics_gears.inputs.tree import Tree, quantity_in, table, value_at

from .body_meshes import only_teeth_that_differ
from .effect import Effect, ResultVariable

SECTION = "wheel_points"
WHEEL = 1
MOST = 200
# Points closer than this, rad, are one.
APART = 1e-6
FORCES = {
    "wheel_support_radial": "radial force of the point on the wheel, positive outwards",
    "wheel_support_tangential": "tangential force of the point on the wheel, positive as the pinion turns",
}
STIFFNESS = "1 N/mm to 1e12 N/mm"


@dataclass(frozen=True, kw_only=True)
class WheelPoints(Section):
    """``[wheel_points]``: bolts, pins or splines that alone hold the wheel, at its bore or, of an internal wheel, at
    its outer circle. Each takes the mean motion of this circle over a pitch; their other ends are rigid."""

    alternatives = (("count", "angles"),)

    count: int | None = whole_number(
        2, MOST, 12, meaning="number of points, evenly around, the first one at angle 0", otherwise="`angles`"
    )
    angles: tuple[float, ...] | None = quantities(
        "-360 deg to 360 deg",
        "0 deg",
        "95 deg",
        meaning="angles of two points or more, counter-clockwise from the centreline of the tooth that meets the"
        " pinion first; an internal gear's centreline is that of its space",
        otherwise="from `count`",
        shortest=2,
        longest=MOST,
    )
    radial_stiffness: float = quantity(STIFFNESS, "2e5 N/mm", meaning="radial stiffness of each point")
    tangential_stiffness: float = quantity(STIFFNESS, "2e5 N/mm", meaning="tangential stiffness of each point")

    @property
    def places(self) -> tuple[float, ...]:
        """Angles of all points, rad."""
        if self.angles is not None:
            return self.angles
        return tuple(2.0 * pi / self.count * number for number in range(self.count))


def points_hold_a_wheel(tree: Tree) -> Broken:
    """Points instead of another support, and two of them nowhere in one place."""
    section = table(tree, SECTION)
    if section is None:
        return
    yield from only_teeth_that_differ(tree, SECTION)
    if not {"count", "angles"} & set(section):
        yield (SECTION, "count"), f"is missing. Allowed: a whole number from 2 to {MOST}, such as 12; or angles."
    if value_at(tree, "gears", "wheel", "support") is not None:
        message = f"cannot be combined with [{SECTION}], which says what holds the wheel. Leave one of the two out."
        yield ("gears", "wheel", "support"), message
    written = section.get("angles")
    angles = [quantity_in(each) for each in written] if isinstance(written, list) else []
    if all(each is not None for each in angles) and _closest(angles) < APART:
        yield (SECTION, "angles"), "has a point twice. Allowed: angles that differ, also after whole turns."


def _closest(angles: Sequence[float]) -> float:
    """The least distance, rad, between two of these around a circle; that of one to itself is a turn."""
    turned = sorted(each % (2.0 * pi) for each in angles)
    return min(
        (after - before for before, after in pairwise([*turned, *(each + 2.0 * pi for each in turned[:1])])), default=pi
    )


def elasticity(points: WheelPoints, model, name: str, reach, cache):
    """Flank compliance of the wheel; None for the pinion."""
    if name != "wheel":
        return None
    from fenics_gears.elasticity.whole_body.ring_on_points import ring_on_points

    width = model.pair.effective_face_widths[WHEEL]
    springs = points.radial_stiffness / width, points.tangential_stiffness / width
    division = model.resolution.discretisation(WHEEL)
    material = model.scene.gears.material_of(name)
    offsets = min(reach.same + 1, model.pair.wheel.tooth_count - 1)
    given = points.places, springs
    return ring_on_points(model.pair.wheel, material, division, given, offsets, cache).by_teeth(offsets)


def watched(points: WheelPoints, cycle, steps) -> dict:
    """Forces (steps, support) of all points on the wheel, N."""
    import numpy as np

    side = cycle.pair.sides[WHEEL]
    loads = np.array([openings_of(cycle, side, record) for record in steps.records])
    forces = cycle.pair.effective_face_widths[WHEEL] * loads.reshape(len(loads), -1, 2)
    return {name: forces[:, :, number] for number, name in enumerate(FORCES)}


def period(points: WheelPoints, scene) -> int:
    """Mesh cycles of a turn of the wheel."""
    return abs(scene.gears.wheel.teeth)


EFFECT = Effect(
    section=SECTION,
    description="a wheel that bolts, pins or splines hold at points of its bore or outer circle",
    absent="the wheel is held all around, or on a foundation",
    fields=WheelPoints,
    terms=("a flank compliance for each tooth of the wheel", "contact equations that change with the teeth in mesh"),
    needs=("tooth_elasticity",),
    excludes=("body_meshes", "coast_flanks", "lead_modifications", "misalignment"),
    variables=tuple(ResultVariable(name, "N", words, dims=("time", "support")) for name, words in FORCES.items()),
    rules=points_hold_a_wheel,
    elasticity=elasticity,
    watched=watched,
    period=period,
)
