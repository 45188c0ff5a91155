"""Displacement and stress of a gear's body, plane or swept along the face, from the forces on its flanks.

Loads inside a sector move its free cuts by the factored sector. The ring's cyclic system (`elasticity.ring`) joins the
cuts of all sectors. Forces on the cuts that make them move so give the inside of a sector, again by the factored
sector.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.sparse import identity, kron

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.geometry.outline import rotation

from .element_sizes import Discretisation
from .elements import element_named
from .face.computed import swept_section
from .face.cut_motions import cut_motions, loads_over_motions, over_motions
from .face.discretisation import FaceDiscretisation
from .nodal_stress import NodalStress
from .ring import cyclic, cyclic_motion, ring_work, turn_last
from .sector import Sector, plane_sector, swept_sector
from .sector_mesh import sector_mesh
from .spanned import spanned


@dataclass(frozen=True)
class RecoveredSectors:
    """Some sectors of a gear under load, the hub held, each in its own tooth's frame at each height.

    sectors: numbers, pitches counter-clockwise of the first. displacement: (sectors, h, n, 2) in the plane, (sectors,
    h, n, 3) over the face, mm. stress: (sectors, h, n, 3, 3), MPa, averaged over the elements that meet at a node,
    including elements of a neighbouring sector if it is recovered too.
    """

    sectors: tuple[int, ...]
    displacement: np.ndarray
    stress: np.ndarray


class GearRecovery:
    """A gear whose displacement and stress are recovered from forces on its flanks. Use it in a `with`, or `close` it.

    gear: over the face its transverse section. sector: that its compliance was computed on, in modules.
    """

    def __init__(self, gear: Gear, material: Material, sector: Sector):
        self.gear = gear
        self.material = material
        self.sector = sector
        self.stress = NodalStress(sector.section, material.poissons_ratio, sector.sweep)
        self._half = len(sector.link) // 2
        turn = rotation(gear.angular_pitch, sector.components)
        self._pitch = kron(identity(self._half // sector.components), turn, format="csr")
        # The upper cut's dofs in the frame of the next sector.
        link = sector.link.copy()
        turn_last(link, self._half, turn)
        self._link = 0.5 * (link + link.T)
        self._same, self._ahead = cyclic(self._link)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *failure) -> None:
        self.close()

    def close(self) -> None:
        """Give the factor's memory back."""
        self.sector.close()

    @property
    def points(self) -> np.ndarray:
        """Nodes (n, 2), mm, of the section in its tooth's frame."""
        return self.gear.module * self.sector.section.points

    @property
    def heights(self) -> np.ndarray:
        """Heights (h,), mm from mid-width; one in the plane."""
        return self.gear.module * self.sector.heights

    def loads(self, force: np.ndarray) -> np.ndarray:
        """Loads (dofs,) on a sector from forces (flanks, h, f, components), in any shape of that order, on the nodes of
        its drive flank, or of its drive and coast flank."""
        sector = self.sector
        loads = np.zeros((sector.nodes, sector.components))
        drive = sector.flank_nodes("flank")
        for side, own in zip(("flank", "coast"), force.reshape(-1, len(drive), sector.components)):
            np.add.at(loads, sector.flank_nodes(side), own)
        return loads.ravel()

    def recovered(self, forces: dict[int, np.ndarray], sectors: Iterable[int] | None = None) -> RecoveredSectors:
        """Some sectors, or all, under forces on the flanks of some teeth as in `loads`, in each tooth's own frame: N/mm
        in the plane, N over the face."""
        sector = self.sector
        teeth = self.gear.tooth_count
        wanted = tuple(range(teeth) if sectors is None else sectors)
        loads: dict[int, np.ndarray] = {}
        for tooth, force in forces.items():
            loads[tooth % teeth] = loads.get(tooth % teeth, 0.0) + self.loads(force)
        free = {tooth: sector.free_motion(load[:, None]) for tooth, load in loads.items()}
        motion = self._cut_motion(free)
        rest = np.zeros((sector.components * sector.nodes, 1))
        both = [(motion[tooth % teeth], self._pitch @ motion[(tooth + 1) % teeth]) for tooth in wanted]
        at_cuts = np.hstack([np.vstack(each) for each in both])
        inside = np.hstack([free.get(tooth % teeth, rest) for tooth in wanted])
        inside += sector.free_motion(sector.pulled(sector.link @ (at_cuts - sector.at_cuts(inside))))
        unit = inside.T.reshape(len(wanted), len(sector.heights), -1, sector.components)
        # Of a plane sector a force per length acts, of one in three dimensions a force: lengths are in modules there.
        length = self.gear.module ** (sector.components - 2)
        stress = np.array([self.stress.at_nodes(each) for each in unit]) / (length * self.gear.module)
        self._average_at_cuts(wanted, stress)
        return RecoveredSectors(wanted, unit / (self.material.youngs_modulus * length), stress)

    def between_teeth(self, responding: np.ndarray, loaded: np.ndarray, reach: int) -> np.ndarray:
        """Reciprocal work (2 reach + 1, k, j) that the ring adds to that within a sector with free cuts, Young's
        modulus 1 MPa, lengths in modules. It is of loads on the tooth m pitches ahead, m from -reach to reach, and of
        loads on the loaded tooth. Both are given by the motions of the free cuts, (2 d, k) and (2 d, j)."""
        responding, loaded = (
            np.vstack([each[: self._half], self._pitch.T @ each[self._half :]]) for each in (responding, loaded)
        )
        held = self._link @ responding
        forces = self._link @ loaded
        # Many loads move the cuts in few ways.
        shapes, of_held = spanned(held.T)
        others, of_forces = spanned(forces.T)
        work = self._ring_work(of_held.T, of_forces.T, reach)
        between = shapes @ work @ others.T
        between[reach] -= held.T @ loaded
        return between

    def _ring_work(self, responding: np.ndarray, loaded: np.ndarray, reach: int) -> np.ndarray:
        """`ring.ring_work` of forces on the cuts, over the face by those motions of the cuts that they cause."""
        link = self._link
        if self.sector.sweep is not None:
            motions = cut_motions(link, np.hstack([responding, loaded]), self.gear.tooth_count)
            link = over_motions(link, motions)
            responding = loads_over_motions(responding, motions)
            loaded = loads_over_motions(loaded, motions)
        return ring_work(link, self.gear.tooth_count, reach, responding, loaded)

    def _cut_motion(self, free: dict[int, np.ndarray]) -> np.ndarray:
        """Motion (teeth, d, 1) of the sectors' lower cuts; `free`: that of the loaded sectors with free cuts."""
        on_cuts = np.zeros((self.gear.tooth_count, self._half, 1))
        for tooth, moved in free.items():
            reaching = self.sector.link @ self.sector.at_cuts(moved)
            on_cuts[tooth] += reaching[: self._half]
            on_cuts[(tooth + 1) % self.gear.tooth_count] += self._pitch.T @ reaching[self._half :]
        return cyclic_motion(self._same, self._ahead, on_cuts)

    def _average_at_cuts(self, sectors: Sequence[int], stress: np.ndarray) -> None:
        """Average, in place, what two neighbouring sectors have at their common cut, by the areas of its elements."""
        turn = rotation(self.gear.angular_pitch, 3)
        lower, upper = self.sector.cuts
        area = self.stress.weight
        flat = stress.reshape(len(stress), -1, 3, 3)
        below, above = (area[cut % len(area)] for cut in (upper, lower))
        share = (below / (below + above))[:, None, None]
        place = {sector % self.gear.tooth_count: number for number, sector in enumerate(sectors)}
        for sector, number in place.items():
            ahead = place.get((sector + 1) % self.gear.tooth_count)
            if ahead is not None:
                mean = share * flat[number, upper] + (1.0 - share) * (turn @ flat[ahead, lower] @ turn.T)
                flat[number, upper] = mean
                flat[ahead, lower] = turn.T @ mean @ turn


def gear_recovery(
    gear: Gear, material: Material, discretisation: Discretisation | FaceDiscretisation, coast_flank: bool = False
) -> GearRecovery:
    """A gear's recovery on the very mesh that `flank_compliance` or `face_compliance` has with the same settings."""
    if isinstance(discretisation, FaceDiscretisation):
        scaled = discretisation.in_modules_of(gear)
        sector = swept_sector(swept_section(gear.of_module_one, scaled.sizes), scaled.sweep, material.poissons_ratio)
    else:
        element = element_named(discretisation.element)
        sizes = discretisation.sizes(gear, both_flanks=coast_flank).in_modules_of(gear)
        mesh = sector_mesh(gear.of_module_one, sizes, element.quadrilateral)
        sector = plane_sector(mesh, element, material.poissons_ratio)
    return GearRecovery(gear, material, sector)
