"""Runs that are solved together against the same runs one by one."""

from dataclasses import replace
from math import isclose

import numpy as np
import pytest
from tests.coarse import coarse_scene, frictionless, quasi_static
from tests.hard_cases.invariants import cycle_of
from tests.helical import CROWNED, FRICTION, helical_scene, on_stand_in_bodies
from tests.planets import COARSE, planetary_text

from fenics_gears import model_of, simulate_train, train_from_text
from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.dynamics.block import Block
from fenics_gears.effects.coast_flanks import CoastFlanks
from fenics_gears.effects.tip_relief import TipRelief
from fenics_gears.errors import ComputationError, MemoryEnded
from fenics_gears.geometry.lead_modification import LeadModification, LeadModifications
from fenics_gears.geometry.misalignment import Misalignment
from fenics_gears.geometry.profile_modification import ProfileModification, ProfileModifications
from fenics_gears.geometry.relief import Relief
from fenics_gears.model.train import train_model_of
from fenics_gears.results.planetary import OF_SETS
from fenics_gears.results.together import ERROR, OFFERED, OVER_FACE
from fenics_gears.runs.common_windows import CommonWindows
from fenics_gears.runs.gear_store import GearStore, operators_key
from fenics_gears.runs.one_run import completed
from fenics_gears.scene.data import Load
from fenics_gears.simulation import together
from fenics_gears.simulation.elastic_route import gaps_of
from fenics_gears.simulation.together import alike, can_be_solved_together, sets_solved_together, solved_together

# What a run by itself counts differently: how long it took and how often Newton's method was applied, by the sets that
# the runs before it left.
OF_ITS_OWN = ("wall_time", "time_march", "newton_iterations_total")
RELIEF = TipRelief(*(Relief(9e-3, length_on_path=3.0) for _ in "pw"))


def designs(scene):
    def both(depth, length, shape="linear"):
        return TipRelief(*(Relief(depth, length_on_path=length, shape=shape) for _ in "pw"))

    crowned = ProfileModifications(ProfileModification(crowning=3e-3, slope=-2e-3), ProfileModification(slope=4e-3))
    changes = [
        {"tip_relief": both(0.01, 4.0)},
        {"tip_relief": both(0.03, 6.0, "parabolic")},
        {"tip_relief": both(0.02, 5.0), "profile_modifications": crowned},
        {"tip_relief": both(0.025, 5.0), "profile_modifications": crowned},
        {"tip_relief": TipRelief(Relief(0.02, length_on_path=5.0), None)},
        {"tip_relief": both(0.02, 7.0), "load": Load(300e3)},
        {"tip_relief": None},
    ]
    return [replace(scene, **change) for change in changes]


def sharing(scene, flanks):
    """Runs on the same operators, with gaps of their own, on teeth without finite elements."""
    model = model_of(scene)
    mesh, tangential = elastic_mesh(flanks, model.resolution.contact_grid), scene.friction is not None
    cycle = Cycle(mesh, model.resolution.steps_per_mesh_cycle, model.drivetrain.indices, tangential)
    return lambda model, *_: ((), cycle.with_gaps(gaps_of(model, cycle)))


def steady(paper_scene, friction, cycles=1):
    scene = quasi_static(coarse_scene(paper_scene, cycles))
    return scene if friction else frictionless(scene)


@pytest.mark.parametrize("friction", [False, True], ids=["frictionless", "with friction"])
@pytest.mark.parametrize("cycles", [1, 2])
def test_runs_together_have_the_numbers_of_runs_alone(paper_scene, stand_in_flanks, friction, cycles):
    """Identity, to the last digit. With friction each has a step through stick."""
    scene = steady(paper_scene, friction, cycles)
    models, preparation = [model_of(each) for each in designs(scene)], sharing(scene, stand_in_flanks)
    assert can_be_solved_together(models[0], OFFERED)
    assert all(alike(models[0], model) for model in models)
    for single in the_same_alone(models, preparation):
        assert ("steps_by_rung: slip through stick" in single.attrs) == friction


def the_same_alone(models, preparation, round_off=0.0):
    """The runs by themselves, whose numbers are those together; energies of several mesh cycles are summed up in
    others' order."""
    for model, numbers in zip(models, solved_together(models, preparation, OFFERED)):
        single = completed(model, preparation)
        asked = {name for name in OFFERED if name in single.attrs}
        assert asked >= {ERROR, "largest_pair_force", "peak_contact_pressure"} and asked <= numbers.attrs.keys()
        shared = {name for name in numbers.attrs if name in single.attrs} - {*OF_ITS_OWN}
        for name in shared:
            value = single.attrs[name]
            expected = pytest.approx(value, rel=round_off) if round_off and not isinstance(value, str) else value
            assert numbers.attrs[name] == expected, name
        assert np.array_equal(numbers["normal_force"], single["normal_force"])
        assert np.array_equal(numbers["transmission_error"], single["transmission_error"])
        yield single


def over_the_face(more=""):
    """Designs of a helical pair, and what prepares them on bodies without finite elements."""
    few = "slices = 5\ncontact_nodes = 37\nsteps_per_mesh_cycle = 8\n"
    few += 'contact_length = "3 mm"\nflank_element_size = "0.2 mm"'
    designs = [
        {}, {"tip_relief": RELIEF}, {"tip_relief": RELIEF, "misalignment": Misalignment(in_plane=0.014)},
        {"lead_modifications": LeadModifications(LeadModification(crowning=4e-3, helix_slope=-6e-3), None)},
        {"misalignment": Misalignment(in_plane=-0.02, out_of_plane=0.005), "load": Load(150e3)},
    ]  # fmt: skip
    scene = helical_scene(CROWNED + more, accuracy=few, cycles=2)
    models = [model_of(replace(scene, **each)) for each in designs]
    gears = on_stand_in_bodies(models[0])
    return models, CommonWindows().of(models), lambda model: ((), cycle_of(model, gears))


@pytest.mark.parametrize("more", ["", FRICTION + "\n[coast_flanks]\n"], ids=["frictionless", "friction, coast flanks"])
def test_runs_over_a_face_together_have_the_numbers_of_runs_alone(more):
    """Identity, load factors among them."""
    _, models, prepared = over_the_face(more)
    cycle = prepared(models[0])[1]
    preparation = lambda model, *_: ((), cycle.with_gaps(gaps_of(model, cycle)))  # noqa: E731
    assert can_be_solved_together(models[0], OFFERED)
    assert all(alike(models[0], model) and operators_key(models[0]) == operators_key(model) for model in models)
    # No slice of five is near an end.
    factors = {*OVER_FACE} - {"edge_line_load_factor"}
    assert all(factors <= single.attrs.keys() for single in the_same_alone(models, preparation, 1e-12))


def test_a_longer_window_of_contact_nodes_changes_nothing():
    """Brute force: runs in windows of their own, of which there are several."""
    own, common, prepared = over_the_face()
    assert len({operators_key(model) for model in own}) > 1 == len({operators_key(model) for model in common})
    for model, longer in zip(own, common):
        single, other = (completed(each, lambda model, *_: prepared(model)) for each in (model, longer))
        assert np.allclose(single["transmission_error"], other["transmission_error"], rtol=1e-12)
        assert isclose(single.attrs[ERROR], other.attrs[ERROR], rel_tol=1e-9)


def test_runs_whose_operators_cannot_all_be_held_are_left_to_themselves():
    """Property: as many at once as there is room for."""
    _, (model, *_), prepared = over_the_face()
    cycle, most = prepared(model)[1], []
    for room in (1e5, 1e8, 1e10):
        cycle.kept.most = room
        most.append(together._most_at_once(model, cycle))
    assert most[0] == 0 < most[1] < most[2]


def test_only_what_is_asked_for_is_found(paper_scene, stand_in_flanks):
    """Definition: T_EPP as beside all others; the largest force, which steps alone would give wrong, is not there."""
    scene = steady(paper_scene, False)
    models, preparation = [model_of(each) for each in designs(scene)[:2]], sharing(scene, stand_in_flanks)
    few, many = (solved_together(models, preparation, asked) for asked in ([ERROR], OFFERED))
    assert [each.attrs[ERROR] for each in few] == [each.attrs[ERROR] for each in many]
    assert not {"largest_pair_force", "peak_contact_pressure"} & few[0].attrs.keys()


def test_a_run_of_which_there_is_more_to_say_is_left_to_itself(paper_scene, stand_in_flanks, monkeypatch):
    """`numbers_together`: a torque a hundred times as large; steps without solution, made up."""
    scene = steady(paper_scene, False)
    models, preparation = [model_of(each) for each in designs(scene)[:3]], sharing(scene, stand_in_flanks)
    through = model_of(replace(models[0].scene, load=Load(80e6)))
    found = solved_together([models[1], through], preparation, [ERROR])
    assert found[0] is not None and found[1] is None
    assert "the result has no meaning" in completed(through, preparation).attrs["warnings"]
    solve = Block.solve

    def failing(block, run, end):
        solve(block, run, end)
        if run == 1 and end > 3:
            raise ContactNotConverged([], "made up")

    monkeypatch.setattr(Block, "solve", failing)
    assert [each is None for each in solved_together(models, preparation, [ERROR])] == [False, True, False]


def test_which_runs_are_solved_together(paper_scene):
    """Definition: quasi-static plane runs that differ in load and reliefs."""
    scene = steady(paper_scene, True)
    model = model_of(scene)
    assert can_be_solved_together(model, [ERROR]) and not can_be_solved_together(model, [ERROR, "rms_normal_force"])
    assert not can_be_solved_together(model_of(coarse_scene(paper_scene)), [ERROR])
    for changed in (
        {"friction": replace(scene.friction, coefficient=0.05)},
        {"motion": replace(scene.motion, mesh_cycles=3)},
        {"coast_flanks": CoastFlanks()},
    ):
        assert not alike(model, model_of(replace(scene, **changed)))
    assert alike(model, model_of(replace(scene, load=Load(1.0), title="another", tip_relief=TipRelief(None, None))))


def test_an_error_of_all_is_raised(paper_scene, stand_in_flanks, monkeypatch):
    """Memory that is too small for one run is too small for all."""
    scene = steady(paper_scene, False)
    monkeypatch.setenv("FENICS_GEARS_MEMORY", "1 MB")
    with pytest.raises(ComputationError, match="memory"):
        solved_together([model_of(scene)], sharing(scene, stand_in_flanks), [ERROR])


@pytest.mark.parametrize("raised, told", [(KeyboardInterrupt, KeyboardInterrupt), (MemoryError, MemoryEnded)])
def test_what_ends_all_marches_is_raised(paper_scene, stand_in_flanks, monkeypatch, raised, told):
    """The user's expectation: Ctrl-C ends a search, with no numbers of half a march; memory has an error of its own,
    after which runs are tried one by one."""

    def ended(*_):
        raise raised

    scene = steady(paper_scene, False)
    models = [model_of(each) for each in designs(scene)[:2]]
    monkeypatch.setattr(Block, "solve", ended)
    with pytest.raises(told):
        solved_together(models, sharing(scene, stand_in_flanks), [ERROR])


def test_sets_together_have_the_numbers_of_sets_alone():
    """Identity, to round-off: pins beside their places, a sun that runs out, another torque."""
    texts = [
        planetary_text(
            more=f'carrier.pin_errors = ["{pin} um", "-5 um"]\neccentricity.sun.distance = "{out} um"',
            accuracy=f'{COARSE}\ncontact_length = "4 mm"\ncontact_nodes = 20',
            load=f'input_torque = "{torque} N m"',
            sections='[motion]\ninput_speed = "1500 rpm"\nmesh_cycles = 3',
        )
        for pin, out, torque in ((10, 5, 600), (25, 8, 600), (25, 5, 610))
    ]
    models = [train_model_of(train_from_text(text)) for text in texts]
    assert all(can_be_solved_together(model, OF_SETS) for model in models)
    assert all(alike(models[0], model) for model in models)
    for numbers, model in zip(sets_solved_together(models, GearStore().row), models):
        alone = simulate_train(model).attrs
        assert {name: numbers.attrs[name] for name in OF_SETS} == pytest.approx(
            {name: alone[name] for name in OF_SETS}, rel=1e-12
        )
