"""Both gears of a run over the face at a stored time: place, displacement and stress of the teeth in mesh, in three
dimensions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fenics_gears.contact.face_forces import face_forces
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.face.recovery import FaceRecovery
from fenics_gears.elasticity.ring import rotation
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.outline import tooth_outline
from fenics_gears.geometry.pair import GearPair
from fenics_gears.model.face_resolution import face_discretisation
from fenics_gears.simulation.elastic_route import gear_compliances
from fenics_gears.simulation.face_route import face_cycle, gear_bodies
from fenics_gears.simulation.run_stresses import RunStresses, outer_sides, standing
from fenics_gears.simulation.stored_forces import StoredForces, stored_forces
from fenics_gears.system.progress import SilentProgress

# Sectors on either side of the loaded teeth that are recovered.
BESIDE = 2
# Modules; nodes on a circle are as near to it.
ON_CIRCLE = 1e-6


@dataclass(frozen=True)
class TeethInSpace:
    """Sectors of one gear at a stored time in the frame of the line of action, z along the axes from the middle of the
    common face.

    sectors: numbers of those recovered. Nodes by sector, height and the section's node: points (s, h, n, 3), mm,
        without load; displacement of the same
    shape, mm, from where the hub is held; stress (s, h, n, 3, 3), MPa. others: points (t, h, n, 3) of all other
    sectors. cells: (m, 6), of the section, triangles of second order; subcells, outline: (j, 3) triangles and (k, 2)
    sides of the section's boundary, of first order, without those on
    the cuts. in_root, on_flank: (n,), whether a node lies in a fillet or below, and whether it is on the involute that
    carries.
    """

    sectors: tuple[int, ...]
    points: np.ndarray
    displacement: np.ndarray
    stress: np.ndarray
    others: np.ndarray
    cells: np.ndarray
    subcells: np.ndarray
    outline: np.ndarray
    in_root: np.ndarray
    on_flank: np.ndarray

    @property
    def von_mises(self) -> np.ndarray:
        """Equivalent stress (s, h, n), MPa."""
        deviator = self.stress - np.trace(self.stress, axis1=-2, axis2=-1)[..., None, None] / 3.0 * np.eye(3)
        return np.sqrt(1.5 * (deviator**2).sum(axis=(-1, -2)))

    @property
    def principal(self) -> np.ndarray:
        """Largest principal stress (s, h, n), MPa, tension positive."""
        return np.linalg.eigvalsh(self.stress)[..., -1]


@dataclass(frozen=True)
class GearsInSpace:
    """Pinion and wheel at a stored time; `coast`: whether the coast flanks carry more."""

    time: float
    mesh_phase: float
    gears: tuple[TeethInSpace, TeethInSpace]
    pair: GearPair
    coast: bool


class FaceStresses(RunStresses):
    """Displacement and stress of the teeth in mesh at any step of a result over the face whose contact fields are
    stored. Use it as `RunStresses`."""

    def _cycle(self, cache: Cache) -> Cycle:
        sections, bodies = (of(self.model, SilentProgress(), cache) for of in (gear_compliances, gear_bodies))
        return face_cycle(self.model, sections, bodies)

    def _recovery(self, gear: int) -> FaceRecovery:
        pair, scene = self.model.pair, self.model.scene
        return FaceRecovery(
            (pair.pinion, pair.wheel)[gear],
            scene.gears.materials[gear],
            face_discretisation(self.model, gear),
            scene.coast_flanks is not None,
        )

    def at(self, index: int) -> GearsInSpace:
        """Both gears at a stored step. Raises SceneError where they stand further than a pitch from their places."""
        self._check_place(index)
        stored = stored_forces(self.result, self.model, self.cycle, index)
        phase, time = (float(self.result[name].values[index]) for name in ("mesh_phase", "time"))
        return GearsInSpace(
            time, phase, (self._gear(0, stored), self._gear(1, stored)), self.model.pair, stored.on_coast_flanks
        )

    def _gear(self, gear: int, stored: StoredForces) -> TeethInSpace:
        recovery, face = self.recoveries[gear], self.model.face
        data = (self.model.pair.pinion, self.model.pair.wheel)[gear]
        forces = face_forces(gear, data, face, recovery.heights, stored.pairs, stored.forces)
        loaded = [*forces] or [0]
        sectors = tuple(range(min(loaded) - BESIDE, max(loaded) + BESIDE + 1))[: data.teeth]
        found = recovery.recovered(forces, sectors)
        centre, angles = standing(self.model.pair, gear, stored.phase)
        z = recovery.heights + face.middles[gear]
        # How a section's frame stands at each height, by sector (teeth, h, 3, 3).
        turns = np.stack(
            [
                [rotation(angle + (1.0, -1.0)[gear] * face.slope / data.base_radius * height, 3) for height in z]
                for angle in angles
            ]
        )
        section = np.column_stack([recovery.points, np.zeros(len(recovery.points))])
        places = (
            np.einsum("thij,nj->thni", turns, section)
            + np.append(centre, 0.0)
            + z[:, None, None] * np.array([0.0, 0.0, 1.0])
        )
        own = np.array(sectors) % data.teeth
        radius = np.linalg.norm(recovery.points, axis=1)
        outline = outer_sides(recovery.body.section, recovery.body.mesh)
        return TeethInSpace(
            sectors=sectors,
            points=places[own],
            displacement=np.einsum("shij,shnj->shni", turns[own], found.displacement),
            stress=np.einsum("shia,shnab,shjb->shnij", turns[own], found.stress, turns[own], optimize=True),
            others=np.delete(places, own, axis=0),
            cells=recovery.body.section.cells,
            subcells=recovery.body.section.subcells,
            outline=outline,
            on_flank=_on_flank(data, recovery.points, outline, stored.on_coast_flanks),
            in_root=(radius < data.form_radius) & (radius > 0.5 * (data.bore_radius + data.root_radius)),
        )


def _on_flank(gear: Gear, points: np.ndarray, outline: np.ndarray, coast: bool) -> np.ndarray:
    """Which nodes (n,) of a section at points (n, 2) lie on the involute of its drive flank, or of its coast flank."""
    tooth = tooth_outline(gear)
    middle = tooth.involute(np.array([0.5 * (gear.form_roll_angle + gear.tip_roll_angle)]))[0]

    def ahead(places: np.ndarray) -> np.ndarray:
        return np.sin(np.arctan2(places[..., 1], places[..., 0]) - tooth.centreline_angle)

    radius, outer = np.linalg.norm(points, axis=1), np.zeros(len(points), dtype=bool)
    outer[np.unique(outline)] = True
    own_side = ahead(points) * ahead(middle) * (-1.0 if coast else 1.0) > 0.0
    # The form circle and the tip's edge belong to it.
    return (
        outer
        & own_side
        & (radius > gear.form_radius - ON_CIRCLE * gear.module)
        & (radius < gear.tip_form_radius + ON_CIRCLE * gear.module)
    )
