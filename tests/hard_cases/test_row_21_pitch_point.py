"""Row 21: a step on the pitch point, exactly or 1e-12 mm beside it, where friction turns its sign."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from fenics_gears.contact.laws import OPEN, SLIP_BACKWARD, SLIP_FORWARD, STICK
from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.window import ContactGrid
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.stepping import EquationsOfMotion
from fenics_gears.model.drivetrain import drivetrain

BESIDE = (0.0, 1e-12, -1e-12)
# Before the pitch point, and after it until all nodes slip again; short enough that one step's slip is less than the
# teeth give way.
AT, AFTER, FINE = 10, 60, 400
STILL = {"inertia": None, "damping": None}


class Shifted(Cycle):
    """Steps counted so that a tooth pair stands `beside` (mm) the pitch point at step AT."""

    beside = 0.0

    def position(self, step):
        """The contact equations at a step; each is asked for once."""
        pair = self.pair
        pitch_point = pair.line_of_action_length * pair.rotation_ratio / (1.0 + pair.rotation_ratio)
        place = (pitch_point + self.beside - pair.path_start) / pair.base_pitch * self.steps + step - AT
        return self.between(place, place - 1)


def past_the_pitch_point(scene, pair, flanks, beside, steps):
    """A march from AT steps before the pitch point to AFTER behind it, `steps` to a mesh cycle."""
    shafts = drivetrain(scene, pair)
    cycle = Shifted(elastic_mesh(flanks, ContactGrid(1.5, 20)), steps, shafts.indices, tangential=True)
    cycle.beside = beside
    return Marcher(cycle, EquationsOfMotion(shafts, 1.0 / (200.0 * steps), scene.friction.coefficient)).run(
        AT + AFTER, AT + AFTER + 1
    )


def on_line(record):
    """Rigid slip (mm) over the step where the pair at the pitch point touches, on the line of action."""
    operator = record.position.operator
    return float(np.abs(operator.rigid_slip).min())


@pytest.mark.parametrize(
    ("friction", "changes"),
    [
        (0.1, {}),
        pytest.param(0.3, {}, marks=pytest.mark.nightly),
        pytest.param(0.1, STILL, marks=pytest.mark.nightly),
        (0.3, STILL),
    ],
    ids=["0.1, dynamic", "0.3, dynamic", "0.1, quasi-static", "0.3, quasi-static"],
)
@pytest.mark.parametrize(
    "absent",
    [
        pytest.param((), id="elastic shafts"),
        pytest.param(("shafts", "bearings"), id="rigid shafts", marks=pytest.mark.nightly),
    ],
)
def test_friction_turns_through_stick(absent, changes, friction, paper_scene, paper_pair, stand_in_flanks, measured):
    """Known course: slip backward, stick, slip forward, none without sticking between; with mu = 0.1 none turns
    back. 1e-12 mm change nothing, and friction is full on either side, against the slip."""
    scene = replace(
        paper_scene, friction=replace(paper_scene.friction, coefficient=friction), **changes, **dict.fromkeys(absent)
    )
    marches = [past_the_pitch_point(scene, paper_pair, stand_in_flanks, beside, FINE) for beside in BESIDE]
    courses, forces = set(), []
    for march in marches:
        assert sum(march.steps_by_method.values()) == AT + AFTER
        statuses = np.array([record.solution.status for record in march.records])
        courses |= {tuple(int(status) for status, _ in itertools.groupby(course)) for course in statuses.T}
        forces.append(np.array([record.solution.forces for record in march.records]))
    n = forces[0].shape[1] // 2
    total = forces[0][:, n:].sum(axis=1)
    difference = max(np.abs(other - forces[0]).max() for other in forces[1:]) / np.abs(forces[0]).max()
    case = f"mu = {friction:g}"
    methods = ", ".join(f"{count} by {method}" for method, count in marches[0].steps_by_method.items() if count)
    measured(
        f"{case}: smallest nominal slip of a node in the step on the pitch point",
        on_line(marches[0].records[AT]),
        "recorded",
        "mm",
    )
    measured(f"{case}: steps solved", methods, "none fails")
    measured(f"{case}: change of forces with the step 1e-12 mm beside / largest force", difference, 1e-9)
    measured(f"{case}: friction force before and after", f"{total[0]:.0f} N, {total[-1]:.0f} N", "changes its sign")
    touching, turns = courses - {(OPEN,)}, {turn for course in courses for turn in itertools.pairwise(course)}
    measured(
        f"{case}: different sequences of slip and stick of the nodes",
        f"{len(touching)}",
        "never from slip to opposite slip",
    )
    assert (SLIP_BACKWARD, SLIP_FORWARD) not in turns and (SLIP_FORWARD, SLIP_BACKWARD) not in turns
    assert (SLIP_BACKWARD, STICK, SLIP_FORWARD) in touching
    assert friction > 0.1 or (SLIP_FORWARD, STICK) not in turns
    assert total[0] == pytest.approx(-friction * forces[0][0, :n].sum(), rel=1e-9)
    assert total[-1] == pytest.approx(friction * forces[0][-1, :n].sum(), rel=1e-9)
