"""Wobble, helix deviations, waves over the face."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from tests.stand_in import stand_in_body

from fenics_gears.contact.eccentricity import Eccentricity, Offset
from fenics_gears.contact.face import Face, even_slices
from fenics_gears.contact.face_mesh import face_mesh
from fenics_gears.contact.flank_gaps import flank_gaps
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.run_out import RunOut
from fenics_gears.contact.tooth_pair import node_slices
from fenics_gears.contact.window import ContactGrid
from fenics_gears.geometry.flank_errors import FlankErrors, GearErrors, Waviness
from fenics_gears.geometry.gear_data import Helix

SLICES, STEPS = 4, 10
WOBBLE, PHASE = 0.02, 0.6


def cycle_of(flanks, helix):
    pair = replace(flanks.pair, helix=helix, axial_offsets=(1.0, -2.0), own_face_widths=(18.0, 20.0))
    face = Face(*even_slices(pair.face_width, SLICES), pair.slope, pair.gear_middles)
    bodies = tuple(stand_in_body(gear, width) for gear, width in zip((pair.pinion, pair.wheel), pair.face_widths))
    return Cycle(face_mesh(replace(flanks, pair=pair), bodies, face, ContactGrid(2.0, 8)), STEPS, [5], False)


@pytest.fixture(scope="module")
def spur(stand_in_flanks):
    return cycle_of(stand_in_flanks, None)


@pytest.fixture(scope="module")
def helical(stand_in_flanks):
    return cycle_of(stand_in_flanks, Helix(np.deg2rad(20.0), "left"))


def heights(position):
    """Height (n,), mm, of each node's slice."""
    return np.concatenate([np.full(len(pair.offsets), pair.place.height) for pair in position.operator.pairs])


@pytest.mark.parametrize("gear", [0, 1])
def test_a_spur_gear_that_wobbles_is_eccentric_in_each_slice(spur, gear):
    """Exact: a section at the height h is off its axis by wobble h/width."""
    pair, offsets = spur.pair, [None, None]
    offsets[gear] = Offset(wobble=WOBBLE, wobble_phase=PHASE)
    wobbling = RunOut(pair, Eccentricity(*offsets), STEPS)
    for step in (0, 3, 47, 151):
        position = spur.position(step)
        found = wobbling(step, position)
        for height in spur.face.positions:
            from_middle = height - pair.gear_middles[gear]
            offsets[gear] = Offset(WOBBLE * from_middle / pair.face_widths[gear], PHASE)
            expected = RunOut(pair, Eccentricity(*offsets), STEPS)(step, position)
            here = heights(position) == height
            assert here.any() and found[here] == pytest.approx(expected[here], abs=1e-15)


@pytest.mark.parametrize("gear", [0, 1])
def test_flanks_of_a_helical_gear_move_with_its_leaning_axis(helical, gear):
    """Rigid motion: points move across the leaning axis and, by their distance from it, along it."""
    pair, offsets, step = helical.pair, [None, None], 23
    offsets[gear] = Offset(wobble=WOBBLE, wobble_phase=PHASE)
    position = helical.position(step)
    sense, teeth, width = ((1.0, pair.pinion.teeth, 18.0), (-1.0, pair.wheel.teeth, 20.0))[gear]
    angle = sense * (2.0 * np.pi * step / (STEPS * teeth) + PHASE)
    lean = WOBBLE / width * np.array([np.cos(angle), np.sin(angle), 0.0])
    expected = []
    for nodes in position.operator.pairs:
        for arm_1, arm_2 in nodes.friction_arms.T:
            x, y = ((arm_1, -pair.pinion.base_radius), (-arm_2, pair.wheel.base_radius))[gear]
            z = nodes.place.height - pair.gear_middles[gear]
            # The axis at z is off by lean z; the end faces tilt against it, so that points ahead in the lean's
            # direction go down.
            motion = lean * z - np.array([0.0, 0.0, lean[0] * x + lean[1] * y])
            along = motion @ np.array([1.0, 0.0, -pair.slope])
            expected.append(-sense * along)
    found = RunOut(pair, Eccentricity(*offsets), STEPS)(step, position)
    assert np.abs(found).max() > 0.2 * WOBBLE and found == pytest.approx(expected, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize(
    ("name", "shape"),
    [("helix_slope", lambda along: along - 0.5), ("helix_form", lambda along: -0.5 * np.cos(2.0 * np.pi * along))],
)
@pytest.mark.parametrize("gear", [0, 1])
def test_helix_deviations_are_material_over_the_gears_own_face(helical, name, shape, gear):
    """Definition: slope rises over the gear's own face, form is one wave as wide as its value."""
    pair, step = helical.pair, 2 * STEPS + 4
    teeth, width, sense = ((pair.pinion.teeth, 18.0, 1), (pair.wheel.teeth, 20.0, 1))[gear]
    values = 0.001 * np.arange(1.0, teeth + 1.0)
    errors = [GearErrors(), GearErrors()]
    errors[gear] = GearErrors(**{name: tuple(values)})
    position = helical.position(step)
    found = flank_gaps(FlankErrors(pinion=errors[0], wheel=errors[1]), pair, STEPS, helical.face)(step, position)
    met = set()
    for place, nodes in zip([each.place for each in position.operator.pairs], node_slices(position.operator.pairs)):
        tooth = (2 - place.index) % teeth
        met.add(tooth)
        along = (place.height - pair.gear_middles[gear]) / width + 0.5
        assert found[nodes] == pytest.approx(-sense * values[tooth] * shape(along), abs=1e-12)
    assert len(met) > 1


class OnTheLine:
    """A node on the line of action in each slice of each pair."""

    def __init__(self, position):
        self.operator, self.index = self, position.index
        self.pairs = [SimpleNamespace(place=each.place, offsets=np.zeros(1)) for each in position.operator.pairs]
        self.nodes = len(self.pairs)


@pytest.mark.parametrize("gear", [0, 1])
def test_waves_run_along_the_lines_of_contact(helical, gear):
    """Definition: one phase along a line of contact."""
    pair, step, waves, amplitude = helical.pair, 6, 40, 0.001
    errors = [GearErrors(), GearErrors()]
    errors[gear] = GearErrors(waviness=Waviness(amplitude, waves, 0.2))
    position = OnTheLine(helical.position(step))
    found = flank_gaps(FlankErrors(pinion=errors[0], wheel=errors[1]), pair, STEPS, helical.face)(step, position)
    for index in {each.place.index for each in position.pairs}:
        own = [place for place, each in enumerate(position.pairs) if each.place.index == index]
        line = [
            each.place.contact_rolls[0] * pair.pinion.base_radius - pair.slope * each.place.height
            for each in position.pairs
            if each.place.index == index
        ]
        assert np.ptp(line) < 1e-12 and len(own) > 1
        tooth = -index % (pair.pinion.teeth, pair.wheel.teeth)[gear]
        if gear == 0:
            angle = waves * (line[0] / pair.pinion.base_radius + tooth * pair.pinion.angular_pitch)
        else:
            angle = waves * (
                (pair.line_of_action_length - line[0]) / pair.wheel.base_radius - tooth * pair.wheel.angular_pitch
            )
        assert found[own] == pytest.approx(-amplitude * np.cos(angle + 0.2), abs=1e-12)
