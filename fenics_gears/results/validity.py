"""The warnings of a finished run: where its own result breaks an assumption of the model."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.dynamics.clock import Clock
from fenics_gears.dynamics.contact_loss import contact_losses
from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.dynamics.march import March
from fenics_gears.effects.relief import PARABOLIC, Reliefs
from fenics_gears.results.key_numbers import wedged
from fenics_gears.scene.data import Scene

if TYPE_CHECKING:
    from fenics_gears.results.recorder import Recorder

Watched = Mapping[str, np.ndarray]
# cos(phi) is 1 within 0.1 % up to here: rotations are taken as small (paper, section 2).
LARGEST_ROTATION = 0.05
# Work that the time stepping itself does at changes of contact within a mesh cycle, in parts of the largest energy,
# above which there is a warning. The sharp edges of unrelieved tips alone take 3 to 4 %.
NOTABLE_WORK = 0.1
# Peak pressure of a line contact over yield strength, at which the material below begins to yield by Tresca's criterion
# (Johnson, Contact Mechanics, 1985, eq. 6.4).
LINE_CONTACT = 1.67
# Warnings with these words come first: the numbers of the run are wrong.
NO_MEANING = "the result has no meaning"
FEWER_THAN_THE_PERIOD = "of the common period"
WINDOW_REACHED = "contact reached the end of the contact window"


def worst_first(warnings: Iterable[str]) -> list[str]:
    """Warnings in their order, but first those that the result has no meaning, then those that its numbers are of a
    part of the period only."""
    return sorted(warnings, key=lambda said: (NO_MEANING not in said, FEWER_THAN_THE_PERIOD not in said))


def warnings_of_energy(
    scene: Scene, result: xr.Dataset, steps_per_mesh_cycle: int, steps: slice = slice(None)
) -> list[str]:
    """Whether the time stepping, not physics, adds or removes much energy within a mesh cycle where teeth part and
    meet, in all steps or some.

    The work is taken cycle by cycle: over a long run even little of it adds up.
    """
    if scene.inertia is None or scene.tooth_elasticity is None or not result.sizes["time"]:
        return []
    work, largest = (
        result["work_contact_changes"].values[steps],
        max(result["energy"].values[steps].max(), np.finfo(float).tiny),
    )
    cycles = (work[first : first + steps_per_mesh_cycle + 1] for first in range(0, len(work), steps_per_mesh_cycle))
    part = max(float(np.ptp(cycle)) for cycle in cycles) / largest
    if part <= NOTABLE_WORK:
        return []
    return [
        f"where teeth part and meet the time stepping itself changes the energy, by {part:.2g} times its largest value"
        " within a mesh cycle (work_contact_changes): impacts are not resolved; raise accuracy.steps_per_mesh_cycle"
        f" above {steps_per_mesh_cycle}"
    ]


def warnings_of(recorder: Recorder, march: March, result: xr.Dataset) -> list[str]:
    """A sentence for each assumption of the model that a march breaks.

    Every step is judged. Only the uniqueness of the solution is judged by the last steps, which the march keeps: its
    proof costs more than a step.
    """
    cycle, drivetrain, clock = recorder.cycle, recorder.model.drivetrain, recorder.model.clock
    watched = recorder.watched
    of_flanks = [*_window(cycle, watched), *_rank(watched)] if cycle.traits.nodes_on_flanks and recorder.steps else []
    if cycle.traits.has_pressure and recorder.steps:
        of_flanks += _yielding(recorder.model.scene, result.attrs)
        of_flanks += [
            *_sharp_edge(recorder.model.scene, watched),
            *_undercut_edge(watched),
            *_kink(recorder.model.scene, result.attrs),
        ]
    if cycle.face is not None:
        # Imported here: plane scenes have none.
        from fenics_gears.results.face_variables import warnings_of_face

        of_flanks += warnings_of_face(cycle.face, result)
    return [
        *_passed_through(cycle, result), *of_flanks, *_rotation(result), *_wedged(cycle, result),
        *_separation(cycle, drivetrain, march, clock, result), *_locking(cycle, march), *_uniqueness(march),
    ]  # fmt: skip


def _window(cycle: Cycle, watched: Watched) -> list[str]:
    """Contact at an end of the window that is no edge of the flank: the window cuts pressure off."""
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
        f" {rows - dependent[worst]} of {rows} at worst): contact nodes stand closer than the elements can tell apart"
        " and were given a thin layer each; forces hold, the pressure does not: lower accuracy.contact_nodes or"
        " accuracy.flank_element_size"
    ]


def _passed_through(cycle: Cycle, result: xr.Dataset) -> list[str]:
    """A transmission error of more than a pitch: the teeth of both gears would stand in the same place."""
    pitch = cycle.pair.wheel.angular_pitch
    largest = np.abs(result["transmission_error"].values).max(initial=0.0)
    if largest <= pitch:
        return []
    return [
        f"{NO_MEANING}: the transmission error reaches {largest:.3g} rad, more than the pitch of the wheel's teeth"
        f" ({pitch:.3g} rad): the gears would have gone through each other; the other warnings say why"
    ]


def _rotation(result: xr.Dataset) -> list[str]:
    found = []
    for name, rotations in zip(result["gear"].values, result["rotation"].values.T):
        largest = np.abs(rotations).max(initial=0.0)
        if largest > LARGEST_ROTATION:
            found.append(
                f"the {name} turns by {largest:.3g} rad from its nominal motion; the model takes such rotations as"
                f" small (below {LARGEST_ROTATION} rad): stiffen the shafts or lower the torque"
            )
    tilts = [np.abs(result[name].values).max(axis=0, initial=0.0) for name in ("tilt_x", "tilt_y") if name in result]
    for name, largest in zip(result["gear"].values, np.max(tilts, axis=0) if tilts else ()):
        if largest > LARGEST_ROTATION:
            found.append(
                f"the {name} tilts by {largest:.3g} rad; the model takes such rotations as small (below"
                f" {LARGEST_ROTATION} rad): stiffen its bearings, move them apart or lower the torque"
            )
    return found


def _wedged(cycle: Cycle, result: xr.Dataset) -> list[str]:
    """Teeth pressed on both sides at once, since run-out, errors or deflection need more than the backlash; the load
    does not explain these forces."""
    if not cycle.coast_flanks:
        return []
    coast, both = result["coast_normal_force"].values, wedged(result)
    if not both.any():
        return []
    return [
        f"the teeth are wedged in {both.sum()} of {len(both)} steps: drive and coast flanks press at once, the coast"
        f" flanks by up to {coast[both].max():.4g} N, since there is less backlash"
        f" ({max(cycle.pair.backlash * 1e3, 0.0):.3f} um) than the gears need: raise gears.centre_distance"
    ]


def _sharp_edge(scene: Scene, watched: Watched) -> list[str]:
    """Contact on the sharp edge of a tip, where linear elasticity has infinite pressure."""
    touched = {gear: watched[f"on the {gear}'s tip"] for gear in ("pinion", "wheel")}
    steps = int((touched["pinion"] | touched["wheel"]).sum())
    if not steps:
        return []
    gears = [gear for gear, at in touched.items() if at.any()]
    named = " and ".join(f"the {gear}'s" for gear in gears)
    return [
        f"contact reaches the sharp edge of {named} tip in {steps} of {len(touched['pinion'])} steps: the pressure"
        f" there does not converge with the mesh, forces and transmission error do; {_off_the_edge(scene, gears)}"
    ]


def _undercut_edge(watched: Watched) -> list[str]:
    """Contact on the edge between an undercut gear's involute and its fillet, at its form circle."""
    found = []
    for gear in ("pinion", "wheel"):
        at = watched[f"on the {gear}'s form circle"]
        if at.any():
            found.append(
                f"contact reaches the edge at the form circle of the undercut {gear} in {int(at.sum())} of {len(at)}"
                " steps: the pressure there does not converge with the mesh, forces and transmission error do;"
                f" [root_relief.{gear}] takes the load off the edge"
            )
    return found


def _yielding(scene: Scene, numbers: Mapping) -> list[str]:
    """Stresses above what the materials bear without yielding, where their yield strength is known."""
    found, pressure = [], numbers.get("peak_contact_pressure", 0.0)
    for gear, material in zip(("pinion", "wheel"), scene.gears.materials):
        strength = material.yield_strength
        if strength is None:
            continue
        limit, root = LINE_CONTACT * strength, numbers.get(f"largest_root_stress_{gear}", 0.0)
        if pressure > limit:
            found.append(
                f"the peak contact pressure, {pressure:.4g} MPa, is above what the {gear}'s material bears below the"
                f" flank without yielding, {limit:.4g} MPa: {LINE_CONTACT:g} times its yield strength of {strength:g}"
                " MPa (Johnson, Contact Mechanics, 1985, eq. 6.4); the model is elastic"
            )
        if root > strength:
            found.append(
                f"the largest root stress of the {gear}, {root:.4g} MPa, is above its yield strength of {strength:g}"
                " MPa; the model is elastic"
            )
    return found


def _kink(scene: Scene, numbers: Mapping) -> list[str]:
    """More pressure at the kink where a linear relief starts than elsewhere: linear elasticity has infinite pressure
    there."""
    largest, elsewhere = numbers.get("peak_kink_pressure", 0.0), numbers.get("peak_contact_pressure", 0.0)
    if largest <= elsewhere:
        return []
    linear = {section: _linear(getattr(scene, section)) for section in ("tip_relief", "root_relief")}
    named = ((section.replace("_", " "), gears) for section, gears in linear.items() if gears)
    starts = " or ".join(f"the linear {words} of the {' or the '.join(gears)}" for words, gears in named)
    remedies = ", ".join(f'{section}.shape = "{PARABOLIC}"' for section, gears in linear.items() if gears)
    return [
        f"beside the kink where {starts} starts the pressure reaches {largest:.4g} MPa and does not converge with the"
        f" mesh; forces and transmission error do. The peak contact pressure, {elsewhere:.4g} MPa, is without it;"
        f" {remedies} starts without a kink"
    ]


def _linear(reliefs: Reliefs | None) -> list[str]:
    """The gears whose relief is linear."""
    own = {gear: getattr(reliefs, gear, None) for gear in ("pinion", "wheel")}
    return [gear for gear, relief in own.items() if relief is not None and relief.power == 1 and relief.depth > 0.0]


def _off_the_edge(scene: Scene, gears: list[str]) -> str:
    """The remedies for contact on sharp tips that the scene does not have yet."""
    reliefs = [getattr(scene.tip_relief, gear) for gear in gears] if scene.tip_relief is not None else []
    if None in reliefs:
        ways = [
            f"[tip_relief.{gear}] takes the load off the edge" for gear, relief in zip(gears, reliefs) if relief is None
        ]
    elif reliefs:
        ways = ["a deeper or longer tip relief takes more load off the edge"]
        ways += (
            [f'tip_relief.shape = "{PARABOLIC}" is steeper at the tip']
            if any(relief.power == 1 for relief in reliefs)
            else []
        )
    else:
        ways = ["[tip_relief] takes the load off the edge"]
    rounded = scene.corner_contact is not None and min(scene.corner_contact.edge_radii) > 0.0
    return ", ".join([*ways, *([] if rounded else ["[corner_contact] with an edge_radius rounds it"])])


def _separation(cycle: Cycle, drivetrain: Drivetrain, march: March, clock: Clock, result: xr.Dataset) -> list[str]:
    """Loss of contact: how often, when, how long and how far; a scene without coast flanks has no meaning once the
    opening exceeds the backlash."""
    losses = contact_losses(march.separations)
    # With a negative torque the wheel drives on the coast flanks; that is no loss of contact.
    if not losses or (cycle.coast_flanks and drivetrain.driven_backwards and len(march.separations) == march.steps):
        return []
    backlash, widest = cycle.pair.backlash, max(loss.opening for loss in losses)
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
            f"{beyond}. The cycles that the numbers are taken from are in contact throughout; [coast_flanks] would give"
            " what comes before them"
        ]
    return [f"{beyond}, and {NO_MEANING} from that time on; add [coast_flanks]"]


def _when(step: int, cycle: Cycle, clock: Clock) -> str:
    return f"{clock.time(step):.4g} s (mesh cycle {step / cycle.steps:.2f})"


def _locking(cycle: Cycle, march: March) -> list[str]:
    """Friction that turns the wheel back by more than the normal force drives it, so that forces grow beyond what the
    load needs."""
    if not march.locked:
        return []
    return [
        f"friction locks the teeth (self-locking) in {len(march.locked)} of {march.steps} steps, first in mesh cycle"
        f" {march.locked[0] / cycle.steps:.2f}: at contact nodes on approach it turns the wheel back by more than the"
        " normal force drives it, and the forces grow beyond what the load asks for: lower friction.coefficient (here"
        f" {march.friction:g})"
    ]


def _uniqueness(march: March) -> list[str]:
    """Steps at which the solution cannot be proved to be the only one."""
    if not march.uncertified:
        return []
    return [
        f"in {march.uncertified} of the last {march.judged} steps there may be more than one solution: friction couples"
        " the contact nodes so strongly that the one found cannot be certified as the only one (friction.coefficient"
        f" is {march.friction:g})"
    ]
