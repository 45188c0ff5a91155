"""Run-out."""

from dataclasses import replace
from math import cos

import numpy as np
import pytest
from tests.coarse import rigid_pair

from fenics_gears import scene_from_text, simulate
from fenics_gears.contact.eccentricity import Eccentricity, Offset
from fenics_gears.contact.kinematics import IN_THE_PLANE, lines_of
from fenics_gears.contact.places import pair_places
from fenics_gears.contact.run_out import RunOut
from fenics_gears.contact.tooth_pair import COAST, DRIVE, PairNodes
from fenics_gears.contact.window import ContactGrid
from fenics_gears.scene.data import Accuracy, Motion

DISTANCE, PHASE = 0.01, 0.7
PERIOD = 48  # mesh cycles until 16 and 24 teeth meet again: three turns of the pinion, two of the wheel


@pytest.fixture(scope="module")
def rigid(paper_scene):
    """The paper's pair with rigid flanks on rigid shafts, over a hunting tooth period."""
    return replace(
        rigid_pair(paper_scene), accuracy=Accuracy(steps_per_mesh_cycle=20), motion=Motion(200.0, PERIOD, PERIOD)
    )


def harmonics(result, radius):
    """Complex amplitudes (mm at the wheel's base circle) of the orders of the hunting tooth period, the mean first."""
    error = result.transmission_error.values[:-1] * radius
    spectrum = 2.0 * np.fft.rfft(error) / len(error)
    return spectrum


@pytest.mark.parametrize(("gear", "turns"), [("pinion", 3), ("wheel", 2)])
def test_rigid_gears_have_one_harmonic_once_a_turn(rigid, paper_pair, gear, turns):
    """Exact: the gap opens by -e cos(rotation + phase) for the pinion, by +e cos(rotation + phase) for the wheel."""
    offsets = {"pinion": None, "wheel": None, gear: Offset(DISTANCE, PHASE)}
    spectrum = harmonics(simulate(replace(rigid, eccentricity=Eccentricity(**offsets))), paper_pair.wheel.base_radius)
    sign = -1.0 if gear == "pinion" else 1.0
    assert spectrum[turns] == pytest.approx(sign * DISTANCE * np.exp(1j * PHASE), abs=1e-12)
    spectrum[turns] = 0.0
    assert np.abs(spectrum[1:]).max() <= 1e-12


class _Position:
    """A node on the line of action of each pair at a position."""

    def __init__(self, pair, index, steps):
        places = pair_places(pair, ContactGrid(1.5, 20), index / steps, coast_flanks=True)
        nothing, both = np.zeros(1), np.zeros((2, 1))
        self.pairs = [PairNodes(place, nothing, nothing, nothing, both, both) for place in places]
        self.operator, self.index = self, index
        self.lines, self.face = lines_of(self.pairs, pair.sides), IN_THE_PLANE


@pytest.mark.parametrize("gear", [0, 1])
def test_gaps_of_both_flanks_are_displacements_along_their_own_normals(paper_pair, gear):
    """Exact: a rigid displacement of the base circle by (x, y); towards the mate both flanks close, around one loses
    what the other gains."""
    steps, offsets = 20, [None, None]
    offsets[gear] = Offset(DISTANCE, 0.0)
    run_out, angle = RunOut(paper_pair, Eccentricity(*offsets), steps), paper_pair.operating_pressure_angle
    teeth, sense = (paper_pair.pinion.teeth, paper_pair.wheel.teeth)[gear], (1.0, -1.0)[gear]
    for step in (0, 7, 33, 191):
        position = _Position(paper_pair, step % steps, steps)
        gaps = run_out(step, position)
        turned = sense * 2.0 * np.pi * step / (steps * teeth)
        # Angles of the displacement from either line of action's direction, pinion to wheel; the coast flanks' is (-cos
        # 2a, -sin 2a).
        expected = {DRIVE: -sense * DISTANCE * cos(turned), COAST: sense * DISTANCE * cos(turned - 2.0 * angle)}
        flanks = [pair.place.flank for pair in position.pairs]
        assert set(flanks) == {DRIVE, COAST}
        assert gaps == pytest.approx([expected[flank] for flank in flanks], abs=1e-15)


def test_a_relief_and_a_run_out_of_nothing_change_nothing(quasi_static_scene):
    """Identity, to the last digit: sweeps may begin at nothing."""
    turn = replace(quasi_static_scene, motion=Motion(200.0, 2, 1), accuracy=Accuracy(steps_per_mesh_cycle=10))
    text = turn.text + '\n[tip_relief]\ndepth = "0 um"\nstart = "HPSTC"\n[eccentricity.wheel]\ndistance = "0 um"\n'
    read = scene_from_text(text)
    nothing = replace(turn, tip_relief=read.tip_relief, eccentricity=read.eccentricity)
    assert nothing.tip_relief.pinion.depth == 0.0
    expected = simulate(turn)
    got = simulate(nothing)
    for name in ("transmission_error", "normal_force"):
        assert (got[name].values == expected[name].values).all()
