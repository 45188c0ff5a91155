"""The demonstration of the best relief, on coarse teeth."""

import re

import numpy as np
import pytest
from demos.best_relief import compare
from demos.best_relief.compare import ERROR, LENGTH, compared

pytestmark = pytest.mark.nightly

COARSE = """
[set]
accuracy = { flank_element_size = "0.3 mm", contact_length = "2.4 mm", contact_nodes = 9, steps_per_mesh_cycle = 20 }
"""


@pytest.fixture(scope="module")
def every(tmp_path_factory):
    """Searches with fewer designs and samples, on maps of 4 by 4 reliefs."""
    folder, found = tmp_path_factory.mktemp("best_relief"), {}
    for name in ("frictionless", "friction", "friction_tolerances"):
        text = (
            (compare.HERE / f"{name}.toml")
            .read_text()
            .replace("../lundvall2004.toml", str(compare.HERE.parent / "lundvall2004.toml"))
        )
        text = re.sub("evaluations = .*", "evaluations = 40", re.sub("samples = .*", "samples = 2", text)).replace(
            "without = [", 'without = ["accuracy", '
        )
        (folder / f"{name}.toml").write_text(text + COARSE)
        with pytest.MonkeyPatch.context() as few:
            few.setattr("fenics_gears.extensions.optimization.optimize.VALUES", 2)
            few.setattr("fenics_gears.extensions.optimization.optimize.TORQUES", (1.0,))
            found[name] = compared(
                folder / f"{name}.toml", folder / name, np.linspace(15.0, 45.0, 4), np.linspace(4.5, 7.5, 4)
            )
    return found


def test_what_is_found_is_as_good_as_the_best_of_the_map(every):
    """Brute force; the README's statement."""
    for each in every.values():
        assert each.found.chosen.goals[ERROR] <= each.least_of_map[2]
        assert each.found.chosen.goals[ERROR] < each.found.before.goals[ERROR]


def test_picture_and_table_have_every_condition(every, tmp_path):
    """The README."""
    picture, table = compare.written(every, tmp_path)
    assert picture.stat().st_size > 50_000
    text = table.read_text()
    assert all(f"| {words} |" in text for words in (compare.NAMES[name] for name in every))
    assert f"| {every['friction'].found.chosen.values[LENGTH]:.2f} |" in text
