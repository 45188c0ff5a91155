"""Contact forces at a stored time, read from a result and applied to the flanks."""

from dataclasses import dataclass

import numpy as np
import xarray as xr

from fenics_gears.contact.flank_forces import flank_forces
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.tooth_pair import COAST, DRIVE, ToothPair
from fenics_gears.elasticity.slice_averages import slice_averages
from fenics_gears.errors import ComputationError, SceneError
from fenics_gears.model.model import Model
from fenics_gears.results.pairs import contact_times

# Largest difference of roll angles (rad) between a result and its scene; a file may round them.
SAME_OFFSETS = 1e-9
MID_WIDTH = np.zeros(1)


@dataclass(frozen=True)
class StoredForces:
    """The contact of one stored step: its tooth pairs, and the forces (n,) or (2 n,), N, of each one's contact nodes.
    `index`: place of the step among the stored ones; `phase`: mesh cycles since the start of contact of pair 0."""

    index: int
    phase: float
    pairs: tuple[ToothPair, ...]
    forces: tuple[np.ndarray, ...]

    @property
    def on_coast_flanks(self) -> bool:
        carried = {DRIVE: 0.0, COAST: 0.0}
        for pair, force in zip(self.pairs, self.forces):
            carried[pair.place.flank] += float(force[: len(pair.offsets)].sum())
        return carried[COAST] > carried[DRIVE]

    def on_flanks(self, model: Model, gear: int, heights: np.ndarray = MID_WIDTH) -> dict[int, np.ndarray]:
        """Forces on the flank nodes of a gear's loaded teeth, as of `contact.flank_forces`, at `heights` (h,), mm from
        its mid-width."""
        averages = slice_averages(heights, 2, model.face.positions - model.face.middles[gear], model.face.widths)
        return flank_forces(model.pair.sides[gear], model.face, averages, self.pairs, self.forces)


def stored_index(result: xr.Dataset, mesh_phase: float) -> int:
    """The step with contact fields nearest to `mesh_phase` mesh cycles after the first of them. Raises SceneError
    outside these cycles, or where there are none."""
    phases = contact_times(result)["contact_mesh_phase"].values
    since = phases - phases[0]
    spacing = np.diff(since).max(initial=0.0)
    if not -spacing <= mesh_phase <= since[-1] + spacing:
        raise SceneError(
            f"--at {mesh_phase:g}: the run has stored mesh cycles 0 to {since[-1]:g}, counted from its first stored"
            " step"
        )
    return int(np.argmin(np.abs(since - mesh_phase)))


def stored_forces(result: xr.Dataset, model: Model, cycle: Cycle, index: int) -> StoredForces:
    """The contact forces of a step, by its place among those with contact fields; `cycle`: the one that the run had.
    Raises ComputationError where the result was computed from another scene than `model` is of."""
    begins = cycle.mesh.ahead
    step = round((float(result["contact_mesh_phase"].values[index]) - begins) * cycle.steps)
    pairs = cycle.pairs_at(step % cycle.steps)
    numbers = result["contact_pair_number"]
    slot = {int(number): i for i, number in enumerate(numbers.values[index])}
    first = numbers.attrs["number_at_phase_0"]
    forces = tuple(
        _forces_of(result, model, pair, index, slot.get(int(cycle.pair_number(step, pair.place.index)) + first))
        for pair in pairs
    )
    return StoredForces(index, step % cycle.steps / cycle.steps + begins, pairs, forces)


def _forces_of(result: xr.Dataset, model: Model, pair: ToothPair, index: int, slot: int | None) -> np.ndarray:
    side = {DRIVE: "", COAST: "coast_"}[pair.place.flank]
    count = len(pair.offsets)

    def stored(name: str) -> np.ndarray:
        return result[f"{side}contact_{name}"].values[index, slot].reshape(model.face.slices, -1)[pair.place.slice]

    rolls = np.empty(0) if slot is None else stored("roll_angle")
    if (
        np.count_nonzero(~np.isnan(rolls)) != count
        or np.abs(rolls[:count] - pair.rolls[0]).max(initial=0.0) > SAME_OFFSETS
    ):
        raise ComputationError(
            "the stored contact nodes are not those of the scene that the result carries. Run the scene again."
        )
    kinds = ["pressure"] if model.scene.friction is None else ["pressure", "traction"]
    missing = [name for kind in kinds if (name := f"{side}contact_{kind}") not in result]
    if missing:
        raise ComputationError(
            f"the result has no {', '.join(missing)}, which the stresses need; run the scene again with this version"
        )
    area = pair.lengths * model.face.contact_widths[pair.place.slice]
    return np.concatenate([stored(kind)[:count] * area for kind in kinds])
