"""Load factors of line loads that are known."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from tests.helical import wide_pair

from fenics_gears import gear_pair
from fenics_gears.contact.window import coast_roll_angles
from fenics_gears.results.face_ends import end_depth, inner_face, slice_ends, window_depth, windows
from fenics_gears.results.load_factors import end_of_line, face_load_factor, load_factors

SLICES, STEPS, FIRST, SLOTS = 10, 200, 2, 5


@pytest.fixture(scope="module")
def spur(paper_scene):
    return gear_pair(paper_scene.gears)


@pytest.fixture(scope="module")
def helical():
    return gear_pair(wide_pair().gears)


def run_of(pair, line_load, slices=SLICES, reach: float = 0.0) -> xr.Dataset:
    """A result whose line load, N/mm, is a function of contact (mm from T1) and place on the face (mm), up to
    `reach` (mm) off the path; slices: how many, or ends of unequal ones."""
    ends = (
        pair.face_width * (np.linspace(0.0, 1.0, slices + 1) if np.ndim(slices) == 0 else np.array(slices))
        - 0.5 * pair.face_width
    )
    phase, z, widths = np.arange(2 * STEPS + 1) / STEPS, 0.5 * (ends[1:] + ends[:-1]), np.diff(ends)
    loads, numbers = np.zeros((len(phase), SLOTS, len(z))), np.zeros((len(phase), SLOTS), dtype=int)
    for entered in range(-4, 6):
        xi = pair.path_start + (phase[:, None] - entered) * pair.base_pitch + pair.slope * z
        there = (xi >= pair.path_start - reach) & (xi <= pair.path_end + reach)
        slot = (entered + FIRST) % SLOTS
        loads[:, slot] += np.where(there, line_load(xi, z), 0.0)
        numbers[there.any(axis=1), slot] = entered + FIRST
    forces = loads @ widths
    along = {"face_position": z, "face_slice_width": ("face_position", widths)}
    time = {
        "time": ("time", phase),
        "contact_time": ("contact_time", phase),
        "contact_mesh_phase": ("contact_time", phase),
    }
    numbered = ("contact_time", "slot"), numbers, {"number_at_phase_0": FIRST}
    values = {
        "line_load": (("contact_time", "slot", "face_position"), loads),
        "pair_normal_force": (("time", "slot"), forces),
        "normal_force": ("time", forces.sum(axis=1)),
    }
    return xr.Dataset(values, {**along, **time, "contact_pair_number": numbered})


def on_coast_flanks(result: xr.Dataset) -> xr.Dataset:
    """What the drive flanks of a result carry, on its coast flanks."""
    renamed = result.rename(line_load="coast_line_load", pair_normal_force="pair_coast_normal_force")
    return renamed.assign(
        line_load=0.0 * result["line_load"],
        coast_normal_force=result["normal_force"],
        normal_force=0.0 * result["normal_force"],
    )


def of_one_force(result: xr.Dataset) -> xr.Dataset:
    """Loads made as large as give the same force of the mesh."""
    share = result["normal_force"].mean() / result["normal_force"]
    of_fields = share.rename(time="contact_time")
    return result.assign(
        line_load=result["line_load"] * of_fields,
        pair_normal_force=result["pair_normal_force"] * share,
        normal_force=result["normal_force"] * share,
    )


@pytest.mark.parametrize("slices", [10, 40, [0.0, 0.02, 0.05, 0.2, 0.5, 0.78, 0.82, 0.9, 1.0]])
def test_line_load_that_grows_along_a_spur_gear(spur, slices):
    """Closed form for 1 + a z over a width b: 1 + a (b/2 - end zone - half a window) beside the end zone, however the
    face is divided; the outermost slice has the edge's."""
    result = of_one_force(run_of(spur, lambda xi, z: 100.0 * (1.0 + 0.05 * z) + 0.0 * xi, slices))
    factors = load_factors(result, spur)
    expected = 1.0 + 0.05 * (inner_face(spur)[1] - 0.5 * window_depth(spur))
    assert factors["face_load_factor"] == pytest.approx(expected, rel=5e-3)
    assert factors["largest_line_load_factor"] == pytest.approx(expected, rel=5e-3)
    assert factors["edge_line_load_factor"] == pytest.approx(
        1.0 + 0.05 * result["face_position"].values.max(), rel=1e-12
    )
    assert factors["transverse_load_factor"] == pytest.approx(1.0, abs=1e-12)
    assert factors["overlap_ratio"] == 0.0 and factors["total_contact_ratio"] == spur.contact_ratio


def test_windows_find_the_largest_running_mean(spur):
    """Brute force: the mean over half a module at a hundred thousand places, random values and widths."""
    random = np.random.default_rng(3)
    ends = np.sort(np.concatenate([[0.0, 1.0], random.uniform(size=30)]))
    result = run_of(spur, lambda xi, z: 1.0 + 0.0 * xi * z, list(ends))
    values = random.uniform(size=31)
    low, high = inner_face(spur)
    depth = window_depth(spur)
    starts = np.linspace(low, high - depth, 100_000)
    integral = np.append(0.0, np.cumsum(values * np.diff(slice_ends(result))))
    brute = (
        np.interp(starts + depth, slice_ends(result), integral) - np.interp(starts, slice_ends(result), integral)
    ) / depth
    found = windows(result, spur)
    assert found.sum(axis=1) == pytest.approx(1.0, abs=1e-12)
    assert (found @ values).max() == pytest.approx(brute.max(), rel=1e-4) and (
        found @ values
    ).max() >= brute.max() - 1e-12
    assert end_depth(spur) == min(0.5 * spur.pinion.normal_module, 0.1 * spur.face_width)
    assert depth == pytest.approx(end_depth(spur), rel=0.1) and (high - low) / depth % 1.0 == pytest.approx(0.0)


@pytest.mark.parametrize("name", ["spur", "helical"])
def test_no_face_load_factor_is_below_one(name, request):
    """A largest mean over parts that make up a width is at least the mean over that width: loads at random, alone on
    the end zones, beside nothing, and like a comb whose teeth no window holds two of."""
    pair, random = request.getfixturevalue(name), np.random.default_rng(5)
    width, zone = pair.face_width, end_depth(pair)
    for trial in range(200):
        ends = np.sort(random.uniform(0.02, 0.98, size=trial % 30 + 1))
        face = run_of(pair, lambda xi, z: 1.0 + 0.0 * xi * z, [0.0, *ends, 1.0])
        factor = face_load_factor(random.uniform(size=len(ends) + 1) ** 4, face, pair)
        assert factor >= 1.0 - 1e-12
    ends = [0.0, *np.sort(np.clip([zone / width, *np.arange(1, 20) / 20.5, 1.0 - zone / width], 0.0, 1.0)), 1.0]
    face = run_of(pair, lambda xi, z: 1.0 + 0.0 * xi * z, ends)
    comb = np.arange(len(ends) - 1) % 2 * 1.0
    assert face_load_factor(comb, face, pair) >= 1.0
    alone = np.zeros(len(comb))
    alone[[0, -1]] = 1.0
    assert face_load_factor(alone, face, pair) is None and face_load_factor(0.0 * comb, face, pair) is None


@pytest.mark.parametrize("hand", ["right", "left"])
@pytest.mark.parametrize("side", ["", "coast_"])
def test_average_over_the_mesh_cycle_of_a_helical_gear(helical, hand, side):
    """Identity: of a line load f(xi) g(z) the average goes as g(z)."""
    pair = helical if hand == "right" else replace(helical, helix=replace(helical.helix, pinion_hand="left"))
    result = run_of(
        pair,
        lambda xi, z: 100.0 * (1.0 + 0.3 * np.sin(xi)) * (1.0 + 0.02 * z),
        slices=[0.0, 0.04, 0.1, 0.35, 0.85, 0.9, 0.95, 1.0],
    )
    found = load_factors(on_coast_flanks(result) if side else result, pair)["face_load_factor"]
    # To the steps at which a slice begins and ends its path.
    assert found == pytest.approx(1.0 + 0.02 * (inner_face(pair)[1] - 0.5 * window_depth(pair)), rel=5e-3)


@pytest.mark.parametrize("end", ["start", "end"])
@pytest.mark.parametrize("side", ["", "coast_"])
def test_edges_have_a_factor_of_their_own(helical, end, side):
    """Definition: no further along the face than the end zones' depth it is of an edge, twice as far not. Coast
    flanks as seen in the mirror."""

    def line_load(within: float):
        near = within * end_depth(helical) * abs(helical.slope)
        beside = (
            (lambda xi: xi < helical.path_start + near) if end == "start" else (lambda xi: xi > helical.path_end - near)
        )
        return lambda xi, z: np.where(beside(on_path(xi)), 300.0, 100.0) + 0.0 * z

    def on_path(xi):
        """Where contact at xi on the drive flanks' line is on that of those that carry."""
        return helical.pinion.base_radius * coast_roll_angles(helical, xi)[0] if side else xi

    def factors(within: float):
        result = of_one_force(run_of(helical, line_load(within), slices=40, reach=helical.base_pitch if side else 0.0))
        return load_factors(on_coast_flanks(result) if side else result, helical)

    near, far = factors(0.9), factors(2.0)
    # To the change of the lines' lengths between the times of the one and of the other.
    assert near["edge_line_load_factor"] == pytest.approx(3.0 * near["largest_line_load_factor"], rel=0.15)
    assert far["edge_line_load_factor"] == pytest.approx(far["largest_line_load_factor"], rel=0.15)


def test_ends_of_lines_of_contact_are_told_apart(spur, helical):
    """Geometry: half a module of the face, along the path by the tangent of the base helix angle."""
    near = 0.5 * helical.pinion.normal_module * abs(helical.slope)
    start, end = helical.path_start, helical.path_end
    places = (start - 0.1, start + 0.99 * near, start + 1.01 * near, end - 1.01 * near, end - 0.99 * near, end + 0.1)
    assert [end_of_line(helical, place) for place in places] == ["start", "start", "", "", "end", "end"]
    assert not end_of_line(spur, spur.path_start + 1e-9)
