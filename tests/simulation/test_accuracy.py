"""What the default accuracy is worth, and the settings of `[accuracy]`."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import coarse_scene, frictionless, teeth_alone

from fenics_gears import SceneError, model_of, scene_from_text, simulate
from fenics_gears.contact.interpolation import AVERAGED, COLLOCATED, INTERPOLATIONS, GearContacts
from fenics_gears.elasticity.element_sizes import DEFAULT_SIZES
from fenics_gears.runs.gear_store import cycle_key
from fenics_gears.scene.data import Accuracy, GearData, Motion
from fenics_gears.simulation.bodies import body_key


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


@pytest.fixture
def error_of(paper_scene):
    """Transmission error (12,), rad, of the paper's teeth alone without friction."""

    def run(scene=None, **accuracy):
        static = replace(scene or frictionless(teeth_alone(coarse_scene(paper_scene))), motion=Motion(200.0, 1, 1))
        settings = {"steps_per_mesh_cycle": 12, **accuracy}
        return simulate(replace(static, accuracy=replace(static.accuracy, **settings))).transmission_error.values

    return run


def test_defaults_are_the_limits_to_the_last_bit(paper_scene):
    """Exact: naming a default changes no bit."""
    scene = coarse_scene(paper_scene, cycles=1)
    named = {
        "body_element_size": scene.gears.module * DEFAULT_SIZES[1].body, "interpolation": AVERAGED, "elastic_teeth": 15,
    }  # fmt: skip
    expected = simulate(scene)
    for name, value in named.items():
        found = simulate(replace(scene, accuracy=replace(scene.accuracy, **{name: value})))
        for variable in expected.data_vars:
            assert np.array_equal(expected[variable], found[variable], equal_nan=True), (name, variable)


@pytest.mark.nightly
def test_teeth_that_feel_each_other(error_of, paper_scene):
    """Limit: as many teeth as are loaded together."""
    scene = frictionless(teeth_alone(coarse_scene(paper_scene)))
    module, teeth = 4.5, (40, 60)
    pinion, wheel = (
        GearData(z, 0.0, module * (z + 2.7), module * (z - 3.2), 0.7 * module * (z - 3.2), 0.2) for z in teeth
    )
    gears = replace(scene.gears, centre_distance=0.5 * module * sum(teeth) + 0.1, pinion=pinion, wheel=wheel)
    high = replace(scene, gears=gears)
    assert model_of(high).pair.contact_ratio > 2.0
    expected = error_of(high)
    errors = [np.abs(error_of(high, elastic_teeth=teeth) - expected).max() / expected.mean() for teeth in (1, 2, 3)]
    assert errors[0] > 0.1
    assert errors[1] < 0.3 * errors[0]
    assert errors[2] == 0.0


@pytest.mark.parametrize("order", [1, 2])
def test_collocation_takes_values_at_points(order):
    """Exact: a polynomial of the element's order is met at the contact nodes."""
    flank = np.sqrt(np.linspace(0.01, 0.36, 20 * order + 1))
    rolls = np.sqrt(np.linspace(0.011, 0.35, 37))
    ends = np.array([0, len(rolls)])
    (view,) = INTERPOLATIONS[COLLOCATED].of_flank(
        GearContacts(rolls, ends, rolls, np.array([0.4]), [flank], 30.0, 1, order)
    )
    for power in range(order + 1):
        assert view.weights @ flank ** (2 * power) == pytest.approx(rolls ** (2 * power), abs=1e-13)
    assert view.near.shape == (len(rolls), order + 1)


@pytest.mark.parametrize("change", [{"body_element_size": 1.0}, {"elastic_teeth": 1}, {"interpolation": COLLOCATED}])
def test_studies_keep_apart_what_differs(change, paper_scene):
    """What changes the operators changes a study's keys."""
    scene = coarse_scene(paper_scene)
    model, other = model_of(scene), model_of(replace(scene, accuracy=replace(scene.accuracy, **change)))
    assert cycle_key(model) != cycle_key(other)
    assert (body_key(model, "pinion") == body_key(other, "pinion")) == ("interpolation" in change)


@pytest.mark.parametrize("line", ['interpolation = "collocated"', "elastic_teeth = 2"])
def test_remeshing_refuses_what_it_does_not_have(line, paper_scene):
    """House rule: no option is ignored silently."""
    text = paper_scene.text.replace('condensation = "once"', f'condensation = "every step"\n{line}')
    with pytest.raises(SceneError, match='has no meaning with condensation = "every step"'):
        scene_from_text(text)
