"""What moves, in rows for people: speed, inertia, periods and natural frequencies of a scene."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import inf, isfinite, lcm
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.dynamics.drivetrain import gear_of
from fenics_gears.dynamics.frequencies import PERIOD_ERROR, Vibration
from fenics_gears.dynamics.guidance import resolved_frequency
from fenics_gears.effects import common_period
from fenics_gears.geometry.sliding import sliding_speed
from fenics_gears.inputs.tree import GEARS

from .drivetrain import lumped_gears
from .model import Model

if TYPE_CHECKING:
    from fenics_gears.dynamics.elastic_shaft import SeatedGear
    from fenics_gears.dynamics.shaft_system import ShaftSystem
    from fenics_gears.geometry.gear import Gear

Rows = list[tuple[str, object, str]]
MILLIMETRE = 1e-3  # m


def speed_rows(model: Model) -> Rows:
    """Nominal speeds of the gears, the pitch circles and the flanks' sliding, at the highest mesh frequency of the
    run."""
    pair = model.pair
    highest = model.scene.mesh_frequencies[1]
    turns = highest / pair.pinion.teeth
    ends = np.array([pair.path_start, pair.path_end])
    sliding = np.abs(sliding_speed(pair, ends, highest)) * MILLIMETRE
    pitch = 2.0 * np.pi * turns * pair.centre_distance * pair.rotation_ratio / (1.0 + pair.rotation_ratio) * MILLIMETRE
    when = "" if model.scene.speed_ramp is None else "at the ramp's highest speed"
    speeds = f"{60.0 * turns:.5g} rpm pinion, {60.0 * turns * abs(pair.rotation_ratio):.5g} rpm wheel"
    slides = f"{sliding[0]:.4g} m/s at the start of contact, {sliding[1]:.4g} m/s at its end"
    unit = f"m/s, {when}" if when else "m/s"
    return [
        ("nominal speeds", speeds, when),
        ("pitch line velocity", float(pitch), unit),
        ("sliding speed", slides, when),
    ]


def inertia_rows(model: Model) -> Rows:
    """Mass and moment of inertia of each gear, of the far end of the output shaft, and of both gears along the line of
    action."""
    rows: Rows = []
    along = []
    inertia = model.scene.inertia
    for number, (name, lumped) in enumerate(lumped_gears(model.scene, model.pair).items(), 1):
        given = inertia.of(name)
        for field, unit in (("mass", "kg"), ("moment_of_inertia", "kg mm^2")):
            origin = "" if getattr(given, field) is not None else ", of its body by the density"
            rows.append((f"{name} {field.replace('_', ' ')}", 1e3 * getattr(lumped, field), unit + origin))
        if f"tilt_x{number}" in model.drivetrain.coordinates:
            origin = "" if given.tilting_moment_of_inertia else ": J/2 + m b^2/12"
            about = f"kg mm^2, about a diameter{origin}"
            rows.append((f"{name} tilting moment of inertia", 1e3 * lumped.tilting_inertia, about))
        along.append(lumped.moment_of_inertia / getattr(model.pair, name).base_radius ** 2)
    twists = "twist_2" in model.drivetrain.coordinates
    if twists or inertia.load is not None:
        place = "far end of the output shaft" if twists else "with the wheel"
        rows.append(("load moment of inertia", 1e3 * inertia.shaft_end, f"kg mm^2, {place}"))
    reduced = 1e3 * along[0] * along[1] / sum(along)
    label = "reduced mass J1 J2/(J1 rb2^2 + J2 rb1^2)"
    return [*rows, (label, reduced, "kg, of both gears along the line of action")]


def unknown_rows(model: Model) -> Rows:
    """The shafts that bend, and the motions that are unknown."""
    names = model.drivetrain.of_gears
    motions = ", ".join(map(motion_in_words, names))
    gears = {gear: getattr(model.pair, gear) for gear in GEARS}
    unknown = ("motions of the gears that are unknown", f"{len(names)}:", motions)
    return [*rows_of_shafts(model.drivetrain.systems, gears), unknown]


def rows_of_shafts(systems: Sequence[ShaftSystem], gears: Mapping[str, Gear]) -> Rows:
    """The shafts that bend, with what is on them, how stiff they are at their `gears`, by their names, and their
    masses."""
    rows: Rows = []
    for system, shaft in [(own, shaft) for own in systems for shaft in own.shafts]:
        name = f"the {shaft.name}'s shaft" if shaft.name in GEARS else f"shaft {shaft.name}"
        seats = ", ".join(f"{each.gear} at {each.at:g}" for each in shaft.seats)
        places = sorted(
            (each.at, "" if each.rolling is None else f" ({each.rolling.elements})") for each in shaft.bearings
        )
        bearings = ", ".join(f"{at:g}{kind}" for at, kind in places)
        rows.append((name, shaft.length, f"mm, bends; {seats}; bearings at {bearings} mm from its left end"))
        torsion = system.torsional_stiffness(shaft)
        if isfinite(torsion):
            ends = [*(each.gear for each in shaft.seats), "drive or load"][:2]
            rows.append(("its torsional stiffness", torsion, f"N mm/rad, between {' and '.join(ends)}"))
        for seat in shaft.seats:
            rows += _rows_of_seat(system, seat, gears[seat.gear])
        if shaft.density:
            modes = sum(each.endswith(f"_{shaft.name}") for each in system.own_modes)
            words = f"kg, in addition, with {modes} modes up to {shaft.up_to:.4g} Hz"
            rows.append((f"mass of {name}", 1e3 * shaft.mass_of_all, words))
    return rows


def _rows_of_seat(system: ShaftSystem, seat: SeatedGear, gear: Gear) -> Iterator[tuple[str, object, str]]:
    """How stiff the shaft is there, and what gives way within the face."""
    name = f"the {seat.gear}" if seat.gear in GEARS else seat.gear
    x, y, axial, *_ = 1e-3 / np.diag(np.linalg.inv(system.stiffness_at(seat)))
    held = "its bearings" if system.housing is None else "its bearings in their housing"
    words = f"{x:.4g} along x, {y:.4g} along y, {axial:.4g} axially"
    yield f"its stiffness at {name}", words, f"N/um, with {held}"
    if seat.integral:
        words = "mm, the root diameter, as which the shaft bends and twists within the face"
        yield f"{name} is cut into its shaft", 2.0 * gear.root_radius, words
    elif seat.hub is not None:
        words = "mm, the bore, where hub and shaft hold each other without slip and give way together"
        yield f"press fit of {name}", 2.0 * seat.hub.shaft.outer, words


def period_rows(model: Model) -> Rows:
    """Mesh cycles of the common period: after it all that differs between cycles repeats."""
    period = common_period(model.scene)
    gears = model.scene.gears
    if period == inf:
        return [("mesh cycles of the common period", "none", "(no two mesh cycles are alike)")]
    words = "(all mesh cycles are alike)" if period == 1 else ""
    if period > 1 and period == lcm(*gears.teeth):
        words = "after which every tooth has met every other"
    return [("mesh cycles of the common period", period, words)]


def frequency_rows(found: Sequence[Vibration], time_step: float) -> Rows:
    """Each natural frequency with the steps that a period has, and the limits of what a step (s) resolves and
    samples."""
    rows: Rows = []
    for number, vibration in enumerate(found, 1):
        steps = vibration.steps_per_period(time_step)
        unmoved = "" if vibration.excited else ", not excited by contact"
        motion = vibration.motion and f", {vibration.motion}"
        damped = f", damping ratio {vibration.damping_ratio:.2g}" if vibration.damping_ratio > 0.0 else ", undamped"
        words = f"Hz: {steps:.3g} steps per period{damped}{motion}{unmoved}"
        rows.append((f"mode {number}", vibration.frequency, words))
    words = f"Hz: by the time step, periods exact within {PERIOD_ERROR:.0%}"
    rows.append(("highest frequency that is resolved", resolved_frequency(time_step), words))
    return [*rows, ("highest frequency that is sampled", 0.5 / time_step, "Hz: two steps per period")]


# Coordinates of a drivetrain in words, without the number of the gear.
MOTIONS = {
    "centre_x": "centre along x", "centre_y": "centre along y", "rotation_": "rotation", "axial_": "along its axis",
    "tilt_x": "tilt about x", "tilt_y": "tilt about y",
}  # fmt: skip


def motion_in_words(coordinate: str) -> str:
    if coordinate == "twist_2":
        return "twist of the output shaft"
    return f"{gear_of(coordinate)} {MOTIONS[coordinate[:-1]]}"
