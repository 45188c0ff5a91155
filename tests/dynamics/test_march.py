"""The march through time: order, start, free flight, against exact solutions."""

from dataclasses import replace

from tests.frozen_gears import GRID

from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
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
