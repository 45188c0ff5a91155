"""Root stress in the result: the stress along the surface of both fillets of every loaded tooth, over time."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr

from fenics_gears.contact.flank_forces import SENSE_OF_TEETH, flank_rows, sector_of, unmirrored
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.tooth_pair import COAST, ToothPair
from fenics_gears.dynamics.march import Record
from fenics_gears.elasticity.root_stress import RootStressRows
from fenics_gears.errors import ComputationError
from fenics_gears.geometry.pair import GearPair

Rows = tuple[RootStressRows, RootStressRows]
SIDES = ("drive", "coast")


class RootStress:
    """Root stress at the steps of a cycle: for each position a matrix from contact forces to stresses, built when first asked for."""

    def __init__(self, pair: GearPair, cycle: Cycle, rows: Rows):
        self.pair, self.cycle, self.rows = pair, cycle, rows
        self._matrices: dict[float, tuple[list[int], np.ndarray]] = {}

    def at(self, record: Record) -> tuple[list[int], np.ndarray]:
        """Numbers of the loaded tooth pairs, and their stress (gears, pairs, points), MPa, at a recorded step."""
        phase = record.step % self.cycle.steps
        if phase not in self._matrices:
            tangential = len(record.solution.forces) > record.position.operator.nodes
            self._matrices[phase] = self._matrix(record.position.operator.pairs, tangential)
        teeth, matrix = self._matrices[phase]
        numbers = [int(self.cycle.pair_number(record.step, index)) for index in teeth]
        return numbers, matrix @ record.solution.forces

    def _matrix(self, pairs: Sequence[ToothPair], tangential: bool) -> tuple[list[int], np.ndarray]:
        """Indices of the pairs, and stress (gears, pairs, points, forces) per contact force, N; forces as the operator has them."""
        teeth = sorted({pair.place.index for pair in pairs}, reverse=True)
        ends = np.cumsum([0] + [len(pair.offsets) for pair in pairs])
        points = self.rows[0].rows.shape[1]
        matrix = np.zeros((2, len(teeth), points, (2 if tangential else 1) * ends[-1]))
        for gear, data in enumerate((self.pair.pinion, self.pair.wheel)):
            for number, pair in enumerate(pairs):
                line = flank_rows(gear, pair, tangential) / self.pair.face_widths[gear]
                line = unmirrored(data, line) if pair.place.flank == COAST else line
                columns = np.arange(ends[number], ends[number + 1])
                if tangential:
                    columns = np.concatenate([columns, ends[-1] + columns])
                for place, index in enumerate(teeth):
                    ahead = SENSE_OF_TEETH[gear] * index - sector_of(gear, pair)
                    matrix[gear, place][:, columns] += self._response(gear, ahead, pair.place.flank, len(line)) @ line
        return teeth, matrix

    def _response(self, gear: int, ahead: int, flank: int, dofs: int) -> np.ndarray:
        rows = self.rows[gear]
        if abs(ahead) > rows.reach:
            raise ComputationError(f"root stress: the stress of a tooth {ahead} pitches from the loaded one was not computed, known are {rows.reach}")
        return rows.rows[rows.reach + ahead][:, flank * dofs : (flank + 1) * dofs]


def root_stress_variables(stress: RootStress, records: Sequence[Record], numbers: Sequence[int]) -> xr.Dataset:
    """The variables of root stress for the tooth pairs `numbers` of a result; not a number where a pair's flanks are out of reach."""
    points = stress.rows[0].rows.shape[1] // 2
    values = np.full((len(records), 2, len(numbers), 2, points), np.nan)
    row = {number: i for i, number in enumerate(numbers)}
    for i, record in enumerate(records):
        present, stresses = stress.at(record)
        for place, number in enumerate(present):
            values[i, :, row[number]] = stresses[:, place].reshape(2, 2, points)
    along, section = values[..., :-1], values[..., -1]
    angles = np.array([rows.tangent_angle[:-1] for rows in stress.rows])
    flat = along.reshape(*along.shape[:3], -1)
    over = ("time", "gear", "pair")
    described = {
        "root_stress": ((*over, "fillet_point"), flat, "stress along the surface of the fillets"),
        "root_stress_maximum": (over, _largest(flat), "largest tension in the fillets"),
        "root_stress_at_30_degrees": ((*over, "fillet"), section, "stress where the fillet's tangent stands at 30 degrees to the tooth's centreline"),
    }
    return xr.Dataset(
        {name: (dims, data, {"units": "MPa", "long_name": words}) for name, (dims, data, words) in described.items()},
        coords={
            "fillet": ("fillet", list(SIDES), {"long_name": "side of the tooth"}),
            "fillet_side": ("fillet_point", np.repeat(SIDES, points - 1), {"long_name": "side of the tooth that the fillet point is on"}),
            "fillet_tangent_angle": (
                ("gear", "fillet_point"), np.hstack([angles, angles]),
                {"units": "rad", "long_name": "angle between the fillet's tangent and the tooth's centreline"},
            ),
        },
    )  # fmt: skip


def _largest(values: np.ndarray) -> np.ndarray:
    """Largest value over the last axis; not a number where there is none."""
    known = np.isfinite(values).any(axis=-1)
    return np.where(known, np.max(np.where(np.isfinite(values), values, -np.inf), axis=-1), np.nan)


def peaks(stress: RootStress, records: Sequence[Record], force: Callable[[Record], float]) -> tuple[float, float]:
    """Largest root stress (MPa) and largest of a force (N) over some steps."""
    stresses = [float(np.nanmax(stress.at(record)[1], initial=0.0)) for record in records]
    return max(stresses, default=0.0), max((force(record) for record in records), default=0.0)
