"""What a finished march says against itself: assumptions of the model that its own result leaves behind."""

from __future__ import annotations

import numpy as np

from fenics_gears.contact.laws import OPEN
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.dynamics.march import Record

# cos(phi) is 1 within 0.1 % up to here: rotations are taken as small (paper, section 2).
LARGEST_ROTATION = 0.05
ROTATIONS = {"rotation_1": "the pinion", "rotation_2": "the wheel"}


def warnings_of(cycle: Cycle, drivetrain: Drivetrain, records: list[Record]) -> list[str]:
    """Sentences on where the stored steps leave what the model assumes; empty where they do not."""
    return [*_window(cycle, records), *_rotation(drivetrain, records), *_separation(cycle, records)]


def _window(cycle: Cycle, records: list[Record]) -> list[str]:
    """Contact at an end of the window that is no edge of the flank: the window cuts pressure off."""
    half, reached = 0.5 * cycle.grid.length, 0
    for record in records:
        status, start = record.solution.status, 0
        for pair in record.position.operator.pairs:
            closed = status[start : start + len(pair.offsets)] != OPEN
            start += len(pair.offsets)
            ends = (closed[0] and pair.offsets[0] <= -half * (1 - 1e-9)) or (closed[-1] and pair.offsets[-1] >= half * (1 - 1e-9))
            reached += bool(ends)
    if not reached:
        return []
    return [
        f"contact reached the end of the contact window in {reached} of {len(records)} stored steps: "
        f"raise accuracy.contact_length above {cycle.grid.length:.3g} mm"
    ]


def _rotation(drivetrain: Drivetrain, records: list[Record]) -> list[str]:
    states = np.array([record.state.position for record in records]).reshape(len(records), -1)
    found = []
    for coordinate, name in ROTATIONS.items():
        largest = np.abs(drivetrain.value(states, coordinate)).max(initial=0.0)
        if largest > LARGEST_ROTATION:
            found.append(
                f"{name} turns by {largest:.3g} rad from its nominal motion; the model takes such rotations as small "
                f"(below {LARGEST_ROTATION} rad): stiffen the shafts or lower the torque"
            )
    return found


def _separation(cycle: Cycle, records: list[Record]) -> list[str]:
    """Flanks further apart than the backlash: the coast flanks would have touched, and are not part of the scene."""
    backlash, first, steps, widest = cycle.pair.backlash, None, 0, 0.0
    for record in records:
        operator = record.position.operator
        if not operator.nodes or np.any(record.solution.status != OPEN):
            continue
        opening = float(np.min(operator.gap - record.solution.displacement[: operator.nodes]))
        steps, widest = steps + 1, max(widest, opening)
        if first is None and opening > backlash:
            first = record.step / cycle.steps
    if first is not None:
        return [
            f"the teeth separate by up to {widest * 1e3:.4g} um, more than the backlash of {backlash * 1e3:.4g} um, from mesh "
            f"cycle {first:.2f} on: the coast flanks would touch, which this scene does not have; from then on the result has no meaning"
        ]
    if steps:
        return [f"the teeth lose contact in {steps} of {len(records)} stored steps, by up to {widest * 1e3:.3g} um"]
    return []
