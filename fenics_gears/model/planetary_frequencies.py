"""Natural frequencies of a planetary set with lumped members, by the kinds of its modes, in rows for people."""

from __future__ import annotations

from itertools import groupby
from math import pi

from fenics_gears.dynamics.planetary_modes import (
    MIXED,
    PLANET,
    ROTATIONAL,
    TRANSLATIONAL,
    LumpedMember,
    LumpedSet,
    SetMode,
    set_modes,
)
from fenics_gears.geometry.planetary import CARRIER, RING, SUN
from fenics_gears.scene.planetary_schema import VibratingMember
from fenics_gears.scene.train_shafts import TrainShafts

from .drivetrain import mesh_stiffness
from .row_model import RowModel

Row = tuple[str, float | str, str]
WORDS = {
    ROTATIONAL: "sun, ring and carrier turn",
    TRANSLATIONAL: "sun, ring and carrier move aside",
    PLANET: "planets alone move",
    MIXED: "sun, ring and carrier turn and move aside",
}
# Frequencies are the same within this part of them; below this part of the highest a motion is rigid.
THE_SAME = 1e-6
RIGID = 1e-6


def lumped_set(row: RowModel) -> LumpedSet:
    """The set of a row whose scene gives lumped members."""
    carrier = row.shafts.carrier
    assert carrier is not None and carrier.vibration is not None and carrier.pin_stiffness is not None
    given = carrier.vibration
    with_sun, with_ring = row.meshes[:2]
    sun, ring = with_sun.pair, with_ring.pair
    planet = abs(sun.wheel.base_radius)
    stiffness = (
        given.sun_mesh_stiffness or mesh_stiffness(with_sun.scene, sun),
        given.ring_mesh_stiffness or mesh_stiffness(with_ring.scene, ring),
    )
    return LumpedSet(
        sun=_member(row.shafts, SUN, given.sun, abs(sun.pinion.base_radius)),
        ring=_member(row.shafts, RING, given.ring, abs(ring.wheel.base_radius)),
        carrier=_member(row.shafts, CARRIER, given.carrier, abs(sun.centre_distance)),
        planet=LumpedMember(given.planet.mass, given.planet.moment_of_inertia / planet**2),
        angles=tuple(carrier.set.angles),
        pressure_angles=(sun.operating_pressure_angle, ring.operating_pressure_angle),
        mesh_stiffness=stiffness,
        pin_stiffness=carrier.pin_stiffness,
    )


def _member(shafts: TrainShafts, name: str, given: VibratingMember, radius: float) -> LumpedMember:
    """A member whose arc has a radius (mm), the output with the load."""
    carrier = shafts.carrier
    assert carrier is not None
    support = 0.0 if name in carrier.floating else given.support_stiffness
    # In time the input turns as it is driven.
    prescribed = (carrier.set.fixed, carrier.set.input) if carrier.in_time else (carrier.set.fixed,)
    if given.torsional_stiffness is not None:
        torsion = given.torsional_stiffness / radius**2
    else:
        torsion = None if name in prescribed else 0.0
    load = (shafts.load or 0.0) if name == carrier.set.output else 0.0
    return LumpedMember(given.mass, (given.moment_of_inertia + load) / radius**2, support, torsion)


def set_frequency_rows(row: RowModel) -> list[Row]:
    """Each natural frequency with the kind of its modes and how many it has, and what was left out."""
    lumped = lumped_set(row)
    modes = set_modes(lumped)
    highest = modes[-1].frequency
    rows: list[Row] = [
        ("mesh stiffness with sun, ring", " / ".join(f"{each:.4g}" for each in lumped.mesh_stiffness), "N/mm"),
        *(_mode_row(found, highest) for found in _together(modes)),
    ]
    carrier = row.shafts.carrier
    assert carrier is not None
    speed = None if carrier.speed is None else abs(carrier.speed * float(carrier.set.speeds[CARRIER])) / (2.0 * pi)
    size = "" if speed is None else f"; here {speed:.4g} Hz"
    runs = ", which a run has" if carrier.in_time else ""
    words = f"gyroscopic and centrifugal terms{runs}: of free masses by the carrier's turns in a second{size}"
    return [*rows, ("left out", "rotation of the carrier", words)]


def _mode_row(found: list[SetMode], highest: float) -> Row:
    kind = found[0].kind
    times = {1: "single", 2: "double"}.get(len(found), f"{len(found)}-fold")
    frequency = found[0].frequency
    rigid = frequency < RIGID * highest
    return f"{kind}, {times}", 0.0 if rigid else frequency, f"Hz: {WORDS[kind]}{', as rigid bodies' if rigid else ''}"


def _together(modes: list[SetMode]) -> list[list[SetMode]]:
    """Modes of one kind and frequency, kind by kind, each by frequency."""
    found: list[list[SetMode]] = []
    kinds = (ROTATIONAL, TRANSLATIONAL, PLANET, MIXED)
    highest = modes[-1].frequency
    for _, group in groupby(sorted(modes, key=lambda each: kinds.index(each.kind)), key=lambda each: each.kind):
        for mode in group:
            before = found[-1][-1] if found else None
            alike = before is not None and before.kind == mode.kind
            near = THE_SAME * max(mode.frequency, RIGID * highest)
            if before is not None and alike and mode.frequency - before.frequency <= near:
                found[-1].append(mode)
            else:
                found.append([mode])
    return found
