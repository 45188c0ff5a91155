"""Gear pairs that the checks let pass."""

from math import atan, cos, radians, tan

from hypothesis import assume
from hypothesis import strategies as st

from fenics_gears import Gear, GearPair, GeometryError
from fenics_gears.geometry.gear_checks import check_gear
from fenics_gears.geometry.gear_data import Helix
from fenics_gears.geometry.pair_checks import check_pair


@st.composite
def valid_pairs(draw, teeth=(6, 90), modules=(0.5, 20.0), addenda=(0.6, 1.3), face_width=1.0, helix_angles=None):
    """Of any proportions within the bounds, in (normal) modules; its bore has the radius of a module.
    `helix_angles`: bounds, deg."""
    proportions = st.tuples(
        st.integers(*teeth), st.floats(-0.5, 1.0), st.floats(*addenda), st.floats(1.0, 1.5), st.floats(0.0, 0.45)
    )
    module, alpha = draw(st.floats(*modules)), radians(draw(st.floats(17.0, 27.0)))
    helix = (
        Helix(radians(draw(st.floats(*helix_angles))), draw(st.sampled_from(["right", "left"])))
        if helix_angles
        else None
    )
    beta = helix.angle if helix else 0.0
    stretch, transverse = 1.0 / cos(beta), atan(tan(alpha) / cos(beta)) if helix else alpha
    gears = []
    for _ in range(2):
        count, shift, addendum, dedendum, rounding = draw(proportions)
        pitch = 0.5 * count * stretch + shift
        tip, root = module * (pitch + addendum), module * (pitch - dedendum)
        gears.append(
            Gear(count, module * stretch, transverse, shift / stretch, tip, root, module, module * rounding, beta)
        )
    bases = gears[0].base_radius + gears[1].base_radius
    touching = GearPair(*gears, centre_distance=bases, face_width=face_width).centre_distance_without_backlash
    pair = GearPair(
        *gears, centre_distance=touching + module * draw(st.floats(0.0, 0.1)), face_width=face_width, helix=helix
    )
    try:
        check_gear(pair.pinion, "pinion")
        check_gear(pair.wheel, "wheel")
        check_pair(pair)
    except GeometryError:
        assume(False)
    return pair
