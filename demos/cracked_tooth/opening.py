"""How far the faces of the crack stand apart, or would pass through each other, while one tooth after the other carries
the whole load.

    python -m demos.cracked_tooth.opening

The model lets faces pass through each other. Where they do, a real crack is closed and carries as if it were not there.
"""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree

from demos.cracked_tooth.depths import CRACKED_TOOTH, DEPTHS, HERE
from fenics_gears.geometry.outline import rotation
from fenics_gears import load_scene
from fenics_gears.elasticity import dolfinx_adapter as adapter
from fenics_gears.elasticity.condensation import by_radius
from fenics_gears.elasticity.element_sizes import ElementSizes, element_sizes
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.mumps import Factor
from fenics_gears.elasticity.condensation import dofs_of
from fenics_gears.elasticity.stiffness import displacement_space, nodes_at, stiffness_matrix
from fenics_gears.geometry.gear import Gear
from fenics_gears.model.model import model_of
from fenics_gears.scene.data import Material
from meshes.root_crack import RootCrack, crack_line, cracked_gear_mesh

P2 = ELEMENTS["P2"]
# The load is spread smoothly about this roll angle (rad), above the pitch point: as high as a tooth carries alone.
PLACE, WIDTH = 0.5, 0.1


class CrackedBody:
    """A whole gear with a crack, the hub held, solved for loads on single teeth; lengths in mm."""

    def __init__(self, gear: Gear, material: Material, sizes: ElementSizes, crack: RootCrack):
        self.gear, self.material = gear, material
        self.mesh = cracked_gear_mesh(gear, sizes, {CRACKED_TOOTH: crack})
        self.space = displacement_space(self.mesh, P2)
        self.points = adapter.node_coordinates(self.space)
        turned = rotation(CRACKED_TOOTH * gear.angular_pitch)
        mouth, along = (turned @ each for each in crack_line(gear, crack))
        self.across = np.array([-along[1], along[0]])
        self.left, self.right = self._faces(mouth)

    def openings(self, teeth: tuple[int, ...], line_load: float) -> np.ndarray:
        """Distance (teeth, nodes), um, of the faces' twin nodes, negative where they would pass through each other;
        N/mm on each tooth."""
        matrix = stiffness_matrix(self.space, P2, self.material.poissons_ratio)
        starts, columns, values = matrix.getValuesCSR()
        stiffness = sparse.csr_matrix((values, columns, starts), shape=matrix.getSize())
        hub = nodes_at(self.space, self.mesh.edge_nodes("hub", 2))
        free = np.setdiff1d(np.arange(stiffness.shape[0]), dofs_of(hub))
        loads = line_load * np.column_stack([self._load(tooth) for tooth in teeth])
        moved = np.zeros_like(loads)
        factor = Factor(stiffness[free][:, free], "a cracked gear")
        moved[free] = factor.solve(loads[free]) / self.material.youngs_modulus
        factor.close()
        matrix.destroy()
        moved = moved.T.reshape(len(teeth), -1, 2)
        return 1e3 * (moved[:, self.left] - moved[:, self.right]) @ self.across

    def on_flank(self, tooth: int) -> np.ndarray:
        """Forces (2f,) that press on the nodes of a tooth's flank with 1 N/mm in all, in the tooth's frame."""
        rolls = self.gear.roll_angle(
            np.maximum(np.linalg.norm(self.points[self._flank(tooth)], axis=1), self.gear.base_radius)
        )
        weight = np.exp(-(((rolls - PLACE) / WIDTH) ** 2)) * np.gradient(rolls**2)
        return -(weight[:, None] * np.column_stack([np.cos(rolls), -np.sin(rolls)]) / weight.sum()).ravel()

    def _flank(self, tooth: int) -> np.ndarray:
        return nodes_at(self.space, by_radius(self.mesh.edge_nodes(f"flank {tooth}", 2)))

    def _load(self, tooth: int) -> np.ndarray:
        """The same as forces on all nodes (2 n,) in space."""
        load = np.zeros(2 * len(self.points))
        load[dofs_of(self._flank(tooth))] = (
            self.on_flank(tooth).reshape(-1, 2) @ rotation(tooth * self.gear.angular_pitch).T
        ).ravel()
        return load

    def _faces(self, mouth: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Twin nodes on the left and on the right face of the crack, seen from its mouth."""
        twins = cKDTree(self.points).query_pairs(1e-9 * self.gear.tip_radius, output_type="ndarray")
        cells = adapter.cell_nodes(self.space)
        on_left = (self.points[cells].mean(axis=1) - mouth) @ self.across > 0.0
        first_is_left = np.isin(twins[:, 0], cells[on_left])
        return np.where(first_is_left, *twins.T), np.where(first_is_left, *twins.T[::-1])


def table(bodies: dict[float, CrackedBody], line_load: float) -> list[str]:
    """Rows of a table in Markdown: at the mouth, the tooth in mesh before the cracked one, itself, and the next."""
    teeth = (CRACKED_TOOTH + 1, CRACKED_TOOTH, CRACKED_TOOTH - 1)
    rows = [
        (
            "| opening of the faces (µm) | whole load on the tooth before | whole load on the cracked tooth | whole"
            " load on the tooth after |"
        ),
        "|---|---|---|---|",
    ]
    for depth, body in bodies.items():
        found = body.openings(teeth, line_load)
        rows.append(
            f"| crack of {depth:g} mm | " + " | ".join(f"{each[np.argmax(np.abs(each))]:.1f}" for each in found) + " |"
        )
    return rows


def main() -> None:
    """Print the table for the depths of this folder."""
    model = model_of(load_scene(HERE / "cracked_tooth.toml"))
    gear, material = model.pair.pinion, model.scene.gears.material
    sizes = element_sizes(gear, P2, 0.4)
    bodies = {depth: CrackedBody(gear, material, sizes, RootCrack(depth)) for depth in DEPTHS if depth}
    load = model.scene.load.wheel_torque / model.pair.wheel.base_radius / model.pair.face_width
    print("\n".join(table(bodies, load)))


if __name__ == "__main__":
    main()
