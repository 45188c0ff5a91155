"""Root stress in the result: stress along the surface of both fillets of each loaded tooth, over time, slice by slice
over a face."""

from collections import defaultdict
from collections.abc import Sequence

import numpy as np
from scipy import sparse

from fenics_gears.contact.flank_forces import rows_in_slice
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.operator import Position
from fenics_gears.contact.tooth_pair import ToothPair, count_of, node_slices
from fenics_gears.elasticity.root_stress import RootStressRows
from fenics_gears.errors import ComputationError
from fenics_gears.geometry.pair import GearPair
from fenics_gears.geometry.side import Side

from .side_by_side import SideBySide

Rows = tuple[RootStressRows, RootStressRows]
SIDES = ("drive", "coast")
# Largest tensions are of points whose tangent's angle is at least so much of that at 30 degrees in the normal section.
# The points beyond are near the involute, where the stress may be that of the contact, which is not resolved.
OF_BENDING = 0.5


# Of a gear: the teeth loaded at a position, numbered as in a Place, and the forces on the nodes of their flanks per
# contact force (teeth f, n or 2 n). A contact node loads a few of hundreds of flank nodes.
OnFlanks = tuple[list[int], sparse.csc_array]


class RootStress:
    """Root stress at the steps of a cycle: forces on the flanks, from the contact forces, times the stress per force on
    a flank."""

    def __init__(self, pair: GearPair, cycle: Cycle, rows: Rows):
        self.pair = pair
        self.cycle = cycle
        self.rows = rows
        angles, at_section = np.split(np.array([each.tangent_angle for each in rows]), [-1], axis=1)
        self._angles = np.tile(angles, 2)
        self._of_bending = self._angles >= OF_BENDING * at_section
        self._on_flanks: dict[tuple, tuple[np.ndarray, tuple[OnFlanks, OnFlanks]]] = {}

    def on_flanks(self, position: Position) -> tuple[np.ndarray, tuple[OnFlanks, OnFlanks]]:
        """Indices (t,) of the tooth pairs in reach, and what contact forces are on both gears' flanks."""
        key = position.nodes, position.index
        if key not in self._on_flanks:
            pairs = position.operator.pairs
            tangential = position.operator.rigid_slip is not None
            teeth = np.array(sorted({pair.place.index for pair in pairs}, reverse=True), dtype=int)
            self._on_flanks[key] = teeth, tuple(self._of_gear(side, pairs, tangential) for side in self.pair.sides)
        return self._on_flanks[key]

    def _of_gear(self, side: Side, pairs: Sequence[ToothPair], tangential: bool) -> OnFlanks:
        teeth = [pair.place.teeth[side.number] for pair in pairs]
        sectors = sorted(set(teeth))
        count = count_of(pairs)
        rows = self.rows[side.number].rows
        _, slices, *_, dofs = rows.shape
        blocks = []
        for nodes, pair, tooth in zip(node_slices(pairs), pairs, teeth):
            forces = rows_in_slice(side, self.cycle.face, pair, tangential)
            columns = np.r_[nodes, count + nodes.start : count + nodes.stop] if tangential else np.r_[nodes]
            in_slice = forces.shape[0] * (slices * pair.place.flank + pair.place.slice)
            first = dofs * sectors.index(tooth) + in_slice
            blocks.append((forces.data, columns[forces.col], first + forces.row))
        values, from_contact, on_flanks = (np.concatenate(each) for each in zip(*blocks))
        shape = len(sectors) * dofs, (2 if tangential else 1) * count
        return sectors, sparse.csc_array((values, (on_flanks, from_contact)), shape)

    def _known(self, gear: int, ahead: int) -> np.ndarray:
        rows = self.rows[gear]
        if abs(ahead) > rows.reach:
            raise ComputationError(f"root stress {ahead} pitches from the loaded tooth: known are {rows.reach}")
        return rows.rows[rows.reach + ahead]

    def values(self, nodes: SideBySide) -> dict[str, np.ndarray]:
        """Root stress at consecutive steps; not a number where a slot's pair is out of reach."""
        slices, points = self.rows[0].rows.shape[1:3]
        values = np.full((len(nodes.steps), 2, nodes.slots, slices, points), np.nan)
        # Not a number at points that a fillet does not have.
        at_rest = np.stack([0.0 * rows.rows[rows.reach, ..., 0] for rows in self.rows])
        # Steps at one position together, then all by gear and distance of the tooth from the loaded one.
        alike: dict[tuple, list[int]] = defaultdict(list)
        for i, position in enumerate(nodes.steps.positions):
            alike[position.nodes, position.index].append(i)
        asked: dict[tuple[int, int], list[tuple[np.ndarray, np.ndarray, np.ndarray]]] = defaultdict(list)
        starts = nodes.steps.kinds * nodes.steps.starts
        all_forces = nodes.steps.forces
        for steps in map(np.array, alike.values()):
            teeth, gears = self.on_flanks(nodes.steps.positions[steps[0]])
            slots = nodes.slot_of(steps[:, None], teeth)
            values[steps[:, None], :, slots] = at_rest
            contact = all_forces[starts[steps] + np.arange(starts[steps[0] + 1] - starts[steps[0]])[:, None]]
            for side, (sectors, per_force) in zip(self.pair.sides, gears):
                on_teeth = (per_force @ contact).reshape(len(sectors), -1, len(steps))
                for sector, loaded, own in zip(sectors, on_teeth.any(axis=1), on_teeth):
                    some = loaded.nonzero()[0]
                    if len(some):
                        own = own[:, some].T
                        these = steps[some]
                        places = slots[some]
                        for index, slot in zip(teeth.tolist(), places.T):
                            asked[side.number, side.sense * index - sector].append((these, slot, own))
        for (gear, ahead), loads in asked.items():
            steps, slots, forces = (np.concatenate(each) for each in zip(*loads))
            stress = forces @ self._known(gear, ahead).reshape(slices * points, -1).T
            # At a step a tooth is so far ahead of one loaded tooth only: no place is there twice.
            values[steps, gear, slots] += stress.reshape(-1, slices, points)
        return self._variables(values.reshape(*values.shape[:4], 2, points // 2))

    def _variables(self, values: np.ndarray) -> dict[str, np.ndarray]:
        along = np.moveaxis(values[..., :-1], 3, -1)
        along = along.reshape(*along.shape[:3], -1, along.shape[-1])
        section = values[..., -1].swapaxes(-1, -2)
        return {
            "root_stress": along,
            "root_stress_over_face": section,
            "root_stress_maximum": np.fmax.reduce(
                along, axis=(-1, -2), where=self._of_bending[:, None, :, None], initial=np.nan
            ),
            "root_stress_at_30_degrees": np.fmax.reduce(section, axis=-1),
        }

    def labels(self) -> tuple[dict[str, str], dict[str, tuple]]:
        """Long names of the variables, and the coordinates of their fillet points."""
        words = {
            "root_stress": "stress along the surface of the fillets",
            "root_stress_maximum": "largest tension in the fillets, tangent over 15 degrees off the centreline",
            "root_stress_at_30_degrees": "stress where the fillet's tangent is at 30 degrees to the tooth's centreline",
        }
        return words, {
            "fillet": ("fillet", list(SIDES), {"long_name": "side of the tooth"}),
            "fillet_side": ("fillet_point", np.repeat(SIDES, self._angles.shape[1] // 2),
                {"long_name": "side of the tooth that the fillet point is on"}),
            "fillet_tangent_angle": (
                ("gear", "fillet_point"), self._angles,
                {"units": "rad", "long_name": "angle between the fillet's tangent and the tooth's centreline"},
            ),
        }  # fmt: skip
