"""What moves in a train whose stages move together, in rows for people: inertia, unknowns and natural frequencies."""

from __future__ import annotations

from math import isfinite

import numpy as np

from fenics_gears.dynamics.frequencies import PERIOD_ERROR
from fenics_gears.dynamics.guidance import resolved_frequency
from fenics_gears.scene.train_mesh import gear_names

from .train import RowModel
from .train_parts import parts_of

Rows = list[tuple[str, float | str, str]]
# Of the kinetic energy of a mode, at least, for a motion to be named.
NOTABLE_SHARE = 0.2


def motion_rows(row: RowModel) -> Rows:
    """Masses of the gears, stiffness of the shafts, and the motions that are unknown."""
    parts = parts_of(row.meshes, row.shafts)
    gears = gear_names(row.meshes)
    rows: Rows = []
    for name, lumped in zip(gears, parts.masses):
        rows.append((f"{name}: moment of inertia", 1e3 * lumped.moment_of_inertia, "kg mm^2"))
    if parts.load is not None:
        rows.append(("load: moment of inertia", 1e3 * parts.load, "kg mm^2, on the last shaft"))
    for number, torsion in enumerate(parts.torsion, 1):
        if isfinite(torsion):
            rows.append((f"shaft {number}: torsional stiffness", torsion, "N mm/rad"))
    words = ", ".join(motion_in_words(name, gears) for name in row.drivetrain.coordinates)
    return [*rows, ("motions that are unknown", len(row.drivetrain.coordinates), words)]


def frequency_rows(row: RowModel) -> Rows:
    """Each natural frequency with the steps that a period has, and what moves most; none without inertia."""
    rows: Rows = []
    if not row.vibrations:
        return rows
    time_step = row.models[0].time_step
    for number, (vibration, moving) in enumerate(zip(row.vibrations, _moving_most(row)), 1):
        damping = vibration.damping_ratio
        damped = f"damping ratio {damping:.2g}" if damping > 0.0 else "undamped"
        unmoved = "" if vibration.excited else ", not excited by a mesh"
        steps = vibration.steps_per_period(time_step)
        words = f"Hz: {steps:.3g} steps per period, {damped}, mostly {moving}{unmoved}"
        rows.append((f"mode {number}", vibration.frequency, words))
    if rows:
        words = f"Hz: by the time step, periods exact within {PERIOD_ERROR:.0%}"
        rows.append(("highest frequency that is resolved", resolved_frequency(time_step), words))
    return rows


def _moving_most(row: RowModel) -> list[str]:
    """Of each elastic mode the motions that have most of the kinetic energy."""
    from fenics_gears.dynamics.frequencies import modes

    drivetrain = row.drivetrain
    frequencies, shapes = modes(drivetrain, row.mesh_stiffness)
    energy = shapes * (drivetrain.mass @ shapes)
    gears = gear_names(row.meshes)
    said = []
    for shares in energy.T[len(frequencies) - len(row.vibrations) :]:
        largest = np.argsort(-shares)
        named = [place for place in largest if shares[place] >= NOTABLE_SHARE] or [largest[0]]
        said.append(" and ".join(motion_in_words(drivetrain.coordinates[place], gears) for place in named[:2]))
    return said


def motion_in_words(name: str, gears: list[str]) -> str:
    """A coordinate of a train for people; `gears`: names of all, from the first on."""
    kind, _, number = name.partition(" of gear ")
    if number:
        direction = "along" if kind == "centre_x" else "off"
        return f"centre of {gears[int(number) - 1]} {direction} the line of action"
    kind, _, number = name.partition("_")
    return f"twist of shaft {number}" if kind == "twist" else f"rotation of shaft {number}"
