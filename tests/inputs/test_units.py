"""Units, by their definitions (SI brochure, international inch and pound)."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fenics_gears.inputs.units import AN_ANGULAR_SPEED, QuantityError, of_kind, quantity

ROUND_OFF = 4e-16


@pytest.mark.parametrize(
    ("text", "value", "kind"),
    [
        ("4.5 mm", 4.5, "a length"),
        ("4.5mm", 4.5, "a length"),
        ("0.0045 m", 4.5, "a length"),
        ("31 um", 0.031, "a length"),
        ("31 µm", 0.031, "a length"),
        ("31 μm", 0.031, "a length"),
        ("1 in", 25.4, "a length"),
        ("20 deg", math.pi / 9, "an angle"),
        ("20°", math.pi / 9, "an angle"),
        ("1200 arcmin", math.pi / 9, "an angle"),
        ("206 GPa", 206000.0, "a stress"),
        ("206e9 Pa", 206000.0, "a stress"),
        ("206e3 N/mm^2", 206000.0, "a stress"),
        ("206e3 N/mm²", 206000.0, "a stress"),
        ("437 N m", 437000.0, "a torque"),
        ("437 Nm", 437000.0, "a torque"),
        ("437 N*m", 437000.0, "a torque"),
        ("437 N·m", 437000.0, "a torque"),
        ("1 ft", 304.8, "a length"),
        ("5 mil", 0.127, "a length"),
        ("2 dm", 200.0, "a length"),
        ("1 lbf in", 4.4482216152605 * 25.4, "a torque"),
        *((f"1 {unit}", 4.4482216152605 * 25.4, "a torque") for unit in ("in-lb", "in lbf", "lb-in", "in·lb", "inlb")),
        *((f"1 {unit}", 4.4482216152605 * 304.8, "a torque") for unit in ("ft-lb", "lbf ft", "lb ft", "ft-lbf")),
        ("1 hp", 550.0 * 4.4482216152605 * 304.8, "a power"),
        ("1 PS", 75.0 * 9.80665e3, "a power"),
        ("30 ksi", 30e3 * 4.4482216152605 / 25.4**2, "a stress"),
        ("30 Mpsi", 30e6 * 4.4482216152605 / 25.4**2, "a stress"),
        ("1 lb in^2", 0.45359237e-3 * 25.4**2, "a moment of inertia"),
        ("8 1/in", 8.0 / 25.4, "a diametral pitch (1/length)"),
        ("0.203e9 N mm/rad", 2.03e8, "a torsional stiffness"),
        ("1 N mm/deg", 180 / math.pi, "a torsional stiffness"),
        ("0.155e6 N/mm", 155000.0, "a stiffness"),
        ("155 N/um", 155000.0, "a stiffness"),
        ("4.9 kg", 4.9e-3, "a mass"),
        ("4900 g", 4.9e-3, "a mass"),
        ("4.9e-3 N s^2/mm", 4.9e-3, "a mass"),
        ("24.5e-3 kg m^2", 24.5, "a moment of inertia"),
        ("24.5 N mm s^2", 24.5, "a moment of inertia"),
        ("24.5 kg mm^2", 24.5e-3, "a moment of inertia"),
        ("200 Hz", 200.0, "a frequency (1/time)"),
        ("0.5e-3 1/s", 0.5e-3, "a frequency (1/time)"),
        ("0.4 ms", 0.4e-3, "a time"),
        ("750 rpm", 25 * math.pi, "an angular speed"),
        ("12.5 rev/s", 25 * math.pi, "an angular speed"),
        ("4500 deg/s", 25 * math.pi, "an angular speed"),
        ("-3 mm", -3.0, "a length"),
        ("5", 5.0, "a number without unit"),
    ],
)
def test_a_quantity_is_what_its_unit_says(text, value, kind):
    """But for the last bit."""
    number, found = quantity(text)
    assert found == kind
    assert number == pytest.approx(value, rel=ROUND_OFF)


@pytest.mark.parametrize(
    "written", ["min^-1", "min⁻¹", "min**-1", "1/min", "1 / min", "U/min", "r/min", "rev/min", "U min^-1", "rpm"]
)
def test_revolutions_a_minute_as_data_sheets_write_them(written):
    """DIN 1301 and ISO 80000-3: a turn is 2 pi rad."""
    for blank in ("", " ") if written[0] != "1" else (" ",):
        assert of_kind(f"750{blank}{written}", AN_ANGULAR_SPEED) == (
            pytest.approx(25 * math.pi, rel=ROUND_OFF),
            AN_ANGULAR_SPEED,
        )


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("437 N m", "437 N m/rad"),
        ("200 Hz", "200 rad/s"),
        ("200 Hz", "200 rpm"),
        ("1 mm", "1 rad"),
        ("1 1/s", "1 rad/s"),
    ],
)
def test_an_angle_is_a_dimension(one, other):
    """docs/promises.md."""
    assert quantity(one)[1] != quantity(other)[1]


@pytest.mark.parametrize(
    ("text", "fragment"),
    [
        ("4.5 Mm", 'unknown unit "Mm". Did you mean "mm"?'),
        ("206 Gpa", 'unknown unit "Gpa". Did you mean "GPa"?'),
        ("4.5 furlong", 'unknown unit "furlong"'),
        ("4,5 mm", "decimal sign is a point"),
        ("mm", "does not begin with a number"),
        ("1.2.3 mm", "does not begin with a number"),
        ("", "is empty"),
        ("   ", "is empty"),
        ("20 deg 3 arcmin", "not understood"),
        ("5 mm^(", "not understood"),
        ("5 N/0", "not understood"),
        ("3 -mm-", "not understood"),
        ("3 m^99 m^99", "not understood"),
        pytest.param("3" + 5000 * " m", "not understood", id="long"),
        ("20 -3 mm", "not understood"),
        ("3 m N^", "not understood"),
        ("3 *", "not understood"),
        ("3 ()", "not understood"),
        ("5 mm; import os", "not understood"),
    ],
)
def test_what_is_no_quantity_is_named(text, fragment):
    """House rule 7."""
    with pytest.raises(QuantityError) as error:
        quantity(text)
    assert fragment in str(error.value)


@pytest.mark.parametrize(
    ("text", "kind", "hint"),
    [
        ("3 KW", "a power", ' Did you mean "kW"?'),
        ("3 kVA", "a torque", ""),
        ("3 kPs", "a length", ""),
        ("3 kgs mm^2", "a moment of inertia", ' Did you mean "kg"?'),
        ("3 N/mmm", "a stiffness", ' Did you mean "mm"?'),
    ],
)
def test_a_unit_that_is_meant_may_make_the_kind(text, kind, hint):
    """By dimensions."""
    with pytest.raises(QuantityError) as error:
        of_kind(text, kind)
    assert str(error.value).partition(".")[2] == hint


UNIT_LIKE = st.text(alphabet="0123456789.eE+-*/^() mNkgsradHzP°µ²\n[]{}'\"", max_size=20)


def test_a_pound_of_force_is_named_where_a_mass_is_given():
    """In inches and pounds a force is often written "lb", which is the unit of a mass here."""
    with pytest.raises(QuantityError, match='is a mass, not a force. A pound of force is "lbf".'):
        of_kind("30 lb", "a force")


@settings(max_examples=150, deadline=None)
@given(st.one_of(UNIT_LIKE, st.text(max_size=12), UNIT_LIKE.map(lambda text: "3 " + text)))
def test_any_text_is_a_quantity_or_is_refused(text):
    """Hard case 26."""
    try:
        number, kind = quantity(text)
    except QuantityError as error:
        assert str(error)
    else:
        assert isinstance(number, float) and kind
