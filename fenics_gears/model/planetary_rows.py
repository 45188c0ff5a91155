"""What `gears check` tells of a planetary set: its ratio, members, planets and phases, in rows for people."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy as np

from fenics_gears.geometry.planetary import RING, SUN, PlanetarySet
from fenics_gears.scene.carrier import Carrier
from fenics_gears.scene.train_mesh import MeshOfScene, gear_names

from .row_model import RowModel

Row = tuple[str, str, str]
HARMONICS = 12
LETTERS = "r rotation of sun, ring and carrier, t translation, b both, p neither"


def set_rows(row: RowModel) -> list[Row]:
    """Teeth, ratio, mesh frequency, steps, phase law, assembly and room."""
    carrier = row.shafts.carrier
    assert carrier is not None
    own = carrier.set
    sun, ring = (row.meshes[carrier.meshes(kind)][0] for kind in range(2))
    distance = abs(sun.pair.centre_distance)
    tip = 2.0 * max(sun.pair.wheel.tip_radius, ring.pair.pinion.tip_radius)
    one, other, clear = min(own.clearances(distance, tip), key=lambda each: each[2])
    gears = SUN, "planet", *(("step",) if own.stepped else ()), own.second
    teeth = *own.teeth[:2], *(() if own.step is None else (own.step,)), own.teeth[2]
    steps = row.models[0].resolution.steps_per_mesh_cycle
    spacing = "equally spaced" if own.equally_spaced else "not equally spaced"
    rows = [
        (f"teeth of {', '.join(gears)}", " / ".join(map(str, teeth)), ""),
        ("planets", f"{own.planets}, {spacing}", ""),
        ("centre distance", f"{distance:.6g}", "mm"),
        ("turns of the input in one of the output", f"{float(own.ratio):.6g}", _sense(own)),
        ("steps in a mesh cycle", f"{steps}", f"a multiple of {own.denominator}: all phases are whole steps"),
        (f"harmonics 1 to {HARMONICS} of equal planets", own.phase_law(HARMONICS), LETTERS),
        ("assembly", "fits", f"planets stand at multiples of 360 deg/{own.turn} = {360.0 / own.turn:.6g} deg"),
        (f"least room between tips, planets {one + 1} and {other + 1}", f"{clear:.4g}", "mm"),
    ]
    if sun.scene.motion.speed_given:
        frequency = f"mesh frequency {'with the sun' if own.stepped else 'of all meshes'}"
        rows.insert(4, (frequency, f"{sun.scene.motion.mesh_frequency:.6g}", "Hz"))
    if not own.sun_drives:
        words = "run with the sun driving; without friction forces are the same, in the reverse order of time"
        rows.append((f"as the carrier sees it, the {own.second} drives", "", words))
    return rows + (_of_steps(row, own) if own.stepped else []) + _supports(carrier, ring)


def _supports(carrier: Carrier, with_ring: MeshOfScene) -> list[Row]:
    """What holds the ring and the members, and where the carrier gives way."""
    rows = []
    if carrier.set.second == RING:
        support = "held at its outer circle" if with_ring.pair.wheel.foundation is None else "on an elastic foundation"
        points = with_ring.scene.wheel_points
        if points is not None:
            support = f"on {len(points.places)} points of its outer circle"
        rows.append((RING, support, ""))
    if carrier.floating:
        rows.append(("floating", ", ".join(carrier.floating), ""))
    if carrier.file is not None:
        rows.append(("carrier", "elastic between its pins", f"by {Path(carrier.file.path).name}"))
    if carrier.bearing_stiffness is not None:
        rows.append(("carrier's bearings", f"{carrier.bearing_stiffness:.4g}", "N/mm"))
    return rows


def _of_steps(row: RowModel, own: PlanetarySet) -> list[Row]:
    """How the second gears of stepped planets stand, and when all meshes are where they were."""
    carrier = row.shafts.carrier
    assert carrier is not None
    planet, step = (gear_names(row.meshes).index(names[0]) for names in (carrier.planets, carrier.steps))
    pitch = 360.0 / (own.teeth[1] * own.cycles[1])
    angle = 180.0 / pi * (row.layout.tooth_angle(step) - row.layout.tooth_angle(planet)) % pitch
    # Of nothing round-off makes no whole.
    angle = 0.0 if pitch - angle < 1e-9 * pitch else angle
    of_sun, of_second = own.cycles
    steps = row.models[-1].resolution.steps_per_mesh_cycle
    return [
        (
            "a tooth of each step from one of its planet",
            f"{angle:.6g}",
            f"deg counter-clockwise, modulo {pitch:.6g} deg",
        ),
        (f"steps in a mesh cycle with the {own.second}", f"{steps}", ""),
        (f"harmonics 1 to {HARMONICS} with the {own.second}", own.phase_law(HARMONICS, True), LETTERS),
        (
            "all meshes are where they were",
            f"{of_sun}",
            f"mesh cycles with the sun later, {of_second} with the {own.second}",
        ),
    ]


def _sense(own: PlanetarySet) -> str:
    return "in the same sense" if own.ratio > 0 else "against each other"


def member_rows(carrier: Carrier) -> list[Row]:
    """Speeds and torques of all members, and power in and out."""
    own = carrier.set
    torques = own.torques(carrier.torque)
    rows = []
    for member in own.members:
        part = {own.fixed: "fixed", own.input: "input", own.output: "output"}[member]
        speed = own.speeds[member]
        turning = f"{float(speed):.6g} turns in one of the input"
        said = f"{1e-3 * torques[member]:.6g} N m from outside, {turning}"
        if carrier.speed is not None:
            rate = 60.0 * carrier.speed / (2.0 * pi) * float(speed)
            power = 1e-6 * torques[member] * carrier.speed * float(speed)
            said += f", {rate:.6g} rpm, {power:.5g} kW"
        rows.append((f"{member}, {part}", said, ""))
    return rows


def planet_rows(row: RowModel) -> list[Row]:
    """Where planets stand, at which phases their meshes are as the run begins, and pins beside their places."""
    carrier = row.shafts.carrier
    assert carrier is not None
    own = carrier.set
    of_sun, of_ring = (row.layout.phases[carrier.meshes(kind)] for kind in range(2))
    rows = []
    for number, (angle, one, other) in enumerate(zip(own.angles, of_sun, of_ring)):
        said = (
            f"at {180.0 / pi * angle:.6g} deg, mesh phases {one:.6g} with the {SUN}, {other:.6g} with the {own.second}"
        )
        if carrier.pin_errors:
            tangential, radial = (1e3 * each for each in carrier.pin_errors[number])
            said += f", pin {tangential:.4g} um against its force, {radial:.4g} um out"
        rows.append((f"planet {number + 1}", said, ""))
    for each in carrier.run_outs:
        said = f"{1e3 * each.distance:.4g} um, at {180.0 / pi * each.phase:.4g} deg as the run begins"
        rows.append((f"run-out of {each.gear.removeprefix(f'{carrier.stage}.')}", said, ""))
    stiffness = "rigid" if carrier.pin_stiffness is None else f"{carrier.pin_stiffness:.4g}"
    for gear, pitches in carrier.pitches:
        single = 1e3 * max(map(abs, pitches))
        total = 1e3 * np.ptp(np.cumsum(pitches))
        said = f"{single:.4g} um at most, {total:.4g} um in all around the gear"
        rows.append((f"pitch errors of {gear.removeprefix(f'{carrier.stage}.')}", said, ""))
    return [*rows, ("pins", stiffness, "" if carrier.pin_stiffness is None else "N/mm")]
