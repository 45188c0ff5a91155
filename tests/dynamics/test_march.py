"""The march through time: order, start, free flight, against exact solutions."""

from dataclasses import replace

import numpy as np
import pytest
from tests.frozen_gears import GRID, frozen_marcher

from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.dynamics.average_acceleration import State
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.stepping import EquationsOfMotion
from fenics_gears.dynamics.steps import Record
from fenics_gears.model.drivetrain import drivetrain


def frictionless(scene, **changes):
    return replace(scene, friction=None, **changes)


def test_start_is_equilibrium(paper_scene, paper_pair, stand_in_flanks):
    """Exact: gears that do not roll, started from static equilibrium, stay where they are."""
    marcher, _ = frozen_marcher(frictionless(paper_scene), paper_pair, stand_in_flanks, 1e-4)
    start = marcher.start()
    record = start
    for step in range(1, 50):
        record = marcher.step(marcher.dynamic, record, step)
    assert record.state.position == pytest.approx(start.state.position, rel=1e-9, abs=1e-12)
    assert np.abs(record.state.velocity).max() <= 1e-7


def test_undamped_tied_motion_keeps_its_energy(paper_scene, paper_pair, stand_in_flanks):
    """Exact: average acceleration conserves the energy of a linear system, here with all nodes staying closed."""
    scene = frictionless(paper_scene, damping=None)
    marcher, shafts = frozen_marcher(scene, paper_pair, stand_in_flanks, 2e-5)
    rest = marcher.start()
    push = np.zeros(len(shafts.coordinates))
    push[shafts.coordinates.index("rotation_1")] = 0.2
    record = Record(0, State(rest.state.position, push, 0.0 * push), rest.position, rest.solution)

    def energy(record):
        forces, compliance = record.solution.forces, record.position.operator.compliance
        gap_work = 0.5 * forces @ compliance @ forces
        x, v = record.state.position, record.state.velocity
        return 0.5 * v @ shafts.mass @ v + 0.5 * x @ shafts.stiffness @ x + gap_work - shafts.load @ x

    first = energy(record)
    kinetic = 0.5 * push @ shafts.mass @ push
    # q'' at the start is not zero once pushed: one step settles it, then energy stands still.
    energies = []
    for step in range(1, 2001):
        record = marcher.step(marcher.dynamic, record, step)
        energies.append(energy(record))
    # The loads' own work is 2e4 times the motion's energy; what is lost of it by round-off is not the method's.
    assert np.abs(np.array(energies) - first).max() <= 1e-6 * kinetic


def test_ctrl_c_keeps_what_was_done(paper_scene, paper_pair, stand_in_flanks):
    """A march that is interrupted returns its records so far, marked."""
    scene = frictionless(paper_scene)
    shafts = drivetrain(scene, paper_pair)
    cycle = Cycle(elastic_mesh(stand_in_flanks, GRID), 50, shafts.indices, tangential=False)

    def interrupt(done, total):
        raise KeyboardInterrupt

    march = Marcher(cycle, EquationsOfMotion(shafts, 1e-4)).run(100, 101, interrupt)
    assert march.interrupted
    assert 1 <= len(march.records) <= 3


def test_only_the_last_steps_are_kept(paper_scene, paper_pair, stand_in_flanks):
    """Two recorded cycles of a long run: the last steps, both ends included, not the whole history."""
    scene = frictionless(paper_scene)
    shafts = drivetrain(scene, paper_pair)
    cycle = Cycle(elastic_mesh(stand_in_flanks, GRID), 20, shafts.indices, tangential=False)
    march = Marcher(cycle, EquationsOfMotion(shafts, 1e-4)).run(100, 41)
    assert [record.step for record in march.records] == list(range(60, 101))
