"""Which steps numbers are of."""

from dataclasses import replace
from math import ceil, log, pi

import numpy as np
import pytest
from tests.coarse import coarse_scene

from fenics_gears import model_of, scene_from_text, simulate
from fenics_gears.effects import common_period
from fenics_gears.model.description import describe
from fenics_gears.results.settled import settled
from fenics_gears.results.summary import summary_rows

# z = 23 and 47, no common factor: every tooth has met every other after 1081 mesh cycles.
PAIR = """
[gears]
module = "3 mm"
pressure_angle = "20 deg"
centre_distance = "105.2 mm"
face_width = "25 mm"
[gears.pinion]
teeth = 23
profile_shift = 0.0
tip_diameter = "75 mm"
root_diameter = "61.5 mm"
bore_diameter = "30 mm"
[gears.wheel]
teeth = 47
profile_shift = 0.0
tip_diameter = "147 mm"
root_diameter = "133.5 mm"
bore_diameter = "50 mm"
[gears.material]
youngs_modulus = "206 GPa"
poissons_ratio = 0.3
[load]
wheel_torque = "200 N m"
[motion]
mesh_frequency = "500 Hz"
mesh_cycles = 23
[flank_errors]
tolerance_class = 7
[eccentricity.pinion]
distance = "10 um"
[eccentricity.wheel]
distance = "15 um"
[accuracy]
model = "ISO 6336-1"
steps_per_mesh_cycle = 8
"""


@pytest.fixture(scope="module")
def by_cycles():
    """Results by 23, 47 and 1081 mesh cycles, on the standard's springs."""
    scene = scene_from_text(PAIR, "pair")
    return scene, {
        cycles: simulate(replace(scene, motion=replace(scene.motion, mesh_cycles=cycles))) for cycles in (23, 47, 1081)
    }


def test_numbers_are_of_all_cycles_that_were_run(by_cycles):
    """Brute force over the longest run, whose beginning each shorter one is."""
    _, found = by_cycles
    whole = found[1081]["transmission_error"].values
    spans = {}
    for cycles, result in found.items():
        part = whole[: 8 * cycles + 1]
        np.testing.assert_allclose(result["transmission_error"].values, part, rtol=1e-9)
        spans[cycles] = result.attrs["peak_to_peak_transmission_error"]
        assert np.ptp(part) <= spans[cycles] < 1.05 * np.ptp(part)
        assert result.attrs["mean_transmission_error"] == pytest.approx(part[:-1].mean(), rel=1e-9)
        assert result.attrs["settled_cycles"] == pytest.approx(cycles)
    # The last two cycles alone, which numbers once were of, see a part of it.
    assert spans[1081] > spans[23] > 1.5 * np.ptp(whole[21 * 8 : 23 * 8 + 1])


def test_extremes_lie_between_the_steps_also_where_cycles_differ_and_springs_jump(by_cycles):
    """Brute force: 512 steps span T_EPP within 1e-4; eight miss 1.8 %."""
    scene, found = by_cycles
    fine = replace(
        scene, motion=replace(scene.motion, mesh_cycles=23), accuracy=replace(scene.accuracy, steps_per_mesh_cycle=512)
    )
    span = np.ptp(simulate(fine)["transmission_error"].values)
    assert found[23].attrs["peak_to_peak_transmission_error"] == pytest.approx(span, rel=2e-4)
    assert np.ptp(found[23]["transmission_error"].values) < 0.985 * span


def test_fewer_cycles_than_the_common_period_are_told_first(by_cycles):
    """z1 z2 without common factor: 1081; a whole period has no warning."""
    scene, found = by_cycles
    assert common_period(scene) == 1081 == 23 * 47
    for cycles in (23, 47):
        said = f"only {cycles} of the 1081 mesh cycles of the common period are run"
        assert found[cycles].attrs["warnings"].startswith(said)
        assert summary_rows(found[cycles])[0][0] == "WARNING" and summary_rows(found[cycles])[0][1].startswith(said)
    assert "common period" not in found[1081].attrs["warnings"] and summary_rows(found[1081])[0][0] != "WARNING"
    rows = [row for _, section in describe(scene) for row in section]
    assert ("mesh cycles of the common period", 1081, "after which every tooth has met every other") in rows
    assert any("only 23 of the 1081" in str(row[1]) for row in rows)


def test_the_start_has_died_down(paper_scene):
    """exp(-zeta omega t) = 0.001 at the first step that counts; a warning where it is above 0.01."""
    model = model_of(coarse_scene(paper_scene, cycles=30))
    slowest = min(
        (
            each.damping_ratio * 2 * pi * each.frequency
            for each in model.vibrations
            if each.excited and each.damping_ratio < 1
        ),
        default=0,
    )
    a_cycle = model.resolution.steps_per_mesh_cycle
    calm, quiet = (ceil(log(left) / slowest / model.time_step) for left in (100.0, 1000.0))
    expected = model.steps - (model.steps - quiet) // a_cycle * a_cycle
    assert settled(model, model.steps) == type(settled(model, model.steps))(expected)
    short = model_of(coarse_scene(paper_scene, cycles=2))
    found = settled(short, short.steps)
    assert found.first == a_cycle and "has not died down" in found.warning and "% of its slowest" in found.warning
    assert f"motion.mesh_cycles = {ceil(calm * short.time_step * 200.0 + 1)}" in found.warning
