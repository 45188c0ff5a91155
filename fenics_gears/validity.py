"""What a finished march says against itself: assumptions of the model that its own result leaves behind."""

from __future__ import annotations

import numpy as np

from fenics_gears.contact.laws import OPEN
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.operator import over_nodes
from fenics_gears.contact.uniqueness import uncertified
from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.dynamics.march import March, Record

# cos(phi) is 1 within 0.1 % up to here: rotations are taken as small (paper, section 2).
LARGEST_ROTATION = 0.05
ROTATIONS = {"rotation_1": "the pinion", "rotation_2": "the wheel"}


def warnings_of(cycle: Cycle, drivetrain: Drivetrain, march: March) -> list[str]:
    """Sentences on where a march leaves what the model assumes; empty where it does not.

    Window, rank, rotations and uniqueness are judged by the stored steps, loss of contact and locking by every step done.
    """
    records = list(march.records)
    return [*_window(cycle, records), *_rank(records), *_rotation(drivetrain, records), *_separation(cycle, march), *_locking(cycle, march), *_uniqueness(march)]


def _window(cycle: Cycle, records: list[Record]) -> list[str]:
    """Contact at an end of the window that is no edge of the flank: the window cuts pressure off."""
    end, reached = 0.5 * cycle.grid.length * (1.0 - 1e-9), 0
    for record in records:
        offsets = over_nodes(record.position.operator.pairs, "offsets")
        reached += bool(np.any((np.abs(offsets) >= end) & (record.solution.status != OPEN)))
    if not reached:
        return []
    return [
        f"contact reached the end of the contact window in {reached} of {len(records)} stored steps: "
        f"raise accuracy.contact_length above {cycle.grid.length:.3g} mm"
    ]


def _rank(records: list[Record]) -> list[str]:
    """Contact nodes that the elements cannot tell apart, so that how they share a force is not elasticity's answer."""
    lacking = [record.position.operator for record in records if record.position.operator.dependent_rows]
    if not lacking:
        return []
    worst = max(lacking, key=lambda operator: operator.dependent_rows)
    rows = len(worst.compliance)
    return [
        f"the contact compliance is singular in {len(lacking)} of {len(records)} stored steps (rank {rows - worst.dependent_rows} of {rows} "
        "at worst): contact nodes stand closer than the elements can tell apart and were given a thin layer each; forces hold, the "
        "pressure does not: lower accuracy.contact_nodes or accuracy.flank_element_size"
    ]


def _rotation(drivetrain: Drivetrain, records: list[Record]) -> list[str]:
    states = np.array([record.state.position for record in records]).reshape(len(records), len(drivetrain.coordinates))
    found = []
    for coordinate, name in ROTATIONS.items():
        largest = np.abs(drivetrain.value(states, coordinate)).max(initial=0.0)
        if largest > LARGEST_ROTATION:
            found.append(
                f"{name} turns by {largest:.3g} rad from its nominal motion; the model takes such rotations as small "
                f"(below {LARGEST_ROTATION} rad): stiffen the shafts or lower the torque"
            )
    return found


def _separation(cycle: Cycle, march: March) -> list[str]:
    """Loss of contact: how often, how far; beyond the backlash the coast flanks, which the scene does not have, would have touched."""
    if not march.separations:
        return []
    backlash, widest = cycle.pair.backlash, max(opening for _, opening in march.separations)
    first, last = (march.separations[place][0] / cycle.steps for place in (0, -1))
    lost = (
        f"the {'drive flanks' if cycle.coast_flanks else 'teeth'} lose contact in {len(march.separations)} of {march.steps} steps, between mesh cycles {first:.2f} and {last:.2f}, "
        f"by up to {widest * 1e3:.4g} um"
    )
    if cycle.coast_flanks or widest <= backlash:
        return [lost]
    steps = [step for step, opening in march.separations if opening > backlash]
    beyond = f"{lost}. That is more than the backlash of {backlash * 1e3:.4g} um: from mesh cycle {steps[0] / cycle.steps:.2f} on the coast "
    if march.records and march.separations[-1][0] < march.records[0].step:
        return [beyond + "flanks would touch, which this scene does not have. The stored cycles are in contact throughout"]
    return [beyond + "flanks would touch, which this scene does not have, and the result has no meaning"]


def _locking(cycle: Cycle, march: March) -> list[str]:
    """Friction that turns the wheel back by more than the normal force drives it: forces grow beyond what the load asks for."""
    if not march.locked:
        return []
    return [
        f"friction locks the teeth (self-locking) in {len(march.locked)} of {march.steps} steps, first in mesh cycle "
        f"{march.locked[0] / cycle.steps:.2f}: at contact nodes on approach it turns the wheel back by more than the normal force drives "
        f"it, and the forces grow beyond what the load asks for: lower friction.coefficient (here {march.friction:g})"
    ]


def _uniqueness(march: March) -> list[str]:
    """Steps at which nothing certifies that the solution is the only one."""
    if not march.friction:
        return []
    solved = ((record.position.operator, record.solution.status, record.solution.forces) for record in march.records)
    count = uncertified(march.stiffness, march.friction, solved)
    if not count:
        return []
    return [
        f"in {count} of {len(march.records)} stored steps there may be more than one solution: friction couples the contact nodes so "
        f"strongly that the one found cannot be certified as the only one (friction.coefficient is {march.friction:g})"
    ]
