"""Rows 29 to 32, which only flanks over a face have, on bodies without finite elements where these do not matter."""

import numpy as np
import pytest
from tests.hard_cases.invariants import run_of
from tests.hard_cases.test_any_scene import obeys_the_laws
from tests.hard_cases.test_over_the_face_on_elements import TEETH, accuracy, bodies_of, run  # noqa: F401
from tests.hard_cases.test_over_the_face_static import FEW, difference, errors, misaligned, states
from tests.hard_cases.test_over_the_face_static import marched as without_result
from tests.hard_cases.test_over_the_face_static import run as on_stand_ins
from tests.helical import BEARINGS, CROWNED, FRICTION, helical_scene, on_stand_in_bodies

from fenics_gears import model_of, scene_from_text
from fenics_gears.errors import GeometryError

BY_NIGHT = pytest.mark.nightly
WIDTH, TORQUE = 24.0, 200e3
EXCESSES = (1e-9, 1e-6, 1e-3, 1.0, 10.0)


def force_error(found):
    """Error of the force without friction: what drive flanks carry more than coast flanks holds the load; in parts
    of the larger of load and drive force."""
    driving, pair = found.result["normal_force"].values, found.model.pair
    coasting = found.result["coast_normal_force"].values if "coast_normal_force" in found.result else 0.0
    held = found.model.scene.load.wheel_torque / pair.wheel.base_radius
    apart = np.abs((driving - coasting) * pair.cosine - held)
    return float(apart.max() / max(held, np.abs(driving).max()))


def of_widths(pinion, wheel, more="", **changes):
    """The scene of gears with widths (mm) of their own."""
    text = helical_scene(more, **{"accuracy": FEW, **changes}).text.replace(f'face_width = "{WIDTH!r} mm"\n', "")
    for name, width in (("pinion", pinion), ("wheel", wheel)):
        text = text.replace(f"[gears.{name}]\n", f'[gears.{name}]\nface_width = "{float(width)!r} mm"\n')
    return scene_from_text(text)


def marched(scene, bodies=on_stand_in_bodies):
    model = model_of(scene)
    found = run_of(model, bodies(model))
    assert found.failure is None, str(found.failure)
    obeys_the_laws(found)
    return found


@pytest.mark.parametrize("wider", ["pinion", pytest.param("wheel", marks=BY_NIGHT)])
def test_one_gear_wider_than_the_other(wider, measured):
    """Row 29. Limit: in proportion to the excess of one width, to the pair of equal widths; equilibrium at any
    excess."""
    usual, more = errors(on_stand_ins(misaligned(0.02))), misaligned(0.02)
    found = [
        marched(of_widths(*((WIDTH + excess, WIDTH) if wider == "pinion" else (WIDTH, WIDTH + excess)), more))
        for excess in EXCESSES
    ]
    rates = [difference(errors(each), usual) / excess for each, excess in zip(found, EXCESSES)]
    measured(
        f"{wider} wider by 1e-6, 1e-3, 1, 10 mm: relative change of the transmission error / excess",
        ", ".join(f"{rate:.3g}" for rate in rates[1:]),
        "constant within 30 % to 1 mm",
        "1/mm",
        row=29,
    )
    held = max(map(force_error, found))
    measured(f"{wider} wider by 1e-9 to 10 mm: error of the force", held, 1e-11, row=29)
    assert rates[1:4] == pytest.approx([rates[2]] * 3, rel=0.3) and rates[0] * EXCESSES[0] <= 1e-7


@pytest.mark.parametrize("offset", [10.0, pytest.param(-23.9, marks=BY_NIGHT), 23.9])
def test_gears_that_overlap_by_a_part_of_their_faces(offset, measured):
    """Row 29. Equilibrium; no common face is refused before anything is computed."""
    found = on_stand_ins(CROWNED, offset=offset)
    obeys_the_laws(found)
    apart = force_error(found)
    common = WIDTH - abs(offset)
    measured(f"gears of 24 mm, {common:.3g} mm of it in common: error of the force", apart, 1e-11, row=29)
    with pytest.raises(GeometryError, match="do not overlap axially"):
        model_of(helical_scene(offset=np.copysign(WIDTH, offset), accuracy=FEW))


@pytest.mark.parametrize("helix", [15.0, pytest.param(0.0, marks=BY_NIGHT)])
def test_ends_that_do_not_touch(helix, measured):
    """Row 30. Equilibrium: ends relieved too deep to touch carry nothing, the middle holds the load."""
    relieved = '[lead_modifications.pinion.end_relief]\ndepth = "200 um"\nlength = "8 mm"\n'
    found = on_stand_ins(relieved, helix=helix, torque=20e3)
    obeys_the_laws(found)
    loads = found.result["line_load"].sum(["contact_time", "slot"]).values
    ends = float(loads[[0, -1]].max() / loads.max())
    apart = force_error(found)
    measured(
        f"ends relieved by 200 um, helix {helix:g} deg: line load at the ends / largest, error of the force",
        f"{ends:.1g}, {apart:.1g}",
        "0, 1e-11",
        row=30,
    )
    assert ends == 0.0 and apart <= 1e-11


@pytest.mark.nightly
def test_line_loads_at_the_ends_of_a_face(run, measured):
    """Row 30. Known order: the mean over slices is a midpoint rule; the largest line load, at an end, is on record."""
    found = [run(misaligned(0.02), accuracy=accuracy(slices, layers=4, nodes=17, steps=7)) for slices in (6, 12, 24)]
    peaks = [float(each["line_load"].max()) for each in found]
    means = np.array([each["transmission_error"].values.mean() for each in found])
    measured(
        "finite elements, misaligned by 20 um: largest line load with 6, 12, 24 slices",
        ", ".join(f"{peak:.0f}" for peak in peaks),
        "recorded",
        "N/mm",
        row=30,
    )
    last = abs(means[2] / means[1] - 1.0)
    measured("finite elements: change of the mean transmission error from 12 to 24 slices", last, 5e-3, row=30)


def steepest(more, steps):
    """Largest change of the transmission error in a step, in parts of its peak-to-peak value."""
    found = without_result(more, accuracy=f"slices = 5\ncontact_nodes = 9\nsteps_per_mesh_cycle = {steps}")
    error = states(*found, "transmission_error")
    return float(np.abs(np.diff(error)).max() / np.ptp(error))


@pytest.mark.parametrize(
    "more", ["", pytest.param("\n[corner_contact]\n", marks=BY_NIGHT)], ids=["along the path", "corner contact"]
)
def test_tips_cross_the_face_continuously(more, measured):
    """Row 31. Continuity: the largest change from step to step halves with the step."""
    changes = np.array([steepest(more + misaligned(0.02), steps) for steps in (240, 480)])
    order = float(np.log2(changes[0] / changes[1]))
    words = "corner contact" if more else "contact along the path"
    measured(
        f"{words}: largest change in 1/480 mesh cycle / peak-to-peak value",
        changes[-1],
        "in proportion to the step",
        row=31,
    )
    measured(f"{words}: order of this change in the step", order, "1 +- 0.2", row=31)
    assert order == pytest.approx(1.0, abs=0.2)


@pytest.mark.nightly
def test_sharp_tips_that_cross_the_face_are_flagged(run, measured):
    """Row 31. Elasticity: pressure at a sharp tip grows with every refinement; forces hold, the transmission error
    settles, and the run says so."""
    found = [
        run(misaligned(0.02), torque=400e3, accuracy=accuracy(6, nodes=nodes).replace('"0.5 mm"', f'"{size} mm"'))
        for size, nodes in ((0.5, 11), (0.25, 21), (0.125, 41))
    ]
    peaks = [each.attrs["peak_edge_pressure"] for each in found]
    means = [each["transmission_error"].values.mean() for each in found]
    measured(
        "finite elements of 0.5, 0.25, 0.125 mm: largest pressure at a tip's edge",
        ", ".join(f"{peak:.0f}" for peak in peaks),
        "grows: no limit",
        "MPa",
        row=31,
    )
    measured("change of the mean transmission error at the last halving", abs(means[2] / means[1] - 1.0), 2e-2, row=31)
    assert peaks[2] > peaks[0]
    assert all("sharp edge of the" in each.attrs["warnings"] for each in found)


WEDGED = {
    "misaligned by 0.2 mm": (misaligned(0.2), {"backlash": 0.01}),
    "misaligned, gears that tilt": (misaligned(0.2) + BEARINGS, {"backlash": 0.01}),
    "40 deg of helix": (misaligned(0.2), {"backlash": 0.01, "helix": 40.0, "teeth": (30, 50)}),
}


@pytest.mark.parametrize("torque", [0.0, pytest.param(1.0, marks=BY_NIGHT), TORQUE, pytest.param(6e6, marks=BY_NIGHT)])
@pytest.mark.parametrize(
    "name", [name if name == "misaligned by 0.2 mm" else pytest.param(name, marks=BY_NIGHT) for name in WEDGED]
)
def test_wedged_teeth(name, torque, measured):
    """Row 32. Equilibrium: what the drive flanks carry more than the coast flanks is the load; the run says that its
    teeth are wedged. With friction the laws hold too."""
    more, changes = WEDGED[name]
    found = on_stand_ins("\n[coast_flanks]\n" + more, torque=torque, **changes)
    obeys_the_laws(found)
    least = float(np.minimum(found.result["normal_force"], found.result["coast_normal_force"]).max())
    apart = force_error(found)
    measured(
        f"{name}, {torque:g} N mm: force that wedges, error of the force",
        f"{least:.2g} N, {apart:.1g}",
        "1e-11",
        row=32,
    )
    assert apart <= 1e-11
    assert (least > 0.0) == ("the teeth are wedged" in found.result.attrs["warnings"])
    assert least > 0.0 or torque == 6e6
    obeys_the_laws(on_stand_ins("\n[coast_flanks]\n" + more + FRICTION, torque=torque, **changes))
