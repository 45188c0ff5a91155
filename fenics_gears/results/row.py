"""The result of meshes that were marched together: those of a row with idlers, or all of a train."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from fenics_gears.dynamics.energy_account import account
from fenics_gears.dynamics.marched import March
from fenics_gears.dynamics.steps import Steps
from fenics_gears.effects.wheel_points import FORCES
from fenics_gears.model.row_model import RowModel

from .contact_variables import energy_of_teeth
from .dataset import coordinates_of, variables_of
from .key_numbers import key_numbers
from .planetary import result_of_set
from .recorder import Recorder
from .train import OF_ENERGY, MeshResult
from .train_shafts import ShaftsOfTrain
from .validity import NO_MEANING, locking, warnings_of_mesh

if TYPE_CHECKING:
    from .train_shafts import ResultOfShafts


class RowResult:
    """What a march of several meshes gives: `recorders` of each, and the work of all of them."""

    def __init__(self, row: RowModel, recorders: Sequence[Recorder]):
        self._row = row
        self._recorders = recorders
        # By block, work (N mm) of each step: what friction takes, and that of the drive beyond the one without losses.
        self._lost: list[np.ndarray] = []
        self._driven: list[np.ndarray] = []
        self._last: Steps | None = None
        # Of shafts that bend, or of a planetary set.
        self._states: list[np.ndarray] = []

    def take(self, solved: Steps, of_meshes: Sequence[Steps]) -> None:
        """The next steps, of all meshes together and of each."""
        for recorder, own in zip(self._recorders, of_meshes):
            recorder.take(own)
        if self._row.bent is not None or self._row.shafts.carrier is not None:
            self._states.append(solved.states[:, 0])
        if not self._row.friction:
            return
        together = solved if self._last is None else self._last.followed_by(solved)
        equations = self._row.equations_of_motion
        energy = energy_of_teeth(together)
        work = account(equations.drivetrain, equations.clock, together, energy, equations.loads)
        self._lost.append(np.diff(work.friction))
        self._driven.append(np.diff(work.rotation))
        self._last = solved.between(len(solved) - 1, len(solved))

    def of_meshes(self, march: March) -> list[MeshResult]:
        """All meshes; the friction loss of the row is that of its last mesh."""
        found: list[MeshResult] = []
        # Points of a ring take the forces of all meshes.
        left_out = OF_ENERGY if self._row.shafts.carrier is None else (*OF_ENERGY, *FORCES)
        for mesh, recorder in zip(self._row.meshes, self._recorders):
            recorder.finish()
            curves = {name: (dims, values, labels) for name, dims, values, labels in variables_of(recorder, 0)}
            places = _along_the_row(coordinates_of(recorder, recorder.arrays))
            numbers = self._numbers(recorder)
            said = [*map(mesh.words, warnings_of_mesh(recorder, numbers)), *self._said(recorder, march)]
            if recorder.model.friction_coefficient * recorder.cycle.longest_lever >= 1.0:
                said += locking(self._slowest.cycle, march)
            for along in recorder.along_face:
                labelled = xr.Dataset(curves, places)
                numbers |= _finite(along.numbers(labelled, numbers))
                said += along.warnings(labelled)
            own = {name: of for name, of in (curves | places).items() if not name.startswith(left_out)}
            # All of them took that march.
            seconds = (0.0 if found else march.seconds, 0.0)
            found.append(MeshResult(mesh.name, own, numbers, said, seconds))
        if self._row.friction and not march.locked:
            found[-1].numbers["friction_loss"] = self._friction_loss()
        if self._states:
            found[0] = replace(found[0], shafts=self._of_shafts(np.concatenate(self._states)))
        return found

    def _of_shafts(self, states: np.ndarray) -> ResultOfShafts:
        """What the states (steps, k) say of a planetary set, or of shafts that bend; other trains load neither."""
        row = self._row
        carrier = row.shafts.carrier
        if carrier is not None:
            return result_of_set(row, carrier, states, [recorder.arrays for recorder in self._recorders])
        return ShaftsOfTrain(row.drivetrain, row.bent, states).result(row.recorded)

    def _friction_loss(self) -> float:
        """Part of the driving work that friction takes in the recorded steps."""
        lost, driven = (np.concatenate(each)[-self._row.recorded :] for each in (self._lost, self._driven))
        return float(lost.sum() / (driven.sum() + self._driving_work(len(lost))))

    @property
    def _slowest(self) -> Recorder:
        return max(self._recorders, key=lambda recorder: recorder.cycle.steps)

    def _said(self, recorder: Recorder, march: March) -> list[str]:
        """Loss of contact in all meshes, which has no meaning where gears turn through a mesh's backlash meanwhile."""
        if not march.separations:
            return []
        coast = recorder.cycle.coast_flanks
        lost = (
            f"no {'drive ' if coast else ''}flanks touch in any mesh in {len(march.separations)} of {march.steps} steps"
        )
        first = march.steps - self._row.recorded if self._row.recorded else 0
        # The smallest opening of all meshes: each is open by as much.
        widest = max((opening for step, opening in march.separations if step >= first), default=0.0)
        # Of gears without backlash a number of round-off.
        backlash = max(round(recorder.cycle.pair.backlash, 9), 0.0)
        if widest <= backlash or coast:
            return [lost]
        return [
            f"{NO_MEANING}: {lost}, and they come {widest * 1e3:.4g} um apart. That is more than the backlash of"
            f" {backlash * 1e3:.4g} um: the coast flanks would touch, which this scene does not have"
        ]

    def _numbers(self, recorder: Recorder) -> dict[str, Any]:
        """Numbers of a mesh, of the last whole mesh cycles among the recorded steps."""
        cycle = recorder.cycle.steps
        last = recorder.steps - 1
        first = max(last - cycle * (self._row.recorded // cycle), 0) if self._row.recorded else 0
        counted = recorder.counted(first)
        model = recorder.model
        error = counted["transmission_error"]
        found = key_numbers(counted, model.pair, None, False) | {
            "mean_transmission_error": float(error[:-1].mean()),
            "peak_to_peak_transmission_error": float(np.ptp(error)),
            "base_radius_wheel": abs(model.pair.wheel.base_radius),
            "steps_per_mesh_cycle": recorder.cycle.steps,
            "newton_iterations_total": int(counted["newton_iterations"][1:].sum()),
            "steps": recorder.steps - 1,
        }
        if model.scene.friction is not None:
            found["friction_coefficient"] = model.friction_coefficient
        return _finite(found)

    def _driving_work(self, steps: int) -> float:
        """Work (N mm) of the drive over so many steps without losses."""
        driving = [self._row.models[mesh] for mesh in self._row.graph.out_of(0)]
        torque = sum(each.scene.load.wheel_torque * abs(each.pair.rotation_ratio) for each in driving)
        first = driving[0]
        return torque * first.pair.pinion.angular_pitch * steps / first.resolution.steps_per_mesh_cycle


def _finite(numbers: Mapping[str, Any]) -> dict[str, Any]:
    """Numbers, also those in words."""
    return {name: value for name, value in numbers.items() if isinstance(value, str) or isfinite(value)}


def _along_the_row(places: dict[str, tuple]) -> dict[str, tuple]:
    """Coordinates of a mesh; those along the axes run one way in all meshes of a row, whichever way their gears
    turn."""
    if "face_position" not in places:
        return places
    dims, values, labels = places["face_position"]
    words = (
        "distance along the axes from the middle of the face, towards the end from which the first gear of the stage"
        " is seen to turn counter-clockwise"
    )
    return places | {"face_position": (dims, values, labels | {"long_name": words})}
