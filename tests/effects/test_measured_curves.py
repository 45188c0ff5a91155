"""Measured profiles and helices of single teeth from tables."""

import numpy as np
import pytest
from tests.effects.examples import text_of
from tests.stand_in import stand_in_compliance

from fenics_gears import SceneError
from fenics_gears.commands.work.scenes import checked_model
from fenics_gears.contact.flank_gaps import flank_gaps
from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.tooth_pair import Flanks
from fenics_gears.contact.window import ContactGrid
from fenics_gears.effects.flank_errors_tables import located
from fenics_gears.geometry.flank_deviations import flank_deviations, slope_and_form
from fenics_gears.geometry.flank_errors import MEAN, REFERENCE_POINT, FlankErrors, GearErrors

STEPS = 20


@pytest.fixture(scope="module")
def drive_flanks(paper_pair):
    gears = paper_pair.pinion, paper_pair.wheel
    return Cycle(
        elastic_mesh(Flanks(paper_pair, tuple(stand_in_compliance(gear) for gear in gears)), ContactGrid(1.5, 20)),
        STEPS,
        [5],
        tangential=False,
    )


def curve(teeth, places, deviation, heading="roll_length (mm)"):
    """A table of curves; `deviation`: um at a tooth and the points' share of the way."""
    share = np.linspace(0.0, 1.0, len(places))
    rows = [
        f"{tooth}, {place!r}, {float(deviation(tooth, at))!r}"
        for tooth in teeth
        for place, at in zip(places.tolist(), share.tolist())
    ]
    return "\n".join([f"tooth, {heading}, deviation (um)", *rows])


def measured(tmp_path, text, gear="pinion", name="profile_curves", anchor=MEAN):
    (tmp_path / "curves.csv").write_text(text)
    return located(FlankErrors(**{gear: GearErrors(**{name: "curves.csv", "anchor": anchor})}), tmp_path)


def places_of(pair, gear, along, points=400):
    body, start = (pair.pinion, pair.wheel)[gear], pair.sap_roll_angles[gear]
    roll = np.linspace(start, body.tip_roll_angle, points)
    return {
        "roll_length (mm)": body.base_radius * roll,
        "roll_angle (deg)": np.degrees(roll),
        "diameter (mm)": 2.0 * body.base_radius * np.hypot(1.0, roll),
    }[along]


@pytest.mark.parametrize("along", ["roll_length (mm)", "roll_angle (deg)", "diameter (mm)"])
@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_a_measured_curve_is_the_deviation_it_shows(drive_flanks, paper_pair, tmp_path, gear, along):
    """Identity: slope and form make the gaps of the lists, within twice pi^2/(4 200^2) of the form, the error of 200
    straight pieces."""
    number = ("pinion", "wheel").index(gear)
    teeth = (16, 24)[number]
    slopes, forms = 1e-3 * np.arange(1.0, teeth + 1.0), 2e-3 * np.cos(np.arange(teeth))
    text = curve(
        range(1, teeth + 1),
        places_of(paper_pair, number, along),
        lambda tooth, at: 1e3 * (slopes[tooth - 1] * at - 0.5 * forms[tooth - 1] * np.cos(2.0 * np.pi * at)) + 7.0,
        along,
    )
    lists = FlankErrors(**{gear: GearErrors(profile_slope=tuple(slopes), profile_form=tuple(forms))})
    gaps = [flank_gaps(errors, paper_pair, STEPS) for errors in (measured(tmp_path, text, gear), lists)]
    checked = []
    for step in range(3 * STEPS, 4 * STEPS):
        position = drive_flanks.position(step)
        inside = np.concatenate([_inside(pair, paper_pair) for pair in position.operator.pairs])
        found, expected = (each(step, position)[inside] for each in gaps)
        assert found == pytest.approx(expected, abs=2e-3 * np.pi**2 / 200.0**2 + 1e-9)
        checked.extend(np.abs(expected))
    assert max(checked) > 3e-4 and len(checked) > 100


def _inside(pair, gear_pair):
    """Nodes well within the active profiles: beyond, the curve is level."""
    shares = []
    for roll, body, start in zip(
        pair.place.contact_rolls, (gear_pair.pinion, gear_pair.wheel), gear_pair.sap_roll_angles
    ):
        shares.append((roll - start) / (body.tip_roll_angle - start))
    return np.full(len(pair.offsets), all(0.27 < share < 0.73 for share in shares))


def test_teeth_without_a_curve_have_the_mean_of_the_measured_ones(paper_pair, tmp_path):
    """ISO 1328-1: the slope of a straight curve is its rise over the active profile, nothing is left for its form."""
    text = curve(
        (1, 5), places_of(paper_pair, 0, "roll_length (mm)"), lambda tooth, at: (4.0 if tooth == 1 else -2.0) * at
    )
    found, true = flank_deviations(measured(tmp_path, text), paper_pair)
    slope, form = slope_and_form(found)
    assert slope == pytest.approx([4e-3, 1e-3, 1e-3, 1e-3, -2e-3, *[1e-3] * 11], abs=1e-12)
    assert form == pytest.approx(0.0, abs=1e-12) and found.curves.mean(axis=1) == pytest.approx(0.0, abs=1e-15)
    assert true.curves is None and not found.slope.any()


def relieved(at):
    return -40.0 * max(at - 0.7, 0.0)


def test_a_tooth_with_relief_stands_where_the_others_do(paper_pair, tmp_path):
    """The V cylinder of ISO 21771, of diameter d + 2 x m, is below the relief."""
    text = curve(
        (1, 2),
        places_of(paper_pair, 0, "diameter (mm)"),
        lambda tooth, at: 5.0 + (relieved(at) if tooth == 1 else 0.0),
        "diameter (mm)",
    )
    found = flank_deviations(measured(tmp_path, text, anchor=REFERENCE_POINT), paper_pair)[0]
    start, end = found.active_profile
    share = (np.sqrt(((36.0 + 0.196 * 4.5) / paper_pair.pinion.base_radius) ** 2 - 1.0) - start) / (end - start)
    below = np.linspace(0.0, 1.0, 201) < 0.6
    assert 0.3 < share < 0.6 and np.abs(found.curves[:, below]).max() < 1e-15
    assert found.curves[:2, -1] == pytest.approx([-12e-3, 0.0], abs=1e-15)
    mean = flank_deviations(measured(tmp_path, text), paper_pair)[0]
    assert mean.curves[0, 60] == pytest.approx(40e-3 * 0.5 * 0.3**2, rel=2e-3)


def test_measured_helices_are_the_deviations_they_show(paper_pair, tmp_path):
    """ISO 1328-1: the slope of a straight helix is its rise over the face width, its mean taken off."""
    width = paper_pair.face_widths[0]
    text = curve((3,), np.linspace(-0.5 * width, 0.5 * width, 50), lambda tooth, at: 6.0 * at, "face_position (mm)")
    found = flank_deviations(measured(tmp_path, text, name="helix_curves"), paper_pair, (0.0, 0.0))[0].helix
    assert slope_and_form(found)[0] == pytest.approx(6e-3, rel=1e-12) and found.curves[0, [0, -1]] == pytest.approx(
        [-3e-3, 3e-3], rel=1e-12
    )


def scene_with(tmp_path, text, more="", name="profile_curves", face=""):
    (tmp_path / "curves.csv").write_text(text)
    (tmp_path / "pair.toml").write_text(
        f'{text_of("tooth_elasticity")}{face}\n[flank_errors.pinion]\n{name} = "curves.csv"\n{more}\n'
    )
    return checked_model(tmp_path / "pair.toml").scene


POINTS = "tooth, roll_length (mm), deviation (um)\n" + "".join(f"1, {place}, 0.5\n" for place in range(3, 24))
WRONG = {
    "no deviation": (
        POINTS.replace("deviation (um)", "roll_angle (deg)"),
        ["has no column deviation", "tooth, roll_length (mm), deviation (um)"],
    ),
    "no place": ("tooth, deviation (um)\n1, 2\n", ["no column that says where a point lies"]),
    "two places": (
        "tooth, roll_length (mm), diameter (mm), deviation (um)\n1, 5, 70, 1\n",
        ["more than one such column"],
    ),
    "a wrong unit": (POINTS.replace("(mm)", "(deg)"), ['roll_length in "deg", which is no unit of length']),
    "a point twice": (POINTS + "1, 5, 0.5\n", ["curves.csv:23: has a second point of tooth 1 at the same roll_length"]),
    "two points": ("\n".join(POINTS.splitlines()[:3]), ["has 2 points of tooth 1. Allowed: at least 3"]),
    "a tooth too many": (POINTS.replace("\n1,", "\n17,"), ["has a curve of tooth 17, but the pinion has 16 teeth"]),
    "half a profile": (
        "\n".join(POINTS.splitlines()[:9]),
        ["% of the active profile of tooth 1. Allowed: at least 80 %"],
    ),
    "millimetres for micrometres": (
        POINTS.replace("(um)", "(mm)").replace("0.5", "0.6"),
        ["has a deviation of 0.6 mm on tooth 1, too large for a module of 4.5 mm"],
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_curves_are_refused(tmp_path, name):
    """Field, file, line where there is one, what is allowed; nothing is computed."""
    text, said = WRONG[name]
    with pytest.raises(SceneError) as refused:
        scene_with(tmp_path, text)
    for words in ('flank_errors.pinion.profile_curves = "curves.csv": ', "Nothing was computed or written.", *said):
        assert words in str(refused.value)
