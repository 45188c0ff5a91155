"""Pressure beside edges and kinks stands apart, by place alone."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import COARSE, coarse_scene, frictionless, teeth_alone

from fenics_gears import model_of, simulate
from fenics_gears.contact.laws import NO_FORCE
from fenics_gears.effects.tip_relief import TipRelief
from fenics_gears.geometry.relief import LINEAR, PARABOLIC, Relief, tip_reliefs
from fenics_gears.results.mesh_curves import read_off

ACCURACY = replace(COARSE, contact_length=2.0, contact_nodes=41, steps_per_mesh_cycle=20)


def relieved(paper_scene, pinion=None, wheel=None):
    """The paper's gears on rigid shafts with reliefs of 31 um from HPSTC."""
    reliefs = [shape and Relief(0.031, shape=shape) for shape in (pinion, wheel)]
    return replace(
        frictionless(teeth_alone(coarse_scene(paper_scene, cycles=1))),
        accuracy=ACCURACY,
        tip_relief=TipRelief(*reliefs),
    )


def along_flanks(pair, result):
    """Arcs (2, time, slot, node), mm, of the nodes along both involutes, by circles through their places."""
    rb1, rb2, span = pair.pinion.base_radius, pair.wheel.base_radius, pair.line_of_action_length
    offset, roll = result.contact_offset.values, result.contact_roll_angle.values
    height = rb1 - offset
    x = np.sqrt(rb1**2 * (1.0 + roll**2) - height**2)
    to_wheel = np.hypot(x - span, rb1 + rb2 - height)
    return 0.5 * rb1 * roll**2, 0.5 * rb2 * ((to_wheel / rb2) ** 2 - 1.0)


@pytest.mark.parametrize(("pinion", "wheel"), [(LINEAR, None), (PARABOLIC, LINEAR)])
def test_pressures_are_told_apart_by_distance_along_the_flanks(paper_scene, pinion, wheel):
    """Brute force: distance from tips and starts of linear relief against the Hertz half-width, twice that for tips."""
    scene = relieved(paper_scene, pinion, wheel)
    result, model = simulate(scene), model_of(scene)
    pair, reach, arcs = model.pair, model.resolution.half_width, along_flanks(model.pair, result)
    pressure = read_off(result.contact_pressure.values, result.contact_roll_angle.values)
    at_edge, at_kink = np.zeros(pressure.shape, dtype=bool), np.zeros(pressure.shape, dtype=bool)
    for arc, gear, relief in zip(arcs, (pair.pinion, pair.wheel), tip_reliefs(pair, scene.tip_relief)):
        tip = 0.5 * gear.base_radius * gear.tip_roll_angle**2
        at_edge |= np.abs(arc - tip) <= 2.0 * reach
        # Pairs that press with the edge itself, at which a node stands.
        pressed = ((np.abs(arc - tip) < 1e-4) & (result.contact_pressure.values > NO_FORCE)).any(axis=-1)
        at_edge |= pressed[..., None]
        if relief is not None and relief.power == 1:
            at_kink |= np.abs(arc - 0.5 * gear.base_radius * relief.start_roll_angle**2) <= reach
    largest = {"contact": ~at_edge & ~at_kink, "edge": at_edge, "kink": at_kink & ~at_edge}
    for name, chosen in largest.items():
        expected = np.where(chosen, pressure, 0.0).max(axis=(1, 2))
        assert result[f"largest_{name}_pressure"].values == pytest.approx(expected, rel=1e-9), name
        assert (expected > 100.0).any(), name


def test_a_pair_without_kinks_has_no_pressure_there(paper_scene):
    """Definition."""
    parabolic = simulate(relieved(paper_scene, PARABOLIC, PARABOLIC))
    assert not parabolic.largest_kink_pressure.values.any() and "peak_kink_pressure" not in parabolic.attrs
    assert "largest_kink_pressure" not in simulate(replace(relieved(paper_scene), tip_relief=None))
