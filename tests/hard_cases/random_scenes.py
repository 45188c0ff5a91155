"""Scenes of any valid gears, loads, springs, speeds and effects, coarse enough to be run by the hundred (issue 4, property-based runs)."""

from math import degrees, log10, pi

from hypothesis import assume
from hypothesis import strategies as st
from tests.random_pairs import valid_pairs

from fenics_gears.errors import GeometryError
from fenics_gears.model import model
from fenics_gears.scene.data import Scene
from fenics_gears.scene.read import scene_from_text

CONTACT_RATIOS = (1.05, 2.3)
# Of steel teeth: stress-like load at which they are used (N/mm of face width and mm of module), stiffness of a pair (N/mm^2), density.
USUAL_LOAD, PAIR_STIFFNESS, DENSITY = 30.0, 14e3, 7.8e-9


def decades(lowest: float, highest: float) -> st.SearchStrategy[float]:
    """Positive numbers, every decade as likely as the next."""
    return st.floats(log10(lowest), log10(highest)).map(lambda exponent: 10.0**exponent)


@st.composite
def valid_scenes(draw, torques=decades(1e-4, 1e2)) -> Scene:
    """A scene whose text any file could have; torque over six decades, springs over nine, 0.01 Hz to 20 kHz, any set of effects.

    `torques`: in parts of the usual one.
    """
    pair = draw(valid_pairs(teeth=(12, 120), modules=(1.0, 10.0), addenda=(0.6, 1.45)))
    assume(CONTACT_RATIOS[0] <= pair.contact_ratio <= CONTACT_RATIOS[1])
    module, width = pair.pinion.module, pair.pinion.module * draw(st.floats(1.0, 20.0))
    coast = draw(st.booleans())
    radius = pair.wheel.base_radius
    torque = draw(torques) * USUAL_LOAD * module * width * radius
    if coast:
        torque *= draw(st.sampled_from((1, -1)))
    sections = [_gears(pair, width), f'[load]\nwheel_torque = "{torque!r} N mm"', _motion(draw)]
    sections += _effects(draw, pair, width) + (["[coast_flanks]"] if coast else []) + [_accuracy(draw, module, coast)]
    text = "\n\n".join(sections) + "\n"
    scene = scene_from_text(text)
    try:
        model(scene)
    except GeometryError:  # a contact ratio at its limit, lost in the text's degrees; relief of more than the flank
        assume(False)
    return scene


def _gears(pair, width: float) -> str:
    def gear(name):
        each = getattr(pair, name)
        return (
            f"[gears.{name}]\nteeth = {each.teeth}\nprofile_shift = {each.profile_shift!r}\ntip_diameter = \"{2 * each.tip_radius!r} mm\"\n"
            f'root_diameter = "{2 * each.root_radius!r} mm"\nbore_diameter = "{each.root_radius!r} mm"\n'
            f"rack_tip_radius = {each.rack_tip_radius / each.module!r}"
        )

    return (
        f'[gears]\nmodule = "{pair.pinion.module!r} mm"\npressure_angle = "{degrees(pair.pinion.pressure_angle)!r} deg"\n'
        f'centre_distance = "{pair.centre_distance!r} mm"\nface_width = "{width!r} mm"\n\n{gear("pinion")}\n\n{gear("wheel")}\n\n'
        '[gears.material]\nyoungs_modulus = "206 GPa"\npoissons_ratio = 0.3'
    )


def _motion(draw) -> str:
    cycles = draw(st.integers(1, 2))
    return f'[motion]\nmesh_frequency = "{draw(decades(1e-2, 2e4))!r} Hz"\nmesh_cycles = {cycles}\nrecorded_cycles = {cycles}'


def _effects(draw, pair, width: float) -> list[str]:
    """Any set of the effects; springs from 1e-4 to 1e5 of the teeth's own stiffness, masses within ten times those of steel discs."""
    radius = pair.wheel.base_radius
    teeth = PAIR_STIFFNESS * width
    disc = DENSITY * pi * radius**2 * width
    shafts, bearings = draw(st.booleans()), draw(st.booleans())
    found = []
    if shafts:
        found.append(f'[shafts]\ntorsional_stiffness = "{draw(decades(1e-4, 1e5)) * teeth * radius**2!r} N mm/rad"')
    if bearings:
        found.append(f'[bearings]\nstiffness = "{draw(decades(1e-4, 1e5)) * teeth!r} N/mm"')
    if draw(st.booleans()):
        mass = disc * draw(decades(0.1, 10.0))
        inertia = 0.5 * disc * radius**2 * draw(decades(0.1, 10.0))
        found.append(f'[inertia]\nmass = "{mass!r} t"\nmoment_of_inertia = "{inertia!r} t mm^2"')
        if draw(st.booleans()):
            of_stiffness = draw(decades(1e-7, 1e-2)) if shafts or bearings else 0.0
            found.append(f'[damping]\nstiffness_proportional = "{of_stiffness!r} s"\nmass_proportional = "{draw(decades(1e-3, 1e4))!r} 1/s"')
    if draw(st.booleans()):
        found.append(f"[friction]\ncoefficient = {draw(st.one_of(decades(1e-6, 0.1), st.floats(0.01, 1.0)))!r}")
    if draw(st.booleans()):
        depth = pair.pinion.module * draw(decades(1e-4, 3e-2))
        found.append(f'[tip_relief]\ndepth = "{depth!r} mm"\nstart = "HPSTC"')
    return found


def _accuracy(draw, module: float, coast: bool) -> str:
    return (
        f'[accuracy]\nelement = "{draw(st.sampled_from(("P1", "P2")))}"\nflank_element_size = "{draw(st.floats(0.08, 0.2)) * module!r} mm"\n'
        f'contact_length = "{draw(st.floats(0.2, 1.0)) * module!r} mm"\ncontact_nodes = {draw(st.integers(2, 9))}\n'
        f"steps_per_mesh_cycle = {draw(st.integers(20, 40))}"
    )
