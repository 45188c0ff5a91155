"""Any value that TOML has, anywhere in a study file: a study, or a refusal in words (hard case 26)."""

from itertools import product

import pytest

from fenics_gears.errors import SceneError
from fenics_gears.studies.study_file import load_study

DIGITS = "9" * 400
ANY_VALUE = (
    "0", "-1", "1e-320", "nan", "-inf", '""', '"mm"', '"1 mm"', "true", "[]", "{}", "12:30:00", "2026-11-29", DIGITS,
    '"1e308 m"', "[[]]", "[1, [2]]", '["1 mm", 2]', f"[{DIGITS}, 1]", '[["1 N m"], "2 N m"]', "[{}, {}]", "[12:30:00]",
    "{ start = 1, stop = 2, count = 3 }", '{ start = "1 um", stop = [1], count = 3 }', "{ at_most = [] }",
    f"{{ start = 1, stop = {DIGITS}, step = 1 }}", '"absent"', '"present"', "['absent', 'absent']",
)  # fmt: skip
STUDY = {
    "title": '"any"',
    "combine": '"zip"',
    "without": '["friction"]',
    "set.load.wheel_torque": '"300 N m"',
    "set.friction": "{ coefficient = 0.1 }",
    "sweep.motion.mesh_frequency": '["100 Hz", "200 Hz"]',
    "sweep.friction": '["absent", "present"]',
    "sweep.accuracy.contact_nodes": "[8, 9]",
    "sweep.tip_relief": '[{ depth = "5 um", start = "HPSTC" }, "absent"]',
}


@pytest.mark.parametrize("every", [13, pytest.param(1, marks=pytest.mark.nightly)])
def test_any_value_in_any_field_of_a_study(folder, every):
    """Any value that TOML has: a study, or a refusal in words (hard case 26)."""
    for name, value in list(product(STUDY, ANY_VALUE))[::every]:
        plain = {"scene": '"pair.toml"', "sweep.motion.mesh_cycles": "[2, 3]"}
        any_value_taken_or_refused(load_study, folder / "study.toml", plain | {name: value})


def any_value_taken_or_refused(load, file, fields):
    """Fails where a file with these fields is neither taken nor refused in words."""
    file.write_text("".join(f"{name} = {value}\n" for name, value in fields.items()))
    try:
        load(file)
    except SceneError as error:
        assert str(error)
    except Exception as error:
        raise AssertionError(file.read_text()) from error
