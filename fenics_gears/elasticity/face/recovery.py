"""Displacement and stress of swept sectors from the forces on a gear's flanks: as `elasticity.recovery` has them in the
plane."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import identity, kron

from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.elasticity.face.half_turn import half_turn_basis, half_turn_response
from fenics_gears.elasticity.face.sector_body import SectorBody
from fenics_gears.elasticity.face.swept_stress import SweptStress
from fenics_gears.elasticity.ring import cyclic, cyclic_motion, rotation
from fenics_gears.elasticity.sector_mesh import sector_mesh
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material


@dataclass(frozen=True)
class RecoveredSectors:
    """Some sectors of a gear under load, the hub held, each in its own tooth's frame at each height.

    sectors: numbers, pitches counter-clockwise of the first. displacement: (sectors, h, n, 3), mm. stress: (sectors, h,
        n, 3, 3), MPa, averaged
    over the elements that meet at a node.
    """

    sectors: tuple[int, ...]
    displacement: np.ndarray
    stress: np.ndarray


class FaceRecovery:
    """A gear, given by its transverse section, on the swept mesh of its face compliance. Use it in a `with`, or `close`
    it."""

    def __init__(self, gear: Gear, material: Material, discretisation: FaceDiscretisation, coast_flank: bool = False):
        self.gear, self.material, scaled = gear, material, discretisation.in_modules_of(gear)
        self.body = SectorBody(sector_mesh(gear.of_module_one, scaled.sizes), scaled.sweep, material.poissons_ratio)
        self.sides = ("flank", "coast") if coast_flank else ("flank",)
        half = len(self.body.between_cuts) // 2
        pitch = kron(identity(half // 3), rotation(gear.angular_pitch, 3), format="csr")
        self.stress = SweptStress(self.body.section, scaled.sweep, material.poissons_ratio)
        # The upper cut's dofs in the frame of the next sector.
        link, self._pitch, self._half = self.body.between_cuts.copy(), pitch, half
        link[half:] = pitch.T @ link[half:]
        link[:, half:] = link[:, half:] @ pitch
        self._link = 0.5 * (link + link.T)
        self._same, self._ahead = cyclic(self._link)

    def __enter__(self) -> FaceRecovery:
        return self

    def __exit__(self, *failure) -> None:
        self.close()

    def close(self) -> None:
        """Give the factor's memory back."""
        self.body.close()

    @property
    def points(self) -> np.ndarray:
        """Nodes (n, 2), mm, of the section in its tooth's frame."""
        return self.gear.module * self.body.section.points

    @property
    def heights(self) -> np.ndarray:
        """Heights (h,), mm from mid-width."""
        return self.gear.module * self.body.heights

    def recovered(self, forces: dict[int, np.ndarray], sectors: Sequence[int]) -> RecoveredSectors:
        """Some sectors under forces (sides, h, f, 3), N, on the flank nodes of some teeth, in each tooth's own frame at
        that height."""
        teeth = self.gear.teeth
        loads = {}
        for tooth, force in forces.items():
            loads[tooth % teeth] = loads.get(tooth % teeth, 0.0) + self._loads(force)
        free = {sector: self.body.free_motion(load[:, None]) for sector, load in loads.items()}
        motion = self._cut_motion(free)
        found = []
        for sector in sectors:
            own = free.get(sector % teeth, np.zeros((3 * self.body.nodes, 1)))
            wanted = np.vstack([motion[sector % teeth], self._pitch @ motion[(sector + 1) % teeth]])
            pull = self.body.between_cuts @ (wanted - self.body.at_cuts(own))
            found.append((own + self.body.free_motion(self.body.pulled(pull))).reshape(len(self.heights), -1, 3))
        unit = np.array(found)
        modulus, module = self.material.youngs_modulus, self.gear.module
        stress = np.array([self.stress.at_nodes(each) for each in unit]) / module**2
        self._average_at_cuts(sectors, stress)
        return RecoveredSectors(tuple(sectors), unit / (modulus * module), stress)

    def between_teeth(self, responding: np.ndarray, loaded: np.ndarray, reach: int) -> np.ndarray:
        """Reciprocal work (2 reach + 1, k, j) that the ring adds to that within a sector with free cuts, Young's
        modulus 1 MPa, lengths in modules.

        Of loads on the tooth m pitches ahead, m from -reach to reach, and on the loaded one; given by what they move
        the free cuts, (2 c, k) and (2 c, j).
        """
        basis = half_turn_basis(self.body.place(self.body.lower), len(self.heights))
        joint = half_turn_response(self._link, self.gear.teeth, reach + 1, basis)
        responding, loaded = (
            np.vstack([each[: self._half], self._pitch.T @ each[self._half :]]) for each in (responding, loaded)
        )
        held, forces, half = self._link @ responding, self._link @ loaded, self._half
        # Of the lower cut of each sector, which is the upper one of the sector before.
        motion = [joint(ahead) @ forces[:half] + joint(ahead - 1) @ forces[half:] for ahead in range(-reach, reach + 2)]
        found = np.stack([held[:half].T @ lower + held[half:].T @ upper for lower, upper in zip(motion, motion[1:])])
        found[reach] -= held.T @ loaded
        return found

    def _loads(self, force: np.ndarray) -> np.ndarray:
        loads = np.zeros((self.body.nodes, 3))
        for side, own in zip(self.sides, force):
            np.add.at(loads, self.body.flank_nodes(side), own.reshape(-1, 3))
        return loads.ravel()

    def _cut_motion(self, free: dict[int, np.ndarray]) -> np.ndarray:
        """Motion (teeth, 3 c, 1) of the sectors' lower cuts; `free`: that of the loaded sectors with free cuts."""
        on_cuts = np.zeros((self.gear.teeth, self._half, 1))
        for sector, moved in free.items():
            reaching = self.body.between_cuts @ self.body.at_cuts(moved)
            on_cuts[sector] += reaching[: self._half]
            on_cuts[(sector + 1) % self.gear.teeth] += self._pitch.T @ reaching[self._half :]
        return cyclic_motion(self._same, self._ahead, on_cuts)

    def _average_at_cuts(self, sectors: Sequence[int], stress: np.ndarray) -> None:
        """Average, in place, what two neighbouring sectors have at their common cut."""
        lower, upper, turn = self.body.lower, self.body.upper, rotation(self.gear.angular_pitch, 3)
        flat = stress.reshape(len(stress), -1, 3, 3)
        for place, sector in enumerate(sectors):
            if (sector + 1) not in sectors:
                continue
            ahead = list(sectors).index(sector + 1)
            mean = 0.5 * (flat[place, upper] + turn @ flat[ahead, lower] @ turn.T)
            flat[place, upper], flat[ahead, lower] = mean, turn.T @ mean @ turn
