"""The table of effects, and the guide's worked example."""

import json
import re
import shutil
from pathlib import Path

import pytest
from tests import effects_table
from tests.effects.examples import text_of
from tests.programs import python

import fenics_gears
from fenics_gears import scene_from_text, simulate

PACKAGE = Path(fenics_gears.__file__).parent
GUIDE = effects_table.PAGE.with_name("adding_an_effect.md")


def test_the_table_of_effects_is_up_to_date():
    """`python -m tests.effects_table` writes it anew."""
    assert effects_table.PAGE.read_text() == effects_table.page()


def block(language, holding):
    found = [code for code in re.findall(rf"```{language}\n(.*?)```", GUIDE.read_text(), re.S) if holding in code]
    assert len(found) == 1
    return found[0]


@pytest.fixture(scope="module")
def extended(tmp_path_factory):
    """A copy of the package with the guide's module, its entry and the scene's field."""
    folder = tmp_path_factory.mktemp("extended")
    # With its compiled kernels, which know their source by its time.
    shutil.copytree(PACKAGE, folder / "fenics_gears")
    effects = folder / "fenics_gears" / "effects"
    (effects / "brake.py").write_text(block("python", "EFFECT = Effect("))
    text = (effects / "__init__.py").read_text()
    entry = block("python", '    "brake",').rstrip()
    text, listed = re.subn(r"(\nAT_THE_TOP = .*?)\n\)", rf"\1\n{entry}\n)", text, count=1, flags=re.S)
    assert listed == 1
    (effects / "__init__.py").write_text(text)
    scene = folder / "fenics_gears" / "scene" / "data.py"
    text, imported = re.subn(
        r"\n    from fenics_gears", f"\n{block('python', 'import Brake')}\\g<0>", scene.read_text(), count=1
    )
    text, added = re.subn(
        r"(\nclass Scene:.*?)(\n\n    @property)",
        rf"\1\n{block('python', 'brake: Brake |').rstrip()}\2",
        text,
        count=1,
        flags=re.S,
    )
    assert imported == added == 1
    scene.write_text(text)
    return folder


def run(folder, *arguments, given=None):
    return python("-P", *arguments, given=given, folder=folder, PYTHONPATH=str(folder)).stdout


PROGRAM = """
import json, sys
from fenics_gears.scene.read import scene_from_text
from fenics_gears.runs.simulate import simulate
found = []
for text in json.load(sys.stdin):
    run = simulate(scene_from_text(text))
    found.append({
        "modules": sorted(sys.modules),
        "variables": sorted(run.data_vars),
        "transmission_error": run.transmission_error.values.tolist(),
        "work": run.get("work_brake", run.time).values.tolist(),
        "twist": (run.shaft_end_rotation - run.rotation[:, 1]).values.tolist()
        if "shaft_end_rotation" in run else [],
    })
print(json.dumps(found))
"""


@pytest.fixture(scope="module")
def plain():
    text = text_of("tooth_elasticity").replace('"437 N m"', '"400 N m"')
    simulate(scene_from_text(text))
    return json.loads(run(PACKAGE.parent, "-c", PROGRAM, given=json.dumps([text])))[0]


CHECK = """
import contextlib, io
from fenics_gears.commands.cli import main
said = []
for name in ("with", "without", "wrong"):
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as err:
        code = main(["check", f"{name}.toml"])
    said.append([code, out.getvalue(), err.getvalue()])
print(json.dumps(said))
"""


@pytest.fixture(scope="module")
def printed(extended, plain):
    """Runs of a bare scene, one with the brake, the bare one under the whole torque, one with shafts and brake; and
    `gears check` of a scene with the brake, without it, and of a wrong one."""
    brake = block("toml", "[brake]")
    scenes = {
        "with": text_of() + brake,
        "without": text_of(),
        "wrong": text_of("coast_flanks").replace('"437 N m"', '"-437 N m"') + brake,
    }
    for name, text in scenes.items():
        (extended / f"{name}.toml").write_text(text)
    brake = brake.replace("20 N m", "37 N m")
    bare, shafts = text_of("tooth_elasticity"), text_of("tooth_elasticity", "shafts")
    less, whole = bare.replace('"437 N m"', '"400 N m"'), bare
    texts = [less, less + brake, whole, shafts.replace('"437 N m"', '"400 N m"') + brake]
    return [
        json.loads(line) for line in run(extended, "-c", PROGRAM + CHECK, given=json.dumps(texts)).splitlines()[-2:]
    ]


@pytest.fixture(scope="module")
def runs(printed):
    return printed[0]


@pytest.mark.nightly
def test_the_guides_effect_is_named_by_check_on_and_off(printed):
    """The guide; one entry in the list is enough."""
    lines = []
    for code, said, _ in printed[1][:2]:
        assert code == 0
        lines.append(next(line.split(maxsplit=2) for line in said.splitlines() if line.split()[:1] == ["brake"]))
    on, off = lines
    assert on[1] == "on" and "brake torque on the wheel" in on[2] and "work_brake" in on[2]
    assert off[1:] == ["off", "no brake"]


@pytest.mark.nightly
def test_the_guides_rule_refuses_with_place_value_and_remedy(printed):
    """The guide."""
    code, _, said = printed[1][2]
    assert code == 2
    assert "load.wheel_torque" in said and "-437 N m" in said and "cannot be combined with a brake" in said


@pytest.mark.nightly
def test_the_guides_effect_has_its_known_answer(runs):
    """Identity: 400 N m of load and 37 N m of brake are 437 N m; work is torque times angle."""
    _, braked, whole, _ = runs
    assert braked["transmission_error"] == pytest.approx(whole["transmission_error"], rel=1e-12)
    assert braked["work"][-1] == pytest.approx(37e3 * 2.0 * 3.141592653589793 / 24, rel=1e-12)


@pytest.mark.nightly
def test_the_guides_brake_works_before_the_output_shaft(runs):
    """Statics: the shaft is twisted by the 400 N m at its end."""
    assert runs[3]["twist"] == pytest.approx([400e3 / 0.203e9] * 21, rel=1e-9)


@pytest.mark.nightly
def test_the_guides_effect_left_out_leaves_nothing_behind(runs, plain):
    """House rule 9."""
    bare = runs[0]
    assert set(bare["modules"]) <= set(plain["modules"])
    assert bare["variables"] == plain["variables"] and "work_brake" not in bare["variables"]
    assert bare["transmission_error"] == plain["transmission_error"]
    assert set(runs[1]["variables"]) - set(bare["variables"]) == {"work_brake"}
