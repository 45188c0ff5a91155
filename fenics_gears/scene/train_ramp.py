"""``[speed_ramp]`` of a train: a speed of its first shaft that rises or falls during the run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from fenics_gears.inputs.fields import quantity, whole_number
from fenics_gears.inputs.problem import Problem
from fenics_gears.inputs.section import Section, fields_of, read_by_itself
from fenics_gears.inputs.written import as_written

from .train_loads import TrainLoad, TrainMotion

SPEED_RAMP = "speed_ramp"


@dataclass(frozen=True)
class TrainRamp(Section):
    """``[speed_ramp]`` of a train: from the speed of ``[motion]`` to another one, linear in time."""

    end_speed: float = quantity(
        "1e-9 rpm to 1e6 rpm", "3000 rpm", meaning="speed of the first shaft at the end of the run"
    )
    hold_cycles: int = whole_number(
        0, 1_000_000, 20, meaning="cycles of the slowest mesh at the first speed, before the ramp begins", default=0
    )


def checked_ramp(
    tree: Mapping[str, Any], load: TrainLoad | None, motion: TrainMotion | None
) -> tuple[TrainRamp | None, list[Problem]]:
    """The speed ramp of a parsed train, None where it has none or a wrong one, and what is wrong with it."""
    written = tree.get(SPEED_RAMP)
    if written is None:
        return None, []
    if not isinstance(written, Mapping):
        said = f"is not a section with {fields_of(TrainRamp)}."
        return None, [Problem((SPEED_RAMP,), as_written(written), said)]
    ramp, problems = read_by_itself(TrainRamp, written, (SPEED_RAMP,))
    if not problems and load is not None and motion is not None:
        problems = list(_wrong_ramp(tree, ramp, load, motion))
    return (None if problems else ramp), problems


def _wrong_ramp(tree: Mapping[str, Any], ramp: TrainRamp, load: TrainLoad, motion: TrainMotion) -> Iterator[Problem]:
    written = tree[SPEED_RAMP]
    if "inertia" not in tree:
        yield Problem((SPEED_RAMP,), "", "needs the section [inertia], which is missing. Add it.")
    if load.power is not None:
        said = "has no constant torque with [speed_ramp]. Give output_torque or input_torque."
        yield Problem(("load", "power"), as_written(tree["load"]["power"]), said)
    if motion.speed is not None:
        said = "is of another shaft than [speed_ramp]. Give motion.input_speed, of the first shaft."
        yield Problem(("motion", "speed"), as_written(tree["motion"]["speed"]), said)
    if motion.input_speed == ramp.end_speed:
        said = "is the speed at the start, motion.input_speed. Allowed: any other, or no section [speed_ramp]."
        yield Problem((SPEED_RAMP, "end_speed"), as_written(written["end_speed"]), said)
    if motion.mesh_cycles is not None and ramp.hold_cycles >= motion.mesh_cycles:
        said = f"leaves no cycle of motion.mesh_cycles = {motion.mesh_cycles} for the ramp. Allowed: fewer."
        yield Problem((SPEED_RAMP, "hold_cycles"), as_written(written["hold_cycles"]), said)
