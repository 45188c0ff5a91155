"""Row 18: no flank touches. With inertia the gears fly free; else the error says which load is not held and what is
free."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from tests.frozen_gears import frozen_marcher

from fenics_gears.contact.errors import NoStaticEquilibrium
from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.operator import Position, Stored
from fenics_gears.contact.window import ContactGrid
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.stepping import EquationsOfMotion
from fenics_gears.model.drivetrain import drivetrain

ABSENT = [(), ("bearings",), ("shafts",), ("shafts", "bearings")]


@pytest.mark.parametrize("frictional", [False, True], ids=["frictionless", "friction"])
@pytest.mark.parametrize("absent", ABSENT, ids=["all"] + ["without " + " and ".join(names) for names in ABSENT[1:]])
def test_a_static_load_that_opens_all_gaps_is_named(
    absent, frictional, paper_scene, paper_pair, stand_in_flanks, measured
):
    """Message: whatever else gives way, the couple turns the wheel."""
    scene = replace(paper_scene, inertia=None, damping=None, **dict.fromkeys(absent))
    scene = scene if frictional else replace(scene, friction=None)
    scene = replace(scene, load=replace(scene.load, wheel_torque=-scene.load.wheel_torque))
    shafts = drivetrain(scene, paper_pair)
    cycle = Cycle(elastic_mesh(stand_in_flanks, ContactGrid(1.5, 20)), 40, shafts.indices, tangential=frictional)
    marcher = Marcher(cycle, EquationsOfMotion(shafts, 1e-4, scene.friction.coefficient if frictional else 0.0))
    with pytest.raises(NoStaticEquilibrium) as failure:
        marcher.run(1, 2)
    measured(
        f"error, {'friction' if frictional else 'frictionless'}", failure.value.reason, "names load and free motion"
    )
    assert failure.value.reason.startswith("no equilibrium")
    assert "all gaps open" in failure.value.reason
    assert failure.value.reason.endswith("the wheel turns freely under its torque of -437 N m")
    # Frictionless sets follow from the forces alone, so no step before the first is solved for them.
    assert failure.value.step == (-1 if frictional else 0) and not failure.value.partial.records


def test_a_position_where_nothing_can_touch_is_named(paper_scene, paper_pair, stand_in_flanks, measured):
    """Message: no tooth pair has a contact node, and the wheel turns freely."""
    scene = replace(paper_scene, inertia=None, damping=None, friction=None)
    marcher, shafts = frozen_marcher(scene, paper_pair, stand_in_flanks, 1e-4)
    start, k = marcher.start()[0], len(shafts.coordinates)
    empty = SimpleNamespace(
        nodes=0, stored=Stored(np.zeros((0, 0))), stored_jacobians=(np.zeros((0, k)), None), gap=np.empty(0),
        rigid_slip=None,
    )  # fmt: skip
    marcher.cycle.position = lambda step: Position(empty, np.empty(0, dtype=np.int64))
    with pytest.raises(NoStaticEquilibrium) as failure:
        marcher.stepper.step(marcher.stepper.static, start, 1)
    measured("error where no tooth pair can touch", failure.value.reason, "names load and free motion")
    assert failure.value.reason.startswith("no equilibrium: no tooth pair can touch")
    assert failure.value.reason.endswith("the wheel turns freely under its torque of 437 N m")
