"""Both gears of a run at a stored time: place, displacement and stress of every node."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
import xarray as xr

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.tooth_pair import coast_place, drive_place
from fenics_gears.effects import effects_on
from fenics_gears.elasticity.cache import Cache, user_cache
from fenics_gears.elasticity.recovery import GearRecovery, gear_recovery, turned_stress
from fenics_gears.elasticity.ring import rotation
from fenics_gears.errors import SceneError
from fenics_gears.geometry.pair import GearPair
from fenics_gears.model.model import Model, model_of
from fenics_gears.model.resolution import ONCE
from fenics_gears.results.pairs import contact_times
from fenics_gears.scene.data import Scene
from fenics_gears.simulation.elastic_route import gear_compliances, mesh_cycle
from fenics_gears.simulation.stored_forces import StoredForces, stored_forces
from fenics_gears.system.progress import SilentProgress


@dataclass(frozen=True)
class GearInSpace:
    """One gear at a stored time, in the frame of the line of action: x along it from T1, the pinion's centre at the
    origin.

    points: (n, 2), mm, where the nodes are without load. cells: (m, 3) or (m, 4) of first order. outline: (k, 2) sides
        of the
    boundary. elastic, displacement: (n, 2), mm, from where the hub is held, and from the nominal motion. stress: (n,
    4), MPa: xx, yy, xy and zz of plane strain.
    """

    points: np.ndarray
    cells: np.ndarray
    outline: np.ndarray
    centre: np.ndarray
    elastic: np.ndarray
    displacement: np.ndarray
    stress: np.ndarray

    @property
    def von_mises(self) -> np.ndarray:
        """Equivalent stress (n,), MPa."""
        xx, yy, xy, zz = self.stress.T
        return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * xy**2)


@dataclass(frozen=True)
class GearsInMesh:
    """Pinion and wheel at a stored time; `coast`: whether the coast flanks carry more than the drive flanks.

    `approach`: mm along their line of action that the hubs' motion brings the flanks together that carry more; coast
        flanks stand apart by
    the backlash before it.
    """

    time: float
    mesh_phase: float
    gears: tuple[GearInSpace, GearInSpace]
    pair: GearPair
    approach: float
    coast: bool


class RunStresses:
    """Displacement and stress of both gears at any step of a result whose contact fields are stored. Use it in a
    `with`, or `close` it.

    scene: the one that was run. Raises SceneError where the run has no elastic teeth, or met its contact by remeshing.
    """

    def __init__(self, result: xr.Dataset, scene: Scene, cache: Cache | None = None):
        self.model = model_of(scene)
        self._check()
        self.result = contact_times(result)
        self.cycle = self._cycle(cache if cache is not None else user_cache())
        self.recoveries = tuple(self._recovery(gear) for gear in (0, 1))

    def _cycle(self, cache: Cache) -> Cycle:
        return mesh_cycle(self.model, gear_compliances(self.model, SilentProgress(), cache))

    def _recovery(self, gear: int):
        return recovery_of(self.model, gear)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *failure) -> None:
        self.close()

    def close(self) -> None:
        """Give the factors' memory back."""
        for recovery in self.recoveries:
            recovery.close()

    def at(self, index: int) -> GearsInMesh:
        """Both gears at a stored step. Raises SceneError where they stand further than a pitch from their places."""
        self._check_place(index)
        stored = stored_forces(self.result, self.model, self.cycle, index)
        motion = hub_motion(self.result, index)
        pair, coast = self.model.pair, stored.on_coast_flanks
        place = coast_place(pair, 0, pair.pitch_point) if coast else drive_place(pair, 0, pair.pitch_point)
        arcs = pair.pinion.base_radius * motion[0, 2] + pair.wheel.base_radius * motion[1, 2]
        approach = float((motion[0, :2] - motion[1, :2]) @ place.axes[0] + place.turn * arcs)
        gears = tuple(self._gear(gear, stored, motion[gear]) for gear in (0, 1))
        phase, time = (float(self.result[name].values[index]) for name in ("mesh_phase", "time"))
        return GearsInMesh(time, phase, gears, pair, approach, coast)

    def _check_place(self, index: int) -> None:
        error, pitch = abs(float(self.result["transmission_error"].values[index])), self.model.pair.wheel.angular_pitch
        if error > pitch:
            raise SceneError(
                f"the transmission error at mesh phase {float(self.result['mesh_phase'].values[index]):.3f} is"
                f" {error:.3g} rad, more than the pitch of the wheel's teeth ({pitch:.3g} rad): gears that have gone"
                " through each other are not drawn; the run's warnings say why"
            )

    def _gear(self, gear: int, stored: StoredForces, motion: np.ndarray) -> GearInSpace:
        recovery = self.recoveries[gear]
        body = recovery.recovered(stored.on_flanks(self.model, gear))
        centre, angles = standing(self.model.pair, gear, stored.phase)
        turns = [rotation(angle) for angle in angles]
        local = recovery.points
        about_centre = np.vstack([local @ turn.T for turn in turns])
        elastic = np.vstack([moved @ turn.T for moved, turn in zip(body.displacement, turns)])
        stress = np.vstack([turned_stress(sector, angle) for sector, angle in zip(body.stress, angles)])
        across = self.model.scene.gears.materials[gear].poissons_ratio * (stress[:, 0] + stress[:, 1])
        rigid = motion[:2] + motion[2] * np.column_stack([-about_centre[:, 1], about_centre[:, 0]])
        cells, outline = whole_cells(recovery)
        return GearInSpace(
            centre + about_centre, cells, outline, centre, elastic, elastic + rigid, np.column_stack([stress, across])
        )

    def _check(self) -> None:
        if self.model.scene.tooth_elasticity is None:
            raise SceneError(
                "the run's flanks are rigid: there are no stresses. Add the section [gears.material] to the scene and"
                " run it again."
            )
        if not self.model.scene.resolves_contact:
            raise SceneError(
                f'the run has a mesh of springs (accuracy.model = "{self.model.scene.accuracy.model}"): there are no'
                ' stresses. Run the scene with "elastic".'
            )
        if any(effect.elasticity is not None for effect in effects_on(self.model.scene)):
            raise SceneError(
                "stresses are recovered from gears of equal sectors; this run has gears meshed as a whole"
                " ([body_meshes])."
            )
        if self.model.resolution.condensation != ONCE:
            raise SceneError(
                'stresses are recovered from runs with [accuracy] condensation = "once"; this one has "every step". Run'
                ' the scene with "once".'
            )


def recovery_of(model: Model, gear: int) -> GearRecovery:
    """The recovery of a gear of a model, on the mesh of its compliance."""
    return gear_recovery(
        (model.pair.pinion, model.pair.wheel)[gear],
        model.scene.gears.materials[gear],
        model.resolution.discretisation(gear),
        coast_flank=model.scene.coast_flanks is not None,
    )


def standing(pair: GearPair, gear: int, phase: float) -> tuple[np.ndarray, np.ndarray]:
    """Centre (2,), mm, and angles (teeth,), rad, of a gear's sectors in the frame of the line of action, at a phase of
    the mesh cycle.

    Sector 0 has the tooth of pair 0, which reached the start of contact last.
    """
    contact = pair.path_start + phase * pair.base_pitch
    if gear == 0:
        return np.zeros(2), contact / pair.pinion.base_radius + pair.pinion.angular_pitch * np.arange(pair.pinion.teeth)
    radii = pair.pinion.base_radius + pair.wheel.base_radius
    first = np.pi + (pair.line_of_action_length - contact) / pair.wheel.base_radius
    return np.array([pair.line_of_action_length, -radii]), first + pair.wheel.angular_pitch * np.arange(
        pair.wheel.teeth
    )


def hub_motion(result: xr.Dataset, index: int) -> np.ndarray:
    """Motion (2, 3) of both hubs from their nominal one: mm along and off the line of action, rad."""
    motion = np.zeros((2, 3))
    for place, name in enumerate(("centre_x", "centre_y", "rotation")):
        if name in result:
            motion[:, place] = result[name].values[index]
    return motion


def whole_cells(recovery: GearRecovery) -> tuple[np.ndarray, np.ndarray]:
    """First-order cells of all sectors, one sector's nodes after the other's, and sides (k, 2) of the gear's own
    boundary."""
    nodes = recovery.interior.nodes
    outline, count = outer_sides(nodes, recovery.interior.mesh), len(nodes.points)
    first = count * np.arange(recovery.gear.teeth)[:, None, None]
    return tuple((part[None] + first).reshape(-1, part.shape[1]) for part in (nodes.subcells, outline))


def outer_sides(nodes, mesh) -> np.ndarray:
    """Sides (k, 2) of first order of a sector's boundary, without those on its cuts."""
    sides, count = nodes.boundary_sides, len(nodes.points)
    cuts = np.sort(np.vstack([mesh.edges["lower cut"], mesh.edges["upper cut"]]), axis=1)
    ends = np.sort(sides[:, :2], axis=1)
    sides = sides[~np.isin(ends @ [count, 1], cuts @ [count, 1])]
    return np.vstack([sides[:, [0, 2]], sides[:, [2, 1]]]) if sides.shape[1] == 3 else sides
