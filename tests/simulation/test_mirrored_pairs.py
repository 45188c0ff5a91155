"""Laws of symmetry: coast flanks are drive flanks in the mirror, and so is a pair of the other hand; turned by half a
turn the wheel drives the pinion. On bodies without finite elements unless a test asks for them."""

from dataclasses import replace

import numpy as np
import pytest
from tests.helical import helical_scene, on_stand_in_bodies

from fenics_gears import model_of
from fenics_gears.dynamics.batch import Batch
from fenics_gears.dynamics.marched import BetweenSteps
from fenics_gears.elasticity.cache import Cache
from fenics_gears.results.mesh_curves import _highest
from fenics_gears.simulation.bodies import gear_bodies
from fenics_gears.simulation.elastic_route import gaps_of, mesh_cycle
from fenics_gears.system.progress import SilentProgress

STEPS, PHASES = 16, np.array([0.13, 0.4, 0.77])
ACCURACY = f"slices = 4\ncontact_nodes = 13\nsteps_per_mesh_cycle = {STEPS}"
# Finite elements; layers enough for cuts with fewer nodes deep below the root.
FEW_ELEMENTS = """slices = 5
layers = 4
body_element_size = "6 mm"
flank_element_size = "0.8 mm"
contact_nodes = 9
steps_per_mesh_cycle = 16"""
FACE = '[lead_modifications.pinion]\ncrowning = "0 um"\n'


class Solved:
    """A pair at some phases, without friction: forces (n,), N, and the wheel's rotation, mm at its base circle."""

    def __init__(self, phases, more="", accuracy=ACCURACY, bodies=on_stand_in_bodies, **of_scene):
        model = model_of(helical_scene(FACE + more, accuracy=accuracy, **of_scene))
        self.pair, cycle = model.pair, mesh_cycle(model, bodies(model))
        cycle = cycle.with_gaps(gaps_of(model, cycle))
        places = (STEPS * (1.0 + np.asarray(phases))).tolist()
        found = BetweenSteps(Batch(cycle, [model.equations_of_motion])).at([(0, place) for place in places])
        self.records = [found[0, place] for place in places]
        self.forces = [record.solution.forces for record in self.records]
        self.turned = np.array([np.abs(record.solution.coordinates).max() for record in self.records])


@pytest.mark.parametrize("helix", [0.0, 15.0])
@pytest.mark.parametrize("backlash", [0.0, 0.12, 0.4])
def test_coast_flanks_are_drive_flanks_in_the_mirror_whatever_the_backlash(helix, backlash):
    """Exact symmetry: mirrored at the line of centres, or turned over about it, a pair driven backwards is the pair
    driven forwards at the mirrored phase. The wheel turns by the backlash more; all else is the same."""
    of_scene = {"helix": helix, "backlash": backlash, "more": "[coast_flanks]\n"}
    drive = Solved(PHASES, torque=200e3, **of_scene)
    pair = drive.pair
    # The coast flank of the pinion's tooth at xi on the drive flanks' line stands at this less xi on its own.
    whole = 2.0 * pair.pinion.base_radius * (pair.operating_pressure_angle + pair.pinion.tooth_half_angle_at_base)
    mirrored = ((whole - 2.0 * pair.path_start) / pair.base_pitch - PHASES) % 1.0
    coast = Solved(mirrored, torque=-200e3, **of_scene)
    assert coast.turned - pair.backlash == pytest.approx(drive.turned, rel=1e-9)
    for one, other in zip(drive.forces, coast.forces):
        np.testing.assert_allclose(np.sort(other[other > 0.0]), np.sort(one[one > 0.0]), rtol=1e-7, atol=1e-7)
        assert other.sum() == pytest.approx(one.sum(), rel=1e-9)


@pytest.mark.parametrize("helix", [pytest.param(0.1, marks=pytest.mark.nightly), 45.0])
def test_hands_and_gears_change_places(helix, tmp_path):
    """Exact symmetries of finite elements at both ends of the range of helix angles: z -> -z turns the hands round;
    turned by half a turn in its plane the pair is the wheel driving the pinion, each with its hand, at L - xi."""
    teeth, torque = (30, 41), 200e3

    def solved(phases, **of_scene):
        kept = Cache(tmp_path)
        return Solved(phases, accuracy=FEW_ELEMENTS, helix=helix, width=9.0, backlash=0.0,
                      bodies=lambda model: gear_bodies(model, SilentProgress(), kept), **of_scene)  # fmt: skip

    usual = solved(PHASES, teeth=teeth, torque=torque)
    mirrored = solved(PHASES, teeth=teeth, torque=torque, hand="left")
    pair, swapped = usual.pair, replace(usual.pair, pinion=usual.pair.wheel, wheel=usual.pair.pinion)
    begins = (pair.line_of_action_length - pair.path_start - swapped.path_start) / pair.base_pitch
    turned = solved((begins - PHASES) % 1.0, teeth=teeth[::-1], torque=torque * teeth[0] / teeth[1], hand="left")
    for other in (mirrored, turned):
        np.testing.assert_allclose(other.turned, usual.turned, rtol=1e-10)
        for one, another in zip(usual.forces, other.forces):
            one, another = (np.sort(each[each > 0.0]) for each in (one, another))
            np.testing.assert_allclose(another, one, rtol=0.0, atol=1e-10 * one.sum())


def test_the_deflection_is_that_of_no_slice_before_the_others():
    """Symmetry: slices change places in the mirror. Two whose highest nodes are alike, with other neighbours; a node as
    high as the next; and the vertex of a parabola, exactly, between nodes that miss it."""
    places = np.arange(5.0)
    one, other = 7.0 - (places - 2.0) ** 2, np.array([3.0, 6.0, 7.0, 6.9, 2.0])
    of_pair = np.repeat([0, 1], 5)
    found = [_highest(np.concatenate(both), of_pair) for both in ((one, other), (other, one))]
    assert found[0] == pytest.approx(found[1], rel=1e-15) and found[0] > 7.0
    missed = 4.0 - 0.5 * (places - 2.3) ** 2
    assert _highest(missed, np.zeros(5, dtype=int)) == pytest.approx(4.0, rel=1e-12)
    level = np.array([1.0, 5.0, 5.0, 1.0, -np.inf])
    backwards = level[::-1].copy()
    assert _highest(level, np.zeros(5, dtype=int)) == pytest.approx(_highest(backwards, np.zeros(5, dtype=int)))
