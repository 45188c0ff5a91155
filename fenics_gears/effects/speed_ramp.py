"""``[speed_ramp]``: a mesh frequency that rises or falls during the run (``dynamics.speed_ramp``)."""

from dataclasses import dataclass
from math import inf, pi

from fenics_gears.dynamics.speed_ramp import RampClock, inertia_forces
from fenics_gears.inputs.fields import quantity, whole_number
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.section import Section
from fenics_gears.inputs.tree import Tree, quantity_in, table
from fenics_gears.inputs.written import as_written

from .effect import Effect, ResultVariable


@dataclass(frozen=True)
class SpeedRamp(Section):
    """``[speed_ramp]``: from the mesh frequency of ``[motion]`` to another one."""

    end_frequency: float = quantity("1e-6 Hz to 1e6 Hz", "260 Hz", meaning="mesh frequency at the end of the run")
    hold_cycles: int = whole_number(
        0, 1_000_000, 20, meaning="number of mesh cycles at the first frequency, before the ramp begins", default=0
    )


def speed_changes(tree: Tree) -> Broken:
    """A ramp leads to another frequency, and leaves time for it."""
    ramp = table(tree, "speed_ramp")
    motion = table(tree, "motion") or {}
    if ramp is None:
        return
    start = quantity_in(motion.get("mesh_frequency"))
    end = quantity_in(ramp.get("end_frequency"))
    if start is not None and start == end:
        message = (
            "is the frequency at the start, motion.mesh_frequency. Allowed: any other, or no section [speed_ramp]."
        )
        yield ("speed_ramp", "end_frequency"), message
    held = ramp.get("hold_cycles")
    run = motion.get("mesh_cycles")
    if type(held) is int and type(run) is int and held >= run > 0:
        message = (
            f"leaves no cycle of motion.mesh_cycles = {as_written(run)} for the ramp. Allowed: fewer than are run."
        )
        yield ("speed_ramp", "hold_cycles"), message


def clock(ramp: SpeedRamp, model):
    return _clock(ramp, model.scene, model.resolution.steps_per_mesh_cycle)


def load(ramp: SpeedRamp, model):
    turn = 2.0 * pi / model.scene.gears.pinion.teeth
    return inertia_forces(clock(ramp, model), turn * model.drivetrain.nominal_momentum)


def results(ramp: SpeedRamp, scene, cycle, steps) -> dict:
    """The mesh frequency (time,), Hz."""
    import numpy as np

    ramped = _clock(ramp, scene, cycle.steps)
    return {"mesh_frequency": (("time",), np.array([ramped.mesh_frequency(step) for step in steps]))}


def period(ramp: SpeedRamp, scene) -> float:
    return inf


def _clock(ramp: SpeedRamp, scene, steps_per_mesh_cycle: int):
    held = ramp.hold_cycles * steps_per_mesh_cycle
    steps = scene.motion.mesh_cycles * steps_per_mesh_cycle
    return RampClock(scene.motion.mesh_frequency, ramp.end_frequency, held, steps, steps_per_mesh_cycle)


EFFECT = Effect(
    section="speed_ramp",
    description="mesh frequency that rises or falls linearly in time",
    absent="constant speed",
    fields=SpeedRamp,
    terms=("inertia forces of the accelerating nominal motion", "time steps of equal mesh phase"),
    variables=(ResultVariable("mesh_frequency", "Hz", "mesh frequency"),),
    needs=("inertia",),
    rules=speed_changes,
    load=load,
    clock=clock,
    results=results,
    period=period,
)
