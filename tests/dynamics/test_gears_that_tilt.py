"""Helical gears on bearings along their shafts, in mesh."""

from dataclasses import replace

import numpy as np
import pytest
from tests.stand_in import stand_in_body

from fenics_gears.contact.face import Face, even_slices
from fenics_gears.contact.face_mesh import face_mesh, opening_over_face
from fenics_gears.contact.mesh_cycle import Cycle, Gaps
from fenics_gears.contact.window import ContactGrid
from fenics_gears.dynamics.bearings import BearingPlaces, Bearings, Support
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.stepping import EquationsOfMotion
from fenics_gears.geometry.gear_data import Helix
from fenics_gears.model.drivetrain import drivetrain
from fenics_gears.results.side_by_side import _reaction_rows

SLICES, STEPS = 5, 8
HELIX = Helix(np.deg2rad(12.0))
PLACES = BearingPlaces((-40.0, 60.0), (-30.0, 75.0))
BEARINGS = Bearings(0.2e6, stiffness_y=0.3e6, axial_stiffness=0.07e6, pinion=Support(stiffness_x=0.1e6), places=PLACES)
# From the middle of the common face.
MIDDLES = (1.5, -1.5)


class Mesh:
    """A cycle over a face of stand-in gears, and what a quasi-static march of it gives."""

    def __init__(self, scene, flanks, bearings, *, opening=0.0, friction=False):
        self.scene, self.pair = replace(scene, inertia=None, damping=None, bearings=bearings), flanks.pair
        self.shafts, self.friction = drivetrain(self.scene, self.pair), friction
        face = Face(*even_slices(self.pair.face_width, SLICES), self.pair.slope, self.pair.gear_middles)
        bodies = tuple(stand_in_body(gear, self.pair.face_width + 4.0) for gear in (self.pair.pinion, self.pair.wheel))

        def openings(heights, positions):
            return opening * heights / self.pair.face_width

        mesh = face_mesh(flanks, bodies, face, ContactGrid(3.0, 12))
        cycle = Cycle(mesh, STEPS, self.shafts.indices, friction)
        self.cycle = cycle.with_gaps(Gaps(openings=(opening_over_face(cycle, openings),)))

    def marched(self, plain=False, cycles=1, marcher=Marcher):
        motion = EquationsOfMotion(self.shafts, 1e-4, 0.1 if self.friction else 0.0)
        return marcher(self.cycle, motion, plain=plain).run(cycles * STEPS, cycles * STEPS + 1).records

    def reactions(self, record):
        """Force, N, and moment, N mm, (x, y, z) of pinion and wheel on their shafts about their mid-widths."""
        operator = record.position.operator
        rows = _reaction_rows([operator], operator.pairs, self.friction) @ record.solution.forces
        return [
            (
                np.array([*rows[place : place + 2], rows[6 + place]]),
                np.array([*rows[7 + place : 9 + place], rows[2 + place]]),
            )
            for place in (0, 3)
        ]


@pytest.fixture(scope="module")
def helical(paper_scene, stand_in_flanks):
    flanks = with_helix(stand_in_flanks, axial_offsets=(1.0, -2.0))
    assert flanks.pair.gear_middles == MIDDLES
    return [Mesh(paper_scene, flanks, BEARINGS, opening=0.004, friction=on) for on in (False, True)]


def with_helix(flanks, **changes):
    return replace(flanks, pair=replace(flanks.pair, helix=HELIX, **changes))


def test_all_balances_of_either_gear_are_closed(helical):
    """Exact: what a gear puts on its shaft is carried; the two gears' forces cancel, in force and in moment."""
    for mesh in helical:
        pair, shafts = mesh.pair, mesh.shafts
        centre = np.array(
            [pair.line_of_action_length, -pair.pinion.base_radius - pair.wheel.base_radius, MIDDLES[1] - MIDDLES[0]]
        )
        for record in mesh.marched():
            (force_1, moment_1), (force_2, moment_2) = mesh.reactions(record)
            size = np.abs(force_1).max()
            assert force_1 + force_2 == pytest.approx(np.zeros(3), abs=1e-11 * size)
            assert moment_1 + moment_2 + np.cross(centre, force_2) == pytest.approx(np.zeros(3), abs=1e-9 * size)
            found = {name: float(shafts.value(record.state.position, name)) for name in shafts.coordinates}
            for number, gear, force, moment in (("1", "pinion", force_1, moment_1), ("2", "wheel", force_2, moment_2)):
                carried, turned = np.zeros(3), np.zeros(3)
                for place in getattr(PLACES, gear):
                    x, y = (
                        found[f"centre_x{number}"] + place * found[f"tilt_y{number}"],
                        found[f"centre_y{number}"] - place * found[f"tilt_x{number}"],
                    )
                    at_bearing = 0.5 * np.array([BEARINGS.of(gear, "x") * x, BEARINGS.of(gear, "y") * y, 0.0])
                    carried, turned = carried + at_bearing, turned + np.cross((0.0, 0.0, place), at_bearing)
                carried[2] = BEARINGS.axial(gear) * found[f"axial_{number}"]
                turned[2] = (
                    mesh.scene.shafts.of("input") * found["rotation_1"]
                    if gear == "pinion"
                    else -mesh.scene.load.wheel_torque
                )
                assert force == pytest.approx(carried, rel=1e-9, abs=1e-9 * size) and moment == pytest.approx(
                    turned, rel=1e-9, abs=1e-8 * size
                )


def test_the_tilt_follows_the_misalignment(paper_scene, stand_in_flanks):
    """Limit: bearings next to each other let the flanks align, far ones do not."""
    loads = {}
    for half in (0.5, 1e4):
        bearings = Bearings(0.2e6, places=BearingPlaces((-half, half), (-half, half)))
        mesh = Mesh(paper_scene, stand_in_flanks, bearings, opening=0.01)
        record = mesh.marched()[-1]
        slices = np.array([pair.place.slice for pair in record.position.operator.pairs])[
            record.position.operator.node_pair
        ]
        loads[half] = np.bincount(slices, record.solution.forces, SLICES)
    assert np.ptp(loads[0.5]) < 0.02 * loads[0.5].mean() and np.ptp(loads[1e4]) > 0.5 * loads[1e4].mean()
