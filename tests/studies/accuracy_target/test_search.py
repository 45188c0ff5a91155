"""What a choice of settings rests on, on errors and costs that are known."""

from itertools import product
from math import hypot, sqrt
from types import SimpleNamespace

import pytest

from fenics_gears.runs.settings.target import RATIO, _chosen, errors_at, even, first_sizes, round_steps, search
from fenics_gears.runs.settings.trial_runs import (
    FEWEST_STEPS,
    MESH,
    ROUND_STEPS,
    SLICES,
    STEPS,
    Sizes,
    TargetNotReached,
)

TRIED = Sizes(2.0, 60)


class KnownRuns:
    """Errors `constants` times the square of the size, costs a power of both; sizes below `finest` are beyond the
    limits."""

    fewest_steps, slices, step_unit = FEWEST_STEPS, 0, ROUND_STEPS

    def __init__(self, constants, powers=(2.0, 1.0), finest=0.0, order=2.0, steps_matter=True):
        self.constants, self.powers, self.finest, self.order = constants, powers, finest, order
        self.steps_matter, self.runs, self.tried = steps_matter, 0, []

    def errors(self, sizes):
        self.runs += 3
        self.tried.append(sizes)
        found = {MESH: self.constants[0] * sizes.mesh**self.order, STEPS: self.constants[1] / sizes.steps**self.order}
        return found if self.steps_matter else {MESH: found[MESH]}

    def cost(self, sizes):
        if sizes.mesh < self.finest:
            raise TargetNotReached("too fine")
        return sizes.mesh ** -self.powers[0] * sizes.steps ** self.powers[1]

    def setting(self, sizes):
        return SimpleNamespace(sizes=sizes, words=str(sizes), accuracy=lambda module: (module, sizes))


@pytest.mark.parametrize("target", [0.02, 0.005, 0.001])
@pytest.mark.parametrize("powers", [(2.0, 1.0), (1.0, 1.0), (1.0, 2.0)])
def test_the_cheapest_sizes_are_lagranges(target, powers):
    """Lagrange's multiplier: errors of order 2 and a cost mesh^-a steps^b share squares of errors as a to b."""
    runs = KnownRuns((0.005, 0.02 * 60**2), powers)
    errors = runs.errors(TRIED)
    found = search(runs, TRIED, errors, target)
    a, b = powers
    best_mesh = (target * sqrt(a / (a + b)) / runs.constants[0]) ** 0.5
    best_steps = (runs.constants[1] / (target * sqrt(b / (a + b)))) ** 0.5
    assert hypot(*errors_at(TRIED, errors, found).values()) <= target
    assert found.steps % ROUND_STEPS == 0
    least = best_mesh**-a * best_steps**b
    # Steps are rounded up; meshes are searched by their ratio.
    assert least * (1.0 - 1e-9) <= runs.cost(found) <= least * RATIO**a * (1.0 + ROUND_STEPS / best_steps) ** b


def test_errors_that_do_not_fall_are_refused():
    """An error of order 0."""
    with pytest.raises(TargetNotReached, match="do not fall"):
        _chosen(KnownRuns((0.1, 0.1), order=0.0), 0.002)


def test_sizes_beyond_the_limits_are_not_chosen_and_the_reachable_target_is_named():
    """Exact: the mesh's error alone, up to the search's steps."""
    runs = KnownRuns((0.01, 0.0), finest=0.99, steps_matter=False)
    assert search(runs, TRIED, {MESH: 0.04}, 0.011).mesh >= 0.99
    with pytest.raises(TargetNotReached, match=r"^too fine; 1 % can be reached$"):
        _chosen(runs, 0.002)
    runs.finest = 100.0
    with pytest.raises(TargetNotReached, match="^too fine$"):
        _chosen(runs, 0.002)


@pytest.mark.parametrize("target", [0.5, 0.05, 0.01, 0.002, 0.0005])
def test_first_sizes_go_with_the_root_of_the_target(target):
    """Order 2; halves of the steps are whole numbers."""
    sizes, coarser = (first_sizes(each, KnownRuns((0.0, 0.0))) for each in (target, 4.0 * target))
    assert coarser.mesh <= 2.0 * sizes.mesh * (1.0 + 1e-12) and sizes.steps <= 2 * coarser.steps
    assert sizes.steps % ROUND_STEPS == 0 and sizes.steps >= FEWEST_STEPS and round_steps(1, ROUND_STEPS) == ROUND_STEPS


class KnownRunsOverFace(KnownRuns):
    """With slices: errors of order 2, a cost of their square."""

    slices = 20
    expected = {MESH: 0.001, SLICES: 0.0025}

    def errors(self, sizes):
        return super().errors(sizes) | {SLICES: 0.02 * (10 / sizes.slices) ** 2}

    def cost(self, sizes):
        return super().cost(sizes) * (1.0 + 0.02 * sizes.slices**2)


@pytest.mark.parametrize("steps_matter", [True, False])
@pytest.mark.parametrize("target", [0.05, 0.01])
def test_slices_are_chosen_beside_mesh_and_steps(steps_matter, target):
    """Brute force: nothing that reaches the target is much cheaper. Errors are twice those of two runs."""
    runs = KnownRunsOverFace((0.002, 0.004 * 60**2), steps_matter=steps_matter)
    tried = first_sizes(target, runs)
    assert tried.slices == even(max(16, 20 * sqrt(2.0 * sqrt(2.0) * 0.0025 / target)))
    errors = runs.errors(tried)
    found = search(runs, tried, errors, target)
    assert hypot(*errors_at(tried, errors, found).values()) <= target
    candidates = (
        Sizes(tried.mesh / RATIO**place, steps, slices)
        for place, slices, steps in product(
            range(18),
            range(tried.slices // 2, 40),
            range(tried.steps, 161, ROUND_STEPS) if steps_matter else [tried.steps],
        )
    )
    least = min(runs.cost(each) for each in candidates if hypot(*errors_at(tried, errors, each).values()) <= target)
    # A step of the mesh apart, by which costs change by its square.
    assert runs.cost(found) <= RATIO**2 * least
