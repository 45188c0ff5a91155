"""Gears and pairs that cannot be."""

import re
from dataclasses import replace
from math import nan, radians

import pytest

from fenics_gears import GeometryError, SceneError, gear_pair
from fenics_gears.geometry.pair_checks import design_warnings


def few_teeth(teeth, profile_shift):
    pitch = 4.5 * (teeth + 2.0 * profile_shift)
    circles = {"pinion.root_diameter": pitch - 11.25, "pinion.tip_diameter": pitch + 9.0, "pinion.bore_diameter": 3.0}
    return {
        "pinion.teeth": teeth,
        "pinion.profile_shift": profile_shift,
        **circles,
        "centre_distance": 4.5 * (0.5 * (teeth + 24) + profile_shift) + 1.0,
    }


IMPOSSIBLE = {
    "undercut to the middle of the tooth": (few_teeth(7, -0.8), ["pinion: undercut", "13.05 mm",
        "0.2306 mm thick at its neck", "0.1 modules", "raise gears.pinion.profile_shift to 0.3"]),
    "no involute left by undercut": (few_teeth(8, -0.3) | {"pinion.tip_diameter": 34.6}, ["pinion: no involute",
        "34.6 mm", "the fillet cuts off the involute up to 34.", "No change of gears.pinion.tip_diameter"]),
    "contact ratio by undercut": (few_teeth(8, 0.0) | {"centre_distance": 72.9}, ["pair: contact ratio 0.9",
        "shortened by the undercut pinion", "at least 1", "profile_shift"]),
    "profile shift of 1.4": (few_teeth(18, 1.4) | {"pinion.root_diameter": 82.35}, ["pinion: no dedendum", "82.35 mm",
        "lower gears.pinion.profile_shift to 1."]),
    "pointed tip": ({"wheel.tip_diameter": 127.0}, ["wheel: pointed tip", "127 mm", "gears.wheel.tip_diameter"]),
    "tip eight modules too high": ({"wheel.tip_diameter": 160.0}, ["wheel: pointed tip", "160 mm",
        "lower gears.wheel.tip_diameter to 12"]),
    "no backlash": ({"centre_distance": 91.3}, ["pair: no backlash", "91.3 mm", "91.3697", "gears.centre_distance"]),
    "contact ratio": ({"pinion.tip_diameter": 78.5, "wheel.tip_diameter": 114.0}, ["pair: contact ratio 0.8",
        "at least 1", "gears.pinion.tip_diameter"]),
    "interference on the pinion": ({"pinion.root_diameter": 64.2, "pinion.rack_tip_radius": 0.45},
        ["pinion: interference: the wheel's tip reaches its fillet", *("7.115 deg", "8.139 deg",
        "gears.wheel.tip_diameter to 117.")]),
    "tip corner in the fillet": ({"pinion.root_diameter": 63.6, "pinion.rack_tip_radius": 0.45},
        ["pinion: interference: the wheel's tip corner cuts 0.04214 mm into its fillet", "gears.wheel.tip_diameter"]),
    "tip in root": ({"wheel.tip_diameter": 120.8}, ["wheel: no tip clearance", "0.15 mm",
        "gears.pinion.root_diameter"]),
    "tip below root": ({"pinion.tip_diameter": 60.0}, ["pinion: no teeth", "60 mm", "62.5 mm",
        "gears.pinion.tip_diameter"]),
    "tip below base circle": ({"pinion.tip_diameter": 67.0}, ["pinion: no flank", "67 mm", "67.6579 mm",
        "gears.pinion.tip_diameter"]),
    "tip in the fillet": ({"wheel.tip_diameter": 102.5}, ["wheel: no involute", "102.5 mm", "102.643 mm",
        "gears.wheel.tip_diameter"]),
    "bore through the root": ({"wheel.bore_diameter": 98.0}, ["wheel: no rim", "98 mm", "96.57 mm",
        "gears.wheel.bore_diameter"]),
    "root above the pitch line": ({"pinion.root_diameter": 74.5, "pinion.tip_diameter": 90.0}, ["pinion: no dedendum",
        "74.5 mm", "72 mm", "gears.pinion.profile_shift"]),
    "root far too deep": ({"pinion.root_diameter": 52.0}, ["pinion: dedendum too deep", "2.418 modules", "2.158",
        "gears.pinion.root_diameter"]),
    "rack tip too round": ({"pinion.rack_tip_radius": 0.6}, ["pinion: fillets of neighbouring teeth overlap",
        "0.6 modules", "0.471", "gears.pinion.rack_tip_radius"]),
    "base circles overlap": ({"centre_distance": 84.0}, ["pair: centre distance 84 mm", "84.5723 mm",
        "gears.centre_distance"]),
    "not a number": ({"pinion.profile_shift": nan}, ["pinion: gears.pinion.profile_shift", "finite"]),
    "negative bore": ({"wheel.bore_diameter": -1.0}, ["wheel: gears.wheel.bore_diameter", "positive", "-1 mm"]),
    "two teeth": ({"pinion.teeth": 2}, ["pinion: 2 teeth", "at least 3", "gears.pinion.teeth"]),
    "pressure angle in degrees": ({"pressure_angle": 20.0}, ["gears.pressure_angle", "between 0 and 45 deg"]),
    "no face": ({"face_width": 0.0}, ["pair: gears.face_width", "positive"]),
    "negative rack tip radius": ({"wheel.rack_tip_radius": -0.1}, ["wheel: gears.wheel.rack_tip_radius", "-0.1"]),
}  # fmt: skip


def changed(data, changes):
    for path, value in changes.items():
        if "." in path:
            gear, field = path.split(".")
            data = replace(data, **{gear: replace(getattr(data, gear), **{field: value})})
        else:
            data = replace(data, **{path: value})
    return data


@pytest.mark.parametrize("name", IMPOSSIBLE)
def test_impossible_gears_are_named_as_what_they_are(paper_data, name):
    """House rule: what, which gear, the value, the limit, the field."""
    changes, said = IMPOSSIBLE[name]
    with pytest.raises(GeometryError) as refused:
        gear_pair(changed(paper_data, changes))
    assert isinstance(refused.value, SceneError) and refused.value.exit_code == 2
    for part in said:
        assert part in str(refused.value)


def test_interference_on_the_wheel_is_that_of_swapped_gears(paper_data):
    """Symmetry."""
    shallow = replace(paper_data.pinion, root_diameter=64.2, rack_tip_radius=0.45)
    with pytest.raises(GeometryError) as refused:
        gear_pair(replace(paper_data, pinion=paper_data.wheel, wheel=shallow))
    for part in (
        "wheel: interference: the pinion's tip reaches its fillet",
        "7.115 deg",
        "gears.pinion.tip_diameter to 117.",
    ):
        assert part in str(refused.value)


def test_the_remedies_given_are_the_limits(paper_data):
    """Just beyond the named limit the pair is accepted, just short of it refused."""
    with pytest.raises(GeometryError, match="no backlash"):
        gear_pair(replace(paper_data, centre_distance=91.3685))
    assert gear_pair(replace(paper_data, centre_distance=91.36970)).backlash < 1e-5
    shallow = changed(paper_data, {"pinion.root_diameter": 64.2, "pinion.rack_tip_radius": 0.45})
    with pytest.raises(GeometryError, match="tip corner"):
        gear_pair(changed(shallow, {"wheel.tip_diameter": 118.018}))
    tip = 2.0 * gear_pair(paper_data).wheel.pointed_radius
    assert tip > 118.64
    with pytest.raises(GeometryError, match="pointed tip"):
        gear_pair(changed(paper_data, {"wheel.tip_diameter": tip + 1e-4}))


ADVISED = re.compile(
    r"(?:raise|lower) gears\.(?P<field>[\w.]+) to (?P<value>[\d.]+)"
    r"(?: mm)?(?: with gears\.\w+\.tip_diameter = (?P<tip>[\d.]+) mm, root_diameter = (?P<root>[\d.]+) mm and"
    r" gears\.centre_distance = (?P<distance>[\d.]+) mm)?"
)
# A pair of 20 and 8 teeth whose larger tip circles leave a contact ratio of 0.67 and whose axes cannot come nearer.
SHORT_TEETH = {
    "module": 3.0, "pressure_angle": radians(14.5), "centre_distance": 42.0,
    **{f"pinion.{name}": value for name, value in {"teeth": 8, "profile_shift": 0.0, "tip_diameter": 30.0,
       "root_diameter": 16.5, "bore_diameter": 6.0, "rack_tip_radius": 0.38}.items()},
    **{f"wheel.{name}": value for name, value in {"teeth": 20, "profile_shift": 0.0, "tip_diameter": 66.0,
       "root_diameter": 52.5, "bore_diameter": 10.0, "rack_tip_radius": 0.38}.items()},
}  # fmt: skip
TRIED = {name: changes for name, (changes, said) in IMPOSSIBLE.items() if "gears" in "".join(said)} | {
    "short teeth": SHORT_TEETH,
    "axes far apart": {"centre_distance": 108.0},
    "both tips too short": {"pinion.tip_diameter": 76.0, "wheel.tip_diameter": 111.0},
}


@pytest.mark.parametrize("name", TRIED)
def test_what_is_advised_helps(paper_data, name):
    """Followed to the letter, each advice makes a pair that can run; one that does not is not given."""
    data = changed(paper_data, TRIED[name])
    with pytest.raises(GeometryError) as refused:
        gear_pair(data)
    for advice in ADVISED.finditer(str(refused.value)):
        field = advice["field"]
        changes = {field: int(advice["value"]) if field.endswith("teeth") else float(advice["value"])}
        if advice["tip"]:
            gear = field.partition(".")[0]
            changes |= {f"{gear}.tip_diameter": float(advice["tip"]), f"{gear}.root_diameter": float(advice["root"])}
            changes["centre_distance"] = float(advice["distance"])
        assert gear_pair(changed(data, changes)).contact_ratio >= 1.0


def test_what_does_not_help_is_not_advised(paper_data):
    """Of the pair of 8 and 20 teeth only other profile shifts and more teeth; where nothing helps alone, that is
    said."""
    with pytest.raises(GeometryError) as refused:
        gear_pair(changed(paper_data, SHORT_TEETH))
    said = str(refused.value)
    assert "contact ratio 0.66" in said and "raise gears.pinion.profile_shift" in said and "gears.pinion.teeth" in said
    assert "raise gears.pinion.tip_diameter" not in said and "lower gears.centre_distance" not in said
    with pytest.raises(GeometryError, match="No change of .* alone mends it"):
        gear_pair(changed(paper_data, {"centre_distance": 191.5}))


def test_thin_tips_are_remarked_upon_not_refused(paper_data):
    """DIN 3960 / ISO 21771: at least 0.2 modules; the paper's pair has 0.6."""
    assert design_warnings(gear_pair(paper_data)) == []
    thin = gear_pair(
        changed(paper_data, {"pinion.tip_diameter": 86.0, "wheel.root_diameter": 96.0, "wheel.rack_tip_radius": 0.2})
    )
    (sentence,) = design_warnings(thin)
    assert sentence.startswith("pinion: thin tip") and "gears.pinion.tip_diameter" in sentence
