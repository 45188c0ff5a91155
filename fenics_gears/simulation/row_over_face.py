"""The contact equations of a row of gears over the face: bodies of its gears, its meshes, and what couples these."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fenics_gears.contact.face_mesh import face_mesh
from fenics_gears.contact.idler import Idler
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.row import MeshOfRow, RowCycle, at_phase
from fenics_gears.contact.row_over_face import RowOverFace, idler_over_face
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Body, Reach
from fenics_gears.elasticity.face.compliance import idler_compliance
from fenics_gears.elasticity.face_compliance_data import IdlerCompliance
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.model import Model
from fenics_gears.model.train import RowModel
from fenics_gears.system.progress import Progress

from .bodies import gear_body
from .elastic_route import cycle_of, flanks_of


def row_cycle_over_face(
    row: RowModel, coordinates: Sequence[np.ndarray], modes: int, progress: Progress, cache: Cache
) -> RowCycle:
    """The contact equations of all meshes of a row over the face, on the bodies of all gears; `coordinates` of each
    mesh, and `modes`, as of `contact.row.MeshOfRow`."""
    bodies, idlers = _bodies(row, progress, cache)
    meshes = []
    for number, (own, (phase, _), rows) in enumerate(zip(row.models, row.begun, coordinates)):
        meshes.append(MeshOfRow(_cycle(own, bodies[number], phase), rows, modes))
    coupled = []
    for mesh, body in enumerate(idlers):
        first, second = (each.cycle for each in meshes[mesh : mesh + 2])
        place = Idler(mesh, row.models[mesh].pair.wheel.teeth, row.second_mesh(mesh))
        sides = (first.pair.sides[1], first.face), (second.pair.sides[0], second.face)
        coupled.append(idler_over_face(place, body, sides))
    return RowCycle(meshes, RowOverFace(coupled))


def _bodies(row: RowModel, progress: Progress, cache: Cache) -> tuple[list[tuple[Body, Body]], list[IdlerCompliance]]:
    """Both gears of each mesh, and the idlers between these."""
    idlers = []
    progress.stage("condense gear 1")
    driving = gear_body(row.models[0], GEARS[0], cache)
    found = []
    for mesh in range(len(row.models) - 1):
        progress.stage(f"condense gear {mesh + 2}")
        section, solid = idler_bodies(row, mesh, cache)
        found.append((driving, Body.of(section, solid.drive)))
        driving = Body.of(section, solid.coast)
        idlers.append(solid)
    progress.stage(f"condense gear {len(row.models) + 1}")
    found.append((driving, gear_body(row.models[-1], GEARS[1], cache)))
    return found, idlers


def idler_bodies(row: RowModel, mesh: int, cache: Cache):
    """The section of an idler, which is alike for both of its meshes, and its body."""
    gear, material, division, reach = row.key_of_idler(mesh)
    # A web is in the body; in its sections it would be twice.
    section = replace(gear, web=None)
    fine = flank_compliance(section, material, division, Reach(reach.same), cache)
    return fine, idler_compliance(gear, material, row.solid_discretisation_of_idler(mesh), reach, cache)


def _cycle(model: Model, bodies: tuple[Body, Body], phase: float) -> Cycle:
    """The contact equations of one mesh of a row."""
    solids = bodies[0].solid, bodies[1].solid
    grid = model.resolution.contact_grid
    mesh = face_mesh(flanks_of(model, bodies), solids, model.face, grid, model.corner)
    return cycle_of(model, at_phase(mesh, phase))
