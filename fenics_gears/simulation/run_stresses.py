"""Both gears of a run at a stored time: place, displacement and stress of nodes, in the plane or over the face."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
import xarray as xr

from fenics_gears.contact.tooth_pair import coast_place, drive_place
from fenics_gears.effects import effects_on
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.elasticity.element_nodes import ElementNodes
from fenics_gears.elasticity.recovery import GearRecovery, gear_recovery
from fenics_gears.elasticity.sector import Sector
from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.in_mesh import standing
from fenics_gears.geometry.outline import rotation, tooth_outline
from fenics_gears.geometry.pair import GearPair
from fenics_gears.model.model import Model, model_of
from fenics_gears.model.resolution import ONCE
from fenics_gears.results.pairs import contact_times
from fenics_gears.scene.data import Scene
from fenics_gears.system.progress import SilentProgress

from .bodies import discretisation_of
from .routes import prepared
from .stored_forces import StoredForces, stored_forces

# Over the face, sectors on either side of the loaded teeth that are recovered; in the plane all are.
ON_EITHER_SIDE = 2
# Modules; nodes on a circle are as near to it.
ON_CIRCLE = 1e-6


@dataclass(frozen=True)
class GearInSpace:
    """Sectors of one gear at a stored time in the frame of the line of action: x along it from T1, the pinion's centre
    at the origin, z along the axes from the middle of the common face.

    sectors: numbers of those recovered. Nodes by sector, height (one in the plane) and the section's node; in_web:
    (layers,), whether a layer over the face has the whole section; rim_and_hub: what the others have, and the sides of
    its boundary. points (s, h, n, 3), mm, without load. elastic: of the same shape, mm, displacement from
    where the hub is held. stress (s, h, n, 3, 3), MPa. others: points (t, h, n, 3) of all other sectors. centre: (2,),
    mm. motion: of the hub from its nominal one, mm, mm, rad. section: nodes and cells of a sector's section; outline:
    (k, 2) sides of its boundary, of first order, without those on the cuts. in_root, on_flank: (n,), whether a node
    lies in a fillet or below, and whether it is on the involute that carries.
    """

    sectors: tuple[int, ...]
    points: np.ndarray
    elastic: np.ndarray
    stress: np.ndarray
    others: np.ndarray
    centre: np.ndarray
    motion: np.ndarray
    section: ElementNodes
    outline: np.ndarray
    in_root: np.ndarray
    on_flank: np.ndarray
    in_web: np.ndarray
    rim_and_hub: tuple[ElementNodes, np.ndarray] | None = None

    def of_layer(self, layer: int) -> tuple[ElementNodes, np.ndarray]:
        return (self.section, self.outline) if self.in_web[layer] else self.rim_and_hub

    @property
    def von_mises(self) -> np.ndarray:
        """Equivalent stress (s, h, n), MPa."""
        deviator = self.stress - np.trace(self.stress, axis1=-2, axis2=-1)[..., None, None] / 3.0 * np.eye(3)
        return np.sqrt(1.5 * (deviator**2).sum(axis=(-1, -2)))

    @property
    def principal(self) -> np.ndarray:
        """Largest principal stress (s, h, n), MPa, tension positive."""
        return np.linalg.eigvalsh(self.stress)[..., -1]

    @property
    def displacement(self) -> np.ndarray:
        """Displacement (s, h, n, 3), mm, from the nominal motion of a gear that does not tilt."""
        x, y = np.moveaxis(self.points[..., :2] - self.centre, -1, 0)
        rigid = [self.motion[0] - self.motion[2] * y, self.motion[1] + self.motion[2] * x, np.zeros_like(x)]
        return self.elastic + np.stack(rigid, axis=-1)

    def of_sectors(self, parts: np.ndarray) -> np.ndarray:
        """Cells or sides (k, j) of the section's nodes for all sectors of a plane gear, one's nodes after the
        other's."""
        first = len(self.section.points) * np.arange(len(self.sectors))[:, None, None]
        return (parts[None] + first).reshape(-1, parts.shape[1])


@dataclass(frozen=True)
class GearsInMesh:
    """Pinion and wheel at a stored time. `coast`: whether the coast flanks carry more than the drive flanks.
    `approach`: mm along their line of action that the hubs' motion brings the flanks together that carry more (coast
    flanks stand apart by the backlash before it)."""

    time: float
    mesh_phase: float
    gears: tuple[GearInSpace, GearInSpace]
    pair: GearPair
    approach: float
    coast: bool

    @property
    def over_face(self) -> bool:
        """Whether the gears are recovered over the face, at more than one height."""
        return self.gears[0].points.shape[1] > 1


class RunStresses:
    """Displacement and stress of both gears at any step of a result whose contact fields are stored. In the plane they
    are of whole gears, over the face of the teeth in mesh. Use it in a `with`, or `close` it.

    scene: the one that was run. Raises SceneError where the run has no elastic teeth, or met its contact by remeshing.
    """

    def __init__(self, result: xr.Dataset, scene: Scene):
        self.model = model_of(scene)
        self._check()
        self.result = contact_times(result)
        _, self.cycle = prepared(self.model, SilentProgress(), user_cache())
        self.recoveries = tuple(recovery_of(self.model, gear) for gear in (0, 1))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *failure) -> None:
        self.close()

    def close(self) -> None:
        for recovery in self.recoveries:
            recovery.close()

    def at(self, index: int) -> GearsInMesh:
        """Both gears at a stored step. Raises SceneError where they stand further than a pitch from their places."""
        self._check_place(index)
        stored = stored_forces(self.result, self.model, self.cycle, index)
        motion = hub_motion(self.result, index)
        pair = self.model.pair
        coast = stored.on_coast_flanks
        place = coast_place(pair, 0, pair.pitch_point) if coast else drive_place(pair, 0, pair.pitch_point)
        arcs = sum(radius * turned for radius, turned in zip(pair.base_radii, motion[:, 2]))
        approach = float((motion[0, :2] - motion[1, :2]) @ place.axes[0] + place.turn * arcs)
        gears = tuple(self._gear(gear, stored, motion[gear]) for gear in (0, 1))
        phase, time = (float(self.result[name].values[index]) for name in ("mesh_phase", "time"))
        return GearsInMesh(time, phase, gears, pair, approach, coast)

    def _check_place(self, index: int) -> None:
        error = abs(float(self.result["transmission_error"].values[index]))
        pitch = abs(self.model.pair.wheel.angular_pitch)
        if error > pitch:
            raise SceneError(
                f"the transmission error at mesh phase {float(self.result['mesh_phase'].values[index]):.3f} is"
                f" {error:.3g} rad, more than the pitch of the wheel's teeth ({pitch:.3g} rad): the gears have gone"
                " through each other; the run's warnings say why"
            )

    def _gear(self, gear: int, stored: StoredForces, motion: np.ndarray) -> GearInSpace:
        recovery = self.recoveries[gear]
        data = self.model.pair.gears[gear]
        forces = self.forces(gear, stored)
        body = recovery.recovered(forces, self._sectors(data, gear, stored))
        centre, turns, places = self._standing(gear, stored.phase)
        own = np.array(body.sectors) % data.tooth_count
        # In the plane nothing moves along z.
        moved = np.pad(body.displacement, [(0, 0)] * 3 + [(0, 3 - body.displacement.shape[-1])])
        section = recovery.sector.section
        radius = data.sign * np.linalg.norm(recovery.points, axis=1)
        outline = outer_sides(section, recovery.sector.mesh)
        in_web, rim_and_hub = layers_of(recovery.sector)
        inner = data.bore_radius if data.web is None else data.web.rim_radius
        return GearInSpace(
            sectors=body.sectors,
            points=places[own],
            elastic=np.einsum("shij,shnj->shni", turns[own], moved),
            stress=np.einsum("shia,shnab,shjb->shnij", turns[own], body.stress, turns[own], optimize=True),
            others=np.delete(places, own, axis=0),
            centre=centre,
            motion=motion,
            section=section,
            outline=outline,
            in_root=(radius < data.form_radius) & (radius > 0.5 * (inner + data.root_radius)),
            on_flank=_on_flank(data, recovery.points, outline, stored.on_coast_flanks),
            in_web=in_web,
            rim_and_hub=rim_and_hub,
        )

    def forces(self, gear: int, stored: StoredForces) -> dict[int, np.ndarray]:
        """Forces on the flanks of a gear, as of `StoredForces.on_flanks`, at the heights of its nodes."""
        return stored.on_flanks(self.model, gear, self.recoveries[gear].heights)

    def _sectors(self, data: Gear, gear: int, stored: StoredForces) -> range:
        if self.model.face.slices == 1:
            return range(data.tooth_count)
        loaded = [pair.place.teeth[gear] for pair, force in zip(stored.pairs, stored.forces) if force.any()] or [0]
        return range(min(loaded) - ON_EITHER_SIDE, max(loaded) + ON_EITHER_SIDE + 1)[: data.tooth_count]

    def _standing(self, gear: int, phase: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """A gear's centre (2,); how a section's frame stands (teeth, h, 3, 3), by sector and height, and its nodes'
        places (teeth, h, n, 3), without load."""
        recovery = self.recoveries[gear]
        face = self.model.face
        pair = self.model.pair
        centre, angles = standing(pair, gear, phase)
        z = recovery.heights + face.middles[gear]
        twist = pair.sides[gear].sense * face.slope / recovery.gear.base_radius
        turns = np.stack([[rotation(angle + twist * height, 3) for height in z] for angle in angles])
        section = np.pad(recovery.points, ((0, 0), (0, 1)))
        along = z[:, None, None] * np.array([0.0, 0.0, 1.0])
        return centre, turns, np.einsum("thij,nj->thni", turns, section) + np.append(centre, 0.0) + along

    def _check(self) -> None:
        scene = self.model.scene
        if scene.tooth_elasticity is None:
            raise SceneError(
                "the run's flanks are rigid: there are no stresses. Run the scene with the section [gears.material]."
            )
        if not scene.resolves_contact:
            raise SceneError(
                f'the run has a mesh of springs (accuracy.model = "{scene.accuracy.model}"): there are no stresses. Run'
                ' the scene with "elastic".'
            )
        if any(effect.elasticity is not None for effect in effects_on(scene)):
            raise SceneError(
                "stresses are those of gears of equal sectors; this run has [body_meshes], [wheel_points] or a ring on"
                " points."
            )
        if self.model.resolution.condensation != ONCE:
            raise SceneError(
                'the run has [accuracy] condensation = "every step": there are no stresses. Run the scene with "once".'
            )


def recovery_of(model: Model, gear: int) -> GearRecovery:
    data = model.pair.gears[gear]
    material = model.scene.gears.materials[gear]
    return gear_recovery(data, material, discretisation_of(model, gear), model.scene.coast_flanks is not None)


def hub_motion(result: xr.Dataset, index: int) -> np.ndarray:
    """Motion (2, 3) of both hubs from their nominal one: mm along and off the line of action, rad."""
    motion = np.zeros((2, 3))
    for place, name in enumerate(("centre_x", "centre_y", "rotation")):
        if name in result:
            motion[:, place] = result[name].values[index]
    return motion


def layers_of(sector: Sector) -> tuple[np.ndarray, tuple[ElementNodes, np.ndarray] | None]:
    """`in_web` and `rim_and_hub` of a `GearInSpace`."""
    sweep = sector.sweep
    section = sector.section
    if sweep is None or sweep.web is None:
        return np.ones(0 if sweep is None else len(sweep.thicknesses), dtype=bool), None
    part = replace(section, cells=section.cells[sweep.web.outside(section.middles)])
    return sweep.in_web, (part, outer_sides(part, sector.mesh))


def outer_sides(nodes, mesh) -> np.ndarray:
    """Sides (k, 2) of first order of a sector's boundary, without those on its cuts."""
    sides = nodes.boundary_sides
    count = len(nodes.points)
    cuts = np.sort(np.vstack([mesh.edges["lower cut"], mesh.edges["upper cut"]]), axis=1)
    ends = np.sort(sides[:, :2], axis=1)
    sides = sides[~np.isin(ends @ [count, 1], cuts @ [count, 1])]
    return np.vstack([sides[:, [0, 2]], sides[:, [2, 1]]]) if sides.shape[1] == 3 else sides


def _on_flank(gear: Gear, points: np.ndarray, outline: np.ndarray, coast: bool) -> np.ndarray:
    """Which nodes (n,) of a section at points (n, 2) lie on the involute of its drive or coast flank."""
    tooth = tooth_outline(gear)
    middle = tooth.involute(np.array([0.5 * (gear.form_roll_angle + gear.tip_roll_angle)]))[0]

    def ahead(places: np.ndarray) -> np.ndarray:
        return np.sin(np.arctan2(places[..., 1], places[..., 0]) - tooth.centreline_angle)

    radius = gear.sign * np.linalg.norm(points, axis=1)
    outer = np.zeros(len(points), dtype=bool)
    outer[np.unique(outline)] = True
    own_side = ahead(points) * ahead(middle) * (-1.0 if coast else 1.0) > 0.0
    # The form circle and the tip's edge belong to it.
    return (
        outer
        & own_side
        & (radius > gear.form_radius - ON_CIRCLE * gear.module)
        & (radius < gear.tip_form_radius + ON_CIRCLE * gear.module)
    )
