"""The whole gear by brute force."""

import numpy as np

from fenics_gears import Gear, Material
from fenics_gears.elasticity.compliance import FlankCompliance
from fenics_gears.elasticity.condensation import by_radius, condense
from fenics_gears.elasticity.element_nodes import node_roll_angles
from fenics_gears.elasticity.elements import element_named
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.geometry.outline import rotation
from meshes.root_crack import joined_sectors


def whole_gear_compliance(
    mesh: BodyMesh,
    gear: Gear,
    material: Material,
    *,
    element: str = "P2",
    loaded_tooth: int = 0,
    tooth_offsets: int = 1,
    comm=None,
) -> FlankCompliance:
    """Flank compliance seen by one loaded tooth; mesh: "hub" and "flank t", all flanks alike; tooth_offsets: how
    many teeth ahead are known. Raises ComputationError where a flank or the hub is missing."""
    chosen = element_named(element)
    teeth = [(loaded_tooth + offset) % gear.teeth for offset in range(tooth_offsets + 1)]
    points = {f"flank {tooth}": by_radius(mesh.edge_nodes(f"flank {tooth}", chosen.order)) for tooth in teeth}
    body = condense(
        mesh, chosen, material.poissons_ratio, {**points, "hub": mesh.edge_nodes("hub", chosen.order)}, comm
    )
    flanks = np.concatenate([body.dofs(name) for name in points])
    compliance = np.linalg.inv(body.stiffness[np.ix_(flanks, flanks)])
    size = len(body.dofs(f"flank {teeth[0]}"))
    into_frames = [np.kron(np.eye(size // 2), rotation(tooth * gear.angular_pitch)) for tooth in teeth]
    blocks = np.stack(
        [
            into_frames[offset].T @ compliance[offset * size : (offset + 1) * size, :size] @ into_frames[0]
            for offset in range(tooth_offsets + 1)
        ]
    )
    blocks[0] = 0.5 * (blocks[0] + blocks[0].T)
    vertices = by_radius(mesh.points[mesh.edge_points(f"flank {teeth[0]}")])
    return FlankCompliance(
        roll_angle=node_roll_angles(gear, vertices, chosen.order),
        element_order=chosen.order,
        blocks=blocks / material.youngs_modulus,
        timings=body.timings,
    )


def whole_gear_mesh(sector: BodyMesh, teeth: int) -> BodyMesh:
    """``teeth`` copies of the sector, merged along their cuts; tooth t stands t pitches counter-clockwise of tooth
    0."""
    return joined_sectors([sector] * teeth)
