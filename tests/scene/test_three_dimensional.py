"""Scenes that name what has no meaning in a plane."""

import re
from math import cos, radians

import pytest

from fenics_gears import GeometryError, SceneError, gear_pair, scene_from_text
from fenics_gears.commands.cli import main
from fenics_gears.geometry.lead_modification import EndRelief, LeadModification, LeadModifications
from fenics_gears.geometry.misalignment import Misalignment
from fenics_gears.model.description import effect_states
from fenics_gears.show.run import conditions

HELICAL = """
[gears]
module = "3 mm"
pressure_angle = "20 deg"
helix_angle = "15 deg"
pinion_hand = "left"
face_width = "30 mm"
[gears.pinion]
teeth = 20
profile_shift = 0.0
bore_diameter = "20 mm"
[gears.wheel]
teeth = 33
profile_shift = 0.0
bore_diameter = "30 mm"
axial_offset = "2 mm"
[gears.material]
youngs_modulus = "206 GPa"
poissons_ratio = 0.3
[load]
wheel_torque = "200 N m"
"""
LEAD = """
[lead_modifications.pinion]
crowning = "6 um"
helix_slope = "-8 um"
end_relief = { depth = "10 um", length = "4 mm" }
"""
MISALIGNED = """
[misalignment]
in_plane = "12 um"
"""
SPUR = HELICAL.replace('helix_angle = "15 deg"\npinion_hand = "left"\n', "")


def test_what_is_written_is_what_is_read():
    """The text itself, in mm and rad."""
    scene = scene_from_text(HELICAL + LEAD + MISALIGNED)
    gears = scene.gears
    assert (gears.module, gears.helix_angle, gears.pinion_hand, gears.axial_offsets) == (
        3.0,
        pytest.approx(radians(15.0)),
        "left",
        (0.0, 2.0),
    )
    assert (gears.face_width, gears.face_widths) == (28.0, (30.0, 30.0))
    assert scene.lead_modifications == LeadModifications(LeadModification(0.006, -0.008, EndRelief(0.01, 4.0)))
    assert scene.misalignment == Misalignment(0.012)
    pair = gear_pair(gears)
    assert (pair.pinion.module, pair.pinion.rack_tip_radius) == pytest.approx((3.0 / cos(radians(15.0)), 1.14))
    assert pair.pinion.dedendum == pytest.approx(3.75, abs=1e-6)


@pytest.mark.parametrize(("text", "expected"), [
    (SPUR, False), (HELICAL, True), (SPUR + LEAD, True), (SPUR + MISALIGNED, True),
    (SPUR + '[misalignment]\nout_of_plane = "0 um"\n', True),
    (SPUR + '[lead_modifications.wheel]\ncrowning = "0 um"\n', True),
    (SPUR + '[bearings]\nstiffness = "1e5 N/mm"\n', False),
])  # fmt: skip
def test_a_scene_is_three_dimensional_where_it_names_what_a_plane_has_not(text, expected):
    """The rule: amounts of zero count; an axial offset alone makes a face narrower."""
    assert scene_from_text(text).three_dimensional is expected


def accuracy(line):
    return f"[accuracy]\n{line}\n"


REFUSED = [
    (HELICAL + accuracy('element = "Q1 incompatible"'), 'accuracy.element = "Q1 incompatible"',
     ["with gears.helix_angle", 'Take "P2"']),
    (SPUR + LEAD + accuracy('condensation = "every step"'), 'accuracy.condensation = "every step"',
     ["with [lead_modifications]", 'Take "once"']),
    (SPUR + accuracy('condensation = "every step"'), 'accuracy.condensation = "every step"',
     ["of one face width without axial_offset", 'take condensation = "once"']),
    (SPUR + MISALIGNED + accuracy('model = "rigid teeth"'), 'accuracy.model = "rigid teeth"', ["with [misalignment]",
     'Take "elastic"']),
    (HELICAL + accuracy('model = "ISO 6336-1"'), 'accuracy.model = "ISO 6336-1"', ["resolved over the face"]),
    (HELICAL + '[body_meshes]\npinion = "a.msh"\n', "[body_meshes]", ["with gears.helix_angle"]),
    (SPUR + LEAD + '[body_meshes]\npinion = "a.msh"\n', "[lead_modifications]", ["with [body_meshes]"]),
    (HELICAL.replace('[gears.material]\nyoungs_modulus = "206 GPa"\npoissons_ratio = 0.3\n', ""),
     'gears.helix_angle = "15 deg"', ["needs elastic teeth", "Add [gears.material]"]),
    (HELICAL.replace('"15 deg"', '"0 deg"'), 'gears.helix_angle = "0 deg"', ["is zero",
     "For spur gears, leave it out"]),
    (HELICAL.replace('"left"', '"both"'), 'gears.pinion_hand = "both"', ["is not known", '"right", "left"']),
    (HELICAL.replace('helix_angle = "15 deg"\n', ""), "gears.helix_angle", ["is missing", "pinion_hand"]),
    (SPUR + accuracy("slices = 20"), "accuracy.slices = 20", ["three-dimensional scenes", "gears.helix_angle",
     "bearings.places"]),
    (HELICAL + accuracy("layers = 900"), "accuracy.layers = 900", ["0.0333 mm thin", "up to 500"]),
    (HELICAL.replace('"30 mm"\n[gears.p', '"0.05 mm"\n[gears.p'), 'gears.face_width = "0.05 mm"', ["less than a layer",
     "from 0.06 mm"]),
    (SPUR + LEAD.replace('"4 mm"', '"15.1 mm"'), 'lead_modifications.pinion.end_relief.length = "15.1 mm"',
     ["both ends of a face of 30 mm", "up to 15 mm"]),
    (SPUR + LEAD.replace('"4 mm"', '"31 mm", sides = "left"'), 'lead_modifications.pinion.end_relief.length = "31 mm"',
     ["the left end", "up to 30 mm"]),
    (SPUR + LEAD.replace('"6 um"', '"6 mm"'), 'lead_modifications.pinion.crowning = "6 mm"', ["up to 0.3 mm"]),
    (SPUR + MISALIGNED.replace("12 um", "2 mm"), 'misalignment.in_plane = "2 mm"', ["up to 0.3 mm"]),
    (SPUR + "[misalignment]\n", "[misalignment]", ["names no deviation"]),
    (SPUR + "[lead_modifications]\n", "[lead_modifications]", ["modifies neither gear"]),
    (SPUR + "[lead_modifications.wheel]\n", "[lead_modifications.wheel]", ["names no modification"]),
    (SPUR + '[lead_modifications.wheel]\nhelix_crowning = "3 um"\n',
     'lead_modifications.wheel.helix_crowning = "3 um"', ['Did you mean "crowning"?']),
]  # fmt: skip


@pytest.mark.parametrize(("text", "place", "fragments"), REFUSED, ids=[place for _, place, _ in REFUSED])
def test_what_cannot_be_is_refused_by_name(text, place, fragments):
    """Hard case 26: place, value, what is allowed, the remedy, and nothing else."""
    with pytest.raises(SceneError) as raised:
        scene_from_text(text, "pair")
    words = str(raised.value)
    assert f"{place}\n" in words and all(each in words for each in fragments), words
    assert "1 mistake in pair" in words, words


def test_gears_that_do_not_overlap_axially_are_refused():
    """Geometry."""
    with pytest.raises(GeometryError, match=re.escape("do not overlap axially")) as raised:
        gear_pair(scene_from_text(HELICAL.replace('"2 mm"', '"31 mm"')).gears)
    assert (
        "31 mm" in str(raised.value)
        and "gears.wheel.axial_offset" in str(raised.value)
        and "less than 30 mm" in str(raised.value)
    )


def test_check_shows_the_third_dimension(tmp_path, capsys):
    """ISO 21771: eps_beta = 28 sin(15 deg)/(3 pi) = 0.769, beta_b = 14.08 deg."""
    file = tmp_path / "pair.toml"
    file.write_text(HELICAL + LEAD + MISALIGNED)
    assert main(["check", str(file)]) == 0
    lines = {line.strip() for line in capsys.readouterr().out.splitlines()}
    shown = [" ".join(line.split()) for line in lines]
    for words in (
        "overlap ratio 0.7689", "helix angle at the reference cylinder 15 deg", "base helix angle 14.076",
        "hand of the helix pinion left, wheel right",
        "face width in common 28 mm: pinion 30 mm about -1 mm, wheel 30 mm about 1 mm",
        "flanks are resolved over the face z from -14 mm to 14 mm",
        "pinion crowning 6 um", "pinion helix slope -8 um", "pinion end relief 10 um, linear over 4 mm at both ends",
        "misalignment in plane 12 um",
    ):  # fmt: skip
        assert any(line.startswith(words) for line in shown), (words, shown)


def test_a_misalignment_of_zero_is_none():
    """Axes are parallel; the flanks are resolved over the face all the same."""
    scene = scene_from_text(SPUR + '[misalignment]\nin_plane = "0 um"\n')
    assert "misalignment" not in conditions(scene)
    (state,) = [each for each in effect_states(scene) if each.effect.section == "misalignment"]
    assert (state.on, state.words, state.adds) == (True, "parallel axes, flanks resolved over the face", "")
