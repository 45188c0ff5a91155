"""The demonstration of tip relief, on coarse teeth."""

from dataclasses import replace

import numpy as np
import pytest
from demos.tip_relief import findings, pictures
from demos.tip_relief.design import PARABOLIC, Bench, Design, conditions, paper_scene
from demos.tip_relief.optimum import ALLOWED, Optimum, optimum
from demos.tip_relief.table import table
from tests.coarse import COARSE

from fenics_gears.runs.gear_store import GearStore


@pytest.fixture(scope="module")
def benches():
    """One for every condition, and one of teeth alone without friction."""
    store = GearStore()
    made = {name: Bench(scene, store) for name, scene in conditions(paper_scene(COARSE)).items()}
    return made | {"teeth alone": Bench(replace(made[findings.STIFF].scene, friction=None), store)}


@pytest.fixture(scope="module")
def best(benches):
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("demos.tip_relief.optimum.SEARCHED", 60)
        return optimum(benches["μ = 0"])


@pytest.mark.nightly
def test_the_chosen_relief_is_the_best(benches, best):
    """Definition of a minimum: nothing of a coarse map or beside it is better; a micrometre more is left at both
    ends."""
    bench, design, least = benches["μ = 0"], best.design, best.peak_to_peak
    around = findings.relief_map(bench, np.array([0.0, 15.0, 30.0, 45.0]), np.array([0.5, 0.8, 1.0, 1.3]))
    assert least < around.left.min()
    for depth, length in ((1.5, 0.0), (-1.5, 0.0), (0.0, 0.06), (0.0, -0.06), (1.5, -0.05), (-1.5, 0.05)):
        assert bench.peak_to_peak(Design(design.depth + depth, design.length + length)) > least
    for depth in best.depths:
        assert bench.peak_to_peak(replace(design, depth=depth)) == pytest.approx(least + ALLOWED, abs=0.35)
    # The README's numbers, on coarser teeth.
    assert 25.0 < design.depth < 36.0 and 0.8 < design.length < 1.15
    assert least < 0.25 * bench.peak_to_peak(None)


@pytest.mark.nightly
def test_pictures_and_table_say_what_was_measured(benches, best):
    """Axes with units, optima marked where they are."""
    bench, designs = benches["μ = 0"], findings.compared(best.design)
    small = findings.Map(
        np.array([0.0, 20.0, 40.0]),
        np.array([0.5, 1.0, 1.5]),
        np.array([[13.0, 13.0, 13.0], [13.0, 2.5, 6.0], [13.0, 8.0, 9.0]]),
    )
    other = Optimum(Design(25.0, 1.0), 11.0, (20.0, 31.0), (0.8, 1.2))
    optima = {
        ("μ = 0", "linear"): best,
        ("μ = 0.1", "linear"): other,
        ("μ = 0", PARABOLIC): replace(other, design=Design(33.0, 1.3, PARABOLIC)),
    }
    curves = {
        (name, which): bench.error(designs[which])
        for name in findings.DRAWN
        for which in ("true involutes", "best relief")
    }
    torques = bench.torque(np.array([0.1, 1.0, 2.0]))
    loads = torques, {(name, which): np.array([3.0, 2.0, 9.0]) for name in findings.DRAWN for which in designs}
    shown = {name: optima[name, "linear"] for name in findings.DRAWN}
    figure = pictures.draw_choice(dict.fromkeys(findings.DRAWN, small), shown, curves, loads)
    maps = [axes for axes in figure.axes if axes.get_xlabel() == pictures.LENGTH]
    marks = [
        [(line.get_xdata()[0], line.get_ydata()[0]) for line in axes.get_lines() if line.get_marker() == "o"][0]
        for axes in maps
    ]
    assert marks == [(each.design.length, each.design.depth) for each in shown.values()]
    assert all("(" in axes.get_xlabel() or "µm" in axes.get_ylabel() for axes in figure.axes)
    harris = pictures.draw_harris_map(bench, designs, (0.5, 1.0))
    assert [len(axes.get_lines()) for axes in harris.axes] == [2, 2, 2] and "(µm)" in harris.axes[0].get_ylabel()
    text = table(
        {name: benches[name] for name in findings.DRAWN},
        benches["teeth alone"],
        optima,
        designs,
        loads=(1.0,),
        tolerance=5.0,
    )
    assert f"| μ = 0 | linear | {best.design.depth:.1f} | {best.design.length:.2f} | {best.peak_to_peak:.1f} |" in text
    assert "| 0.874 N m | 437 N m |" in text
