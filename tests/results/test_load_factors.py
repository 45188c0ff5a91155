"""Load factors of line loads that are known."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from tests.helical import wide_pair

from fenics_gears.contact.window import coast_roll_angles
from fenics_gears.geometry.pair import gear_pair
from fenics_gears.results.load_factors import at_pitch_cylinder, contact_line_lengths, largest_even_share, load_factors

SLICES, STEPS, FIRST, SLOTS = 10, 200, 2, 5


@pytest.fixture(scope="module")
def spur(paper_scene):
    """The paper's pair."""
    return gear_pair(paper_scene.gears)


@pytest.fixture(scope="module")
def helical():
    """A helical pair."""
    return gear_pair(wide_pair().gears)


def run_of(pair, line_load, slices: int = SLICES, reach: float = 0.0) -> xr.Dataset:
    """Two mesh cycles of a result whose line load, N/mm, is that function of contact (mm from T1) and place on the face (mm), up to `reach` (mm) off the path."""
    phase, z = np.arange(2 * STEPS + 1) / STEPS, pair.face_width * ((np.arange(slices) + 0.5) / slices - 0.5)
    loads, numbers = np.zeros((len(phase), SLOTS, slices)), np.zeros((len(phase), SLOTS), dtype=int)
    for entered in range(-4, 6):
        xi = pair.path_start + (phase[:, None] - entered) * pair.base_pitch + pair.slope * z
        there = (xi >= pair.path_start - reach) & (xi <= pair.path_end + reach)
        slot = (entered + FIRST) % SLOTS
        loads[:, slot] += np.where(there, line_load(xi, z), 0.0)
        numbers[there.any(axis=1), slot] = entered + FIRST
    forces = loads.sum(axis=2) * pair.face_width / slices
    time = {"time": ("time", phase), "contact_time": ("contact_time", phase), "contact_mesh_phase": ("contact_time", phase), "face_position": z}
    numbered = ("contact_time", "slot"), numbers, {"number_at_phase_0": FIRST}
    values = {
        "line_load": (("contact_time", "slot", "face_position"), loads),
        "pair_normal_force": (("time", "slot"), forces),
        "normal_force": ("time", forces.sum(axis=1)),
    }
    return xr.Dataset(values, {**time, "contact_pair_number": numbered})


def test_line_load_that_grows_along_a_spur_gear(spur):
    """Closed form: of a line load 1 + a z over a width b the largest over the mean is 1 + a b/2 (1 - 1/slices), everywhere and at the pitch cylinder."""
    factors = load_factors(run_of(spur, lambda xi, z: 100.0 * (1.0 + 0.05 * z) + 0.0 * xi), spur)
    expected = 1.0 + 0.05 * 0.5 * spur.face_width * (1.0 - 1.0 / SLICES)
    assert factors["face_load_factor"] == pytest.approx(expected, rel=1e-12)
    assert factors["face_load_factor_at_pitch_cylinder"] == pytest.approx(expected, rel=1e-12)
    assert factors["transverse_load_factor"] == pytest.approx(1.0, abs=1e-12)
    assert factors["overlap_ratio"] == 0.0 and factors["total_contact_ratio"] == spur.contact_ratio


@pytest.mark.parametrize("hand", ["right", "left"])
def test_pitch_cylinder_of_a_helical_gear(helical, hand):
    """Identity: of a line load f(xi) g(z) the one on the pitch cylinder is f(pitch point) g(z), though slices pass it one after the other."""
    pair = helical if hand == "right" else replace(helical, helix=replace(helical.helix, pinion_hand="left"))
    result = run_of(pair, lambda xi, z: 100.0 * (1.0 + 0.3 * (xi - pair.pitch_point)) * (1.0 + 0.02 * z))
    z = result["face_position"].values
    found = at_pitch_cylinder(result, pair)
    assert len(found) >= 1
    assert found == pytest.approx(np.broadcast_to(100.0 * (1.0 + 0.02 * z), found.shape), rel=1e-9)


@pytest.mark.parametrize("hand", ["right", "left"])
def test_pitch_cylinder_on_coast_flanks(helical, hand):
    """Identity: the same on coast flanks, whose contact goes the other way along a line of action of its own."""
    pair = helical if hand == "right" else replace(helical, helix=replace(helical.helix, pinion_hand="left"))

    def line_load(xi, z):
        position = pair.pinion.base_radius * np.vectorize(lambda at: coast_roll_angles(pair, at)[0])(xi)
        return 100.0 * (1.0 + 0.3 * (position - pair.pitch_point)) * (1.0 + 0.02 * z)

    result = run_of(pair, line_load, reach=pair.base_pitch)
    result = result.rename(line_load="coast_line_load", pair_normal_force="pair_coast_normal_force").assign(
        line_load=0.0 * result["line_load"], coast_normal_force=result["normal_force"], normal_force=0.0 * result["normal_force"]
    )
    z = result["face_position"].values
    found = at_pitch_cylinder(result, pair, "coast_")
    assert len(found) >= 1
    assert found == pytest.approx(np.broadcast_to(100.0 * (1.0 + 0.02 * z), found.shape), rel=1e-9)
    largest = (1.0 + 0.02 * z).max()
    assert load_factors(result, pair)["face_load_factor_at_pitch_cylinder"] == pytest.approx(largest, rel=1e-9)


def test_lengths_of_contact_lines(helical):
    """Brute force: lengths, summed over points along the face whose contact is on the path; and all pairs together are the path times the face over the base pitch on average."""
    positions = np.linspace(helical.path_start - 10.0, helical.path_end + 10.0, 301)
    z = helical.face_width * ((np.arange(20_000) + 0.5) / 20_000 - 0.5)
    there = [np.mean((xi + helical.slope * z >= helical.path_start) & (xi + helical.slope * z <= helical.path_end)) for xi in positions]
    assert contact_line_lengths(helical, positions) == pytest.approx(helical.face_width * np.array(there), abs=1e-3 * helical.face_width)
    phases = np.linspace(0.0, helical.base_pitch, 10_000, endpoint=False)
    all_lines = contact_line_lengths(helical, phases[:, None] + helical.base_pitch * np.arange(-5, 9)).sum(axis=1)
    assert all_lines.mean() == pytest.approx(helical.contact_ratio * helical.face_width, rel=1e-6)
    brute = (contact_line_lengths(helical, phases[:, None] + helical.base_pitch * np.arange(-5, 9)).max(axis=1) / all_lines).max()
    assert largest_even_share(helical) == pytest.approx(brute, rel=1e-4) and largest_even_share(helical) >= brute - 1e-12


def test_even_line_load_of_a_helical_pair(helical):
    """Identity: pairs that share by the lengths of their lines of contact have a transverse load factor of 1 (but for the slices, steps of those lengths)."""
    result = run_of(helical, lambda xi, z: 100.0 + 0.0 * xi * z, slices=400)
    assert load_factors(result, helical)["transverse_load_factor"] == pytest.approx(1.0, abs=3e-3)


def test_nothing_of_flanks_without_load(spur):
    """A pair that touches nowhere has its geometry's ratios only."""
    assert set(load_factors(run_of(spur, lambda xi, z: 0.0 * xi * z), spur)) == {"overlap_ratio", "total_contact_ratio"}
