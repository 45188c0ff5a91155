"""Fields that take lists, several kinds, or a whole hunting tooth period (hard case 26)."""

import pytest
from tests.paper_text import PAPER as DEMO

from fenics_gears import SceneError, scene_from_text
from fenics_gears.geometry.flank_errors import GearErrors

PERIOD = '"hunting tooth period"'


def pitches(*values):
    """As many deviations as the pinion has teeth, zero but for the first."""
    every = [*values, *["0 um"] * (16 - len(values))]
    return "[" + ", ".join(f"'{value}'" if isinstance(value, str) else str(value) for value in every) + "]"


def test_lists_and_their_units():
    """1 um is 1e-3 mm."""
    text = f"[flank_errors.pinion]\npitch = {pitches('3 um', '-0.003 mm')}\nprofile_slope = {pitches('2 um')}".replace(
        "'", '"'
    )
    found = scene_from_text(f"{DEMO}\n{text}\n").flank_errors
    nothing = (0.0,) * 14
    assert found.pinion.pitch == pytest.approx((0.003, -0.003, *nothing), rel=1e-14)
    assert found.pinion.profile_slope == pytest.approx((0.002, 0.0, *nothing), rel=1e-14)
    assert found.pinion.profile_form is None and found.wheel == GearErrors() and found.tolerance_class is None


@pytest.mark.parametrize(
    ("run", "recorded", "cycles"), [(PERIOD, PERIOD, (48, 48)), ("60", PERIOD, (60, 48)), (PERIOD, "3", (48, 3))]
)
def test_a_run_may_last_a_whole_hunting_tooth_period(run, recorded, cycles):
    """lcm(16, 24) = 48."""
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
    """Arithmetic: time times mesh frequency, rounded up."""
    text = (
        DEMO.replace('"200 Hz"', f'"{frequency}"')
        .replace("mesh_cycles = 30 ", f'settling_time = "{time}"  ')
        .replace("recorded_cycles = 2\n", f"{recorded}\n")
    )
    motion = scene_from_text(text).motion
    assert (motion.mesh_cycles, motion.recorded_cycles) == cycles


@pytest.mark.parametrize(
    ("section", "said"),
    [
        ("[flank_errors]", ["[flank_errors]\n", "has no errors", "leave the section out"]),
        (
            "[flank_errors]\nseed = 4\n[flank_errors.pinion.waviness]\namplitude = '1 um'\nwaves = 3",
            ["flank_errors.tolerance_class\n", "is missing"],
        ),
        ("[eccentricity]", ["says of neither gear that it runs out"]),
        ("[eccentricity.wheel]\ndistance = '1 mm'", ["eccentricity.wheel.distance", "up to 0.45 mm"]),
        ("[eccentricity.wheel]\ndistance = '-1 mm'", ["is negative"]),
        (
            "[tip_relief]\ndepth = '3 um'\nstart = '3 kg'",
            ["is a mass, not an angle or a length", '"80.1 mm"', '"HPSTC"'],
        ),
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
    """ISO 1328-1: modules from 0.5 mm to 70 mm, diameters from 5 mm to 15 m."""
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
