"""The result of the meshes of a row with idlers, which were marched together."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import Any

import numpy as np

from fenics_gears.dynamics.energy_account import account
from fenics_gears.dynamics.marched import March
from fenics_gears.dynamics.steps import Steps
from fenics_gears.model.train import RowModel

from .contact_variables import energy_of_teeth
from .dataset import coordinates_of, variables_of
from .key_numbers import key_numbers
from .recorder import Recorder
from .train import OF_ENERGY, MeshResult


class RowResult:
    """What the march of a row gives: `recorders` of its meshes, and the work of all of them."""

    def __init__(self, row: RowModel, recorders: Sequence[Recorder]):
        self._row = row
        self._recorders = recorders
        # Work (N mm) that friction takes, and that of the drive beyond the one without losses.
        self._lost = 0.0
        self._driven = 0.0
        self._last: Steps | None = None

    def take(self, solved: Steps, of_meshes: Sequence[Steps]) -> None:
        """The next steps, of all meshes together and of each."""
        for recorder, own in zip(self._recorders, of_meshes):
            recorder.take(own)
        if self._row.models[0].scene.friction is None:
            return
        together = solved if self._last is None else self._last.followed_by(solved)
        clock = self._row.models[0].clock
        work = account(self._row.drivetrain, clock, together, energy_of_teeth(together))
        self._lost += float(work.friction[-1])
        self._driven += float(work.rotation[-1])
        self._last = solved.between(len(solved) - 1, len(solved))

    def of_meshes(self, march: March) -> list[MeshResult]:
        """All meshes; the friction loss of the row is that of its last mesh."""
        found: list[MeshResult] = []
        for mesh, recorder in zip(self._row.meshes, self._recorders):
            recorder.finish()
            own = {name: (dims, values, labels) for name, dims, values, labels in variables_of(recorder, 0)}
            own |= coordinates_of(recorder, recorder.arrays)
            own = {name: of for name, of in own.items() if not name.startswith(OF_ENERGY)}
            # All of them took that march.
            seconds = (0.0 if found else march.seconds, 0.0)
            found.append(MeshResult(mesh.name, own, self._numbers(recorder), self._said(march), seconds))
        if self._row.models[0].scene.friction is not None:
            found[-1].numbers["friction_loss"] = self._lost / (self._driven + self._driving_work(march.steps))
        return found

    @staticmethod
    def _said(march: March) -> list[str]:
        if not march.separations:
            return []
        return [f"no flanks of the row touch in {len(march.separations)} of {march.steps} steps"]

    @staticmethod
    def _numbers(recorder: Recorder) -> dict[str, Any]:
        counted = {name: recorder.arrays[name] for name, (dims, _) in recorder.stored.items() if dims[0] == "time"}
        model = recorder.model
        error = counted["transmission_error"]
        found = key_numbers(counted, model.pair, None, False) | {
            "mean_transmission_error": float(error[:-1].mean()),
            "peak_to_peak_transmission_error": float(np.ptp(error)),
            "base_radius_wheel": model.pair.wheel.base_radius,
            "steps_per_mesh_cycle": recorder.cycle.steps,
            "newton_iterations_total": int(counted["newton_iterations"][1:].sum()),
            "steps": recorder.steps - 1,
        }
        return {name: value for name, value in found.items() if isinstance(value, str) or isfinite(value)}

    def _driving_work(self, steps: int) -> float:
        """Work (N mm) of the drive over so many steps without losses."""
        first = self._row.models[0]
        torque = first.scene.load.wheel_torque * first.pair.rotation_ratio
        return torque * first.pair.pinion.angular_pitch * steps / first.resolution.steps_per_mesh_cycle
