"""Fields that take lists, quantities of several kinds, or the words for a whole hunting tooth period; rules of errors
of manufacture.

Authority of every test here: the scene's format and hard case 26. A refusal names file, field, what is wrong with which
    value and what
is allowed.
"""

import math
import re
from pathlib import Path

import pytest

from fenics_gears.effects.eccentricity import Eccentricity, Offset
from fenics_gears.effects.flank_errors_sections import FlankErrors, GearErrors, Waviness
from fenics_gears.errors import SceneError
from fenics_gears.scene.read import scene_from_text

DEMO = (Path(__file__).parents[2] / "demos" / "lundvall2004.toml").read_text(encoding="utf-8")
PERIOD = '"hunting tooth period"'


def pitches(*values):
    """A list of as many deviations as the pinion has teeth, zero but for the first; texts in quotes, numbers
    without."""
    every = [*values, *["0 um"] * (16 - len(values))]
    return "[" + ", ".join(f"'{value}'" if isinstance(value, str) else str(value) for value in every) + "]"


def test_lists_and_their_units():
    """Each entry has its own unit; 1 um is 1e-3 mm."""
    text = f"[flank_errors.pinion]\npitch = {pitches('3 um', '-0.003 mm')}\nprofile_slope = {pitches('2 um')}".replace(
        "'", '"'
    )
    found = scene_from_text(f"{DEMO}\n{text}\n").flank_errors
    nothing = (0.0,) * 14
    assert found.pinion.pitch == pytest.approx((0.003, -0.003, *nothing), rel=1e-14)
    assert found.pinion.profile_slope == pytest.approx((0.002, 0.0, *nothing), rel=1e-14)
    assert found.pinion.profile_form is None and found.wheel == GearErrors() and found.tolerance_class is None


def test_a_class_a_seed_and_waves():
    """The seed is 1 and the phase zero unless given."""
    text = (
        '[flank_errors]\ntolerance_class = 7\n[flank_errors.wheel.waviness]\namplitude = "1 um"\nwaves = 90\nphase ='
        ' "90 deg"'
    )
    expected = FlankErrors(wheel=GearErrors(waviness=Waviness(0.001, 90, math.pi / 2)), tolerance_class=7, seed=1)
    assert scene_from_text(f"{DEMO}\n{text}\n").flank_errors == expected
    assert scene_from_text(f"{DEMO}\n[flank_errors]\ntolerance_class = 7\nseed = 12\n").flank_errors.seed == 12


def test_run_out_of_one_gear():
    """A gear without a section runs true."""
    found = scene_from_text(f'{DEMO}\n[eccentricity.wheel]\ndistance = "10 um"\n').eccentricity
    assert found == Eccentricity(None, Offset(0.01, 0.0))


@pytest.mark.parametrize(
    ("run", "recorded", "cycles"), [(PERIOD, PERIOD, (48, 48)), ("60", PERIOD, (60, 48)), (PERIOD, "3", (48, 3))]
)
def test_a_run_may_last_a_whole_hunting_tooth_period(run, recorded, cycles):
    """16 and 24 teeth: every tooth has met every one that it ever meets after lcm = 48 mesh cycles."""
    text = DEMO.replace("mesh_cycles = 30 ", f"mesh_cycles = {run} ").replace(
        "recorded_cycles = 2\n", f"recorded_cycles = {recorded}\n"
    )
    motion = scene_from_text(text).motion
    assert (motion.mesh_cycles, motion.recorded_cycles) == cycles


@pytest.mark.parametrize(
    ("frequency", "time", "recorded", "cycles"),
    [
        ("40 Hz", "25 ms", "", (3, 2)),
        ("40 Hz", "25.1 ms", "", (4, 2)),
        ("4 kHz", "25 ms", "recorded_cycles = 5", (105, 5)),
        ("200 Hz", "0 s", "", (2, 2)),
    ],
)
def test_a_settling_time_comes_before_the_recorded_cycles(frequency, time, recorded, cycles):
    """Arithmetic: time times mesh frequency, rounded up, and the recorded cycles after them."""
    text = (
        DEMO.replace('"200 Hz"', f'"{frequency}"')
        .replace("mesh_cycles = 30 ", f'settling_time = "{time}"  ')
        .replace("recorded_cycles = 2\n", f"{recorded}\n")
    )
    motion = scene_from_text(text).motion
    assert (motion.mesh_cycles, motion.recorded_cycles) == cycles


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("#mesh_cycles", "mesh_cycles"), "stands beside mesh_cycles"),
        (("[inertia]", "[output]\n[nothing]"), "is for scenes with [inertia]"),
        (("[shafts]", '[speed_ramp]\nend_frequency = "300 Hz"\n[shafts]'), "is for a steady speed"),
    ],
)
def test_a_settling_time_stands_alone(change, said):
    """It says how long a run with inertia at a steady speed is, in place of mesh_cycles."""
    text = DEMO.replace("mesh_cycles = 30", 'settling_time = "25 ms"\n#mesh_cycles = 30', 1)
    assert scene_from_text(text).motion.mesh_cycles == 7
    with pytest.raises(SceneError, match=rf'motion.settling_time = "25 ms"\n    {re.escape(said)}'):
        scene_from_text(text.replace(*change, 1))


def test_a_period_that_is_not_run_cannot_be_recorded():
    """The words are told with their number."""
    with pytest.raises(SceneError) as refused:
        scene_from_text(DEMO.replace("recorded_cycles = 2\n", f"recorded_cycles = {PERIOD}\n"))
    assert "(48 mesh cycles) is more than mesh_cycles = 30" in str(refused.value)
    with pytest.raises(SceneError, match='a text, not a bare number.*or "hunting tooth period"'):
        scene_from_text(DEMO.replace("recorded_cycles = 2\n", 'recorded_cycles = "hunting tooth"\n'))


WRONG = {
    "pitch = []": ["flank_errors.pinion.pitch = a list", "is empty"],
    'pitch = "3 um"': ["is not a list", 'such as ["3.5 um", "3.5 um"]'],
    'pitch = ["3 um"]': ["has 1 values, but the pinion has 16 teeth"],
    f"pitch = {pitches('3 kg')}": ['has the entry "3 kg" at place 1, which is a mass, not a length'],
    f"pitch = {pitches('0 um', 3)}": ["has the entry 3 at place 2, which is a number without its unit", '"3 um"'],
    f"pitch = {pitches('nan um')}": ["at place 1, which is not a finite number"],
    f"pitch = {pitches('200 mm')}": ["at place 1, which is too large", "from -100 mm to 100 mm"],
    f"pitch = {pitches('3 um')}": ["sums to 3 um over the whole turn"],
    f"profile_form = {pitches('0.5 mm')}": [
        "too large an error of manufacture for a module of 4.5 mm: up to 0.5 mm",
        "up to 0.45 mm",
    ],
    'waviness = { amplitude = "1 um", waves = 0 }': ["flank_errors.pinion.waviness.waves = 0", "from 1 to 1000000"],
    'waviness = { amplitude = "1 um" }': ["flank_errors.pinion.waviness.waves", "is missing"],
    'waviness = { amplitude = "0 um", waves = 37 }': ["For flanks without waviness, leave the section out"],
    'pich = ["3 um"]': ['Did you mean "pitch"?'],
}


@pytest.mark.parametrize("line", WRONG)
def test_wrong_errors_of_a_gear_are_refused(line):
    """Mistakes as people make them in the list of a gear's errors."""
    with pytest.raises(SceneError) as refused:
        scene_from_text(f"{DEMO}\n[flank_errors.pinion]\n{line}\n".replace("'", '"'))
    for words in WRONG[line]:
        assert words in str(refused.value)
    assert "1 mistake in" in str(refused.value)


@pytest.mark.parametrize(
    ("section", "said"),
    [
        ("[flank_errors]", ["[flank_errors]\n", "has no errors", "leave the section out"]),
        (
            "[flank_errors]\nseed = 4\n[flank_errors.pinion.waviness]\namplitude = '1 um'\nwaves = 3",
            ["flank_errors.tolerance_class\n", "is missing"],
        ),
        ("[flank_errors]\ntolerance_class = 12", ["is too large", "from 1 to 11"]),
        ("[eccentricity]", ["says of neither gear that it runs out"]),
        ("[eccentricity.wheel]\ndistance = '1 mm'", ["eccentricity.wheel.distance", "up to 0.45 mm"]),
        ("[eccentricity.wheel]\ndistance = '0 mm'", ["is zero. For a gear that runs true, leave its section out"]),
        (
            "[tip_relief]\ndepth = '3 um'\nstart = '3 kg'",
            ["is a mass, not an angle or a length", '"80.1 mm"', '"HPSTC"'],
        ),
        ("[tip_relief]\ndepth = '3 um'\nstart = '400 deg'", ["is too large", "from 1e-3 deg to 360 deg"]),
        ("[root_relief]\ndepth = '3 um'\nstart = 'HPSTC'", ['Did you mean "LPSTC"?']),
        (
            "[root_relief]\ndepth = '3 um'\nstart = 'LPSTC'\nshape = 'cubic'",
            ['root_relief.shape = "cubic"', '"linear", "parabolic"'],
        ),
        ("[root_relief]\ndepth = '3 um'", ["root_relief.start\n", '"LPSTC" or "29.61 deg"']),
    ],
)
def test_wrong_sections_are_refused(section, said):
    """Sections that say nothing, values out of range or of another kind, a rule between fields."""
    with pytest.raises(SceneError) as refused:
        scene_from_text(f"{DEMO}\n{section}\n".replace("'", '"'))
    for words in said:
        assert words in str(refused.value)


def test_a_class_is_for_gears_of_the_standards_sizes():
    """ISO 1328-1: modules from 0.5 mm to 70 mm, reference diameters from 5 mm to 15 m."""
    for module, teeth, words in (
        ("0.4 mm", 24, "modules from 0.5 to 70 mm"),
        ("65 mm", 250, "from 5 mm to 15 m .*, not 16250 mm"),
    ):
        text = (
            DEMO[: DEMO.index("[accuracy]")]
            .replace('module = "4.5 mm"', f'module = "{module}"')
            .replace("teeth = 24", f"teeth = {teeth}")
        )
        with pytest.raises(SceneError, match=words):
            scene_from_text(f"{text}\n[flank_errors]\ntolerance_class = 6\n")
