"""Natural frequencies and static displacements of a helical pair whose gears tilt and move axially, by this program
and by Exudyn. Its large displacements make differences that fall in proportion to the torque."""

from dataclasses import replace
from math import radians, sqrt

import numpy as np
from tests.benchmarks.against_exudyn.pair import BEARINGS, MESH, SHAFTS, scene

from fenics_gears import gear_pair, lumped_gears
from fenics_gears.dynamics.bearings import BearingPlaces
from fenics_gears.dynamics.frequencies import natural_frequencies
from fenics_gears.geometry.gear_data import Helix
from fenics_gears.model.drivetrain import drivetrain

# N mm: small, the program being of small displacements.
TORQUE = 30.0
PLACES = BearingPlaces((-30.0, 55.0), (-70.0, 25.0))
AXIAL = {"pinion": 4.0e4, "wheel": 6.0e4}
MOTIONS = [
    [f"{name}{gear}" for name in ("centre_x", "centre_y", "axial_", "tilt_x", "tilt_y", "rotation_")] for gear in (1, 2)
]


def by_this_program() -> tuple[np.ndarray, np.ndarray, dict]:
    """Frequencies (13,), Hz; displacements of both gears (2, 6), mm and rad; and what Exudyn is to be given."""
    plane = scene()
    held = {gear: replace(getattr(plane.bearings, gear), axial_stiffness=AXIAL[gear]) for gear in AXIAL}
    of = replace(
        plane, bearings=replace(plane.bearings, places=PLACES, **held), load=replace(plane.load, wheel_torque=TORQUE)
    )
    pair = replace(gear_pair(of.gears), helix=Helix(radians(20.0)), axial_offsets=(1.5, -2.0))
    shafts, lumped = drivetrain(of, pair), lumped_gears(of, pair)
    normals = shafts.mesh.normals
    state = np.linalg.solve(shafts.stiffness + 0.5 * MESH * normals.T @ normals, shafts.load)
    moved = np.array([[float(shafts.value(state, name)) for name in names] for names in MOTIONS])
    heights = np.array([-0.5, 0.5]) * pair.face_width / sqrt(3.0)
    given = {
        "centre": [
            [0.0, 0.0, pair.gear_middles[0]],
            [pair.line_of_action_length, -pair.pinion.base_radius - pair.wheel.base_radius, pair.gear_middles[1]],
        ],
        "normal": [pair.cosine, 0.0, -pair.cosine * pair.slope],
        "mesh": MESH,
        "contact": [[pair.pitch_point + pair.slope * height, -pair.pinion.base_radius, height] for height in heights],
        "mass": [each.mass for each in lumped.values()],
        "inertia": [each.moment_of_inertia for each in lumped.values()],
        "tilting_inertia": [each.tilting_inertia for each in lumped.values()],
        "load": of.inertia.shaft_end,
        "shaft": list(SHAFTS.values()),
        "bearing": list(BEARINGS.values()),
        "axial": list(AXIAL.values()),
        "places": [PLACES.pinion, PLACES.wheel],
        "torque": TORQUE,
    }
    return natural_frequencies(shafts, MESH), moved, given
