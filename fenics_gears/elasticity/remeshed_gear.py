"""A gear meshed anew so that its flanks have nodes at given places, condensed onto those nodes and the centre.

Only the sectors of loaded teeth change from position to position; all others are the same sector, condensed once. The
cuts are congruent, so that the result equals that of meshing the whole gear, to round-off.
"""

from dataclasses import dataclass
from time import perf_counter

import numpy as np
from scipy.linalg import block_diag

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.geometry.involute import canonical_point
from fenics_gears.geometry.outline import rotation

from .cut_chain import closed_ring, eliminated, run_of
from .element_sizes import ElementSizes
from .elements import Element
from .ring import centre_motion, condensed_sector, sector_cuts
from .sector_boundary import flank_through
from .sector_mesh import sector_mesh

NO_NODES = np.empty((0, 2))


@dataclass(frozen=True)
class LoadedTooth:
    """A tooth turned counter-clockwise from its own frame by `angle` (rad), with neighbouring flank vertices at `rolls`
    (k,), rad."""

    angle: float
    rolls: np.ndarray


class RemeshedGear:
    """Stiffness of a gear on the flank nodes of each position; `timings` (s): sums over all positions so far."""

    def __init__(self, gear: Gear, material: Material, element: Element, sizes: ElementSizes):
        self.gear = gear
        self.material = material
        self.element = element
        self.sizes = sizes
        self.timings = {"time_mesh": 0.0, "time_compile": 0.0, "time_condense": 0.0}
        self._unloaded = self._sector(None, NO_NODES)
        self._cut = len(self._unloaded) // 2
        self._runs: dict[int, np.ndarray] = {}

    def stiffness(self, teeth: tuple[LoadedTooth, ...]) -> np.ndarray:
        """Stiffness (2 K + 3, 2 K + 3), N/mm per mm of face width, over all teeth's nodes and the centre (dx, dy, phi).

        teeth: by rising angle, whole pitches apart. A tooth's nodes are in the order of its `rolls`; second-order
        elements have a node between each two. Dofs x, y are interleaved, in the frame in which the angles are counted.
        Raises ComputationError when a stage fails.
        """
        ends = [tooth.angle for tooth in teeth[1:]] + [teeth[0].angle + 2.0 * np.pi]
        between = [round((end - tooth.angle) / self.gear.angular_pitch) - 1 for tooth, end in zip(teeth, ends)]
        sectors = [self._loaded(tooth) for tooth in teeth]
        clock = perf_counter()
        pieces = (part for sector, count in zip(sectors, between) for part in (sector, self._run(count)))
        parts = [part for part in pieces if part is not None]
        ring = closed_ring(parts, self._cut)
        held = eliminated(ring, np.arange(len(parts) * self._cut, len(ring)), np.arange(len(parts) * self._cut))
        points = [self.contact_points(tooth.rolls) @ rotation(tooth.angle).T for tooth in teeth]
        turn = block_diag(*(np.kron(np.eye(len(own)), rotation(tooth.angle)) for own, tooth in zip(points, teeth)))
        # Only motion relative to the hub deforms the gear: with the centre's motion taken off, the hub is held.
        relative = turn.T @ np.hstack([np.eye(len(turn)), -centre_motion(np.vstack(points))])
        result = self.material.youngs_modulus * relative.T @ held @ relative
        self.timings["time_condense"] += perf_counter() - clock
        return result

    def contact_points(self, rolls: np.ndarray) -> np.ndarray:
        """Nodes (k, 2), or (2 k - 1, 2) of a second-order element, mm, in the tooth's own frame, of vertices at `rolls`
        (k,)."""
        vertices = canonical_point(self.gear.base_radius, rolls)
        if self.element.order == 1:
            return vertices
        points = np.empty((2 * len(vertices) - 1, 2))
        points[::2] = vertices
        points[1::2] = 0.5 * (vertices[1:] + vertices[:-1])
        return points

    def _loaded(self, tooth: LoadedTooth) -> np.ndarray:
        rolls = flank_through(self.gear, self.sizes.flank, tooth.rolls)
        # A wanted vertex may have been moved by round-off onto the flank's end.
        wanted = rolls[np.abs(rolls[:, None] - tooth.rolls).argmin(axis=0)]
        return self._sector(rolls, self.contact_points(wanted))

    def _run(self, count: int) -> np.ndarray | None:
        """So many unloaded sectors joined; None for none."""
        if count and count not in self._runs:
            self._runs[count] = run_of(self._unloaded, count)
        return self._runs.get(count)

    def _sector(self, rolls: np.ndarray | None, points: np.ndarray) -> np.ndarray:
        """Stiffness of a sector over its lower cut, its upper cut in the frame of the next sector, and flank nodes at
        points."""
        clock = perf_counter()
        mesh = sector_mesh(self.gear, self.sizes, self.element.quadrilateral, rolls)
        meshed = perf_counter()
        sector = condensed_sector(mesh, self.element, self.material.poissons_ratio, points)
        cuts, turn = sector_cuts(sector, self.gear.teeth)
        dofs = np.concatenate([cuts, sector.dofs("flank")])
        turn = block_diag(turn, np.eye(2 * len(points)))
        result = turn.T @ sector.stiffness[np.ix_(dofs, dofs)] @ turn
        compiling = sector.timings["time_compile"]
        self.timings["time_mesh"] += meshed - clock
        self.timings["time_compile"] += compiling
        self.timings["time_condense"] += perf_counter() - meshed - compiling
        return result
