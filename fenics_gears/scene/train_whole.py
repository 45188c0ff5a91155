"""What a train says of all of its stages: title, load and motion, a ramp of the speed, damping, the load's inertia."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from fenics_gears.dynamics.damping import Damping
from fenics_gears.dynamics.inertia import LoadInertia
from fenics_gears.inputs.fields import quantity, text, whole_number
from fenics_gears.inputs.problem import Problem
from fenics_gears.inputs.section import Section, allowed_in, names_in, read_by_itself
from fenics_gears.inputs.tree import GEARS, value_at
from fenics_gears.inputs.written import as_written

from .train_loads import TrainLoad, TrainMotion

INERTIA = "inertia"
NEEDS_INERTIA = "needs the section [inertia], which is missing. Add it."


@dataclass(frozen=True)
class TrainRamp(Section):
    """``[speed_ramp]`` of a train: from the speed of ``[motion]`` to another one, linear in time."""

    end_speed: float = quantity(
        "1e-9 rpm to 1e6 rpm", "3000 rpm", meaning="speed of the first shaft at the end of the run"
    )
    hold_cycles: int = whole_number(
        0, 1_000_000, 20, meaning="cycles of the slowest mesh at the first speed, before the ramp begins", default=0
    )


@dataclass(frozen=True)
class InertiaOfTrain(Section):
    """``[inertia]`` of a train, but for the masses of its gears."""

    load: LoadInertia | None = None


@dataclass(frozen=True, kw_only=True)
class WholeTrain(Section):
    """Sections of a train beside its stages and shafts that are not those of its pairs."""

    title: str | None = text(500, meaning="title in summaries and pictures", otherwise="the name of the file")
    load: TrainLoad
    motion: TrainMotion = TrainMotion()
    speed_ramp: TrainRamp | None = None
    damping: Damping | None = None
    inertia: InertiaOfTrain | None = None

    @property
    def load_inertia(self) -> float | None:
        """Moment of inertia (N mm s^2) of the load, None where there is none."""
        load = None if self.inertia is None else self.inertia.load
        return None if load is None else load.moment_of_inertia


def whole_train(tree: Mapping[str, Any]) -> tuple[WholeTrain | None, list[Problem]]:
    """What a parsed train says of all of its stages, None where it is wrong, and all that is wrong with it."""
    own = {name: tree[name] for name in names_in(WholeTrain) if name in tree}
    if isinstance(own.get(INERTIA), Mapping):
        own[INERTIA] = {name: each for name, each in own[INERTIA].items() if name == "load"}
    whole, problems = read_by_itself(WholeTrain, own, ())
    for gear in GEARS:
        if value_at(tree, "damping", gear) is not None:
            problems.append(Problem(("damping", gear), "", "is of a pair. Allowed: one damping of the whole train."))
    if whole is not None:
        problems += [*_wrong_sections(tree, whole), *_wrong_ramp(tree, whole)]
    return (None if problems else whole), problems


def _wrong_sections(tree: Mapping[str, Any], whole: WholeTrain) -> Iterator[Problem]:
    if whole.load.power is not None and not whole.motion.given:
        said = "needs a speed. Allowed: with motion.input_speed."
        yield Problem(("load", "power"), as_written(tree["load"]["power"]), said)
    if whole.inertia is None and whole.damping is not None:
        yield Problem(("damping",), "", NEEDS_INERTIA)


def wrong_with_inertia(motion: TrainMotion) -> Iterator[Problem]:
    """What motion lacks that [inertia] needs."""
    for name in ("input_speed", "mesh_cycles"):
        if getattr(motion, name) is None and not (name == "input_speed" and motion.given):
            allowed = allowed_in(TrainMotion, name)
            yield Problem(("motion", name), None, f"is missing, which [inertia] needs. Allowed: {allowed.description}.")


def _wrong_ramp(tree: Mapping[str, Any], whole: WholeTrain) -> Iterator[Problem]:
    ramp = whole.speed_ramp
    motion = whole.motion
    if ramp is None:
        return
    place = ("speed_ramp",)
    if whole.inertia is None:
        yield Problem(place, "", NEEDS_INERTIA)
    if whole.load.power is not None:
        said = "has no constant torque with [speed_ramp]. Give output_torque or input_torque."
        yield Problem(("load", "power"), as_written(tree["load"]["power"]), said)
    if motion.speed is not None:
        said = "is of another shaft than [speed_ramp]. Give motion.input_speed, of the first shaft."
        yield Problem(("motion", "speed"), as_written(tree["motion"]["speed"]), said)
    written = tree["speed_ramp"]
    if motion.input_speed == ramp.end_speed:
        said = "is the speed at the start, motion.input_speed. Allowed: any other, or no section [speed_ramp]."
        yield Problem((*place, "end_speed"), as_written(written["end_speed"]), said)
    if motion.mesh_cycles is not None and ramp.hold_cycles >= motion.mesh_cycles:
        said = f"leaves no cycle of motion.mesh_cycles = {motion.mesh_cycles} for the ramp. Allowed: fewer."
        yield Problem((*place, "hold_cycles"), as_written(written["hold_cycles"]), said)
