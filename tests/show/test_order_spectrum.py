"""Orders of the transmission error."""

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.text import Annotation
from tests.show.synthetic import made_up_run

from fenics_gears.results.spectrum import BOTH, HUNTING, MESH, PINION, WHEEL, origin
from fenics_gears.show.plots import run_figures

TEETH, PERIOD, STEPS = (16, 24), 48, 40
ERRORS = '\n[flank_errors.wheel.waviness]\namplitude = "1 um"\nwaves = 90\n[eccentricity.pinion]\ndistance = "10 um"\n'


def error_of(lines, cycles):
    """A sum of cosines (order, amplitude), with a mean."""
    turns = np.arange(int(cycles * STEPS) + 1) / (STEPS * TEETH[0])
    return 5.0 + sum(amplitude * np.cos(2.0 * np.pi * order * turns + order) for order, amplitude in lines)


def test_orders_are_told_by_what_they_come_back_with():
    """Arithmetic: 16 and 24 teeth; order k/3 is a whole number of turns of the pinion or, times 3/2, of the wheel."""
    expected = {
        16.0: MESH,
        32.0: MESH,
        1.0: PINION,
        37.0: PINION,
        2.0 / 3.0: WHEEL,
        16.0 + 2.0 / 3.0: WHEEL,
        2.0: BOTH,
        1.0 / 3.0: HUNTING,
    }
    assert {order: origin(order, TEETH) for order in expected} == expected


def order_spectrum(run):
    return run_figures(run).get("order_spectrum.png")


def made_up_turns(scene, cycles=float(PERIOD)):
    run = made_up_run(steps=int(cycles * STEPS) + 1, cycles=cycles, nodes=3, scene=scene)
    lines = [(1.0, 2e-4), (16.0, 3e-4), (60.0, 1e-5)]
    return run.assign(transmission_error=("time", error_of(lines, cycles) * 1e-3, {"units": "rad"}))


def test_the_picture_names_mesh_orders_run_out_and_ghosts(paper_scene):
    """Amplitudes on the wheel's base circle; 90 waves on the wheel are order 60 of the pinion's shaft."""
    run = made_up_turns(paper_scene.text + ERRORS)
    axes = order_spectrum(run).axes[0]
    flags = {text.get_text().strip(): text.xy for text in axes.texts if isinstance(text, Annotation)}
    assert {"mesh", "2 × mesh", "run-out of the pinion", "ghost order: 90 waves on the wheel"} <= set(flags)
    assert axes.get_yscale() == "log"
    drawn = [each for each in axes.collections if isinstance(each, PolyCollection)]
    bars = {
        each.get_label(): [(path.vertices[:4, 0].mean(), path.vertices[:, 1].max()) for path in each.get_paths()]
        for each in drawn
    }
    # The base radius of the made-up result is 50 mm.
    assert bars["mesh"] == [pytest.approx((16.0, 3e-7 * 50e3), rel=1e-9)]
    assert (1.0, 2e-7 * 50e3) in [
        pytest.approx(bar, rel=1e-9) for bar in bars["turn of either gear"] + bars["turn of the pinion"]
    ]
    assert flags["ghost order: 90 waves on the wheel"] == pytest.approx((60.0, 1e-8 * 50e3), rel=1e-9)


def test_a_run_of_a_turn_has_the_picture_and_a_shorter_one_has_not(paper_scene):
    """From a turn of the pinion on, 16 mesh cycles; needs the scene for the teeth."""
    for cycles, there in ((15.0, False), (16.0, True), (20.0, True)):
        assert ("order_spectrum.png" in run_figures(made_up_turns(paper_scene.text, cycles))) == there
    assert order_spectrum(made_up_turns("")) is None
    windowed = order_spectrum(made_up_turns(paper_scene.text, 20.0)).axes[0]
    title = windowed.get_title(loc="left")
    # What is drawn is said once, by the heading.
    assert windowed.figure._suptitle.get_text().startswith("Orders of the transmission error") and "rders" not in title
    assert "20 mesh cycles" in title and "repeats after 48" in title
