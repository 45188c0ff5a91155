"""Root stress in the result: stress along the surface of both fillets of each loaded tooth, over time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fenics_gears.contact.flank_forces import SENSE_OF_TEETH, flank_rows, sector_of, unmirrored
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.operator import node_slices
from fenics_gears.contact.tooth_pair import COAST, ToothPair
from fenics_gears.dynamics.steps import Record
from fenics_gears.elasticity.root_stress import RootStressRows
from fenics_gears.errors import ComputationError
from fenics_gears.geometry.pair import GearPair
from fenics_gears.results.side_by_side import SideBySide

Rows = tuple[RootStressRows, RootStressRows]
SIDES = ("drive", "coast")


class RootStress:
    """Root stress at the steps of a cycle: for each position a matrix from contact forces to stresses, built when first
    asked for."""

    def __init__(self, pair: GearPair, cycle: Cycle, rows: Rows):
        self.pair, self.cycle, self.rows = pair, cycle, rows
        self._matrices: dict[float, tuple[list[int], np.ndarray]] = {}

    def at(self, record: Record) -> tuple[list[int], np.ndarray]:
        """Indices of the tooth pairs in reach, and their stress (gears, pairs, points), MPa, at a step."""
        phase = record.step % self.cycle.steps
        if phase not in self._matrices:
            tangential = len(record.solution.forces) > record.position.operator.nodes
            self._matrices[phase] = self._matrix(record.position.operator.pairs, tangential)
        teeth, matrix = self._matrices[phase]
        return teeth, matrix @ record.solution.forces

    def _matrix(self, pairs: Sequence[ToothPair], tangential: bool) -> tuple[list[int], np.ndarray]:
        """Indices of the pairs, and stress (gears, pairs, points, forces) per contact force, N; forces as the operator
        has them."""
        teeth = sorted({pair.place.index for pair in pairs}, reverse=True)
        count = sum(len(pair.offsets) for pair in pairs)
        points = self.rows[0].rows.shape[1]
        matrix = np.zeros((2, len(teeth), points, (2 if tangential else 1) * count))
        for gear, data in enumerate((self.pair.pinion, self.pair.wheel)):
            for nodes, pair in zip(node_slices(pairs), pairs):
                line = flank_rows(gear, pair, tangential) / self.pair.face_width
                line = unmirrored(data, line) if pair.place.flank == COAST else line
                columns = np.r_[nodes, count + nodes.start : count + nodes.stop] if tangential else np.r_[nodes]
                for place, index in enumerate(teeth):
                    known, first = (
                        self._known(gear, SENSE_OF_TEETH[gear] * index - sector_of(gear, pair)),
                        pair.place.flank * len(line),
                    )
                    matrix[gear, place][:, columns] += known[:, first : first + len(line)] @ line
        return teeth, matrix

    def _known(self, gear: int, ahead: int) -> np.ndarray:
        rows = self.rows[gear]
        if abs(ahead) > rows.reach:
            raise ComputationError(
                f"root stress: the stress of a tooth {ahead} pitches from the loaded one was not computed, known are"
                f" {rows.reach}"
            )
        return rows.rows[rows.reach + ahead]

    def values(self, nodes: SideBySide) -> dict[str, np.ndarray]:
        """Root stress at consecutive steps; not a number where a slot's pair is out of reach."""
        points = self.rows[0].rows.shape[1] // 2
        values = np.full((len(nodes.steps), 2, nodes.slots, 2, points), np.nan)
        for i, record in enumerate(nodes.steps.records):
            teeth, stresses = self.at(record)
            for place, index in enumerate(teeth):
                values[i, :, nodes.slot_of(i, index)] = stresses[:, place].reshape(2, 2, points)
        along = values[..., :-1].reshape(*values.shape[:3], -1)
        return {
            "root_stress": along,
            "root_stress_maximum": np.fmax.reduce(along, axis=-1),
            "root_stress_at_30_degrees": values[..., -1],
        }

    def labels(self) -> tuple[dict[str, str], dict[str, tuple]]:
        """Long names of the variables, and the coordinates of their fillet points."""
        angles = np.array([rows.tangent_angle[:-1] for rows in self.rows])
        words = {
            "root_stress": "stress along the surface of the fillets",
            "root_stress_maximum": "largest tension in the fillets",
            "root_stress_at_30_degrees": (
                "stress where the fillet's tangent stands at 30 degrees to the tooth's centreline"
            ),
        }
        return words, {
            "fillet": ("fillet", list(SIDES), {"long_name": "side of the tooth"}),
            "fillet_side": ("fillet_point", np.repeat(SIDES, angles.shape[1]), {"long_name": "side of the tooth that "
                "the fillet point is on"}),
            "fillet_tangent_angle": (
                ("gear", "fillet_point"), np.hstack([angles, angles]),
                {"units": "rad", "long_name": "angle between the fillet's tangent and the tooth's centreline"},
            ),
        }  # fmt: skip
