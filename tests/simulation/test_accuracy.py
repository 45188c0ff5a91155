"""What the default accuracy is worth."""

from dataclasses import replace

import numpy as np
import pytest

from fenics_gears import model_of, simulate
from fenics_gears.scene.data import Accuracy


@pytest.fixture(scope="module")
def default_scene(quasi_static_scene):
    """The paper's pair, frictionless, quasi-static, with the program's own [accuracy]."""
    return replace(quasi_static_scene, friction=None, accuracy=Accuracy())


@pytest.fixture(scope="module")
def bare_scene(default_scene):
    return replace(default_scene, shafts=None, bearings=None)


STEPS = {"steps_per_mesh_cycle": 40}  # by day, where steps do not matter


@pytest.fixture(scope="module")
def bare(bare_scene):
    return simulate(replace(bare_scene, accuracy=Accuracy(**STEPS)))


def relative_change(value, reference):
    return abs(value / reference - 1.0)


@pytest.mark.nightly
@pytest.mark.parametrize("name", ["bare_scene", "default_scene"])
def test_halving_everything_moves_mean_and_peak_to_peak_by_less_than_half_a_per_cent(name, request):
    """Flank elements, contact spacing and time step halved; also without the drivetrain's share."""
    scene = request.getfixturevalue(name)
    result, resolution = simulate(scene), model_of(scene).resolution
    finer = replace(
        scene,
        accuracy=Accuracy(
            flank_element_size=0.5 * resolution.flank_element_size,
            contact_length=resolution.contact_grid.length,
            contact_nodes=2 * resolution.contact_grid.nodes - 1,
            steps_per_mesh_cycle=2 * resolution.steps_per_mesh_cycle,
        ),
    )
    fine = simulate(finer)
    for measure in ("mean_transmission_error", "peak_to_peak_transmission_error"):
        assert relative_change(result.attrs[measure], fine.attrs[measure]) < 0.005


def test_a_longer_window_changes_nothing_at_any_phase(bare_scene, bare):
    """model.md section 1: no phase moves by more than the 0.1 % ripple of the grid; 0.8 mm cuts hand-over off."""
    grid = model_of(bare_scene).resolution.contact_grid
    change = {}
    for nodes in (grid.nodes + 40, round(0.8 / grid.spacing) + 1):
        accuracy = Accuracy(contact_length=(nodes - 1) * grid.spacing, contact_nodes=nodes, **STEPS)
        error = simulate(replace(bare_scene, accuracy=accuracy)).transmission_error.values
        change[nodes > grid.nodes] = np.abs(error / bare.transmission_error.values - 1.0).max()
    assert change[True] < 1e-3
    assert change[False] > 1e-2
