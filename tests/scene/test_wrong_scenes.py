"""How each mistake is worded (hard case 26 and docs/promises.md): file, field, value, what is allowed, the nearest
known name; exit code 2, nothing written."""

import re

import pytest
from tests import paper_text
from tests.paper_text import PAPER as DEMO

from fenics_gears import SceneError, scene_from_text
from fenics_gears.commands.cli import main

UNTITLED = DEMO[DEMO.index("[gears]") :]
RELIEF = '\n[tip_relief]\ndepth = "31 um"\nstart = "HPSTC"\n'


def with_line(text, section, key, line):
    head, header, rest = text.partition(f"[{section}]\n")
    assert header, f"no section {section}"
    body, following, tail = rest.partition("\n[")
    pattern = rf"^{re.escape(key)} *=.*$"
    body = re.sub(pattern, lambda _: line, body, flags=re.M) if re.search(pattern, body, re.M) else f"{line}\n{body}"
    return head + header + body + following + tail


@pytest.fixture
def refusal(tmp_path, monkeypatch, capsys):
    """Runs a scene text and returns the refusal; fails unless that is complete and nothing was written."""
    monkeypatch.chdir(tmp_path)

    def refuse(text):
        file = tmp_path / "pair.toml"
        file.write_text(text)
        assert main(["run", "pair.toml"]) == 2
        assert [each.name for each in tmp_path.rglob("*")] == ["pair.toml"]
        output = capsys.readouterr()
        assert output.out == ""
        assert output.err.startswith("pair.toml:")
        assert "Nothing was computed or written." in output.err
        assert "Traceback" not in output.err
        return output.err

    return refuse


# (what to replace, by what, field and value in the message, further fragments)
MUTATIONS = [
    ("teeth = 16", "module = 16", "gears.pinion.module = 16", ['"module" belongs to [gears]', "teeth, profile_shift"]),
    ("teeth = 16", "friction = 0.1", "gears.pinion.friction = 0.1", ["It is a section of the scene: [friction]"]),
    ('module = "4.5 mm"', 'module = "4.5 Mm"', 'gears.module = "4.5 Mm"', ['unknown unit "Mm". Did you mean "mm"?']),
    ("teeth = 16", "teeth = -16", "gears.pinion.teeth = -16", ["internal gear (ISO 21771)", "internal gear the wheel"]),
    ("teeth = 24", "teeth = 24\ninternal = true", "gears.wheel.outer_diameter", ["is missing", "a length"]),
    ('module = "4.5 mm"', "diametral_pitch = 5", "gears.diametral_pitch = 5", ['In 1/in it is written "5 1/in"']),
    ('module = "4.5 mm"', "", "gears.module", ["or transverse_module, diametral_pitch or normal_diametral_pitch"]),
    ('module = "4.5 mm"', 'module = "4.5 mm"\ndiametral_pitch = "5 1/in"', 'gears.diametral_pitch = "5 1/in"',
     ["is given together with module"]),
    ('pressure_angle = "20 deg"', 'transverse_pressure_angle = "11 deg"\nhelix_angle = "40 deg"',
     'gears.transverse_pressure_angle = "11 deg"', ["makes pressure_angle = 8.469 deg", "from 10 deg to 35 deg"]),
    ('module = "4.5 mm"', "module = 4.5", "gears.module = 4.5", ['In mm it is written "4.5 mm"']),
    ('"437 N m"', '"-437 N m"', 'load.wheel_torque = "-437 N m"', ["is negative", "from the wheel",
     "with the section [coast_flanks] any sign"]),
    ('mesh_frequency = "200 Hz"', 'mesh_frequency = "200 rpm"', 'motion.mesh_frequency = "200 rpm"',
     ["is an angular speed", '"200 Hz"']),
    ('mesh_frequency = "200 Hz"', 'mesh_frequency = "200 Hz"\npinion_speed = "750 rpm"',
     'motion.pinion_speed = "750 rpm"', ["one of the two"]),
    ('wheel_torque = "437 N m"\n\n[motion]\nmesh_frequency = "200 Hz"',
     'power = "20 kW"\n\n[motion]\npinion_speed = "-750 rpm"', 'motion.pinion_speed = "-750 rpm"', ["1 mistake in"]),
    ("recorded_cycles = 2", "recorded_cycles = 31", "motion.recorded_cycles = 31", ["is more than mesh_cycles = 30"]),
    ("coefficient = 0.1", "coefficient = 0", "friction.coefficient = 0", ["is zero",
     "leave the section [friction] out", "up to 5"]),
    ("[inertia]", "[damping.inertia]", "[damping.inertia]", ["is not a known field of [damping]",
     "needs the section [inertia]"]),
    ('"0.4e-3 s"\nmass_proportional = "0.5e-3 1/s"', '"0 s"\nmass_proportional = "0 1/s"', "[damping]",
     ["damps nothing", "leave the section [damping] out"]),
    ('element = "P2"', 'element = "p2"', 'accuracy.element = "p2"', ['Did you mean "P2"?']),
    ('"0.08 mm"', '"5 mm"', 'accuracy.flank_element_size = "5 mm"', ["too large for a module of 4.5 mm",
     "up to 4.5 mm"]),
    ("[load]", "[[load]]", "load = a list", ["is not a section", "Write a line [load]"]),
    ("[load]\nwheel_torque", "load = 3\n[wheel]\nwheel_torque", "gears.material.load = 3",
     ["is not a known field of [gears.material]"]),
    ('title = "', 'friction = 0.3\ntitle2 = "', "friction = 0.3", ["is not a section", "[friction]"]),
    ('title = "', 'title = "' + 600 * "x", "title = ", ["is too long", "500 characters"]),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "field", "fragments"), MUTATIONS)
def test_a_wrong_scene_is_refused(refusal, old, new, field, fragments):
    """Mistakes as people make them."""
    text = DEMO
    if new.startswith("friction = "):
        text = text.replace("[friction]\ncoefficient = 0.1\n", "")
    assert old in text
    message = refusal(text.replace(old, new, 1))
    assert re.search(rf"^pair\.toml:\d+: {re.escape(field)}", message, re.M)
    for fragment in fragments:
        assert fragment in message


# (sections left out, what is appended or a pair of what is replaced by what, fragments of the message)
SECTIONS = [
    ("inertia", [], ["[damping]\n", "needs the section [inertia], which is missing", "leave [damping] out"]),
    ("", [('"once"', '"every step"'), "[coast_flanks]"], ["accuracy.condensation", "no contact on the coast flanks"]),
    ("", '[stages.one]\nkind = "row"', ["has [gears], which are those of a pair, and [stages]", "Leave one"]),
    ("", "[thermal]", ["[thermal]\n", "is not a known section", "tip_relief"]),
    ("", "[tip_relief]", ["tip_relief.depth\n", "tip_relief.start\n", "is missing", '"HPSTC"', "2 mistakes"]),
    ("", '[tip_relief]\nstart = "HPSTC"\n[tip_relief.pinion]', ["tip_relief.pinion.depth\n", "is missing"]),
    ("", '[tip_relief.wheel]\ndepth = "-1 um"\nstart = "HPSTC"', ['tip_relief.wheel.depth = "-1 um"',
     "is negative"]),
    ("", '[tip_relief.weel]\ndepth = "3 um"\nstart = "HPSTC"', ["[tip_relief.weel]\n", 'Did you mean "wheel"?']),
    ("shafts bearings", ('"0.5e-3 1/s"', '"0 1/s"'), ['damping.stiffness_proportional = "0.4e-3 s"',
     "no stiffness without [shafts] or [bearings]"]),
    ("inertia", '[inertia.pinion]\nmass = "1 kg"\nmoment_of_inertia = "1 kg m^2"', ["inertia.wheel.mass\n",
     "inertia.wheel.moment_of_inertia\n", "here or in [inertia] for both gears", 'density = "7.85 g/cm^3"']),
    ("inertia", "[inertia]", ["inertia.mass\n", "inertia.moment_of_inertia\n", "2 mistakes"]),
    ("inertia", '[inertia]\ndensity = "7.85 g/cm^3"', ["inertia.load.moment_of_inertia\n",
     "far end of the output shaft", "leave [shafts] out"]),
    ("inertia", '[inertia]\ndensity = "7.85 g/cm^3"\nmass = "1 kg"', ['inertia.density = "7.85 g/cm^3"',
     "is given together with mass, which follow"]),
    ("", '[inertia.motor]\nmoment_of_inertia = "1 kg m^2"', ["[inertia.motor]", "turns as prescribed",
     "[shafts.input]"]),
    ("shafts", '[shafts.input]\ntorsional_stiffness = "1 kN m/rad"', ["shafts.output.torsional_stiffness\n",
     "only the other shaft"]),
    ("shafts", "[shafts]", ["shafts.torsional_stiffness\n", "[shafts.input] and [shafts.output]"]),
    ("damping", "[damping]", ["damping.stiffness_proportional\n", "damping.mass_proportional\n", "ratio = 0.05"]),
    ("damping", '[damping.wheel]\nstiffness_proportional = "1 s"\nmass_proportional = "0 1/s"',
     ["damping.pinion.stiffness_proportional\n", "of [damping] for both gears"]),
    ("damping", '[damping]\nratio = 0.05\nmass_proportional = "1 1/s"', ['damping.mass_proportional = "1 1/s"',
     "is given together with ratio"]),
    ("damping", "[damping]\nratio = 0.05\nratios = [0.1]\n[damping.pinion]", ["damping.ratios", "[damping.pinion]",
     "is given together with ratio"]),
    ("damping", "[damping]\nratios = [0.1, -0.2]", ["damping.ratios", "-0.2 at place 2", "is negative"]),
    ("damping", '[damping]\nratios = ["5 %"]', ["damping.ratios", "at place 1", "is a text, not a bare number"]),
    ("damping", "[damping]\nratios = [0, 0.0]", ["damping.ratios", "damps nothing"]),
    ("gears.material", '[gears.pinion.material]\nyoungs_modulus = "100 GPa"\npoissons_ratio = 0.3',
     ["gears.wheel.material\n", "both gears are elastic or none", "[gears.material] for both"]),
    ("gears.material",
     '[gears.pinion.material]\nyoungs_modulus = "100 GPa"\n[gears.wheel.material]\npoissons_ratio = 0.3',
     ["gears.pinion.material.poissons_ratio\n", "gears.wheel.material.youngs_modulus\n", "what both gears share"]),
    ("", ('face_width = "15 mm"\n', ""), ["gears.face_width\n", "is missing",
     "face_width of [gears.pinion] and of [gears.wheel]"]),
    ("", ("[gears]", "[gears"), [":7: [gears", "is no name of a section", "[gears.pinion]"]),
    ("bearings", '[bearings.pinion]\nstiffness = "1 N/mm"\n[[bearings.pinion]]', ["[[bearings.pinion]]\n",
     "is given above, first in line", "Write [[bearings.pinion]] there too"]),
    ("", ('module = "4.5 mm"', 'module = "3 N m"\nhelix_angle = "10 deg"'), ["is a torque", "1 mistake"]),
    ("", "[friction]\ncoefficient = 0.2", [":68: [friction]", "[friction] is there twice, first in line"]),
    ("", ('module = "4.5 mm"', "module = 4.5 mm"), [":8: module = 4.5 mm\n", 'lacks quotes', 'module = "4.5 mm"']),
    ("", ('module = "4.5 mm"', "module = “4.5 mm”"), [":8: module = ", "typographic quotes"]),
    ("", ('module = "4.5 mm"', "module = '4.5 mm"), [":8: module = ", "quotes that do not end"]),
    ("", ('module = "4.5 mm"', 'module = "4.5 mm'), [":8: module = ", "quotes that do not end"]),
    ("", ('module = "4.5 mm"', 'module = "4.5 mm",'), [":8: module = ", "has , behind the value"]),
    ("", ('module = "4.5 mm"', 'module: "4.5 mm"'), [":8: module: ", "has no = between"]),
    ("", ('module = "4.5 mm"', "module ="), [":8: module =", "has no value"]),
    ("", ('module = "4.5 mm"', 'module = "4.5 mm"\nmodule = "5 mm"'), [":9: module", "given twice, first in line 8"]),
    ("", ("profile_shift = 0.196", "profile_shift = .196"), ["profile_shift = .196\n", "is no number", "0.5"]),
    ("", ("[output]\nroot_stress = True"), ["root_stress = True\n", "is written true"]),
    ("", ("mesh_cycles = 30", "mesh_cycles = [30"), ["] or } is missing"]),
    ("", ('[load]\nwheel_torque = "437 N m"', ""), ["[load] with its fields: wheel_torque or pinion_torque or power"]),
    ("", "[" + ".".join(20 * "x") + "]", ["[x.x.x", "is nested too deeply", "Allowed: 12 tables"]),
    ("", ("teeth = 16", "teeth = " + 5000 * "9"), ["is not valid TOML", "thousands of digits"]),
    ("", (DEMO, "a = " + 3000 * "[" + 3000 * "]"), ["pair.toml"]),
    ("", (DEMO, ""), ["gears\n", "load\n", "2 mistakes"]),
    ("", ("flank_element_size", 'body_element_size = "50 um"\nflank_element_size'),
     ['accuracy.body_element_size = "50 um"', "is smaller than flank_element_size", "from that size on"]),
    ("", [("mesh_cycles = 30", 'settling_time = "0.1 s"'), '[speed_ramp]\nend_frequency = "300 Hz"'],
     ["motion.settling_time", "is for a steady speed", "mesh_cycles, the length of the whole ramp"]),
    ("inertia damping", ("mesh_cycles = 30", 'settling_time = "0.1 s"'), ["motion.settling_time",
     "is for scenes with [inertia]"]),
    ("", '[output]\ncontact_fields = "last 2 cycles"', ["output.contact_fields",
     "is given together with motion.recorded_cycles", "Leave one of the two out"]),
    ("", [("recorded_cycles = 2", ""), '[output]\ncontact_fields = "last 40 cycles"'], ["output.contact_fields",
     "is more than motion.mesh_cycles = 30"]),
    ("inertia damping shafts bearings", [('wheel_torque = "437 N m"', 'power = "1 kW"'),
     ('mesh_frequency = "200 Hz"', "")], ["load.power", "needs a speed",
     "motion.pinion_speed"]),
    ("", ('mesh_frequency = "200 Hz"', ""), ["motion.mesh_frequency\n", "is missing", "[inertia] needs one",
     '"750 rpm"', "1 mistake"]),
    ("", ("mesh_cycles = 30", ""), ["motion.mesh_cycles\n", "is missing", "[inertia] needs it",
     "hunting tooth period", "1 mistake"]),
]  # fmt: skip


@pytest.mark.parametrize(("left_out", "change", "fragments"), SECTIONS)
def test_sections_that_do_not_fit_are_refused(refusal, left_out, change, fragments):
    """Needs, effects that exclude one another, incomplete sections, broken TOML."""
    text = paper_text.without(DEMO, *left_out.split())
    for each in change if isinstance(change, list) else [change]:
        if isinstance(each, tuple):
            assert each[0] in text
            text = text.replace(*each)
        else:
            text = f"{text}\n{each}\n"
    message = refusal(text)
    for fragment in fragments:
        assert fragment in message


def test_every_mistake_is_named_at_once(refusal):
    """A person corrects a file once."""
    text = paper_text.without(DEMO + RELIEF, "inertia")
    for section, key, value in [
        ("gears", "module", "4.5"),
        ("gears.pinion", "teeth", "true"),
        ("load", "wheel_torque", '"-1 N m"'),
        ("motion", "recorded_cycles", "40"),
        ("friction", "coefficient", "nan"),
        ("tip_relief", "start", '"hpstc"'),
    ]:
        text = with_line(text, section, key, f"{key} = {value}")
    message = refusal(text.replace("[bearings]", "[bearing]"))
    for field in (
        "gears.module = 4.5",
        "gears.pinion.teeth = true",
        'load.wheel_torque = "-1 N m"',
        "motion.recorded_cycles = 40",
        "friction.coefficient = nan",
        'tip_relief.start = "hpstc"',
        "[bearing]",
        "[damping]",
    ):
        assert f": {field}\n" in message
    assert "8 mistakes in" in message


def test_the_line_is_that_of_the_field():
    """The text itself, also behind a text over several lines that looks like a scene."""
    text = DEMO.replace('title = "Lundvall, Strömberg, Klarbring 2004"', 'title = """\n[gears.pinion]\nteeth = 3\n"""')
    text = text.replace('bore_diameter = "30 mm" ', "bore_diameter = 30 ")
    line = next(number for number, each in enumerate(text.splitlines(), 1) if each.startswith("bore_diameter = 30 "))
    with pytest.raises(SceneError) as error:
        scene_from_text(text, "pair")
    assert f"pair:{line}: gears.pinion.bore_diameter = 30\n" in str(error.value)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ('title = "a\\u0000b"', 'title = "a\\u0000b"\n    has the control character U+0000. Allowed: '),
        ('title = "a\\u001b]0;owned\\u0007"', "has the control character U+001B"),
        ('title = "a\\u009b31m"', "has the control character U+009B"),
        ('without = ["a\\u0008"]', "pair.toml:2: without = "),
    ],
)
def test_control_characters_are_refused(refusal, line, said):
    """ECMA-48; and a text of HDF5 ends at NUL."""
    found = refusal("\n" + line + "\n" + UNTITLED)
    assert said in found and "\0" not in found and "\x1b" not in found


def test_of_many_mistakes_the_first_are_told_and_the_others_counted(refusal):
    """The first twenty in the order of their lines."""
    found = refusal("".join(f"frictoin{number} = 1\n" for number in range(2000)) + DEMO)
    assert (
        found.count("is not a known section or field of a scene.") == 20
        and "frictoin0 = 1" in found
        and "frictoin19 = 1" in found
    )
    assert found.endswith("... and 1980 more\n2000 mistakes in pair.toml. Nothing was computed or written.\n")


@pytest.mark.parametrize(
    ("content", "fragment"),
    [(None, "there is no such file"), (b"\xff\xfe\x00", "is not a text in UTF-8"), ("directory", "cannot be read")],
)
def test_a_file_that_cannot_be_read_is_named(tmp_path, capsys, content, fragment):
    """Missing, binary, a directory."""
    file = tmp_path / "pair.toml"
    if content == "directory":
        file.mkdir()
    elif content is not None:
        file.write_bytes(content)
    assert main(["run", str(file)]) == 2
    assert f"{file}: {fragment}" in capsys.readouterr().err
