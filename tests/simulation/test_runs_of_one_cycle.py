"""What runs on one mesh cycle share."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import coarse_scene
from tests.hard_cases.invariants import cycle_of
from tests.helical import CROWNED, FRICTION, helical_scene, on_stand_in_bodies

from fenics_gears import simulate
from fenics_gears.contact.mesh_cycle import Cycle, in_common
from fenics_gears.model.model import model_of
from fenics_gears.results.recorder import Recorder
from fenics_gears.runs.common_windows import CommonWindows
from fenics_gears.runs.gear_store import GearStore, cycle_key, operators_key
from fenics_gears.scene.data import Motion
from fenics_gears.simulation import dynamic_factor


def variants(paper_scene) -> list:
    """A scene, and the same at another speed and torque."""
    scene = replace(coarse_scene(paper_scene), motion=Motion(200.0, 2, 1))
    return [
        scene,
        replace(scene, motion=Motion(310.0, 2, 1)),
        replace(scene, load=replace(scene.load, wheel_torque=0.5 * scene.load.wheel_torque)),
    ]


def test_runs_that_share_a_cycle_are_those_that_do_not(paper_scene, monkeypatch):
    """Brute force: each run with its own cycle, to the last bit."""
    scenes, store, recorders = variants(paper_scene), GearStore(), []
    alone = [simulate(scene) for scene in scenes]
    monkeypatch.setattr(
        dynamic_factor, "Recorder", lambda *given, **named: recorders.append(given) or Recorder(*given, **named)
    )
    for scene, expected in zip(scenes, alone):
        found = simulate(scene, preparation=store.prepared)
        are_the_same(found, expected)
    assert len(recorders) == 2


def are_the_same(found, expected):
    """To the last bit, but for times and, without friction, iterations."""
    assert list(found.variables) == list(expected.variables)
    spent = ("time_", "newton_iterations") if "friction_coefficient" not in expected.attrs else ("time_",)
    for name, variable in expected.variables.items():
        as_number = variable.dtype.kind == "f"
        assert name.startswith(spent) or np.array_equal(found[name].values, variable.values, as_number), name
    one, other = (
        {name: value for name, value in each.attrs.items() if not name.startswith(spent)} for each in (found, expected)
    )
    assert one == other


RELIEF = '\n[tip_relief]\ndepth = "9 um"\nlength_on_path = "3 mm"\n'
TILTED = '\n[misalignment]\nin_plane = "14 um"\nout_of_plane = "5 um"\n'
ERRORS = '\n[flank_errors.pinion.waviness]\namplitude = "2 um"\nwaves = 40\n'
RUN_OUT = '\n[eccentricity.wheel]\ndistance = "6 um"\n'
SLOPING = '\n[lead_modifications.wheel]\nhelix_slope = "6 um"\n'
FEW = 'contact_nodes = 13\nsteps_per_mesh_cycle = 8\ncontact_length = "1 mm"\nflank_element_size = "0.2 mm"'


@pytest.mark.parametrize(("always", "friction"), [
    pytest.param("", "", id="in the plane, frictionless"),
    pytest.param(CROWNED, FRICTION, id="over the face, with friction"),
    pytest.param("", FRICTION, id="in the plane, with friction", marks=pytest.mark.nightly),
    pytest.param(CROWNED, "", id="over the face, frictionless", marks=pytest.mark.nightly),
])  # fmt: skip
def test_designs_share_operators_and_nothing_else(friction, always):
    """Brute force: each design alone, to the last bit; only the first is built at whole steps."""
    accuracy = f"slices = 5\n{FEW}" if always else FEW
    designs = ["", RUN_OUT, RELIEF + ERRORS, *((TILTED + RELIEF, SLOPING) if always else (RELIEF, ERRORS))]
    models = [
        model_of(helical_scene(always + friction + design, accuracy=accuracy, helix=12.0 if always else 0.0))
        for design in designs
    ]
    models = CommonWindows().of(models)
    gears = tuple(body if always else replace(body, solid=None) for body in on_stand_in_bodies(models[0]))
    assert len({operators_key(model) for model in models}) == 1
    assert len({cycle_key(model) for model in models}) == len(models)
    store, built = GearStore(), []

    def made(model, *_):
        built.append(model)
        return (), cycle_of(model, gears)

    store._made = made
    for model in (*models, models[1]):
        are_the_same(
            simulate(model, preparation=store.prepared), simulate(model, preparation=lambda m, *_: made(m)[:2])
        )
    assert len(built) == 2 + len(models)


def test_cycles_of_the_same_bodies_stay_while_there_is_room():
    """Property: torques with contact nodes of their own do not drive out each other's operators unless memory is
    short; other gears do."""
    models = [
        model_of(helical_scene(CROWNED, accuracy=f"slices = 5\n{FEW}".replace("nodes = 13", f"nodes = {nodes}")))
        for nodes in (9, 11, 9, 11, 13)
    ]
    gears, built, store = on_stand_in_bodies(models[0]), [], GearStore()
    store._made = lambda model, *_: built.append(model) or ((), cycle_of(model, gears))

    def asked_for(model, most=1e9):
        cycle = store.prepared(model, None, None)[1]
        cycle.kept.most = most
        return cycle, [id(cycle.position(step).operator.compliance) for step in range(3)]

    found = [asked_for(model) for model in models[:4]]
    assert len(built) == 2 and found[2][1] == found[0][1] and found[3][1] == found[1][1]
    assert found[3][0].kept.others == found[2][0].kept.taken > 0.0
    for model in (*models[:2], models[4], models[0]):
        asked_for(model, most=2.0 * found[0][0].kept.taken)
    assert len(built) == 4
    asked_for(model_of(helical_scene(CROWNED, accuracy=f"slices = 5\n{FEW}", width=20.0)))
    assert len(store._operators) == 1


def test_places_between_steps_are_built_once(paper_scene, monkeypatch):
    """Identity: a repeated run builds no position again."""
    store, count = GearStore(), []
    build = Cycle._build
    monkeypatch.setattr(Cycle, "_build", lambda cycle, ends: count.extend(end for end, _ in ends) or build(cycle, ends))
    scene = replace(coarse_scene(paper_scene, cycles=1), friction=None, inertia=None, damping=None)
    first = simulate(scene, preparation=store.prepared)
    assert any(place != int(place) and in_common(place) for place in count) and len(set(count)) == len(count)
    count.clear()
    are_the_same(simulate(scene, preparation=store.prepared), first)
    assert not any(map(in_common, count))
