"""What a march leaves."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from tests.coarse import coarse_scene, cycle_of, frictionless, quasi_static

from fenics_gears import model_of, results, simulate
from fenics_gears.dynamics import march as march_module
from fenics_gears.dynamics.energy_account import contact_work
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.steps import Steps
from fenics_gears.effects.coast_flanks import CoastFlanks
from fenics_gears.results.contact_variables import energy_variables, work_variables
from fenics_gears.results.dataset import RunResult
from fenics_gears.results.recorder import Recorder
from fenics_gears.scene.data import Motion, Output

FIELDS = ("contact_pressure", "contact_traction", "contact_offset", "contact_roll_angle")


@pytest.fixture(scope="module")
def marched(paper_scene):
    """Four mesh cycles, more steps than are gone over at once, with all records."""
    model = model_of(replace(coarse_scene(paper_scene), coast_flanks=CoastFlanks(), motion=Motion(200.0, 4, 2)))
    cycle = cycle_of(model)
    recorder = Recorder(model, cycle)
    with pytest.MonkeyPatch.context() as changed:
        changed.setattr(march_module, "LONGEST_BLOCK", 90)
        march = Marcher(cycle, model.equations_of_motion).run(model.steps, model.steps + 1, observe=recorder.take)
    return model, cycle, march.records, RunResult(recorder, march).dataset


def by_pair_number(model, cycle, records) -> xr.Dataset:
    """Brute force: by pair counted through the run, from the records one by one."""
    numbers = sorted(
        {int(cycle.pair_number(r.step, p.place.index)) for r in records for p in r.position.operator.pairs}
    )
    shape = (len(records), len(numbers), cycle.grid.most_nodes)
    fields = {
        name: np.full(shape, np.nan if name.endswith(("offset", "angle")) else 0.0)
        for name in FIELDS + tuple(f"coast_{each}" for each in FIELDS)
    }
    forces = {
        name: np.zeros(shape[:2])
        for name in ("pair_normal_force", "pair_friction_force", "pair_coast_normal_force", "unused")
    }
    for i, record in enumerate(records):
        start, count = 0, record.position.operator.nodes
        for pair in record.position.operator.pairs:
            nodes = slice(start, start + len(pair.offsets))
            start, row = nodes.stop, numbers.index(int(cycle.pair_number(record.step, pair.place.index)))
            normal, tangential = record.solution.forces[:count][nodes], record.solution.forces[count:][nodes]
            coast, area = bool(pair.place.flank), pair.lengths * model.pair.face_width
            values = (normal / area, tangential / area, pair.offsets, pair.rolls[0])
            for name, each in zip(FIELDS, values):
                fields[f"coast_{name}" if coast else name][i, row, : len(each)] = each
            for name, force in zip(
                ("pair_coast_normal_force", "unused") if coast else ("pair_normal_force", "pair_friction_force"),
                (normal, tangential),
            ):
                forces[name][i, row] = force.sum()
    fields.pop("coast_contact_offset"), forces.pop("unused")
    variables = {name: (("time", "pair"), force) for name, force in forces.items()}
    variables |= {name: (("time", "pair", "contact_node"), field) for name, field in fields.items()}
    return xr.Dataset(variables, {"pair": numbers})


def test_slots_hold_what_pairs_held(marched):
    """Brute force: the march's own records."""
    model, cycle, records, result = marched
    pairs = by_pair_number(model, cycle, list(records))
    first = result["pair_number"].attrs["number_at_phase_0"]
    assert (
        result["pair_number"].values.max() == pairs["pair"].values.max() + first
        and result["pair_number"].values[0].min() >= 0
    )
    assert 1 in result["pair_number"].values[0]
    for name in ("pair_normal_force", "pair_friction_force", "pair_coast_normal_force"):
        found = results.by_pair(result[name], absent=0.0)
        np.testing.assert_allclose(
            found.values, pairs[name].sel(pair=found["pair"].values - first).values, rtol=1e-12, atol=1e-9
        )
    assert (
        result.sizes["contact_time"]
        == model.contact_steps
        == 2 * cycle.steps + 1
        < result.sizes["time"]
        == model.steps + 1
    )
    for name in [name for name in pairs.data_vars if "contact_" in name]:
        found = results.by_pair(result[name], absent=np.nan if name.endswith(("offset", "angle")) else 0.0)
        expected = pairs[name].sel(pair=found["pair"].values - first).values[-model.contact_steps :]
        np.testing.assert_allclose(found.values, expected, rtol=1e-12)


def test_the_account_goes_on_from_block_to_block(marched):
    """Identity with all records at once; nothing but round-off is left."""
    model, cycle, records, result = marched
    steps = Steps.of(records)
    energies = energy_variables(model.scene, model.drivetrain, steps)
    works = work_variables(model.scene, cycle, model.drivetrain, model.clock, model.loads, steps, energies["energy"])
    for name, values in (energies | works).items():
        np.testing.assert_allclose(
            result[name].values, values, rtol=1e-9, atol=1e-9 * np.abs(result["work_input"].values).max()
        )
    assert np.abs(result["energy_defect"].values).max() <= 1e-10 * np.abs(result["work_input"].values).max()


def test_friction_and_changes_of_contact_are_by_definition(marched):
    """Definition: friction loses p_t times the slip, changes of contact are half of p0 times the opening now less p1
    times the one before; the rest is the rotation's."""
    records, checked = marched[2], 0
    works = contact_work(Steps.of(records))
    for step, (last, record) in enumerate(zip(records, records[1:])):
        operator, found = record.position.operator, record.position.node_before
        now = np.flatnonzero(found >= 0)
        before = found[now]
        (normal_0, tangential_0), (normal, tangential) = (
            each.solution.forces.reshape(2, -1) for each in (last, record)
        )
        if np.delete(normal, now).any() or np.delete(normal_0, before).any() or len(set(before)) < len(before):
            continue
        earlier = operator.previous_jacobian @ last.state.position - operator.previous_compliance @ last.solution.forces
        slip = record.solution.displacement[operator.nodes :] + operator.rigid_slip - earlier
        open_0, open_1 = (
            each.position.operator.gap - each.solution.displacement.reshape(2, -1)[0] for each in (last, record)
        )
        changes = 0.5 * float(normal_0[before] @ open_1[now] - normal[now] @ open_0[before])
        changes += 0.5 * float((tangential[now] - tangential_0[before]) @ slip[now])
        scale = abs(works.rotation[step]) + abs(works.friction[step]) + 1e-6
        assert works.friction[step] == pytest.approx(float(tangential @ slip), abs=1e-10 * scale)
        assert works.changes[step] == pytest.approx(changes, abs=1e-10 * scale)
        checked += 1
    assert checked > 0.5 * len(records)


@pytest.mark.nightly
@pytest.mark.parametrize("coast", [False, True])
@pytest.mark.parametrize("friction", [False, True])
@pytest.mark.parametrize("root_stress", [False, True])
def test_memory_is_as_it_was_counted(paper_scene, coast, friction, root_stress):
    """Count, to the byte."""
    scene = replace(
        quasi_static(coarse_scene(paper_scene)),
        coast_flanks=CoastFlanks() if coast else None,
        output=Output(root_stress=root_stress),
    )
    result = simulate(scene if friction else frictionless(scene))
    held = sum(each.nbytes for each in result.variables.values() if {"time", "contact_time"} & set(each.dims))
    assert held == model_of(scene if friction else frictionless(scene)).stored_bytes
