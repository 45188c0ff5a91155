"""`python -m tests.benchmarks.growth`: exponents of exact powers, bytes that are known, and what it writes."""

import csv
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.benchmarks.growth import memory
from tests.benchmarks.growth.analysis import expected_by_mumps
from tests.benchmarks.growth.axes import AXES, axis_named, paper
from tests.benchmarks.growth.face_axes import FACE_AXES, helical
from tests.benchmarks.growth.face_point import FacePoint
from tests.benchmarks.growth.fit import exponent, local_slopes
from tests.benchmarks.growth.picture import growth_picture
from tests.benchmarks.growth.point import Point
from tests.benchmarks.growth.report import MEBI, column, exponents, section, write_csv
from tests.benchmarks.marked_section import replaced

from fenics_gears.elasticity.cache import Cache
from fenics_gears.model.model import model_of

MACHINE = {"processor": "a machine", "load": "0.1", "threads": "1", "versions": "0"}


@pytest.mark.parametrize("power", [0.0, 1.0, 1.5, 3.0])
def test_an_exact_power_has_its_exponent_and_no_error(power):
    """Authority: definition; below the upper decade another power that must not count."""
    x = np.geomspace(1.0, 100.0, 9)
    found = exponent(x, np.where(x < 9.9, 7.0 * 10.0 ** (power - 2.0) * x**2, 7.0 * x**power))
    assert found.value == pytest.approx(power, abs=1e-12) and found.error == pytest.approx(0.0, abs=1e-9)
    assert found.points == 5 and found.last == pytest.approx(power)
    assert local_slopes([1.0, 2.0, 4.0], [3.0, 6.0, 24.0]) == pytest.approx([1.0, 2.0])


def test_the_standard_error_is_that_of_a_regression():
    """Authority: scipy's linear regression of the logarithms."""
    from scipy.stats import linregress

    x = np.geomspace(10.0, 100.0, 6)
    y = x**1.3 * np.array([1.0, 1.1, 0.9, 1.05, 0.97, 1.02])
    known, found = linregress(np.log(x), np.log(y)), exponent(x, y)
    assert (found.value, found.error) == (pytest.approx(known.slope), pytest.approx(known.stderr))
    assert exponent([1.0, 2.0, 100.0], [1.0, 1.0, 1.0]) is None and exponent(x, np.zeros(6)) is None


def test_bytes_of_arrays_are_counted_once_wherever_they_are():
    """Authority: NumPy; views of an array that is counted add nothing."""
    array = np.zeros(1000)
    assert memory.array_bytes(array, [array, {"a": (array[10:], np.zeros(5))}], None, 3.0) == 8000 + 40


HELD = """
import numpy as np
from tests.benchmarks.growth import memory

memory.forget_peak()
before = memory.peak()
np.ones(8 * 2**20).sum()
held = memory.peak() - before
memory.forget_peak()
print(held, memory.peak() - before)
"""


def test_the_peak_is_of_what_was_held_since_it_was_forgotten():
    """Authority: an array of 64 MiB that is written and let go; the peak falls back when it is forgotten.

    In a process of its own: MPI, once loaded, keeps what is freed.
    """
    if not memory.RESET.exists():
        pytest.skip("no /proc/self/clear_refs")
    root = Path(__file__).parents[2]
    held, after = map(
        int,
        subprocess.run(
            [sys.executable, "-c", HELD], cwd=root, capture_output=True, text=True, check=True
        ).stdout.split(),
    )
    assert 60 * MEBI < held < 80 * MEBI and after < 10 * MEBI


@pytest.mark.parametrize("axis", AXES, ids=lambda axis: axis.name)
def test_every_axis_spans_two_decades_of_scenes_that_can_be_run(axis):
    """Authority: issue 6; and each scene is checked as a user's is. One thing alone is counted along an axis."""
    assert max(axis.values) / min(axis.values) >= 99.0
    for value in (min(axis.values), max(axis.values)):
        model = model_of(axis.scene(value))
        counted = {
            "contact_nodes": model.resolution.contact_grid.nodes, "teeth": model.pair.wheel.teeth,
            "steps": model.resolution.steps_per_mesh_cycle,
            "cycles": model.scene.motion.mesh_cycles,
        }  # fmt: skip
        if axis.counted in counted:
            assert counted[axis.counted] == value


def test_a_point_has_all_that_theory_speaks_of():
    """Authority: identity; every quantity of every axis is measured and positive, and both routes through the ring are
    timed where asked for."""
    scene = paper()
    scene = replace(
        scene, accuracy=replace(scene.accuracy, flank_element_size=0.5, contact_nodes=9, steps_per_mesh_cycle=4)
    )
    point = Point(model_of(scene), set(), compares_rings=True).measured()
    for axis in AXES:
        assert point[axis.counted] > 0.0
        assert all(point[column(quantity)] > 0.0 for quantity in axis.theory if not quantity.endswith("peak"))
    assert point["contact_nodes"] == 9 and point["steps"] == 4 and point["teeth"] == 24 and point["cycles"] == 2


@pytest.mark.parametrize("axis", FACE_AXES, ids=lambda axis: axis.name)
def test_every_axis_over_the_face_has_scenes_that_can_be_run(axis):
    """Authority: definition; each scene is checked as a user's is, and has what its axis asks for."""
    for value in (min(axis.values), max(axis.values)):
        model = model_of(axis.scene(value))
        counted = {"slices": model.face.slices, "teeth": model.pair.wheel.teeth, "layers": model.scene.accuracy.layers}
        assert model.scene.three_dimensional and counted.get(axis.counted, value) == value


def test_a_point_over_the_face_has_all_that_theory_speaks_of(tmp_path):
    """Authority: identity; every quantity of every axis is measured and positive. MUMPS's analysis has the size of what
    is condensed, and more bytes than its dense front."""
    model = model_of(helical(layers=1, slices=2, steps_per_mesh_cycle=2))
    point = FacePoint(model, set()).body()
    contact = FacePoint(model, set()).contact(Cache(tmp_path))
    for axis in FACE_AXES:
        found = contact if axis.measured == "contact" else point
        assert found[axis.counted] > 0.0 and all(found[count] > 0.0 for count in axis.also)
        assert all(found[column(quantity)] > 0.0 for quantity in axis.theory if not quantity.endswith("peak"))
    assert (point["layers"], point["teeth"], point["ranks"], contact["slices"], contact["steps"]) == (1, 30, 1, 2, 2)
    expected, condensed = expected_by_mumps(model), point["condensed_unknowns"]
    assert (expected["unknowns"], expected["condensed_unknowns"]) == (point["unknowns"], condensed)
    assert expected["factor_array_bytes"] > 4.0 * expected["condensed_half"] ** 2


def points_of(axis):
    """Made-up points that grow just as theory says."""
    found = []
    for value in axis.values:
        point = dict.fromkeys(
            (
                f"{stage}_{what}"
                for stage in ("mesh", "condense", "operators", "solving")
                for what in ("peak_bytes", "array_bytes", "rounds")
            ),
            5.0,
        )
        point |= dict.fromkeys(("flank_nodes", "contact_nodes", "teeth", "steps", "cycles", "unknowns"), 1.0)
        point |= {column(quantity): 3.0 * value**theory.exponent for quantity, theory in axis.theory.items()}
        found.append(point | {axis.counted: value})
    return found


def test_table_picture_and_numbers_have_every_exponent(tmp_path):
    """Authority: identity; what was made to grow as theory says is told so, in the page, the CSV and the picture's
    legends."""
    axis = axis_named("contact nodes")
    found = {axis.name: points_of(axis)}
    assert all(
        fit.value == pytest.approx(axis.theory[name].exponent, abs=1e-9)
        for name, fit in exponents(axis, found[axis.name]).items()
    )
    words = section(found, MACHINE)
    assert "## Contact nodes" in words and "|marching: operators|2.00 ± 0.00|2.00|2|" in words
    write_csv(found, MACHINE, tmp_path / "growth.csv")
    with open(tmp_path / "growth.csv", encoding="utf-8", newline="") as file:
        lines = list(csv.DictReader(file))
    assert [line["kind"] for line in lines] == ["point"] * len(axis.values) + ["exponent"] * len(axis.theory)
    legend = growth_picture(found, MACHINE).axes[0].get_legend().get_texts()
    assert any(text.get_text() == "marching: operators: 2.0, theory 2" for text in legend)


def test_a_section_goes_between_its_markers_and_nowhere_else():
    """Authority: definition; a page without them is refused with the remedy."""
    assert replaced("a\n<b>\nold\n<e>\nz", "<b>", "<e>", "new") == "a\n<b>\n\nnew\n\n<e>\nz"
    with pytest.raises(SystemExit, match="put them where the section shall stand"):
        replaced("a\n<b>\n", "<b>", "<e>", "new")
