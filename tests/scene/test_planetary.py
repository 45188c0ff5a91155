"""Planetary sets as scenes: what is read, and mistakes, told before anything is computed."""

import pytest
from tests.planets import in_time_text, planetary, planetary_text

from fenics_gears import GearsError, train_from_text
from fenics_gears.model.train import train_model_of

THIN = planetary_text().replace('"272 mm", support = "held"', '"236 mm"')

CARRIER = "[stages.set.carrier]\n"
LUMPED = '{ mass = "2 kg", moment_of_inertia = "1e-3 kg m^2", support_stiffness = "1e5 N/mm" }'
VIBRATION = f"""[stages.set.vibration]
sun = {LUMPED}
ring = {LUMPED}
carrier = {LUMPED}
planet = {{ mass = "2 kg", moment_of_inertia = "1e-3 kg m^2" }}"""

PINS = 'carrier = { pin_stiffness = "3e5 N/mm" }'
IN_TIME = planetary_text((20, 16, 52), "planets = 3", more=f"{PINS}\n{VIBRATION}", sections="[inertia]").replace(
    'support_stiffness = "1e5 N/mm"', 'support_stiffness = "1e5 N/mm", torsional_stiffness = "0 N mm/rad"', 1
)
# Of the third member.
IN_TIME = f"{IN_TIME.replace('[inertia]', '')}\n[inertia]\n".replace(
    f"carrier = {LUMPED}", f'{f"carrier = {LUMPED}"[:-2]}, torsional_stiffness = "1e9 N mm/rad" }}'
)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (planetary_text(planets="planets = 3"), "cannot be assembled: planet 3 would stand 0.3333 pitches beside"),
        (planetary_text(planets="planets = 3"), '2, 5 planets can.* = ."0 deg", "118.28571 deg", "241.7'),
        (planetary_text(planets='planet_angles = ["0 deg", "100 deg"]'), "planet 2 would stand 0.4444 pitches beside"),
        (planetary_text(teeth=(20, 40, 100), planets="planets = 5"), "planets 1 and 2 touch: .* up to 4 planets"),
        (planetary_text(teeth=(17, 18, 54)), "the planets do not fit: their centres are 70 mm .* 72 mm"),
        (planetary_text(parts=("ring", "ring", "carrier")), 'input = "ring"\n.*is the member that is fixed too'),
        (planetary_text(parts=("ring", "sun", "ring")), 'output = "ring"\n.*is the member that is fixed too'),
        (planetary_text(parts=("ring", "sun", "sun")), "is the member that is the input too. .* Left: carrier"),
        (planetary_text(parts=("rings", "sun", "carrier")), 'Did you mean "ring"'),
        (planetary_text().replace('fixed = "ring"', ""), "set.fixed\n.*no member is held"),
        (planetary_text().replace('input = "sun"', ""), "set.input\n.*no member is driven"),
        (planetary_text(planets=""), "a number of planets, equally spaced; or planet_angles"),
        (planetary_text(planets="planets = 2\nplanet_angles = []"), "planet_angles"),
        (planetary_text(more='floating = ["sun"]'), "floating.*\n.*needs three planets"),
        (planetary_text((20, 16, 52), "planets = 3", more='floating = ["sun", "ring"]'), "floating.*\n.*planets roll"),
        (planetary_text(more='floating = ["carrier"]'), '"carrier", which is none of them'),
        (planetary_text(more='carrier = { pin_errors = ["1 um"] }'), "has 1 entries for 2 planets"),
        (planetary_text(more='carrier = { pins = "1 um" }'), "carrier.pins.*\n.*not known here"),
        (planetary_text(more='carrier = { bearing_stiffness = "1 N/mm" }'), "bearing_stiffness.*\n.*needs springs"),
        (
            planetary_text(more='carrier = { pin_stiffness = "1e5 N/mm", bearing_stiffness = "0 N/mm" }'),
            "bearing_stiffness = 0 N/mm.*\n.*takes three planets, sun and ring held",
        ),
        (
            planetary_text(
                more='helix_angle = "9 deg"',
                sections=f'{CARRIER}pin_stiffness = "1 N/mm"\nbearing_stiffness = "1 N/mm"',
            ),
            "set.carrier: stiffness and bearing_stiffness are not computed over the face",
        ),
        (planetary_text(more='carrier = { stiffness = "none.txt" }'), "set.carrier.stiffness = .*none.txt"),
        (planetary_text(more="eccentricity = {}"), r"eccentricity.*\n.*says of no gear that it runs out"),
        (planetary_text(more='eccentricity = { planets = { distance = ["1 um"] } }'), "has 1 entries for 2 planets"),
        (planetary_text(more='eccentricity = { planets = { phase = ["1 deg"] } }'), "planets.distance.*\n.*is missing"),
        (planetary_text(more='eccentricity = { sun = { distance = "-1 um" } }'), "sun.distance.*\n.*0 mm to 10 mm"),
        (planetary_text(more='eccentricity = { sun = { phase = "9 deg" } }'), "sun.distance.*\n.*is missing"),
        (planetary_text(more='eccentricity = { carrier = {} }'), "eccentricity.carrier.*\n.*not known here"),
        (
            planetary_text(more='pitch_errors = { step = ["1 um"] }'),
            "pitch_errors.step .*not known here. Known: sun, planets, ring",
        ),
        (planetary_text((20, 16, 52), "planets = 6"), "tip circles of 72 mm meet, without room .* up to 4 planets"),
        (
            planetary_text((17, 20, 52), "planets = 3", step=15),
            "planet 3 would need its gears turned against each other by 2 deg more",
        ),
        (planetary_text((17, 20, 53), step=15), "centres are 74 mm .* 76 mm .* z_ring - z_step"),
        (
            planetary_text((20, 20, 20), step=20, second="second_sun", parts=("second_sun", "sun", "carrier")),
            "both suns turn alike, whatever the carrier does: z_sun z_step = z_second_sun z_planet = 400",
        ),
        (planetary_text(second="second_sun"), "set.step\n.*meshes with a second gear of each planet"),
        (planetary_text(more="second_sun = { teeth = 30 }"), "stands beside a ring.*Ravigneaux"),
        (planetary_text((20, 24, 26), step=18, second="second_sun"), 'fixed = "ring"\n.*is no member of this set'),
        (planetary_text(more='step_angle = "1 deg"'), "step_angle.*\n.*is of stepped planets"),
        (planetary_text(step=18, more='helix_angle = "9 deg"'), "helix_angle.*\n.*not computed with stepped"),
        (planetary_text(more='ring_mesh = { module = "3 mm" }'), "ring_mesh.module.*\n.*is not computed in a mesh"),
        (planetary_text(more="planet_count = 3"), "planet_count = 3\n.*Did you mean"),
        (planetary_text().replace("sun = {", "suns = {"), 'suns.*\n.*Did you mean "sun"'),
        (planetary_text().replace("teeth = 18", "teet = 18"), r"set.planet.teet"),
        (planetary_text(more='tip_relief = { depth = "9 um", start = "HPSTC" }'), r"\[stages.set.sun_mesh\]"),
        (planetary_text(more="sun_mesh = { coast_flanks = {} }"), "sun_mesh.coast_flanks.*is not computed in a mesh"),
        (planetary_text(sections='[inertia]\ndensity = "7.8 g/cm^3"'), r"density.*\n.*masses are in \[stages.NAME.vib"),
        (planetary_text(sections="[inertia]"), r"set.vibration\n.*is missing, which \[inertia\] needs"),
        (planetary_text(sections="[damping]\nratio = 0.1"), r"damping.*\n.*needs the section \[inertia\]"),
        (IN_TIME, "vibration.carrier.support_stiffness.*\n.*not computed with .inertia. yet"),
        (IN_TIME, "carrier.torsional_stiffness.*\n.*would take the torque of the output"),
        (IN_TIME, "sun.torsional_stiffness.*\n.*lets a member turn that is to stand"),
        (IN_TIME, r"motion.mesh_cycles\n.*is missing, which \[inertia\] needs"),
        (in_time_text(parts=("ring", "carrier", "sun")), r"inertia where the ring drives .*without \[inertia\]"),
        (in_time_text(more='helix_angle = "20 deg"'), r"not computed yet of a planetary set over the face"),
        (planetary_text(more=VIBRATION), r"set.carrier.pin_stiffness.*\n.*natural frequencies need the spring"),
        (planetary_text(more=VIBRATION.replace("mass", "weight", 1)), r"vibration.sun.weight"),
        (
            planetary_text((20, 16, 52), "planets = 3", more=f'floating = ["sun"]\n{VIBRATION}'),
            r"vibration.sun.support_stiffness.*\n.*is floating",
        ),
        (planetary_text(sections="[bearings]\n"), r"bearings.*\n.*pin_stiffness"),
        ("joins = []" + planetary_text(), "joins.*\n.*is not of a train"),
        (planetary_text(sections='[stages.other]\nkind = "row"'), r"other.gears.*\n.*not the gears of a row"),
        (planetary_text(load='power = "1 kW"'), "load.power.*\n.*needs a speed"),
        (planetary_text(load='torque = "1 N m"'), "load"),
        (
            planetary_text(parts=("ring", "carrier", "sun"), sections="[friction]\ncoefficient = 0.05"),
            "friction where the ring drives",
        ),
        (THIN, r"ring: thin rim: free between three planets .*stages.set.ring.support = .held."),
        (planetary_text().replace("teeth = 18", "teeth = 18, face_width = \"30 mm\""), "not equally wide"),
    ],
)  # fmt: skip
def test_mistakes_are_told(text, said):
    """Each says where it is and what is allowed, in words of the set."""
    with pytest.raises(GearsError, match=f"(?s){said}") as told:
        train_model_of(train_from_text(text))
    words = str(told.value)
    assert "computed or written" in words
    assert "pinion" not in words
    assert "wheel" not in words


def test_planets_at_angles_are_where_equal_ones_are():
    """The same set by both ways; angles within a thousandth of a pitch."""
    one = planetary(planets="planets = 2").shafts.carrier.set
    other = planetary(planets='planet_angles = ["10 deg", "190.001 deg"]').shafts.carrier.set
    assert one == other


def test_loads_of_input_and_output_are_one():
    """Of the ring fixed the carrier has 1 + z_r/z_s times the sun's torque, and the speed over it."""
    given = planetary(load='input_torque = "100 N m"')
    ratio = 1.0 + 53.0 / 17.0
    by_output = planetary(load=f'output_torque = "{100.0 * ratio!r} N m"')
    by_power = planetary(load='power = "1 kW"', sections='[motion]\ninput_speed = "1000 rpm"')
    assert given.output_torque == pytest.approx(100e3 * ratio)
    assert by_output.input_torque == pytest.approx(100e3)
    assert by_power.input_torque == pytest.approx(1e6 / (1000.0 * 2.0 * 3.141592653589793 / 60.0))
    # As the carrier sees it, the sun turns by 1 - 1/ratio of its speed.
    frequency = by_power.meshes[0].scene.motion.mesh_frequency
    assert frequency == pytest.approx(1000.0 / 60.0 * 17 * (1.0 - 1.0 / ratio))
    assert given.ratio == pytest.approx(ratio)


def test_a_set_that_the_ring_drives_says_so():
    """The carrier driven, the sun loaded: the sentence of `gears check` and of the result."""
    said = train_model_of(planetary(parts=("ring", "carrier", "sun"))).warnings
    assert any("as the carrier sees it, the ring drives" in each for each in said)
    assert not any("the ring drives" in each for each in train_model_of(planetary()).warnings)


def test_steps_hold_all_phases():
    """A mesh cycle has steps for the phases of all planets: thirds here, whatever is asked for."""
    scene = planetary(
        teeth=(17, 19, 55), planets="planets = 3", accuracy='steps_per_mesh_cycle = 20\nflank_element_size = "0.3 mm"'
    )
    row = train_model_of(scene).rows[0]
    assert row.models[0].resolution.steps_per_mesh_cycle == 21
    assert [ahead for _, ahead in row.phases[0::2]] == [0, 7, 14]
