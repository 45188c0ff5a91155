"""Whole settings of `gears accuracy`: fronts and charged errors of numbers known exactly."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fenics_gears import ComputationError
from fenics_gears.extensions.measuring.accuracy import whole
from fenics_gears.extensions.measuring.accuracy.refinement import Level, Refinement
from fenics_gears.runs.settings import measures
from fenics_gears.runs.settings.measures import SPAN
from fenics_gears.runs.settings.setting import Setting

BASE = Setting("P2", 0.04, 0.04, 3.2, 0.5, 80)


def brute_front(points):
    def beaten(mine, other):
        return other[0] <= mine[0] and other[1] <= mine[1] and other != mine

    return {mine for mine in points if not any(beaten(mine, other) for other in points)}


@pytest.mark.parametrize("seed", range(20))
def test_the_front_is_that_of_comparing_each_with_each(seed):
    """Definition, with ties and equal points."""
    random = np.random.default_rng(seed)
    points = [tuple(map(float, point)) for point in random.integers(1, 9, size=(25, 2))]
    front = whole.pareto_front(points)
    assert {points[place] for place in front} == brute_front(points)
    assert len({points[place] for place in front}) == len(front)
    assert [points[place][0] for place in front] == sorted(points[place][0] for place in front)


def test_errors_that_cancel_are_no_accuracy():
    """+5 % and -5 % give the right answer and are charged 10 %."""

    def span(h, k):
        return np.array([10.0 * (1.0 + 0.05 * h**2 - 0.05 * k**2)])

    exact = {SPAN: span(0.0, 0.0)}
    direct = measures.distance({SPAN: span(1.0, 1.0)}, exact, SPAN)
    parts = {
        "h": measures.distance({SPAN: span(1.0, 0.0)}, exact, SPAN),
        "k": measures.distance({SPAN: span(0.0, 1.0)}, exact, SPAN),
    }
    assert direct == 0.0
    assert whole.total_error(direct, parts) == pytest.approx(0.10)
    honest = whole.total_error(
        measures.distance({SPAN: span(0.5, 0.5)}, exact, SPAN), {name: 0.25 * part for name, part in parts.items()}
    )
    assert honest == pytest.approx(0.025)
    assert whole.pareto_front([(1.0, whole.total_error(direct, parts)), (1.5, honest)]) == [0, 1]


def refinement(name, field, values, expected=2.0):
    levels = tuple(Level(str(value), replace(BASE, **{field: value}), float(value)) for value in values)
    return Refinement(name, (field,), levels, expected, "made up", BASE)


FLANK, STEPS = refinement("flank", "flank", (0.16, 0.08, 0.04)), refinement("steps", "steps", (20, 40, 80, 160))
ERRORS = {("flank", 0): 0.08, ("flank", 1): 0.02, ("flank", 2): 0.005}
ERRORS |= {("steps", place): error for place, error in enumerate((0.2, 0.05, 0.012, 0.003))}


def test_the_path_refines_what_limits_it():
    """By hand; 0.28, 0.13, 0.07, 0.032, 0.017 by turns of the larger error."""
    found = [(setting.flank, setting.steps) for setting in whole.path(BASE, [FLANK, STEPS], ERRORS)]
    assert found == [(0.16, 20), (0.16, 40), (0.08, 40), (0.08, 80), (0.04, 80), (0.04, 160)]


def test_settings_of_targets(monkeypatch):
    """Definition: what `choose` gives; a target that cannot be reached joins the failures by its first line."""

    def choose(scene, target, progress):
        if target < 0.01:
            raise ComputationError("is not reached\nand why")
        return SimpleNamespace(setting=BASE)

    monkeypatch.setattr(whole, "choose", choose)
    failures = []
    assert whole.settings_of(None, (0.1, 0.001), None, failures) == {"target 10 %": (BASE, 0.1)}
    assert failures == [("target 0.1 %", "is not reached")]
