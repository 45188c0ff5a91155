"""Scenes that failed once: rows 1 to 3 at every step, every step converged."""

from pathlib import Path

import numpy as np
import pytest
from tests.hard_cases.invariants import run_of, worst_of
from tests.hard_cases.test_any_scene import LAWS, on_elements

from fenics_gears import load_scene, model_of

FOUND = sorted(Path(__file__).with_name("found_scenes").glob("*.toml"))


def checked(file, cache):
    """Every step of a scene, converged and obeying the laws."""
    model = model_of(load_scene(file))
    run = run_of(model, on_elements(cache)(model))
    assert run.failure is None
    assert len(run.records) == model.steps + 1
    for name, value in worst_of(run).items():
        # Without load there is no direction to speak of where friction acts.
        assert value <= LAWS[name][2] or (
            model.scene.load.wheel_torque == 0.0 and name in ("wrong_way", "dissipation")
        ), name
    return run


@pytest.mark.parametrize("file", [file for file in FOUND if "no_load" in file.stem], ids=lambda file: file.stem)
def test_a_scene_without_load_that_failed_once_converges(file, suite_cache):
    """Row 16: nodes that carry no more than round-off have no friction."""
    run = checked(file, suite_cache)
    spurious = max(np.abs(record.solution.forces).max(initial=0.0) for record in run.records)
    assert run.model.scene.load.wheel_torque == 0.0 and spurious <= 1e-8


@pytest.mark.parametrize("file", [file for file in FOUND if "no_load" not in file.stem], ids=lambda file: file.stem)
def test_a_scene_that_failed_once_converges(file, suite_cache):
    """Rows 1 to 3, of contact that has a solution."""
    checked(file, suite_cache)
