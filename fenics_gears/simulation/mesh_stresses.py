"""Displacement and stress of the gears of a mesh of a train, under the forces of all meshes that these gears are in."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from fenics_gears.elasticity.cache import user_cache
from fenics_gears.elasticity.recovery import GearRecovery, gear_recovery
from fenics_gears.geometry.outline import centreline_mirror
from fenics_gears.model.train import row_of
from fenics_gears.results.mesh_of_train import mesh_run
from fenics_gears.results.pairs import contact_times
from fenics_gears.scene.train import TrainScene
from fenics_gears.system.progress import SilentProgress

from .run_stresses import RunStresses, recovery_of
from .stored_forces import StoredForces, stored_forces
from .train import cycle_of_row


def stresses_of_mesh(result: xr.Dataset, train: TrainScene, number: int) -> RunStresses:
    """Of any mesh of a train's result, which is a pair where it runs by itself. Errors are those of `RunStresses`."""
    if number in train.alone:
        return RunStresses(mesh_run(result, train, number), train.meshes[number].scene)
    return MeshStresses(result, train, number)


class MeshStresses(RunStresses):
    """See `RunStresses`; of the mesh with that `number` of a train whose meshes are computed together."""

    def __init__(self, result: xr.Dataset, train: TrainScene, number: int):
        first, part, numbers = next(
            (first, part, row) for first, part in train.numbered for row in part.rows if number - first in row
        )
        self.row = row_of(part, numbers)
        self.number = numbers.index(number - first)
        self.model = self.row.models[self.number]
        self._check()
        runs = [mesh_run(result, train, first + each) for each in numbers]
        self.runs = [contact_times(each) for each in runs]
        self.result = self.runs[self.number]
        self.cycles = [mesh.cycle for mesh in cycle_of_row(self.row, SilentProgress(), user_cache()).meshes]
        self.cycle = self.cycles[self.number]
        self.recoveries = tuple(self._recovery(side) for side in (0, 1))

    def _recovery(self, side: int) -> GearRecovery:
        """Of a gear on the elements that its row has."""
        gear = self.row.graph.gears[self.number][side]
        if gear not in self.row.graph.shared:
            return recovery_of(self.model, side)
        own, material, discretisation, reach = self.row.key_of_shared(gear)
        divided = self.row.solid_discretisation_of(gear) if self.row.over_face else discretisation
        return gear_recovery(own, material, divided, reach.across is not None)

    def forces(self, gear: int, stored: StoredForces) -> dict[int, np.ndarray]:
        recovery = self.recoveries[gear]
        name = self.row.graph.gears[self.number][gear]
        own = list(_by_flank(super().forces(gear, stored)))
        for mesh, side in self.row.graph.sides[name]:
            if mesh != self.number:
                shared = self.row.layout.shared(name, self.number, mesh)
                theirs = self._stored(mesh, stored.index).on_flanks(self.row.models[mesh], side, recovery.heights)
                for place, force in _by_flank(theirs):
                    seen = _mirrored(force, recovery) if shared.mirrored else force
                    own.append((shared.flank(1, place), seen))
        flanks = 1 + max((flank for (_, flank), _ in own), default=0)
        found: dict[int, np.ndarray] = {}
        for (tooth, flank), force in own:
            found.setdefault(tooth, np.zeros((flanks, *force.shape)))[flank] += force
        return found

    def _stored(self, mesh: int, index: int) -> StoredForces:
        """The forces of another mesh at the time of a stored step."""
        run = self.runs[mesh]
        time = self.result["contact_time"].values[index]
        same = int(np.argmin(np.abs(run["contact_time"].values - time)))
        return stored_forces(run, self.row.models[mesh], self.cycles[mesh], same)


def _by_flank(forces: dict[int, np.ndarray]) -> Iterator[tuple[tuple[int, int], np.ndarray]]:
    """Tooth and kind of each flank, and forces (h, f components) on it, of those that `flank_forces` gives."""
    for tooth, of_tooth in forces.items():
        for flank, force in enumerate(of_tooth):
            yield (tooth, flank), force


def _mirrored(force: np.ndarray, recovery: GearRecovery) -> np.ndarray:
    """Forces (h, f components) on a flank from those on its mirror image."""
    mirror = centreline_mirror(recovery.gear, recovery.sector.components)
    return (force.reshape(*force.shape[:-1], -1, len(mirror)) @ mirror.T).reshape(force.shape)
