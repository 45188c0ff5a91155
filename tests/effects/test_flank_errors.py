"""Errors of single teeth, wobble and helix deviations."""

from dataclasses import replace
from math import cos, pi

import numpy as np
import pytest
from tests.coarse import rigid_pair
from tests.effects.examples import text_of
from tests.effects.hats import hat_mean
from tests.stand_in import stand_in_compliance

from fenics_gears import SceneError, model_of, scene_from_text, simulate
from fenics_gears.contact.flank_at_height import roll_angle_at_height
from fenics_gears.contact.flank_gaps import flank_gaps
from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.tooth_pair import COAST, Flanks
from fenics_gears.contact.window import ContactGrid
from fenics_gears.geometry.flank_errors import FlankErrors, GearErrors, Waviness
from fenics_gears.scene.data import Accuracy, Motion

STEPS, PERIOD = 20, 48
ERROR = 0.01


@pytest.fixture(scope="module")
def rigid(paper_scene):
    """The paper's pair with rigid flanks on rigid shafts, over a hunting tooth period."""
    return replace(
        rigid_pair(paper_scene), accuracy=Accuracy(steps_per_mesh_cycle=STEPS), motion=Motion(200.0, PERIOD, PERIOD)
    )


@pytest.fixture(scope="module")
def both_flanks(paper_pair):
    gears = paper_pair.pinion, paper_pair.wheel
    flanks = Flanks(paper_pair, tuple(stand_in_compliance(gear, coast_flank=True) for gear in gears))
    return Cycle(elastic_mesh(flanks, ContactGrid(1.5, 20)), STEPS, [5], tangential=False)


def length(result, pair):
    """T_E (n,) on the wheel's base circle, mm."""
    return result.transmission_error.values * pair.wheel.base_radius


def spectrum(error):
    """Amplitudes of the multiples of once a hunting tooth period."""
    return 2.0 * np.abs(np.fft.rfft(error[:-1])) / (len(error) - 1)


def one_tooth(teeth, tooth, error):
    pitches = np.zeros(teeth)
    pitches[tooth], pitches[tooth + 1] = error, -error
    return tuple(pitches)


@pytest.mark.parametrize(("gear", "teeth", "first"), [("pinion", 16, -1.0), ("wheel", 24, 1.0)])
def test_a_tooth_out_of_place_displaces_the_rigid_pair_while_it_leads(rigid, paper_pair, gear, teeth, first):
    """Exact: a pitch deviation f is f cos(alpha) along the line of action. A tooth nearer to its mate leads all
    along the path of contact, one that stands back is felt only where it is alone; a pitch too long brings the
    pinion's tooth late, the wheel's near."""
    along = ERROR * cos(paper_pair.pinion.pressure_angle)
    ratio, tooth = paper_pair.contact_ratio, 5
    for sign in (first, -first):
        errors = FlankErrors(**{gear: GearErrors(pitch=one_tooth(teeth, tooth, sign * ERROR))})
        result = simulate(replace(rigid, flank_errors=errors))
        error, phase = length(result, paper_pair), (result.mesh_phase.values - tooth) % teeth
        inside, alone = (phase > 0.0) & (phase < ratio), (phase > ratio - 1.0 + 0.06) & (phase < 0.94)
        outside = (phase > ratio + 0.1) & (phase < teeth - 0.1)
        near = sign == first
        assert error[inside if near else alone] == pytest.approx(-along if near else along, abs=1e-12)
        if not near:
            assert error[inside & ~alone].max() <= along + 1e-12
            beside_another = ((phase > 0.0) & (phase <= ratio - 1.0)) | ((phase >= 1.0) & (phase < ratio))
            assert np.abs(error[beside_another]).max() <= 1e-12
        assert np.abs(error[outside]).max() <= 1e-12


@pytest.mark.parametrize(
    ("waves", "gear", "turns"),
    [
        (64, "pinion", 3),
        *(
            pytest.param(*each, marks=pytest.mark.nightly)
            for each in [(7, "wheel", 2), (7, "pinion", 3), (37, "pinion", 3), (37, "wheel", 2), (64, "wheel", 2)]
        ),
    ],
)
def test_waves_give_their_own_order_and_go_on_from_tooth_to_tooth(rigid, paper_pair, gear, turns, waves):
    """Known answer: all pairs in mesh see the same phase, so that there is one order, as large as the wave is high."""
    small, amplitude = 1e-7, 1e-4
    found = []
    for height in (small, amplitude):
        errors = FlankErrors(**{gear: GearErrors(waviness=Waviness(height, waves, 0.4))})
        lines = spectrum(
            length(
                simulate(replace(rigid, accuracy=Accuracy(steps_per_mesh_cycle=40), flank_errors=errors)), paper_pair
            )
        )
        others = np.delete(lines, [0, turns * waves])
        found.append((lines[turns * waves] / height, others.max() / height))
    (line, rest), (coarser, coarse_rest) = found
    assert line == pytest.approx(1.0, abs=1e-4) and rest < 1e-3
    assert coarser == pytest.approx(1.0, abs=0.02) and coarse_rest < 0.02


ALL = GearErrors(
    pitch=one_tooth(16, 3, ERROR),
    profile_slope=(0.004,) * 16,
    profile_form=(0.003,) * 16,
    waviness=Waviness(0.001, 37, 0.4),
)


def moved(name, change):
    """Errors of the pinion with one kind of them changed by `change` (mm, rad)."""
    if name in ("amplitude", "phase"):
        waves = replace(ALL.waviness, **{name: getattr(ALL.waviness, name) + change})
        return FlankErrors(pinion=replace(ALL, waviness=waves))
    if name == "pitch":
        return FlankErrors(pinion=replace(ALL, pitch=one_tooth(16, 3, ERROR + change)))
    return FlankErrors(pinion=replace(ALL, **{name: tuple(np.array(getattr(ALL, name)) + change)}))


def excess_per_unit(name, roll, tooth, pair):
    """Material in excess on the pinion's flank for a unit of a deviation."""
    start, end = pair.sap_roll_angles[0], pair.pinion.tip_roll_angle
    along = (roll - start) / (end - start)
    turned = 37 * (roll + tooth * pair.pinion.angular_pitch) + 0.4
    return {
        "pitch": -cos(pair.pinion.pressure_angle) * (tooth == 3),
        "profile_slope": along - 0.5,
        "profile_form": -0.5 * np.cos(2 * pi * along),
        "amplitude": np.cos(turned),
        "phase": -0.001 * np.sin(turned),
    }[name]


@pytest.mark.parametrize("name", ["pitch", "profile_slope", "profile_form", "amplitude", "phase"])
def test_gaps_follow_each_deviation(both_flanks, paper_pair, name):
    """Finite differences: the gap's derivative is less the excess, averaged by quadrature; coast flanks have true
    profiles, but stand where their tooth stands."""
    change, step = 1e-7, 3 * STEPS + 11
    position = both_flanks.position(step)
    ends = [flank_gaps(moved(name, sign * change), paper_pair, STEPS)(step, position) for sign in (1, -1)]
    derivative, start, checked = (ends[0] - ends[1]) / (2.0 * change), 0, []
    for pair in position.operator.pairs:
        nodes = derivative[start : start + len(pair.offsets)]
        start += len(nodes)
        tooth = (3 - pair.place.index) % 16
        if pair.place.flank == COAST:
            sign = -cos(paper_pair.pinion.pressure_angle) * (tooth == 3) if name == "pitch" else 0.0
            assert nodes == pytest.approx(sign, abs=1e-9)
            continue
        for j in (0, len(nodes) // 2, len(nodes) - 1):
            expected = -hat_mean(pair.offsets, j, lambda offset: _excess_at(name, offset, pair, tooth, paper_pair))
            assert nodes[j] == pytest.approx(expected, abs=1e-6)
            checked.append(abs(expected))
    assert max(checked) > (1e-4 if name == "phase" else 0.05)


def _excess_at(name, offset, pair, tooth, gear_pair):
    radius = gear_pair.pinion.base_radius
    roll = roll_angle_at_height(radius, pair.place.contact_rolls[0], radius - offset)
    return float(excess_per_unit(name, roll, tooth, gear_pair))


def test_waves_that_the_steps_do_not_sample_are_refused(paper_scene):
    """What, the value, what is allowed, the remedy, before gears are condensed."""
    scene = replace(paper_scene, flank_errors=FlankErrors(wheel=GearErrors(waviness=Waviness(0.001, 241, 0.0))))
    with pytest.raises(SceneError) as refused:
        model_of(replace(scene, accuracy=Accuracy(steps_per_mesh_cycle=STEPS)))
    for words in ("flank_errors.wheel.waviness.waves = 241", "480 steps", "steps_per_mesh_cycle to 21 or more"):
        assert words in str(refused.value)
    model_of(replace(scene, accuracy=Accuracy(steps_per_mesh_cycle=STEPS + 1)))


FACE = '[misalignment]\nin_plane = "0 um"\n'
ELASTIC = text_of("tooth_elasticity")
WOBBLE = '[eccentricity.wheel]\nwobble = "10 um"\nwobble_phase = "90 deg"\n'
FIVE = '"5 um"'
HELIX = f"[flank_errors.pinion]\nhelix_slope = [{', '.join([FIVE] * 16)}]\n"
CLASS = "[flank_errors]\ntolerance_class = 6\n"


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (
            WOBBLE,
            (
                'eccentricity.wheel.wobble = "10 um"\n    is of three-dimensional scenes: allowed with'
                " gears.helix_angle, [lead_modifications], [misalignment], bearings.places,"
                " shafts.input.sections or shafts.output.sections."
            ),
        ),
        (HELIX, "flank_errors.pinion.helix_slope = a list\n    is of three-dimensional scenes"),
        (
            FACE + '[eccentricity.wheel]\nwobble_phase = "90 deg"\n',
            'eccentricity.wheel.distance\n    is missing. Allowed: such as "10 um"; or a wobble',
        ),
        (FACE + '[eccentricity.wheel]\nwobble = "1 mm"\n', "is too large an error of manufacture"),
        (FACE + HELIX.replace("5 um", "1 mm"), "is too large an error of manufacture"),
        (FACE + HELIX.replace(', "5 um"', "", 1), "has 15 values, but the pinion has 16 teeth"),
    ],
)
def test_what_needs_a_face_or_does_not_fit_it_is_refused(lines, said):
    """House rule 7."""
    with pytest.raises(SceneError) as refused:
        scene_from_text(ELASTIC + lines)
    assert said in str(refused.value)


def test_a_class_is_for_face_widths_of_the_standard():
    """ISO 1328-1:2013: face widths from 4 mm to 1.2 m; a plane scene draws nothing along the face."""
    narrow = ELASTIC.replace('face_width = "15 mm"', 'face_width = "3 mm"')
    scene_from_text(narrow + CLASS)
    with pytest.raises(SceneError, match="face widths from 4 mm to 1200 mm"):
        scene_from_text(narrow + CLASS + FACE)


def test_a_table_with_helix_deviations_is_of_a_scene_with_a_face(tmp_path, monkeypatch):
    """House rule 7."""
    from fenics_gears.model.model import model_of

    (tmp_path / "pinion.csv").write_text(
        "tooth, helix_form (um)\n" + "".join(f"{tooth}, 3\n" for tooth in range(1, 17))
    )
    table = f'[flank_errors.pinion]\nfile = "{tmp_path}/pinion.csv"\n'
    assert model_of(scene_from_text(ELASTIC + FACE + table)).scene.flank_errors.pinion.helix_form == pytest.approx(
        (0.003,) * 16
    )
    with pytest.raises(SceneError, match="the column helix_form is of three-dimensional scenes"):
        model_of(scene_from_text(ELASTIC + table))
