"""The march through time: order, start, free flight, against exact solutions."""

from dataclasses import replace

import numpy as np
import pytest
from tests.frozen_gears import GRID

from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.relief_gaps import Profiles
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.stepping import EquationsOfMotion
from fenics_gears.model.drivetrain import drivetrain


def frictionless(scene, **changes):
    return replace(scene, friction=None, **changes)


def test_only_the_last_steps_are_kept(paper_scene, paper_pair, stand_in_flanks):
    """Definition: both ends of two recorded cycles included."""
    scene = frictionless(paper_scene)
    shafts = drivetrain(scene, paper_pair)
    cycle = Cycle(elastic_mesh(stand_in_flanks, GRID), 20, shafts.indices, tangential=False)
    march = Marcher(cycle, EquationsOfMotion(shafts, 1e-4)).run(100, 41)
    assert [record.step for record in march.records] == list(range(60, 101))


@pytest.mark.parametrize("friction", [0.0, 0.1])
def test_a_batch_has_the_marches_of_its_runs(paper_scene, paper_pair, stand_in_flanks, friction):
    """Identity, to the last digit: motions with inertia under three loads, side by side and one by one."""
    shafts = drivetrain(paper_scene, paper_pair)
    cycle = Cycle(elastic_mesh(stand_in_flanks, GRID), 20, shafts.indices, tangential=friction > 0.0)
    loads = [part * shafts.load for part in (1.0, 0.5, 2.0)]
    motions = [EquationsOfMotion(replace(shafts, load=load), 1e-4, friction) for load in loads]
    unmodified = Profiles(cycle, [(None, None)] * 3, [()] * 3)
    together = Marcher(cycle, *motions, opened=unmodified).together(60)
    for motion, march in zip(motions, together):
        alone = Marcher(cycle, motion).run(60, 61)
        assert march.steps_by_method == alone.steps_by_method and march.steps == 60
        for name in ("states", "forces", "displacement", "status"):
            assert np.array_equal(getattr(march.latest, name), getattr(alone.latest, name)), name
