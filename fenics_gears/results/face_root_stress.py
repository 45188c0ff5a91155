"""Root stress in the result of flanks resolved over the face: stress in both fillets of each loaded tooth, slice by
slice, over time."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

import numpy as np
from scipy import sparse

from fenics_gears.contact.face_forces import slice_rows
from fenics_gears.contact.face_pairing import FacePair
from fenics_gears.contact.flank_forces import SENSE_OF_TEETH, sector_of
from fenics_gears.contact.operator import node_slices
from fenics_gears.dynamics.steps import Record
from fenics_gears.results.root_stress_variables import RootStress
from fenics_gears.results.side_by_side import SideBySide

# Of a gear: the teeth loaded at a position, by `sector_of`, and the forces on their flanks' slices per contact force
# (loaded d, forces).
OnFlanks = tuple[list[int], sparse.csr_matrix]


class FaceRootStress(RootStress):
    """Root stress at the steps of a cycle over the face: forces on slices of the flanks from the contact forces, times
    the stress per force on a slice."""

    def on_flanks(self, record: Record) -> tuple[list[int], tuple[OnFlanks, OnFlanks]]:
        """Indices of the tooth pairs in reach, and matrices from contact forces to forces on both gears' flanks, built
        when first asked for."""
        phase = record.step % self.cycle.steps
        if phase not in self._matrices:
            pairs = record.position.operator.pairs
            tangential = len(record.solution.forces) > record.position.operator.nodes
            teeth = sorted({pair.place.index for pair in pairs}, reverse=True)
            self._matrices[phase] = teeth, tuple(self._of_gear(gear, pairs, tangential) for gear in (0, 1))
        return self._matrices[phase]

    def _of_gear(self, gear: int, pairs: Sequence[FacePair], tangential: bool) -> OnFlanks:
        face, data = self.cycle.face, (self.pair.pinion, self.pair.wheel)[gear]
        sectors, dofs = sorted({sector_of(gear, pair) for pair in pairs}), self.rows[gear].rows.shape[-1]
        count = sum(len(pair.offsets) for pair in pairs)
        entries = []
        for nodes, pair in zip(node_slices(pairs), pairs):
            forces = slice_rows(gear, data, face, pair, tangential)
            columns = np.r_[nodes, count + nodes.start : count + nodes.stop] if tangential else np.r_[nodes]
            first = dofs * sectors.index(sector_of(gear, pair)) + len(forces) * (
                face.slices * pair.place.flank + pair.place.slice
            )
            row, column = np.nonzero(forces)
            entries.append((forces[row, column], first + row, columns[column]))
        values, row, column = (
            (np.concatenate(each) for each in zip(*entries)) if entries else np.empty((3, 0), dtype=int)
        )
        return sectors, sparse.csr_matrix(
            (values, (row, column)), shape=(dofs * len(sectors), (2 if tangential else 1) * count)
        )

    def values(self, nodes: SideBySide) -> dict[str, np.ndarray]:
        """Root stress at consecutive steps; not a number where a slot's pair is out of reach."""
        slices, points = self.rows[0].rows.shape[1:3]
        values = np.full((len(nodes.steps), 2, nodes.slots, slices, points), np.nan)
        # By gear and distance of the tooth from the loaded one, so that all steps are one product.
        asked: dict[tuple[int, int], list[tuple[int, int, np.ndarray]]] = defaultdict(list)
        for i, record in enumerate(nodes.steps.records):
            teeth, gears = self.on_flanks(record)
            slots = [nodes.slot_of(i, index) for index in teeth]
            values[i, :, slots] = 0.0
            for gear, (sectors, matrix) in enumerate(gears):
                for sector, force in zip(sectors, (matrix @ record.solution.forces).reshape(len(sectors), -1)):
                    if force.any():
                        for index, slot in zip(teeth, slots):
                            asked[gear, SENSE_OF_TEETH[gear] * index - sector].append((i, slot, force))
        for (gear, ahead), found in asked.items():
            steps, slots, forces = zip(*found)
            stress = np.stack(forces) @ self._known(gear, ahead).reshape(slices * points, -1).T
            np.add.at(values, (np.array(steps), gear, np.array(slots)), stress.reshape(-1, slices, points))
        return _variables(values.reshape(*values.shape[:4], 2, points // 2))

    def labels(self) -> tuple[dict[str, str], dict[str, tuple]]:
        """As in the plane, and that of the slices."""
        words, coordinates = super().labels()
        section = words["root_stress_at_30_degrees"]
        return words | {
            "root_stress_at_30_degrees": f"largest {section}",
            "root_stress_over_face": section,
        }, coordinates


def _variables(values: np.ndarray) -> dict[str, np.ndarray]:
    """The variables of a result from stresses (steps, gears, slots, slices, sides, points)."""
    along = np.moveaxis(values[..., :-1], 3, -1)
    along = along.reshape(*along.shape[:3], -1, along.shape[-1])
    section = values[..., -1].swapaxes(-1, -2)
    return {
        "root_stress": along,
        "root_stress_maximum": np.fmax.reduce(along, axis=(-1, -2)),
        "root_stress_over_face": section,
        "root_stress_at_30_degrees": np.fmax.reduce(section, axis=-1),
    }
