"""Displacement and stress of a gear's whole body from the forces on its flanks.

Three solves: loads inside a sector are brought to its cuts by the factored sector; the ring's cyclic system
    (`elasticity.ring`) moves the
cuts of all sectors; from its two cuts the inside of each sector follows by the factored sector again.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag

from fenics_gears.elasticity.condensation import dofs_of
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.elasticity.elements import Element, element_named
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.nodal_stress import nodal_stress
from fenics_gears.elasticity.ring import cyclic, cyclic_motion, rotation, turned_nodes
from fenics_gears.elasticity.sector_interior import SectorInterior
from fenics_gears.elasticity.sector_mesh import sector_mesh
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material


@dataclass(frozen=True)
class RecoveredBody:
    """A gear's sectors under load, the hub held: sector s stands s pitches counter-clockwise of the first, each in its
    own tooth's frame.

    displacement: (teeth, n, 2), mm. stress: (teeth, n, 3), MPa: xx, yy, xy at the nodes, averaged over the elements
        that meet there,
    those of the neighbouring sector at a cut included. hub_force: (3,), N per mm of face width and N: forces and torque
    of the hub on the body, in the frame of sector 0, about the gear's centre.
    """

    displacement: np.ndarray
    stress: np.ndarray
    hub_force: np.ndarray


class GearRecovery:
    """A gear whose displacement and stress are recovered from forces on its flanks.

    gear, material: lengths in mm, MPa. mesh: the sector that its compliance was computed on, in modules. Use it in a
        `with`, or `close` it.
    """

    def __init__(self, gear: Gear, material: Material, mesh: BodyMesh, element: Element):
        self.gear, self.material, self.element = gear, material, element
        self.interior = SectorInterior(mesh, element, material.poissons_ratio)
        self.nodal_stress = nodal_stress(self.interior.nodes, material.poissons_ratio)
        self._same, self._ahead = cyclic(self._link())

    def __enter__(self) -> GearRecovery:
        return self

    def __exit__(self, *failure) -> None:
        self.close()

    def close(self) -> None:
        """Give the factor's memory back."""
        self.interior.close()

    @property
    def points(self) -> np.ndarray:
        """Nodes (n, 2) of the first sector in its tooth's frame, mm."""
        return self.gear.module * self.interior.nodes.points

    def flank_loads(self, forces: dict[int, np.ndarray]) -> np.ndarray:
        """Loads (teeth, 2 n) from line forces (2 f,) or (4 f,), N/mm, on the flank nodes of some teeth, by the sector
        they are of.

        f: nodes of a flank, in the order of the flank compliance and in each tooth's own frame; the coast flank's after
            the drive flank's.
        """
        loads = np.zeros((self.gear.teeth, 2 * len(self.interior.nodes.points)))
        drive, coast = (dofs_of(self.interior.flank_nodes(side)) for side in ("flank", "coast"))
        for tooth, force in forces.items():
            own = loads[tooth % self.gear.teeth]
            np.add.at(own, drive, force[: len(drive)])
            if len(force) > len(drive):
                np.add.at(own, coast, force[len(drive) :])
        return loads

    def recovered(self, forces: dict[int, np.ndarray]) -> RecoveredBody:
        """Displacement and stress of the whole gear under forces on flanks, as in `flank_loads`."""
        loads = self.flank_loads(forces)
        loaded = {int(tooth): loads[tooth][:, None] for tooth in np.flatnonzero(loads.any(axis=1))} or {
            0: loads[0][:, None]
        }
        unit = self.unit_displacement(loaded, range(self.gear.teeth))[:, :, 0]
        displacement = unit.reshape(self.gear.teeth, -1, 2) / self.material.youngs_modulus
        # Strains are displacements over the gear's own lengths, which the mesh has in modules.
        return RecoveredBody(displacement, self._stress(unit) / self.gear.module, self._hub_force(unit))

    def unit_displacement(self, loads: dict[int, np.ndarray], sectors: Iterable[int]) -> np.ndarray:
        """Displacement (sectors, 2 n, k) of some sectors under loads (2 n, k) on some, by number; Young's modulus 1
        MPa, the hub held."""
        teeth, cases = self.gear.teeth, next(iter(loads.values())).shape[1]
        on_lower, on_upper = (
            _by_sector(each, cases) for each in self.interior.at_held_cuts(np.hstack([*loads.values()]))
        )
        cut_loads = np.zeros((teeth, *on_lower.shape[1:]))
        cut_loads[[*loads]] += on_lower
        cut_loads[[(sector + 1) % teeth for sector in loads]] += self._turned(on_upper, -1)
        motion, chosen = self.cut_motion(cut_loads), np.array([*sectors]) % teeth
        upper = self._turned(motion[(chosen + 1) % teeth], 1)
        unloaded = np.zeros_like(next(iter(loads.values())))
        inside = np.hstack([loads.get(sector, unloaded) for sector in chosen.tolist()])
        return _by_sector(self.interior.between_cuts(np.hstack(motion[chosen]), np.hstack(upper), inside), cases)

    def _turned(self, vectors: np.ndarray, pitches: int) -> np.ndarray:
        """Interleaved plane vectors (sectors, 2 c, k) turned counter-clockwise by pitches."""
        turn = rotation(pitches * self.gear.angular_pitch)
        return np.einsum("xa,scak->scxk", turn, vectors.reshape(len(vectors), -1, 2, vectors.shape[-1])).reshape(
            vectors.shape
        )

    def cut_motion(self, loads: np.ndarray) -> np.ndarray:
        """Displacement (teeth, 2 c, k) of the sectors' lower cuts under loads (teeth, 2 c, k) on them, Young's modulus
        1 MPa."""
        return cyclic_motion(self._same, self._ahead, loads)

    def _link(self) -> np.ndarray:
        """Stiffness (4 c, 4 c) of one sector between its cuts, the upper one's dofs in the frame of the next sector."""
        cut = 2 * len(self.interior.lower)
        motion = block_diag(np.eye(cut), turned_nodes(self.gear.teeth, cut // 2))
        moved = self.interior.between_cuts(
            motion[:cut], motion[cut:], np.zeros((2 * len(self.interior.nodes.points), 2 * cut))
        )
        link = motion.T @ (
            self.interior.stiffness[dofs_of(np.concatenate([self.interior.lower, self.interior.upper]))] @ moved
        )
        return 0.5 * (link + link.T)

    def _hub_force(self, unit: np.ndarray) -> np.ndarray:
        """Sum over the sectors of the hub's forces on them, (3,)."""
        hub = self.interior.hub
        total, points = np.zeros(3), self.points[hub]
        rows = self.interior.stiffness[dofs_of(hub)]
        for tooth, displacement in enumerate(unit):
            force = (rows @ displacement).reshape(-1, 2)
            total[:2] += rotation(tooth * self.gear.angular_pitch) @ force.sum(axis=0)
            total[2] += (points[:, 0] * force[:, 1] - points[:, 1] * force[:, 0]).sum()
        return total

    def _stress(self, unit: np.ndarray) -> np.ndarray:
        """Averaged stress (teeth, n, 3) in modules' lengths, elements of both sectors counted at a cut."""
        weighted = (self.nodal_stress.weighted @ unit.T).T.reshape(len(unit), -1, 3)
        weight = self.nodal_stress.weight.copy()
        hub = self.interior.hub
        lower, upper = (
            np.concatenate([cut, self._hub_end(cut, hub)]) for cut in (self.interior.lower, self.interior.upper)
        )
        pitch = self.gear.angular_pitch
        ahead, behind = np.roll(weighted, -1, axis=0)[:, lower], np.roll(weighted, 1, axis=0)[:, upper]
        at_lower, at_upper = weight[lower], weight[upper]
        weighted[:, upper] += turned_stress(ahead, pitch)
        weighted[:, lower] += turned_stress(behind, -pitch)
        weight[upper] += at_lower
        weight[lower] += at_upper
        return weighted / weight[:, None]

    def _hub_end(self, cut: np.ndarray, hub: np.ndarray) -> np.ndarray:
        """The hub's node at the end of a cut, (1,)."""
        points = self.interior.nodes.points
        angle = np.arctan2(*(points[cut[0]][::-1]))
        ends = np.arctan2(points[hub][:, 1], points[hub][:, 0])
        return hub[[np.argmin(np.abs(np.angle(np.exp(1j * (ends - angle)))))]]


def _by_sector(columns: np.ndarray, cases: int) -> np.ndarray:
    """Columns (m, sectors cases) as (sectors, m, cases)."""
    return columns.reshape(len(columns), -1, cases).swapaxes(0, 1)


def gear_recovery(
    gear: Gear, material: Material, discretisation: Discretisation, coast_flank: bool = False
) -> GearRecovery:
    """A gear's recovery on the very mesh that `flank_compliance` has with the same settings."""
    element, sizes = element_named(discretisation.element), discretisation.sizes(gear, both_flanks=coast_flank)
    return GearRecovery(
        gear, material, sector_mesh(gear.of_module_one, sizes.in_modules_of(gear), element.quadrilateral), element
    )


def turned_stress(stress: np.ndarray, angle: float) -> np.ndarray:
    """Stress xx, yy, xy (..., 3) of a body turned counter-clockwise by an angle (rad)."""
    cosine, sine = np.cos(angle), np.sin(angle)
    matrix = np.array(
        [
            [cosine**2, sine**2, -2.0 * sine * cosine],
            [sine**2, cosine**2, 2.0 * sine * cosine],
            [sine * cosine, -sine * cosine, cosine**2 - sine**2],
        ]
    )
    return stress @ matrix.T
