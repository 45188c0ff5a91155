"""The warnings of a finished run: where its own result breaks an assumption of the model."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.dynamics.clock import Clock
from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.dynamics.marched import March
from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.data import Scene

from .key_numbers import wedged
from .numbers import contact_losses
from .pressure_limits import warnings_of_pressure

if TYPE_CHECKING:
    from .dataset import RunResult
    from .recorder import Recorder

Watched = Mapping[str, np.ndarray]
# cos(phi) is 1 within 0.1 % up to here: rotations are taken as small (paper, section 2).
LARGEST_ROTATION = 0.05
# Work that the time stepping itself does at changes of contact within a mesh cycle, in parts of the largest energy,
# above which there is a warning. The sharp edges of unrelieved tips alone take 3 to 4 %.
NOTABLE_WORK = 0.1
# Warnings with these words come first: the numbers of the run are wrong.
NO_MEANING = "the result has no meaning"
FEWER_THAN_THE_PERIOD = "of the common period"
WINDOW_REACHED = "contact reached the end of the contact window"


def worst_first(warnings: Iterable[str]) -> list[str]:
    """Warnings in their order, but first those that the result has no meaning, then those that its numbers are of a
    part of the period only."""
    return sorted(warnings, key=lambda said: (NO_MEANING not in said, FEWER_THAN_THE_PERIOD not in said))


# Between the names of meshes that have the same warning.
NAMES_BETWEEN = "; "
_NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def of_each_kind(named: Iterable[tuple[str, str]]) -> list[str]:
    """One sentence of those that differ in their numbers alone, the one of the largest first number, behind the names
    of the meshes that have it. `named`: name of a mesh, and its warning.

    >>> of_each_kind([("sun-1", "in 3 of 9 steps"), ("sun-2", "in 4 of 9 steps"), ("1-ring", "too thin")])
    ['sun-1; sun-2: in 4 of 9 steps (that is sun-2, the most)', '1-ring: too thin']
    """
    kinds: dict[str, list[tuple[str, str]]] = {}
    for name, said in named:
        kinds.setdefault(_NUMBER.sub("0", said), []).append((name, said))
    return [_one_of(kind) for kind in kinds.values()]


def _one_of(kind: Sequence[tuple[str, str]]) -> str:
    name, said = max(kind, key=lambda each: float((_NUMBER.findall(each[1]) or ["0"])[0]))
    alike = len({words for _, words in kind}) == 1
    names = NAMES_BETWEEN.join(dict.fromkeys(each for each, _ in kind))
    return f"{names}: {said}" + ("" if alike else f" (that is {name}, the most)")


def warnings_of_energy(
    scene: Scene, result: RunResult, steps_per_mesh_cycle: int, steps: slice = slice(None)
) -> list[str]:
    """Whether the time stepping, not physics, adds or removes much energy within a mesh cycle where teeth part and
    meet, in all steps or some. It is judged cycle by cycle, since over a long run even a little adds up."""
    if scene.inertia is None or scene.tooth_elasticity is None or not len(result["time"]):
        return []
    work = result["work_contact_changes"][steps]
    largest = max(result["energy"][steps].max(), np.finfo(float).tiny)
    cycles = (work[first : first + steps_per_mesh_cycle + 1] for first in range(0, len(work), steps_per_mesh_cycle))
    part = max(float(np.ptp(cycle)) for cycle in cycles) / largest
    if part <= NOTABLE_WORK:
        return []
    return [
        f"where teeth part and meet the time stepping itself changes the energy, by {part:.2g} times its largest value"
        " within a mesh cycle (work_contact_changes): impacts are not resolved; raise accuracy.steps_per_mesh_cycle"
        f" above {steps_per_mesh_cycle}"
    ]


def warnings_of(recorder: Recorder, march: March, result: RunResult) -> list[str]:
    """A sentence for each assumption of the model that a march breaks. Every step is judged; the uniqueness of the
    solution, whose proof costs more than a step, by the last steps."""
    cycle = recorder.cycle
    drivetrain = recorder.model.drivetrain
    clock = recorder.model.clock
    of_mesh = warnings_of_mesh(recorder, result.attrs)
    for along in recorder.along_face:
        of_mesh += along.warnings(result.dataset)
    return [
        *of_mesh, *_separation(cycle, drivetrain, march, clock, result),
        *locking(cycle, march), *_uniqueness(march),
    ]  # fmt: skip


def warnings_of_mesh(recorder: Recorder, numbers: Mapping[str, Any]) -> list[str]:
    """What of it one mesh tells, of a pair or among those of a train, with its `numbers` (attributes)."""
    cycle = recorder.cycle
    curves = recorder.arrays
    watched = recorder.watched
    of_flanks = [*_window(cycle, watched), *_rank(watched)] if cycle.traits.nodes_on_flanks and recorder.steps else []
    said = [*_passed_through(cycle, curves), *of_flanks, *_rotation(curves), *_wedged(cycle, curves)]
    if cycle.traits.has_pressure and recorder.steps:
        said += warnings_of_pressure(recorder.model.scene, watched, numbers)
    return said


def _window(cycle: Cycle, watched: Watched) -> list[str]:
    reached = int(watched["window reached"].sum())
    if not reached:
        return []
    return [
        f"{WINDOW_REACHED} in {reached} of {len(watched['window reached'])} steps: "
        f"raise accuracy.contact_length above {cycle.grid.length:.3g} mm"
    ]


def _rank(watched: Watched) -> list[str]:
    """Contact nodes closer together than the elements resolve: elasticity does not determine how they share a force."""
    dependent = watched["dependent rows"]
    if not dependent.any():
        return []
    worst = int(np.argmax(dependent))
    rows = watched["rows"][worst]
    return [
        f"the contact compliance is singular in {np.count_nonzero(dependent)} of {len(dependent)} steps (rank"
        f" {rows - dependent[worst]} of {rows} at worst): contact nodes are closer than the elements resolve;"
        " forces are right, the pressure is not: lower accuracy.contact_nodes or accuracy.flank_element_size"
    ]


def _passed_through(cycle: Cycle, curves: Watched) -> list[str]:
    pitch = abs(cycle.pair.wheel.angular_pitch)
    largest = np.abs(curves["transmission_error"]).max(initial=0.0)
    if largest <= pitch:
        return []
    return [
        f"{NO_MEANING}: the transmission error reaches {largest:.3g} rad, more than the pitch of the wheel's teeth"
        f" ({pitch:.3g} rad): the gears would have gone through each other; the other warnings say why"
    ]


def _rotation(curves: Watched) -> list[str]:
    sentences = []
    for name, rotations in zip(GEARS, curves["rotation"].T):
        largest = np.abs(rotations).max(initial=0.0)
        if largest > LARGEST_ROTATION:
            sentences.append(
                f"the {name} turns by {largest:.3g} rad from its nominal motion; the model takes such rotations as"
                f" small (below {LARGEST_ROTATION} rad): stiffen the shafts or lower the torque"
            )
    tilts = [np.abs(curves[name]).max(axis=0, initial=0.0) for name in ("tilt_x", "tilt_y") if name in curves]
    for name, largest in zip(GEARS, np.max(tilts, axis=0) if tilts else ()):
        if largest > LARGEST_ROTATION:
            sentences.append(
                f"the {name} tilts by {largest:.3g} rad; the model takes such rotations as small (below"
                f" {LARGEST_ROTATION} rad): stiffen its bearings, move them apart or lower the torque"
            )
    return sentences


def _wedged(cycle: Cycle, curves: Watched) -> list[str]:
    if not cycle.coast_flanks:
        return []
    coast = curves["coast_normal_force"]
    both = wedged(curves)
    if not both.any():
        return []
    return [
        f"the teeth are wedged in {both.sum()} of {len(both)} steps: drive and coast flanks press at once, the coast"
        f" flanks by up to {coast[both].max():.4g} N, since there is less backlash"
        f" ({max(cycle.pair.backlash * 1e3, 0.0):.3f} um) than the gears need: raise their centre_distance"
    ]


def _separation(cycle: Cycle, drivetrain: Drivetrain, march: March, clock: Clock, result: RunResult) -> list[str]:
    """Loss of contact: how often, when, how long and how far; a scene without coast flanks has no meaning once the
    opening exceeds the backlash."""
    losses = contact_losses(march.separations)
    # With a negative torque the wheel drives on the coast flanks; that is no loss of contact.
    if not losses or (cycle.coast_flanks and drivetrain.driven_backwards and len(march.separations) == march.steps):
        return []
    backlash = cycle.pair.backlash
    widest = max(loss.opening for loss in losses)
    longest = max(losses, key=lambda loss: loss.duration(clock))
    share = sum(loss.duration(clock) for loss in losses) / clock.duration(0, march.steps)
    times = "once" if len(losses) == 1 else f"{len(losses)} times"
    lost = (
        f"the {'drive flanks' if cycle.coast_flanks else 'teeth'} lose contact {times}, in {len(march.separations)} of"
        f" {march.steps} steps ({share:.2g} of the time), first at {_when(losses[0].first, cycle, clock)}, last at"
        f" {_when(losses[-1].first, cycle, clock)}, for up to {longest.duration(clock):.3g} s ="
        f" {longest.steps / cycle.steps:.3g} mesh cycles, by up to {widest * 1e3:.4g} um"
    )
    if cycle.coast_flanks or widest <= backlash:
        return [lost]
    crossed = next(step for step, opening in march.separations if opening > backlash)
    beyond = (
        f"{lost}. That is more than the backlash of {backlash * 1e3:.4g} um: from {_when(crossed, cycle, clock)} on the"
        " coast flanks would touch, which this scene does not have"
    )
    if "settled_from" in result.attrs and clock.time(march.separations[-1][0]) < result.attrs["settled_from"]:
        return [
            f"{beyond}. The cycles that the numbers are taken from are in contact throughout; [coast_flanks] would"
            " compute the cycles before them"
        ]
    return [f"{beyond}, and {NO_MEANING} from that time on; add [coast_flanks]"]


def _when(step: int, cycle: Cycle, clock: Clock) -> str:
    return f"{clock.time(step):.4g} s (mesh cycle {step / cycle.steps:.2f})"


def locking(cycle: Cycle, march: March) -> list[str]:
    """What to say where friction locks the teeth."""
    if not march.locked:
        return []
    return [
        f"friction locks the teeth (self-locking) in {len(march.locked)} of {march.steps} steps, first in mesh cycle"
        f" {march.locked[0] / cycle.steps:.2f}: on approach it turns the wheel back by more than the normal force"
        f" drives it: lower friction.coefficient (here {march.friction:g})"
    ]


def _uniqueness(march: March) -> list[str]:
    if not march.uncertified:
        return []
    return [
        f"in {march.uncertified} of the last {march.judged} steps there may be more than one solution: friction couples"
        f" the contact nodes too strongly to certify the one found (friction.coefficient is {march.friction:g})"
    ]
