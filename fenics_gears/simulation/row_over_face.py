"""Gears of a row over the face that several mates load: their bodies, and how their meshes feel each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from fenics_gears.contact.gear_over_face import GearOverFace, MeshOfGear, gear_over_face
from fenics_gears.contact.joined_meshes import JoinedMeshes
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Body, FlankCompliance, Reach
from fenics_gears.elasticity.face.compliance import shared_compliance
from fenics_gears.elasticity.face_compliance_data import SharedCompliance
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.model.row_model import RowModel


@dataclass(frozen=True, eq=False)
class SharedBody:
    """A gear that several mates load: its section, alike for all of its meshes, and its body."""

    section: FlankCompliance
    solid: SharedCompliance

    def in_mesh(self, row: RowModel, gear: int, mesh: int) -> Body:
        """The gear of this number as one of its meshes loads it."""
        own = next(each for each in _meshes_of(row, gear) if each.number == mesh)
        section, solid = self.section, self.solid.flanks[own.kind]
        if row.models[mesh].touching.coast is None:
            section = FlankCompliance(section.roll_angle, section.element_order, section.blocks, section.timings)
            solid = solid.of_drive_flanks
        return Body.of(section, solid)


def shared_body(row: RowModel, number: int, cache: Cache) -> SharedBody:
    """A gear of several meshes, by its number."""
    gear, material, division, reach = row.key_of_shared(number)
    # A web is in the body; in its sections it would be twice.
    fine = flank_compliance(replace(gear, web=None), material, division, Reach(reach.same, reach.own), cache)
    return SharedBody(fine, shared_compliance(gear, material, row.solid_discretisation_of(number), reach, cache))


def joined(row: RowModel, bodies: Sequence[Body | SharedBody], cycles: Sequence[Cycle]) -> JoinedMeshes:
    """The compliance of all meshes of a row, on the bodies of all gears."""
    return JoinedMeshes(
        [_coupling(row, gear, body, cycles) for gear, body in enumerate(bodies) if isinstance(body, SharedBody)]
    )


def _coupling(row: RowModel, gear: int, body: SharedBody, cycles: Sequence[Cycle]) -> GearOverFace:
    return gear_over_face(row.gear(gear).tooth_count, _meshes_of(row, gear), body.solid, cycles)


def _meshes_of(row: RowModel, gear: int) -> tuple[MeshOfGear, ...]:
    (first, side), *others = row.graph.sides[gear]
    counted = [MeshOfGear(mesh, own, row.layout.shared(gear, first, mesh)) for mesh, own in others]
    return MeshOfGear(first, side), *counted
