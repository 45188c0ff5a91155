"""Flash temperature against Blok's integral, and the standard's load share."""

from math import pi, sqrt

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import quad
from tests.helical import wide_pair

from fenics_gears.extensions.rating.finish import Finish
from fenics_gears.extensions.rating.flash_temperature import STEEL, flash_temperature, standard_share
from fenics_gears.extensions.rating.rating import _flash, _operation
from fenics_gears.scene.data import Material

MATERIALS = (Material(206e3, 0.3), Material(206e3, 0.3))


def test_it_is_the_temperature_under_a_moving_band(paper_pair):
    """Exact: a semi-elliptic band of heat on a half-space, T(x) = 1/(B sqrt(pi v)) int q(s)/sqrt(x - s) ds, split so
    that both flanks have the same largest temperature. The formula's 0.80 is the rounded 0.7924."""
    position, force, friction, speed = 0.75 * paper_pair.path_end, 400.0, 0.1, 1500.0
    first, second = position, paper_pair.line_of_action_length - position
    radius = first * second / (first + second)
    half_width = 1e-3 * sqrt(8.0 * force * radius * (1.0 - 0.09) / (pi * 206e3))
    turning = 2.0 * pi * speed / 60.0
    v1, v2 = 1e-3 * turning * first, 1e-3 * turning * 16 / 24 * second
    heat = friction * 1e3 * force * abs(v1 - v2)
    contact = STEEL * 1e3

    def largest(v, power):
        def at(x):
            # s = x - u^2 takes the singularity away.
            return quad(
                lambda u: 2.0 * sqrt(max(1.0 - ((x - u**2) / half_width) ** 2, 0.0)), 0.0, sqrt(x + half_width)
            )[0]

        peak = max(at(x) for x in np.linspace(0.0, 0.9, 40) * half_width)
        return 2.0 * power / (pi * half_width) * peak / (contact * sqrt(pi * v))

    # Equal temperatures on both sides: T = T1 T2 / (T1 + T2) of the whole heat to either.
    one, two = largest(v1, heat), largest(v2, heat)
    exact = one * two / (one + two)
    found = flash_temperature(paper_pair, MATERIALS, [position], [force], friction, speed)[0]
    assert found == pytest.approx(exact, rel=0.02)


def test_load_share_of_unmodified_teeth(paper_pair):
    """ISO/TS 6336-20: one third at both ends, two thirds beside single contact, one in it."""
    lowest, highest = paper_pair.path_end - paper_pair.base_pitch, paper_pair.path_start + paper_pair.base_pitch
    places = [paper_pair.path_start, lowest - 1e-9, 0.5 * (lowest + highest), highest + 1e-9, paper_pair.path_end]
    assert standard_share(paper_pair, places) == pytest.approx([1 / 3, 2 / 3, 1.0, 2 / 3, 1 / 3], abs=1e-6)


def test_computed_forces_enter_in_the_transverse_section_as_the_standards_do():
    """Statics: F_bt/cos(beta_b) along the contact normal has the flash temperature of the line force F_bt/b."""
    scene = wide_pair("[friction]\ncoefficient = 0.05\n")
    operation = _operation(scene, Finish(), xr.Dataset())
    pair, force = operation.pair, scene.load.wheel_torque / operation.pair.wheel.base_radius
    phase = np.linspace(0.0, 0.95 * pair.contact_ratio, 40)
    dims = ("time", "slot")
    coordinates = {
        "time": phase,
        "mesh_phase": ("time", phase),
        "pair_number": (dims, np.ones((40, 1), dtype=int), {"number_at_phase_0": 1}),
    }
    result = xr.Dataset(
        {"pair_normal_force": (dims, np.full((40, 1), force / pair.cosine))},
        coordinates,
        {"friction_coefficient": 0.05},
    )
    expected = flash_temperature(
        pair,
        operation.materials,
        pair.path_start + phase * pair.base_pitch,
        np.full(40, force / pair.face_width),
        0.05,
        operation.pinion_speed,
    )
    (row,) = _flash(operation, result)
    assert pair.cosine < 0.98 and row.computed == pytest.approx(expected.max())
