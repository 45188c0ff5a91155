"""Relief towards tip and root, crowning and slope of the profile."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest
from tests.effects.examples import BASE, EXAMPLES
from tests.effects.hats import hat_mean

from fenics_gears import GeometryError, SceneError, scene_from_text
from fenics_gears.contact.flank_at_height import roll_angle_at_height
from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.tooth_pair import Flanks
from fenics_gears.contact.window import ContactGrid
from fenics_gears.effects.root_relief import RootRelief
from fenics_gears.effects.tip_relief import TipRelief
from fenics_gears.geometry.involute import flank_point
from fenics_gears.geometry.profile_modification import ProfileModification, ProfileModifications, profile_curves
from fenics_gears.geometry.relief import LINEAR, PARABOLIC, Relief, root_reliefs, tip_reliefs
from fenics_gears.inputs.allowed import Measured
from fenics_gears.model.modification import removals

DEPTH = 0.02
KINDS = {"tip_relief": (TipRelief, tip_reliefs), "root_relief": (RootRelief, root_reliefs)}


@pytest.mark.parametrize("section", KINDS)
def test_relief_runs_from_single_contact_to_the_end_of_the_flank(paper_pair, section):
    """Definition: nothing before HPSTC (LPSTC), the depth at the tip (form circle)."""
    (kind, curves), fractions = KINDS[section], np.array([-1.0, 0.0, 0.25, 0.5, 1.0])
    point, end = ("hpstc", "tip") if section == "tip_relief" else ("lpstc", "form")
    gears = tuple(zip((paper_pair.pinion, paper_pair.wheel), getattr(paper_pair, f"{point}_roll_angles")))
    for shape, power in ((LINEAR, 1), (PARABOLIC, 2)):
        reliefs = Relief(DEPTH, shape=shape), Relief(2.0 * DEPTH, shape=shape)
        for curve, (gear, start), relief in zip(curves(paper_pair, kind(*reliefs)), gears, reliefs):
            rolls = start + fractions * (getattr(gear, f"{end}_roll_angle") - start)
            assert curve(rolls) == pytest.approx(relief.depth * np.maximum(fractions, 0.0) ** power, abs=1e-16)


@pytest.mark.parametrize("section", KINDS)
def test_a_start_may_be_a_roll_angle_or_a_diameter(paper_pair, section):
    """Identity: r = rb sqrt(1 + v^2)."""
    kind, curves = KINDS[section]
    roll = radians(22.0)
    diameter = 2.0 * float(paper_pair.pinion.radius(roll))
    by_roll, none = curves(paper_pair, kind(Relief(DEPTH, roll), None))
    assert none is None
    by_diameter, wheel = curves(paper_pair, kind(Relief(DEPTH, Measured(diameter, "a length")), Relief(DEPTH, 0.4)))
    assert by_diameter.start_roll_angle == pytest.approx(by_roll.start_roll_angle, rel=1e-14)
    assert wheel.start_roll_angle == 0.4
    end = paper_pair.pinion.tip_roll_angle if section == "tip_relief" else paper_pair.pinion.form_roll_angle
    assert by_roll.end_roll_angle == end


@pytest.mark.parametrize("section", KINDS)
def test_a_start_may_be_a_length_from_the_end(paper_pair, section):
    """Identities: the path is rb v long; the arc is the integral of |dr|, by a fine polygon."""
    kind, curves = KINDS[section]
    for fields in ({"length_on_path": 3.0}, {"length_on_flank": 1.5}):
        for curve, gear in zip(
            curves(paper_pair, kind(Relief(DEPTH, None, **fields), Relief(DEPTH, None, **fields))),
            (paper_pair.pinion, paper_pair.wheel),
        ):
            rolls = np.linspace(*sorted((curve.start_roll_angle, curve.end_roll_angle)), 4001)
            assert curve.end_roll_angle == (gear.tip_roll_angle if section == "tip_relief" else gear.form_roll_angle)
            if "length_on_path" in fields:
                assert gear.base_radius * (rolls[-1] - rolls[0]) == pytest.approx(3.0, rel=1e-12)
            else:
                points = gear.base_radius * np.exp(1j * rolls) * (1.0 - 1j * rolls)
                assert np.abs(np.diff(points)).sum() == pytest.approx(1.5, rel=1e-6)


@pytest.mark.parametrize(
    ("field", "words"), [("length_on_path", "on the path of contact"), ("length_on_flank", "along the flank")]
)
def test_a_relief_longer_than_the_flank_is_refused(paper_pair, field, words):
    """What, which gear, the value, what is allowed, the field."""
    with pytest.raises(GeometryError) as refused:
        tip_reliefs(paper_pair, TipRelief(None, Relief(DEPTH, None, **{field: 40.0})))
    for said in ("wheel: ", f"starts at 40 mm from the tip {words}", f"change tip_relief.wheel.{field}"):
        assert said in str(refused.value)


@pytest.mark.parametrize(("section", "word"), [("tip_relief", "HPSTC"), ("root_relief", "LPSTC")])
def test_a_gears_own_growth_goes_before_that_of_both(paper_scene, section, word):
    """docs/scene.md; shape and exponent say the same."""
    text = f'[{section}]\ndepth = "20 um"\nstart = "{word}"\nexponent = 1.5\n[{section}.wheel]\nshape = "parabolic"\n'
    found = getattr(scene_from_text(f"{paper_scene.text}\n{text}"), section)
    assert (found.pinion.power, found.wheel.power) == (1.5, 2)


@pytest.mark.parametrize(("section", "word"), [("tip_relief", "HPSTC"), ("root_relief", "LPSTC")])
def test_a_start_means_one_place(paper_scene, section, word):
    """Definition: a diameter belongs to one gear, lengths and roll angles to both."""
    depth, diameter = f'[{section}]\ndepth = "20 um"\n', 'start = "80 mm"\n'

    def relief(text, scene=paper_scene.text):
        return getattr(scene_from_text(f"{scene}\n{text}\n"), section)

    with pytest.raises(
        SceneError,
        match=(
            rf'{section}.start = "80 mm"\n.*is a diameter, which is another place of either gear.*\[{section}.pinion\]'
        ),
    ):
        relief(depth + diameter)
    with pytest.raises(
        SceneError, match="is given together with start; allowed is one of start, length_on_path, length_on_flank"
    ):
        relief(f'{depth}start = "{word}"\nlength_on_path = "3 mm"')
    with pytest.raises(SceneError, match=f'{section}.start\n *is missing. Allowed: such as "{word}".*length_on_flank'):
        relief(depth)
    assert relief(f'{depth}length_on_path = "3 mm"').wheel == Relief(0.02, None, length_on_path=3.0)
    mixed = relief(f'{depth}length_on_path = "3 mm"\n[{section}.wheel]\nstart = "110 mm"')
    assert mixed.pinion == Relief(0.02, None, length_on_path=3.0) and mixed.wheel == Relief(
        0.02, Measured(110.0, "a length")
    )
    # One gear alone takes the diameter, or both are alike.
    assert relief(f'[{section}]\n{diameter}[{section}.pinion]\ndepth = "20 um"').pinion == Relief(
        0.02, Measured(80.0, "a length")
    )
    pinion = paper_scene.text.partition("[gears.pinion]\n")[2].partition("[gears.wheel]")[0]
    wheel = paper_scene.text.partition("[gears.wheel]\n")[2].partition("[gears.material]")[0]
    assert relief(depth + diameter, paper_scene.text.replace(wheel, pinion)).wheel == Relief(
        0.02, Measured(80.0, "a length")
    )


@pytest.mark.parametrize("section", KINDS)
def test_gaps_open_by_the_removal_there(paper_scene, paper_pair, stand_in_flanks, section):
    """Finite differences: the removal averaged over the node's hat, by adaptive quadrature, to 3e-3 of the relief
    that one cell has."""
    change = 1e-6
    scenes = [
        replace(paper_scene, **{section: KINDS[section][0](Relief(DEPTH + sign * change, None), None)})
        for sign in (1, -1)
    ]
    curve, radius = removals(scenes[0], paper_pair)[0], paper_pair.pinion.base_radius
    grid, relieved = ContactGrid(1.5, 20), 0
    for step in (1, 14):
        both = [_operator(paper_pair, stand_in_flanks, scene, grid, step) for scene in scenes]
        derivative, start = (both[0].gap - both[1].gap) / (2.0 * change), 0
        for pair in both[0].pairs:
            own = derivative[start : start + len(pair.offsets)]
            start += len(own)

            def removed(offset):
                return (
                    float(curve(roll_angle_at_height(radius, pair.place.contact_rolls[0], radius - offset)))
                    / curve.depth
                )

            kink = radius - flank_point(radius, curve.start_roll_angle, pair.place.contact_rolls[0])[1]
            for j, value in enumerate(own):
                expected = hat_mean(pair.offsets, j, removed, [kink])
                assert value == pytest.approx(expected, abs=1e-4)
                assert (value == 0.0) or expected > 0.0
                relieved += expected > 0.05
    assert relieved > 5


def _operator(pair, flanks, scene, grid, step):
    flanks = Flanks(pair, flanks.compliance, removals(scene, pair))
    return Cycle(elastic_mesh(flanks, grid), 20, [5], tangential=False).position(step).operator


@pytest.mark.parametrize(
    ("relief", "said"),
    [
        (Relief(0.01, radians(41.0)), ["41 deg", "40.19 deg (tip)", "tip_relief.pinion.start"]),
        (Relief(0.01, radians(2.0)), ["2 deg", "2.904 deg (form circle)", "tip_relief.pinion.start"]),
        (Relief(-0.01, None), ["tip_relief", "-0.01 mm"]),
        (Relief(float("nan"), None), ["tip_relief", "nan"]),
    ],
)
def test_relief_off_the_flank_is_refused(paper_pair, relief, said):
    """What, which gear, the value, what is allowed, the field."""
    with pytest.raises(GeometryError) as refused:
        tip_reliefs(paper_pair, TipRelief(relief, None))
    assert str(refused.value).startswith("pinion: tip")
    for part in said:
        assert part in str(refused.value)


ELASTIC = BASE + EXAMPLES["tooth_elasticity"]


def test_curves_are_what_the_fields_say(paper_pair):
    """Definition: crowning at both ends, slope at the tip; nothing is ever added."""
    start, end = paper_pair.sap_roll_angles[1], paper_pair.wheel.tip_roll_angle
    places = np.array([start, 0.5 * (start + end), end])
    for modification, removed in (
        (ProfileModification(0.004, 0.0), [0.004, 0.0, 0.004]), (ProfileModification(-0.004, 0.0), [0.0, 0.004, 0.0]),
        (ProfileModification(0.0, 0.005), [0.0, 0.0025, 0.005]),
        (ProfileModification(0.0, -0.005), [0.005, 0.0025, 0.0]),
    ):  # fmt: skip
        pinion, wheel = profile_curves(paper_pair, ProfileModifications(None, modification))
        assert pinion is None and wheel(places) == pytest.approx(np.array(removed), abs=1e-15)
        assert (wheel(np.linspace(start - 0.2, end + 0.2)) >= 0.0).all()


def test_exponents_of_one_and_two_are_the_shapes(paper_pair):
    """Identity; an exponent of 1.5 lies between them."""
    rolls = np.linspace(paper_pair.hpstc_roll_angles[0], paper_pair.pinion.tip_roll_angle, 20)

    def removed(**how):
        return tip_reliefs(paper_pair, TipRelief(Relief(0.02, None, **how), None))[0](rolls)

    assert np.array_equal(removed(exponent=1.0), removed(shape=LINEAR)) and np.array_equal(
        removed(exponent=2.0), removed(shape=PARABOLIC)
    )
    assert (removed(exponent=2.0) <= removed(exponent=1.5)).all() and (
        removed(exponent=1.5) <= removed(exponent=1.0)
    ).all()


@pytest.mark.parametrize(
    ("section", "words"),
    [
        ("[profile_modifications]\n", "modifies neither gear"),
        ("[profile_modifications.pinion]\n", "names no modification. Add crowning or slope"),
        ('[profile_modifications.wheel]\nslope = "1 mm"\n', "is too large an error of manufacture"),
        ('[tip_relief]\ndepth = "20 um"\nstart = "HPSTC"\nshape = "linear"\nexponent = 1.5\n', "together with shape"),
    ],
)
def test_wrong_modifications_are_refused(section, words):
    """docs/scene.md."""
    with pytest.raises(SceneError, match=words):
        scene_from_text(ELASTIC + section)
