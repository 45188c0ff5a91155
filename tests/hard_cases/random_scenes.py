"""Scenes of any valid gears, loads, springs, speeds and effects, coarse enough to be run by the hundred."""

from math import degrees

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st
from tests.hard_cases.random_effects import decades, random_effects
from tests.random_pairs import valid_pairs

from fenics_gears import GeometryError, Scene, model_of, scene_from_text

CONTACT_RATIOS = (1.05, 2.3)
# Of steel teeth: stress-like load at which they are used (N/mm of face width and mm of module).
USUAL_LOAD = 30.0
# In parts of that: what a changing speed may ask.
MOST_LOAD = 1e3


@st.composite
def valid_scenes(draw, torques=decades(1e-4, 1e2)) -> Scene:
    """Torque over six decades (`torques`: in parts of the usual one), springs over nine, 0.01 Hz to 20 kHz, any set
    of effects."""
    pair = draw(valid_pairs(teeth=(12, 120), modules=(1.0, 10.0), addenda=(0.6, 1.45)))
    assume(CONTACT_RATIOS[0] <= pair.contact_ratio <= CONTACT_RATIOS[1])
    module, width = pair.pinion.module, pair.pinion.module * draw(st.floats(1.0, 20.0))
    # Rigid flanks come last of all when hypothesis simplifies; one scene in four has them.
    coast, elastic = draw(st.booleans()), draw(st.integers(0, 3)) < 3
    radius = pair.wheel.base_radius
    torque = draw(torques) * USUAL_LOAD * module * width * radius
    if coast:
        torque *= draw(st.sampled_from((1, -1)))
    mesh_frequency, cycles = draw(decades(1e-2, 2e4)), draw(st.integers(1, 2))
    sections = [
        _gears(pair, width, elastic),
        f'[load]\nwheel_torque = "{torque!r} N mm"',
        _motion(mesh_frequency, cycles),
    ]
    sections += random_effects(draw, pair, width, torque, mesh_frequency, cycles, elastic, coast)
    sections += (["[coast_flanks]"] if coast else []) + [_accuracy(draw, module)]
    text = "\n\n".join(sections) + "\n"
    scene = scene_from_text(text)
    try:
        assume(_speed_changes_slowly(model_of(scene), MOST_LOAD * USUAL_LOAD * module * width))
    except (
        GeometryError
    ):  # a contact ratio at its limit, lost in the text's degrees; reliefs of more than the flank, or off it
        assume(False)
    return scene


def _speed_changes_slowly(model, most: float) -> bool:
    """Whether the inertia of a changing speed asks no more than `most` (N) of the teeth, and without coast flanks
    does not pull the wheel off them at the start."""
    if model.scene.speed_ramp is None:
        return True
    loads = np.array([sum((load(step) for load in model.loads), model.drivetrain.load) for step in (-1, 0, 1)])
    wheel = loads[:, model.drivetrain.coordinates.index("rotation_2")]
    return np.abs(loads).max() <= most and (model.scene.coast_flanks is not None or wheel.min() > 0.0)


def _gears(pair, width: float, elastic: bool) -> str:
    def gear(name):
        each = getattr(pair, name)
        return (
            f"[gears.{name}]\nteeth = {each.teeth}\nprofile_shift = {each.profile_shift!r}\ntip_diameter ="
            f' "{2 * each.tip_radius!r} mm"\nroot_diameter = "{2 * each.root_radius!r} mm"\nbore_diameter ='
            f' "{each.root_radius!r} mm"\nrack_tip_radius = {each.rack_tip_radius / each.module!r}'
        )

    material = '\n\n[gears.material]\nyoungs_modulus = "206 GPa"\npoissons_ratio = 0.3' if elastic else ""
    return (
        f'[gears]\nmodule = "{pair.pinion.module!r} mm"\npressure_angle = "{degrees(pair.pinion.pressure_angle)!r}'
        f' deg"\ncentre_distance = "{pair.centre_distance!r} mm"\nface_width = "{width!r}'
        f' mm"\n\n{gear("pinion")}\n\n{gear("wheel")}{material}'
    )


def _motion(mesh_frequency: float, cycles: int) -> str:
    return f'[motion]\nmesh_frequency = "{mesh_frequency!r} Hz"\nmesh_cycles = {cycles}\nrecorded_cycles = {cycles}'


def _accuracy(draw, module: float) -> str:
    return (
        f'[accuracy]\nelement = "{draw(st.sampled_from(("P1", "P2")))}"\nflank_element_size ='
        f' "{draw(st.floats(0.08, 0.2)) * module!r} mm"\ncontact_length = "{draw(st.floats(0.2, 1.0)) * module!r}'
        f' mm"\ncontact_nodes = {draw(st.integers(2, 9))}\ninterpolation ='
        f' "{draw(st.sampled_from(("averaged", "collocated")))}"\nsteps_per_mesh_cycle = {draw(st.integers(20, 40))}'
    )
