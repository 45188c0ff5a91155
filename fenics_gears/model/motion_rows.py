"""What moves, in rows for people: speed, inertia, periods and natural frequencies of a scene."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, lcm
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.dynamics.drivetrain import gear_of
from fenics_gears.dynamics.frequencies import PERIOD_ERROR, Vibration
from fenics_gears.dynamics.guidance import resolved_frequency
from fenics_gears.effects import common_period
from fenics_gears.geometry.sliding import sliding_speed

from .drivetrain import lumped_gears
from .model import Model

if TYPE_CHECKING:
    from fenics_gears.dynamics.elastic_shaft import ElasticShaft
    from fenics_gears.dynamics.shaft_system import ShaftSystem

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
    for system, shaft in shafts_of(model):
        modes = sum(name.endswith(f"_{shaft.name}") for name in system.own_modes)
        lowest = "lowest mode" if modes == 1 else f"{modes} lowest modes"
        words = f"kg, in addition, with its {lowest}, up to {shaft.up_to:.4g} Hz"
        rows.append((f"mass of the {shaft.name}'s shaft", 1e3 * shaft.mass_of_all, words))
    twists = "twist_2" in model.drivetrain.coordinates
    if twists or inertia.load is not None:
        place = "far end of the output shaft" if twists else "with the wheel"
        rows.append(("load moment of inertia", 1e3 * inertia.shaft_end, f"kg mm^2, {place}"))
    reduced = 1e3 * along[0] * along[1] / sum(along)
    label = "reduced mass J1 J2/(J1 rb2^2 + J2 rb1^2)"
    return [*rows, (label, reduced, "kg, of both gears along the line of action")]


def shafts_of(model: Model) -> list[tuple[ShaftSystem, ElasticShaft]]:
    """The shafts that bend, each with the system that it is in."""
    return [(system, shaft) for system in model.drivetrain.systems for shaft in system.shafts]


def unknown_rows(model: Model) -> Rows:
    """The shafts that bend, with how stiff they are where the gear is, and the motions that are unknown."""
    rows: Rows = []
    for system, shaft in shafts_of(model):
        (seat,) = shaft.seats
        places = ", ".join(f"{bearing.at:g}" for bearing in shaft.bearings)
        rows.append((f"shaft of the {seat.gear}", shaft.length, f"mm, on bearings at {places} mm from its left end"))
        x, y, axial, *_ = 1e-3 / np.diag(np.linalg.inv(system.stiffness_at(seat)))
        words = f"{x:.4g} along x, {y:.4g} along y, {axial:.4g} axially"
        held = "its bearings" if system.housing is None else "its bearings in their housing"
        rows.append((f"its stiffness at the {seat.gear}", words, f"N/um, with {held}"))
        if seat.integral:
            words = "mm, the root diameter, as which the shaft bends and twists within the face"
            rows.append(
                (f"the {seat.gear} is cut into its shaft", 2.0 * getattr(model.pair, seat.gear).root_radius, words)
            )
        elif seat.hub is not None:
            words = "mm, the bore, where hub and shaft hold each other without slip and give way together"
            rows.append((f"press fit of the {seat.gear}", 2.0 * seat.hub.shaft.outer, words))
    names = model.drivetrain.of_gears
    motions = ", ".join(map(motion_in_words, names))
    return [*rows, ("motions of the gears that are unknown", f"{len(names)}:", motions)]


def period_rows(model: Model) -> Rows:
    """Mesh cycles of the common period: after it all that differs between cycles repeats."""
    period = common_period(model.scene)
    gears = model.scene.gears
    if period == inf:
        return [("mesh cycles of the common period", "none", "(no two mesh cycles are alike)")]
    words = "(all mesh cycles are alike)" if period == 1 else ""
    if period > 1 and period == lcm(*(gear.teeth for gear in gears.of_gears)):
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
