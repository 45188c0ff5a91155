"""Row 24: time steps a thousand times too large: finite, bounded energy, and words on what the step resolves."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import COARSE, quasi_static

from fenics_gears import model_of, simulate
from fenics_gears.dynamics.frequencies import PERIOD_ERROR
from fenics_gears.dynamics.guidance import resolved_frequency, steps_to_resolve
from fenics_gears.model.description import describe
from fenics_gears.scene.data import Motion


def light(scene):
    """The same with a millionth of the inertia: every natural frequency a thousand times as high."""
    inertia = scene.inertia
    return replace(
        scene,
        inertia=replace(
            inertia, **{name: 1e-6 * value for name, value in vars(inertia).items() if isinstance(value, float)}
        ),
    )


CASES = {
    "2 steps per mesh cycle at 17 Hz": lambda scene: (scene, 17.0, 2),
    "2 steps per mesh cycle at 200 Hz": lambda scene: (scene, 200.0, 2),
    "40 steps at 200 Hz, natural frequencies x 1000": lambda scene: (light(scene), 200.0, 40),
    "3 steps per mesh cycle at 400 Hz": lambda scene: (scene, 400.0, 3),
}


# By day each once, damped or not.
EACH = [
    pytest.param(name, damped, marks=[] if damped == (place % 2 == 1) else pytest.mark.nightly)
    for place, name in enumerate(CASES)
    for damped in (True, False)
]


@pytest.mark.parametrize(("name", "damped"), EACH)
def test_large_steps_are_finite_bounded_and_named(coarse, name, damped, measured):
    """Energy: backward Euler gives none, average acceleration may carry what the start brought; twice the static
    energy bounds both."""
    scene, mesh_frequency, steps = CASES[name](coarse if damped else replace(coarse, damping=None))
    scene = replace(scene, accuracy=replace(COARSE, steps_per_mesh_cycle=steps), motion=Motion(mesh_frequency, 60, 60))
    result, static = simulate(scene), simulate(quasi_static(scene))
    ratio = result.energy.values.max() / static.energy.values.max()
    words = "damped" if damped else "undamped"
    measured(f"largest energy / static energy, {name}, {words}", ratio, 2.0)
    assert np.all(np.isfinite(result.transmission_error.values))
    said = [line for line in result.attrs["warnings"].splitlines() if f"within {PERIOD_ERROR:.0%} up to" in line]
    assert len(said) == 1 and f"up to {resolved_frequency(model_of(scene).time_step):.4g} Hz" in said[0]
    assert said[0] in [words for _, words, _ in dict(describe(scene))["Warnings"]]


def test_the_remedy_is_a_remedy(coarse):
    """With the steps that the warning asks for it has nothing more to say."""
    undamped = replace(coarse, damping=None)
    frequencies = [vibration.frequency for vibration in model_of(undamped).vibrations]
    needed = steps_to_resolve(frequencies[-1], 200.0)
    for steps, silent in ((needed, True), (needed - 2, False)):
        scene = replace(undamped, accuracy=replace(COARSE, steps_per_mesh_cycle=steps))
        said = [words for words in model_of(scene).warnings if "does not resolve" in words]
        assert (not said) == silent
        if said:
            assert f"steps_per_mesh_cycle = {needed} instead of {steps}" in said[0]


@pytest.mark.nightly
def test_inertia_that_does_not_matter_is_named_and_its_effect_is_of_the_size_said(coarse, measured):
    """The quasi-static solver: the estimate of the difference is right within a factor of ten."""
    from fenics_gears.dynamics.guidance import effect_of_inertia

    scene = replace(coarse, friction=None, accuracy=replace(COARSE, steps_per_mesh_cycle=600), motion=Motion(1.0, 2, 1))
    (said,) = [words for words in model_of(scene).warnings if "inertia hardly matters" in words]
    assert "leave out [inertia] and [damping]" in said
    labels = [label for label, _, _ in dict(describe(scene))["Expected cost (about, alone on an idle machine)"]]
    assert {"quasi-static instead: marching", "quasi-static instead: memory"} <= set(labels)
    dynamic, static = simulate(scene).transmission_error.values, simulate(quasi_static(scene)).transmission_error.values
    difference = np.sqrt(np.mean((dynamic - static) ** 2)) / np.ptp(static)
    expected = effect_of_inertia(model_of(scene).vibrations[0], 1.0)
    measured("1 Hz: difference from quasi-static / peak-to-peak value", difference, f"{expected:.2g} expected")
    assert 0.1 <= difference / expected <= 10.0
    assert not any("inertia hardly" in words for words in model_of(replace(scene, motion=Motion(100.0, 2, 1))).warnings)
