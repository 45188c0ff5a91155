"""The contact equations of a row of gears over the face: bodies of its gears, its meshes, and what couples these."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fenics_gears.contact.face_mesh import face_mesh
from fenics_gears.contact.idler import BetweenMeshes
from fenics_gears.contact.idler_over_face import idler_over_face
from fenics_gears.contact.joined_meshes import JoinedMeshes
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.row import MeshOfRow, RowCycle, at_phase
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Body, Reach
from fenics_gears.elasticity.face.compliance import idler_compliance
from fenics_gears.elasticity.face_compliance_data import IdlerCompliance
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.model import Model
from fenics_gears.model.shared_gears import couplings
from fenics_gears.model.train import RowModel
from fenics_gears.system.progress import Progress

from .bodies import gear_body
from .elastic_route import cycle_of, flanks_of


def row_cycle_over_face(
    row: RowModel, placed: Sequence[tuple[np.ndarray, np.ndarray]], modes: int, progress: Progress, cache: Cache
) -> RowCycle:
    """The contact equations of all meshes of a row over the face, on the bodies of all gears; `placed`: `coordinates`
    and `offset` of each mesh, and `modes`, as of `contact.row.MeshOfRow`."""
    bodies, idlers = _bodies(row, progress, cache)
    meshes = []
    for own, both, phase, (coordinates, offset) in zip(row.models, bodies, row.layout.phases, placed):
        meshes.append(MeshOfRow(_cycle(own, both, phase), coordinates, offset, modes))
    coupled = []
    for gear, body in idlers.items():
        (shared,) = couplings(row.layout, gear)
        cycles = [meshes[mesh].cycle for mesh in shared.meshes]
        sides = [(cycle.pair.sides[side], cycle.face) for cycle, side in zip(cycles, shared.sides)]
        coupled.append(idler_over_face(BetweenMeshes(row.gear(gear).teeth, shared), body, sides))
    return RowCycle(meshes, JoinedMeshes(coupled))


def _bodies(
    row: RowModel, progress: Progress, cache: Cache
) -> tuple[list[tuple[Body, Body]], dict[int, IdlerCompliance]]:
    """Both gears of each mesh, and by their numbers the idlers, which are driven in their first mesh and drive in their
    second."""
    idlers = {}
    found: dict[tuple[int, int], Body] = {}
    for gear, sides in enumerate(row.graph.sides):
        progress.stage(f"condense gear {gear + 1}")
        if len(sides) == 1:
            ((mesh, side),) = sides
            found[mesh, side] = gear_body(row.models[mesh], GEARS[side], cache)
            continue
        section, solid = idler_bodies(row, gear, cache)
        idlers[gear] = solid
        for each, own in zip(sides, (solid.drive, solid.coast)):
            found[each] = Body.of(section, own)
    return [(found[mesh, 0], found[mesh, 1]) for mesh in range(len(row.models))], idlers


def idler_bodies(row: RowModel, number: int, cache: Cache):
    """The section of an idler, by its number, which is alike for both of its meshes, and its body."""
    gear, material, division, reach = row.key_of_shared(number)
    # A web is in the body; in its sections it would be twice.
    section = replace(gear, web=None)
    fine = flank_compliance(section, material, division, Reach(reach.same), cache)
    return fine, idler_compliance(gear, material, row.solid_discretisation_of(number), reach, cache)


def _cycle(model: Model, bodies: tuple[Body, Body], phase: float) -> Cycle:
    """The contact equations of one mesh of a row."""
    solids = bodies[0].solid, bodies[1].solid
    grid = model.resolution.contact_grid
    mesh = face_mesh(flanks_of(model, bodies), solids, model.face, grid, model.corner)
    return cycle_of(model, at_phase(mesh, phase))
